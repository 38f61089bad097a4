//! The program under its launcher: every case once for every number of ranks.
//!
//! `MPIEXEC` names the launcher, `mpirun` by default. A case that hangs fails after a minute, and
//! its processes are ended.

#![expect(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test that can't go on has failed"
)]

mod support;

use std::collections::BTreeMap;
use std::fs;
use std::panic;
use std::process::ExitCode;
use std::sync::{Arc, OnceLock};
use std::thread;
use std::time::{Duration, Instant};

use hdf5::types::TypeDescriptor;
use hdf5::{File, H5Type};
use libtest_mimic::{Arguments, Trial};

use support::process::{Ended, Running, is_alive, kill};
use support::scenes::{
    BODIES, JOINT, SUPPORTS, built_in_model, model, two_block_scene, two_blocks,
};
use support::solution::Solution;
use support::solver::{Case, LIMIT, program};

/// Numbers of ranks; there are few cores, so that more would only wait for each other.
const RANKS: [usize; 4] = [1, 2, 3, 4];

fn main() -> ExitCode {
    let mut arguments = Arguments::from_args();
    // Most of a case's time is the launcher's, which sleeps.
    arguments.test_threads.get_or_insert(4);
    // The harness shows the message; what it doesn't know is the place.
    panic::set_hook(Box::new(|panic| {
        panic.location().inspect(|place| eprintln!("at {place}:"));
    }));
    let mut trials = Trials::default();
    same_results(&mut trials);
    bad_input(&mut trials);
    bad_usage(&mut trials);
    no_equilibrium(&mut trials);
    not_converged(&mut trials);
    unwritable_output(&mut trials);
    killed_rank(&mut trials);
    libtest_mimic::run(&arguments, trials.0).exit_code()
}

/// The cases so far.
#[derive(Default)]
struct Trials(Vec<Trial>);

impl Trials {
    /// Adds `case` once for every number of ranks.
    fn on_all_ranks(&mut self, name: &str, case: impl Fn(usize) + Send + Sync + 'static) {
        let case = Arc::new(case);
        for ranks in RANKS {
            let case = Arc::clone(&case);
            self.once(&format!("{name}::on_{ranks}_ranks"), move || case(ranks));
        }
    }

    fn once(&mut self, name: &str, case: impl FnOnce() + Send + 'static) {
        let trial = Trial::test(name, move || {
            case();
            Ok(())
        });
        self.0.push(trial);
    }
}

/// Runs a case on so many ranks.
fn run(case: &Case, ranks: usize, args: &[&str]) -> Ended {
    Running::start(program(ranks).arg(case.problem()).args(args)).wait(LIMIT)
}

/// Fails unless a run ended with `code` and said why exactly once.
#[track_caller]
fn failed_once(ended: &Ended, code: i32, words: &[&str]) {
    assert_eq!(ended.code(), code, "{}{}", ended.stdout, ended.stderr);
    let errors = ended.errors();
    assert_eq!(errors.len(), 1, "{}{}", ended.stdout, ended.stderr);
    for word in words {
        assert!(errors[0].contains(word), "{}\nlacks '{word}'", errors[0]);
    }
    assert!(!ended.stderr.contains("panicked"), "{}", ended.stderr);
    assert!(!ended.stderr.contains("HDF5-DIAG"), "{}", ended.stderr);
}

/// Every dataset of a result file that doesn't speak of time, bit by bit.
fn datasets(case: &Case) -> BTreeMap<String, Vec<u64>> {
    let file = File::open(case.result()).unwrap();
    let mut all = BTreeMap::new();
    let mut groups = vec![file.group("/").unwrap()];
    while let Some(group) = groups.pop() {
        groups.extend(group.groups().unwrap());
        for dataset in group.datasets().unwrap() {
            fn bits<T: H5Type>(dataset: &hdf5::Dataset, as_bits: impl Fn(&T) -> u64) -> Vec<u64> {
                dataset
                    .read_raw::<T>()
                    .unwrap()
                    .iter()
                    .map(as_bits)
                    .collect()
            }
            let values = match dataset.dtype().unwrap().to_descriptor().unwrap() {
                TypeDescriptor::Float(_) => bits::<f64>(&dataset, |x| x.to_bits()),
                _ => bits::<i64>(&dataset, |x| *x as u64),
            };
            all.insert(dataset.name(), values);
        }
    }
    all.retain(|name, _| !name.ends_with("/seconds"));
    all
}

