//! The text of a deck: keywords with their parameters, and the lines of data that follow.

use std::io::Read as _;
use std::ops::Range;
use std::path::{Path, PathBuf};

use super::notes::Notes;
use crate::error::InputError;
use crate::{magnitude, name, source};

/// Largest nesting of included files, as a deck that includes itself would be endless.
const DEEPEST: usize = 5;

/// Largest number of inclusions.
const INCLUSIONS: usize = 10_000;

/// Total size of repeated inclusions (bytes); the first inclusion of each file isn't limited.
const REPEATED: usize = 64 << 20;

/// The largest number of a node or an element, so that sums of several don't overflow.
const LARGEST_TAG: i64 = 1 << 50;

/// Byte order mark at the start of a file.
const BYTE_ORDER_MARK: char = '\u{feff}';

/// Keywords whose parameter `INPUT` names another file with their data.
const WITH_INPUT: [&str; 4] = ["NODE", "ELEMENT", "NSET", "ELSET"];

/// A line of a file.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct LinePlace {
    file: usize,
    line: usize,
}

/// A line of data.
pub(crate) struct Data {
    pub(crate) place: LinePlace,
    text: Range<usize>,
}

/// A keyword with its parameters and data.
pub(crate) struct Block {
    /// Keyword in capitals, with single blanks.
    pub(crate) keyword: String,
    /// Names in capitals, with values.
    parameters: Vec<(String, String)>,
    pub(crate) place: LinePlace,
    pub(crate) data: Vec<Data>,
}

impl Block {
    /// The names and the values of its parameters.
    pub(crate) fn parameters(&self) -> impl Iterator<Item = (&str, &str)> {
        (self.parameters.iter()).map(|(name, value)| (name.as_str(), value.as_str()))
    }

    /// Replaces the names of parameters by those that `spelled` returns.
    pub(crate) fn spell_parameters<'a>(&mut self, spelled: impl Fn(&str) -> Option<&'a str>) {
        for (name, _) in &mut self.parameters {
            if let Some(other) = spelled(name) {
                *name = other.to_owned();
            }
        }
    }

    /// The value of a parameter; empty for a parameter without a value.
    pub(crate) fn parameter(&self, name: &str) -> Option<&str> {
        let found = self.parameters.iter().find(|(key, _)| key == name);
        found.map(|(_, value)| value.as_str())
    }
}

/// All files of a deck.
pub(crate) struct Source {
    files: Vec<(PathBuf, String)>,
    pub(crate) blocks: Vec<Block>,
    /// Notes on parts of the text that aren't read.
    pub(crate) notes: Notes,
    inclusions: usize,
    /// Total size of repeated inclusions.
    repeated: usize,
}

impl Source {
    /// Reads a deck and its included files.
    pub(crate) fn read(path: &Path) -> Result<Self, InputError> {
        let mut source = Self {
            files: Vec::new(),
            blocks: Vec::new(),
            notes: Notes::default(),
            inclusions: 0,
            repeated: 0,
        };
        source.files.push((path.to_path_buf(), text(path)?));
        source.add(0, DEEPEST)?;
        if source.blocks.is_empty() && !lines(&source.files[0].1).is_empty() {
            let (line, _) = lines(&source.files[0].1)[0];
            let message =
                "expected a keyword, such as *NODE: this isn't a deck of Abaqus or CalculiX";
            return Err(source.error(LinePlace { file: 0, line }, message));
        }
        Ok(source)
    }

    /// All files.
    pub(crate) fn paths(&self) -> impl Iterator<Item = &Path> {
        self.files.iter().map(|(path, _)| path.as_path())
    }

    /// An error at a line.
    pub(crate) fn error(&self, at: LinePlace, message: impl std::fmt::Display) -> InputError {
        InputError::new(format!("line {}: {message}", at.line)).in_file(&self.files[at.file].0)
    }

    /// A line of data as text.
    pub(crate) fn text(&self, data: &Data) -> &str {
        self.files[data.place.file].1[data.text.clone()].trim()
    }

