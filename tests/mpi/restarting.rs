//! Runs that a signal stops, and those that go on from there.

use std::collections::BTreeSet;

use rustix::process::Signal;
use serde_json::Value;

use super::*;

/// A stopped run leaves a checkpoint, and going on from it has the bits of a run that wasn't stopped,
/// on any number of ranks.
pub fn stopped_and_restarted(trials: &mut Trials) {
    let picard = ["--method", "picard", "--tolerance", "1e-5"];
    let whole: Arc<Solved> = Arc::default();
    let term: (_, &[_]) = ("term", &[Signal::TERM]);
    let on_all_ranks = RANKS.map(|ranks| (term, ranks));
    let others: [((_, &[_]), _); 3] = [
        (("int", &[Signal::INT]), 2),
        (("usr1", &[Signal::USR1]), 3),
        // A batch system asks, and asks again otherwise; only the same one twice ends at once.
        (("usr1_and_term", &[Signal::USR1, Signal::TERM]), 2),
    ];
    for ((name, signals), ranks) in on_all_ranks.into_iter().chain(others) {
        let whole = Arc::clone(&whole);
        trials.once(&format!("stopped::by_{name}_of_{ranks}"), move || {
            let (whole, expected) = whole.get_or_init(|| {
                let case = Case::of(&built_in_model("granite", 0), 8);
                assert_eq!(case.run(&picard).code(), 0);
                let datasets = datasets(&case.result());
                (case, datasets)
            });
            let folder = tempfile::tempdir().unwrap();
            let result = folder.path().join("result.vtkhdf");
            let checkpoint = folder.path().join("result.vtkhdf.checkpoint");
            fs::write(&result, "an older result").unwrap();
            let start = |ranks: usize, more: &[&str]| {
                let mut command = program(ranks);
                command.arg(whole.problem()).arg("-o").arg(&result);
                command.args(picard).args(more);
                Running::start(&mut command)
            };
            // Written after every sweep, of which there are dozens.
            let mut running = start(ranks, &["--checkpoint-every", "1"]);
            let deadline = Instant::now() + LIMIT;
            while !checkpoint.exists() && running.is_running() && Instant::now() < deadline {
                thread::sleep(Duration::from_millis(2));
            }
            let all = running.descendants("contact-dd-mpi");
            // It is enough that one hears of it.
            let Some(&last) = all.last() else {
                panic!("{:?}", running.wait(LIMIT));
            };
            signals.iter().for_each(|&signal| send(last, signal));
            let ended = running.wait(LIMIT);
            failed_once(&ended, 6, &["interrupted after", "--restart"]);
            assert_eq!(fs::read_to_string(&result).unwrap(), "an older result");

            let ended = start(1 + ranks % 4, &["--restart"]).wait(LIMIT);
            assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
            assert!(&datasets(&result) == expected);
            assert_eq!(names_in(folder.path()), ["result.vtkhdf"]);
        });
    }
}

/// Every method remembers all that its next sweep depends on.
pub fn every_sweep(trials: &mut Trials) {
    let methods = [
        ("newton", "1e-10", 1),
        ("anderson", "1e-10", 5),
        ("picard", "1e-3", 3),
    ];
    for (method, tolerance, at_least) in methods {
        trials.on_all_ranks(&format!("every_sweep::of_{method}"), move |ranks| {
            let case = Case::of(&built_in_model("granite", 0), 8);
            let method = ["--method", method, "--tolerance", tolerance];
            let whole = case.run_on(ranks, &method);
            let code = whole.code();
            let expected = datasets(&case.result());
            let sweeps = Solution::read(&case.result()).sweeps();
            assert!(sweeps >= at_least, "{sweeps}");
            for sweep in BTreeSet::from([1, sweeps.div_ceil(2), sweeps]) {
                let count = sweep.to_string();
                let stop = ["--max-sweeps", &count, "--checkpoint-every", &count];
                let stopped = case.run_on(ranks, &[&method[..], &stop].concat());
                let is_last = stopped.code() == 0;
                let on = case.run_on(ranks, &[&method[..], &["--restart"]].concat());
                assert_eq!(on.code(), code, "{}{}", on.stdout, on.stderr);
                assert_eq!(on.stdout.contains("no good checkpoint"), is_last);
                assert!(datasets(&case.result()) == expected, "{count} sweeps");
            }
        });
    }
}

