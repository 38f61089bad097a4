//! `/VTKHDF`: an UnstructuredGrid of VTK's HDF format 2.0 with one partition a subdomain.

use hdf5::types::FixedAscii;
use hdf5::{Error, File, Group, Result};

use super::super::result::SubdomainResult;
use super::PartitionSize;
use super::column;

/// The length is that of the word: null-padded, with no room for the terminator over which VTK's
/// reader trips.
type GridType = FixedAscii<16>;

/// The grid, and which subdomains have been written.
#[derive(Debug)]
pub(super) struct Grid {
    group: Group,
    points: Group,
    cells: Group,
    sizes: Vec<PartitionSize>,
    starts: Vec<PartitionSize>,
    written: Vec<bool>,
}

impl Grid {
    /// Makes all arrays in their final sizes.
    pub(super) fn create(file: &File, sizes: &[PartitionSize]) -> Result<Self> {
        let group = file.create_group("VTKHDF")?;
        group
            .new_attr_builder()
            .with_data(&[2_i64, 0])
            .create("Version")?;
        let kind = GridType::from_ascii("UnstructuredGrid").map_err(|e| e.to_string())?;
        group
            .new_attr::<GridType>()
            .create("Type")?
            .write_scalar(&kind)?;

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

        column::empty_table::<f64>(&group, "Points", end.points, 3)?;
        column::empty::<i64>(&group, "Connectivity", end.connectivity)?;
        column::empty::<i64>(&group, "Offsets", end.cells + sizes.len())?;
        column::empty::<u8>(&group, "Types", end.cells)?;

        let points = group.create_group("PointData")?;
        column::empty::<i64>(&points, "GlobalNodeId", end.points)?;
        column::empty_table::<f64>(&points, "Displacement", end.points, 3)?;
        column::empty_table::<f64>(&points, "Stress", end.points, 6)?;

        let cells = group.create_group("CellData")?;
        column::empty::<i32>(&cells, "Subdomain", end.cells)?;
        column::empty::<i32>(&cells, "Material", end.cells)?;
        column::empty_table::<f64>(&cells, "Stress", end.cells, 6)?;
        column::empty_table::<f64>(&cells, "PrincipalStress", end.cells, 3)?;
        column::empty::<f64>(&cells, "VonMises", end.cells)?;

        Ok(Self {
            group,
            points,
            cells,
            sizes: sizes.to_vec(),
            starts,
            written: vec![false; sizes.len()],
        })
    }

    /// Writes one partition.
    pub(super) fn write(&mut self, result: &SubdomainResult) -> Result<()> {
        let index = result.index;
        let Some(&size) = self.sizes.get(index) else {
            let count = self.sizes.len();
            return Err(format!("subdomain {index} of {count} has no place").into());
        };
        check_sizes(result, size)?;

        let start = self.starts[index];
        let connectivity = widened(result.cells.connectivity());
        column::fill(
            &self.group,
            "Connectivity",
            start.connectivity,
            &connectivity,
        )?;
        // Each partition has an offset more than cells.
        let offsets: Vec<i64> = result.cells.offsets().iter().map(|&o| o as i64).collect();
        column::fill(&self.group, "Offsets", start.cells + index, &offsets)?;
        let types: Vec<u8> = result.cells.iter().map(|(kind, _)| kind.vtk()).collect();
        column::fill(&self.group, "Types", start.cells, &types)?;
        column::fill_table(&self.group, "Points", start.points, &result.points)?;

        let points = &self.points;
        column::fill(points, "GlobalNodeId", start.points, &result.node_tags)?;
        column::fill_table(points, "Displacement", start.points, &result.displacement)?;
        column::fill_table(points, "Stress", start.points, &result.nodal_stress)?;

        let cells = &self.cells;
        let subdomain = vec![index as i64; size.cells];
        column::fill(cells, "Subdomain", start.cells, &subdomain)?;
        let material = widened(&result.cell_material);
        column::fill(cells, "Material", start.cells, &material)?;
        column::fill_table(cells, "Stress", start.cells, &result.cell_stress)?;
        column::fill_table(cells, "PrincipalStress", start.cells, &result.principal)?;
        column::fill(cells, "VonMises", start.cells, &result.von_mises)?;

        self.written[index] = true;
        Ok(())
    }

    /// Checks that every partition was written.
    pub(super) fn finish(self) -> Result<()> {
        match self.written.iter().position(|&written| !written) {
            Some(index) => Err(format!("subdomain {index} is missing").into()),
            None => Ok(()),
        }
    }
}

fn widened(values: &[u32]) -> Vec<i64> {
    values.iter().map(|&value| i64::from(value)).collect()
}

fn check_sizes(result: &SubdomainResult, size: PartitionSize) -> Result<()> {
    let index = result.index;
    for (name, found, expected) in [
        ("points", result.points.len(), size.points),
        ("node tags", result.node_tags.len(), size.points),
        ("displacements", result.displacement.len(), size.points),
        ("nodal stresses", result.nodal_stress.len(), size.points),
        ("cells", result.cells.len(), size.cells),
        (
            "connectivity",
            result.cells.connectivity().len(),
            size.connectivity,
        ),
        ("materials", result.cell_material.len(), size.cells),
        ("cell stresses", result.cell_stress.len(), size.cells),
        ("principal stresses", result.principal.len(), size.cells),
        ("von Mises stresses", result.von_mises.len(), size.cells),
    ] {
        if found != expected {
            return Err(Error::from(format!(
                "subdomain {index} has {found} {name}; expected {expected}"
            )));
        }
    }
    Ok(())
}
