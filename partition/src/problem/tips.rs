//! The crack tips in the problem file.

use super::datasets::Datasets;
use crate::crack_tip::CrackTip;

/// Writes them.
pub(super) fn write(tips: &[CrackTip], datasets: &mut Datasets) -> hdf5::Result<()> {
    let tips = || tips.iter();
    datasets.strings("/tip/name", tips().map(|tip| tip.name.as_str()))?;
    datasets.put("/tip/node", tips().map(|tip| tip.tag))?;
    datasets.integers("/tip/body", tips().map(|tip| tip.body))?;
    datasets.integers("/tip/material", tips().map(|tip| tip.material))?;
    datasets.vectors("/tip/position", tips().map(|tip| &tip.position))?;
    datasets.vectors("/tip/direction", tips().map(|tip| &tip.direction))?;
    datasets.put("/tip/radius", tips().map(|tip| tip.radius))?;
    datasets.offsets("/tip/facet_offset", tips().map(|tip| tip.facets.len()))?;
    let facets = || tips().flat_map(|tip| &tip.facets);
    datasets.integers("/tip/facet_face", facets().map(|facet| facet.is_upper))?;
    datasets.put("/tip/facet_node", facets().flat_map(|facet| facet.nodes))?;
    datasets.put("/tip/facet_distance", facets().flat_map(|f| f.distances))
}
