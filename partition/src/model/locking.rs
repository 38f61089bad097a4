//! Volumetric locking: cells of a nearly incompressible material that are too stiff, as they can't deform without a change
//! of volume.

use std::collections::BTreeSet;

use crate::mesh::Mesh;
use crate::scene::Scene;
use crate::scene::condition::Integration;
use crate::scene::material::{Elasticity, PlaneState};

/// Poisson's ratio above which linear cells lock: too stiff by 7 % in energy at 0.499.
const LINEAR: f64 = 0.49;

/// Poisson's ratio above which quadratic cells lock. At 0.4999 the displacement of a thick-walled cylinder under pressure is
/// off by 0.3 to 5 % where its wall has five cells, and by 0.02 to 0.3 % where it has ten; at 0.499999 by 3 to 40 %.
const QUADRATIC: f64 = 0.4999;

/// Warnings of materials with cells that lock, `cell_body` being the body of every cell. In plane stress none does, as a
/// sheet may change its thickness.
pub(super) fn warnings(scene: &Scene, mesh: &Mesh, cell_body: &[u32]) -> Vec<String> {
    if scene.plane == Some(PlaneState::Stress) {
        return Vec::new();
    }
    let of_material = scene.materials.iter().map(|(name, material)| {
        let poisson = match material {
            Elasticity::Isotropic { poisson, .. } if *poisson >= LINEAR => *poisson,
            _ => return Vec::new(),
        };
        let is_reduced: Vec<Option<bool>> = (scene.bodies.values())
            .map(|body| {
                (body.material == *name).then_some(body.integration == Integration::Reduced)
            })
            .collect();
        let (mut linear, mut quadratic) = (BTreeSet::new(), BTreeSet::new());
        for ((kind, _), &body) in mesh.cells.iter().zip(cell_body) {
            let Some(is_reduced) = is_reduced[body as usize] else {
                continue;
            };
            let kinds = match kind.is_linear() {
                true => &mut linear,
                false if is_reduced && kind.reduced_points().is_some() => continue,
                false => &mut quadratic,
            };
            kinds.insert(kind.name());
        }
        of_kinds(name, poisson, &linear, &quadratic)
    });
    of_material.flatten().collect()
}

/// The warnings of a material with linear and quadratic cells of these names.
fn of_kinds(
    material: &str,
    poisson: f64,
    linear: &BTreeSet<&str>,
    quadratic: &BTreeSet<&str>,
) -> Vec<String> {
    let listed = |kinds: &BTreeSet<&str>| {
        let kinds = kinds.iter().map(|kind| kind.replacen(' ', "s ", 1));
        kinds.collect::<Vec<_>>().join(" and ")
    };
    let mut warnings = Vec::new();
    if !linear.is_empty() {
        let others = match poisson < QUADRATIC {
            true => "quadratic ones don't lock",
            false => "quadratic ones lock less",
        };
        warnings.push(format!(
            "material '{material}': {} lock at a Poisson's ratio of {poisson}; displacements come out too small; {others}",
            listed(linear)
        ));
    }
    if poisson >= QUADRATIC && !quadratic.is_empty() {
        warnings.push(format!(
            "material '{material}': {} lock, too, at a Poisson's ratio of {poisson}: displacements and pressures are off by some \
             percent, of coarse cells by half and more, and stated errors are too small; expected a ratio of 0.499 at most, or \
             quadrilaterals of 8 nodes or hexahedra of 20 with integration = \"reduced\"",
            listed(quadratic)
        ));
    }
    warnings
}
