//! The contact results of a solution.

use contact_dd_partition::model::Model;

use super::super::assembled::{Assembled, Tangent};
use super::super::solution::{ContactPoint, Solution};

/// Contact results by condition and by tangent.
pub struct Answer<'a> {
    pub points: Vec<&'a ContactPoint>,
    pub forces: Vec<f64>,
    pub tangential: Vec<f64>,
    /// Tangential jumps now, and since the step before.
    pub jumps: Vec<f64>,
    pub since: Vec<f64>,
}

impl<'a> Answer<'a> {
    pub fn new(
        model: &Model,
        assembled: &Assembled,
        solution: &'a Solution,
        before: Option<&Solution>,
    ) -> Self {
        let points = model.contacts.iter().flat_map(|contact| {
            let points = &solution.contacts[&contact.name];
            assert_eq!(points.len(), contact.points.len(), "{}", contact.name);
            points
        });
        let points: Vec<&ContactPoint> = points.collect();
        let jumps = |solution: &Solution| -> Vec<f64> {
            let u = solution.dofs(model);
            assembled.tangents.iter().map(|t| t.jump(&u)).collect()
        };
        let now = jumps(solution);
        let past = before.map_or(vec![0.0; now.len()], jumps);
        let tangents = assembled.tangents.iter();
        Self {
            forces: points.iter().map(|point| point.force).collect(),
            tangential: (tangents)
                .map(|t| -dot(points[t.condition].tangential_force, t.direction))
                .collect(),
            since: now
                .iter()
                .zip(&past)
                .map(|(now, past)| now - past)
                .collect(),
            jumps: now,
            points,
        }
    }

    /// The bound of every tangent.
    pub fn bounds(&self, assembled: &Assembled) -> Vec<f64> {
        let bound = |tangent: &Tangent| {
            let (grows, constant) = tangent.bound(self.points[tangent.condition].closed);
            grows * self.forces[tangent.condition] + constant
        };
        assembled.tangents.iter().map(bound).collect()
    }
}

pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| a[k] * b[k]).sum()
}
