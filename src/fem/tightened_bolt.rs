//! Force and shortening of tightened bolts.

use contact_dd_partition::contact_point::ContactPoint;
use contact_dd_partition::element::geometry::dot;
use contact_dd_partition::problem::{Catalog, ContactKind};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A bolt that is tightened at a cut through it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TightenedBolt {
    /// Name of the pretension.
    pub name: String,
    /// Tensile force across the cut (N, per metre of thickness in the plane).
    pub force: f64,
    /// Length that is taken out of the bolt at the cut (m).
    pub shortening: f64,
    /// True if the shortening is fixed: prescribed or locked.
    pub held: bool,
}

impl TightenedBolt {
    /// The first point of each pretension of a problem, with the nodes of its cut only; its jump is the shortening.
    pub fn points<N: Copy>(catalog: &Catalog, points: &[ContactPoint<N>]) -> Vec<ContactPoint<N>> {
        let is_first = |point: &&ContactPoint<N>| {
            let kind = catalog.contacts[point.contact as usize].kind;
            kind == ContactKind::Pretension && point.place == 0
        };
        let mut all: Vec<_> = points.iter().filter(is_first).cloned().collect();
        for point in &mut all {
            point.entries.truncate(2);
            point.axes.truncate(2);
        }
        all.sort_by_key(|point| point.contact);
        all
    }

    /// The bolt `name` of such a point in a load step, with its `jump` (m); `held` is the multiplier λ of the
    /// constraint that holds the shortening, if there is one (N).
    pub fn new<N: Copy>(
        name: &str,
        point: &ContactPoint<N>,
        (step, jump): (usize, [f64; 3]),
        held: Option<f64>,
    ) -> Self {
        let given = point.preload.get(step).copied().unwrap_or_default();
        Self {
            name: name.to_owned(),
            force: given - held.unwrap_or_default(),
            shortening: dot(jump, point.normal()),
            held: held.is_some(),
        }
    }
}