type MakeCase = fn() -> Case;

/// One problem file has one answer: the same bits on any number of ranks and without a launcher.
fn same_results(trials: &mut Trials) {
    let cases: [(&str, MakeCase); 7] = [
        ("granite", || Case::of(&built_in_model("granite", 0), 8)),
        ("granite_in_one_subdomain", || {
            Case::of(&built_in_model("granite", 0), 1)
        }),
        ("more_ranks_than_subdomains", || {
            Case::of(&model(&two_block_scene(), two_blocks().mesh), 2)
        }),
        ("two_blocks", || {
            Case::of(&model(&two_block_scene(), two_blocks().mesh), 9)
        }),
        ("without_contact", || {
            Case::of(&built_in_model("plain", 0), 4)
        }),
        ("junction", || Case::of(&built_in_model("junction", 0), 6)),
        ("stack", || Case::of(&built_in_model("stack", 0), 6)),
    ];
    for (name, make) in cases {
        let alone: OnceLock<(Case, BTreeMap<String, Vec<u64>>)> = OnceLock::new();
        trials.on_all_ranks(&format!("same_bits::{name}"), move |ranks| {
            let (_, expected) = alone.get_or_init(|| {
                let case = make();
                let ended = case.run(&[]);
                assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
                let datasets = datasets(&case);
                (case, datasets)
            });
            let case = make();
            let ended = run(&case, ranks, &[]);
            assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
            let found = datasets(&case);
            assert!(found.keys().eq(expected.keys()), "{:?}", found.keys());
            for (name, values) in &found {
                assert!(values == &expected[name], "{name} differs");
            }
            let report = Solution::read(&case.result()).report;
            assert_eq!(report["ranks"], ranks);
            assert_eq!(report["per_rank"].as_array().unwrap().len(), ranks);
            // The title of the run stands once, whoever printed it.
            assert_eq!(ended.stdout.matches("certificate").count(), 1);
            assert_eq!(case.files(), ["problem.h5", "problem.vtkhdf"]);
        });
    }
}

/// What is wrong with a problem file that was right.
type Damage = fn(&Case);

