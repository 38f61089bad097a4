//! `scripts/summary`, which summarizes a run on one page.

use std::fs;
use std::path::Path;
use std::process::Command;

use hdf5::types::VarLenUnicode;

use crate::support::process::{Ended, Running};
use crate::support::scenes::built_in_model;
use crate::support::solver::{Case, LIMIT};

/// True if a Python with plotting exists; the script would install one.
pub fn can_draw() -> bool {
    let draws = ["python3", "/usr/bin/python3"].iter().any(|python| {
        let mut imported = Command::new(python);
        imported.args(["-c", "import h5py, matplotlib"]);
        imported
            .output()
            .is_ok_and(|output| output.status.success())
    });
    if !draws {
        eprintln!("skipped: there is no Python with h5py and matplotlib");
    }
    draws
}

fn summary(args: &[&Path]) -> Ended {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("scripts/summary");
    // On a busy machine most of the time is the start of Python and its packages.
    Running::start(Command::new(script).args(args)).wait(4 * LIMIT)
}

/// The page of a run of a built-in scene.
fn page(scene: &str, options: &[&str], code: i32) -> String {
    let case = Case::of(&built_in_model(scene, 0), 8);
    let ended = case.run(options);
    assert_eq!(ended.code(), code, "{}{}", ended.stdout, ended.stderr);
    let drawn = summary(&[&case.result()]);
    assert_eq!(drawn.code(), 0, "{}", drawn.stderr);
    fs::read_to_string(case.result().with_extension("html")).unwrap()
}

#[test]
fn a_page_says_how_the_run_ended_and_draws_its_contacts() {
    if !can_draw() {
        return;
    }
    let converged = page("granite", &[], 0);
    let short = page("granite", &["--method", "picard", "--max-sweeps", "3"], 3);
    let linear = page("plain", &[], 0);
    let rough = page("raous", &[], 0);
    assert!(rough.contains("work of friction") && !converged.contains("friction"));
    for (page, badge, pictures) in [
        (&converged, "\"badge good\">converged<", 1),
        (&short, "\"badge bad\">not converged<", 2),
        (&linear, "\"badge good\">converged<", 0),
    ] {
        assert!(page.contains(badge));
        assert_eq!(page.matches("<svg").count(), pictures);
        assert_eq!(page.matches("</svg>").count(), pictures);
        assert!(!page.contains(">nan") && !page.contains("http-equiv"));
    }
    assert!(converged.contains("left crack") && converged.contains("31 of 48"));
    assert!(short.contains("<h2>Warnings</h2>") && !converged.contains("<h2>Warnings</h2>"));
    assert!(linear.contains("No contact"));
    // Numbers that aren't to be used stand behind that sentence.
    let first = "<h2>In short</h2><p>The run did not converge";
    assert!(short.contains(first) && !converged.contains("did not converge"));
    assert!(short.contains("not solved in") && converged.contains(", solved in"));
}

#[test]
fn what_is_no_result_gets_no_page() {
    if !can_draw() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("other.vtkhdf");
    fs::write(&file, "other").unwrap();
    let refused = summary(&[&file]);
    assert_eq!(refused.code(), 2);
    let printed = &refused.stderr;
    assert!(
        printed.contains("other.vtkhdf: isn't a result"),
        "{printed}"
    );
    assert!(!file.with_extension("html").exists());
}

/// Declares mm, N and MPa as the units of a result.
pub fn set_millimetres(result: &Path) {
    let file = hdf5::File::open_rw(result).unwrap();
    let attribute = file.attr("units");
    let attribute = attribute.or_else(|_| file.new_attr::<VarLenUnicode>().create("units"));
    let units: VarLenUnicode = "mm".parse().unwrap();
    attribute.unwrap().write_scalar(&units).unwrap();
}

#[test]
fn a_page_has_the_units_of_the_scene() {
    if !can_draw() {
        return;
    }
    let case = Case::of(&built_in_model("hertz", 0), 4);
    assert_eq!(case.run(&[]).code(), 0);
    let page = || {
        let drawn = summary(&[&case.result()]);
        assert_eq!(drawn.code(), 0, "{}", drawn.stderr);
        fs::read_to_string(case.result().with_extension("html")).unwrap()
    };
    let in_m = page();
    set_millimetres(&case.result());
    let in_mm = page();
    // With the preceding space, as base64 of a picture may contain the three letters in sequence.
    assert!(in_m.contains("-5 N/m<") && !in_m.contains(" MPa"));
    assert!(in_mm.contains("-5 N/mm<") && in_mm.contains(" MPa"));
}

#[test]
fn a_second_result_is_not_taken_for_the_name_of_the_page() {
    if !can_draw() {
        return;
    }
    let case = Case::of(&built_in_model("patch", 0), 2);
    assert_eq!(case.run(&[]).code(), 0);
    let folder = tempfile::tempdir().unwrap();
    let other = folder.path().join("other.vtkhdf");
    fs::write(&other, "other").unwrap();
    let refused = summary(&[&case.result(), &other]);
    assert_eq!(refused.code(), 2);
    let printed = &refused.stderr;
    assert!(
        printed.contains("other.vtkhdf: isn't the name of a page"),
        "{printed}"
    );
    assert_eq!(fs::read_to_string(&other).unwrap(), "other");
}
