//! Outputs that can't be written: exit code 5, one message, the older file unchanged.

use std::path::Path;

use rustix::process::{Pid, Signal, kill_process};

use super::*;
use support::mounted::{Mounted, privilege};
use support::solver::{built, launched};

pub fn unwritable_output(trials: &mut Trials) {
    let outputs: [(&str, &[&str]); 4] = [
        ("no_folder", &["-o", "/nowhere/at/all/result.vtkhdf"]),
        ("a_folder", &["-o", "/tmp"]),
        ("a_device", &["-o", "/dev/full"]),
        ("report", &["--report", "/nowhere/at/all/report.json"]),
    ];
    for (name, args) in outputs {
        trials.on_all_ranks(&format!("unwritable_output::{name}"), move |ranks| {
            let case = Case::of(&model(&two_block_scene(), two_blocks().mesh), 3);
            failed_once(&case.run_on(ranks, args), 5, &[args[1]]);
            assert_eq!(case.files(), ["problem.h5"]);
        });
    }
}

/// A file system that fills up at every possible stage, and a read-only one.
pub fn full_disk(trials: &mut Trials) {
    let full = "No space left on device";
    // The result has some 150 kB, the report some 4 kB, and the older file one page of 4 kB.
    let places: [(&str, Mounted, &str, &str); 6] = [
        ("from_the_start", Mounted::OfSize(4 << 10), "-o", full),
        ("soon", Mounted::OfSize(20 << 10), "-o", full),
        ("half_way", Mounted::OfSize(70 << 10), "-o", full),
        ("for_the_report", Mounted::OfSize(4 << 10), "--report", full),
        (
            "read_only",
            Mounted::ReadOnly,
            "-o",
            "Read-only file system",
        ),
        (
            "read_only_for_the_report",
            Mounted::ReadOnly,
            "--report",
            "Read-only file system",
        ),
    ];
    for (name, place, option, words) in places {
        trials.on_all_ranks(&format!("full_disk::{name}"), move |ranks| {
            let case = Case::of(&model(&two_block_scene(), two_blocks().mesh), 9);
            let folder = case.folder().join("mounted");
            fs::create_dir(&folder).unwrap();
            let output = folder.join("output");
            let mut command = program(ranks);
            command.arg(case.problem()).arg(option).arg(&output);
            let Some(mut command) = place.around(&folder, &command) else {
                eprintln!("skipped: nothing may be mounted here");
                return;
            };
            let ended = Running::start(&mut command).wait(LIMIT);
            failed_once(&ended, 5, &[&output.display().to_string(), words]);
        });
    }
}

/// A second run with the same output is refused while the first one is active, without disturbing it; a killed run
/// doesn't keep others from continuing.
pub fn the_same_output(trials: &mut Trials) {
    // An optimized program doesn't have the artificial stops.
    if cfg!(not(debug_assertions)) {
        return;
    }
    trials.on_all_ranks("same_output", |ranks| {
        let case = Case::of(&steps::two_blocks_in_steps(), 6);
        case.run(&[]);
        let expected = datasets(&case.result());
        let mut command = program(ranks);
        command.arg(case.problem());
        command.env("CONTACT_DD_END", "0 stop writing");
        let first = Running::start(&mut command);
        let id = first.stopped(LIMIT);
        for options in [&[][..], &["--restart"]] {
            let second = case.run_on(1 + ranks % 2, options);
            let words = [
                "problem.vtkhdf: can't be written: another run writes it",
                &format!("process {id} on host '"),
            ];
            failed_once(&second, 5, &words);
        }
        // It stops again in every load step, and is killed in the last one.
        for _ in 0..2 {
            kill_process(Pid::from_raw(id as i32).unwrap(), Signal::CONT).unwrap();
            assert_eq!(first.stopped(LIMIT), id);
        }
        kill_process(Pid::from_raw(id as i32).unwrap(), Signal::KILL).unwrap();
        assert_ne!(first.wait(LIMIT).code(), 0);
        let third = case.run_on(ranks, &["--restart"]);
        assert_eq!(third.code(), 0, "{}{}", third.stdout, third.stderr);
        assert!(third.stdout.contains("step 3 of 3"), "{}", third.stdout);
        assert!(!third.stdout.contains("step 1 of 3"), "{}", third.stdout);
        assert!(datasets(&case.result()) == expected);
        assert_eq!(case.files(), ["problem.h5", "problem.vtkhdf"]);
    });
}

