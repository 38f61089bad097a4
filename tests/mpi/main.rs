//! The program under its launcher: every case for every number of ranks.
//!
//! `MPIEXEC` names the launcher, `mpirun` by default. A case that hangs fails after a minute, and its processes are
//! killed.

#![expect(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test that can't go on has failed"
)]

extern crate contact_dd_trials as support;

mod bad_input;
mod endings;
mod outputs;
mod resting;
mod starting;
mod steps;
mod stopping;
mod sudden_ends;

use std::collections::BTreeMap;
use std::fs;
use std::panic;
use std::process::ExitCode;
use std::sync::{Arc, OnceLock};
use std::thread;
use std::time::{Duration, Instant};

use libtest_mimic::{Arguments, Trial};

use contact_dd_partition::element::ElementKind::Hexahedron8;
use contact_dd_partition::model::Model;
use support::blocks::{jittered, joined};
use support::extruded::extruded;
use support::process::{Ended, Running, send};
use support::scenes::{
    BODIES, JOINT, SUPPORTS, built_in_model, corner, model, two_block_scene, two_blocks,
};
use support::solids::{between, solid};
use support::solution::{Solution, datasets};
use support::solver::{Case, LIMIT, program};
use support::sorts::sort;

/// Numbers of ranks; with few cores, more ranks would only wait for each other.
const RANKS: [usize; 4] = [1, 2, 3, 4];

fn main() -> ExitCode {
    let mut arguments = Arguments::from_args();
    // Most of the time of a case is spent sleeping in the launcher.
    arguments.test_threads.get_or_insert(4);
    // The harness shows the message; this adds the location.
    panic::set_hook(Box::new(|panic| {
        panic.location().inspect(|place| eprintln!("at {place}:"));
    }));
    let mut trials = Trials::default();
    same_results(&mut trials);
    without_stresses(&mut trials);
    trials.once("memory_is_about_what_was_estimated", memory);
    starting::only_where_needed(&mut trials);
    starting::foreign_launchers(&mut trials);
    bad_input::bad_input(&mut trials);
    bad_input::bad_settings(&mut trials);
    bad_input::bad_usage(&mut trials);
    endings::no_equilibrium(&mut trials);
    resting::no_rest(&mut trials);
    resting::just_rest(&mut trials);
    endings::not_converged(&mut trials);
    outputs::unwritable_output(&mut trials);
    outputs::full_disk(&mut trials);
    outputs::the_same_output(&mut trials);
    outputs::full_terminal(&mut trials);
    outputs::little_memory(&mut trials);
    outputs::folder_of_the_root_alone(&mut trials);
    outputs::vanished_folder(&mut trials);
    sudden_ends::sudden_ends(&mut trials);
    sudden_ends::in_an_active_set_step(&mut trials);
    stopping::stopped_once_all_is_read(&mut trials);
    stopping::stopped_ahead_of_sweeps(&mut trials);
    stopping::stopped_while_sweeping(&mut trials);
    stopping::stopped_between_steps(&mut trials);
    stopping::restarted_in_vain(&mut trials);
    stopping::restarted_from_damage(&mut trials);
    stopping::killed_again_and_again(&mut trials);
    steps::no_equilibrium(&mut trials);
    steps::squeezed(&mut trials);
    steps::not_converged(&mut trials);
    libtest_mimic::run(&arguments, trials.0).exit_code()
}

/// The cases added so far.
#[derive(Default)]
struct Trials(Vec<Trial>);

