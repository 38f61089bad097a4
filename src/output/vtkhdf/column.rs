//! A dataset: an array with a row for each node, cell or constraint.

use bytemuck::Pod;
use hdf5::plist::dataset_create::AllocTime;
use hdf5::{Dataset, Group, H5Type, Hyperslab, Result, SliceOrIndex};
use ndarray::ArrayViewD;

use super::checkpoint::{Column, digest};

/// A row of a dataset: one number or several.
pub(crate) trait Row: Pod {
    /// The type of its numbers.
    type Number: H5Type + Pod;
    /// Number of components; `None` for a scalar.
    const WIDTH: Option<usize> = None;
}

impl Row for f64 {
    type Number = Self;
}

impl Row for i64 {
    type Number = Self;
}

impl Row for i32 {
    type Number = Self;
}

impl Row for u8 {
    type Number = Self;
}

impl<T: Row + H5Type, const N: usize> Row for [T; N]
where
    [T; N]: Pod,
{
    type Number = T;
    const WIDTH: Option<usize> = Some(N);
}

/// Rows of a dataset, of any type.
pub(crate) trait List {
    /// Number of rows.
    fn rows(&self) -> usize;

    /// Creates a dataset for `rows` rows of this type in each of the load `steps`, see [`empty`].
    fn empty(&self, group: &Group, name: &str, steps: usize, rows: usize) -> Result<Dataset>;

    /// Writes the rows of a load step from row `start` on.
    fn fill(&self, dataset: &Dataset, step: usize, start: usize) -> Result<()>;

    /// The rows as stored in the file.
    fn bytes(&self) -> &[u8];

    /// Size of a row (bytes).
    fn row_bytes(&self) -> usize;
}

impl<R: Row> List for Vec<R> {
    fn rows(&self) -> usize {
        self.len()
    }

    fn empty(&self, group: &Group, name: &str, steps: usize, rows: usize) -> Result<Dataset> {
        empty::<R>(group, name, steps, rows)
    }

    fn fill(&self, dataset: &Dataset, step: usize, start: usize) -> Result<()> {
        fill(dataset, step, start, self)
    }

    fn bytes(&self) -> &[u8] {
        bytemuck::cast_slice(self)
    }

    fn row_bytes(&self) -> usize {
        size_of::<R>()
    }
}

/// A dataset that is written in every load step, or in the first one only.
#[derive(Debug)]
pub(super) struct Written {
    dataset: Dataset,
    /// Number of rows, for every load step if it has them.
    rows: usize,
    /// Number of load steps with their own rows.
    steps: Option<usize>,
    /// Digest of the rows written in this load step.
    digest: u64,
}

impl Written {
    /// An [`empty`] dataset for rows like those of `list`.
    pub(super) fn empty(
        list: &dyn List,
        group: &Group,
        name: &str,
        steps: usize,
        rows: usize,
    ) -> Result<Self> {
        Ok(Self {
            dataset: list.empty(group, name, steps, rows)?,
            rows,
            steps: (steps > 0).then_some(steps),
            digest: 0,
        })
    }

    /// [Writes](fill) rows of a load step from row `start` on.
    pub(super) fn fill(&mut self, step: usize, start: usize, list: &dyn List) -> Result<()> {
        let first = self.steps.map_or(start, |_| step * self.rows + start);
        let of_rows = digest(first, list.row_bytes(), list.bytes());
        self.digest = self.digest.wrapping_add(of_rows);
        list.fill(&self.dataset, step, start)
    }

    /// Ends a load step; returns the digest of the rows written in it.
    pub(super) fn finish_step(&mut self) -> u64 {
        std::mem::take(&mut self.digest)
    }

    /// The column by its place in the file.
    pub(super) fn column(&self) -> Result<Column> {
        Column::new(&self.dataset, self.rows, self.steps)
    }
}

/// A group, created unless an earlier run has done so.
pub(super) fn group(parent: &Group, name: &str) -> Result<Group> {
    match parent.link_exists(name) {
        true => parent.group(name),
        false => parent.create_group(name),
    }
}

/// A dataset of `rows` rows to be filled later, or the one created by an earlier run; of shape (steps, rows) or (steps,
/// rows, width) if there are load `steps`.
pub(super) fn empty<R: Row>(
    group: &Group,
    name: &str,
    steps: usize,
    rows: usize,
) -> Result<Dataset> {
    if group.link_exists(name) {
        return group.dataset(name);
    }
    let steps = (steps > 0).then_some(steps).into_iter();
    let shape: Vec<usize> = steps.chain([rows]).chain(R::WIDTH).collect();
    // Allocated immediately, so that its place in the file is fixed.
    let new = group.new_dataset::<R::Number>().shape(shape);
    new.alloc_time(Some(AllocTime::Early)).create(name)
}

/// A column that is written at once.
pub(super) fn whole<R: Row>(
    group: &Group,
    name: &str,
    values: impl Iterator<Item = R>,
) -> Result<()> {
    let values: Vec<R> = values.collect();
    fill(&empty::<R>(group, name, 0, values.len())?, 0, 0, &values)
}

/// Writes the rows of a load step from row `start` on, to a dataset with or without load steps.
pub(super) fn fill<R: Row>(dataset: &Dataset, step: usize, start: usize, rows: &[R]) -> Result<()> {
    let numbers: &[R::Number] = bytemuck::cast_slice(rows);
    let shape: Vec<usize> = [rows.len()].into_iter().chain(R::WIDTH).collect();
    let step = (dataset.ndim() > shape.len()).then_some(SliceOrIndex::from(step));
    let of_row = R::WIDTH.map(|_| SliceOrIndex::from(..));
    let place = step
        .into_iter()
        .chain([SliceOrIndex::from(start..start + rows.len())]);
    let place: Vec<SliceOrIndex> = place.chain(of_row).collect();
    let values = ArrayViewD::from_shape(shape, numbers)?;
    dataset.write_slice(values, Hyperslab::from(place))
}
