//! Contact points of single nodes, such as those of a node-based surface without facets: each is paired with the facet
//! that it faces.

use std::collections::{BTreeSet, HashMap};

use super::super::mortar::opposite;
use super::super::ray_search::Target;
use super::super::sides::{INTERFERENCE, SideNode, apart};
use super::super::surface::{Surface, SurfaceFacet};
use super::super::{groups, surface};
use super::{Contacts, Paired};
use crate::contact_point::ContactPoint;
use crate::element::geometry::dot;
use crate::error::InputError;
use crate::scene::condition::Names;
use crate::scene::contact;

/// Cosine of the angle up to which two normals are equal.
const SAME: f64 = 1.0 - 1e-12;

impl Contacts<'_> {
    /// The points of the nodes of side a, and the side of these `names` that they face.
    ///
    /// # Errors
    /// A discretization that needs facets, or nodes none of which faces the side.
    pub(super) fn single_nodes(
        &self,
        keys: &contact::Contact,
        names: &Names,
        what: &str,
    ) -> Result<(Surface, Paired), InputError> {
        let refused = InputError::about(what);
        if keys.pairing.is_some() {
            return Err(refused(
                "'pairing' is of sides of facets, and side a consists of points; expected none"
                    .into(),
            ));
        }
        let (_, side_b) = self.side(names, what)?;
        let of_b = side_b.nodes();
        let nodes = groups::nodes(self.mesh, &keys.side_a, what)?.into_iter();
        let mut nodes: Vec<u32> = nodes.filter(|node| !of_b.contains_key(node)).collect();
        let at = |node: &u32| self.mesh.points[*node as usize];
        nodes.sort_by(|a, b| surface::compare(at(a), at(b)));
        let areas = self.areas(&nodes);
        let target = Target::new(&side_b);
        let normals = normals(&side_b);
        let behind = INTERFERENCE * side_b.extent();
        let point = |&node: &u32| {
            let tag = self.mesh.node_tags[node as usize];
            let facing = normals.iter().filter_map(|normal| {
                let of = SideNode {
                    node,
                    position: at(&node),
                    normal: *normal,
                    tributary_area: areas.get(&node).copied().unwrap_or_default(),
                };
                let hit = target.hit(of.position, of.normal, behind, |_| false);
                let (entries, gap) = opposite(hit, (self.mesh, &side_b), &of)?;
                Some(ContactPoint {
                    gap,
                    area: of.tributary_area,
                    ..ContactPoint::new(entries, of.normal, of.position, tag)
                })
            });
            facing.min_by(|a, b| a.gap.abs().total_cmp(&b.gap.abs()))
        };
        let points: Vec<ContactPoint<u32>> = nodes.iter().filter_map(point).collect();
        match points.is_empty() {
            true => Err(refused(apart(false))),
            false => Ok((
                side_b,
                Paired {
                    points,
                    ..Paired::default()
                },
            )),
        }
    }

    /// The area of each node from all facets of bodies around it, as in CalculiX.
    fn areas(&self, nodes: &[u32]) -> HashMap<u32, f64> {
        let own: BTreeSet<u32> = nodes.iter().copied().collect();
        let cells = &self.mesh.cells;
        let mut areas = HashMap::new();
        for of_cell in self.topology.boundary() {
            let nodes = of_cell.nodes(cells);
            let here: Vec<u32> = nodes.iter().copied().filter(|n| own.contains(n)).collect();
            if here.is_empty() {
                continue;
            }
            let (kind, _) = cells.kind(of_cell.cell as usize).facets()[of_cell.facet as usize];
            let at = nodes
                .iter()
                .map(|&n| self.mesh.points[n as usize])
                .collect();
            let facet = SurfaceFacet::new(kind, nodes, at, self.plane);
            for node in here {
                *areas.entry(node).or_default() += facet.tributary_area(node);
            }
        }
        areas
    }
}

/// The normals of a side's facets, without repetition.
fn normals(side: &Surface) -> Vec<[f64; 3]> {
    let mut normals: Vec<[f64; 3]> = Vec::new();
    for facet in &side.facets {
        let normal = facet.normal.map(|c| -c);
        if !normals.iter().any(|known| dot(*known, normal) > SAME) {
            normals.push(normal);
        }
    }
    normals
}
