//! Consecutive rows of a dataset in memory, and checks of their values.

use std::ops::Range;

use crate::element::geometry::{length, padded};
use crate::error::InputError;
use crate::magnitude;
use crate::problem::UNIT_TOLERANCE;
use crate::problem::schema::Kind;

/// Name of indices of nodes in messages.
pub(super) const NODE: &str = "node of its subdomain";

/// Consecutive rows of a dataset; rows are counted as in the dataset.
pub(super) struct Slice<T> {
    name: &'static str,
    first: usize,
    width: usize,
    values: Vec<T>,
}

/// A valid index of one of `count` items.
fn index(value: i64, what: &str, count: usize) -> Result<u32, String> {
    let index = u32::try_from(value).ok();
    let index = index.filter(|&index| (index as usize) < count);
    index.ok_or_else(|| match count {
        0 => format!("{value} is no {what}; there is none"),
        _ => format!("{value} is no {what}; expected 0 to {}", count - 1),
    })
}

impl<T> Slice<T> {
    /// The rows from `first` on, of `width` values each.
    pub fn new(name: &'static str, first: usize, width: usize, values: Vec<T>) -> Self {
        Self {
            name,
            first,
            width,
            values,
        }
    }

    /// All values.
    pub fn all(&self) -> &[T] {
        &self.values
    }

    /// The values of some of the rows.
    pub fn of(&self, rows: Range<usize>) -> &[T] {
        let at = |row: usize| self.width * (row - self.first);
        &self.values[at(rows.start)..at(rows.end)]
    }

    /// An error about one row.
    pub fn error(&self, row: usize, what: &str) -> InputError {
        InputError::new(format!("dataset {}, row {row}: {what}", self.name))
    }

    /// Checks the values one by one; an error of `law` is the expectation.
    fn check(&self, law: impl Fn(&T) -> Result<(), String>) -> Result<(), InputError> {
        let mut values = self.values.iter().enumerate();
        let wrong = values.find_map(|(at, value)| Some((at, law(value).err()?)));
        wrong.map_or(Ok(()), |(at, what)| {
            Err(self.error(self.first + at / self.width.max(1), &what))
        })
    }
}

impl Slice<i64> {
    /// Checks that all values are indices below `count`.
    pub fn check_indices(&self, what: &str, count: usize) -> Result<(), InputError> {
        self.check(|&value| index(value, what, count).map(|_| ()))
    }

    /// The values of some of the rows as indices below `count`.
    pub fn indices(
        &self,
        rows: Range<usize>,
        what: &str,
        count: usize,
    ) -> Result<Vec<u32>, InputError> {
        let values = self.of(rows.clone()).iter().zip(rows);
        let index = |(&value, row)| index(value, what, count).map_err(|e| self.error(row, &e));
        values.map(index).collect()
    }

    /// The values as offsets that ascend from 0 to `end`.
    pub fn offsets(&self, end: usize) -> Result<Vec<usize>, InputError> {
        let last = self.values.len().saturating_sub(1);
        let mut offsets = vec![0; self.values.len()];
        for (row, &value) in self.values.iter().enumerate() {
            let [least, most] = match row {
                _ if row == last => [end; 2],
                0 => [0; 2],
                _ => [offsets[row - 1], end],
            };
            match usize::try_from(value) {
                Ok(offset) if (least..=most).contains(&offset) => offsets[row] = offset,
                _ => {
                    let what = format!("offset {value}; expected one of {least} to {most}");
                    return Err(self.error(row, &what));
                }
            }
        }
        match offsets.first() {
            Some(&first) if first > 0 => Err(self.error(0, "expected offsets that start at 0")),
            _ => Ok(offsets),
        }
    }

    /// Offsets from the values as counts, which are positive and add up to `total`.
    pub fn running_sum(&self, total: usize, what: &str) -> Result<Vec<usize>, InputError> {
        let mut sums = vec![0];
        let mut sum = 0;
        for (row, &value) in self.values.iter().enumerate() {
            let is_last = row + 1 == self.values.len();
            let least = if is_last { total - sum } else { 1 };
            sum += match usize::try_from(value) {
                Ok(n) if n > 0 && (least..=total - sum).contains(&n) => n,
                _ => {
                    let expected = format!("positive numbers with the sum {total}, that of {what}");
                    return Err(self.error(row, &format!("{value}; expected {expected}")));
                }
            };
            sums.push(sum);
        }
        Ok(sums)
    }
}

impl Slice<f64> {
    /// Checks the condition of `kind` for every value.
    pub fn check_numbers(&self, kind: Kind) -> Result<(), InputError> {
        self.check(|&value| match kind {
            Kind::NumbersOrNan if value.is_nan() => Ok(()),
            Kind::Positive if value <= 0.0 => Err(format!("{value}; expected a positive number")),
            Kind::NotNegative if value < 0.0 => Err(format!("{value}; expected 0 or more")),
            _ => magnitude::check(value)
                .map(|_| ())
                .map_err(|expected| format!("{value:e}; expected {expected}")),
        })?;
        let rows = self.first..self.first + self.values.len() / self.width.max(1);
        match kind {
            Kind::UnitVectors => self.check_unit(rows),
            _ => Ok(()),
        }
    }

    fn check_unit(&self, rows: Range<usize>) -> Result<(), InputError> {
        for (row, vector) in rows.clone().zip(self.vectors(rows)) {
            let length = length(vector);
            if (length - 1.0).abs() > UNIT_TOLERANCE {
                let what = format!("the vector has length {length}; expected 1");
                return Err(self.error(row, &what));
            }
        }
        Ok(())
    }

    /// The vectors in some of the rows; components beyond the width are zero.
    pub fn vectors(&self, rows: Range<usize>) -> Vec<[f64; 3]> {
        let width = self.width.max(1);
        self.of(rows).chunks_exact(width).map(padded).collect()
    }
}
