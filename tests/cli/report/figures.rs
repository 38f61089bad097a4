//! `scripts/figures`, which draws a result: its magnification of displacements.

use std::fs;
use std::path::Path;
use std::process::Command;

use super::summary::{can_draw, set_millimetres};
use crate::support::blocks::Blocks;
use crate::support::process::{Ended, Running};
use crate::support::scenes::{model, two_block_scene, two_blocks};
use crate::support::solver::{Case, LIMIT};

/// The solution for the two blocks, with the upper one above the lower by a gap.
fn solved(gap: f64) -> Case {
    let blocks = match gap {
        0.0 => two_blocks(),
        _ => Blocks::new()
            .rectangle("lower", [0.0, 2.0], [0.0, 1.0], [16, 8])
            .rectangle("upper", [0.5, 1.5], [1.0 + gap, 2.0 + gap], [8, 8]),
    };
    let case = Case::of(&model(&two_block_scene(), blocks.mesh), 4);
    let ended = case.run(&["--quiet"]);
    assert_eq!(ended.code(), 0, "{}", ended.stderr);
    case
}

fn figures(case: &Case, options: &[&str]) -> Ended {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("scripts/figures");
    let mut command = Command::new(script);
    command
        .arg(case.result())
        .arg(case.folder().join("pictures"));
    command.args(["--only", "overview"]).args(options);
    Running::start(&mut command).wait(4 * LIMIT)
}

#[test]
fn gaps_that_close_are_not_enlarged_into_overlaps() {
    if !can_draw() {
        return;
    }
    let apart = solved(0.05);
    let by_itself = figures(&apart, &[]);
    assert_eq!((by_itself.code(), &*by_itself.stderr), (0, ""));
    assert!(apart.folder().join("pictures/overview.png").exists());
    let asked = figures(&apart, &["--scale", "20"]);
    assert_eq!(asked.code(), 0, "{}", asked.stderr);
    let printed = &asked.stderr;
    assert!(
        printed.contains("× 20 enlarges gaps that close") && printed.contains("× 1 isn't"),
        "{printed}"
    );

    let touching = figures(&solved(0.0), &["--scale", "20"]);
    assert_eq!((touching.code(), &*touching.stderr), (0, ""));
}

#[test]
fn a_picture_has_the_units_of_the_scene() {
    if !can_draw() {
        return;
    }
    let case = solved(0.0);
    let picture = || {
        let drawn = figures(&case, &[]);
        assert_eq!((drawn.code(), &*drawn.stderr), (0, ""));
        fs::read(case.folder().join("pictures/overview.png")).unwrap()
    };
    let in_m = picture();
    set_millimetres(&case.result());
    assert!(picture() != in_m);
}

#[test]
fn what_is_no_result_is_not_drawn() {
    if !can_draw() {
        return;
    }
    let case = solved(0.0);
    let mut command = Command::new(Path::new(env!("CARGO_MANIFEST_DIR")).join("scripts/figures"));
    let refused = Running::start(command.arg(case.problem())).wait(4 * LIMIT);
    assert_eq!(refused.code(), 2);
    assert!(
        refused.stderr.contains("is a problem file"),
        "{}",
        refused.stderr
    );
    let refused = figures(&case, &["--scale", "0"]);
    assert_eq!(refused.code(), 2);
    assert!(
        refused
            .stderr
            .contains("expected 'auto' or a number above 0"),
        "{}",
        refused.stderr
    );
}
