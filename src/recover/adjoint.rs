//! Quantities of the solution, and their derivatives by the transposed problem of the accepted active set.
//!
//! With closed conditions c and slipping tangents s, with forces λ_s = M λ_c + Q s + φ, a change of the solution obeys
//!
//! ```text
//! K du + B_cᵀ dλ_c + B_sᵀ dλ_s = df − dK u,    B_c du = dg,    D du = dv
//! ```
//!
//! with the rows D of supports and their forces ρ. A quantity's derivatives a, b, r in u, λ, ρ load the transposed
//! problem
//!
//! ```text
//! K w + B_cᵀ ν + B_sᵀ Q τ' + Dᵀ η = a,    B_c w = b_c − Mᵀ τ',    D w = −r,    τ' = B_s w − b_s
//! ```
//!
//! whose solution gives the derivative w·(df − dK u) + ν·dg + η·dv − τ'·dφ for all parameters at once. M = μ e and, in
//! space, Q = κ (I − e eᵀ). Slipping points are not symmetric: M is in the conditions here, in the forces there.

mod contact_edges;
mod crack_tip;
mod derivatives;
mod functional;
mod held_ends;
mod mesh_error;
mod near_change;
mod reaction;
mod slip_conditions;
mod slipping;
mod smoothing;
mod solved;
mod transposed;

use std::cell::RefCell;
use std::collections::BTreeMap;

use contact_dd_partition::id::OnGroups;
use contact_dd_partition::quantity::{Parameter, Quantity, QuantityKind};

use self::derivatives::{Sensitivity, derivatives};
use self::functional::{Functional, MaterialForces};
use self::held_ends::HeldEnds;
use self::mesh_error::MeshError;
use self::near_change::about_to_change;
use self::slipping::SlippingPoints;
use self::solved::Solved;
use self::transposed::{Transposed, TransposedProblem};
use crate::context::LoadPoint;
use crate::fem::quantity::{Derivative, Quantities, QuantityValue};
use crate::recover::fixed_active_set::FixedActiveSet;
use crate::recover::solution::Solution;

/// Reciprocity error, relative to the sum of its terms, from which on derivatives are rejected.
const RECIPROCITY: f64 = 1e-7;
/// Reciprocity error that is good enough, and the most refinements of a transposed problem above it.
const GOOD: f64 = 1e-10;
const REFINEMENTS: usize = 3;

/// The quantities that the scene requests, if this load point is the end of a load step; with derivatives if the slips
/// with which it began are known. Collective.
pub fn quantities_at(
    load_point: LoadPoint,
    fixed: &FixedActiveSet<'_>,
    solution: &Solution,
    before: Option<&OnGroups<Vec<f64>>>,
) -> Quantities {
    let catalog = fixed.context.catalog;
    if load_point.part < 1.0 || catalog.quantities.is_empty() {
        return Quantities::default();
    }
    let slips = before.into_iter().flat_map(BTreeMap::values).flatten();
    let has_slipped = fixed.context.comm.largest(slips) > 0.0;
    let has_come = catalog.points.iter().any(|point| point.since != [0.0; 3]);
    let without = if before.is_none() {
        Some("they aren't asked for")
    } else if has_slipped {
        Some("friction depends on the load steps and increments before the last one")
    } else if has_come {
        Some("a contact added in a later step depends on the position of its bodies then")
    } else {
        None
    };
    let solved = Solved {
        fixed,
        solution,
        step: load_point.step,
    };
    quantities(solved, without.map(Into::into))
}

