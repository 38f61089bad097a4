//! Man pages and completions are generated from the parsers' options.

use std::fs;
use std::process::{Command, Output};

use clap::CommandFactory;
use contact_dd_mpi::settings::command_line as solver;
use contact_dd_partition::command_line as partition;
use contact_dd_partition::manual::{Document, Manual};

use crate::support::process::Running;
use crate::support::solver::{LIMIT, program};

/// Both programs: their options, and the rest of their manual.
fn programs() -> [(clap::Command, Manual); 2] {
    [
        (solver::CommandLine::command(), solver::MANUAL),
        (partition::CommandLine::command(), partition::MANUAL),
    ]
}

fn run(command: &mut Command) -> Option<Output> {
    command.output().ok()
}

#[test]
fn the_documents_show_the_exit_codes_of_the_manual() {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/command-line.md");
    let page = fs::read_to_string(page).unwrap();
    for (code, meaning) in solver::MANUAL.exit_codes {
        let row = |line: &str| line.starts_with(&format!("| {code} |"));
        let rows: Vec<&str> = page.lines().filter(|line| row(line)).collect();
        assert_eq!(rows.len(), 1, "{code}");
        assert_eq!(rows[0].replace('`', ""), format!("| {code} | {meaning} |"));
    }
}

#[test]
fn the_man_page_has_every_option_and_exit_code_and_is_well_formed() {
    let folder = tempfile::tempdir().unwrap();
    for (command, manual) in programs() {
        let page = manual.write(Document::Man, command.clone());
        let words = page.replace("\\-", "-");
        for option in command.get_arguments().filter_map(clap::Arg::get_long) {
            assert!(words.contains(&format!("--{option}")), "{option}");
        }
        for (code, meaning) in manual.exit_codes {
            let meaning = meaning.replace('\'', "\\*(Aq");
            let entry = format!("\\fB{code}\\fR\n{meaning}\n");
            assert!(words.contains(&entry), "{entry} in {words}");
        }
        for section in [
            "EXIT STATUS",
            "FILES",
            "ENVIRONMENT",
            "EXAMPLES",
            "SEE ALSO",
        ] {
            assert!(words.contains(section), "{section}");
        }
        let path = folder.path().join("page.1");
        fs::write(&path, page).unwrap();
        // All readers of man pages installed here accept it.
        let linted = run(Command::new("mandoc")
            .args(["-T", "lint", "-W", "error"])
            .arg(&path));
        let set = run(Command::new("groff")
            .args(["-man", "-Tutf8", "-ww", "-z"])
            .arg(&path));
        for output in linted.into_iter().chain(set) {
            let printed = [output.stdout, output.stderr].concat();
            assert!(printed.is_empty(), "{}", String::from_utf8_lossy(&printed));
        }
    }
}

#[test]
fn bash_completes_options_and_their_values() {
    let folder = tempfile::tempdir().unwrap();
    for (command, manual) in programs() {
        let name = command.get_name().to_owned();
        let (option, values) = match name.as_str() {
            "contact-dd-mpi" => ("--method", vec!["newton", "anderson", "picard"]),
            _ => ("--element", vec!["triangle3", "quad9"]),
        };
        let path = folder.path().join("completion");
        fs::write(&path, manual.write(Document::CompleteBash, command)).unwrap();
        let complete = |words: &str| {
            let script = format!(
                "source {}; function=$(complete -p {name} | sed 's/.*-F \\([^ ]*\\) .*/\\1/'); \
                 words=({name} {words}''); COMP_WORDS=(\"${{words[@]}}\"); \
                 COMP_CWORD=$((${{#words[@]}} - 1)); \
                 $function {name} '' \"${{words[COMP_CWORD - 1]}}\"; echo \"${{COMPREPLY[@]}}\"",
                path.display()
            );
            let mut bash = Command::new("bash");
            let ended = Running::start(bash.args(["--norc", "-c", &script])).wait(LIMIT);
            assert_eq!((ended.code(), ended.stderr.as_str()), (0, ""));
            ended.stdout
        };
        let options = complete("");
        assert!(options.contains(option), "{options}");
        let offered = complete(&format!("{option} "));
        for value in values {
            let mut offered = offered.split_whitespace();
            assert!(offered.any(|word| word == value), "{value}");
        }
    }
}

#[test]
fn documents_need_no_problem() {
    for (kind, word) in [
        ("man", ".TH contact-dd-mpi 1"),
        ("complete-bash", "complete -F"),
        ("complete-zsh", "#compdef contact-dd-mpi"),
        ("complete-fish", "complete -c contact-dd-mpi"),
    ] {
        let mut command = program(0);
        let ended = Running::start(command.args(["--generate", kind])).wait(LIMIT);
        assert_eq!(ended.code(), 0, "{}", ended.stderr);
        assert!(ended.stdout.contains(word), "{}", ended.stdout);
        assert_eq!(ended.stderr, "");
    }
}

#[test]
fn the_long_help_tells_more_than_the_short_one() {
    for (mut command, manual) in programs() {
        let short = command.render_help().to_string();
        let long = command.render_long_help().to_string();
        assert!(short.lines().count() < long.lines().count());
        for option in command.get_arguments().filter_map(clap::Arg::get_long) {
            assert!(short.contains(&format!("--{option}")), "{option}");
            assert!(long.contains(&format!("--{option}")), "{option}");
        }
        for (code, meaning) in manual.exit_codes {
            assert!(long.contains(&format!("  {code}  {meaning}")), "{long}");
        }
    }
}

#[test]
fn the_help_names_the_defaults_that_hold() {
    let case = super::case("");
    let report = case.folder().join("report.json");
    let ended = case.run(&["--report", report.to_str().unwrap()]);
    assert_eq!(ended.code(), 0, "{}", ended.stderr);
    let settings = &super::report(&case)["settings"];
    let help = solver::CommandLine::command().render_help().to_string();
    for name in ["method", "tolerance", "log", "threads"] {
        let value = match &settings[name] {
            serde_json::Value::String(text) => text.clone(),
            number => format!("{:e}", number.as_f64().unwrap()).replace("1e0", "1"),
        };
        let words: Vec<&str> = help.split_whitespace().collect();
        let printed = words.join(" ");
        let option = printed.split(&format!("--{name} ")).nth(1).unwrap();
        let printed = option.split("[default: ").nth(1).unwrap();
        assert!(
            printed.starts_with(&format!("{value}]")),
            "{name}: {printed}"
        );
    }
}
