//! Bodies that overlap without a contact between them: nothing drives them apart, as an interference would.

use std::collections::{BTreeMap, BTreeSet};

use super::Diagnostics;
use crate::element::geometry::advance;
use crate::magnitude::short;
use crate::mesh::bounding_box::BoundingBox;
use crate::model::activation;
use crate::model::facet_tree::FacetTree;
use crate::model::skin::{STANDING_OFF, Skin, SkinFacet};

/// Direction along which the boundary of a body is crossed once from inside: one that meshes hardly follow.
const ACROSS: [f64; 3] = [0.612_372, 0.707_907, 0.351_9];
/// The same in the plane.
const ACROSS_PLANE: [f64; 3] = [0.654_3, 0.756_2, 0.0];
/// Most facets of a body that are looked for in another one.
const MOST_FACETS: usize = 400;

/// The boundary of all bodies, and its facets body by body.
struct Boundary<'a> {
    skin: Skin<'a>,
    tree: FacetTree,
    of_body: BTreeMap<u32, Vec<usize>>,
}

impl Diagnostics<'_> {
    /// Warnings, for each pair of bodies without a contact or tie, of the depth by which they overlap.
    pub(super) fn overlaps(&self) -> Vec<String> {
        let pairs = self.pairs_without_contact();
        if pairs.is_empty() {
            return Vec::new();
        }
        let skin = Skin::new(self.bodies, self.topology, self.scene.plane, |_| true);
        let mut of_body: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for (index, facet) in skin.facets.iter().enumerate() {
            of_body.entry(facet.body).or_default().push(index);
        }
        let boundary = Boundary {
            tree: FacetTree::new(skin.facets.iter().map(|facet| &facet.shape), |_| 0.0),
            skin,
            of_body,
        };
        let name = |body: u32| self.scene.bodies.keys().nth(body as usize);
        let warnings = pairs.into_iter().filter_map(|[a, b]| {
            let found = [boundary.deepest([a, b]), boundary.deepest([b, a])];
            let deeper = |one: &(f64, _), other: &(f64, _)| one.0.total_cmp(&other.0);
            let (depth, place) = found.into_iter().flatten().max_by(deeper)?;
            Some(format!(
                "bodies '{}' and '{}' overlap without a contact by up to {} {}, as at {}: nothing keeps them from \
                 passing through each other",
                name(a)?,
                name(b)?,
                short(depth),
                self.scene.units.length(),
                self.place(place)
            ))
        });
        warnings.collect()
    }

    /// The pairs of bodies whose bounding boxes overlap, that are there at the same time, and that no contact or tie
    /// connects.
    fn pairs_without_contact(&self) -> Vec<[u32; 2]> {
        let count = self.scene.bodies.len();
        let mut boxes = vec![BoundingBox::EMPTY; count];
        let mesh = &self.bodies.mesh;
        for ((_, nodes), &body) in mesh.cells.iter().zip(&self.bodies.cell_body) {
            let at = nodes.iter().map(|&node| &mesh.points[node as usize]);
            boxes[body as usize].include(&BoundingBox::around(at));
        }
        let meets = |a: &BoundingBox, b: &BoundingBox| {
            (0..mesh.dim).all(|axis| a.low[axis] < b.high[axis] && b.low[axis] < a.high[axis])
        };
        let absent = activation::bodies(self.scene);
        let is_together = |a: u32, b: u32| {
            let both = |absent: &Vec<u32>| !absent.contains(&a) && !absent.contains(&b);
            absent.is_empty() || absent.iter().any(both)
        };
        // Sorted along x, so that most pairs aren't looked at.
        let mut order: Vec<u32> = (0..count as u32).collect();
        let low = |body: u32| boxes[body as usize].low[0];
        order.sort_by(|&a, &b| low(a).total_cmp(&low(b)));
        let mut pairs = Vec::new();
        for (place, &a) in order.iter().enumerate() {
            let high = boxes[a as usize].high[0];
            let beside = order[place + 1..].iter().take_while(|&&b| low(b) < high);
            for &b in beside.filter(|&&b| meets(&boxes[a as usize], &boxes[b as usize])) {
                pairs.push([a.min(b), a.max(b)]);
            }
        }
        if pairs.is_empty() {
            return pairs;
        }
        let connected = self.connected();
        pairs.retain(|pair| !connected.contains(pair) && is_together(pair[0], pair[1]));
        pairs.sort_unstable();
        pairs
    }

    /// The pairs of bodies that a contact or tie connects.
    fn connected(&self) -> BTreeSet<[u32; 2]> {
        let mut body_of: Vec<Option<u32>> = vec![None; self.bodies.mesh.points.len()];
        for ((_, nodes), &body) in (self.bodies.mesh.cells.iter()).zip(&self.bodies.cell_body) {
            (nodes.iter()).for_each(|&node| body_of[node as usize] = Some(body));
        }
        let mut connected = BTreeSet::new();
        for point in self.contacts.iter().flat_map(|contact| &contact.points) {
            let bodies = point.entries.iter();
            let bodies: BTreeSet<u32> = bodies
                .filter_map(|&(node, _)| body_of.get(node as usize).copied().flatten())
                .collect();
            for &a in &bodies {
                connected.extend(bodies.range(a + 1..).map(|&b| [a, b]));
            }
        }
        connected
    }
}

