//! The documents: every command on a page works as printed, every link has a target, and VTK reads the files as the
//! pages claim. The tests of the Python package are here, too, as they need the same Python.
//!
//! A page is run in a fresh folder, its blocks in order:
//!
//! - `sh` and `bash` are shell scripts that have to end with 0;
//! - `console` contains commands after `$ ` with their output; a command that fails has to be followed by `$ echo $?`;
//! - `python` is run by the documents' Python;
//! - any block after a paragraph that ends with a file's name in backticks and a colon is written to that file;
//! - `text` after a paragraph that ends with "prints:" is the expected output of the block before.
//!
//! In the output `…` matches any text within a line; as a line of its own it matches any number of lines. A block that
//! can't be run here is preceded by a comment `<!-- not run: reason -->`, or, for all following blocks, `<!-- none of
//! this page is run: reason -->`; any other block that isn't run is an error.
//!
//! `DOCUMENTS_PYTHON` names the Python, which `scripts/setup --documents` installs; without it the tests that need it
//! are ignored. `DOCUMENTS_KEEP` names a folder that keeps the pages' output.

mod block;
mod book;
mod code;
mod figures;
mod links;
mod package;
mod page;
mod printed;
mod release;
mod run;
mod troubleshooting;
mod vtk;

use std::sync::Arc;

use libtest_mimic::Trial;

use crate::{gallery, trial};

use page::Page;

pub fn trials() -> Vec<Trial> {
    let pages: Arc<Vec<Page>> = Arc::new(page::all());
    let mut trials = Vec::new();
    for index in 0..pages.len() {
        let name = &pages[index].name;
        let all = Arc::clone(&pages);
        trials.push(trial(format!("{name}::links_lead_somewhere"), move || {
            links::lead_somewhere(&all[index], &all);
        }));
        let all = Arc::clone(&pages);
        trials.push(trial(format!("{name}::names_of_code_exist"), move || {
            code::names_exist(&all[index]);
        }));
        let all = Arc::clone(&pages);
        let runs = trial(format!("{name}::runs_as_printed"), move || {
            let folder = run::as_printed(&all[index]);
            gallery::numbers_hold(&all[index].name, folder.path());
        });
        trials.push(match pages[index].needs_python() {
            true => needs_python(runs),
            false => runs,
        });
    }
    let all = Arc::clone(&pages);
    trials.push(trial("the_book_holds_every_page", move || {
        book::holds_every_page(&all);
    }));
    trials.push(needs_python(trial("the_book_is_whole", book::is_whole)));
    trials.push(trial(
        "figures_of_readme_stand_in_their_tables",
        figures::of_readme,
    ));
    trials.push(trial("figures_are_told_apart", figures::are_told_apart));
    trials.push(trial(
        "troubleshooting_quotes_messages",
        troubleshooting::quotes_messages,
    ));
    trials.push(trial(
        "troubleshooting_explains_every_message",
        troubleshooting::explains_every_message,
    ));
    trials.push(trial(
        "messages_are_found_in_calls",
        troubleshooting::finds_messages,
    ));
    trials.push(trial("a_release_solves", release::solves));
    trials.push(trial("a_page_is_split_into_its_blocks", block::are_split));
    trials.push(trial("unmarked_blocks_are_refused", block::refuse_unmarked));
    trials.push(trial("dots_stand_for_anything", printed::dots));
    trials.push(trial(
        "failures_that_the_page_hides_fail",
        run::show_failures,
    ));
    for file in package::tests() {
        let name = format!("python::{}", file.display());
        trials.push(needs_python(trial(name, move || package::passes(&file))));
    }
    for case in &vtk::CASES {
        let name = format!("vtk_reads_what_h5py_reads::{}", case.name);
        trials.push(needs_python(trial(name, || vtk::reads_the_same(case))));
    }
    trials
}

/// Ignores a test, with the reason, if there is no Python for the documents.
fn needs_python(trial: Trial) -> Trial {
    match run::python() {
        Some(_) => trial,
        None => trial
            .with_ignored_flag(true)
            .with_kind("needs DOCUMENTS_PYTHON"),
    }
}
