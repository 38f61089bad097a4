//! The command line: documents that are made of it, settings and who settles them, what is printed,
//! and what is said of mistakes.

mod colours;
mod documents;
mod log;
mod mistakes;
mod settings;
use std::fs;

use crate::support::scenes::{model, two_block_scene, two_blocks};
use crate::support::solver::Case;
use contact_dd_partition::example;

/// Two blocks in contact, of a scene that ends with `more`.
fn case(more: &str) -> Case {
    let scene = format!("{}\n{more}", two_block_scene());
    Case::of(&model(&scene, two_blocks().mesh), 6)
}

/// The built-in scene of that name, which picard can solve, with `more` at its end.
fn granite(more: &str) -> Case {
    let granite = example::find("granite").unwrap();
    let scene = format!("{}\n{more}", granite.scene);
    Case::of(&model(&scene, granite.mesh(0).unwrap()), 8)
}

/// The report that a run wrote beside its problem.
fn report(case: &Case) -> serde_json::Value {
    let text = fs::read_to_string(case.folder().join("report.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}
