//! Quantities and parameters in the problem file.

use super::Problem;
use super::datasets::Datasets;
use crate::quantity::{ParameterKind, QuantityKind};

/// Writes the quantities and parameters; nothing if no quantity is requested.
pub(super) fn write(problem: &Problem, datasets: &mut Datasets) -> hdf5::Result<()> {
    let all = || problem.catalog.quantities.iter();
    if all().len() == 0 {
        return Ok(());
    }
    let kind = |kind: QuantityKind| QuantityKind::ALL.iter().position(|&of| of == kind);
    let kinds = all().map(|of| kind(of.kind).map_or(-1, |place| place as i64));
    datasets.strings("/quantity/name", all().map(|of| of.name.as_str()))?;
    datasets.put("/quantity/kind", kinds)?;
    datasets.vectors("/quantity/direction", all().map(|of| &of.direction))?;
    datasets.vectors("/quantity/point", all().map(|of| &of.point))?;
    datasets.put("/quantity/length", all().map(|of| of.length))?;
    let constants = all().flat_map(|of| &of.constants).copied();
    datasets.put("/quantity/constant", constants)?;
    datasets.put("/quantity/node", all().map(|of| of.node))?;
    datasets.offsets("/quantity/of_offset", all().map(|of| of.of.len()))?;
    datasets.integers("/quantity/of", all().flat_map(|of| &of.of).copied())?;
    let subdomains = || problem.subdomains.iter().map(|s| &s.shares);
    if subdomains().any(|of| !of.weights.is_empty()) {
        let weights = || subdomains().flat_map(|of| &of.weights);
        datasets.offsets("/weight/offset", subdomains().map(|of| of.weights.len()))?;
        datasets.integers("/weight/quantity", weights().map(|of| of.quantity))?;
        datasets.integers("/weight/node", weights().map(|of| of.node))?;
        datasets.vectors("/weight/value", weights().map(|of| &of.value))?;
    }
    let all = || problem.catalog.parameters.iter();
    if all().len() == 0 {
        return Ok(());
    }
    let kind = |kind: ParameterKind| ParameterKind::ALL.iter().position(|&of| of == kind);
    let kinds = all().map(|of| kind(of.kind).map_or(-1, |place| place as i64));
    datasets.strings("/parameter/name", all().map(|of| of.name.as_str()))?;
    datasets.put("/parameter/kind", kinds)?;
    datasets.put("/parameter/value", all().map(|of| of.value))?;
    datasets.offsets("/parameter/of_offset", all().map(|of| of.of.len()))?;
    datasets.integers("/parameter/of", all().flat_map(|of| &of.of).copied())?;
    if subdomains().any(|of| !of.forces.is_empty()) {
        let forces = || subdomains().flat_map(|of| &of.forces);
        datasets.offsets("/load/offset", subdomains().map(|of| of.forces.len()))?;
        datasets.integers("/load/parameter", forces().map(|of| of.parameter))?;
        datasets.integers("/load/node", forces().map(|of| of.node))?;
        datasets.vectors("/load/force", forces().flat_map(|of| &of.forces))?;
    }
    Ok(())
}
