//! Checks that redundant data of a contact point agree with each other and with the mesh.

use std::collections::BTreeMap;

use crate::contact_point::ContactPoint;
use crate::element::geometry::{advance, difference, length, shown};
use crate::error::InputError;
use crate::model::PlaneState;
use crate::problem::SubdomainNode;

/// Largest error of the sum of weights, relative to the largest of them.
const WEIGHT: f64 = 1e-8;

/// Largest distance of a position from its node, relative to the extent of its subdomains.
const PLACE: f64 = 1e-8;

/// Largest tributary area, relative to the extent of its subdomains: no curved side around a node is longer.
const LARGEST_AREA: f64 = 10.0;

type Point = ContactPoint<SubdomainNode>;

/// A node with the data of its subdomain.
#[derive(Clone, Copy, Debug)]
pub struct NodePlace {
    /// The mesh file's tag.
    pub tag: i64,
    /// Body.
    pub body: usize,
    /// Coordinates (m).
    pub at: [f64; 3],
    /// True for an [auxiliary](super::auxiliary) node, which belongs to neither side.
    pub is_auxiliary: bool,
}

/// The nodes of contact points.
#[derive(Debug)]
pub struct Places {
    /// The nodes by subdomain and number.
    pub nodes: BTreeMap<SubdomainNode, NodePlace>,
    /// The largest extent of their subdomains (m).
    pub extent: f64,
    /// Dimension of space.
    pub dim: usize,
    /// Plane state; `None` in space.
    pub plane: Option<PlaneState>,
}

impl Places {
    /// Checks one point, which is row `at` of the datasets.
    ///
    /// # Errors
    /// The dataset that contradicts the mesh.
    pub fn check(&self, point: &Point, at: usize) -> Result<(), InputError> {
        self.fault(point).map_or(Ok(()), |(dataset, what)| {
            Err(InputError::new(format!(
                "dataset /contact/{dataset}, row {at}: {what}"
            )))
        })
    }

    /// The error in a point, and its dataset.
    fn fault(&self, point: &Point) -> Option<(&'static str, String)> {
        if point.is_equation() {
            return self.fault_of_equation(point);
        }
        let is_auxiliary =
            |node: &SubdomainNode| self.nodes.get(node).is_some_and(|of| of.is_auxiliary);
        let point = &point.rename(|node| (!is_auxiliary(&node)).then_some(node));
        let extent = self.extent;
        let around =
            PlaneState::thickness(self.plane, [point.position[0].abs() + extent, 0.0, 0.0]);
        if point.area > LARGEST_AREA * extent.powi(self.dim as i32 - 1) * around {
            let what = format!(
                "{:e}; expected a part of a side of subdomains whose extent is {extent:e}",
                point.area
            );
            return Some(("area", what));
        }
        let weights = point.entries.iter().map(|&(_, weight)| weight);
        let scale = weights.clone().fold(0.0, |m: f64, w| m.max(w.abs()));
        let sum: f64 = weights.sum();
        // On some quadratic facets the ends of a node's edge are included, too.
        let may_blend = matches!(self.plane, None | Some(PlaneState::Axisymmetric));
        let is_blended = may_blend && point.tag_b == -1 && (sum - 1.0).abs() <= WEIGHT * scale;
        let (expected, why) = match point.entries.len() == 1 || is_blended {
            true => (1.0, "1, that of a node against an obstacle"),
            false => (0.0, "0: those of side a to 1, those of side b to -1"),
        };
        if (sum - expected).abs() > WEIGHT * scale {
            let what = format!("the weights of the point sum to {sum}; expected {why}");
            return Some(("entry_weight", what));
        }
        self.fault_of_names(point)
    }

    /// The error of an equation in the node that represents it.
    fn fault_of_equation(&self, point: &Point) -> Option<(&'static str, String)> {
        let named = point.entries.iter().any(|(node, _)| {
            let place = self.nodes.get(node);
            place.is_some_and(|place| place.tag == point.tag())
        });
        let what = "expected the tag (GlobalNodeId) of a node of the equation";
        (!named && point.tag() != -1).then(|| ("node_a", format!("{}; {what}", point.tag_a)))
    }

    /// The error of a point in its tags.
    fn fault_of_names(&self, point: &Point) -> Option<(&'static str, String)> {
        for (dataset, tag, sign, side) in [
            ("node_a", point.tag_a, 1.0, "positive"),
            ("node_b", point.tag_b, -1.0, "negative"),
        ] {
            if tag == -1 {
                continue;
            }
            let found = point.entries.iter().find(|(node, _)| {
                let place = self.nodes.get(node);
                place.is_some_and(|place| place.tag == tag)
            });
            let Some(&(node, _)) = found.filter(|(_, weight)| sign * weight > 0.0) else {
                let what = format!(
                    "{tag}; expected -1 or the tag (GlobalNodeId) of a node of the point whose \
                     weight is {side}"
                );
                return Some((dataset, what));
            };
            if sign > 0.0 {
                let at = self.nodes[&node].at;
                let is_there =
                    |place: [f64; 3]| length(difference(place, at)) <= PLACE * self.extent;
                if !is_there(point.position) {
                    let [found, at] = [point.position, at].map(|place| shown(place, self.dim));
                    return Some((
                        "position",
                        format!("{found}; expected {at}, where node {tag} is"),
                    ));
                }
                if !self.acts_there(point, node) {
                    let what = format!(
                        "{}; expected the sum of weight · position over the nodes of side a",
                        shown(point.force_point, self.dim)
                    );
                    return Some(("force_point", what));
                }
            }
        }
        None
    }

    /// True if the point of application of a force agrees with the weights of side a, which has the node `own`.
    fn acts_there(&self, point: &Point, own: SubdomainNode) -> bool {
        let body = |node: SubdomainNode| self.nodes.get(&node).map(|place| place.body);
        let is_pair = point.entries.len() == 1 || (point.tag_a != -1 && point.tag_b != -1);
        // If both sides belong to one body, the nodes don't determine their side.
        if !is_pair && (point.entries.iter()).all(|&(node, _)| body(node) == body(own)) {
            return true;
        }
        let on_a = |&&(node, _): &&(SubdomainNode, f64)| match is_pair {
            true => node == own,
            false => body(node) == body(own),
        };
        let (mut place, mut scale) = ([0.0; 3], 0.0);
        for &(node, weight) in point.entries.iter().filter(on_a) {
            let offset = difference(self.nodes[&node].at, point.position);
            place = advance(place, weight, offset);
            scale += weight.abs();
        }
        let force_point = difference(point.force_point, point.position);
        length(difference(force_point, place)) <= PLACE * self.extent * scale.max(1.0)
    }
}
