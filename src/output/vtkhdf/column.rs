//! One dataset: an array with a row for each node, cell or condition.

use bytemuck::Pod;
use hdf5::{Dataset, Group, H5Type, Result};
use ndarray::{ArrayView1, ArrayView2};

/// A row of a dataset: a number, or some.
pub(crate) trait Row: Pod {
    /// The type of its numbers.
    type Number: H5Type + Pod;
    /// How many they are; `None` for a number that is alone.
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

/// Rows for a dataset, whatever their type.
pub(crate) trait List {
    /// Number of rows.
    fn rows(&self) -> usize;

    /// Makes a dataset for `rows` rows of this type, see [`empty`].
    fn empty(&self, group: &Group, name: &str, rows: usize) -> Result<Dataset>;

    /// Fills a dataset from row `start` on.
    fn fill(&self, dataset: &Dataset, start: usize) -> Result<()>;
}

impl<R: Row> List for Vec<R> {
    fn rows(&self) -> usize {
        self.len()
    }

    fn empty(&self, group: &Group, name: &str, rows: usize) -> Result<Dataset> {
        empty::<R>(group, name, rows)
    }

    fn fill(&self, dataset: &Dataset, start: usize) -> Result<()> {
        fill(dataset, start, self)
    }
}

/// A group, which an earlier run may have made.
pub(super) fn group(parent: &Group, name: &str) -> Result<Group> {
    match parent.link_exists(name) {
        true => parent.group(name),
        false => parent.create_group(name),
    }
}

/// A dataset of `rows` rows to be filled later, or that of an earlier run.
pub(super) fn empty<R: Row>(group: &Group, name: &str, rows: usize) -> Result<Dataset> {
    let new = || group.new_dataset::<R::Number>();
    match R::WIDTH {
        _ if group.link_exists(name) => group.dataset(name),
        None => new().shape(rows).create(name),
        Some(width) => new().shape((rows, width)).create(name),
    }
}

/// A dataset of `rows` rows for each of some load `steps`, (steps, rows) or (steps, rows, width); a plain one
/// where there are none.
pub(super) fn empty_by_step<R: Row>(
    group: &Group,
    name: &str,
    steps: usize,
    rows: usize,
) -> Result<Dataset> {
    match steps {
        0 => empty::<R>(group, name, rows),
        _ if group.link_exists(name) => group.dataset(name),
        _ => {
            let new = group.new_dataset::<R::Number>();
            match R::WIDTH {
                None => new.shape((steps, rows)).create(name),
                Some(width) => new.shape((steps, rows, width)).create(name),
            }
        }
    }
}

/// A column that is filled at once.
pub(super) fn whole<R: Row>(
    group: &Group,
    name: &str,
    values: impl Iterator<Item = R>,
) -> Result<()> {
    let values: Vec<R> = values.collect();
    fill(&empty::<R>(group, name, values.len())?, 0, &values)
}

/// Fills a dataset from row `start` on.
pub(super) fn fill<R: Row>(dataset: &Dataset, start: usize, rows: &[R]) -> Result<()> {
    let numbers: &[R::Number] = bytemuck::cast_slice(rows);
    let range = start..start + rows.len();
    match R::WIDTH {
        None => dataset.write_slice(ArrayView1::from(numbers), range),
        Some(width) => {
            let table = ArrayView2::from_shape((rows.len(), width), numbers);
            dataset.write_slice(table.map_err(|why| why.to_string())?, (range, ..))
        }
    }
}

/// Fills what a dataset has of a load step from row `start` on; all of it where there are no steps.
pub(super) fn fill_by_step<R: Row>(
    dataset: &Dataset,
    step: usize,
    start: usize,
    rows: &[R],
) -> Result<()> {
    let plain = 1 + usize::from(R::WIDTH.is_some());
    if dataset.ndim() == plain {
        return fill(dataset, start, rows);
    }
    let numbers: &[R::Number] = bytemuck::cast_slice(rows);
    let range = start..start + rows.len();
    match R::WIDTH {
        None => dataset.write_slice(ArrayView1::from(numbers), (step, range)),
        Some(width) => {
            let table = ArrayView2::from_shape((rows.len(), width), numbers);
            dataset.write_slice(table.map_err(|why| why.to_string())?, (step, range, ..))
        }
    }
}
