//! `contact-dd-mpi`: starts MPI, runs, and ends with the exit code that all ranks agree on.

use std::process::ExitCode;

use clap::Parser;
use contact_dd_mpi::comm;
use contact_dd_mpi::run::{Ending, run};
use contact_dd_mpi::settings::Settings;

fn main() -> ExitCode {
    if comm::watch_if_asked().is_some() {
        return ExitCode::SUCCESS;
    }
    let world = match comm::start() {
        Ok(world) => world,
        Err(failure) => {
            eprintln!("error: {failure}");
            return failure.exit_code();
        }
    };
    let comm = world.comm();
    let settings = match Settings::try_parse() {
        Ok(settings) => settings,
        Err(error) => {
            if comm.is_root() {
                // Where a message can't be printed there is nobody to tell.
                let _ = error.print();
            }
            return ExitCode::from(if error.use_stderr() { 2 } else { 0 });
        }
    };
    match run(&comm, &settings) {
        Ok(Ending::Converged) => ExitCode::SUCCESS,
        Ok(Ending::NotConverged) => ExitCode::from(3),
        Err(failure) => {
            if comm.is_root() {
                eprintln!("error: {failure}");
            }
            failure.exit_code()
        }
    }
}
