//! Resultant forces and moments of contacts and supports.

use contact_dd_partition::contact_point::{ContactPoint, Law};
use contact_dd_partition::element::geometry::{advance, cross, length};
use contact_dd_partition::magnitude::short;
use contact_dd_partition::problem::{Catalog, ContactKind};
use contact_dd_partition::scene::units::Units;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::contact_state::ContactState;
use super::quantity::{Quantities, QuantityValue};
use super::stress_intensity::StressIntensity;
use super::tightened_bolt::TightenedBolt;

/// Relative difference of a slipping point's force from its cohesion that may be round-off.
const ROUND_OFF: f64 = 1e-6;

/// Penetration over the largest displacement above which a warning is given: where two curved bodies approach each
/// other by the largest displacement, facets as long as a third of the contact penetrate that far.
const WARNED_PENETRATION: f64 = 0.05;

/// A force and its moment about the origin (N and N m, per metre of thickness in the plane; around an axis the force
/// along it).
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

    /// True if it has components out of the plane.
    pub fn is_spatial(&self) -> bool {
        self.force[2] != 0.0 || self.moment[..2] != [0.0; 2]
    }
}

/// The resultant of a contact.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ContactResultant {
    /// Name of the contact.
    pub name: String,
    /// The kind: "contact", "tie", "equation", "spring", "coupling", "pretension" or "held pretension".
    pub kind: String,
    /// Number of contact constraints.
    pub conditions: usize,
    /// Number of closed constraints.
    pub closed: usize,
    /// Resultant on side a, of equations on the first node of each, of springs on their first end.
    #[serde(flatten)]
    pub resultant: Resultant,
    /// Largest contact pressure (Pa).
    pub largest_pressure: f64,
    /// Largest overlap of its sides (m): pressure over stiffness where it is compliant, else 0.
    pub largest_overclosure: f64,
    /// State and work of its friction; `null` where it has none.
    pub friction: Option<Friction>,
    /// Number of constraints about to open, which slip under a part of their cohesion.
    #[serde(skip)]
    pub parting: usize,
    /// Largest penetration at the nodes of the master side, where nodes don't match (m).
    pub penetration: f64,
    /// The penetration at those nodes.
    #[serde(skip)]
    pub probed: Option<Probed>,
    /// True if side b is the slave side, whose nodes carry the constraints.
    #[serde(skip)]
    pub on_b: bool,
    /// Multiplier λ of the constraint that holds a pretension (N).
    #[serde(skip)]
    pub held: f64,
}

/// Penetration of a contact at the nodes of the side without constraints.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Probed {
    /// Tag of the node that penetrates farthest.
    pub deepest: i64,
    /// Depth, over the largest displacement.
    pub relative: f64,
    /// Number of nodes that touch the other side.
    pub touching: usize,
}

/// State and work of friction in a load step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Friction {
    /// Number of closed constraints with friction that stick.
    pub sticking: usize,
    /// Number of closed constraints that slip.
    pub slipping: usize,
    /// Work dissipated by friction (J, per metre of thickness in the plane).
    pub dissipated_work: f64,
}

impl Friction {
    /// Adds the friction of other points.
    fn add(&mut self, other: Self) {
        self.sticking += other.sticking;
        self.slipping += other.slipping;
        self.dissipated_work += other.dissipated_work;
    }
}

impl ContactResultant {
    /// Adds the forces and status of a point.
    pub fn add(&mut self, point: &ContactPoint<u32>, state: &ContactState) {
        self.closed += usize::from(state.closed);
        self.on_b = point.tag_a == -1;
        if let (Some(friction), true) = (&mut self.friction, point.law.has_friction()) {
            friction.add(Friction {
                sticking: usize::from(state.status() == 1),
                slipping: usize::from(state.status() == 2),
                dissipated_work: state.dissipated,
            });
            self.parting += usize::from(is_parting(point, state));
        }
        // The forces of a coupling also act on its reference point, where loads and reactions report them.
        if point.is_equation() && point.tag() == -1 {
            return;
        }
        match ContactKind::of(point) {
            ContactKind::Pretension => return,
            ContactKind::Spring => {
                let force = point.normal().map(|n| -state.force * n);
                self.resultant.add(point.force_point, force);
                return;
            }
            ContactKind::Held => {
                self.held = state.force;
                return;
            }
            _ => {}
        }
        if let (true, Some((_, factor))) = (point.is_equation(), point.entries.first()) {
            let force = point.normal().map(|n| -factor * state.force * n);
            self.resultant.add(point.position, force);
            return;
        }
        let force = advance(state.tangential_force, -state.force, point.normal());
        self.resultant.add(point.force_point, force);
        self.largest_pressure = self.largest_pressure.max(state.force / point.area);
        let overclosure = point.overclosure(state.force);
        self.largest_overclosure = self.largest_overclosure.max(overclosure);
    }