impl Boundary<'_> {
    /// The largest depth at which the first body is inside the second one, and its place; `None` if it isn't, beyond
    /// the distance of straight facets from a curve.
    fn deepest(&self, [inner, outer]: [u32; 2]) -> Option<(f64, [f64; 3])> {
        let own = self.of_body.get(&inner)?;
        let others = self.of_body.get(&outer)?;
        let mut around = BoundingBox::EMPTY;
        for &facet in others {
            around.include(&BoundingBox::around(&self.skin.facets[facet].shape.at));
        }
        let dim = self.skin.mesh.dim;
        let places = own.iter().map(|&facet| {
            (
                &self.skin.facets[facet],
                off_centre(&self.skin.facets[facet]),
            )
        });
        let within: Vec<(&SkinFacet, [f64; 3])> = places
            .filter(|(_, x)| (0..dim).all(|k| around.low[k] < x[k] && x[k] < around.high[k]))
            .collect();
        let some = within.len().div_ceil(MOST_FACETS).max(1);
        let inside = (within.into_iter().step_by(some)).filter(|(_, x)| self.is_inside(outer, *x));
        let depths = inside.filter_map(|(facet, x)| {
            let (depth, size) = self.depth(others, x)?;
            (depth > STANDING_OFF * size.max(facet.shape.size())).then_some((depth, x))
        });
        depths.max_by(|one, other| one.0.total_cmp(&other.0))
    }

    /// True if a point is inside a body: a line from there crosses its boundary an odd number of times.
    fn is_inside(&self, body: u32, x: [f64; 3]) -> bool {
        let direction = match self.skin.mesh.dim {
            2 => ACROSS_PLANE,
            _ => ACROSS,
        };
        let facets = self
            .tree
            .along(x, direction)
            .map(|at| &self.skin.facets[at]);
        let crossed = facets.filter(|facet| facet.body == body).filter(|facet| {
            let shape = &facet.shape;
            (shape.kind.crossing(&shape.at, x, direction)).is_some_and(|ahead| ahead > 0.0)
        });
        crossed.count() % 2 == 1
    }

    /// The distance of a point from the nearest of these facets, and the facet's size.
    fn depth(&self, facets: &[usize], x: [f64; 3]) -> Option<(f64, f64)> {
        let distances = facets.iter().filter_map(|&facet| {
            let shape = &self.skin.facets[facet].shape;
            let ahead = shape.kind.crossing(&shape.at, x, shape.normal)?;
            Some((ahead.abs(), shape.size()))
        });
        distances.min_by(|one, other| one.0.total_cmp(&other.0))
    }
}

/// A point of a facet off its middle, so that lines through it hardly meet an edge of a regular mesh.
fn off_centre(facet: &SkinFacet) -> [f64; 3] {
    let corners = &facet.shape.at[..facet.shape.kind.corners()];
    let weights = (0..corners.len()).map(|k| 1.0 + 0.31 * (1.7 * k as f64 + 0.4).sin());
    let all: f64 = weights.clone().sum();
    let sum = corners.iter().zip(weights);
    sum.fold([0.0; 3], |sum, (corner, weight)| {
        advance(sum, weight / all, *corner)
    })
}
