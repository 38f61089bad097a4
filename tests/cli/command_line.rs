//! The command line: documents generated from it, precedence of settings, output, and messages for mistakes.

mod colours;
mod documents;
mod log;
mod mistakes;
mod settings;
use std::fs;

use crate::support::scenes::{model, two_block_scene, two_blocks};
use crate::support::solver::Case;
use contact_dd_partition::example;

/// Two blocks in contact, with `more` appended to their scene.
fn case(more: &str) -> Case {
    let scene = format!("{}\n{more}", two_block_scene());
    Case::of(&model(&scene, two_blocks().mesh), 6)
}

/// The built-in scene granite, which picard can solve, with `more` appended.
fn granite(more: &str) -> Case {
    let granite = example::find("granite").unwrap();
    let scene = format!("{}\n{more}", granite.scene);
    Case::of(&model(&scene, granite.mesh(0).unwrap()), 8)
}

/// The report that a run wrote next to its problem.
fn report(case: &Case) -> serde_json::Value {
    let text = fs::read_to_string(case.folder().join("report.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}
