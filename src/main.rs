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
        // Launchers attach ranks to a terminal even if their output is redirected.
        event::without_colours();
    }
    let command_line = match CommandLine::of_this_program() {
        Ok(command_line) => command_line,
        Err(answer) if comm::is_first() => return print_answer(&answer),
        // Any failing rank would make the launcher kill the first one before that has printed its message.
        Err(_) => return ExitCode::SUCCESS,
    };
    match comm::start() {
        Ok(world) => solve(&world.comm(), &command_line),
        Err(failure) => fail(LogFormat::of_this_program(), &failure),
    }
}

/// Lets the allocator keep freed memory for reuse: the system clears every page that it hands out, which takes longer
/// than the arithmetic on most matrices. Blocks of at least `LARGE` bytes still go back to the system: their arithmetic
/// takes much longer than the clearing, and kept memory would be too fragmented to hold another one.
fn keep_freed_memory() {
    #[cfg(target_env = "gnu")]
    // SAFETY: sets parameters of the C library's allocator while nothing else runs.
    unsafe {
        libc::mallopt(libc::M_MMAP_THRESHOLD, LARGE);
        libc::mallopt(libc::M_TRIM_THRESHOLD, -1);
        libc::mallopt(libc::M_TOP_PAD, TOP_PAD);
    }
}

/// Size from which on freed memory goes back to the system (bytes): the largest that the C library allows, a matrix of
/// 2048 rows.
#[cfg(target_env = "gnu")]
const LARGE: i32 = 32 << 20;

/// Memory that the allocator requests from the system beyond its need (bytes).
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

/// Prints the answer to a command line that starts no run.
fn print_answer(answer: &Answer) -> ExitCode {
    match answer {
        Answer::Refusal(why) => {
            event::error(LogFormat::of_this_program(), BAD_USAGE, why);
            ExitCode::from(BAD_USAGE)
        }
        Answer::Text(_) => answer.print(),
    }
}

/// Prints the failure that ends the program.
fn fail(log: LogFormat, failure: &Failure) -> ExitCode {
    event::error(log, failure.kind as u8, &failure.message);
    failure.exit_code()
}
