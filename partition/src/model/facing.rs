//! Whether contacts tell the same facets twice to keep apart: their forces would be anybody's guess.

use super::groups;
use crate::error::InputError;
use crate::mesh::Mesh;
use crate::scene::Scene;
use crate::scene::condition::{Obstacle, Partner};

/// What a contact keeps apart.
struct Facing<'a> {
    name: &'a str,
    /// Facets of side a, ascending.
    a: Vec<u32>,
    /// Facets of side b, ascending; none of an obstacle.
    b: Vec<u32>,
    obstacle: Option<&'a Obstacle>,
}

/// Checks that no two contacts have facets of both of their sides in common, or those of one side
/// and the obstacle. A side may well have several partners.
///
/// # Errors
/// Two such contacts.
pub(super) fn check(scene: &Scene, mesh: &Mesh) -> Result<(), InputError> {
    let mut before: Vec<Facing> = Vec::with_capacity(scene.contact.len());
    for contact in &scene.contact {
        let what = format!("contact '{}'", contact.name);
        let (b, obstacle) = match &contact.partner {
            Partner::Side(names) => (groups::facets(mesh, names, &what)?, None),
            Partner::Obstacle(obstacle) => (Vec::new(), Some(obstacle)),
        };
        let own = Facing {
            name: &contact.name,
            a: groups::facets(mesh, &contact.side_a, &what)?,
            b,
            obstacle,
        };
        for other in &before {
            if let Some(facet) = own.common(other) {
                return Err(InputError::new(format!(
                    "{what}: the facet of nodes {} faces there what it faces in contact '{}' \
                     already; expected every part of two sides in one contact",
                    mesh.tags_of(mesh.facets.nodes_of(facet as usize)),
                    other.name
                )));
            }
        }
        before.push(own);
    }
    Ok(())
}

impl Facing<'_> {
    /// A facet of side a that faces the same in both.
    fn common(&self, other: &Self) -> Option<u32> {
        if self.obstacle.is_some() || other.obstacle.is_some() {
            return match self.obstacle == other.obstacle {
                true => first_common(&self.a, &other.a),
                false => None,
            };
        }
        let same = first_common(&self.b, &other.b).and_then(|_| first_common(&self.a, &other.a));
        same.or_else(|| {
            first_common(&self.b, &other.a).and_then(|_| first_common(&self.a, &other.b))
        })
    }
}

/// The first number that two ascending lists have in common.
fn first_common(a: &[u32], b: &[u32]) -> Option<u32> {
    a.iter().copied().find(|n| b.binary_search(n).is_ok())
}
