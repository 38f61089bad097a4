//! Totals of a load step, kept for the report.

use contact_dd_partition::id::BlockId;
use contact_dd_partition::magnitude::short;
use contact_dd_partition::problem::Catalog;

use crate::certificate::energy::EnergyBalance;
use crate::certificate::scales::Scales;
use crate::fem::resultants::Resultants;
use crate::fem::strain::{LARGE, LargestStrain};
use crate::recover::solution::Solution;
use crate::report::totals::StepTotals;
use crate::rigid::body_analysis::RigidBodyAnalysis;
use crate::sweep::{SweepOutcome, SweepStatus};

/// Fraction of the bodies' measure with large strains above which a warning is given: at edges and crack tips strains
/// grow without bound as cells become smaller.
const WARNED_SHARE: f64 = 1e-3;

impl StepTotals {
    /// The totals of a load step with this `solution` and `outcome` of the sweeps, after this number of
    /// `linear_solves`.
    pub fn new(
        (outcome, linear_solves): (SweepOutcome, usize),
        solution: &Solution,
        (resultants, energy): (Resultants, EnergyBalance),
        analysis: &RigidBodyAnalysis,
        catalog: &Catalog,
    ) -> Self {
        let error = solution.estimate.map(|estimate| estimate.relative());
        let converged = outcome.status == SweepStatus::Converged;
        let slides = solution.friction_limit.iter().filter(|_| converged);
        let slides: Vec<String> = slides.map(|what| at_limit(what)).collect();
        let strain = (solution.largest_strain).and_then(|s| large_strain(s, catalog));
        let warnings = [
            &analysis.motions.warnings[..],
            &solution.minimum_norm.warnings,
            &slides,
            &outcome.notes,
            &resultants.warnings(),
            &resultants.warnings_of_mesh(catalog, error),
            &Vec::from_iter(strain),
            &Vec::from_iter(energy.warning()),
        ];
        Self {
            active: resultants.closed_points(catalog),
            certificate: solution.certificate,
            condition: solution.condition,
            resultants,
            energy,
            estimate: solution.estimate,
            at_limit: !slides.is_empty(),
            scales: match converged {
                true => solution.certificate.scales,
                false => Scales::default(),
            },
            warnings: warnings.concat(),
            linear_solves,
            outcome,
        }
    }
}

/// A warning of the largest strain of any block, if it isn't small.
fn large_strain((block, largest): (BlockId, LargestStrain), catalog: &Catalog) -> Option<String> {
    if largest.large <= WARNED_SHARE * largest.whole {
        return None;
    }
    let body = &catalog.bodies[catalog.body_of(block)].name;
    let at = largest.at.map(short);
    Some(format!(
        "body '{body}': strains of up to {} at ({}) {}, beyond small strains, above {} in {} % of the bodies; are the units \
         of loads, displacements and stiffness consistent?",
        short(largest.size),
        at[..catalog.dim].join(", "),
        catalog.units.length(),
        short(LARGE),
        short(100.0 * largest.large / largest.whole)
    ))
}

/// The warning of a motion at the friction limit.
fn at_limit(motion: &str) -> String {
    format!(
        "limit of friction: friction alone restrains {motion}, and is at its bound at every distance of sliding; position \
         not unique"
    )
}
