//! Invalid input and usage: exit code 2, one message, no file lost.

use hdf5::File;

use super::*;

/// An error introduced into a valid problem file.
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
    // A process that another test is starting may have inherited the lock of an open file.
    let mut options = File::with_options();
    options.with_fapl(|access| access.file_locking(false));
    options.open_rw(case.problem()).unwrap()
}

/// Invalid input ends with 2 and one message, on any rank; no result is changed.
pub fn bad_input(trials: &mut Trials) {
    for (name, damage, words) in damaged() {
        trials.on_all_ranks(&format!("bad_input::{name}"), move |ranks| {
            let case = Case::of(&model(&two_block_scene(), two_blocks().mesh), 6);
            damage(&case);
            fs::write(case.result(), "the result of yesterday").unwrap();
            let files = case.files();
            failed_once(&case.run_on(ranks, &[]), 2, words);
            assert_eq!(case.files(), files);
            let result = fs::read_to_string(case.result()).unwrap();
            assert_eq!(result, "the result of yesterday");
        });
    }
}

/// Invalid settings in the problem.
pub fn bad_settings(trials: &mut Trials) {
    trials.on_all_ranks("bad_settings::in_the_problem", |ranks| {
        let scene = format!("{}\n[solver]\ntolerance = 1e-8\n", two_block_scene());
        let case = Case::of(&model(&scene, two_blocks().mesh), 2);
        let settings = open(&case).group("settings").unwrap();
        let tolerance = settings.attr("tolerance").unwrap();
        tolerance.write_scalar(&-1.0).unwrap();
        // Open attributes aren't written yet.
        drop((settings, tolerance));
        let words = ["problem.h5", "tolerance of /settings", "above 0"];
        failed_once(&case.run_on(ranks, &[]), 2, &words);
        assert_eq!(case.files(), ["problem.h5"]);
    });
}

pub fn bad_usage(trials: &mut Trials) {
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
            failed_once(&case.run_on(ranks, args), 2, &[word]);
            assert_eq!(case.files(), ["problem.h5"]);
        });
    }
    trials.on_all_ranks("bad_usage::no_problem", |ranks| {
        failed_once(&Running::start(&mut program(ranks)).wait(LIMIT), 2, &[]);
    });
    trials.on_all_ranks("check_writes_nothing", |ranks| {
        let case = Case::of(&model(&two_block_scene(), two_blocks().mesh), 6);
        let ended = case.run_on(ranks, &["--check"]);
        assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
        assert_eq!(
            ended.stdout.matches("contact      9 conditions").count(),
            1,
            "{}",
            ended.stdout
        );
        assert_eq!(case.files(), ["problem.h5"]);
    });
}
