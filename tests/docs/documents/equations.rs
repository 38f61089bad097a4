//! The equations of the paper on `docs/method.md`, and where the code says that it does them.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use super::links::in_repository;
use super::page::{Page, root};

/// What the paper's numbered equations are about, in words of its own or of the page.
const PAPER: [(usize, &str); 19] = [
    (1, "least energy"),
    (2, "strain energy"),
    (3, "loads"),
    (4, "traces"),
    (5, "inverse of the trace"),
    (6, "interface condition"),
    (7, "linear subdomain"),
    (8, "pair in contact"),
    (9, "extension"),
    (10, "contact surface"),
    (11, "local Schur complement"),
    (12, "common local Schur complement"),
    (13, "sum over the subdomains"),
    (14, "interface problem"),
    (15, "S_0, S_CON, F"),
    (16, "bilateral condition"),
    (17, "start"),
    (18, "successive approximations"),
    (19, "finite elements"),
];

/// A test: every equation of the paper has its heading, in its order, with what it is about; and where
/// comments in the code cite an equation, one of the files linked below its heading does.
pub fn are_the_papers(pages: &[Page]) {
    let page = pages
        .iter()
        .find(|page| page.name == "docs/method.md")
        .unwrap();
    let mut sections: Vec<(Vec<usize>, usize)> = Vec::new();
    for heading in &page.headings {
        let numbers = cited(&heading.text);
        for number in &numbers {
            let (_, about) = PAPER
                .iter()
                .find(|(n, _)| n == number)
                .unwrap_or_else(|| panic!("the paper has no ({number})"));
            assert!(heading.text.contains(about), "{}: '{about}'", heading.text);
        }
        sections.push((numbers.into_iter().collect(), heading.line));
    }
    let all: Vec<usize> = sections
        .iter()
        .flat_map(|(numbers, _)| numbers.clone())
        .collect();
    assert_eq!(all, PAPER.map(|(number, _)| number));

    let ends = sections
        .iter()
        .skip(1)
        .map(|(_, line)| *line)
        .chain([usize::MAX]);
    let mut linked: BTreeMap<usize, Vec<PathBuf>> = BTreeMap::new();
    for ((numbers, begin), end) in sections.iter().zip(ends) {
        let links = page
            .links
            .iter()
            .filter(|link| (*begin..end).contains(&link.line));
        let files: Vec<PathBuf> = links.map(|link| in_repository(page, &link.file)).collect();
        numbers
            .iter()
            .for_each(|&number| drop(linked.insert(number, files.clone())));
    }
    let mut sources = Vec::new();
    sources_in(&root().join("src"), &mut sources);
    // The front page cites them all.
    sources.retain(|path| !path.ends_with("src/lib.rs"));
    let citing: BTreeMap<&Path, BTreeSet<usize>> = sources
        .iter()
        .map(|path| {
            let code = fs::read_to_string(path).unwrap();
            let comments = code
                .lines()
                .filter_map(|line| line.trim_start().strip_prefix("//"));
            (
                path.strip_prefix(root()).unwrap(),
                comments.flat_map(cited).collect(),
            )
        })
        .collect();
    for (number, files) in linked {
        let does = |file: &&Path| citing[*file].contains(&number);
        let citing: Vec<&Path> = citing.keys().copied().filter(does).collect();
        let is_linked = citing
            .iter()
            .any(|file| files.iter().any(|linked| linked == file));
        assert!(
            citing.is_empty() || is_linked,
            "({number}) is cited in {citing:?}, and none of them is linked below it"
        );
    }
}

fn sources_in(folder: &Path, sources: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        match path.is_dir() {
            true => sources_in(&path, sources),
            false => sources.push(path),
        }
    }
}

/// The numbers that stand in parentheses by themselves; (16)-(17) are two of them.
fn cited(text: &str) -> BTreeSet<usize> {
    let mut numbers = BTreeSet::new();
    for (at, _) in text.match_indices('(') {
        let before = text[..at].chars().next_back();
        let digits = text[at + 1..].split(')').next().unwrap_or_default();
        if before.is_none_or(|c| !c.is_alphanumeric() && c != '_')
            && let Ok(number) = digits.parse()
        {
            numbers.insert(number);
        }
    }
    numbers
}
