//! Loads that can't go with the stiffness, and displacements that can't go with the bodies' size:
//! their units are likely to differ.

use super::Diagnostics;
use crate::element::geometry::length;
use crate::magnitude::short;
use crate::mesh::topology::CellFacet;
use crate::model::groups;
use crate::scene::condition::Names;

/// Strain that nobody means: by then small strains are no approximation.
const LARGE: f64 = 0.1;

impl Diagnostics<'_> {
    /// Pressures and tractions not much below the stiffness, and displacements beyond the bodies' size.
    pub(super) fn strains(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        for loading in self.scene.loadings() {
            for (index, traction) in loading.traction.iter().enumerate() {
                let size = |x| Ok(loading.scale.traction * length(traction.value.at(x)?));
                let label = loading.traction_label(index, &traction.on);
                warnings.extend(self.strain(&label, &traction.on, size));
            }
            for (index, pressure) in loading.pressure.iter().enumerate() {
                let size = |x| Ok(loading.scale.pressure * pressure.value.at(x)?);
                let label = loading.pressure_label(index, &pressure.on);
                warnings.extend(self.strain(&label, &pressure.on, size));
            }
        }
        let (extent, unit) = (self.extent(), self.scene.units.length());
        for (i, support) in self.loads.supports.iter().enumerate() {
            let values = self.loads.values(i).into_iter();
            let largest = values.map(f64::abs).fold(0.0, f64::max);
            if largest > extent {
                warnings.push(format!(
                    "{}: a displacement of {} {unit}, and the bodies measure {} {unit}; are their units the same?",
                    self.loads.names[support.condition as usize],
                    short(largest),
                    short(extent)
                ));
            }
        }
        // Said once for all nodes and steps.
        warnings.sort();
        warnings.dedup_by_key(|warning| warning.split(": ").next().map(str::to_owned));
        warnings
    }

    /// The warning of a load whose size at a place is `size`; values that aren't finite have been refused.
    fn strain(
        &self,
        label: &str,
        on: &Names,
        size: impl Fn([f64; 3]) -> Result<f64, String>,
    ) -> Option<String> {
        let mesh = &self.bodies.mesh;
        let facets = groups::facets(mesh, on, label).ok()?;
        let loaded = facets.into_iter().filter_map(|facet| {
            let nodes = mesh.facets.nodes_of(facet as usize);
            let [CellFacet { cell, .. }] = self.topology.cells_at(nodes)[..] else {
                return None;
            };
            let at = nodes.iter().map(|&node| mesh.points[node as usize]);
            let load = at
                .filter_map(|x| size(x).ok())
                .map(f64::abs)
                .fold(0.0, f64::max);
            let material = &self.materials[self.bodies.cell_material[cell as usize] as usize];
            Some((load, material.stiffness.largest(), material.name.as_str()))
        });
        let unit = self.scene.units.stress();
        let (load, stiffness, name) = loaded.max_by(|a, b| (a.0 / a.1).total_cmp(&(b.0 / b.1)))?;
        (load > LARGE * stiffness).then(|| {
            format!(
                "{label}: up to {} {unit} on '{name}' of a stiffness of {} {unit} make strains of about {}, where \
                 small ones are meant; are their units the same?",
                short(load),
                short(stiffness),
                short(load / stiffness)
            )
        })
    }
}
