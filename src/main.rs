//! `contact-dd-mpi`: starts MPI where it is needed, runs, and ends with the exit code that all ranks agree on.

use std::process::ExitCode;

use contact_dd_mpi::comm::{self, Comm};
use contact_dd_mpi::error::Failure;
use contact_dd_mpi::output::event;
use contact_dd_mpi::run::{Ending, run};
use contact_dd_mpi::settings::command_line::{CommandLine, LogFormat};
use contact_dd_partition::allocator::Allocator;
use contact_dd_partition::manual::{Answer, BAD_USAGE};
use contact_dd_partition::problem::trial;

#[global_allocator]
static ALLOCATOR: Allocator = Allocator;

fn main() -> ExitCode {
    keep_freed_memory();
    if let Some(code) = trial::answer() {
        return code;
    }
    if comm::is_launched() {
        // Launchers show ranks a terminal whatever their output goes to.
        event::without_colours();
    }
    let command_line = match CommandLine::of_this_program() {
        Ok(command_line) => command_line,
        Err(answer) if comm::is_first() => return tell(&answer),
        // A launcher would end the first rank before it has told anything.
        Err(_) => return ExitCode::SUCCESS,
    };
    match comm::start() {
        Ok(world) => solve(&world.comm(), &command_line),
        Err(failure) => fail(LogFormat::of_this_program(), &failure),
    }
}

/// Keeps memory that is freed for what needs some next: a page that the system gives anew is cleared first and takes
/// longer than what most matrices are made for. Large ones go back to the system: their arithmetic takes much longer, and
/// between them what is kept would be in pieces that none of them fits in.
fn keep_freed_memory() {
    #[cfg(target_env = "gnu")]
    // SAFETY: sets parameters of the C library's allocator while nothing else runs.
    unsafe {
        libc::mallopt(libc::M_MMAP_THRESHOLD, LARGE);
        libc::mallopt(libc::M_TRIM_THRESHOLD, -1);
        libc::mallopt(libc::M_TOP_PAD, TOP_PAD);
    }
}

/// Bytes from which on memory goes back to the system: the most that the C library allows, a matrix of 2048 rows.
#[cfg(target_env = "gnu")]
const LARGE: i32 = 32 << 20;

/// Bytes that the allocator asks the system for beyond what it needs.
#[cfg(target_env = "gnu")]
const TOP_PAD: i32 = 64 << 20;

/// Runs on all ranks. Collective.
fn solve(comm: &Comm, command_line: &CommandLine) -> ExitCode {
    match run(comm, command_line) {
        Ok(Ending::Converged) => ExitCode::SUCCESS,
        Ok(Ending::NotConverged) => ExitCode::from(3),
        Err(failure) if comm.is_root() => fail(command_line.run.log.unwrap_or_default(), &failure),
        Err(failure) => failure.exit_code(),
    }
}

/// Answers a command line that asks for no run.
fn tell(answer: &Answer) -> ExitCode {
    match answer {
        Answer::Refusal(why) => {
            event::error(LogFormat::of_this_program(), BAD_USAGE, why);
            ExitCode::from(BAD_USAGE)
        }
        Answer::Text(_) => answer.print(),
    }
}

/// Prints why the program ends.
fn fail(log: LogFormat, failure: &Failure) -> ExitCode {
    event::error(log, failure.kind as u8, &failure.message);
    failure.exit_code()
}
