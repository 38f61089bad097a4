//! The constraints of a model: contacts, followed by equations between displacements.

use super::activation;
use super::contact::Contacts;
use super::couplings::CoupledFrame;
use super::crack_tips::CrackTips;
use super::cyclic;
use super::equations;
use super::held_nodes::HeldNodes;
use super::loaded_bodies::LoadedBodies;
use super::parts::Contact;
use super::seams;
use super::touching::Declared;
use crate::error::InputError;
use crate::scene::Scene;
use crate::scene::material::PlaneState;

/// Contacts and equations between bodies, and the crack tips at which contacts end.
#[derive(Default)]
pub(super) struct Constraints<'a> {
    /// The contacts, declared or found, that have points.
    pub contacts: Vec<Contact>,
    /// The table of each contact in the scene.
    tables: Vec<&'a str>,
    /// Equations, represented as contacts.
    pub equations: Vec<Contact>,
    /// Crack tips of a plane mesh.
    pub tips: CrackTips,
    /// Descriptions of contacts found automatically and of crack tips left out.
    pub found: Vec<String>,
}

impl<'a> Constraints<'a> {
    /// The contacts that are `declared`, and the equations of the scene, also of the points of couplings, cyclic symmetry
    /// included.
    ///
    /// # Errors
    /// Sides that don't match, supports that press sides into each other, contacts with bodies that are added later, or
    /// equations of nodes that don't exist.
    pub fn new(
        scene: &Scene,
        on: &LoadedBodies,
        plane: Option<PlaneState>,
        (declared, couplings): (&'a [Declared], &[CoupledFrame]),
        warnings: &mut Vec<String>,
    ) -> Result<Self, InputError> {
        let (bodies, topology) = (&on.bodies, &on.topology);
        let held = HeldNodes::new(&on.loads);
        let sides = Contacts::new(&bodies.mesh, topology, held, scene);
        let mut all = Self::default();
        all.make(&sides, declared, warnings)?;
        activation::check(scene, bodies, &all.contacts)?;
        let absent = all.absent(scene).into_iter().flatten().collect();
        seams::join(&mut all.contacts, &bodies.mesh, &absent);
        warnings.extend(seams::hanging(&all.contacts, &bodies.mesh));
        all.tips = CrackTips::find(
            (&bodies.mesh, topology),
            plane,
            &bodies.cell_material,
            &all.contacts,
        );
        all.found.extend(all.tips.remark());
        all.equations = equations::equations(scene, (&bodies.mesh, couplings), all.contacts.len())?;
        let count = all.count();
        let of_sectors = cyclic::cyclic(scene, bodies, &mut all.contacts, count, warnings)?;
        all.equations.extend(of_sectors);
        Ok(all)
    }

    /// Appends the contacts between their `sides`.
    ///
    /// # Errors
    /// Sides that don't match, or that supports press into each other.
    fn make(
        &mut self,
        sides: &Contacts,
        declared: &'a [Declared],
        warnings: &mut Vec<String>,
    ) -> Result<(), InputError> {
        for of in declared {
            let made = sides.declared(self.contacts.len() as u32, &of.contact, warnings)?;
            // A contact that was found needs no points if supports hold all of its nodes.
            if of.words.is_none() || !made.points.is_empty() {
                self.contacts.push(made);
                self.tables.push(&of.table[..]);
                self.found.extend(of.words.clone());
            }
        }
        Ok(())
    }

    /// The number of contacts and equations.
    pub fn count(&self) -> usize {
        self.contacts.len() + self.equations.len()
    }

    /// The contacts and equations that are absent in each step.
    pub fn absent(&self, scene: &Scene) -> Vec<Vec<u32>> {
        let names = self.equations.iter().map(|of| &of.name[..]);
        let tables: Vec<&str> = self.tables.iter().copied().chain(names).collect();
        activation::contacts(scene, &tables)
    }
}
