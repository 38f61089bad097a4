//! Runs stopped by a signal.

use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

use rustix::process::Signal;
use serde_json::Value;

use super::support::random::Random;
use super::*;

type MakeModel = fn() -> Model;

/// A signal stops a run between two sweeps, with exit code 6 and a message; the older result is unchanged.
pub fn stopped_while_sweeping(trials: &mut Trials) {
    // An optimized program doesn't have the artificial stops.
    if cfg!(not(debug_assertions)) {
        return;
    }
    let signals: [(&str, &[Signal]); 4] = [
        ("term", &[Signal::TERM]),
        ("int", &[Signal::INT]),
        ("usr1", &[Signal::USR1]),
        // A batch system may send a second, different signal; only the same signal twice ends the run immediately.
        ("usr1_and_term", &[Signal::USR1, Signal::TERM]),
    ];
    for (name, signals) in signals {
        trials.on_all_ranks(&format!("stopped::by_{name}"), move |ranks| {
            let case = Case::of(&built_in_model("granite", 0), 8);
            fs::write(case.result(), "an older result").unwrap();
            let ended = stop(&case, ranks, "sweeping", |running| {
                // Both signals are pending before it continues, on any rank.
                let last = *running.descendants("contact-dd-mpi").last().unwrap();
                signals.iter().for_each(|&signal| send(last, signal));
            });
            failed_once(&ended, 6, &["interrupted after 0 sweeps"]);
            let result = fs::read_to_string(case.result()).unwrap();
            assert_eq!(result, "an older result");
            assert_eq!(case.files(), ["problem.h5", "problem.vtkhdf"]);
        });
    }
}

/// Between two load steps one rank that receives the signal is enough. Finished steps are on disk, and a restarted run
/// has the bits of an uninterrupted run, on any number of ranks.
pub fn stopped_between_steps(trials: &mut Trials) {
    if cfg!(not(debug_assertions)) {
        return;
    }
    // Some subdomains have more numbers than a reader's buffer.
    let cases: [(&str, MakeModel, usize); 6] = [
        ("", steps::two_blocks_in_steps, 6),
        ("_with_friction", steps::two_blocks_with_friction, 6),
        (
            "_with_friction_in_large_subdomains",
            steps::two_fine_blocks_with_friction,
            2,
        ),
        ("_in_stages", steps::two_blocks_in_stages, 6),
        ("_before_one_without_load", steps::two_blocks_unloaded, 6),
        (
            "_with_friction_in_space",
            steps::two_solids_with_friction,
            6,
        ),
    ];
    for (name, model, subdomains) in cases {
        stop_between_steps(trials, name, model, subdomains);
    }
}

fn stop_between_steps(
    trials: &mut Trials,
    name: &'static str,
    model: MakeModel,
    subdomains: usize,
) {
    trials.on_all_ranks(&format!("stopped::between_steps{name}"), move |ranks| {
        let case = Case::of(&model(), subdomains);
        let ended = case.run_on(ranks, &[]);
        assert_eq!(ended.code(), 0, "{}", ended.stderr);
        let expected = datasets(&case.result());
        let friction = friction(&case);
        let status = &expected["/contact/joint/status"];
        assert_eq!(status.contains(&2), !name.is_empty());
        fs::write(case.result(), "an older result").unwrap();

        stop_after_one_step(&case, ranks);
        let result = fs::read_to_string(case.result()).unwrap();
        assert_eq!(result, "an older result");
        let ended = case.run_on(1 + ranks % 4, &["--restart"]);
        assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
        assert!(datasets(&case.result()) == expected);
        assert_eq!(self::friction(&case), friction);
        assert_eq!(case.files(), ["problem.h5", "problem.vtkhdf"]);
    });
}

/// The report's friction of every load step.
fn friction(case: &Case) -> Vec<Value> {
    let report = Solution::read_report(&case.result());
    let steps = report["steps"].as_array().unwrap();
    steps.iter().map(|step| step["friction"].clone()).collect()
}

