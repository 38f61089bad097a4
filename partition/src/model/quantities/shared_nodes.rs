//! Nodes that both sides of a contact share: crack tips, in space crack fronts; and nodes of both sides at a support that
//! prescribes the jump between them. No point carries the pressure on their part of the sides, which quantities of the
//! contact count by that of the points beside them.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use super::Known;
use crate::contact_point::ContactPoint;
use crate::element::geometry::{difference, length};
use crate::model::surface::{Surface, SurfaceFacet};

/// Distance of neighbours, relative to that of the nearest one.
const NEIGHBOUR: f64 = 1.5;

/// The part of a contact that belongs to shared nodes.
#[derive(Default)]
pub(super) struct SharedNodes {
    /// Their tributary area (m, in space m²).
    pub area: f64,
    /// The points that have a facet with them, by their places in the contact.
    pub beside: Vec<u32>,
}

impl SharedNodes {
    /// Adds points at supports that end a contact of two sides with these `points`. Where supports hold whole facets
    /// they carry the force, not the contact: only points beside others count.
    pub fn add_prescribed(
        &mut self,
        prescribed: &[ContactPoint<u32>],
        points: &[ContactPoint<u32>],
    ) {
        // The weights of two sides cancel, unlike those of a side and an obstacle.
        let has_sides = |point: &&ContactPoint<u32>| {
            let weights = point.entries.iter().map(|(_, weight)| weight);
            weights.sum::<f64>().abs() < 0.5
        };
        for end in prescribed.iter().filter(has_sides) {
            let away = |other: &ContactPoint<u32>| length(difference(other.position, end.position));
            let others = prescribed.iter().map(away).filter(|away| *away > 0.0);
            let nearest = points.iter().map(away).fold(f64::INFINITY, f64::min);
            if nearest > NEIGHBOUR * others.fold(f64::INFINITY, f64::min) {
                continue;
            }
            let beside = points
                .iter()
                .filter(|point| away(point) <= NEIGHBOUR * nearest);
            self.beside.extend(beside.map(|point| point.place));
            self.area += end.area;
        }
        self.beside.sort_unstable();
        self.beside.dedup();
    }
}

impl Known<'_> {
    /// The shared nodes of a contact of these points.
    pub(super) fn shared_nodes(&self, points: &[ContactPoint<u32>]) -> SharedNodes {
        let mut partners: BTreeMap<u32, (u32, u32)> = BTreeMap::new();
        for point in points {
            if let [(a, 1.0), (b, -1.0)] = point.entries[..] {
                partners.insert(a, (b, point.place));
            }
        }
        let all = Surface::of_all(&self.bodies.mesh, self.topology, self.scene.plane).facets;
        // Facets with a node of side a and one of no point, by the nodes that side b has opposite.
        let mut opposite: HashMap<Vec<u32>, (&SurfaceFacet, Vec<u32>)> = HashMap::new();
        for facet in &all {
            let (of_points, rest): (Vec<u32>, Vec<u32>) =
                (facet.nodes.iter().copied()).partition(|node| partners.contains_key(node));
            if of_points.is_empty() || rest.is_empty() {
                continue;
            }
            let others = of_points.iter().map(|node| partners[node].0);
            let mut others: Vec<u32> = others.chain(rest.iter().copied()).collect();
            others.sort_unstable();
            opposite.insert(others, (facet, rest));
        }
        let mut found = SharedNodes::default();
        let mut beside = BTreeSet::new();
        for facet in &all {
            let mut nodes = facet.nodes.clone();
            nodes.sort_unstable();
            if let Some((facet, shared)) = opposite.get(&nodes) {
                let areas = shared.iter().map(|&node| facet.tributary_area(node));
                found.area += areas.sum::<f64>();
                let of_facet = facet.nodes.iter().filter_map(|node| partners.get(node));
                beside.extend(of_facet.map(|(_, place)| *place));
            }
        }
        found.beside = beside.into_iter().collect();
        found
    }
}
