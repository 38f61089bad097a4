//! Adjacent pairs of facets, combined to the two sides of a contact.

use std::collections::{BTreeSet, HashMap, HashSet};

use super::super::skin::{Facing, Skin};
use super::super::surface::Surface;
use crate::element::geometry::advance;
use crate::mesh::bounding_box::BoundingBox;

/// Ratio of the facets' size to that of the other side below which a side is finer.
const FINER: f64 = 0.6;

/// Components of the sum of all normals, relative to the size of a side, and differences of positions, relative to the
/// extent of the bodies, that are round-off.
const SAME: f64 = 1e-6;

/// Two sides that face each other.
pub(super) struct Patch {
    /// The body of each.
    pub bodies: [u32; 2],
    /// Facets, ascending.
    pub sides: [Vec<usize>; 2],
    /// Length or area of their overlap.
    pub measure: f64,
    /// The smallest and the largest gap at the centres of facets (m).
    pub gaps: [f64; 2],
}

impl Patch {
    /// The bodies in ascending order, whichever has side a.
    pub fn pair(&self) -> [u32; 2] {
        let [a, b] = self.bodies;
        [a.min(b), a.max(b)]
    }
}

/// The pairs of facets adjacent to a pair: one or both of its facets replaced by a neighbour.
pub(super) fn beside(
    neighbours: &[Vec<usize>],
    [a, b]: [usize; 2],
) -> impl Iterator<Item = [usize; 2]> {
    let around = |facet: usize| std::iter::once(facet).chain(neighbours[facet].iter().copied());
    around(a).flat_map(move |first| around(b).map(move |second| [first, second]))
}

/// The sides of all contacts between pairs of facets, in an order that doesn't depend on the numbering of nodes and
/// cells: by bodies, then by position.
pub(super) fn patches(skin: &Skin, neighbours: &[Vec<usize>], pairs: &[Facing]) -> Vec<Patch> {
    let number: HashMap<[usize; 2], usize> = (pairs.iter().enumerate())
        .map(|(index, pair)| (pair.facets, index))
        .collect();
    let mut done = vec![false; pairs.len()];
    let mut patches = Vec::new();
    for seed in 0..pairs.len() {
        if std::mem::replace(&mut done[seed], true) {
            continue;
        }
        let mut patch = Sides::default();
        let mut stack = vec![(seed, pairs[seed].facets)];
        while let Some((index, [a, b])) = stack.pop() {
            patch.add(&pairs[index], [a, b]);
            for [a, b] in beside(neighbours, [a, b]) {
                if let Some(&next) = number.get(&[a.min(b), a.max(b)])
                    && !std::mem::replace(&mut done[next], true)
                {
                    stack.push((next, [a, b]));
                }
            }
        }
        patches.extend(patch.oriented(skin));
    }
    let extent = BoundingBox::around(&skin.mesh.points).extent();
    let place = |patch: &Patch| {
        let middle = middle(skin, &patch.sides);
        let rounded = middle.map(|c| (c / (SAME * extent)).round());
        (patch.pair(), rounded)
    };
    patches.sort_by(|one, other| {
        let ((bodies, at), (others, there)) = (place(one), place(other));
        let axes = (0..3).map(|k| at[k].total_cmp(&there[k]));
        axes.fold(bodies.cmp(&others), std::cmp::Ordering::then)
    });
    patches
}

/// Facets of the two sides of a growing contact.
#[derive(Default)]
struct Sides {
    facets: [BTreeSet<usize>; 2],
    measure: f64,
    gaps: Option<[f64; 2]>,
}

impl Sides {
    fn add(&mut self, pair: &Facing, facets: [usize; 2]) {
        for (side, facet) in self.facets.iter_mut().zip(facets) {
            side.insert(facet);
        }
        self.measure += pair.measure;
        let [least, most] = self.gaps.unwrap_or([pair.gap; 2]);
        self.gaps = Some([least.min(pair.gap), most.max(pair.gap)]);
    }

    /// The patch. Side a, the slave side, is that of the body whose name comes first, within one body the side that
    /// faces up or right; on curved sides it is the other one if that has a much coarser mesh. `None` where the sides
    /// can't open, as they have the same nodes.
    fn oriented(self, skin: &Skin) -> Option<Patch> {
        let mut sides = self.facets.map(|side| side.into_iter().collect::<Vec<_>>());
        let nodes = |side: &[usize]| -> HashSet<u32> {
            let facets = side.iter().map(|&facet| &skin.facets[facet].shape);
            facets
                .flat_map(|facet| facet.nodes.iter().copied())
                .collect()
        };
        let [on_a, on_b] = [nodes(&sides[0]), nodes(&sides[1])];
        if on_a.is_subset(&on_b) || on_b.is_subset(&on_a) {
            return None;
        }
        let body = |side: &[usize]| skin.facets[side[0]].body;
        let is_turned = match body(&sides[0]).cmp(&body(&sides[1])) {
            std::cmp::Ordering::Equal => faces_down(skin, &sides[0]),
            order => order.is_gt(),
        };
        let surface = |side: &[usize]| Surface {
            facets: (side.iter().map(|&facet| skin.facets[facet].shape.clone())).collect(),
        };
        if is_turned {
            sides.swap(0, 1);
        }
        let [a, b] = [surface(&sides[0]), surface(&sides[1])];
        let is_curved = a.sagitta().max(b.sagitta()) > SAME * a.extent();
        if is_curved && a.facet_size() < FINER * b.facet_size() {
            sides.swap(0, 1);
        }
        Some(Patch {
            bodies: [body(&sides[0]), body(&sides[1])],
            sides,
            measure: self.measure,
            gaps: self.gaps?,
        })
    }
}

/// True if a side faces down, left or to the back: by the last component of its normals' sum that isn't round-off.
fn faces_down(skin: &Skin, side: &[usize]) -> bool {
    let facets = || side.iter().map(|&facet| &skin.facets[facet].shape);
    let measure: f64 = facets().map(|facet| facet.measure).sum();
    let sum = facets().fold([0.0; 3], |sum, f| advance(sum, f.measure, f.normal));
    let decides = |c: &&f64| c.abs() > SAME * measure;
    sum.iter().rev().find(decides).is_some_and(|c| *c < 0.0)
}

/// The mean of the nodes of both sides (m).
fn middle(skin: &Skin, sides: &[Vec<usize>; 2]) -> [f64; 3] {
    let facets = sides
        .iter()
        .flatten()
        .map(|&facet| &skin.facets[facet].shape);
    let nodes: Vec<[f64; 3]> = facets.flat_map(|facet| facet.at.iter().copied()).collect();
    let part = 1.0 / nodes.len() as f64;
    nodes.iter().fold([0.0; 3], |sum, &x| advance(sum, part, x))
}
