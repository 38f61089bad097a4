//! `/VTKHDF`: an UnstructuredGrid in VTK's HDF format 2.0 with one partition for each subdomain.

use std::iter::repeat_n;
use std::ops::Range;

use contact_dd_partition::problem::vtkhdf;
use hdf5::{Dataset, File, Group, Result};

use super::super::result::{ListField, Of, PartitionSize, SubdomainResults};
use super::checkpoint::{Column, digest};
use super::column::List;
use super::{Layout, column};

/// Most nodes of a slab of more than one subdomain. With its cells it has about 6 MB, which still fits in the cache and
/// adds little to the root's memory; yet its columns of numbers exceed 64 KiB, up to which HDF5 reads the file before
/// it writes.
const SLAB_POINTS: usize = 1 << 14;

/// Offsets of the subdomains in the datasets of the grid.
#[derive(Debug)]
pub(super) struct GridPlacement {
    left_out: Vec<Of>,
    total: PartitionSize,
    sizes: Vec<PartitionSize>,
    starts: Vec<PartitionSize>,
    /// True if there are load steps from which a run may be resumed.
    is_kept: bool,
}

impl GridPlacement {
    pub(super) fn new(layout: &Layout) -> Self {
        let sizes = layout.partitions.clone();
        let mut starts = Vec::with_capacity(sizes.len());
        let mut total = PartitionSize::default();
        for size in &sizes {
            starts.push(total);
            total.add(size);
        }
        Self {
            left_out: layout.left_out(),
            total,
            sizes,
            starts,
            is_kept: layout.times.len() > 1,
        }
    }

    /// Adds rows from `row` on to the digest of their dataset, if finished load steps are kept.
    pub(super) fn sum(&self, digest_of_step: &mut u64, row: usize, list: &dyn List) {
        if self.is_kept {
            let of_rows = digest(row, list.row_bytes(), list.bytes());
            *digest_of_step = digest_of_step.wrapping_add(of_rows);
        }
    }

    /// Calls `put` with each list of consecutive subdomains in a load step, the number of its dataset, and its first
    /// row there.
    ///
    /// # Errors
    /// Results that don't have the sizes of the layout, or an error of `put`.
    pub(super) fn each(
        &self,
        results: &SubdomainResults,
        step: usize,
        mut put: impl FnMut(usize, usize, &dyn List) -> Result<()>,
    ) -> Result<()> {
        let first = results.first;
        let end = first + results.sizes.len();
        let Some(sizes) = self.sizes.get(first..end) else {
            let (count, index) = (self.sizes.len(), first.max(self.sizes.len()));
            return Err(format!("subdomain {index} of {count} has no place").into());
        };
        check_sizes(results, sizes, &self.left_out)?;
        let Some(size) = self.starts.get(first) else {
            return Ok(());
        };
        let mut datasets = 0;
        for (dataset, (field, list)) in written(results, &self.left_out).enumerate() {
            datasets = dataset + 1;
            let start = field.per.rows(size, first);
            let of_a_step = field.per.rows(&self.total, self.sizes.len());
            match field.of {
                Of::Mesh if step > 0 => {}
                Of::Mesh => put(dataset, start, list)?,
                Of::Solution | Of::Stress | Of::Presence | Of::Quantity => {
                    put(dataset, step * of_a_step + start, list)?
                }
            }
        }
        if step == 0 {
            let numbers = (first as i32..).zip(sizes);
            let numbers: Vec<i32> = numbers
                .flat_map(|(s, size)| repeat_n(s, size.cells))
                .collect();
            put(datasets, size.cells, &numbers)?;
        }
        Ok(())
    }
}

/// The grid, and flags of the subdomains written.
#[derive(Debug)]
pub(super) struct Grid {
    /// A dataset for each list, and one for the subdomain number of each cell. They stay open, because finding one by
    /// name costs as much as writing a small subdomain.
    datasets: Vec<Dataset>,
    placement: GridPlacement,
    written: Vec<bool>,
    /// Digest of each dataset as written in this load step.
    digests: Vec<u64>,
}

