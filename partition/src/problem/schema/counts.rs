//! The counts of the letters of shapes in a file.

use std::collections::BTreeMap;

use super::{Field, noun};
use crate::model::PlaneState;

/// Counts by letter.
#[derive(Clone, Debug, Default)]
pub struct Counts(BTreeMap<char, usize>);

impl Counts {
    /// The counts that follow from the dimension of space and the plane state.
    pub fn new(dim: usize, plane: Option<PlaneState>) -> Self {
        let mut counts = Self::default();
        counts.set('d', dim);
        counts.set('v', PlaneState::components(plane));
        counts
    }

    /// The count of a letter; 0 if no dataset has it.
    pub fn of(&self, letter: char) -> usize {
        self.0.get(&letter).copied().unwrap_or(0)
    }

    /// Sets the count of a letter.
    pub fn set(&mut self, letter: char, count: usize) {
        self.0.insert(letter, count);
    }

    /// The extents of a field's shape; unknown letters count 0.
    pub fn shape(&self, field: &Field) -> Vec<usize> {
        let terms = self.terms(field).into_iter();
        terms.map(|term| self.sum(term).0).collect()
    }

    /// Compares the extents of a field with its shape. If one letter of an extent is unknown, its count is set from the
    /// extent.
    ///
    /// # Errors
    /// The expected shape.
    pub fn match_shape(&mut self, field: &Field, found: &[usize]) -> Result<(), String> {
        let terms = self.terms(field);
        // h5py writes `data=[]` with shape (0,) whatever the width of a row.
        let rows = match found {
            [0] => &terms[..1],
            _ => &terms[..],
        };
        let mut fits = rows.len() == found.len();
        for (&term, &extent) in rows.iter().zip(found) {
            match self.sum(term) {
                (known, None) => fits &= known == extent,
                (known, Some(letter)) => match extent.checked_sub(known) {
                    Some(count) => self.set(letter, count),
                    None => fits = false,
                },
            }
        }
        match fits {
            true => Ok(()),
            false => Err(self.expected(&terms)),
        }
    }

    /// The extents of a field: one with a question mark only if it isn't 0.
    fn terms(&self, field: &Field) -> Vec<&'static str> {
        let terms = field.shape.split(", ");
        let present = terms.filter_map(|term| match term.strip_suffix('?') {
            Some(term) => (self.sum(term).0 > 0).then_some(term),
            None => Some(term),
        });
        present.collect()
    }

    /// The sum of an extent's known parts, and its unknown letter.
    fn sum(&self, term: &str) -> (usize, Option<char>) {
        let (mut sum, mut unknown) = (0, None);
        for part in term.split(" + ") {
            let letter = part.chars().next().unwrap_or_default();
            match part.parse().ok().or_else(|| self.0.get(&letter).copied()) {
                Some(count) => sum += count,
                None => unknown = Some(letter),
            }
        }
        (sum, unknown)
    }

    /// A shape in words: "[R, d] with R = 12 contact points".
    fn expected(&self, terms: &[&str]) -> String {
        let shape = terms.join(", ");
        let known = self.0.iter().filter(|(letter, _)| shape.contains(**letter));
        let known: Vec<String> = known
            .map(|(&letter, count)| format!("{letter} = {count} {}", noun(letter)))
            .collect();
        match known.is_empty() {
            true => format!("[{shape}]"),
            false => format!("[{shape}] with {}", known.join(", ")),
        }
    }
}
