//! The book that `scripts/book` generates from the pages.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Component, Path, PathBuf};
use std::process::Command;

use super::links::in_repository;
use super::page::{Page, root};
use super::run::Folder;

/// The table of contents of the book.
const SUMMARY: &str = "docs/SUMMARY.md";

/// A test: each page is in the book exactly once.
pub fn holds_every_page(pages: &[Page]) {
    let summary = pages.iter().find(|page| page.name == SUMMARY).unwrap();
    let mut chapters: Vec<String> = (summary.links.iter())
        .map(|link| in_repository(summary, &link.file).display().to_string())
        .collect();
    chapters.sort();
    let names = pages.iter().map(|page| page.name.clone());
    let mut wanted: Vec<String> = names.filter(|name| name != SUMMARY).collect();
    wanted.sort();
    assert_eq!(chapters, wanted);
}

/// A test: the book is complete, its links lead to files and headings, and its search finds words.
pub fn is_whole() {
    let folder = Folder::new();
    let book = folder.path().join("book");
    let ended = folder.run(Command::new(root().join("scripts/book")).arg(&book));
    assert_eq!(ended.code(), 0, "{}", ended.stderr);
    let mut files = BTreeSet::new();
    files_in(&book, &mut files);
    let pages: BTreeMap<&PathBuf, String> = (files.iter())
        .filter(|file| file.extension().is_some_and(|ending| ending == "html"))
        // Only these two don't correspond to one page.
        .filter(|file| !file.ends_with("404.html") && !file.ends_with("print.html"))
        .map(|file| (file, fs::read_to_string(file).unwrap()))
        .collect();
    let mut wrong = Vec::new();
    for (file, html) in &pages {
        for link in values(html, "href").chain(values(html, "src")) {
            let (path, anchor) = link.split_once('#').unwrap_or((link, ""));
            if path.contains(':') {
                continue;
            }
            let target = match path {
                "" => (*file).clone(),
                path => straight(&file.parent().unwrap().join(path)),
            };
            let is_there = match pages.get(&target) {
                Some(html) => anchor.is_empty() || values(html, "id").any(|id| id == anchor),
                None => target.exists(),
            };
            if !is_there {
                wrong.push(format!("{}: {link}", file.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let index = files.iter().find(|file| {
        let name = file.file_name().unwrap().to_string_lossy();
        name.starts_with("searchindex")
    });
    let index = fs::read_to_string(index.unwrap()).unwrap();
    // The last three are generated from the docstrings of the Python package, from the notebook, and from a case.
    for page in [
        "docs/coming-from.html#",
        "docs/python-reference.html#model",
        "docs/tutorials/python-notebook.html#",
        "docs/validation/junction.html#",
    ] {
        assert!(index.contains(page), "search finds nothing of {page}");
    }
}

/// The unparsed values of an attribute.
fn values<'a>(html: &'a str, name: &str) -> impl Iterator<Item = &'a str> {
    let start = format!(" {name}=\"");
    let found: Vec<&str> = html.split(&start).skip(1).collect();
    found
        .into_iter()
        .map(|rest| rest.split('"').next().unwrap())
}

/// The path without `..`.
fn straight(path: &Path) -> PathBuf {
    path.components().fold(PathBuf::new(), |mut path, part| {
        match part {
            Component::ParentDir => assert!(path.pop()),
            part => path.push(part),
        }
        path
    })
}

fn files_in(folder: &Path, files: &mut BTreeSet<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files_in(&path, files);
        } else {
            files.insert(path);
        }
    }
}
