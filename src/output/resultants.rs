//! Forces and moments that contacts and supports carry.

use contact_dd_partition::contact_point::ContactPoint;
use contact_dd_partition::element::geometry::{advance, cross};
use contact_dd_partition::problem::Catalog;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::result::ContactState;

/// A force and its moment about the origin (N and N m, per metre of thickness in the plane).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Resultant {
    /// Force.
    pub force: [f64; 3],
    /// Moment.
    pub moment: [f64; 3],
}

impl Resultant {
    /// Adds a force that acts at a point.
    pub fn add(&mut self, at: [f64; 3], force: [f64; 3]) {
        self.force = advance(self.force, 1.0, force);
        self.moment = advance(self.moment, 1.0, cross(at, force));
    }
}

/// What a contact transfers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ContactResultant {
    /// Name of the contact.
    pub name: String,
    /// Number of conditions.
    pub conditions: usize,
    /// Number of those that are closed.
    pub closed: usize,
    /// Number of closed ones with friction that stick.
    pub sticking: usize,
    /// Number of those that slip.
    pub slipping: usize,
    /// What friction dissipates in this load step (J, per metre of thickness in the plane).
    pub dissipated_work: f64,
    /// What acts on side a.
    #[serde(flatten)]
    pub resultant: Resultant,
    /// Largest contact pressure (Pa).
    pub largest_pressure: f64,
}

impl ContactResultant {
    /// Adds what a point carries.
    pub fn add(&mut self, point: &ContactPoint<u32>, state: &ContactState) {
        self.closed += usize::from(state.closed);
        if point.law.has_friction() {
            self.sticking += usize::from(state.status() == 1);
            self.slipping += usize::from(state.status() == 2);
            self.dissipated_work += state.dissipated;
        }
        let force = advance(state.tangential_force, -state.force, point.normal());
        self.resultant.add(point.force_point, force);
        self.largest_pressure = self.largest_pressure.max(state.force / point.area);
    }
}

/// What a condition that prescribes displacements exerts on the bodies.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Reaction {
    /// The condition: its kind, its number among those, and where it holds.
    pub support: String,
    /// What acts on the bodies.
    #[serde(flatten)]
    pub resultant: Resultant,
}

/// All of them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Resultants {
    /// Contacts, in the order of the scene.
    pub contacts: Vec<ContactResultant>,
    /// Reactions: displacement conditions, then bilateral ones.
    pub reactions: Vec<Reaction>,
}

impl Resultants {
    /// Contacts of a problem that carry nothing yet, and reactions.
    pub fn new(catalog: &Catalog, reactions: Vec<Reaction>) -> Self {
        let contacts = catalog.contacts.iter().map(|contact| ContactResultant {
            name: contact.name.clone(),
            conditions: contact.conditions,
            ..ContactResultant::default()
        });
        Self {
            contacts: contacts.collect(),
            reactions,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_force_has_a_moment_about_the_origin() {
        let mut sum = Resultant::default();
        sum.add([2.0, 1.0, 0.0], [3.0, 5.0, 0.0]);
        sum.add([0.0, 1.0, 0.0], [1.0, 0.0, 0.0]);
        assert_eq!(sum.force, [4.0, 5.0, 0.0]);
        assert_eq!(sum.moment, [0.0, 0.0, 2.0 * 5.0 - 3.0 - 1.0]);
    }
}
