//! Nodes that both sides of a contact share: crack tips, in space crack fronts. No point carries the pressure on their
//! part of the sides, which quantities of the contact count by that of the points beside them.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use super::Known;
use crate::contact_point::ContactPoint;
use crate::model::surface::{Surface, SurfaceFacet};

/// The part of a contact that belongs to shared nodes.
#[derive(Default)]
pub(super) struct SharedNodes {
    /// Their tributary area (m, in space m²).
    pub area: f64,
    /// The points that have a facet with them, by their places in the contact.
    pub beside: Vec<u32>,
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