/// An unwritable terminal is an error, but the result is written all the same.
pub fn full_terminal(trials: &mut Trials) {
    let runs: [(&str, &[&str]); 4] = [
        ("text", &[]),
        ("json", &["--log", "json"]),
        ("check", &["--check"]),
        ("help", &["--help"]),
    ];
    for (name, args) in runs {
        trials.once(&format!("full_terminal::{name}"), move || {
            let case = Case::of(&model(&two_block_scene(), two_blocks().mesh), 3);
            let left = case.folder().join(".problem.vtkhdf.abcdef.part");
            fs::write(&left, "of a run that was killed").unwrap();
            let script = "exec \"$0\" \"$@\" >/dev/full";
            let mut command = launched(Path::new("sh"), 0);
            command.args(["-c", script]).arg(built());
            command.arg(case.problem()).args(args);
            let ended = Running::start(&mut command).wait(LIMIT);
            assert_eq!(ended.code(), 5, "{}", ended.stderr);
            assert!(ended.stderr.contains("stdout"), "{}", ended.stderr);
            assert!(ended.stderr.contains("No space left"), "{}", ended.stderr);
            let is_solved = args.is_empty() || args[0] == "--log";
            assert_eq!(case.result().exists(), is_solved);
            assert_eq!(left.exists(), !is_solved);
        });
    }
}

/// A memory limit that is reached at every possible stage.
pub fn little_memory(trials: &mut Trials) {
    for ranks in [0, 2] {
        trials.once(&format!("little_memory::on_{ranks}_ranks"), move || {
            let case = Case::of(&built_in_model("granite", 2), 12);
            let limits = [80, 100, 130, 160, 180, 200, 240].map(|megabytes| {
                // The launcher itself needs more than the limit.
                let script = format!("ulimit -v {}; exec \"$0\" \"$@\"", megabytes << 10);
                let mut command = launched(Path::new("sh"), ranks);
                command
                    .args(["-c", &script])
                    .arg(built())
                    .arg(case.problem());
                let ended = Running::start(&mut command).wait(LIMIT);
                let printed = format!("{megabytes} MB: {}{}", ended.stdout, ended.stderr);
                // If MPI runs out of memory for its own libraries, it may end with a signal before the program starts,
                // with or without a message.
                let in_mpi =
                    ["failed to map segment", "mmap(2)"].map(|words| printed.contains(words));
                let in_mpi = in_mpi.contains(&true) || ended.stdout.is_empty();
                let aborted =
                    printed.contains("memory allocation of") || printed.contains("panicked");
                // An abort would be a signal, which launchers report as 128 or more.
                let is_told = ended.code() < 128 || in_mpi && !aborted;
                assert!(is_told, "{printed}");
                printed
            });
            let words = ["out of memory", "of memory, and"];
            let is_told = |printed: &String| words.iter().any(|word| printed.contains(word));
            assert!(limits.iter().any(is_told), "{limits:?}");
        });
    }
}

/// Ranks without access to the folder of the result, as on hosts with local disks, leave writing to the root.
pub fn folder_of_the_root_alone(trials: &mut Trials) {
    trials.once("folder_of_the_root_alone", || {
        let case = Case::of(&model(&two_block_scene(), two_blocks().mesh), 9);
        let folder = case.folder().join("mounted");
        fs::create_dir(&folder).unwrap();
        let Some(privilege) = privilege() else {
            eprintln!("skipped: nothing may be mounted here");
            return;
        };
        let output = folder.join("result.vtkhdf");
        let script = "mount -t tmpfs none \"$0\" && \"$@\" && cp \"$0/result.vtkhdf\" \"$0/..\"";
        let mut command = launched(Path::new("unshare"), 1);
        command.args([privilege, "sh", "-c", script]).arg(&folder);
        for separator in ["", ":"] {
            if !separator.is_empty() {
                command.args([separator, "-n", "2"]);
            }
            command.arg(built()).arg(case.problem());
            command.arg("-o").arg(&output);
        }
        let ended = Running::start(&mut command).wait(LIMIT);
        assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
        assert!(!output.exists());
        case.run(&[]);
        let found = datasets(&case.folder().join("result.vtkhdf"));
        assert_eq!(found, datasets(&case.result()));
    });
}

/// A folder that is removed before its result is complete.
pub fn vanished_folder(trials: &mut Trials) {
    // An optimized program doesn't have the artificial stops.
    if cfg!(not(debug_assertions)) {
        return;
    }
    for option in ["-o", "--report"] {
        trials.once(&format!("vanished_folder::{option}"), move || {
            let case = Case::of(&model(&two_block_scene(), two_blocks().mesh), 9);
            let folder = case.folder().join("vanishes");
            fs::create_dir(&folder).unwrap();
            let output = folder.join("output");
            let mut command = program(0);
            command.arg(case.problem()).arg(option).arg(&output);
            command.env("CONTACT_DD_END", "0 stop writing");
            let running = Running::start(&mut command);
            let id = running.stopped(LIMIT);
            assert!(fs::read_dir(&folder).unwrap().count() > 0);
            fs::remove_dir_all(&folder).unwrap();
            kill_process(Pid::from_raw(id as i32).unwrap(), Signal::CONT).unwrap();
            let words = [&*output.display().to_string(), "No such file or directory"];
            failed_once(&running.wait(LIMIT), 5, &words);
        });
    }
}
