//! A dataset of the schema: opens it and checks its type and shape.

use std::ops::Range;

use hdf5::plist::dataset_create::Layout;
use hdf5::types::TypeDescriptor;

use super::slice::Slice;
use crate::error::InputError;
use crate::problem::schema::{Counts, Field};
use crate::problem::strings::read_strings;

/// The largest compression ratio of HDF5's deflate; a dataset that declares more data than that isn't fully stored.
const LARGEST_RATIO: u64 = 1100;

/// An open dataset.
#[derive(Debug)]
pub(super) struct Dataset {
    pub field: &'static Field,
    inner: hdf5::Dataset,
    shape: Vec<usize>,
}

impl Dataset {
    /// Opens a dataset and checks that the file contains its data, with the type and shape of the schema. Unknown
    /// counts of letters in its shape are set from it.
    pub fn open(
        file: &hdf5::File,
        field: &'static Field,
        counts: &mut Counts,
    ) -> Result<Self, InputError> {
        let inner = file
            .dataset(field.path)
            .map_err(|_| InputError::new(format!("dataset {} is missing", field.path)))?;
        let shape = inner.shape();
        let dataset = Self {
            field,
            inner,
            shape,
        };
        dataset.check_layout()?;
        dataset.check_storage(file.size())?;
        dataset.check_type()?;
        counts
            .match_shape(field, &dataset.shape)
            .map_err(|expected| {
                dataset.error(&format!(
                    "has shape {:?}; expected {expected}",
                    dataset.shape
                ))
            })?;
        Ok(dataset)
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.shape.first().copied().unwrap_or(0)
    }

    /// An error about the whole dataset.
    pub fn error(&self, what: &str) -> InputError {
        InputError::new(format!("dataset {}: {what}", self.field.path))
    }

    /// Reads some of the rows.
    pub fn slice<T: hdf5::H5Type>(&self, rows: Range<usize>) -> Result<Slice<T>, InputError> {
        let width = self.shape.iter().skip(1).product();
        if rows.is_empty() {
            return Ok(Slice::new(self.field.path, rows.start, width, Vec::new()));
        }
        let first = rows.start;
        let values = match self.shape.len() {
            _ if rows == (0..self.rows()) => self.inner.read_raw(),
            1 => flat(self.inner.read_slice_1d(rows)),
            2 => flat(self.inner.read_slice_2d((rows, ..))),
            _ => flat(self.inner.read_slice::<_, _, ndarray::Ix3>((rows, .., ..))),
        };
        let values = values.map_err(|reason| self.error(&format!("can't be read: {reason}")))?;
        Ok(Slice::new(self.field.path, first, width, values))
    }

    /// Reads all strings.
    pub fn strings(&self) -> Result<Vec<String>, InputError> {
        read_strings(&self.inner).map_err(|reason| self.error(&reason))
    }

    /// Checks the type; an empty list has none in h5py.
    fn check_type(&self) -> Result<(), InputError> {
        use TypeDescriptor::{
            FixedAscii, FixedUnicode, Float, Integer, Unsigned, VarLenAscii, VarLenUnicode,
        };
        let descriptor = self.inner.dtype().and_then(|dtype| dtype.to_descriptor());
        let found = descriptor
            .map_err(|reason| self.error(&format!("has a type that can't be read: {reason}")))?;
        let expected = self.field.kind.word();
        let fits = match found {
            Integer(_) | Unsigned(_) => expected != "strings",
            Float(_) => expected == "numbers",
            VarLenUnicode | VarLenAscii | FixedUnicode(_) | FixedAscii(_) => expected == "strings",
            _ => false,
        };
        match fits || self.inner.size() == 0 {
            true => Ok(()),
            false => Err(self.error(&format!("holds {found}; expected {expected}"))),
        }
    }

    /// Checks that the data are in this file, as no other file is to be read.
    fn check_layout(&self) -> Result<(), InputError> {
        let creation = self.inner.dcpl();
        let creation =
            creation.map_err(|reason| self.error(&format!("can't be read: {reason}")))?;
        let is_here = matches!(
            creation.layout(),
            Layout::Compact | Layout::Contiguous | Layout::Chunked
        );
        match is_here && creation.external().is_empty() {
            true => Ok(()),
            false => Err(self.error("lies in another file; expected all data in this one")),
        }
    }

    /// Checks that the data have the declared size, so that no allocation exceeds the file's content.
    fn check_storage(&self, file_size: u64) -> Result<(), InputError> {
        let element = self.inner.dtype().map_or(0, |dtype| dtype.size());
        let declared = (self.shape.iter()).try_fold(element as u64, |size, &extent| {
            size.checked_mul(extent as u64)
        });
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

fn flat<T, D: ndarray::Dimension>(
    read: hdf5::Result<ndarray::Array<T, D>>,
) -> hdf5::Result<Vec<T>> {
    read.map(|array| array.into_raw_vec_and_offset().0)
}
