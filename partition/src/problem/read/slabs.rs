//! What the file holds of consecutive subdomains, each dataset read once.

use std::ops::Range;

use super::ProblemFile;
use crate::error::InputError;
use crate::problem::dataset::Dataset;
use crate::problem::slab::Slab;

/// The slices of consecutive subdomains, whose values aren't checked against each other yet.
pub(super) struct Slabs {
    pub points: Slab<f64>,
    pub tags: Slab<i64>,
    pub types: Slab<i64>,
    pub connectivity: Slab<i64>,
    pub offsets: Slab<i64>,
    pub materials: Slab<i64>,
    pub supports: Option<Supports>,
    pub forces: Option<Forces>,
    pub interface: Option<Slab<i64>>,
}

/// Supports of consecutive subdomains.
pub(super) struct Supports {
    pub node: Slab<i64>,
    pub direction: Slab<f64>,
    /// A number a row, or one for each load step.
    pub value: Slab<f64>,
    /// Absent from files that don't tell conditions apart.
    pub condition: Option<Slab<i64>>,
}

/// Nodal forces of consecutive subdomains.
pub(super) struct Forces {
    pub node: Slab<i64>,
    /// A vector a row, or one for each load step.
    pub value: Slab<f64>,
}

impl Slabs {
    /// Reads the slices of `subdomains`.
    pub fn read(file: &ProblemFile, subdomains: Range<usize>) -> Result<Self, InputError> {
        let rows = |offsets: &[usize]| offsets[subdomains.start]..offsets[subdomains.end];
        let points = rows(&file.offsets.points);
        let cells = rows(&file.offsets.cells);
        // Each of the subdomains before has an offset more than cells.
        let ends = cells.start + subdomains.start..cells.end + subdomains.end;
        let integers = |name, rows| Slab::integers(file.column(name)?, rows);
        Ok(Self {
            points: Slab::floats(file.table("/VTKHDF/Points", 3)?, points.clone(), 3)?,
            tags: integers("/VTKHDF/PointData/GlobalNodeId", points)?,
            types: integers("/VTKHDF/Types", cells.clone())?,
            connectivity: integers("/VTKHDF/Connectivity", rows(&file.offsets.connectivity))?,
            offsets: integers("/VTKHDF/Offsets", ends)?,
            materials: integers("/VTKHDF/CellData/Material", cells)?,
            supports: Supports::read(file, rows(&file.offsets.supports))?,
            forces: Forces::read(file, rows(&file.offsets.forces))?,
            interface: interface(file, subdomains.clone())?,
        })
    }
}

impl Supports {
    fn read(file: &ProblemFile, rows: Range<usize>) -> Result<Option<Self>, InputError> {
        if rows.is_empty() {
            return Ok(None);
        }
        let dim = file.catalog.dim;
        let node = file.column("/support/node")?;
        let direction = file.table("/support/direction", dim)?;
        let value = Dataset::open(&file.file, "/support/value")?;
        let total = Some(node.rows());
        let direction = direction.shaped(total, &[dim])?;
        let steps = file.catalog.steps.len();
        let value = match steps {
            0 => value.shaped(total, &[])?,
            _ => value.shaped(total, &[steps])?,
        };
        Ok(Some(Self {
            node: Slab::integers(node, rows.clone())?,
            direction: Slab::unit_vectors(direction, rows.clone(), dim)?,
            value: Slab::floats(value, rows.clone(), steps.max(1))?,
            condition: match file.file.link_exists("support/condition") {
                true => Some(Slab::integers(
                    file.column("/support/condition")?.shaped(total, &[])?,
                    rows,
                )?),
                false => None,
            },
        }))
    }
}

impl Forces {
    fn read(file: &ProblemFile, rows: Range<usize>) -> Result<Option<Self>, InputError> {
        if rows.is_empty() {
            return Ok(None);
        }
        let dim = file.catalog.dim;
        let node = file.column("/force/node")?;
        let value = Dataset::open(&file.file, "/force/value")?;
        let total = Some(node.rows());
        let steps = file.catalog.steps.len();
        let value = match steps {
            0 => value.shaped(total, &[dim])?,
            _ => value.shaped(total, &[steps, dim])?,
        };
        Ok(Some(Self {
            node: Slab::integers(node, rows.clone())?,
            value: Slab::floats(value, rows, steps.max(1) * dim)?,
        }))
    }
}

/// The nodes of Γ of consecutive subdomains; `None` where there are none.
fn interface(
    file: &ProblemFile,
    subdomains: Range<usize>,
) -> Result<Option<Slab<i64>>, InputError> {
    let offsets = &file.offsets.interface;
    let rows = offsets[subdomains.start]..offsets[subdomains.end];
    if rows.is_empty() {
        return Ok(None);
    }
    Slab::integers(file.column("/interface/node")?, rows).map(Some)
}
