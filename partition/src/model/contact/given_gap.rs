//! Gaps given in the scene, in place of those measured on the mesh.

use std::collections::HashSet;

use super::super::mortar;
use super::super::surface::Surface;
use super::{Contacts, Paired};
use crate::contact_point::ContactPoint;
use crate::error::InputError;
use crate::magnitude::short;
use crate::scene::number::Number;

impl Contacts<'_> {
    /// Replaces the gaps measured on the mesh by a given one; returns a warning if the two differ much.
    ///
    /// # Errors
    /// A gap that isn't finite at a point.
    pub(super) fn give_gap(
        &self,
        gap: &Number,
        paired: &mut Paired,
        side_a: &Surface,
        what: &str,
    ) -> Result<Option<String>, InputError> {
        let unit = self.units.length();
        let at = |x: [f64; 3]| {
            gap.at(x)
                .map_err(|reason| InputError::new(format!("{what}.gap: {reason}")))
        };
        let at_node = |node: u32| at(self.mesh.points[node as usize]);
        paired.off = 0.0;
        let on_a: HashSet<u32> = side_a.nodes().into_keys().collect();
        let mut furthest = (0.0, 0.0, 0.0);
        for point in &mut paired.points {
            let given = weighted(point, &on_a, at_node)?;
            let measured = std::mem::replace(&mut point.gap, given);
            point.is_gap_given = true;
            furthest = match (given - measured).abs() {
                away if away > furthest.0 => (away, given, measured),
                _ => furthest,
            };
        }
        for probe in &mut paired.probes {
            let place = (probe.entries.first()).map(|&(node, _)| self.mesh.points[node as usize]);
            probe.gap = at(place.unwrap_or_default())?;
        }
        let (away, given, measured) = furthest;
        Ok((away > side_a.extent()).then(|| {
            format!(
                "{what}.gap: it is {} {unit} where the mesh has {} {unit}, which is off by more than the side \
                 measures; are place and units right?",
                short(given),
                short(measured)
            )
        }))
    }
}

/// The gap of a point: that `at_node` weighted as displacements of the side that carries the constraints are. On
/// quadratic faces in space a point has the ends of its edge, too, so that the gap at its node alone would be one that
/// no displacement fills. It is bounded by the smallest gap, like a measured one.
fn weighted(
    point: &ContactPoint<u32>,
    on_a: &HashSet<u32>,
    at_node: impl Fn(u32) -> Result<f64, InputError>,
) -> Result<f64, InputError> {
    let is_on_b = point.tag_a == -1;
    let own = (point.entries.iter()).filter(|(node, _)| on_a.contains(node) != is_on_b);
    let (mut sum, mut weights) = (0.0, 0.0);
    let (mut least, mut largest) = (f64::INFINITY, f64::NEG_INFINITY);
    for &(node, weight) in own {
        let gap = at_node(node)?;
        sum += weight * gap;
        weights += weight;
        (least, largest) = (least.min(gap), largest.max(gap));
    }
    // One gap everywhere stays what it is, without round-off.
    Ok(match least == largest {
        true => least,
        false => mortar::bounded(sum / weights, least),
    })
}
