//! Nodes held by supports, and contact points whose jump is prescribed by them.

use std::collections::HashMap;

use super::steps::Loads;
use super::supports::PARALLEL;
use crate::contact_point::ContactPoint;
use crate::element::geometry::{advance, dot, length};
use crate::error::InputError;
use crate::scene::units::Units;

/// Relative accuracy of gaps, in terms of the scene's coordinates.
pub(super) const ROUNDING: f64 = 1e-12;

/// Squared cosine between an axis and the held directions of a node above which the node counts as held along the axis.
const ALONG: f64 = 0.5;

/// A direction in which a node is held, and the displacement in each load step (m).
struct Held {
    direction: [f64; 3],
    values: Vec<f64>,
}

/// The nodes held by supports, each with its directions.
#[derive(Default)]
pub(super) struct HeldNodes(HashMap<u32, Vec<Held>>);

impl HeldNodes {
    /// The nodes held by the supports of `loads`.
    pub fn new(loads: &Loads) -> Self {
        let mut by_node: HashMap<u32, Vec<Held>> = HashMap::new();
        for (i, support) in loads.supports.iter().enumerate() {
            by_node.entry(support.node).or_default().push(Held {
                direction: support.direction,
                values: loads.values(i),
            });
        }
        Self(by_node)
    }

    /// True if supports hold a node along axis k, at least approximately.
    pub fn is_held_along(&self, node: u32, k: usize) -> bool {
        let held = self.0.get(&node).into_iter().flatten();
        held.map(|held| held.direction[k].powi(2)).sum::<f64>() > ALONG
    }

    /// The points of contact `number` whose normal jump isn't prescribed by supports, and those of which it is; gaps are
    /// exact to `slack` (m).
    ///
    /// # Errors
    /// A point at which supports prescribe penetration.
    pub fn without_prescribed(
        &self,
        (number, what): (u32, &str),
        points: Vec<ContactPoint<u32>>,
        slack: f64,
        units: Units,
    ) -> Result<[Vec<ContactPoint<u32>>; 2], InputError> {
        let unit = units.length();
        let mut kept = Vec::with_capacity(points.len());
        let mut prescribed = Vec::new();
        for point in points {
            let Some(jumps) = self.prescribed_jump(&point) else {
                kept.push(ContactPoint {
                    contact: number,
                    place: kept.len() as u32,
                    ..point
                });
                continue;
            };
            let closest = jumps.into_iter().fold(f64::NEG_INFINITY, f64::max);
            if closest > point.gap + slack {
                return Err(InputError::new(format!(
                    "{what}: at node {} displacements are prescribed on both sides that close \
                     the gap of {} {unit} by {closest} {unit}; expected no penetration",
                    point.tag(),
                    point.gap
                )));
            }
            prescribed.push(point);
        }
        Ok([kept, prescribed])
    }

    /// The normal jump in every load step of a point all of whose nodes are prescribed along the normal. `None` if one
    /// is free, or if the contact is compliant.
    fn prescribed_jump(&self, point: &ContactPoint<u32>) -> Option<Vec<f64>> {
        let mut jumps = Vec::new();
        if point.is_compliant() {
            return None;
        }
        for (node, row) in point.row() {
            let mut free = row;
            for held in self.0.get(&node)? {
                let along = dot(row, held.direction);
                free = advance(free, -along, held.direction);
                jumps.resize(held.values.len(), 0.0);
                for (jump, value) in jumps.iter_mut().zip(&held.values) {
                    *jump += along * value;
                }
            }
            if length(free) > PARALLEL {
                return None;
            }
        }
        for (jump, motion) in jumps.iter_mut().zip(&point.motion) {
            *jump -= dot(point.normal(), *motion);
        }
        Some(jumps)
    }
}