/// The quantities of a solution, with derivatives unless the root knows a reason `without` them. Collective.
fn quantities(solved: Solved<'_>, without: Option<String>) -> Quantities {
    let context = &solved.fixed.context;
    let catalog = context.catalog;
    let mut all = Quantities {
        without_derivatives: without.or_else(|| solved.without_derivatives()),
        ..Quantities::default()
    };
    context.comm.broadcast(&mut all.without_derivatives);
    let has_derivatives = all.without_derivatives.is_none();
    let of_energy = |of: &Quantity| of.kind == QuantityKind::Energy;
    let forces = match has_derivatives || catalog.quantities.iter().any(of_energy) {
        true => MaterialForces::new(context, &solved.solution.discrete),
        false => MaterialForces::default(),
    };
    let slipping: OnGroups<SlippingPoints> = (solved.solution.discrete.groups.iter())
        .map(|(&g, of_group)| {
            let in_matrix = solved.fixed.fronts.is_none();
            (
                g,
                SlippingPoints::new(&context.groups[&g], of_group, in_matrix),
            )
        })
        .collect();
    if has_derivatives {
        all.about_to_change = about_to_change(solved);
    }
    let sums_forces = |of: &Quantity| of.kind.adds_forces() || of.kind == QuantityKind::Reaction;
    let held_ends = match has_derivatives && catalog.quantities.iter().any(sums_forces) {
        true => HeldEnds::new(solved),
        false => HeldEnds::default(),
    };
    let directions = RefCell::default();
    for number in 0..catalog.quantities.len() {
        let functional = Functional::new(solved, number, &forces);
        let quantity = &catalog.quantities[number];
        let (mut found, mut error, mut error_bar) = (Vec::new(), None, None);
        if has_derivatives {
            let problem = TransposedProblem::new(solved, &functional, (&slipping, &directions));
            let parts = (solved, &functional, &forces);
            let (state, off) = solve(parts, &problem);
            if context.comm.decide(off > RECIPROCITY || off.is_nan()) {
                let name = &quantity.name;
                all.without_derivatives = Some(format!(
                    "the transposed problem of '{name}' can't be solved well enough with the contacts as they are"
                ));
            } else {
                found = derivatives(&sensitivity(parts, &problem, &state));
                if let Some(of_mesh) = MeshError::new(solved, (&functional, &held_ends), &state) {
                    error = Some(of_mesh.error);
                    error_bar = Some(of_mesh.bar);
                    if number == 0 {
                        all.errors_of_cells = of_mesh.of_cells;
                    }
                }
            }
        }
        let value = value(quantity, &functional, &catalog.parameters, &found);
        all.values.push(QuantityValue {
            error,
            error_bar,
            ..value
        });
    }
    all
}

/// A solved load step, a functional of it, and K u of its materials.
type Parts<'a> = (Solved<'a>, &'a Functional, &'a MaterialForces);

/// The solution of the transposed problem of a functional, and its reciprocity error, which the root knows. Collective.
fn solve(parts: Parts<'_>, problem: &TransposedProblem<'_>) -> (Transposed, f64) {
    let mut state = problem.solve();
    let mut off = f64::INFINITY;
    for round in 0.. {
        let before = off;
        off = sensitivity(parts, problem, &state).reciprocity();
        let goes_on = off > GOOD && off < 0.5 * before && round < REFINEMENTS;
        if !parts.0.fixed.context.comm.decide(goes_on) {
            break;
        }
        state = problem.refine(state);
    }
    (state, off)
}

fn sensitivity<'a>(
    (solved, functional, forces): Parts<'a>,
    problem: &'a TransposedProblem<'a>,
    state: &'a Transposed,
) -> Sensitivity<'a> {
    Sensitivity {
        solved,
        functional,
        problem,
        state,
        forces,
    }
}

/// Value and derivatives of a quantity for the report.
fn value(
    quantity: &Quantity,
    functional: &Functional,
    parameters: &[Parameter],
    found: &[f64],
) -> QuantityValue {
    let derivative = |(parameter, &derivative): (&Parameter, &f64)| Derivative {
        parameter: parameter.name.clone(),
        kind: parameter.kind.word().into(),
        at: Some(parameter.value).filter(|value| value.is_finite()),
        derivative,
    };
    QuantityValue {
        name: quantity.name.clone(),
        kind: quantity.kind.word().into(),
        value: functional.value,
        node: Some(functional.node).filter(|&node| node != -1),
        derivatives: parameters.iter().zip(found).map(derivative).collect(),
        error: None,
        error_bar: None,
    }
}
