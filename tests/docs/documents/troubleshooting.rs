//! The page for troubleshooting: the messages that it explains are those of the programs, and it explains them all.

use std::fs;
use std::path::{Path, PathBuf};

use super::page::root;

const PAGE: &str = "docs/troubleshooting.md";

/// Openings of calls whose next string is a message.
const CALLS: [&str; 8] = [
    "Failure::internal(",
    "Failure::input(",
    "Failure::ill_posed(",
    "Failure::interrupted(",
    "InputError::new(",
    "NotConverged(",
    "warnings.push(",
    "fell_back(",
];

/// Folders whose messages are explained one by one; those of mesh and problem files explain themselves.
const EXPLAINED: [&str; 4] = [
    "src",
    "partition/src/model",
    "partition/src/decompose",
    "partition/src/scene",
];

/// A message with less of its own words is made of others.
const SHORTEST: usize = 12;

/// A test: the first column of tables of messages quotes the sources.
pub fn quotes_messages() {
    let sources: String = (sources("src").chain(sources("partition/src")))
        .chain(python_sources("python/contact_dd"))
        .collect();
    let quoted = quoted();
    assert!(quoted.len() > 100, "{PAGE} explains {}", quoted.len());
    let wrong: Vec<_> = (quoted.iter())
        .filter(|part| !sources.contains(part.as_str()))
        .collect();
    assert!(wrong.is_empty(), "{PAGE}: no program says {wrong:#?}");
}

/// A test: messages of the programs have entries.
pub fn explains_every_message() {
    let quoted = quoted();
    let messages: Vec<String> = (EXPLAINED.iter())
        .flat_map(|folder| sources(folder))
        .flat_map(|source| messages(&source))
        .collect();
    assert!(messages.len() > 50, "{} messages", messages.len());
    let without: Vec<_> = (messages.iter())
        .filter(|message| !quoted.iter().any(|part| message.contains(part.as_str())))
        .collect();
    assert!(without.is_empty(), "{PAGE} has no entry for {without:#?}");
}

/// A test: messages are found in calls, without their comments and continuations.
pub fn finds_messages() {
    let source = "// warnings.push(\"no message\")\n\
        warnings.push(format!(\n \"body '{}' isn't held: \\\n   hold it\", name));\n\
        InputError::new(reason); let other = \"no message at all\";\n\
        InputError::new(format!(\"{what}: {reason}\"))";
    assert_eq!(messages(&joined(source)), ["body '{}' isn't held: hold it"]);
}

/// The parts between dots of what the page quotes.
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

/// The messages of a source: strings with words of their own in calls that take one.
fn messages(source: &str) -> Vec<String> {
    let calls = CALLS.iter().flat_map(|call| source.match_indices(call));
    let strings = calls.filter_map(|(at, call)| {
        let rest = &source[at + call.len()..];
        let start = rest.find('"')?;
        let is_here = !rest[..start].contains(';');
        let string = &rest[start + 1..];
        is_here.then(|| string[..string.find('"').unwrap_or(0)].replace('\u{1}', "\""))
    });
    let has_words = |message: &String| {
        let fixed = message
            .split('{')
            .map(|part| part.split_once('}').map_or(part, |part| part.1));
        fixed.map(|part| part.trim().len()).max() >= Some(SHORTEST)
    };
    strings.filter(has_words).collect()
}

/// The sources in a folder, without their tests.
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

/// The sources of the Python package in a folder, as they stand there.
fn python_sources(folder: &str) -> impl Iterator<Item = String> {
    let entries = fs::read_dir(root().join(folder)).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    let is_source = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "py");
    paths
        .filter(is_source)
        .map(|path| fs::read_to_string(path).unwrap())
}

/// A source without comments and continued strings; quotes within strings as U+0001.
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
    text.replace("\\\"", "\u{1}")
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