/// A state file of another run is refused and kept; without a state file the run starts from the beginning.
pub fn restarted_in_vain(trials: &mut Trials) {
    if cfg!(not(debug_assertions)) {
        return;
    }
    trials.on_all_ranks("restarted::of_another_run", |ranks| {
        let case = Case::of(&steps::two_blocks_in_steps(), 6);
        stop_after_one_step(&case, ranks);
        let kept = case.folder().join("problem.vtkhdf.unfinished");
        let before = fs::read(&kept).unwrap();
        let ended = case.run_on(ranks, &["--restart", "--tolerance", "1e-9"]);
        failed_once(&ended, 2, &["problem.vtkhdf.unfinished", "other settings"]);
        let own = fs::read(case.problem()).unwrap();
        let other = Case::of(&steps::two_blocks_in_steps(), 4);
        let state = case.folder().join("problem.vtkhdf.unfinished.state");
        fs::copy(other.problem(), case.problem()).unwrap();
        let ended = case.run_on(ranks, &["--restart"]);
        failed_once(&ended, 2, &["problem.vtkhdf.unfinished", "another problem"]);
        assert!(fs::read(&kept).unwrap() == before);
        fs::write(case.problem(), &own).unwrap();
        for (file, of) in [
            (kept.clone(), "of load step 1 isn't what was written"),
            (state, "isn't what a run that was stopped leaves"),
        ] {
            fs::write(&file, "something else").unwrap();
            let ended = case.run_on(ranks, &["--restart"]);
            failed_once(&ended, 2, &["problem.vtkhdf.unfinished", "expected", of]);
            assert_eq!(fs::read_to_string(&file).unwrap(), "something else");
        }
    });
    trials.on_all_ranks("restarted::where_nothing_is", |ranks| {
        let case = Case::of(&steps::two_blocks_in_steps(), 6);
        let ended = case.run_on(ranks, &["--restart"]);
        assert_eq!(ended.code(), 0, "{}", ended.stderr);
        assert!(ended.stdout.contains("this run begins at the start"));
        assert_eq!(case.files(), ["problem.h5", "problem.vtkhdf"]);
    });
}

/// With some bytes of the kept files changed, cut off or appended, `--restart` either reproduces the result of the
/// whole run or refuses the files with a message; `DAMAGES=500` tests that many cases for each file.
pub fn restarted_from_damage(trials: &mut Trials) {
    if cfg!(not(debug_assertions)) {
        return;
    }
    trials.once("restarted::from_damage", || {
        let count = std::env::var("DAMAGES").map_or(12, |count| count.parse().unwrap());
        let case = Case::of(&steps::two_blocks_with_friction(), 6);
        let ended = case.run(&[]);
        assert_eq!(ended.code(), 0, "{}", ended.stderr);
        let expected = datasets(&case.result());
        stop_after_one_step(&case, 1);
        let names = [
            "problem.vtkhdf.unfinished",
            "problem.vtkhdf.unfinished.state",
        ];
        let kept = names.map(|name| (case.folder().join(name), name));
        let whole = kept.each_ref().map(|(path, _)| fs::read(path).unwrap());
        let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap();
        for seed in (0..2 * count).map(|i| now.as_millis() as u64 + i) {
            for ((path, _), bytes) in kept.iter().zip(&whole) {
                fs::write(path, bytes).unwrap();
            }
            let mut random = Random::new(seed);
            let file = (seed % 2) as usize;
            let mut bytes = whole[file].clone();
            let end = match random.count(0, 1) {
                0 => bytes.len().min(4000),
                _ => bytes.len(),
            } - 1;
            match random.count(0, 3) {
                0 => bytes.truncate(random.count(0, end)),
                1 => bytes.resize(bytes.len() + random.count(1, 5000), 7),
                _ => {
                    for _ in 0..random.count(1, 100) {
                        bytes[random.count(0, end)] = random.count(0, 255) as u8;
                    }
                }
            }
            fs::write(&kept[file].0, bytes).unwrap();
            let ended = case.run(&["--restart"]);
            match ended.code() {
                0 => assert!(datasets(&case.result()) == expected, "seed {seed}"),
                _ => failed_once(&ended, 2, &[names[0], "expected"]),
            }
        }
    });
}

