//! The content of a problem file: all datasets of the schema, read by slices.

use std::collections::{BTreeMap, HashMap};
use std::ops::Range;

use hdf5::LinkType;

use super::dataset::Dataset;
use super::slice::Slice;
use crate::error::InputError;
use crate::model::PlaneState;
use crate::name;
use crate::problem::schema::{self, Counts, FIELDS, FREE, Field, Kind, MAY_BE_EMPTY, TOGETHER};
use crate::scene::suggest::nearest;

/// The datasets of a file, each with the type and shape of the schema.
#[derive(Debug)]
pub(super) struct Contents {
    datasets: BTreeMap<&'static str, Dataset>,
    counts: Counts,
    /// Offsets of the slices of the items that a letter counts, for every letter whose offsets or sizes the schema has;
    /// all are empty in an empty group.
    offsets: BTreeMap<char, Vec<usize>>,
}

impl Contents {
    /// Opens all datasets of a file in `dim` dimensions, for a plane mesh with this plane state.
    ///
    /// # Errors
    /// The first unknown name, or the dataset that is missing or invalid.
    pub fn open(
        file: &hdf5::File,
        dim: usize,
        plane: Option<PlaneState>,
    ) -> Result<Self, InputError> {
        check_names(file)?;
        let mut counts = Counts::new(dim, plane);
        let mut datasets = BTreeMap::new();
        if !file.link_exists("support") {
            return Err(InputError::new(
                "group /support is missing; expected one, empty where nothing is supported",
            ));
        }
        for field in FIELDS {
            if file.link_exists(field.path) {
                datasets.insert(field.path, Dataset::open(file, field, &mut counts)?);
            } else if !field.optional && !is_empty(file, field.group()) {
                return Err(InputError::new(format!(
                    "dataset {} is missing",
                    field.path
                )));
            }
        }
        let mut contents = Self {
            datasets,
            counts,
            offsets: BTreeMap::new(),
        };
        for together in TOGETHER {
            contents.check_together(together)?;
        }
        for field in FIELDS {
            if let Kind::Offsets(letter) | Kind::Sizes(letter) = field.kind {
                let offsets = contents.read_offsets(field, letter)?;
                contents.offsets.insert(letter, offsets);
            }
        }
        Ok(contents)
    }

    /// Checks that either all of some datasets exist, or none.
    fn check_together(&self, paths: &[&str]) -> Result<(), InputError> {
        let missing = paths.iter().find(|path| !self.has(path));
        match missing.filter(|_| paths.iter().any(|path| self.has(path))) {
            Some(missing) => Err(InputError::new(format!(
                "dataset {missing} is missing; expected all of {}, or none of them",
                paths.join(", ")
            ))),
            None => Ok(()),
        }
    }

    fn read_offsets(&self, field: &Field, letter: char) -> Result<Vec<usize>, InputError> {
        let slice = self.all_integers(field.path)?;
        let count = self.count(letter);
        match field.kind {
            _ if !self.has(field.path) => Ok(vec![0; self.counts.shape(field)[0]]),
            Kind::Sizes(_) => slice.running_sum(count, schema::noun(letter)),
            _ => slice.offsets(count),
        }
    }

    /// The rows of slice `index` of the items that a letter counts.
    pub fn rows(&self, letter: char, index: usize) -> Range<usize> {
        self.rows_of(letter, index..index + 1)
    }

    /// The rows of consecutive slices of the items that a letter counts.
    pub fn rows_of(&self, letter: char, slices: Range<usize>) -> Range<usize> {
        let offsets = &self.offsets[&letter];
        offsets[slices.start]..offsets[slices.end]
    }

    /// Sizes of the slices of the items that a letter counts.
    pub fn sizes(&self, letter: char) -> Vec<usize> {
        let ends = self.offsets[&letter].windows(2);
        ends.map(|w| w[1] - w[0]).collect()
    }

    /// True if the file holds a dataset.
    pub fn has(&self, path: &str) -> bool {
        self.datasets.contains_key(path)
    }

    /// The count of a letter.
    pub fn count(&self, letter: char) -> usize {
        self.counts.of(letter)
    }

    /// Reads some rows of integers.
    ///
    /// # Errors
    /// The row that contradicts the schema.
    pub fn integers(&self, path: &str, rows: Range<usize>) -> Result<Slice<i64>, InputError> {
        let Some(dataset) = self.datasets.get(path) else {
            return Ok(Slice::new("", 0, 1, Vec::new()));
        };
        let slice = dataset.slice(rows)?;
        match dataset.field.kind {
            Kind::Indices(what, letter) => slice.check_indices(what, self.count(letter))?,
            Kind::Codes(what, count) => slice.check_indices(what, count)?,
            _ => {}
        }
        Ok(slice)
    }

