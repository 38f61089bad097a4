//! `/VTKHDF`: an UnstructuredGrid of VTK's HDF format 2.0 with one partition a subdomain.

use std::iter::repeat_n;
use std::ops::Range;

use contact_dd_partition::problem::vtkhdf;
use hdf5::{Dataset, File, Group, Result};

use super::super::result::{PartitionSize, SubdomainResults};
use super::{Layout, column, time_series};

/// Most nodes of a slab of more than one subdomain. With its cells it is about 6 MB, which is still
/// in the cache when it is written and doesn't count beside what the root holds anyway; yet its
/// columns of numbers are past the 64 KiB up to which HDF5 reads from a file where it writes.
const SLAB_POINTS: usize = 1 << 14;

/// The grid, and which subdomains have been written.
#[derive(Debug)]
pub(super) struct Grid {
    arrays: Arrays,
    total: PartitionSize,
    sizes: Vec<PartitionSize>,
    starts: Vec<PartitionSize>,
    written: Vec<bool>,
}

/// Every array that is filled slab by slab; to find one by its name costs as much as to write a
/// small subdomain.
#[derive(Debug)]
struct Arrays {
    points: Dataset,
    node_tags: Dataset,
    displacement: Dataset,
    connectivity: Dataset,
    offsets: Dataset,
    types: Dataset,
    subdomains: Dataset,
    materials: Dataset,
    stress: Option<StressArrays>,
}

/// The arrays of stresses.
#[derive(Debug)]
struct StressArrays {
    at_nodes: Dataset,
    of_cells: Dataset,
    principal: Dataset,
    von_mises: Dataset,
    energy_error: Dataset,
}

impl Grid {
    /// Makes all arrays in their final sizes, or takes those that an earlier run made.
    pub(super) fn create(file: &File, layout: &Layout) -> Result<Self> {
        let (sizes, times) = (&layout.partitions, &layout.times);
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

        let mut starts = Vec::with_capacity(sizes.len());
        let mut end = PartitionSize::default();
        for size in sizes {
            starts.push(end);
            end.points += size.points;
            end.cells += size.cells;
            end.connectivity += size.connectivity;
        }
        let steps = times.len().max(1);
        let arrays = Arrays::create(&group, end, sizes.len(), steps, layout.stress)?;
        if !times.is_empty() {
            time_series::create(&group, layout, end)?;
        }
        Ok(Self {
            arrays,
            total: end,
            sizes: sizes.to_vec(),
            starts,
            written: vec![false; sizes.len()],
        })
    }

    /// Runs of subdomains of at most [`SLAB_POINTS`] nodes together, or of a single larger one.
    pub(super) fn slabs(&self) -> Vec<Range<usize>> {
        let mut slabs: Vec<Range<usize>> = Vec::new();
        let mut points = 0;
        for (index, size) in self.sizes.iter().enumerate() {
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
        let first = results.first;
        let end = first + results.sizes.len();
        let Some(sizes) = self.sizes.get(first..end) else {
            let (count, index) = (self.sizes.len(), first.max(self.sizes.len()));
            return Err(format!("subdomain {index} of {count} has no place").into());
        };
        check_sizes(results, sizes, self.arrays.stress.is_some())?;
        if let Some(&start) = self.starts.get(first) {
            if step == 0 {
                self.arrays.fill_mesh(results, start)?;
            }
            let start = PartitionSize {
                points: step * self.total.points + start.points,
                cells: step * self.total.cells + start.cells,
                ..start
            };
            self.arrays.fill_fields(results, start)?;
        }
        self.written[first..end].fill(true);
        Ok(())
    }

    /// Checks that every partition was written in a load step, and makes ready for the next one.
    pub(super) fn finish_step(&mut self) -> Result<()> {
        if let Some(index) = self.written.iter().position(|&written| !written) {
            return Err(format!("subdomain {index} is missing").into());
        }
        self.written.fill(false);
        Ok(())
    }
}

impl Arrays {
    /// Makes them for `partitions` partitions of the size `total` together, fields for each of the `steps`.
    fn create(
        group: &Group,
        total: PartitionSize,
        partitions: usize,
        steps: usize,
        stress: bool,
    ) -> Result<Self> {
        let points = column::group(group, "PointData")?;
        let cells = column::group(group, "CellData")?;
        let stress = match stress {
            true => Some(StressArrays::create(&points, &cells, total, steps)?),
            false => None,
        };
        Ok(Self {
            points: column::empty_table::<f64>(group, "Points", total.points, 3)?,
            connectivity: column::empty::<i64>(group, "Connectivity", total.connectivity)?,
            offsets: column::empty::<i64>(group, "Offsets", total.cells + partitions)?,
            types: column::empty::<u8>(group, "Types", total.cells)?,

            node_tags: column::empty::<i64>(&points, "GlobalNodeId", total.points)?,
            displacement: column::empty_table::<f64>(
                &points,
                "Displacement",
                steps * total.points,
                3,
            )?,

            subdomains: column::empty::<i32>(&cells, "Subdomain", total.cells)?,
            materials: column::empty::<i32>(&cells, "Material", total.cells)?,
            stress,
        })
    }