/// A run that is killed repeatedly, at any stage, continues after its last finished load step each time, and arrives at
/// the same bits.
pub fn killed_again_and_again(trials: &mut Trials) {
    let case = |ranks: usize| {
        let mut steps =
            two_block_scene().replacen("[[contact]]\n", "[[contact]]\nfriction = 0.2\n", 1);
        for k in 1..=24 {
            steps += &format!("[[step]]\nscale = {}\n", f64::from(k) / 24.0);
        }
        let case = Case::of(&model(&steps, two_blocks().mesh), 6);
        let ended = case.run_on(ranks, &[]);
        assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
        let expected = datasets(&case.result());
        fs::remove_file(case.result()).unwrap();
        let state = case.folder().join("problem.vtkhdf.unfinished.state");
        let written = |path: &Path| fs::metadata(path).and_then(|of| of.modified()).ok();
        let (mut first, mut kills, mut is_killed) = (Vec::new(), 0_u32, false);
        while !case.result().exists() {
            // With paths relative to the folder, as users do.
            let mut command = program(ranks);
            command.current_dir(case.folder());
            let running = Running::start(command.args(["problem.h5", "--restart"]));
            // Some steps later, at a different stage each time.
            let (mut kept, mut steps) = (written(&state), 0);
            let deadline = Instant::now() + LIMIT;
            while steps < 2 + kills && !case.result().exists() && Instant::now() < deadline {
                thread::sleep(Duration::from_millis(1));
                let now = written(&state);
                if now != kept && now.is_some() {
                    (kept, steps) = (now, steps + 1);
                }
            }
            thread::sleep(Duration::from_millis(u64::from(kills)));
            let all = running.descendants("contact-dd-mpi");
            let one = all.get(kills as usize % ranks);
            if let Some(&one) = one {
                send(one, Signal::KILL);
            }
            is_killed = one.is_some();
            let ended = running.wait(LIMIT);
            assert!(ended.errors().is_empty(), "{}", ended.stderr);
            let begun = ended
                .stdout
                .lines()
                .find_map(|line| line.strip_prefix("step "));
            let begun = begun.and_then(|line| line.split(' ').next()?.parse::<usize>().ok());
            first.extend(begun);
            kills += 1;
        }
        assert!(first.is_sorted() && first.last() > Some(&1), "{first:?}");
        assert!(datasets(&case.result()) == expected);
        let mut files = case.files();
        // A run killed behind its result leaves its lock, which the next one takes over.
        files.retain(|name| !is_killed || name != ".problem.vtkhdf.lock");
        assert_eq!(files, ["problem.h5", "problem.vtkhdf"]);
    };
    for ranks in [1, 3] {
        let name = format!("restarted::after_kills::on_{ranks}_ranks");
        trials.once(&name, move || case(ranks));
    }
}

/// Stops a run of three load steps between the first two.
fn stop_after_one_step(case: &Case, ranks: usize) {
    let ended = stop(case, ranks, "recovering", |running| {
        let all = running.descendants("contact-dd-mpi");
        send(*all.last().unwrap(), Signal::USR1);
    });
    let words = ["interrupted, after 1 of 3 load steps", "--restart"];
    failed_once(&ended, 6, &words);
    assert!(case.files().contains(&"problem.vtkhdf.unfinished".into()));
}

/// A run whose first rank pauses in `phase` until `sent` has sent its signals.
fn stop(case: &Case, ranks: usize, phase: &str, sent: impl FnOnce(&Running)) -> Ended {
    let mut command = program(ranks);
    command.arg(case.problem());
    command.env("CONTACT_DD_END", format!("0 stop {phase}"));
    let running = Running::start(&mut command);
    let first = running.stopped(LIMIT);
    sent(&running);
    send(first, Signal::CONT);
    running.wait(LIMIT)
}

/// A signal at the start of a phase before the sweeps ends the run in that phase, on whichever of the participating
/// ranks it arrives, and leaves no files behind.
pub fn stopped_ahead_of_sweeps(trials: &mut Trials) {
    if cfg!(not(debug_assertions)) {
        return;
    }
    let phases = [
        (
            "creating the outputs",
            "interrupted while creating the outputs",
            true,
        ),
        ("factorizing", "interrupted while factorizing", true),
        ("condensing the load", "interrupted, before", false),
    ];
    for (phase, words, by_first) in phases {
        let name = format!("stopped::while_{}", phase.replace(' ', "_"));
        trials.on_all_ranks(&name, move |ranks| {
            let case = Case::of(&built_in_model("granite", 0), 8);
            let ended = stop(&case, ranks, phase, |running| {
                let first = running.stopped(LIMIT);
                let last = *running.descendants("contact-dd-mpi").last().unwrap();
                send(if by_first { first } else { last }, Signal::TERM);
            });
            failed_once(&ended, 6, &[words, "before a result was written"]);
            assert_eq!(case.files(), ["problem.h5"]);
        });
    }
}

/// A table of the result file or a factor that is in progress when a signal arrives is completed, then the run ends.
pub fn stopped_once_all_is_read(trials: &mut Trials) {
    trials.on_all_ranks("stopped::once_all_is_read", |ranks| {
        let case = Case::of(&built_in_model("granite", 2), 40);
        let mut running = Running::start(program(ranks).arg(case.problem()));
        let deadline = Instant::now() + LIMIT;
        // The result file is created after everything has been read.
        let is_made = || case.files().iter().any(|name| name.ends_with(".part"));
        while !is_made() && Instant::now() < deadline {
            thread::sleep(Duration::from_millis(2));
        }
        let all = running.descendants("contact-dd-mpi");
        assert!(running.is_running(), "the problem is too small");
        send(all[0], Signal::USR1);
        failed_once(
            &running.wait(LIMIT),
            6,
            &["interrupted while ", "before a result was written"],
        );
        assert_eq!(case.files(), ["problem.h5"]);
    });
}
