//! One dataset: an array with a row for each node, cell or condition.

use hdf5::{Dataset, Group, H5Type, Result};
use ndarray::{ArrayView1, ArrayView2};

/// A group, which an earlier run may have made.
pub(super) fn group(parent: &Group, name: &str) -> Result<Group> {
    match parent.link_exists(name) {
        true => parent.group(name),
        false => parent.create_group(name),
    }
}

/// A column of `rows` rows to be filled later, or that of an earlier run.
pub(super) fn empty<T: H5Type>(group: &Group, name: &str, rows: usize) -> Result<Dataset> {
    match group.link_exists(name) {
        true => group.dataset(name),
        false => group.new_dataset::<T>().shape(rows).create(name),
    }
}

/// A table of `rows` rows of `width` numbers to be filled later, or that of an earlier run.
pub(super) fn empty_table<T: H5Type>(
    group: &Group,
    name: &str,
    rows: usize,
    width: usize,
) -> Result<Dataset> {
    match group.link_exists(name) {
        true => group.dataset(name),
        false => group.new_dataset::<T>().shape((rows, width)).create(name),
    }
}

/// A column of `rows` rows for each of some load `steps`, (steps, rows); a plain one where there are none.
pub(super) fn empty_by_step<T: H5Type>(
    group: &Group,
    name: &str,
    steps: usize,
    rows: usize,
) -> Result<Dataset> {
    match steps {
        0 => empty::<T>(group, name, rows),
        _ => empty_table::<T>(group, name, steps, rows),
    }
}

/// A column that is filled at once.
pub(super) fn whole<T: H5Type>(
    group: &Group,
    name: &str,
    values: impl Iterator<Item = T>,
) -> Result<()> {
    let values: Vec<T> = values.collect();
    fill(&empty::<T>(group, name, values.len())?, 0, &values)
}

/// Fills a column from row `start` on.
pub(super) fn fill<T: H5Type>(column: &Dataset, start: usize, values: &[T]) -> Result<()> {
    column.write_slice(ArrayView1::from(values), start..start + values.len())
}

/// Fills the column of a load step from row `start` on.
pub(super) fn fill_by_step<T: H5Type>(
    columns: &Dataset,
    step: usize,
    start: usize,
    values: &[T],
) -> Result<()> {
    match columns.ndim() {
        1 => fill(columns, start, values),
        _ => columns.write_slice(
            ArrayView1::from(values),
            (step, start..start + values.len()),
        ),
    }
}

/// Fills a table from row `start` on.
pub(super) fn fill_table<T: H5Type, const N: usize>(
    table: &Dataset,
    start: usize,
    rows: &[[T; N]],
) -> Result<()> {
    table.write_slice(ArrayView2::from(rows), (start..start + rows.len(), ..))
}