    /// Writes the mesh of partitions, the first of which starts at `start`.
    fn fill_mesh(&self, results: &SubdomainResults, start: PartitionSize) -> Result<()> {
        let (points, cells) = (start.points, start.cells);
        column::fill_table(&self.points, points, &results.points)?;
        column::fill(
            &self.connectivity,
            start.connectivity,
            &results.connectivity,
        )?;
        // Each partition before has an offset more than cells.
        column::fill(&self.offsets, cells + results.first, &results.offsets)?;
        column::fill(&self.types, cells, &results.types)?;

        column::fill(&self.node_tags, points, &results.node_tags)?;

        let subdomains: Vec<i32> = (results.first as i32..)
            .zip(&results.sizes)
            .flat_map(|(index, size)| repeat_n(index, size.cells))
            .collect();
        column::fill(&self.subdomains, cells, &subdomains)?;
        column::fill(&self.materials, cells, &results.materials)
    }

    /// Writes the fields on partitions, which stand from `start` on.
    fn fill_fields(&self, results: &SubdomainResults, start: PartitionSize) -> Result<()> {
        column::fill_table(&self.displacement, start.points, &results.displacement)?;
        match &self.stress {
            Some(stress) => stress.fill(results, start),
            None => Ok(()),
        }
    }
}

impl StressArrays {
    fn create(points: &Group, cells: &Group, total: PartitionSize, steps: usize) -> Result<Self> {
        let (nodes, of_cells) = (steps * total.points, steps * total.cells);
        Ok(Self {
            at_nodes: column::empty_table::<f64>(points, "Stress", nodes, 6)?,
            of_cells: column::empty_table::<f64>(cells, "Stress", of_cells, 6)?,
            principal: column::empty_table::<f64>(cells, "PrincipalStress", of_cells, 3)?,
            von_mises: column::empty::<f64>(cells, "VonMises", of_cells)?,
            energy_error: column::empty::<f64>(cells, "EnergyError", of_cells)?,
        })
    }

    fn fill(&self, results: &SubdomainResults, start: PartitionSize) -> Result<()> {
        column::fill_table(&self.at_nodes, start.points, &results.nodal_stress)?;
        column::fill_table(&self.of_cells, start.cells, &results.cell_stress)?;
        column::fill_table(&self.principal, start.cells, &results.principal)?;
        column::fill(&self.von_mises, start.cells, &results.von_mises)?;
        column::fill(&self.energy_error, start.cells, &results.energy_error)
    }
}

/// Checks that each partition has the size in `sizes`, and that the lists hold what these say.
fn check_sizes(results: &SubdomainResults, sizes: &[PartitionSize], stress: bool) -> Result<()> {
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
    let sum = |of: fn(&PartitionSize) -> usize| sizes.iter().map(of).sum();
    let (points, cells) = (sum(|size| size.points), sum(|size| size.cells));
    let connectivity = sum(|size| size.connectivity);
    let stressed = |count| if stress { count } else { 0 };
    let whose = match sizes.len() {
        0 | 1 => format!("subdomain {} has", results.first),
        n => format!(
            "subdomains {} to {} have",
            results.first,
            results.first + n - 1
        ),
    };
    check(
        &whose,
        &[
            ("points", results.points.len(), points),
            ("node tags", results.node_tags.len(), points),
            ("displacements", results.displacement.len(), points),
            (
                "nodal stresses",
                results.nodal_stress.len(),
                stressed(points),
            ),
            ("connectivity", results.connectivity.len(), connectivity),
            ("offsets", results.offsets.len(), cells + sizes.len()),
            ("cell types", results.types.len(), cells),
            ("materials", results.materials.len(), cells),
            ("cell stresses", results.cell_stress.len(), stressed(cells)),
            (
                "principal stresses",
                results.principal.len(),
                stressed(cells),
            ),
            (
                "von Mises stresses",
                results.von_mises.len(),
                stressed(cells),
            ),
            ("errors", results.energy_error.len(), stressed(cells)),
        ],
    )
}