    /// Comma-separated items of a line of data, without an empty last one.
    pub(crate) fn items(&self, data: &Data) -> impl Iterator<Item = &str> {
        let text = self.text(data);
        let text = text.strip_suffix(',').unwrap_or(text);
        text.split(',').map(|item| unquoted(item.trim()))
    }

    /// A number of an element or node.
    pub(crate) fn tag(&self, at: LinePlace, item: &str, what: &str) -> Result<i64, InputError> {
        let number = item.parse().ok();
        number
            .filter(|tag| (1..=LARGEST_TAG).contains(tag))
            .ok_or_else(|| {
                let found = name::shown(item);
                self.error(
                    at,
                    format!("expected {what}, a positive integer, found `{found}`"),
                )
            })
    }

    /// A real number, with `e`, Fortran's `d` or nothing before the exponent, as in `5.-1`; an empty item is 0.
    pub(crate) fn real(&self, at: LinePlace, item: &str, what: &str) -> Result<f64, InputError> {
        let item = if item.is_empty() { "0" } else { item };
        let shown = || name::shown(item);
        let value = real(item).ok_or_else(|| {
            self.error(
                at,
                format!("expected {what}, a number, found `{}`", shown()),
            )
        })?;
        magnitude::check(value).map_err(|expected| {
            self.error(at, format!("{what} is {}; expected {expected}", shown()))
        })
    }

    /// The value of a required parameter.
    pub(crate) fn required<'a>(&self, block: &'a Block, name: &str) -> Result<&'a str, InputError> {
        let value = block.parameter(name).filter(|value| !value.is_empty());
        value.ok_or_else(|| {
            self.error(
                block.place,
                format!("*{} has no {name}; expected {name}=…", block.keyword),
            )
        })
    }

    /// The line as text, with the file unless it is the deck itself.
    pub(crate) fn place(&self, at: LinePlace) -> String {
        match at.file {
            0 => format!("line {}", at.line),
            file => format!("{}, line {}", self.files[file].0.display(), at.line),
        }
    }

    /// Appends the blocks of a file; `depth` is the remaining nesting of inclusions.
    fn add(&mut self, file: usize, depth: usize) -> Result<(), InputError> {
        let lines = lines(&self.files[file].1);
        let mut next = 0;
        while let Some((line, range)) = lines.get(next).cloned() {
            next += 1;
            let place = LinePlace { file, line };
            let text = &self.files[file].1[range.clone()];
            let Some(head) = text.strip_prefix('*') else {
                match self.blocks.last_mut() {
                    Some(block) => block.data.push(Data { place, text: range }),
                    None => {
                        let item = format!("{} `{}`", self.place(place), name::shown(text));
                        (self.notes).add("text before the first keyword is left out", item);
                    }
                }
                continue;
            };
            let mut head = head.to_owned();
            while head.ends_with(',') {
                let Some((_, more)) = lines.get(next) else {
                    break;
                };
                let more = &self.files[file].1[more.clone()];
                if !more.starts_with(char::is_alphabetic) {
                    break;
                }
                head.push_str(more);
                next += 1;
            }
            let block = block(&head, place);
            let includes = block.keyword == "INCLUDE";
            let input = match includes {
                true => Some(self.required(&block, "INPUT")?.to_owned()),
                false if WITH_INPUT.contains(&block.keyword.as_str()) => {
                    block.parameter("INPUT").map(str::to_owned)
                }
                false => None,
            };
            if !includes {
                self.blocks.push(block);
            }
            if let Some(input) = input {
                let Some(depth) = depth.checked_sub(1) else {
                    let message = format!("more than {DEEPEST} files are included in each other");
                    return Err(self.error(place, message));
                };
                let file = self.included(place, &input)?;
                self.add(file, depth)?;
            }
        }
        Ok(())
    }

    /// The number of a file included by a line.
    fn included(&mut self, at: LinePlace, input: &str) -> Result<usize, InputError> {
        // Relative to the main deck, as in Abaqus.
        let folder = self.files[0].0.parent().unwrap_or(Path::new(""));
        // Decks that were written on Windows have backslashes.
        let path = folder.join(input.replace('\\', "/"));
        self.inclusions += 1;
        if self.inclusions > INCLUSIONS {
            let message = format!(
                "more than {INCLUSIONS} files are included; expected a deck whose files don't include each other \
                 again and again"
            );
            return Err(self.error(at, message));
        }
        let known = self.files.iter().position(|(known, _)| *known == path);
        let Some(file) = known else {
            let text = text(&path).map_err(|error| self.error(at, error))?;
            self.files.push((path, text));
            return Ok(self.files.len() - 1);
        };
        self.repeated += self.files[file].1.len();
        if self.repeated > REPEATED {
            let message = format!(
                "files that are included more than once add up to more than {REPEATED} bytes; expected each once"
            );
            return Err(self.error(at, message));
        }
        Ok(file)
    }
}

