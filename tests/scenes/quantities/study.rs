//! Parameter studies: many cases with the factorizations of one run.

use contact_dd_partition::model::Model;
use serde_json::{Value, json};

use super::{COULOMB, FRICTION, KNOBS, Knob, in_plane, plane, quantities, varied};
use crate::support::blocks::Blocks;
use crate::support::scenes::model;
use crate::support::solver::Case;

/// The scene in the plane with this coefficient of friction and increment of its joint's gap.
fn scene(friction: f64, gap: f64) -> Model {
    let knobs: Vec<&Knob> = KNOBS.iter().chain([&FRICTION]).collect();
    let text = plane()
        .replace("@friction@", &format!("{friction:?}"))
        .replace("@gap@", &format!("{gap:?}"));
    let law = COULOMB.replace("@friction@", &format!("{friction:?}"));
    varied(&text, &law, &in_plane("quad4"), &knobs, None)
}

/// The table of a study on `ranks` ranks, and the exit code and messages of the run.
fn table(case: &Case, ranks: usize, asked: &Value, args: &[&str]) -> (Option<Value>, i32, String) {
    let path = case.folder().join("cases.json");
    std::fs::write(&path, asked.to_string()).unwrap();
    let args = [&["--study", path.to_str().unwrap()], args].concat();
    let ended = case.run_on(ranks, &args);
    let written = std::fs::read(case.folder().join("problem.study.json")).ok();
    let table = written.map(|bytes| serde_json::from_slice(&bytes).unwrap());
    (
        table,
        ended.code(),
        format!("{}{}", ended.stdout, ended.stderr),
    )
}

fn asked() -> Value {
    json!({
        "parameters": ["contact 'joint': friction", "contact 'joint': gap"],
        "cases": [[0.3, 0.0], [0.1, 0.0], [0.0, 0.0], [0.5, 1e-6]],
    })
}

#[test]
fn a_case_is_a_run_of_its_own_with_the_same_bits_on_any_number_of_ranks_and_after_any_other_case() {
    let case = Case::of(&scene(0.3, 0.0), 6);
    let (alone, code, printed) = table(&case, 0, &asked(), &[]);
    assert_eq!(code, 0, "{printed}");
    let alone = alone.unwrap();
    for (row, (friction, gap)) in [(0, (0.3, 0.0)), (1, (0.1, 0.0)), (3, (0.5, 1e-6))] {
        let report = Case::of(&scene(friction, gap), 6).solve(&[]).report;
        let all = quantities(&report);
        let names = alone["quantities"].as_array().unwrap().iter();
        let found = alone["cases"][row]["quantities"].as_array().unwrap();
        for (name, found) in names.zip(found) {
            let name = name["name"].as_str().unwrap();
            assert_eq!(*found, all[name]["value"], "{name}, case {row}");
        }
    }
    for ranks in [1, 2, 3, 4] {
        let (found, code, printed) = table(&case, ranks, &asked(), &[]);
        assert_eq!(
            (found.as_ref(), code),
            (Some(&alone), 0),
            "{ranks}: {printed}"
        );
    }
    let mut reversed = asked();
    reversed["cases"].as_array_mut().unwrap().reverse();
    let found = table(&case, 0, &reversed, &[]).0.unwrap();
    let rows = found["cases"].as_array().unwrap().iter().rev();
    assert!(rows.eq(alone["cases"].as_array().unwrap()));
}

#[test]
fn a_case_without_friction_slips_as_without_any() {
    let case = Case::of(&scene(0.3, 0.0), 6);
    let (found, code, printed) = table(&case, 0, &asked(), &["--interface", "iterative"]);
    assert_eq!(code, 0, "{printed}");
    let found = &found.unwrap()["cases"][2]["quantities"];
    let (none, code, _) = table(
        &Case::of(&scene(0.0, 0.0), 6),
        0,
        &json!({"parameters": [], "cases": [[]]}),
        &[],
    );
    assert_eq!(code, 0);
    let none = &none.unwrap()["cases"][0]["quantities"];
    for (found, none) in found
        .as_array()
        .unwrap()
        .iter()
        .zip(none.as_array().unwrap())
    {
        let [found, none] = [found, none].map(|of| of.as_f64().unwrap());
        // Nothing remains of the shear.
        assert!(
            (found - none).abs() <= 1e-8 * none.abs() + 1e-4,
            "{found:e}, {none:e}"
        );
    }
}