impl Trials {
    /// Adds `case` for every number of ranks.
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

/// Fails unless a run ended with `code` and gave the reason exactly once.
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

type MakeCase = fn() -> Case;

/// A problem and the bits of its solution on one rank.
type Solved = OnceLock<(Case, BTreeMap<String, Vec<u64>>)>;

/// The solution of a problem file has the same bits on any number of ranks and without a launcher.
fn same_results(trials: &mut Trials) {
    let cases: [(&str, MakeCase); 22] = [
        ("granite", || Case::of(&built_in_model("granite", 0), 8)),
        ("granite_in_one_subdomain", || {
            Case::of(&built_in_model("granite", 0), 1)
        }),
        ("granite_in_a_deep_hierarchy", || {
            Case::of(&built_in_model("granite", 0), 70)
        }),
        ("curved_cells_of_three_kinds", || {
            let mesh = sort("triangle6, quad8 and quad9").of(&two_blocks().mesh);
            let mesh = jittered(mesh, 0.008, 5);
            Case::of(&model(&two_block_scene(), mesh), 9)
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
        ("rollers", || Case::of(&built_in_model("rollers", 0), 8)),
        ("stack", || Case::of(&built_in_model("stack", 0), 6)),
        ("many_conditions", || {
            Case::of(&built_in_model("wall", 1), 33)
        }),
        ("stack_without_interface", || {
            Case::of(&built_in_model("stack", 0), 3)
        }),
        ("row", || Case::of(&resting::row([-1e6, 0.0], true), 6)),
        ("fallen", || Case::of(&resting::fallen(), 5)),
        ("mortar", || Case::of(&resting::uneven(), 7)),
        ("in_steps", || Case::of(&steps::two_blocks_in_steps(), 6)),
        ("with_friction_in_steps", || {
            Case::of(&steps::two_blocks_with_friction(), 6)
        }),
        ("in_space", || {
            let plane = sort("quad4").of(&two_blocks().mesh);
            let mesh = extruded(&plane, &[0.0, 0.1, 0.2]);
            let scene = two_block_scene().replace("plane = 'strain'\n", "");
            let held = "[[bilateral]]\non = ['lower back', 'upper back']\n";
            Case::of(&model(&format!("{scene}{held}"), mesh.unwrap()), 9)
        }),
        ("around_an_axis", || {
            let scene = two_block_scene().replace("'strain'", "'axisymmetric'");
            let scene = scene.replace("name = 'joint'", "name = 'joint'\nfriction = 0.3");
            let scene = scene.replace("1.9*x", "1.6*x");
            Case::of(&model(&scene, sort("quad9").of(&two_blocks().mesh)), 9)
        }),
        ("raous", || Case::of(&built_in_model("raous", 0), 7)),
        ("incline", || Case::of(&built_in_model("incline", 0), 4)),
        ("on_circles", || Case::of(&resting::on_circles(), 6)),
    ];
    for (name, make) in cases {
        same_bits(trials, name, make, &[]);
    }
    let iterative: [(&str, MakeCase); 9] = [
        ("between_clusters::in_space", || {
            let lower = solid(
                "lower",
                Hexahedron8,
                [4, 3, 2],
                between([0.0; 3], [1.0, 1.0, 0.5]),
            );
            let upper = between([0.0, 0.0, 0.5], [0.8, 1.0, 1.0]);
            let upper = solid("upper", Hexahedron8, [3, 3, 2], upper);
            let scene = two_block_scene()
                .replace("plane = 'strain'\n", "")
                .replace("bottom", "z0")
                .replace("top", "z1")
                .replace("left", "x0")
                .replace("y = 0.0\n", "y = 0.0\nz = 0.0\n");
            let held = "[[displacement]]\non = 'upper y0'\ny = 0.0\n";
            Case::in_clusters(
                &model(&format!("{scene}{held}"), joined(lower, upper)),
                9,
                6,
            )
        }),
        ("between_clusters::plain", || {
            Case::in_clusters(&built_in_model("plain", 0), 20, 9)
        }),
        ("between_clusters::granite", || {
            Case::in_clusters(&built_in_model("granite", 0), 30, 12)
        }),
        ("between_clusters::stack", || {
            Case::in_clusters(&built_in_model("stack", 0), 20, 7)
        }),
        ("between_clusters::raous", || {
            Case::in_clusters(&built_in_model("raous", 0), 14, 6)
        }),
        ("between_clusters::with_friction_in_steps", || {
            Case::in_clusters(&steps::two_blocks_with_friction(), 12, 6)
        }),
        ("between_clusters::dependent", || {
            Case::in_clusters(&corner([-1e4, -25e3], "friction = 0.3"), 12, 6)
        }),
        ("in_the_tree::dependent", || {
            Case::in_clusters(&corner([-1e4, -25e3], "friction = 0.3"), 12, 1)
        }),
        ("between_clusters::in_steps", || {
            Case::in_clusters(&steps::two_blocks_in_steps(), 12, 6)
        }),
    ];
    for (name, make) in iterative {
        same_bits(trials, name, make, &["--interface", "iterative"]);
    }
}

fn same_bits(trials: &mut Trials, name: &str, make: MakeCase, args: &'static [&'static str]) {
    let alone = Solved::new();
    trials.on_all_ranks(&format!("same_bits::{name}"), move |ranks| {
        let (_, expected) = alone.get_or_init(|| {
            let case = make();
            let ended = case.run(args);
            assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
            let datasets = datasets(&case.result());
            (case, datasets)
        });
        let case = make();
        let ended = case.run_on(ranks, args);
        assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
        let found = datasets(&case.result());
        assert!(found.keys().eq(expected.keys()), "{:?}", found.keys());
        for (name, values) in &found {
            assert!(values == &expected[name], "{name} differs");
        }
        let report = Solution::read_report(&case.result());
        assert_eq!(report["ranks"], ranks);
        assert_eq!(report["hosts"], 1);
        assert_eq!(report["per_rank"].as_array().unwrap().len(), ranks);
        // The certificate is printed once, by whichever rank.
        assert_eq!(ended.stdout.matches("certificate").count(), 1);
        assert_eq!(case.files(), ["problem.h5", "problem.vtkhdf"]);
    });
}

/// Omitting stresses removes them from the file and changes nothing else.
fn without_stresses(trials: &mut Trials) {
    trials.on_all_ranks("without_stresses", |ranks| {
        let case = Case::of(&built_in_model("granite", 0), 8);
        assert_eq!(case.run(&[]).code(), 0);
        let mut expected = datasets(&case.result());
        let with = expected.len();
        expected.retain(|name, _| {
            ["Stress", "VonMises", "EnergyError"]
                .iter()
                .all(|left_out| !name.contains(left_out))
        });
        assert_eq!(expected.len() + 6, with);
        let ended = case.run_on(ranks, &["--no-stress"]);
        assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
        assert!(datasets(&case.result()) == expected);
        assert!(ended.stdout.contains("skipped: stresses"));
    });
}

/// The memory estimated by `--check` is that of a run of the same problem, to within a third.
fn memory() {
    let case = Case::of(&built_in_model("granite", 3), 30);
    let checked = case.run_on(2, &["--check"]);
    assert_eq!(checked.code(), 0, "{}", checked.stderr);
    let mut lines = checked.stdout.lines().map(str::trim_start);
    let line = lines.find(|line| line.starts_with("memory")).unwrap();
    let estimated: f64 = line.split_whitespace().nth(1).unwrap().parse().unwrap();
    assert_eq!(case.run_on(2, &[]).code(), 0);
    let report = Solution::read(&case.result()).report;
    let needed = report["peak_memory_bytes"].as_f64().unwrap() / 1e9;
    let ratio = estimated / needed;
    assert!((0.7..1.4).contains(&ratio), "{estimated} GB, {needed} GB");
}
