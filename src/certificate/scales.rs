//! The scales of load steps: what is left of forces and displacements once the load is gone is round-off of those before.

use serde::{Deserialize, Serialize};

use super::most::Most;
use crate::vector::NOTHING;
use crate::vector::larger;

/// Part of the largest displacement that counts as much as the whole force of friction: displacements are known better.
const SLIP_LIKE_FORCE: f64 = 0.1;

/// The largest scales of some load steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Scales {
    /// The terms of a residual (N/m).
    pub terms: f64,
    /// Load, contact force or support reaction at a node (N/m).
    external: f64,
    /// Contact force (N/m).
    contact_force: f64,
    /// Displacement (m).
    displacement: f64,
}

impl Scales {
    /// The scales of a load step in which this was largest.
    pub(super) fn of(most: &Most) -> Self {
        Self {
            terms: most.scale,
            external: most.external,
            contact_force: most.contact_force,
            displacement: most.displacement,
        }
    }

    /// The larger ones of two.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            terms: larger(self.terms, other.terms),
            external: larger(self.external, other.external),
            contact_force: larger(self.contact_force, other.contact_force),
            displacement: larger(self.displacement, other.displacement),
        }
    }

    /// Puts these in the place of scales of a later load step that are nothing beside them.
    pub(super) fn replace_nothing(self, most: &mut Most) {
        if most.displacement < NOTHING * self.displacement {
            most.displacement = self.displacement;
            // So far it was driven then.
            most.driven = larger(most.driven, self.displacement);
        }
        if most.scale < NOTHING * self.terms {
            // Nothing acts at all; contacts may have carried nothing before, either.
            most.contact_force = larger(most.contact_force, self.terms);
        }
        for (own, earlier) in [
            (&mut most.scale, self.terms),
            (&mut most.external, self.external),
            (&mut most.contact_force, self.contact_force),
        ] {
            if *own < NOTHING * earlier {
                *own = earlier;
            }
        }
    }
}

/// The scales by which slips and the forces that oppose them are measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SlipScales {
    /// Forces of friction (N/m).
    pub force: f64,
    /// Displacement (m).
    pub displacement: f64,
}

impl SlipScales {
    /// The lesser of a slip (m) and of what a force lacks (N/m).
    pub(super) fn lesser(self, slip: f64, lacks: f64) -> f64 {
        if lacks <= 0.0 {
            // Without any contact force there is no scale of it either.
            return 0.0;
        }
        let slip = slip / (SLIP_LIKE_FORCE * self.displacement);
        slip.min(lacks / self.force)
    }
}
