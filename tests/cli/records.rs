//! Records of random scenes, and comparisons of two records.

use std::collections::BTreeSet;

use contact_dd_partition::model::Model;

use crate::support::scenes::{model, two_block_scene, two_blocks};
use crate::support::solution::difference;
use crate::support::solver::{Case, LIMIT, built};
use crate::support::stress::draw_frictional;
use crate::support::stress::record::comparison::Comparison;
use crate::support::stress::record::{Key, Record, Row};
use crate::support::stress::trial::{Interface, Trial, Verdict};

/// Three scenes.
const OLD: &str = "\
# of a program
suite operator  law   seed verdict exit sweeps newton solves solver       backward seconds why
plane direct    none  7    right   0    1      9      10     newton/dense 1.2e-16  0.50
plane direct    none  8    right   4    -      -      -      -            -        0.10 error: it slides
plane iterative given 7    right   0    6      6      20     newton/bddc  9.0e-15  1.00 springs held it; and more
";

fn record(text: &str) -> Record {
    text.parse().unwrap()
}

/// The old record with a replacement, compared with the original.
#[track_caller]
fn changed(from: &str, to: &str) -> Comparison {
    assert!(OLD.contains(from), "{from}");
    Comparison::new(&record(OLD), &record(&OLD.replacen(from, to, 1)))
}

/// Descriptions of scenes that got worse and of those that improved.
fn words(comparison: &Comparison) -> [Vec<String>; 2] {
    [&comparison.worse, &comparison.better].map(|changes| {
        let words = changes
            .iter()
            .map(|change| format!("{}: {}", change.key, change.words));
        words.collect()
    })
}

#[test]
fn a_record_is_read_as_it_was_written() {
    let read = record(OLD);
    assert_eq!(read.rows.len(), 3);
    let of = |operator: &str, seed| {
        let (suite, operator) = ("plane".into(), operator.into());
        &read.rows[&Key {
            suite,
            operator,
            seed,
        }]
    };
    assert_eq!(of("direct", 7).counts, Some([1, 9, 10]));
    assert_eq!(
        (of("direct", 8).exit, of("direct", 8).counts),
        (Some(4), None)
    );
    assert_eq!(of("iterative", 7).words, "springs held it; and more");
    assert_eq!(record(&read.to_text()), read);
}

#[test]
fn a_broken_record_is_refused_with_its_line() {
    for (from, to, why) in [
        (
            "right   0    1 ",
            "right   0    x ",
            "line 3: `x` is no number of column sweeps",
        ),
        (
            "7    right   0    1",
            "7    write   0    1",
            "line 3: no verdict is called that",
        ),
        (
            "direct    none  8",
            "direct    none  7",
            "line 4: plane direct 7 is there twice",
        ),
        (
            "-        0.10 error: it slides",
            "-",
            "line 4: there is no seconds",
        ),
    ] {
        assert!(OLD.contains(from), "{from}");
        let error = OLD.replacen(from, to, 1).parse::<Record>().unwrap_err();
        assert!(error.starts_with(why), "{error}");
    }
}

#[test]
fn a_scene_that_is_no_longer_right_is_worse_and_the_other_way_round_better() {
    for (to, exit) in [
        ("not-converged 3", 3),
        ("wrong 0", 0),
        ("hung -", -1),
        ("refused 4", 4),
        ("unclear 4", 4),
    ] {
        let comparison = changed("right   0    1 ", &format!("{to} 1 "));
        let verdict = to.split(' ').next().unwrap().replace('-', " ");
        let exit = if exit < 0 {
            "-".to_owned()
        } else {
            exit.to_string()
        };
        let words_of_it = format!("plane direct 7: right (exit 0) | {verdict} (exit {exit})");
        assert_eq!(words(&comparison), [vec![words_of_it.clone()], vec![]]);
        assert!(comparison.is_worse());
        let back = Comparison::new(
            &record(&OLD.replacen("right   0    1 ", &format!("{to} 1 "), 1)),
            &record(OLD),
        );
        assert_eq!(words(&back), [vec![], vec![words_of_it]]);
        assert!(!back.is_worse());
    }
}

#[test]
fn a_wrong_answer_is_worse_than_none() {
    let text = |to: &str| record(&OLD.replacen("right   0    1 ", to, 1));
    let comparison = Comparison::new(&text("not-converged 3 500"), &text("wrong 0 1"));
    assert!(comparison.is_worse());
    assert!(!Comparison::new(&text("wrong 0 1"), &text("not-converged 3 500")).is_worse());
}

