//! Colours and progress bars appear on terminals only.

use std::process::Command;

use super::case;
use crate::support::process::Running;
use crate::support::solver::{LIMIT, built, program};

/// The beginning of a colour's escape sequence.
const COLOUR: &str = "\u{1b}[";

fn is_control(c: char) -> bool {
    c.is_control() && c != '\n'
}

#[test]
fn what_is_no_terminal_gets_no_control_characters() {
    let case = case("");
    for ranks in [0, 1, 2] {
        for args in [
            &[][..],
            &["--help"],
            &["--max-sweeps", "0"],
            &["--log", "json"],
        ] {
            let ended = case.run_on(ranks, args);
            // Open MPI gives ranks a terminal of its own, with other line endings.
            let printed = [ended.stdout, ended.stderr].concat().replace("\r\n", "\n");
            assert!(
                !printed.contains(is_control),
                "{ranks} ranks, {args:?}: {printed:?}"
            );
        }
    }
}

#[test]
fn the_environment_may_insist_on_colours() {
    let case = case("");
    for ranks in [0, 1] {
        let mut command = program(ranks);
        command.env("CLICOLOR_FORCE", "1").arg(case.problem());
        let ended = Running::start(&mut command).wait(LIMIT);
        assert_eq!(ended.code(), 0, "{}", ended.stderr);
        assert!(ended.stdout.contains(COLOUR), "{}", ended.stdout);
    }
}

#[test]
fn a_terminal_shows_colours_unless_the_environment_forbids_them() {
    let case = case("");
    let on_a_terminal = |no_color: bool| {
        let line = format!("'{}' '{}'", built().display(), case.problem().display());
        let mut command = Command::new("script");
        command
            .args(["-qec", &line, "/dev/null"])
            .env("TERM", "xterm");
        command.env_remove("NO_COLOR").env_remove("CLICOLOR_FORCE");
        if no_color {
            command.env("NO_COLOR", "1");
        }
        let ended = Running::start(&mut command).wait(LIMIT);
        assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
        ended.stdout
    };
    let shown = on_a_terminal(false);
    assert!(shown.contains("\u{1b}[32mconverged"), "{shown}");
    // A progress bar without a phase would contain these.
    assert!(!shown.contains('░'), "{shown}");
    assert!(!on_a_terminal(true).contains("\u{1b}[32m"));
}
