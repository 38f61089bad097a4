//! The certificate: the full discrete problem (1), checked without any Schur complement.
//!
//! > K u − f + Bᵀ λ = 0,   B u ≤ g,   λ ≥ 0,   λᵀ (g − B u) = 0

pub mod check;
pub mod energy;
pub mod most;
pub mod scales;
pub mod shared;

use contact_dd_partition::model::PlaneState;
use serde::{Deserialize, Serialize};

use self::check::{BlockCheck, External};
use self::most::Most;
use self::scales::{Scales, SlipScales};
use crate::vector::{larger, largest};

/// Resultant of forces, relative to the sum of their magnitudes, below which there is no load.
const NO_LOAD: f64 = 1e-12;

/// Moments, relative to the forces times the size of the scene, below which they count as zero.
const SMALL_MOMENT: f64 = 1e-3;

/// Friction bounds, relative to contact forces and to the terms of nodal forces, below which the friction check is less
/// accurate than the other checks.
const SMALL_BOUND: f64 = 1e-3;
const BOUND_OF_TERMS: f64 = 1e-6;

/// Checks of the full discrete problem, each relative to its own scale.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Certificate {
    /// ‖K u − f + Bᵀλ‖∞ / ‖|K||u| + |f| + |Bᵀλ|‖∞.
    pub equilibrium: f64,
    /// ‖K u − f + Bᵀλ‖∞ over the largest load, contact force or reaction at a node: round-off amplified by the
    /// condition number of the scene.
    pub equilibrium_of_load: f64,
    /// The largest load at a node over that scale: near 0 if forces are round-off of a scene without load, or
    /// displacements drive it.
    #[serde(skip)]
    pub load_share: f64,
    /// Largest displacement over the largest cause of motion in a scene without load: prescribed displacements, gaps,
    /// closing motions, earlier slips. If it is large, the scene has a load, though forces are round-off of
    /// displacements.
    #[serde(skip)]
    pub farther: f64,
    /// Largest penetration over the largest displacement.
    pub penetration: f64,
    /// Largest tension in a contact over the load scale.
    pub tension: f64,
    /// Largest product of contact force and gap over the product of their scales.
    pub complementarity: f64,
    /// The largest of four violations of the law of friction: tangential force beyond the friction cone, over the
    /// largest bound of friction, or a thousandth of the largest contact force; slip of sticking points, over the
    /// largest displacement; the lesser of slip, over a tenth of the largest displacement, and the shortfall of the
    /// opposing force from its bound; slip times the force across it, over the product of both scales.
    pub friction: f64,
    /// Slip of sticking points over the largest displacement, the second of these four.
    #[serde(skip)]
    pub drift: f64,
    /// The scales of slips and of forces of friction.
    #[serde(skip)]
    pub of_slips: SlipScales,
    /// Sum of loads and reactions over the load scale.
    pub force_balance: f64,
    /// Sum of their moments over the load scale times the size of the scene.
    pub moment_balance: f64,
    /// Largest jump of the displacement across Γ over the largest displacement.
    pub interface_jump: f64,
    /// True if loads work along motions that no contact force resists.
    #[serde(skip)]
    pub is_driven: bool,
    /// The scales of the checks.
    #[serde(skip)]
    pub scales: Scales,
}

impl Certificate {
    /// True if no check is NaN.
    pub fn is_a_number(&self) -> bool {
        let checks = [
            self.equilibrium,
            self.equilibrium_of_load,
            self.penetration,
            self.tension,
            self.complementarity,
            self.friction,
            self.force_balance,
            self.moment_balance,
            self.interface_jump,
        ];
        !checks.into_iter().any(f64::is_nan)
    }