fn damaged() -> [(&'static str, Damage, &'static [&'static str]); 8] {
    [
        (
            "missing",
            |case| fs::remove_file(case.problem()).unwrap(),
            &["problem.h5"],
        ),
        (
            "a_folder",
            |case| {
                fs::remove_file(case.problem()).unwrap();
                fs::create_dir(case.problem()).unwrap();
            },
            &["problem.h5"],
        ),
        (
            "no_hdf5",
            |case| fs::write(case.problem(), "not at all HDF5").unwrap(),
            &["problem.h5", "HDF5"],
        ),
        (
            "truncated",
            |case| {
                let length = fs::metadata(case.problem()).unwrap().len();
                let file = fs::File::options().write(true).open(case.problem());
                file.unwrap().set_len(length * 2 / 3).unwrap();
            },
            &["problem.h5"],
        ),
        (
            "without_a_dataset",
            |case| open(case).unlink("interface/node").unwrap(),
            &["problem.h5", "interface/node"],
        ),
        (
            "without_contact_gaps",
            |case| open(case).unlink("contact/gap").unwrap(),
            &["problem.h5", "contact/gap"],
        ),
        (
            "with_a_wild_node_in_the_last_subdomain",
            |case| {
                let dataset = open(case).dataset("VTKHDF/Connectivity").unwrap();
                let mut nodes: Vec<i64> = dataset.read_raw().unwrap();
                *nodes.last_mut().unwrap() = 1 << 40;
                dataset.write_raw(&nodes).unwrap();
            },
            &["problem.h5", "Connectivity"],
        ),
        (
            "with_a_point_that_is_no_number",
            |case| {
                let dataset = open(case).dataset("VTKHDF/Points").unwrap();
                let mut points: Vec<f64> = dataset.read_raw().unwrap();
                *points.last_mut().unwrap() = f64::NAN;
                dataset.write_raw(&points).unwrap();
            },
            &["problem.h5", "Points"],
        ),
    ]
}

fn open(case: &Case) -> File {
    File::open_rw(case.problem()).unwrap()
}

/// Bad input ends with 2 and one message, whichever ranks notice it; no result is touched.
fn bad_input(trials: &mut Trials) {
    for (name, damage, words) in damaged() {
        trials.on_all_ranks(&format!("bad_input::{name}"), move |ranks| {
            let case = Case::of(&model(&two_block_scene(), two_blocks().mesh), 6);
            damage(&case);
            fs::write(case.result(), "the result of yesterday").unwrap();
            let files = case.files();
            failed_once(&run(&case, ranks, &[]), 2, words);
            assert_eq!(case.files(), files);
            let result = fs::read_to_string(case.result()).unwrap();
            assert_eq!(result, "the result of yesterday");
        });
    }
}

fn bad_usage(trials: &mut Trials) {
    let usages: [(&str, &[&str], &str); 5] = [
        ("unknown_flag", &["--metod", "newton"], "--metod"),
        ("unknown_method", &["--method", "newtn"], "newtn"),
        ("negative_tolerance", &["--tolerance=-1"], "tolerance"),
        ("no_thread", &["--threads", "0"], "threads"),
        ("two_problems", &["another.h5"], "another.h5"),
    ];
    for (name, args, word) in usages {
        trials.on_all_ranks(&format!("bad_usage::{name}"), move |ranks| {
            let case = Case::of(&model(&two_block_scene(), two_blocks().mesh), 2);
            failed_once(&run(&case, ranks, args), 2, &[word]);
            assert_eq!(case.files(), ["problem.h5"]);
        });
    }
    trials.on_all_ranks("bad_usage::no_problem", |ranks| {
        failed_once(&Running::start(&mut program(ranks)).wait(LIMIT), 2, &[]);
    });
    trials.on_all_ranks("check_writes_nothing", |ranks| {
        let case = Case::of(&model(&two_block_scene(), two_blocks().mesh), 6);
        let ended = run(&case, ranks, &["--check"]);
        assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
        assert_eq!(
            ended.stdout.matches("9 conditions").count(),
            1,
            "{}",
            ended.stdout
        );
        assert_eq!(case.files(), ["problem.h5"]);
    });
}

/// A free rigid motion with load along it ends with 4 and the name of the body.
fn no_equilibrium(trials: &mut Trials) {
    let lifted = "[[traction]]\non = 'upper top'\nvalue = [0.0, 1e6]\n";
    let pushed = "[[traction]]\non = 'upper top'\nvalue = [1e5, -1e6]\n";
    let toppled = "[[pressure]]\non = 'upper top'\nvalue = '1e6*(0.6-x)'\n[[traction]]\non = 'upper top'\nvalue = [0.0, -5e5]\n";
    let scenes = [
        ("lifted", format!("{BODIES}{SUPPORTS}{JOINT}{lifted}")),
        (
            "pushed_aside",
            format!("{BODIES}{}{JOINT}{pushed}", lower_support()),
        ),
        (
            "toppled",
            format!("{BODIES}{}{JOINT}{toppled}", lower_support()),
        ),
        (
            "not_touched_at_all",
            format!("{BODIES}{}{lifted}", lower_support()),
        ),
    ];
    for (name, scene) in scenes {
        trials.on_all_ranks(&format!("no_equilibrium::{name}"), move |ranks| {
            let case = Case::of(&model(&scene, two_blocks().mesh), 6);
            failed_once(&run(&case, ranks, &[]), 4, &["upper"]);
            assert_eq!(case.files(), ["problem.h5"]);
        });
    }
}

/// Nothing holds the upper block but contact.
fn lower_support() -> &'static str {
    SUPPORTS
        .split("[[displacement]]\non = 'upper left'")
        .next()
        .unwrap_or_default()
}

/// Results that aren't converged are written and flagged; the message names a way out.
fn not_converged(trials: &mut Trials) {
    let methods: [(&str, &[&str]); 3] = [
        (
            "literal_picard",
            &["--method", "picard", "--relaxation", "1"],
        ),
        (
            "few_picard_sweeps",
            &["--method", "picard", "--max-sweeps", "2"],
        ),
        ("no_newton_sweep", &["--max-sweeps", "0"]),
    ];
    for (name, args) in methods {
        trials.on_all_ranks(&format!("not_converged::{name}"), move |ranks| {
            let case = Case::of(&built_in_model("granite", 0), 8);
            let words: &[&str] = match args.contains(&"picard") {
                true => &["not converged", "--method newton"],
                false => &["not converged"],
            };
            failed_once(&run(&case, ranks, args), 3, words);
            assert_eq!(case.files(), ["problem.h5", "problem.vtkhdf"]);
            let report = Solution::read(&case.result()).report;
            assert_eq!(report["status"], "not_converged");
        });
    }
}

fn unwritable_output(trials: &mut Trials) {
    let outputs: [(&str, &[&str]); 4] = [
        ("no_folder", &["-o", "/nowhere/at/all/result.vtkhdf"]),
        ("a_folder", &["-o", "/tmp"]),
        ("a_device", &["-o", "/dev/full"]),
        ("report", &["--report", "/nowhere/at/all/report.json"]),
    ];
    for (name, args) in outputs {
        trials.on_all_ranks(&format!("unwritable_output::{name}"), move |ranks| {
            let case = Case::of(&model(&two_block_scene(), two_blocks().mesh), 3);
            failed_once(&run(&case, ranks, args), 5, &[args[1]]);
            let parts = case.files().into_iter().filter(|f| f.ends_with(".part"));
            assert_eq!(parts.count(), 0);
        });
    }
}

/// The end of one rank is the end of all.
fn killed_rank(trials: &mut Trials) {
    let case: OnceLock<Case> = OnceLock::new();
    let case = Arc::new(case);
    for ranks in RANKS.into_iter().filter(|&ranks| ranks > 1) {
        let case = Arc::clone(&case);
        trials.once(&format!("killed_rank::of_{ranks}"), move || {
            let case = case.get_or_init(|| Case::of(&built_in_model("granite", 3), 8));
            let result = case.folder().join(format!("{ranks}.vtkhdf"));
            let mut command = program(ranks);
            command.arg(case.problem()).arg("-o").arg(&result);
            let mut running = Running::start(&mut command);
            let deadline = Instant::now() + Duration::from_secs(20);
            let mut all = Vec::new();
            while all.len() < ranks && Instant::now() < deadline {
                thread::sleep(Duration::from_millis(20));
                all = running.descendants("contact-dd-mpi");
            }
            assert_eq!(all.len(), ranks);
            // By then they are in the midst of it.
            thread::sleep(Duration::from_millis(700));
            assert!(running.is_running(), "the problem is too small");
            let began = Instant::now();
            kill(all[ranks - 1]);
            let ended = running.wait(LIMIT);
            assert_ne!(ended.code(), 0, "{}", ended.stderr);
            assert!(
                began.elapsed() < Duration::from_secs(15),
                "{:?}",
                began.elapsed()
            );
            // The launcher doesn't wait until the system has buried them.
            let deadline = Instant::now() + Duration::from_secs(5);
            while all.iter().any(|&id| is_alive(id)) {
                assert!(Instant::now() < deadline, "a rank lives on");
                thread::sleep(Duration::from_millis(20));
            }
            assert!(!result.exists());
        });
    }
}