    /// Reads all integers of a one-dimensional dataset.
    ///
    /// # Errors
    /// Errors of [`Contents::integers`].
    pub fn all_integers(&self, path: &str) -> Result<Slice<i64>, InputError> {
        let rows = self.datasets.get(path).map_or(0, Dataset::rows);
        self.integers(path, 0..rows)
    }

    /// Reads some rows of numbers.
    ///
    /// # Errors
    /// The row that contradicts the schema.
    pub fn numbers(&self, path: &str, rows: Range<usize>) -> Result<Slice<f64>, InputError> {
        let Some(dataset) = self.datasets.get(path) else {
            return Ok(Slice::new("", 0, 1, Vec::new()));
        };
        let slice = dataset.slice(rows)?;
        slice.check_numbers(dataset.field.kind)?;
        Ok(slice)
    }

    /// Reads all strings.
    ///
    /// # Errors
    /// The row that contradicts the schema.
    pub fn strings(&self, path: &str) -> Result<Vec<String>, InputError> {
        let Some(dataset) = self.datasets.get(path) else {
            return Ok(Vec::new());
        };
        let kind = dataset.field.kind;
        let law = match kind {
            Kind::GroupNames => name::check_contact,
            Kind::Names => name::check,
            _ => name::check_text,
        };
        let strings = dataset.strings()?;
        if kind == Kind::Names && strings.is_empty() {
            return Err(dataset.error("is empty; expected at least one name"));
        }
        let mut seen = HashMap::new();
        for (row, text) in strings.iter().enumerate() {
            let refused = |what: String| {
                let path = dataset.field.path;
                InputError::new(format!(
                    "dataset {path}, row {row}: '{}' {what}",
                    name::shown(text)
                ))
            };
            law(text).map_err(|reason| refused(reason.to_owned()))?;
            match seen.insert(text, row) {
                Some(first) if kind == Kind::GroupNames => {
                    return Err(refused(format!("is the name of contact {first} already")));
                }
                _ => {}
            }
        }
        Ok(strings)
    }
}

/// True if a group is empty and may be.
fn is_empty(file: &hdf5::File, group: &str) -> bool {
    let nothing = || file.group(group).is_ok_and(|group| group.is_empty());
    MAY_BE_EMPTY.contains(&group) && (!file.link_exists(group) || nothing())
}

/// Checks that the file has only names of the schema, as another name is probably a misspelt one, and no links out of
/// the file.
fn check_names(file: &hdf5::File) -> Result<(), InputError> {
    for path in schema::groups() {
        // An entry that isn't a group is reported when its datasets are opened.
        let Ok(group) = file.group(path) else {
            continue;
        };
        let unreadable = |_| InputError::new(format!("the group {path} can't be read"));
        let place = format!("{}/", path.trim_end_matches('/'));
        let (mut names, mut leading_out) = (Vec::new(), None);
        let visited = group.iter_visit_default(|name, link| {
            names.push(name.to_owned());
            if link.link_type == LinkType::External {
                leading_out.get_or_insert_with(|| name.to_owned());
            }
            Ok(())
        });
        visited.map_err(unreadable)?;
        if let Some(name) = leading_out {
            return Err(InputError::new(format!(
                "{place}{name} is a link to another file; expected all data in this one"
            )));
        }
        if FREE.contains(&path) {
            continue;
        }
        check_known(&place, names, &schema::names_in(path))?;
        let attributes = group.attr_names().map_err(unreadable)?;
        let known: Vec<&str> = schema::attributes_of(path).map(|a| a.name).collect();
        check_known(&format!("attribute {place}"), attributes, &known)?;
    }
    Ok(())
}

fn check_known(place: &str, mut names: Vec<String>, known: &[&str]) -> Result<(), InputError> {
    names.sort();
    let unknown = names.iter().find(|name| !known.contains(&name.as_str()));
    let Some(name) = unknown else {
        return Ok(());
    };
    let what = match nearest(name, known.iter().copied()) {
        Some(near) => format!("did you mean '{near}'? Known here: {}", known.join(", ")),
        None => "expected none here".to_owned(),
    };
    Err(InputError::new(format!(
        "{place}{} isn't known; {what}",
        name::shown(name)
    )))
}