/// A number in Fortran's syntax.
fn real(item: &str) -> Option<f64> {
    let text = item.replace(['d', 'D'], "e");
    let bytes = text.as_bytes();
    let is_sign = |&at: &usize| matches!(bytes[at], b'+' | b'-');
    let bare = (1..bytes.len()).find(is_sign);
    match bare.filter(|&at| bytes[at - 1].is_ascii_digit() || bytes[at - 1] == b'.') {
        Some(at) => format!("{}e{}", &text[..at], &text[at..]).parse().ok(),
        None => text.parse().ok(),
    }
}

fn text(path: &Path) -> Result<String, InputError> {
    let mut bytes = Vec::new();
    let read = |mut file: std::fs::File| {
        let read = file.read_to_end(&mut bytes);
        read.map_err(|error| InputError::new(format!("the mesh can't be read: {error}")))
    };
    (source::open(path, "a deck of Abaqus or CalculiX").and_then(read))
        .map_err(|error| error.in_file(path))?;
    // Comments and names may have any encoding.
    let mut text = match String::from_utf8(bytes) {
        Ok(text) => text,
        Err(other) => String::from_utf8_lossy(other.as_bytes()).into_owned(),
    };
    // Some editors write a byte order mark.
    if text.starts_with(BYTE_ORDER_MARK) {
        text.drain(..BYTE_ORDER_MARK.len_utf8());
    }
    Ok(text)
}

/// The numbers and the trimmed texts of lines except blank lines and comments.
fn lines(text: &str) -> Vec<(usize, Range<usize>)> {
    let mut start = 0;
    let mut lines = Vec::new();
    for (number, line) in (1..).zip(text.split('\n')) {
        let trimmed = line.trim();
        if !trimmed.is_empty() && !trimmed.starts_with("**") {
            let at = start + (line.len() - line.trim_start().len());
            lines.push((number, at..at + trimmed.len()));
        }
        start += line.len() + 1;
    }
    lines
}

/// A keyword with its parameters, without data; `head` is the text after the asterisk.
fn block(head: &str, place: LinePlace) -> Block {
    let mut quoted = false;
    let mut words = head.split(|c| {
        quoted ^= c == '"';
        c == ',' && !quoted
    });
    let capitals = |text: &str| {
        let words: Vec<&str> = text.split_whitespace().collect();
        words.join(" ").to_uppercase()
    };
    let keyword = capitals(words.next().unwrap_or_default());
    let parameters = words.filter(|word| !word.trim().is_empty()).map(|word| {
        let (name, value) = word.split_once('=').unwrap_or((word, ""));
        (capitals(name), unquoted(value.trim()).to_owned())
    });
    Block {
        keyword,
        parameters: parameters.collect(),
        place,
        data: Vec::new(),
    }
}

fn unquoted(item: &str) -> &str {
    let inner = item
        .strip_prefix('"')
        .and_then(|rest| rest.strip_suffix('"'));
    inner.unwrap_or(item)
}
