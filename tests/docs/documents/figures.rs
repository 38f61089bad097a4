//! Measured figures of README: each has to occur in the section that its line links.

use std::fs;

use super::links::anchor_of;
use super::page::root;

/// Largest number of lines of README.
const LONGEST: usize = 120;

/// A test: README is short, and the linked section contains each of its measured figures.
pub fn of_readme() {
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    let lines = readme.lines().count();
    assert!(
        lines <= LONGEST,
        "README.md has {lines} lines, over {LONGEST}"
    );
    let (measured, _) = readme.split_once("\n## Install\n").unwrap();
    let mut found = 0;
    let mut wrong = Vec::new();
    for line in measured.lines() {
        for (text, target) in claims(line) {
            let figures = figures(text);
            found += figures.len();
            let section = target.map(section).unwrap_or_default();
            let there = words(&section);
            wrong.extend(
                (figures.iter())
                    .filter(|figure| !holds(&there, figure))
                    .map(|figure| {
                        let target = target.unwrap_or("no link");
                        format!("{} isn't in {target}: {line}", figure.join(" "))
                    }),
            );
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(found > 15, "README.md has {found} figures only");
}

/// A test: figures are distinguished from others and from parts of others.
pub fn are_told_apart() {
    let line = "- **3-D**: 46 875 dofs in 1.24 s, `quad9` ([here](docs/a.md#b)), and 7 more";
    let claims: Vec<_> = claims(line).collect();
    assert_eq!(
        claims.iter().map(|claim| claim.1).collect::<Vec<_>>(),
        [Some("docs/a.md#b"), None, None]
    );
    assert_eq!(figures(claims[0].0), [vec!["46", "875"], vec!["1.24"]]);
    assert_eq!(figures(claims[2].0), [vec!["7"]]);
    let page = words("| linear | 46 875 | 0 | 1.24 |\n| 11.24 | 8 46 875 |");
    assert!(holds(&page, &["46", "875"]) && holds(&page, &["1.24"]));
    for absent in [&["875"][..], &["24"], &["0", "1.24"], &["1.2"]] {
        assert!(!holds(&page, absent), "{absent:?}");
    }
}

/// The parts of a line, each with the target of the link at its end.
fn claims(line: &str) -> impl Iterator<Item = (&str, Option<&str>)> {
    line.split_inclusive(')').map(|part| {
        let link = part
            .rsplit_once("](")
            .filter(|link| link.1.contains(".md#"));
        match link {
            Some((text, target)) => (text, target.strip_suffix(')')),
            None => (part, None),
        }
    })
}

/// The text of `page.md#heading`, up to the next heading.
fn section(target: &str) -> String {
    let (file, anchor) = target.split_once('#').unwrap();
    let page = fs::read_to_string(root().join(file)).unwrap();
    let lines = (page.lines()).skip_while(|line| {
        !(line.starts_with('#') && anchor_of(line.trim_start_matches('#')) == anchor)
    });
    let lines = lines.skip(1).take_while(|line| !line.starts_with('#'));
    lines.collect::<Vec<_>>().join("\n")
}

/// The figures of a text: adjacent numbers form one figure, with spaces between thousands.
fn figures(text: &str) -> Vec<Vec<&str>> {
    let words = words(text);
    let runs = words.split(|word| !is_figure(word));
    runs.filter(|run| !run.is_empty())
        .map(<[_]>::to_vec)
        .collect()
}

/// True if a figure occurs among the words of a page as a whole.
fn holds(page: &[&str], figure: &[&str]) -> bool {
    page.split(|word| !is_figure(word)).any(|run| run == figure)
}

/// The words of a text: numbers with sign and exponent, and other signs as separate words.
fn words(text: &str) -> Vec<&str> {
    let inside = |c: char| c.is_alphanumeric() || "-._".contains(c);
    let separate = text.split_inclusive(|c| !inside(c)).flat_map(|part| {
        let word = part.trim_end_matches(|c| !inside(c));
        [word.trim_matches('.'), part[word.len()..].trim()]
    });
    separate.filter(|word| !word.is_empty()).collect()
}

/// True if a word is a number, unlike `3-D`.
fn is_figure(word: &&str) -> bool {
    word.starts_with(|c: char| c.is_ascii_digit()) && !word.ends_with("-D")
}
