//! Positions in the text of a scene, or of settings: line and key.

use std::ops::Range;

use serde::de::Error as _;
use serde::{Deserialize, Deserializer};
use toml::Spanned;
use toml::de::{DeTable, DeValue, Error};

use super::suggest::hint_and_known;
use super::syntax;
use crate::error::InputError;
use crate::mismatch::in_plain_words;

/// A step from a table or an array to an entry.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Step {
    Key(String),
    Index(usize),
}

impl From<&str> for Step {
    fn from(key: &str) -> Self {
        Self::Key(key.to_owned())
    }
}

impl From<usize> for Step {
    fn from(index: usize) -> Self {
        Self::Index(index)
    }
}

/// An error at the key given by `path`.
pub(super) fn error_at(text: &str, path: &[Step], message: &str) -> InputError {
    let found = entries(text)
        .into_iter()
        .find(|entry| entry.path == path)
        .map(|entry| entry.key.unwrap_or(entry.value).start);
    compose(text, found, path, message)
}

/// The error that `toml` or `serde` found in `text`, with line and key.
pub fn located(text: &str, error: &Error) -> InputError {
    let start = error.span().map(|span| span.start);
    if let (Some(start), Err(_)) = (start, DeTable::parse(text)) {
        let message = syntax::described(text, start, error);
        return compose(text, Some(start), &[], &message);
    }
    // A missing key has no position, and the error's position may be that of another key.
    let is_missing = error.message().starts_with("missing field");
    let path = start
        .and_then(|start| {
            entries(text)
                .into_iter()
                .filter_map(|entry| {
                    let at_key =
                        !is_missing && entry.key.as_ref().is_some_and(|key| key.contains(&start));
                    let depth = entry.path.len();
                    (at_key || entry.value.contains(&start)).then_some(((at_key, depth), entry))
                })
                .max_by_key(|(rank, _)| *rank)
        })
        .map(|(_, entry)| entry.path)
        .unwrap_or_default();
    // A top-level key has to precede the first table.
    let start = match is_missing && path.is_empty() {
        true => Some(first_table(text).map_or(0, |(start, _)| start)),
        false => start,
    };
    let message = with_advice(text, error.message(), &path);
    compose(text, start, &path, &message)
}

/// Top-level keys of a scene, and examples of their values.
const OF_SCENE: [(&str, &str); 5] = [
    ("title", "\"…\""),
    ("mesh", "\"mesh.msh\""),
    ("units", "\"mm\""),
    ("plane", "\"strain\""),
    ("subdomains", "[…]"),
];

/// The position of the first table, and its header.
fn first_table(text: &str) -> Option<(usize, &str)> {
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        if line.trim_start().starts_with('[') {
            return Some((start, line.trim()));
        }
        start += line.len();
    }
    None
}

/// The place of a missing top-level key, for the end of a message; empty for a key of a table, given by `path`.
fn above(text: &str, key: &str, path: &[Step]) -> String {
    if path.is_empty() && ["materials", "bodies"].contains(&key) {
        return format!("; expected a table [{key}.NAME] for each");
    }
    let known = OF_SCENE.iter().find(|(known, _)| *known == key);
    let Some((_, value)) = known.filter(|_| path.is_empty()) else {
        return String::new();
    };
    let place = match first_table(text) {
        Some((_, head)) => format!(" above {head}"),
        None => String::new(),
    };
    format!("; expected {key} = {value}{place}")
}

/// The error that `serde` found in the value at `path`, with the most similar known word for an unknown one, and
/// brackets for a table that should be a list.
fn with_advice(text: &str, message: &str, path: &[Step]) -> String {
    let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    if let ([missing], true) = (&quoted[..], message.starts_with("missing field")) {
        return format!(
            "the key '{missing}' is missing{}",
            above(text, missing, path)
        );
    }
    let is_of_scene = path.len() > 1 && OF_SCENE.iter().any(|(key, _)| quoted.first() == Some(key));
    if let (&[found, ..], true, true) = (
        &quoted[..],
        is_of_scene,
        message.starts_with("unknown field"),
    ) {
        let belongs = above(text, found, &[]);
        return format!("unknown key '{found}', which isn't of a table but of the scene{belongs}");
    }
    let unknown = ["field", "variant"].map(|what| message.starts_with(&format!("unknown {what}")));
    if let ([found, known @ ..], true) = (&quoted[..], unknown.contains(&true)) {
        let word = if unknown[0] { "key" } else { "value" };
        let hint = hint_and_known(found, known.iter().copied());
        return format!("unknown {word} '{found}'{hint}");
    }
    let keys = path.iter().filter_map(|step| match step {
        Step::Key(key) => Some(key.as_str()),
        Step::Index(_) => None,
    });
    let table = keys.collect::<Vec<_>>().join(".");
    match syntax::double_brackets(&table) {
        Some(advice) if message.starts_with("invalid type: map") => {
            format!("it is a table; {advice}")
        }
        _ => in_plain_words(message),
    }
}

