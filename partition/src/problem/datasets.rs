//! The datasets of a problem file being written, with the shapes of the schema.

use hdf5::H5Type;
use hdf5::types::TypeDescriptor;

use super::SubdomainNode;
use super::schema::{Counts, FIELDS};
use super::strings::{type_of, write_strings};

/// The datasets of a file being written.
pub(super) struct Datasets<'a> {
    pub(super) file: &'a hdf5::File,
    pub(super) counts: Counts,
}

impl Datasets<'_> {
    /// Writes values row by row, with the shape of the schema.
    pub(super) fn put<T: H5Type>(
        &mut self,
        path: &str,
        values: impl Iterator<Item = T>,
    ) -> hdf5::Result<()> {
        let values: Vec<T> = values.collect();
        let dataset = self.create(path, &T::type_descriptor(), values.len())?;
        match values.is_empty() {
            true => Ok(()),
            false => dataset.write_raw(&values),
        }
    }

    /// Creates a dataset for a number of values of a type, with the shape of the schema.
    fn create(
        &mut self,
        path: &str,
        of: &TypeDescriptor,
        values: usize,
    ) -> hdf5::Result<hdf5::Dataset> {
        let field = FIELDS.iter().find(|field| field.path == path);
        let field = field.ok_or_else(|| format!("the schema has no {path}"))?;
        let mut shape = self.counts.shape(field);
        shape[0] = values / shape[1..].iter().product::<usize>();
        (self.counts.match_shape(field, &shape))
            .map_err(|expected| format!("{path} has shape {shape:?}; expected {expected}"))?;
        group(self.file, field.group())?;
        let new = self.file.new_dataset_builder().empty_as(of);
        new.shape(shape).create(path)
    }

    /// Writes for each of `count` items whether it is present, row by row; nothing if none is ever `absent`.
    pub(super) fn presence<'v>(
        &mut self,
        path: &str,
        count: usize,
        absent: impl Iterator<Item = &'v Vec<u32>> + Clone,
    ) -> hdf5::Result<()> {
        if absent.clone().all(Vec::is_empty) {
            return Ok(());
        }
        let of_row = |absent: &'v Vec<u32>| {
            (0..count as u32).map(move |number| i64::from(!absent.contains(&number)))
        };
        self.put(path, absent.flat_map(of_row))
    }

    /// Writes vectors with as many components as the shape has.
    pub(super) fn vectors<'v>(
        &mut self,
        path: &str,
        vectors: impl Iterator<Item = &'v [f64; 3]>,
    ) -> hdf5::Result<()> {
        let width = match path {
            "/VTKHDF/Points" => 3,
            _ => self.counts.of('d'),
        };
        self.put(path, vectors.flat_map(|v| &v[..width]).copied())
    }

    pub(super) fn offsets(
        &mut self,
        path: &str,
        counts: impl Iterator<Item = usize>,
    ) -> hdf5::Result<()> {
        let mut end = 0;
        let ends = counts.map(|count| {
            end += count as i64;
            end
        });
        self.put(path, std::iter::once(0).chain(ends))
    }

    /// Writes nodes with weights of a `group`, point by point.
    pub(super) fn entries<'v>(
        &mut self,
        group: &str,
        points: impl Iterator<Item = &'v Vec<(SubdomainNode, f64)>> + Clone,
    ) -> hdf5::Result<()> {
        let path = |name: &str| format!("{group}/entry_{name}");
        self.offsets(&path("offset"), points.clone().map(Vec::len))?;
        let all = points.flatten();
        let nodes = || all.clone().map(|(node, _)| node);
        self.integers(&path("subdomain"), nodes().map(|node| node.subdomain))?;
        self.integers(&path("node"), nodes().map(|node| node.node))?;
        self.put(&path("weight"), all.clone().map(|&(_, weight)| weight))
    }

    pub(super) fn integers<T: Into<i64>>(
        &mut self,
        path: &str,
        values: impl Iterator<Item = T>,
    ) -> hdf5::Result<()> {
        self.put(path, values.map(Into::into))
    }

    pub(super) fn strings<'v>(
        &mut self,
        path: &str,
        strings: impl Iterator<Item = &'v str>,
    ) -> hdf5::Result<()> {
        let texts: Vec<String> = strings.map(without_nul).collect();
        let dataset = self.create(path, &type_of(&texts), texts.len())?;
        write_strings(&dataset, &texts)
    }
}

/// Opens or creates a group and its parents: without time stamps, so that equal problems give equal files.
pub(super) fn group(file: &hdf5::File, path: &str) -> hdf5::Result<hdf5::Group> {
    let mut group = file.group("/")?;
    for name in path.split('/').filter(|name| !name.is_empty()) {
        group = match group.link_exists(name) {
            true => group.group(name)?,
            false => {
                let new = group.create_group_builder().obj_track_times(false);
                new.create(name)?
            }
        };
    }
    Ok(group)
}

/// The text up to its first NUL, at which HDF5's strings end.
pub(super) fn without_nul(text: &str) -> String {
    text.replace('\0', "\u{fffd}")
}