impl Grid {
    /// Creates all datasets in their final sizes, or opens those created by an earlier run.
    pub(super) fn create(file: &File, layout: &Layout) -> Result<Self> {
        let sizes = &layout.partitions;
        let is_new = !file.link_exists("VTKHDF");
        let group = column::group(file, "VTKHDF")?;
        if is_new {
            vtkhdf::mark(&group)?;
        }

        let counts =
            |of: fn(&PartitionSize) -> usize| sizes.iter().map(move |size| of(size) as i64);
        column::whole(&group, "NumberOfPoints", counts(|size| size.points))?;
        column::whole(&group, "NumberOfCells", counts(|size| size.cells))?;
        column::whole(
            &group,
            "NumberOfConnectivityIds",
            counts(|size| size.connectivity),
        )?;

        let placement = GridPlacement::new(layout);
        let total = &placement.total;
        column::group(&group, "PointData")?;
        let subdomains = column::group(&group, "CellData")?;
        let subdomains = column::empty::<i32>(&subdomains, "Subdomain", 0, total.cells)?;
        let steps = layout.times.len().max(1);
        let none = SubdomainResults::default();
        let create = |(field, list): (ListField, &dyn List)| {
            let rows = field.per.rows(total, sizes.len());
            let rows = if field.of == Of::Mesh {
                rows
            } else {
                steps * rows
            };
            list.empty(&group, field.place, 0, rows)
        };
        let mut datasets: Vec<Dataset> = written(&none, &placement.left_out)
            .map(create)
            .collect::<Result<_>>()?;
        datasets.push(subdomains);
        if !layout.times.is_empty() {
            create_steps(&group, layout, total)?;
        }
        Ok(Self {
            digests: vec![0; datasets.len()],
            datasets,
            written: vec![false; sizes.len()],
            placement,
        })
    }

    /// The first byte of every dataset in the file; `None` if one isn't allocated yet.
    pub(super) fn places(&self) -> Option<Vec<u64>> {
        let is_empty = |dataset: &Dataset| dataset.size() == 0;
        let place = |dataset: &Dataset| dataset.offset().or(is_empty(dataset).then_some(0));
        self.datasets.iter().map(place).collect()
    }

    /// Ranges of subdomains with at most [`SLAB_POINTS`] nodes in total, or of a single larger one.
    pub(super) fn slabs(&self) -> Vec<Range<usize>> {
        let mut slabs: Vec<Range<usize>> = Vec::new();
        let mut points = 0;
        for (index, size) in self.placement.sizes.iter().enumerate() {
            points += size.points;
            match slabs.last_mut() {
                Some(slab) if points <= SLAB_POINTS => slab.end = index + 1,
                _ => {
                    slabs.push(index..index + 1);
                    points = size.points;
                }
            }
        }
        slabs
    }

    /// Writes consecutive partitions in a load step.
    pub(super) fn write(&mut self, results: &SubdomainResults, step: usize) -> Result<()> {
        let Self {
            datasets,
            placement,
            digests,
            ..
        } = self;
        placement.each(results, step, |k, row, list| {
            placement.sum(&mut digests[k], row, list);
            list.fill(&datasets[k], 0, row)
        })?;
        let written = results.first..results.first + results.sizes.len();
        self.written[written].fill(true);
        Ok(())
    }

    /// Marks all partitions as written by their owners, with these digests.
    pub(super) fn take_as_written(&mut self, digests: &[Vec<u64>]) {
        self.written.fill(true);
        for of_rank in digests {
            for (sum, digest) in self.digests.iter_mut().zip(of_rank) {
                *sum = sum.wrapping_add(*digest);
            }
        }
    }

    /// All datasets by their places in a file of this number of load `steps`.
    pub(super) fn columns(&self, steps: usize) -> Result<Vec<Column>> {
        let GridPlacement {
            left_out,
            total,
            sizes,
            ..
        } = &self.placement;
        let none = SubdomainResults::default();
        let fields = written(&none, left_out).map(|(field, _)| {
            let changes = (field.of != Of::Mesh).then_some(steps);
            (field.per.rows(total, sizes.len()), changes)
        });
        let all = fields.chain([(total.cells, None)]).zip(&self.datasets);
        all.map(|((rows, steps), dataset)| Column::new(dataset, rows, steps))
            .collect()
    }

