//! Forces and moments that contacts and supports carry.

use std::io::{Result, Write};

use contact_dd_partition::problem::Catalog;
use schemars::JsonSchema;
use serde::Serialize;

use super::result::ContactResult;

/// Most lines that are printed; the report has all.
const LINES: usize = 12;

/// A force and its moment about the origin (N and N m, per metre of thickness in the plane).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct Resultant {
    /// Force.
    pub force: [f64; 3],
    /// Moment.
    pub moment: [f64; 3],
}

impl Resultant {
    /// Adds a force that acts at a point.
    pub fn add(&mut self, at: [f64; 3], force: [f64; 3]) {
        for k in 0..3 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            self.force[k] += force[k];
            self.moment[k] += at[i] * force[j] - at[j] * force[i];
        }
    }
}

/// What a contact transfers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct ContactResultant {
    /// Name of the contact.
    pub name: String,
    /// Number of conditions.
    pub conditions: usize,
    /// Number of those that are closed.
    pub closed: usize,
    /// What acts on side a.
    #[serde(flatten)]
    pub resultant: Resultant,
    /// Largest contact pressure (Pa).
    pub largest_pressure: f64,
}

impl ContactResultant {
    /// Adds what a condition carries.
    pub fn add(&mut self, row: &ContactResult) {
        self.closed += usize::from(row.closed);
        (self.resultant).add(row.acts_at, row.normal.map(|n| -row.force * n));
        self.largest_pressure = self.largest_pressure.max(row.pressure);
    }
}

/// What a condition that prescribes displacements exerts on the bodies.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct Reaction {
    /// The condition: its kind, its number among those, and where it holds.
    pub support: String,
    /// What acts on the bodies.
    #[serde(flatten)]
    pub resultant: Resultant,
}

/// All of them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
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

/// Prints contacts and reactions.
///
/// # Errors
/// `out` can't be written.
pub fn print(out: &mut dyn Write, resultants: &Resultants) -> Result<()> {
    let Resultants {
        contacts,
        reactions,
    } = resultants;
    let names = (contacts.iter().map(|c| c.name.as_str()))
        .chain(reactions.iter().map(|r| r.support.as_str()));
    let width = names.map(|name| name.chars().count()).max().unwrap_or(0);
    if !contacts.is_empty() {
        let title = pad("contact, on side a", width);
        writeln!(
            out,
            "{title}       closed      force x      force y     moment z     pressure"
        )?;
    }
    for contact in contacts.iter().take(LINES) {
        let closed = format!("{} of {}", contact.closed, contact.conditions);
        let name = pad(&contact.name, width);
        write!(out, "{name} {closed:>12}")?;
        forces(out, &contact.resultant)?;
        writeln!(out, " {:>12.4e}", contact.largest_pressure)?;
    }
    more(out, contacts.len())?;
    if !reactions.is_empty() {
        let title = pad("support", width);
        writeln!(
            out,
            "{title}                   force x      force y     moment z"
        )?;
    }
    for reaction in reactions.iter().take(LINES) {
        let name = pad(&reaction.support, width);
        write!(out, "{name} {:>12}", "")?;
        forces(out, &reaction.resultant)?;
        writeln!(out)?;
    }
    more(out, reactions.len())
}

fn pad(name: &str, width: usize) -> String {
    let width = width.max("contact, on side a".len());
    format!("{name:<width$}")
}

fn forces(out: &mut dyn Write, resultant: &Resultant) -> Result<()> {
    let [x, y, _] = resultant.force;
    let [.., z] = resultant.moment;
    write!(out, " {x:>12.4e} {y:>12.4e} {z:>12.4e}")
}

fn more(out: &mut dyn Write, count: usize) -> Result<()> {
    match count.checked_sub(LINES) {
        Some(rest @ 1..) => writeln!(out, "… and {rest} more in the report"),
        _ => Ok(()),
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

    #[test]
    fn long_lists_are_cut() {
        let resultants = Resultants {
            contacts: vec![ContactResultant::default(); 15],
            reactions: vec![Reaction::default(); 2],
        };
        let mut out = Vec::new();
        print(&mut out, &resultants).unwrap_or_default();
        let text = String::from_utf8_lossy(&out).into_owned();
        assert_eq!(text.lines().count(), 1 + 12 + 1 + 1 + 2);
        assert!(text.contains("… and 3 more"));
    }
}
