//! Contacts that say the same twice.

use std::collections::{BTreeMap, HashMap};

use super::Diagnostics;
use crate::model::groups;
use crate::scene::condition::Partner;

/// Which sides of two contacts have a facet in common: the first's a with the second's a and b, then its b.
type Common = [[bool; 2]; 2];

impl Diagnostics<'_> {
    /// Two contacts between the same facets, or with the same obstacle: each of them holds what the
    /// other holds already.
    pub(super) fn repeated_contacts(&self) -> Vec<String> {
        let contacts = &self.scene.contact;
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
        let again = common.into_iter().filter_map(|((first, second), common)| {
            let (first, second) = (&contacts[first], &contacts[second]);
            let is_repeated = match (&first.partner, &second.partner) {
                (Partner::Obstacle(one), Partner::Obstacle(other)) => one == other,
                _ => (common[0][0] && common[1][1]) || (common[0][1] && common[1][0]),
            };
            is_repeated.then(|| {
                format!(
                    "contact '{}': there is contact '{}' between the same facets; what they carry is shared \
                     out between the two at will",
                    second.name, first.name
                )
            })
        });
        again.collect()
    }
}