#[test]
fn many_more_sweeps_or_solves_and_larger_errors_are_worse() {
    for (from, to, worse) in [
        // An increase by half, and by five.
        (
            "6      6      20 ",
            "11     6      20 ",
            Some("sweeps 6 | 11"),
        ),
        ("6      6      20 ", "10     6      20 ", None),
        (
            "6      6      20 ",
            "6      6      31 ",
            Some("linear solves 20 | 31"),
        ),
        ("6      6      20 ", "6      6      30 ", None),
        ("6      6      20 ", "6      60     20 ", None),
        (
            "9.0e-15",
            "1.1e-14",
            Some("backward error 9.0e-15 | 1.1e-14"),
        ),
        ("9.0e-15", "-      ", Some("backward error 9.0e-15 | inf")),
        ("1.2e-16", "9.9e-15", None),
        // Time alone depends on the machine.
        ("1.00 springs", "9.00 springs", None),
    ] {
        let comparison = changed(from, to);
        let found = comparison.worse.first().map(|change| &change.words[..]);
        assert_eq!(found, worse, "{to}");
        assert_eq!(comparison.is_worse(), worse.is_some());
    }
}

#[test]
fn a_scene_that_is_missing_is_worse_and_one_that_is_added_is_not() {
    let line = OLD.lines().nth(3).unwrap();
    let less = OLD.replace(&format!("{line}\n"), "");
    let comparison = Comparison::new(&record(OLD), &record(&less));
    assert!(comparison.is_worse() && comparison.missing.len() == 1);
    let comparison = Comparison::new(&record(&less), &record(OLD));
    assert!(!comparison.is_worse() && comparison.added == 1);
}

#[test]
fn sums_are_those_of_a_suite_an_operator_and_a_law() {
    let comparison = changed("right   4", "refused   4").to_string();
    let line = |of: &str| {
        let line = comparison
            .lines()
            .find(|line| line.starts_with(of))
            .unwrap();
        line[of.len()..]
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ")
    };
    assert_eq!(
        line("plane direct none"),
        "2 2 100.00 0 | 1 50.00 0 | 1.00 1.00"
    );
    assert_eq!(
        line("plane iterative given"),
        "1 1 100.00 0 | 1 100.00 0 | 1.00 1.00"
    );
    assert_eq!(line("all"), "3 3 100.00 0 | 2 66.67 0 | 1.00 1.00");
}

/// The columns are those that only a run can provide.
#[test]
fn a_row_holds_what_the_program_says_of_a_run() {
    let mut solvers = BTreeSet::new();
    for (seed, interface) in (0..6).flat_map(|seed| {
        [Interface::Direct, Interface::Iterative(4)].map(|interface| (seed, interface))
    }) {
        let mut drawn = draw_frictional(seed, 4);
        drawn.ranks = 0;
        let trial = Trial::with(&drawn, built(), LIMIT, None, interface);
        let row = Row::new(drawn.friction, &trial);
        assert_eq!(row.verdict, Verdict::Right, "{seed}: {}", row.words);
        let Some([sweeps, newton, solves]) = row.counts else {
            assert_eq!((row.exit, row.solver), (Some(4), None));
            continue;
        };
        assert_eq!(row.exit, Some(0));
        // A scene without load needs no linear solve.
        assert!(
            solves >= newton && (newton >= sweeps || newton == 0),
            "{seed}: {sweeps} {newton} {solves}"
        );
        assert!(row.backward.unwrap() <= 1e-14 && row.seconds > 0.0);
        solvers.insert(row.solver.unwrap());
    }
    let known = ["newton/bddc", "newton/dense"].map(str::to_owned);
    assert!(solvers.is_superset(&BTreeSet::from(known)), "{solvers:?}");
}

fn result_of(model: &Model) -> Case {
    let case = Case::of(model, 4);
    case.solve(&[]);
    case
}

#[test]
fn results_are_as_far_from_each_other_as_their_loads() {
    let load = |factor: f64| {
        let text = format!("{}[[step]]\nscale = {factor:?}\n", two_block_scene());
        result_of(&model(&text, two_blocks().mesh))
    };
    let (one, again, more) = (load(1.0), load(1.0), load(1.0 + 1e-9));
    assert_eq!(difference(&one.result(), &again.result()).0, 0.0);
    let (far, dataset) = difference(&one.result(), &more.result());
    assert!((1e-10..1e-8).contains(&far), "{far:e} in {dataset}");
}
