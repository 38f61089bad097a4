//! Ties: points whose jump is 0, discretized like those of a contact.

use super::super::Contact;
use super::super::surface::{Surface, SurfaceFacet};
use super::Contacts;
use crate::contact_point::{ContactPoint, Law};
use crate::error::InputError;
use crate::magnitude::short;
use crate::scene::condition::Names;
use crate::scene::contact::{self, TieReach};

/// Distance up to which sides are tied, relative to the size of their facets: the position tolerance of Abaqus.
const NEAR: f64 = 0.05;

/// Remaining gap, relative to the size of facets, above which a warning is given: the tie doesn't preserve moments
/// across it.
const WARNED_GAP: f64 = 1e-3;

/// The points of a tie with the size of its facets.
pub(in crate::model) struct Tied {
    /// The points, with the gaps of the mesh.
    pub points: Vec<ContactPoint<u32>>,
    /// Size of the facets (m).
    pub size: f64,
    /// Warnings.
    pub warnings: Vec<String>,
}

impl Contacts<'_> {
    /// Builds tie `number` of the scene, along side a.
    pub(super) fn tie(
        &self,
        number: u32,
        keys: &contact::Contact,
        (names, reach): (&Names, TieReach),
        warnings: &mut Vec<String>,
    ) -> Result<Contact, InputError> {
        let what = format!("tie '{}'", keys.name);
        let tied = self.tied(keys, (names, reach), &what)?;
        warnings.extend(tied.warnings);
        let widest = tied.points.iter().fold(0.0, |m: f64, p| m.max(p.gap.abs()));
        if !reach.adjust && widest > WARNED_GAP * tied.size {
            warnings.push(format!(
                "{what}: gaps of up to {} {} are kept: across them forces act without a moment; expected sides that touch, or \
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
            prescribed: Vec::new(),
        })
    }

    /// The points of a tie between side a of `keys` and the side of these `names`, within its reach.
    ///
    /// # Errors
    /// Sides that don't face each other, or are apart.
    pub(in crate::model) fn tied(
        &self,
        keys: &contact::Contact,
        (names, reach): (&Names, TieReach),
        what: &str,
    ) -> Result<Tied, InputError> {
        let (side_a, side_b) = (self.side(&keys.side_a, what)?, self.side(names, what)?);
        let mut warnings = Vec::new();
        let points = self.points_of_tie(keys, (names, [&side_a, &side_b]), &mut warnings, what)?;
        let size = side_a.1.facet_size().max(side_b.1.facet_size());
        let tolerance = reach.tolerance.unwrap_or(NEAR * size);
        let least = points.iter().fold(f64::INFINITY, |m, p| m.min(p.gap.abs()));
        let count = points.len();
        let unit = self.units.length();
        let (near, far): (Vec<_>, Vec<_>) =
            (points.into_iter()).partition(|point| point.gap.abs() <= tolerance);
        if near.is_empty() {
            return Err(InputError::new(format!(
                "{what}: its sides are {} {unit} apart at least, and only what is within {} {unit} of each other is tied; \
                 expected sides that touch, or a larger 'tolerance'",
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

    /// The points of a tie, whatever their gaps. The nodes of side a carry the multipliers unless supports hold its
    /// facets and not those of side b, as the nodes with multipliers have to be free.
    fn points_of_tie(
        &self,
        keys: &contact::Contact,
        (names, [a, b]): (&Names, [&(Vec<u32>, Surface); 2]),
        warnings: &mut Vec<String>,
        what: &str,
    ) -> Result<Vec<ContactPoint<u32>>, InputError> {
        let [held_a, held_b] = [a, b].map(|(_, side)| self.held_shares(side));
        let is_more = |a: [f64; 3], b: [f64; 3]| (0..3).any(|k| a[k] > b[k]);
        let mut face_the_same_way = false;
        let mut of_sides = |(facets, side): &(Vec<u32>, Surface), other: &Names| {
            let facets = facets.iter().copied().collect();
            let sides = |side: &Surface| self.sides(0, (&facets, side), other, keys.pairing, what);
            sides(side).or_else(|apart| {
                // Tied sides may face the same way, as a tie doesn't push.
                let paired = sides(&side.turned()).map_err(|_| apart)?;
                face_the_same_way = true;
                Ok(paired)
            })
        };
        let points = match (is_more(held_a, held_b), is_more(held_b, held_a)) {
            (true, false) => {
                let of_a = a.1.nodes();
                let at = |node: u32| self.mesh.points[node as usize];
                let points = of_sides(b, &keys.side_a)?.points.into_iter();
                let turned = points.map(|p| p.turned(|node| of_a.contains_key(&node), at));
                turned.collect()
            }
            (are_both, _) => {
                warnings.extend(are_both.then(|| format!(
                    "{what}: supports hold facets of both sides along other directions; nodes of side a that they hold \
                     aren't tied; expected supports of one side"
                )));
                of_sides(a, names)?.points
            }
        };
        warnings.extend(face_the_same_way.then(|| format!(
            "{what}: the sides face the same way, so that bodies overlap there, and are tied all the same; is that meant?"
        )));
        Ok(points)
    }

    /// The fraction of a side's facets that supports hold at all nodes, for each axis.
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
