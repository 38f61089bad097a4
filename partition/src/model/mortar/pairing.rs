//! Choice of the side that carries the multipliers.

use super::super::sides::Sides;
use super::carried::{Carried, carried};
use super::probes::probes;
use crate::contact_point::{ContactPoint, Probe};
use crate::magnitude::short;

/// Sagitta of the facets of curves, of both sides, in multiples of the larger one: gaps that are no larger are those of
/// sides that fit each other.
const FITTING: f64 = 2.0;

/// Gap relative to the smaller facets that is round-off.
const ROUND_OFF: f64 = 1e-6;

/// Part of what side a doesn't see that side b may not see for it to carry the multipliers in its place: facets of √½ of
/// the size on a curve. What is larger turns more contacts over and brings their orders nearer: of 26 punches on blocks these
/// are 0.36 of the estimated error apart on average with 0.1, 0.29 with 0.5, 0.27 with 1.
const BETTER: f64 = 0.5;

/// Facets of side a that are shorter than this fraction of those of side b are finer.
const FINER: f64 = 0.6;

/// A contact of sides whose nodes don't match.
pub(in crate::model) struct Mortar {
    /// A point for every node that carries a multiplier.
    pub points: Vec<ContactPoint<u32>>,
    /// Places at which the other side is checked for penetration.
    pub probes: Vec<Probe<u32>>,
    /// A warning.
    pub warning: Option<String>,
}

/// The contact of two sides. `what` names it.
///
/// Side a carries the multipliers, unless it can't see where the sides touch: a condition is about a mean of the gap over
/// the facets around its node, and where the other side is curved within such a facet, or ends in an edge, the mean is
/// larger than the gap. Until the first one closes the sides go through each other by that much. Then side b carries
/// them, if it sees them sooner, and the sides pass the same forces in either order. Where it is only straight facets of
/// the same curve that stand off each other, side a carries them in any case.
///
/// # Errors
/// Sides that don't face each other.
pub(in crate::model) fn pair(sides: &Sides, what: &str) -> Result<Mortar, String> {
    let first = carried(sides)?;
    let of = |first: Carried, warning| Mortar {
        points: first.points,
        probes: probes(sides),
        warning,
    };
    let (a, b) = (sides.a, sides.b);
    let off = FITTING * a.kinks().max(b.kinks());
    let round_off = ROUND_OFF * a.facet_size().min(b.facet_size());
    let fits = |unseen: f64| unseen <= off.max(round_off);
    let ratio = a.facet_size() / b.facet_size();
    let stands_off = a.stands_off().max(b.stands_off()) > round_off;
    let is_finer = stands_off && ratio < FINER;
    if fits(first.unseen) && !is_finer {
        return Ok(of(first, None));
    }
    let turned = Sides::new(sides.mesh, b, a, what).map_err(|error| error.to_string());
    let Ok((turned, second)) = turned.and_then(|turned| {
        let second = carried(&turned)?;
        Ok((turned, second))
    }) else {
        return Ok(of(first, None));
    };
    if !fits(first.unseen) && second.unseen < BETTER * first.unseen {
        let at = |node: u32| sides.mesh.points[node as usize];
        let on_a = |node: u32| sides.around_a.contains_key(&node);
        let points = second.points.into_iter();
        return Ok(Mortar {
            points: points.map(|point| point.turned(on_a, at)).collect(),
            probes: probes(&turned),
            warning: None,
        });
    }
    let warning = (is_finer && fits(second.unseen)).then(|| {
        format!(
            "{what}: the facets of side a (the slave) are {} times as large as those of side b, at whose corners pressures \
             oscillate; expected the coarser one first, as the curved sides fit each other",
            short(ratio)
        )
    });
    Ok(of(first, warning))
}