    /// Warnings of a mesh too coarse for a contact, in `dim` dimensions; `error` is the estimated error.
    fn of_mesh(&self, dim: usize, units: Units, error: Option<f64>) -> Vec<String> {
        // Without pressure no mesh is too coarse.
        let Some(probed) = self.probed.filter(|_| self.largest_pressure > 0.0) else {
            return Vec::new();
        };
        let mut warnings = Vec::new();
        let (own, other) = if self.on_b { ('b', 'a') } else { ('a', 'b') };
        if probed.relative > WARNED_PENETRATION {
            warnings.push(format!(
                "contact '{}': at node {} of side {other} the sides penetrate by {} {}, {} of the largest displacement: the \
                 nodes of side {own} hold them apart, and its facets are too large there; expected smaller ones",
                self.name,
                probed.deepest,
                short(self.penetration),
                units.length(),
                percent(probed.relative)
            ));
        }
        let narrow = [(own, self.closed), (other, probed.touching)];
        if let Some((side, count)) = narrow.into_iter().find(|&(_, count)| count < dim) {
            let error = error.map_or(String::new(), |error| {
                format!(
                    " (the estimate of its error in the energy norm is {})",
                    percent(error)
                )
            });
            warnings.push(format!(
                "contact '{}': the contact zone is narrower than a facet of side {side}, {count} of whose nodes lie in it: \
                 pressures and the approach of the bodies depend on the mesh{error}; expected several facets of both \
                 sides",
                self.name
            ));
        }
        warnings
    }
}

/// A fraction as a percentage.
fn percent(part: f64) -> String {
    format!("{} %", short(100.0 * part))
}

/// True if a point slips below the bound of its law, as happens without pressure at a part of the cohesion.
fn is_parting(point: &ContactPoint<u32>, state: &ContactState) -> bool {
    let Law::Coulomb {
        coefficient,
        cohesion,
    } = point.law
    else {
        return false;
    };
    let bound = coefficient * state.force + cohesion * point.area;
    cohesion > 0.0
        && state.status() == 2
        && length(state.tangential_force) < bound - ROUND_OFF * cohesion * point.area
}

/// Reaction of a support or a prescribed displacement.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Reaction {
    /// The boundary condition: its kind, its number among those of its kind, its groups, and the conditions with which
    /// it shares displacements.
    pub support: String,
    /// Resultant on the bodies.
    #[serde(flatten)]
    pub resultant: Resultant,
}

/// The resultants of all contacts and supports.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Resultants {
    /// Contacts, in the order of the scene.
    pub contacts: Vec<ContactResultant>,
    /// Reactions: displacement conditions, then bilateral ones.
    pub reactions: Vec<Reaction>,
    /// Bolts that are tightened, in the order of the scene.
    pub pretensions: Vec<TightenedBolt>,
    /// Stress intensity of crack tips in the plane; empty where stresses are left out.
    pub crack_tips: Vec<StressIntensity>,
    /// Quantities that the scene requests.
    pub quantities: Vec<QuantityValue>,
    /// Contact points whose status is about to change, as text; derivatives are one-sided there, for the present
    /// status.
    pub about_to_change: Vec<String>,
    /// Reason why all quantities, or one of them, have no derivatives, as text; `null` if all have derivatives.
    pub without_derivatives: Option<String>,
}

impl Resultants {
    /// The resultants of a problem's contacts, all zero, and `reactions`.
    pub fn new(catalog: &Catalog, reactions: Vec<Reaction>) -> Self {
        let contacts = catalog.contacts.iter().map(|contact| ContactResultant {
            name: contact.name.clone(),
            kind: contact.kind.word().into(),
            conditions: contact.conditions,
            friction: contact.has_friction.then(Friction::default),
            ..ContactResultant::default()
        });
        Self {
            contacts: contacts.collect(),
            reactions,
            ..Self::default()
        }
    }

    /// Number of closed contact points.
    pub fn closed_points(&self, catalog: &Catalog) -> usize {
        let contacts = catalog.contacts.iter().zip(&self.contacts);
        let unilateral = contacts.filter(|(of, _)| of.kind == ContactKind::Unilateral);
        unilateral.map(|(_, contact)| contact.closed).sum()
    }

    /// Adds the quantities of a load step.
    pub fn put(&mut self, quantities: Quantities) {
        self.quantities = quantities.values;
        self.about_to_change = quantities.about_to_change;
        self.without_derivatives = quantities.without_derivatives;
    }

    /// Turns the forces into sums all around an axis: components not along the axis cancel, and so do moments.
    pub fn sum_around_axis(&mut self) {
        let contacts = self
            .contacts
            .iter_mut()
            .map(|contact| &mut contact.resultant);
        let reactions = self
            .reactions
            .iter_mut()
            .map(|reaction| &mut reaction.resultant);
        for Resultant { force, moment } in contacts.chain(reactions) {
            *force = [0.0, force[1], 0.0];
            *moment = [0.0; 3];
        }
    }

    /// State and work of friction in all contacts; `None` if there is none.
    pub fn friction(&self) -> Option<Friction> {
        let all = self.contacts.iter().filter_map(|contact| contact.friction);
        all.reduce(|mut sum, friction| {
            sum.add(friction);
            sum
        })
    }

    /// Warnings of contacts for which the mesh is too coarse; `error` is the estimated error, if known.
    pub fn warnings_of_mesh(&self, catalog: &Catalog, error: Option<f64>) -> Vec<String> {
        let contacts = self.contacts.iter();
        let words = contacts.flat_map(|contact| contact.of_mesh(catalog.dim, catalog.units, error));
        words.collect()
    }

    /// Warnings of contacts whose law leaves the force of some points indeterminate.
    pub fn warnings(&self) -> Vec<String> {
        let parting = self.contacts.iter().filter(|contact| contact.parting > 0);
        let words = parting.map(|contact| {
            format!(
                "contact '{}': {} of its points are on the verge of opening, at zero pressure, and slip below full \
                 cohesion",
                contact.name, contact.parting
            )
        });
        words.collect()
    }
}

#[cfg(test)]
mod tests;