    /// Checks that every partition was written in a load step, and prepares for the next one; returns the digests of
    /// the datasets.
    pub(super) fn finish_step(&mut self) -> Result<Vec<u64>> {
        if let Some(index) = self.written.iter().position(|&written| !written) {
            return Err(format!("subdomain {index} is missing").into());
        }
        self.written.fill(false);
        let none = vec![0; self.digests.len()];
        Ok(std::mem::replace(&mut self.digests, none))
    }
}

/// The lists present in the file.
fn written<'a>(
    results: &'a SubdomainResults,
    left_out: &[Of],
) -> impl Iterator<Item = (ListField, &'a dyn List)> {
    let lists = results.lists().into_iter();
    lists.filter(|(field, _)| !left_out.contains(&field.of))
}

/// Writes `/VTKHDF/Steps`: load steps as a time series of VTK's HDF format, on a constant mesh.
///
/// The rows of step k follow those of step k − 1 in one array; every step has an offset into each array, which is
/// constant for those of the mesh. `total` is the size of all partitions together.
fn create_steps(grid: &Group, layout: &Layout, total: &PartitionSize) -> Result<()> {
    let steps = layout.times.len();
    let is_new = !grid.link_exists("Steps");
    let group = column::group(grid, "Steps")?;
    if is_new {
        let count = group.new_attr::<i64>().create("NSteps")?;
        count.write_scalar(&(steps as i64))?;
    }
    column::whole(&group, "Values", layout.times.iter().copied())?;
    let parts = layout.partitions.len();
    column::whole(&group, "NumberOfParts", repeat_n(parts as i64, steps))?;
    for name in ["PartOffsets", "PointOffsets"] {
        column::whole(&group, name, repeat_n(0_i64, steps))?;
    }
    // A column for each type of cell with its own array; unstructured grids have one.
    for name in ["CellOffsets", "ConnectivityIdOffsets"] {
        column::whole(&group, name, repeat_n([0_i64], steps))?;
    }
    let offsets = |place: &str, rows: usize| match place.split_once('/') {
        Some((data, name)) => {
            let group = column::group(&group, &format!("{data}Offsets"))?;
            column::whole(&group, name, (0..steps).map(|k| (k * rows) as i64))
        }
        None => Ok(()),
    };
    for (field, _) in written(&SubdomainResults::default(), &layout.left_out()) {
        let of_a_step = field.per.rows(total, parts);
        offsets(
            field.place,
            if field.of == Of::Mesh { 0 } else { of_a_step },
        )?;
    }
    offsets("CellData/Subdomain", 0)
}

/// Checks that each partition has the size in `sizes`, and that the lengths of the lists agree with these.
fn check_sizes(results: &SubdomainResults, sizes: &[PartitionSize], left_out: &[Of]) -> Result<()> {
    let check = |whose: &str, checks: &[(&str, usize, usize)]| match checks
        .iter()
        .find(|(_, found, expected)| found != expected)
    {
        Some((name, found, expected)) => {
            Err(format!("{whose} {found} {name}; expected {expected}").into())
        }
        None => Ok(()),
    };
    for (index, (found, expected)) in (results.first..).zip(results.sizes.iter().zip(sizes)) {
        check(
            &format!("subdomain {index} has"),
            &[
                ("points", found.points, expected.points),
                ("cells", found.cells, expected.cells),
                ("connectivity", found.connectivity, expected.connectivity),
            ],
        )?;
    }
    let mut sum = PartitionSize::default();
    sizes.iter().for_each(|size| sum.add(size));
    let whose = match sizes.len() {
        0 | 1 => format!("subdomain {} has", results.first),
        n => format!(
            "subdomains {} to {} have",
            results.first,
            results.first + n - 1
        ),
    };
    let lists = results.lists().into_iter().map(|(field, list)| {
        let expected = if left_out.contains(&field.of) {
            0
        } else {
            field.per.rows(&sum, sizes.len())
        };
        (field.what, list.rows(), expected)
    });
    check(&whose, &lists.collect::<Vec<_>>())
}
