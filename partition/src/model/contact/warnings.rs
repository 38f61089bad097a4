//! Warnings of contacts that are probably mistakes.

use std::collections::HashMap;

use super::super::held_nodes::ROUNDING;
use super::super::surface::{CORNER, Surface, Turn};
use super::{Contacts, Paired};
use crate::contact_point::ContactPoint;
use crate::element::geometry::dot;
use crate::magnitude::short;

/// Gap or overlap, relative to the side's extent, above which a warning is given: quadratic edges that approximate an arc have
/// a smaller one.
const WARNED_GAP: f64 = 1e-8;

/// Distance of straight facets from a curve, relative to an interference, above which it affects the interference.
const SIGNIFICANT: f64 = 0.1;

/// Height of the kinks between straight quadratic facets, relative to their size, above which they approximate a curve.
const KINKED: f64 = 1e-4;

impl Contacts<'_> {
    /// The warning of an interference fit whose straight facets lie `off` a curve (m).
    pub(super) fn interference(
        &self,
        points: &[ContactPoint<u32>],
        side_a: &Surface,
        off: f64,
        what: &str,
    ) -> Option<String> {
        let unit = self.units.length();
        let deepest = points.iter().map(|p| p.gap).fold(0.0, f64::min);
        let seen = self.seen(side_a);
        if deepest >= -seen {
            return None;
        }
        let count = points.iter().filter(|p| p.gap < -seen).count();
        let facets = match off > SIGNIFICANT * -deepest {
            true => format!(
                "; straight facets stand off a curve by up to {} {unit} of that: expected quadratic cells",
                short(off)
            ),
            false => String::new(),
        };
        Some(format!(
            "{what}: {count} of {} gaps are negative, an interference fit of up to {} {unit}{facets}",
            points.len(),
            short(-deepest)
        ))
    }

    /// The warning of measured gaps that straight facets alone may make: they stand off the curve by as much, so that
    /// sides which touch are held apart. Overlaps have a warning of their own.
    pub(super) fn gaps_of_facets(
        &self,
        paired: &Paired,
        side_a: &Surface,
        what: &str,
    ) -> Option<String> {
        let unit = self.units.length();
        let gaps = || paired.points.iter().map(|point| point.gap);
        let (least, most) = (
            gaps().fold(f64::INFINITY, f64::min),
            gaps().fold(0.0, f64::max),
        );
        let seen = self.seen(side_a);
        (least >= -seen && most > seen && most <= paired.sagitta).then(|| {
            format!(
                "{what}: its gaps of up to {} {unit} are no larger than straight facets stand off the curve, by up to {} {unit}: \
                 where the sides touch, facets that don't match hold them apart; expected gap = 0.0 there, the same mesh on both \
                 sides, or curved quadratic cells",
                short(most),
                short(paired.sagitta)
            )
        })
    }

    /// The gap or overlap above which a warning is given (m).
    fn seen(&self, side_a: &Surface) -> f64 {
        (ROUNDING * self.size).max(WARNED_GAP * side_a.extent())
    }

    /// The warning of a point at a corner of side a, where the averaged normal is that of neither facet.
    pub(super) fn corner(
        &self,
        side_a: &Surface,
        points: &[ContactPoint<u32>],
        what: &str,
    ) -> Option<String> {
        let normals: HashMap<i64, [f64; 3]> =
            (points.iter().map(|point| (point.tag_a, point.normal()))).collect();
        let tag = |node: u32| self.mesh.node_tags[node as usize];
        let nodes = side_a.nodes();
        let is_mean = |node: u32| {
            let (used, mean) = (normals.get(&tag(node))?, nodes[&node].normal()?);
            Some(dot(*used, mean) > 1.0 - 1e-9)
        };
        let turn = (side_a.turns().into_iter())
            .find(|turn| turn.angle > CORNER && is_mean(turn.node) == Some(true))?;
        let Turn { node, angle, .. } = turn;
        let at = self.mesh.points[node as usize][..self.mesh.dim].iter();
        let at: Vec<String> = at.map(|&c| short(c)).collect();
        Some(format!(
            "{what}: side a has a corner of {:.0}° at node {}, ({}), where it presses along the mean of \
             both normals; expected sides without corners, a contact for each",
            angle.to_degrees(),
            tag(node),
            at.join(", ")
        ))
    }

    /// The warning of straight quadratic facets that approximate a curve: their middle nodes are farther from it than
    /// the corners, so that pressures oscillate between the two.
    pub(super) fn straight_edges(what: &str, letter: &str, side: &Surface) -> Option<String> {
        let is_quadratic = side.facets.iter().any(|facet| !facet.kind.is_linear());
        let off = side.sagitta_of_curve();
        (is_quadratic && off > KINKED * side.facet_size()).then(|| {
            format!(
                "{what}: the quadratic facets of side {letter} are straight and stand off a curve by up to {} of their size, so \
                 that pressures oscillate from node to node; expected nodes on edges that lie on the curve, or linear cells, \
                 whose pressures don't",
                short(off / side.facet_size())
            )
        })
    }
}