    /// The worse of two values for every check.
    #[must_use]
    pub fn worse(self, other: Self) -> Self {
        // NaN is worse than any number.
        let worse = |a: f64, b: f64| if a.is_nan() || a > b { a } else { b };
        Self {
            equilibrium: worse(self.equilibrium, other.equilibrium),
            equilibrium_of_load: worse(self.equilibrium_of_load, other.equilibrium_of_load),
            load_share: worse(self.load_share, other.load_share),
            farther: worse(self.farther, other.farther),
            penetration: worse(self.penetration, other.penetration),
            tension: worse(self.tension, other.tension),
            complementarity: worse(self.complementarity, other.complementarity),
            friction: worse(self.friction, other.friction),
            drift: worse(self.drift, other.drift),
            of_slips: other.of_slips,
            force_balance: worse(self.force_balance, other.force_balance),
            moment_balance: worse(self.moment_balance, other.moment_balance),
            interface_jump: worse(self.interface_jump, other.interface_jump),
            is_driven: self.is_driven || other.is_driven,
            scales: self.scales.and(other.scales),
        }
    }
}

/// The certificate of the whole solution from the checks of blocks, in their order, and the largest values `elsewhere`:
/// at contact points and at shared nodes; in a plane state or in space. Quantities that vanish against the scales of
/// the load steps `before` are measured by these scales.
pub fn certificate(
    checks: &[BlockCheck],
    elsewhere: Most,
    before: Scales,
    plane: Option<PlaneState>,
) -> Certificate {
    let mut most = elsewhere;
    checks.iter().for_each(|check| most.include(check.most));
    let external = external(checks, plane);
    let scales = Scales::of(&most);
    before.replace_nothing(&mut most);
    if most.scale < NO_LOAD * most.rest && most.load < f64::EPSILON * most.rest {
        // Bodies moved without load: residuals and forces are round-off of their displacement.
        most.scale = most.rest;
    }
    let force_scale = larger(most.scale, most.contact_force);
    let [force_balance, moment_balance] = balances(&external, most.scale);
    let of_friction = (most.bound.max(SMALL_BOUND * most.contact_force))
        .max(BOUND_OF_TERMS * most.scale)
        .min(most.contact_force);
    let drift = ratio(most.astray, most.displacement);
    let friction = [
        ratio(most.beyond_bound, of_friction),
        drift,
        ratio(most.aside, of_friction * most.displacement),
    ];
    Certificate {
        equilibrium: ratio(most.residual, most.scale),
        equilibrium_of_load: ratio(most.residual, most.external),
        load_share: ratio(most.load, most.external),
        farther: ratio(most.displacement, most.driven),
        penetration: ratio(most.penetration, most.displacement),
        tension: ratio(most.tension, force_scale),
        complementarity: ratio(most.complementarity, most.contact_force * most.displacement),
        friction: friction.into_iter().fold(0.0, larger),
        drift,
        of_slips: SlipScales {
            force: of_friction,
            displacement: most.displacement,
        },
        force_balance,
        moment_balance,
        interface_jump: ratio(most.jump, most.displacement),
        is_driven: false,
        scales,
    }
}

/// The resultant of external forces on blocks; around an axis only the component along it, as all others cancel.
fn external(checks: &[BlockCheck], plane: Option<PlaneState>) -> External {
    let mut external = External::default();
    checks
        .iter()
        .for_each(|check| external.include(check.external));
    if plane == Some(PlaneState::Axisymmetric) {
        external.force = [0.0, external.force[1], 0.0];
        external.moment = [0.0; 3];
    }
    external
}

/// Resultants of external forces and of moments over their scales, where nodal forces have this `scale` (N/m).
fn balances(external: &External, scale: f64) -> [f64; 2] {
    // Without load, forces are round-off of the terms that they are sums of.
    let to_load = match external.force_scale >= NO_LOAD * scale {
        true => 1.0,
        false => external.force_scale / scale,
    };
    // Where each node's load is carried by a support at the same node, moments are round-off only.
    let moment_scale = larger(
        external.moment_scale,
        SMALL_MOMENT * external.force_scale * external.reach,
    );
    [
        to_load * ratio(largest(&external.force), external.force_scale),
        to_load * ratio(largest(&external.moment), moment_scale),
    ]
}

fn ratio(a: f64, b: f64) -> f64 {
    if a == 0.0 { 0.0 } else { a / b }
}
