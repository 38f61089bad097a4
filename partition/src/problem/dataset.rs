//! A dataset that knows its name: reads slices and says what is wrong with them, and where.

use std::collections::HashMap;
use std::ops::Range;

use hdf5::plist::dataset_create::Layout;
use hdf5::types::TypeDescriptor;

use super::strings::read_strings;
use crate::element::geometry::padded;
use crate::error::InputError;
use crate::{magnitude, name};

/// The best compression that HDF5's deflate reaches; a dataset that declares more isn't there.
const LARGEST_RATIO: u64 = 1100;

/// An open dataset.
pub(super) struct Dataset {
    name: &'static str,
    inner: hdf5::Dataset,
    shape: Vec<usize>,
}

impl Dataset {
    /// Opens the dataset called `name` and makes sure that its data are in the file.
    pub fn open(file: &hdf5::File, name: &'static str) -> Result<Self, InputError> {
        let inner = file
            .dataset(name)
            .map_err(|_| InputError::new(format!("dataset {name} is missing")))?;
        let shape = inner.shape();
        let dataset = Self { name, inner, shape };
        dataset.check_layout()?;
        dataset.check_storage(file.size())?;
        Ok(dataset)
    }

    /// Opens a dataset with one row of a single number for each of `rows`, if that is known.
    pub fn column(
        file: &hdf5::File,
        name: &'static str,
        rows: Option<usize>,
    ) -> Result<Self, InputError> {
        Self::open(file, name)?.shaped(rows, &[])
    }

    /// Opens a dataset with a vector of `width` numbers in each of `rows` rows.
    pub fn table(
        file: &hdf5::File,
        name: &'static str,
        rows: Option<usize>,
        width: usize,
    ) -> Result<Self, InputError> {
        Self::open(file, name)?.shaped(rows, &[width])
    }

    /// Checks the shape: `rows` (any number if `None`) times `row`.
    pub fn shaped(self, rows: Option<usize>, row: &[usize]) -> Result<Self, InputError> {
        let fits = self.shape.len() == 1 + row.len()
            && self.shape[1..] == *row
            && rows.is_none_or(|rows| self.shape[0] == rows);
        // h5py writes `data=[]` with shape (0,) whatever the width of a row.
        let empty = self.shape == [0] && rows.is_none_or(|rows| rows == 0);
        if fits || empty {
            return Ok(self);
        }
        let rows = rows.map_or("any".to_owned(), |rows| rows.to_string());
        let expected: Vec<String> = std::iter::once(rows)
            .chain(row.iter().map(ToString::to_string))
            .collect();
        Err(self.error(&format!(
            "has shape {:?}; expected [{}]",
            self.shape,
            expected.join(", ")
        )))
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.shape.first().copied().unwrap_or(0)
    }

    /// An error about the whole dataset.
    pub fn error(&self, what: &str) -> InputError {
        InputError::new(format!("dataset {}: {what}", self.name))
    }

    /// An error about one row.
    pub fn row_error(&self, row: usize, what: &str) -> InputError {
        InputError::new(format!("dataset {}, row {row}: {what}", self.name))
    }

    /// Reads integers of any width.
    pub fn integers(&self, rows: Range<usize>) -> Result<Vec<i64>, InputError> {
        match self.descriptor()? {
            TypeDescriptor::Integer(_) | TypeDescriptor::Unsigned(_) => self.slice(rows),
            other => Err(self.error(&format!("holds {other}; expected integers"))),
        }
    }

    /// Reads all integers.
    pub fn all_integers(&self) -> Result<Vec<i64>, InputError> {
        self.integers(0..self.rows())
    }

    /// Reads integers that are `what` below `count`.
    pub fn indices(
        &self,
        rows: Range<usize>,
        count: usize,
        what: &str,
    ) -> Result<Vec<u32>, InputError> {
        let start = rows.start;
        self.indices_of(&self.integers(rows)?, start, count, what)
    }

    /// Makes integers that stand from row `start` on indices of `what` below `count`.
    pub fn indices_of(
        &self,
        values: &[i64],
        start: usize,
        count: usize,
        what: &str,
    ) -> Result<Vec<u32>, InputError> {
        let index = |(row, &value): (usize, &i64)| {
            let index = u32::try_from(value).ok();
            index.filter(|&i| (i as usize) < count).ok_or_else(|| {
                let expected = match count {
                    0 => "there is none".to_owned(),
                    _ => format!("expected 0 to {}", count - 1),
                };
                self.row_error(start + row, &format!("{value} is no {what}; {expected}"))
            })
        };
        values.iter().enumerate().map(index).collect()
    }

    /// Reads a table of offsets that rises from 0 to `end`.
    pub fn offsets(&self, end: usize) -> Result<Vec<usize>, InputError> {
        let values = self.all_integers()?;
        let mut offsets = Vec::with_capacity(values.len());
        for (row, &value) in values.iter().enumerate() {
            let least = offsets.last().copied().unwrap_or(0);
            match usize::try_from(value) {
                Ok(offset) if (least..=end).contains(&offset) => offsets.push(offset),
                _ => {
                    return Err(self.row_error(
                        row,
                        &format!("offset {value}; expected one of {least} to {end}"),
                    ));
                }
            }
        }
        match (offsets.first(), offsets.last()) {
            (Some(&0), Some(&last)) if last == end => Ok(offsets),
            _ => Err(self.error(&format!(
                "expected offsets that start at 0 and end at {end}"
            ))),
        }
    }

