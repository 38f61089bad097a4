//! `/VTKHDF/Steps`: load steps as a time series of VTK's HDF format, on a mesh that stays the same.
//!
//! Fields of step k follow those of step k − 1 in one array; for every step there is an offset into each
//! array, always the same one into those of the mesh.

use hdf5::{Group, Result};

use super::super::result::PartitionSize;
use super::{Layout, column};

/// Writes times and offsets; `total` is the size of all partitions together.
pub(super) fn create(grid: &Group, layout: &Layout, total: PartitionSize) -> Result<()> {
    let steps = layout.times.len();
    let is_new = !grid.link_exists("Steps");
    let group = column::group(grid, "Steps")?;
    if is_new {
        let count = group.new_attr::<i64>().create("NSteps")?;
        count.write_scalar(&(steps as i64))?;
    }
    column::whole(&group, "Values", layout.times.iter().copied())?;
    let parts = layout.partitions.len() as i64;
    column::whole(&group, "NumberOfParts", vec![parts; steps].into_iter())?;
    let stays = |group: &Group, name| column::whole(group, name, vec![0_i64; steps].into_iter());
    let follows = |group: &Group, name, rows: usize| {
        column::whole(group, name, (0..steps).map(|k| (k * rows) as i64))
    };
    for name in ["PartOffsets", "PointOffsets"] {
        stays(&group, name)?;
    }
    // A column for each type of cell that has an array of its own; unstructured grids have one.
    for name in ["CellOffsets", "ConnectivityIdOffsets"] {
        let table = column::empty_table::<i64>(&group, name, steps, 1)?;
        column::fill_table(&table, 0, &vec![[0_i64]; steps])?;
    }
    let points = column::group(&group, "PointDataOffsets")?;
    stays(&points, "GlobalNodeId")?;
    follows(&points, "Displacement", total.points)?;
    let cells = column::group(&group, "CellDataOffsets")?;
    for name in ["Subdomain", "Material"] {
        stays(&cells, name)?;
    }
    if layout.stress {
        follows(&points, "Stress", total.points)?;
        for name in ["Stress", "PrincipalStress", "VonMises", "EnergyError"] {
            follows(&cells, name, total.cells)?;
        }
    }
    Ok(())
}
