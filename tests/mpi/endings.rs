//! Runs that end otherwise than with a solution: on every rank alike.

use super::*;

/// A free rigid motion with load along it ends with 4 and the name of the body.
pub fn no_equilibrium(trials: &mut Trials) {
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
pub fn not_converged(trials: &mut Trials) {
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
            failed_once(&run(&case, ranks, args), 5, &[args[1]]);
            let parts = case.files().into_iter().filter(|f| f.ends_with(".part"));
            assert_eq!(parts.count(), 0);
        });
    }
}

/// The end of one rank is the end of all.
pub fn killed_rank(trials: &mut Trials) {
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