/// What isn't a checkpoint of this run is refused, what is damaged isn't gone on from.
pub fn other_checkpoints(trials: &mut Trials) {
    let granite = || Case::of(&built_in_model("granite", 0), 8);
    let picard = ["--method", "picard", "--tolerance", "1e-4"];
    let leave = move |case: &Case, ranks| {
        let stop = ["--max-sweeps", "7", "--checkpoint-every", "3"];
        let stopped = case.run_on(ranks, &[&picard[..], &stop].concat());
        assert_eq!(stopped.code(), 3);
        let [newest, older] = ["problem.vtkhdf.checkpoint", "problem.vtkhdf.checkpoint.old"];
        [newest, older].map(|name| case.folder().join(name))
    };
    trials.on_all_ranks("other_checkpoints::of_another_problem", move |ranks| {
        let case = granite();
        leave(&case, ranks);
        let other = Case::of(&built_in_model("granite", 0), 7);
        fs::copy(other.problem(), case.problem()).unwrap();
        let ended = case.run_on(ranks, &[&picard[..], &["--restart"]].concat());
        failed_once(&ended, 2, &["checkpoint", "another problem"]);
    });
    trials.on_all_ranks("other_checkpoints::of_another_method", move |ranks| {
        let case = granite();
        leave(&case, ranks);
        let ended = case.run_on(ranks, &["--restart"]);
        failed_once(&ended, 2, &["checkpoint", "--method picard"]);
    });
    trials.on_all_ranks("other_checkpoints::damaged", move |ranks| {
        let case = granite();
        assert_eq!(case.run_on(ranks, &picard).code(), 0);
        let expected = datasets(&case.result());
        let [newest, older] = leave(&case, ranks);
        let restart = [&picard[..], &["--restart"]].concat();
        let mut bytes = fs::read(&newest).unwrap();
        let middle = bytes.len() / 2;
        bytes[middle] ^= 1;
        fs::write(&newest, &bytes).unwrap();
        let from_older = case.run_on(ranks, &restart);
        assert_eq!(from_older.code(), 0, "{}", from_older.stderr);
        let said = [from_older.stderr, from_older.stdout].concat();
        assert!(said.contains("damaged") && !said.contains("begins at the start"));
        assert!(datasets(&case.result()) == expected);

        leave(&case, ranks);
        fs::write(&newest, &bytes[..middle]).unwrap();
        fs::write(&older, "").unwrap();
        let from_start = case.run_on(ranks, &restart);
        assert_eq!(from_start.code(), 0, "{}", from_start.stderr);
        let said = [from_start.stderr, from_start.stdout].concat();
        assert!(said.contains("this run begins at the start"));
        assert!(datasets(&case.result()) == expected);
        assert_eq!(case.files(), ["problem.h5", "problem.vtkhdf"]);
    });
}

/// A checkpoint that can't be written is a warning, and one only.
pub fn unwritable(trials: &mut Trials) {
    trials.on_all_ranks("unwritable_checkpoints", |ranks| {
        let case = Case::of(&built_in_model("granite", 0), 8);
        let in_the_way = case.folder().join("problem.vtkhdf.checkpoint.old");
        fs::create_dir_all(in_the_way.join("a folder")).unwrap();
        let picard = ["--method", "picard", "--tolerance", "1e-3", "--report"];
        let report = case.folder().join("report.json");
        let every = [report.to_str().unwrap(), "--checkpoint-every", "1"];
        let ended = case.run_on(ranks, &[&picard[..], &every].concat());
        assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
        let report: Value = serde_json::from_str(&fs::read_to_string(report).unwrap()).unwrap();
        assert!(report["sweeps"].as_u64().unwrap() > 2);
        let warnings = report["warnings"].as_array().unwrap().iter();
        let of_it = warnings.filter(|w| w.as_str().unwrap().contains("checkpoint.old"));
        assert_eq!(of_it.count(), 1, "{report}");
    });
}

/// Before the first sweep there is nothing to keep.
pub fn stopped_while_factorizing(trials: &mut Trials) {
    trials.on_all_ranks("stopped::while_factorizing", |ranks| {
        let case = Case::of(&built_in_model("granite", 2), 40);
        let mut running = Running::start(program(ranks).arg(case.problem()));
        let deadline = Instant::now() + LIMIT;
        // The result file is made when everything is read.
        while case.files().len() < 2 && Instant::now() < deadline {
            thread::sleep(Duration::from_millis(2));
        }
        let all = running.descendants("contact-dd-mpi");
        assert!(running.is_running(), "the problem is too small");
        send(all[0], Signal::USR1);
        failed_once(&running.wait(LIMIT), 6, &["while factorizing"]);
        assert_eq!(case.files(), ["problem.h5"]);
    });
}