/// Only an obstacle below holds a block, which the load of the second case lifts.
#[test]
fn cases_without_equilibrium_are_told_of_and_the_others_solved() {
    let mesh = Blocks::new().rectangle("block", [0.0, 1.0], [0.0, 1.0], [3, 3]);
    let text = "
plane = 'strain'
materials.cork = {young = 1e8, poisson = 0.2}
bodies.block.material = 'cork'
[[displacement]]
on = 'block left'
x = 0
[[pressure]]
on = 'block top'
value = 1e5
[[contact]]
name = 'table'
sides = ['block bottom']
obstacle = {point = [0, 0], normal = [0, 1]}
[[quantity]]
name = 'grip'
kind = 'contact_force'
contact = 'table'
";
    let case = Case::of(&model(text, mesh.mesh), 2);
    let asked =
        json!({"parameters": ["pressure[1] on 'block top'"], "cases": [[1.0], [-1.0], [2.0]]});
    let (found, code, printed) = table(&case, 0, &asked, &[]);
    assert_eq!(code, 3, "{printed}");
    let cases = found.unwrap()["cases"].clone();
    let status = |k: usize| cases[k]["status"].as_str().unwrap().to_owned();
    assert_eq!(
        [status(0), status(1), status(2)],
        ["converged", "ill_posed", "converged"]
    );
    let grip = |k: usize| cases[k]["quantities"][0].as_f64().unwrap();
    assert!((grip(0) - 1e5).abs() < 1e-4 && (grip(2) - 2e5).abs() < 1e-4);
    assert!(cases[1]["why"].as_str().unwrap().contains("block"));
}

#[test]
fn what_a_study_cannot_be_is_refused() {
    let case = Case::of(&scene(0.3, 0.0), 4);
    for (parameter, value, expected) in [
        (
            "materials.rock.young",
            1.0,
            "is a stiffness: a study varies loads",
        ),
        (
            "displacement[1] on 'low bottom': x",
            1.0,
            "is a displacement",
        ),
        ("friction", 0.3, "known are \""),
        ("contact 'joint': friction", -0.1, "of friction 0 or more"),
    ] {
        let asked = json!({"parameters": [parameter], "cases": [[value]]});
        let (found, code, printed) = table(&case, 2, &asked, &[]);
        assert_eq!((found, code), (None, 2), "{printed}");
        assert!(printed.contains(expected), "{printed}");
    }
    let (_, code, printed) = table(&case, 0, &json!({"parameters": [], "cases": [[1.0]]}), &[]);
    assert!(
        code == 2 && printed.contains("case 1 has 1 values; expected 0"),
        "{printed}"
    );
    for (asked, expected) in [
        (
            json!([1]),
            "line 1: it is the number 1; expected a list; the file's form is {\"parameters\"",
        ),
        (
            json!({"parameters": []}),
            "line 1: the key 'cases' is missing",
        ),
        (
            json!({"case": []}),
            "line 1: unknown key 'case'; expected 'parameters' or 'cases'",
        ),
        (
            json!({"parameters": [], "cases": [["1"]]}),
            "line 1: it is the text \"1\"; expected a number",
        ),
    ] {
        let (_, code, printed) = table(&case, 0, &asked, &[]);
        assert!(code == 2 && printed.contains(expected), "{printed}");
    }
    let (_, code, printed) = table(&case, 0, &asked(), &["--restart"]);
    assert!(code == 2 && printed.contains("--restart"), "{printed}");
}
