//! The scales of load steps: forces and displacements left after unloading are round-off of the earlier ones.

use serde::{Deserialize, Serialize};

use super::most::Most;
use crate::vector::NOTHING;
use crate::vector::larger;

/// Part of the largest displacement that counts like the whole friction force, as displacements are more accurate.
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
    /// The scales of a load step with these largest values.
    pub(super) fn of(most: &Most) -> Self {
        Self {
            terms: most.scale,
            external: most.external,
            contact_force: most.contact_force,
            displacement: most.displacement,
        }
    }

    /// The larger scales of two.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            terms: larger(self.terms, other.terms),
            external: larger(self.external, other.external),
            contact_force: larger(self.contact_force, other.contact_force),
            displacement: larger(self.displacement, other.displacement),
        }
    }

    /// Replaces scales of a later load step that vanish against these.
    pub(super) fn replace_nothing(self, most: &mut Most) {
        if most.displacement < NOTHING * self.displacement {
            most.displacement = self.displacement;
            // The earlier load step was driven that far.
            most.driven = larger(most.driven, self.displacement);
        }
        if most.scale < NOTHING * self.terms {
            // Without any load, contacts may have carried no force in the earlier load step either.
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
    /// The lesser of a slip (m) and of the shortfall of a force (N/m), each over its scale.
    pub(super) fn lesser(self, slip: f64, shortfall: f64) -> f64 {
        if shortfall <= 0.0 {
            // Without contact forces their scale is zero.
            return 0.0;
        }
        let slip = slip / (SLIP_LIKE_FORCE * self.displacement);
        slip.min(shortfall / self.force)
    }
}
