//! Warnings of probable mistakes in an otherwise valid scene.

mod facets;
mod hinges;
mod overlaps;
mod strains;
mod undeclared;

use std::collections::{BTreeMap, HashMap};

use super::bodies::Bodies;
use super::loaded_bodies::LoadedBodies;
use super::steps::Loads;
use super::touching::Declared;
use super::{Contact, Material, activation, groups};
use crate::error::InputError;
use crate::magnitude::{short, short_point};
use crate::mesh::bounding_box::BoundingBox;
use crate::mesh::topology::Topology;
use crate::scene::Scene;
use crate::scene::contact::Partner;

/// Pairs of sides of two contacts that have a facet in common: the first's a with the second's a and b, then its b.
type Common = [[bool; 2]; 2];

/// The parts of a model to be checked.
pub(super) struct Diagnostics<'a> {
    scene: &'a Scene,
    bodies: &'a Bodies,
    topology: &'a Topology,
    materials: &'a [Material],
    loads: &'a Loads,
    contacts: &'a [Contact],
    /// The declarations of the contacts.
    declared: &'a [Declared],
}

impl<'a> Diagnostics<'a> {
    /// The diagnostics of a scene on its bodies, with the contacts built from `declared`.
    pub fn new(
        scene: &'a Scene,
        on: &'a LoadedBodies,
        contacts: &'a [Contact],
        declared: &'a [Declared],
    ) -> Self {
        Self {
            scene,
            bodies: &on.bodies,
            topology: &on.topology,
            materials: &on.materials,
            loads: &on.loads,
            contacts,
            declared,
        }
    }

    /// All warnings.
    ///
    /// # Errors
    /// A value so large that it has to be a mistake.
    pub fn warnings(&self) -> Result<Vec<String>, InputError> {
        let tables: Vec<&str> = self.declared.iter().map(|of| &of.table[..]).collect();
        self.check_repeated_contacts(&activation::contacts(self.scene, &tables))?;
        let mut warnings = self.strains()?;
        warnings.extend(self.far_apart());
        warnings.extend(self.undeclared());
        warnings.extend(self.overlaps());
        warnings.extend(self.hinges());
        warnings.extend(self.facets_of_curves());
        Ok(warnings)
    }

    /// The largest extent of the bodies (m).
    fn extent(&self) -> f64 {
        BoundingBox::around(&self.bodies.mesh.points).extent()
    }

    /// A point of the mesh as text, with its unit.
    fn place(&self, at: [f64; 3]) -> String {
        let at = short_point(at, self.bodies.mesh.dim);
        format!("{at} {}", self.scene.units.length())
    }

    /// Warnings of contacts whose gap exceeds the size of the bodies.
    fn far_apart(&self) -> Vec<String> {
        let (extent, unit) = (self.extent(), self.scene.units.length());
        let least = |contact: &Contact| {
            let gaps = contact.points.iter().map(|point| point.gap);
            gaps.reduce(f64::min)
        };
        let far = self.contacts.iter().filter_map(|contact| {
            let gap = least(contact).filter(|&gap| gap > extent)?;
            Some(format!(
                "contact '{}': the smallest gap is {} {unit}, and the bodies measure {} {unit}; are place and units right?",
                contact.name,
                short(gap),
                short(extent)
            ))
        });
        far.collect()
    }

    /// Refuses two contacts between the same facets, or with the same obstacle, whose constraints repeat each other.
    ///
    /// # Errors
    /// Two such contacts in the same load step: the forces of each would depend on their order.
    fn check_repeated_contacts(&self, absent: &[Vec<u32>]) -> Result<(), InputError> {
        let contacts: Vec<_> = self.declared.iter().map(|of| &of.contact).collect();
        let mesh = &self.bodies.mesh;
        let mut of_facet: HashMap<u32, Vec<(usize, usize)>> = HashMap::new();
        let mut common: BTreeMap<(usize, usize), Common> = BTreeMap::new();
        for (index, contact) in contacts.iter().enumerate() {
            for (side, names) in contact.sides().enumerate() {
                for facet in groups::facets(mesh, names, "").unwrap_or_default() {
                    let others = of_facet.entry(facet).or_default();
                    for &(other, of_other) in others.iter().filter(|(other, _)| *other != index) {
                        common.entry((other, index)).or_default()[of_other][side] = true;
                    }
                    others.push((index, side));
                }
            }
        }
        let mut again = common.into_iter().filter_map(|((first, second), common)| {
            let (first_number, second_number) = (first as u32, second as u32);
            let (first, second) = (contacts[first], contacts[second]);
            let is_repeated = match (&first.partner, &second.partner) {
                (Partner::Obstacle(one), Partner::Obstacle(other)) => one == other,
                _ => (common[0][0] && common[1][1]) || (common[0][1] && common[1][0]),
            };
            let is_there = |k: &Vec<u32>| !k.contains(&first_number) && !k.contains(&second_number);
            let are_together = absent.is_empty() || absent.iter().any(is_there);
            (is_repeated && are_together).then(|| {
                InputError::new(format!(
                    "contact '{}': there is contact '{}' between the same facets; expected one contact, or \
                     steps in which only one of them is there",
                    second.name, first.name
                ))
            })
        });
        match again.next() {
            Some(error) => Err(error),
            None => Ok(()),
        }
    }
}
