//! The page for troubleshooting: it explains exactly the messages of the programs.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use contact_dd_partition::explanation::Explanation;

use super::page::root;

const PAGE: &str = "docs/troubleshooting.md";

/// Beginnings of calls and statements whose next string is a message.
const CALLS: [&str; 22] = [
    "Failure::internal(",
    "Failure::input(",
    "Failure::ill_posed(",
    "Failure::interrupted(",
    "InputError::new(",
    "InputError::about(",
    "MeshError::new(",
    "Error::custom(",
    ".error(",
    "refuse(",
    "refused(",
    "failure(",
    "fails(",
    "Err(",
    ".ok_or(",
    ".ok_or_else(|| ",
    "let message = ",
    "notes).add(",
    "NotConverged(",
    "warnings.push(",
    "fell_back(",
    "#[error(",
];

/// Text that occurs in errors only, in any call.
const EXPECTED: &str = "expected ";

/// Folders of the two programs.
const EXPLAINED: [&str; 2] = ["src", "partition/src"];

/// Length of fixed text below which a message is a combination of others.
const SHORTEST: usize = 12;

/// A reason that is itself a message, at the end of another message.
const REASON: &str = "{why}";

/// A test: the first column of the tables quotes messages of the sources.
pub fn quotes_messages() {
    let sources: String = (EXPLAINED.iter())
        .flat_map(|folder| sources(folder))
        .chain(python_sources("python/contact_dd"))
        .collect();
    let quoted = quoted();
    assert!(quoted.len() > 100, "{PAGE} explains {}", quoted.len());
    let wrong: Vec<_> = (quoted.iter())
        .filter(|part| !sources.contains(part.as_str()))
        .collect();
    assert!(wrong.is_empty(), "{PAGE}: no program says {wrong:#?}");
}

/// A test: messages of the programs have entries, whose names the programs print.
pub fn explains_every_message() {
    let messages: Vec<String> = (EXPLAINED.iter())
        .flat_map(|folder| sources(folder))
        .flat_map(|source| messages(&source))
        .collect();
    assert!(messages.len() > 500, "{} messages", messages.len());
    let without: Vec<_> = (messages.iter())
        .filter(|message| !message.contains(REASON) && Explanation::of(message).is_none())
        .collect();
    assert!(without.is_empty(), "{PAGE} has no entry for {without:#?}");
}

/// A test: messages are found in calls, without comments and continuations, and by their expectations.
pub fn finds_messages() {
    let source = "// warnings.push(\"no message\")\n\
        warnings.push(format!(\n \"body '{}' isn't held: \\\n   hold it\", name));\n\
        InputError::new(reason); let other = \"no message at all\";\n\
        InputError::new(why).in_file(\"no message either\");\n\
        let what = \"a side; expected two sides\"; InputError::new(what);\n\
        InputError::new(format!(\"{what}: {reason}\"))";
    let found: Vec<String> = messages(&joined(source)).into_iter().collect();
    let expected = [
        "a side; expected two sides",
        "body '{}' isn't held: hold it",
    ];
    assert_eq!(found, expected);
}

/// The parts between dots of the messages on the page.
fn quoted() -> Vec<String> {
    let page = fs::read_to_string(root().join(PAGE)).unwrap();
    let mut is_of_messages = false;
    let mut quoted = Vec::new();
    for line in page.lines() {
        is_of_messages =
            line.starts_with("| message |") || (is_of_messages && line.starts_with('|'));
        let cell = line.split('|').nth(1).filter(|_| is_of_messages);
        let codes = cell
            .into_iter()
            .flat_map(|cell| cell.split('`').skip(1).step_by(2));
        let parts = codes.flat_map(|code| code.split('…')).map(str::trim);
        quoted.extend(parts.filter(|part| part.len() > 3).map(str::to_owned));
    }
    quoted
}

/// The messages of a source, without repetition: strings with enough fixed text in calls that take a message, or with
/// an expectation.
fn messages(source: &str) -> BTreeSet<String> {
    let calls = CALLS.iter().flat_map(|call| source.match_indices(call));
    let in_calls = calls.filter_map(|(at, call)| {
        let rest = &source[at + call.len()..];
        let start = rest.find('"')?;
        let string = &rest[start + 1..];
        is_inside(&rest[..start]).then(|| &string[..string.find('"').unwrap_or(0)])
    });
    // Line by line, as an unpaired quote in a comment would exchange strings and code in all that follows.
    let strings = (source.lines()).flat_map(|line| line.split('"').skip(1).step_by(2));
    let expecting = strings.filter(|string| string.contains(EXPECTED));
    let has_words = |message: &String| {
        let fixed = message
            .split('{')
            .map(|part| part.split_once('}').map_or(part, |part| part.1));
        fixed.map(|part| part.trim().len()).max() >= Some(SHORTEST)
    };
    let all = in_calls.chain(expecting);
    all.map(|message| message.replace('\u{1}', "\""))
        .filter(has_words)
        .collect()
}

/// True if a text ends within the call in which it begins.
fn is_inside(text: &str) -> bool {
    let mut depth = 0;
    text.chars().all(|c| {
        depth += i32::from(c == '(') - i32::from(c == ')');
        depth >= 0 && c != ';'
    })
}

/// The sources in a folder, without unit tests.
fn sources(folder: &str) -> impl Iterator<Item = String> {
    let mut files = Vec::new();
    files_in(&root().join(folder), &mut files);
    let file = root().join(folder).with_extension("rs");
    files.extend(file.exists().then_some(file));
    files.into_iter().map(|file| {
        let text = fs::read_to_string(file).unwrap();
        joined(text.split("#[cfg(test)]").next().unwrap())
    })
}

/// The sources of the Python package in a folder, unprocessed.
fn python_sources(folder: &str) -> impl Iterator<Item = String> {
    let entries = fs::read_dir(root().join(folder)).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    let is_source = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "py");
    paths
        .filter(is_source)
        .map(|path| fs::read_to_string(path).unwrap())
}

/// A source without comments and continued strings; quotes within strings become U+0001, other escapes and quote
/// characters U+0002.
fn joined(source: &str) -> String {
    let code = source
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"));
    let mut text = String::new();
    for line in code {
        match line.strip_suffix('\\') {
            Some(start) => text.push_str(start.trim_start()),
            None => {
                text.push_str(line.trim_start());
                text.push('\n');
            }
        }
    }
    let plain = text.replace("\\\\", "\u{2}").replace("'\"'", "\u{2}");
    plain.replace("\\\"", "\u{1}")
}

fn files_in(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap();
        if path.is_dir() && name != "tests" && name != "example" {
            files_in(&path, files);
        } else if path.extension().is_some_and(|ending| ending == "rs") && name != "tests.rs" {
            files.push(path);
        }
    }
}
