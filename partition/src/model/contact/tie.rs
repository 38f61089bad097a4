//! Ties: points whose jump is 0, made like those of a contact.

use super::super::Contact;
use super::super::surface::{Surface, SurfaceFacet};
use super::Contacts;
use crate::contact_point::{ContactPoint, Law};
use crate::error::InputError;
use crate::magnitude::short;
use crate::scene::condition::Names;
use crate::scene::contact;
use crate::scene::tie::TieReach;

/// Distance up to which sides are tied, relative to the size of their facets: the position tolerance of Abaqus.
const NEAR: f64 = 0.05;

/// Gap that is kept, relative to the size of facets, from which on it is worth a warning: it turns with neither side.
const FELT: f64 = 1e-3;

/// The points of a tie, and those that are too far from the other side.
pub(in crate::model) struct Tied {
    /// The points, with the gaps of the mesh.
    pub points: Vec<ContactPoint<u32>>,
    /// Size of the facets (m).
    pub size: f64,
    /// Warnings.
    pub warnings: Vec<String>,
}

impl Contacts<'_> {
    /// The points of tie `number` of the scene, along side a.
    pub(super) fn tie(
        &self,
        number: u32,
        keys: &contact::Contact,
        (names, reach): (&Names, TieReach),
        warnings: &mut Vec<String>,
    ) -> Result<Contact, InputError> {
        let what = format!("tie '{}'", keys.name);
        let tied = self.tied(number, keys, (names, reach), &what)?;
        warnings.extend(tied.warnings);
        let widest = tied.points.iter().fold(0.0, |m: f64, p| m.max(p.gap.abs()));
        if !reach.adjust && widest > FELT * tied.size {
            warnings.push(format!(
                "{what}: gaps of up to {} {} are kept, over which forces act without a moment; expected sides that touch, or \
                 adjust = true, which moves nodes",
                short(widest),
                self.units.length()
            ));
        }
        let points = (0..).zip(tied.points);
        let points = points.map(|(place, point)| ContactPoint {
            contact: number,
            place,
            gap: 0.0,
            law: Law::Tied,
            ..point
        });
        Ok(Contact {
            name: keys.name.clone(),
            points: points.collect(),
            probes: Vec::new(),
        })
    }

    /// The points of a tie between side a of `keys` and the side of these `names`, as far as it reaches.
    ///
    /// # Errors
    /// Sides that don't face each other, or are apart.
    pub(in crate::model) fn tied(
        &self,
        number: u32,
        keys: &contact::Contact,
        (names, reach): (&Names, TieReach),
        what: &str,
    ) -> Result<Tied, InputError> {
        let (facets_a, side_a) = self.side(&keys.side_a, what)?;
        let (facets_b, side_b) = self.side(names, what)?;
        let [held_a, held_b] = [&side_a, &side_b].map(|side| self.held_shares(side));
        let is_more = |a: [f64; 3], b: [f64; 3]| (0..3).any(|k| a[k] > b[k]);
        let mut warnings = Vec::new();
        let points = match (is_more(held_a, held_b), is_more(held_b, held_a)) {
            // What carries the conditions is to be free.
            (true, false) => {
                let on_b = facets_b.into_iter().collect();
                let paired = self.sides(
                    number,
                    (&on_b, &side_b),
                    &keys.side_a,
                    keys.pairing,
                    what,
                )?;
                let of_a = side_a.nodes();
                let at = |node: u32| self.mesh.points[node as usize];
                let points = paired.points.into_iter();
                points
                    .map(|point| point.turned(|node| of_a.contains_key(&node), at))
                    .collect()
            }
            (is_held, _) => {
                if is_held {
                    warnings.push(format!(
                        "{what}: supports hold facets of both sides in other directions, and what they hold of side a isn't \
                         tied; expected supports of one side"
                    ));
                }
                let on_a = facets_a.into_iter().collect();
                let paired =
                    self.sides(number, (&on_a, &side_a), names, keys.pairing, what)?;
                paired.points
            }
        };
        let size = side_a.facet_size().max(side_b.facet_size());
        let tolerance = reach.tolerance.unwrap_or(NEAR * size);
        let least = points.iter().fold(f64::INFINITY, |m, p| m.min(p.gap.abs()));
        let count = points.len();
        let unit = self.units.length();
        let (near, far): (Vec<_>, Vec<_>) =
            (points.into_iter()).partition(|point| point.gap.abs() <= tolerance);
        if near.is_empty() {
            return Err(InputError::new(format!(
                "{what}: its sides are {} {unit} apart or more, and what is farther apart than {} {unit} isn't tied; expected \
                 sides that touch, or a larger 'tolerance'",
                short(least),
                short(tolerance)
            )));
        }
        let farthest = far.iter().fold(0.0, |m: f64, p| m.max(p.gap.abs()));
        if !far.is_empty() {
            warnings.push(format!(
                "{what}: {} of its {count} nodes are up to {} {unit} from the other side, farther than {} {unit}, and aren't \
                 tied",
                far.len(),
                short(farthest),
                short(tolerance)
            ));
        }
        Ok(Tied {
            points: near,
            size,
            warnings,
        })
    }

    /// The parts of a side's facets all of whose nodes supports hold along each axis.
    fn held_shares(&self, side: &Surface) -> [f64; 3] {
        let count = side.facets.len().max(1) as f64;
        std::array::from_fn(|k| {
            let is_held = |facet: &&SurfaceFacet| {
                let mut nodes = facet.nodes.iter();
                nodes.all(|&node| self.held.is_held_along(node, k))
            };
            side.facets.iter().filter(is_held).count() as f64 / count
        })
    }
}