/// Reads a list of exactly `N` entries: `toml` ignores further ones.
pub(super) fn exactly<'de, D, T, const N: usize>(
    deserializer: D,
) -> Result<Option<[T; N]>, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    let items = Vec::<T>::deserialize(deserializer)?;
    let count = items.len();
    let wrong = |_| D::Error::custom(format!("the number of entries is {count}; expected {N}"));
    items.try_into().map(Some).map_err(wrong)
}

/// Reads an array of tables so that an error in one of them is located there: `toml` assigns an error without a
/// position to the innermost newtype around it.
pub(super) fn list<'de, D, T>(deserializer: D) -> Result<Vec<T>, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    #[derive(Deserialize)]
    struct Item<T>(T);
    let items = Vec::<Item<T>>::deserialize(deserializer)?;
    Ok(items.into_iter().map(|item| item.0).collect())
}

fn compose(text: &str, start: Option<usize>, path: &[Step], message: &str) -> InputError {
    let mut place = String::new();
    if let Some(start) = start.and_then(|start| text.get(..start)) {
        place = format!("line {}: ", start.matches('\n').count() + 1);
    }
    if !path.is_empty() {
        place = format!("{place}{}: ", shown(text, path));
    }
    InputError::new(format!("{place}{message}"))
}

/// A path as in `contact[2] 'seam'.sides`, counted from 1, with the names of tables that have one.
fn shown(text: &str, path: &[Step]) -> String {
    let root = DeTable::parse(text).ok();
    let root = root.map(|root| DeValue::Table(root.into_inner()));
    let mut value = root.as_ref();
    let mut shown = String::new();
    for (depth, step) in path.iter().enumerate() {
        match step {
            Step::Key(key) => {
                value = value.and_then(|table| table.get(key.as_str()).map(Spanned::get_ref));
                if !shown.is_empty() {
                    shown.push('.');
                }
                let bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
                if !key.is_empty() && key.chars().all(bare) {
                    shown.push_str(key);
                } else {
                    shown.push_str(&format!("{key:?}"));
                }
            }
            Step::Index(index) => {
                value = value.and_then(|array| array.get(*index).map(Spanned::get_ref));
                shown.push_str(&format!("[{}]", index + 1));
                let name = value.and_then(|item| item.get("name")?.get_ref().as_str());
                let about_name = path.get(depth + 1) == Some(&Step::from("name"));
                if let Some(name) = name.filter(|name| !about_name && !name.is_empty()) {
                    shown.push_str(&format!(" '{}'", name.escape_debug()));
                }
            }
        }
    }
    shown
}

/// A value of the text: its path, its key and its position.
struct Entry {
    path: Vec<Step>,
    key: Option<Range<usize>>,
    value: Range<usize>,
}

/// All values of the text; empty if it isn't TOML.
fn entries(text: &str) -> Vec<Entry> {
    let mut entries = Vec::new();
    if let Ok(table) = DeTable::parse(text) {
        collect(&DeValue::Table(table.into_inner()), &[], &mut entries);
    }
    entries
}

/// Adds the content of `value`, given by `path`.
fn collect(value: &DeValue, path: &[Step], entries: &mut Vec<Entry>) {
    let held: Vec<_> = match value {
        DeValue::Table(table) => (table.iter())
            .map(|(key, value)| (key.get_ref().as_ref().into(), Some(key.span()), value))
            .collect(),
        DeValue::Array(array) => (array.iter().enumerate())
            .map(|(index, item)| (Step::Index(index), None, item))
            .collect(),
        _ => return,
    };
    for (step, key, value) in held {
        let path = [path, &[step]].concat();
        collect(value.get_ref(), &path, entries);
        entries.push(Entry {
            path,
            key,
            value: value.span(),
        });
    }
}