    /// Reads finite numbers of any width, `width` a row.
    pub fn floats(&self, rows: Range<usize>) -> Result<Vec<f64>, InputError> {
        let start = rows.start;
        let count = rows.len();
        let values = self.any_floats(rows)?;
        let width = values.len().checked_div(count).unwrap_or(1).max(1);
        for (at, &value) in values.iter().enumerate() {
            magnitude::check(value).map_err(|expected| {
                let what = format!("{value:e}; expected {expected}");
                self.row_error(start + at / width, &what)
            })?;
        }
        Ok(values)
    }

    /// Reads numbers that may be NaN.
    pub fn any_floats(&self, rows: Range<usize>) -> Result<Vec<f64>, InputError> {
        match self.descriptor()? {
            TypeDescriptor::Integer(_) | TypeDescriptor::Unsigned(_) | TypeDescriptor::Float(_) => {
                self.slice(rows)
            }
            other => Err(self.error(&format!("holds {other}; expected numbers"))),
        }
    }

    /// Reads vectors of `width` finite components; the others are zero.
    pub fn vectors(&self, rows: Range<usize>, width: usize) -> Result<Vec<[f64; 3]>, InputError> {
        let values = self.floats(rows)?;
        Ok(values.chunks_exact(width).map(padded).collect())
    }

    /// Reads unit vectors of `width` components.
    pub fn unit_vectors(
        &self,
        rows: Range<usize>,
        width: usize,
    ) -> Result<Vec<[f64; 3]>, InputError> {
        let start = rows.start;
        let vectors = self.vectors(rows, width)?;
        self.check_unit(&vectors, start)?;
        Ok(vectors)
    }

    /// Checks that vectors that stand from row `start` on have the length 1.
    pub fn check_unit(&self, vectors: &[[f64; 3]], start: usize) -> Result<(), InputError> {
        for (row, vector) in vectors.iter().enumerate() {
            let length = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
            if (length - 1.0).abs() > super::UNIT_TOLERANCE {
                return Err(self.row_error(
                    start + row,
                    &format!("the vector has length {length}; expected 1"),
                ));
            }
        }
        Ok(())
    }

    /// Reads all strings, of variable or fixed length, each a line of text.
    pub fn strings(&self) -> Result<Vec<String>, InputError> {
        self.checked_strings(name::check_text)
    }

    /// Reads all names, of which there has to be one at least.
    pub fn names(&self) -> Result<Vec<String>, InputError> {
        match self.checked_strings(name::check)? {
            names if names.is_empty() => Err(self.error("is empty; expected at least one name")),
            names => Ok(names),
        }
    }

    /// Reads the names of contacts, each another one.
    pub fn contact_names(&self) -> Result<Vec<String>, InputError> {
        let names = self.checked_strings(name::check_contact)?;
        let mut seen = HashMap::new();
        for (row, name) in names.iter().enumerate() {
            if let Some(first) = seen.insert(name, row) {
                let what = format!("'{name}' is the name of contact {first} already");
                return Err(self.row_error(row, &what));
            }
        }
        Ok(names)
    }

    fn checked_strings(
        &self,
        check: fn(&str) -> Result<(), &'static str>,
    ) -> Result<Vec<String>, InputError> {
        let strings = read_strings(&self.inner).map_err(|reason| self.error(&reason))?;
        for (row, text) in strings.iter().enumerate() {
            check(text).map_err(|reason| {
                self.row_error(row, &format!("'{}' {reason}", name::shown(text)))
            })?;
        }
        Ok(strings)
    }

    fn descriptor(&self) -> Result<TypeDescriptor, InputError> {
        self.inner
            .dtype()
            .and_then(|dtype| dtype.to_descriptor())
            .map_err(|reason| self.error(&format!("has a type that can't be read: {reason}")))
    }

    fn slice<T: hdf5::H5Type>(&self, rows: Range<usize>) -> Result<Vec<T>, InputError> {
        if rows.is_empty() {
            return Ok(Vec::new());
        }
        let data = if rows == (0..self.rows()) {
            self.inner.read_raw()
        } else if self.shape.len() == 1 {
            self.inner
                .read_slice_1d::<T, _>(rows)
                .map(|array| array.into_raw_vec_and_offset().0)
        } else if self.shape.len() == 2 {
            self.inner
                .read_slice_2d::<T, _>((rows, ..))
                .map(|array| array.into_raw_vec_and_offset().0)
        } else {
            self.inner
                .read_slice::<T, _, ndarray::Ix3>((rows, .., ..))
                .map(|array| array.into_raw_vec_and_offset().0)
        };
        data.map_err(|reason| self.error(&format!("can't be read: {reason}")))
    }

    /// No other file is read than the one that was named.
    fn check_layout(&self) -> Result<(), InputError> {
        let creation = self
            .inner
            .dcpl()
            .map_err(|reason| self.error(&format!("can't be read: {reason}")))?;
        let is_here = matches!(
            creation.layout(),
            Layout::Compact | Layout::Contiguous | Layout::Chunked
        );
        match is_here && creation.external().is_empty() {
            true => Ok(()),
            false => Err(self.error("lies in another file; expected all data in this one")),
        }
    }

    /// No allocation may follow a shape that the file doesn't fill.
    fn check_storage(&self, file_size: u64) -> Result<(), InputError> {
        let element = self.inner.dtype().map_or(0, |dtype| dtype.size());
        let declared = self
            .shape
            .iter()
            .try_fold(element as u64, |size, &n| size.checked_mul(n as u64));
        let stored = self.inner.storage_size();
        let holds = match self.inner.filters().is_empty() {
            true => stored,
            false => stored.saturating_mul(LARGEST_RATIO),
        };
        match declared {
            Some(declared) if declared <= holds && stored <= file_size => Ok(()),
            _ => Err(self.error(&format!(
                "has shape {:?}, but the file holds only {} bytes of it",
                self.shape,
                stored.min(file_size)
            ))),
        }
    }
}
