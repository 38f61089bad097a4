//! The contact problem of all pairs, coupled through the interface.
//!
//! With A = S_0 + S_CON' of the bilateral problem, C = Σ R_pᵀ S_Γt and the pairs' laws,
//!
//! ```text
//! A δ + C τ = r,    λ = d − Cᵀ δ − H τ ≥ 0,    τ ≤ s,    λ (s − τ) = 0
//! ```
//!
//! determines the changes δ of U and τ of the normal jumps that solve the interface problem (14), where r is its
//! residual and d and s are the forces and gaps at U. Elimination of δ leaves a contact problem in the normal jumps of
//! all pairs, with the matrix H − Cᵀ A⁻¹ C. Linearly dependent constraints of a pair, D τ ≤ d − D t, remain unchanged.

use faer::MatRef;
use serde::{Deserialize, Serialize};

use super::operator::{Interface, diagonal_of};
use super::problem::InterfaceProblem;
use super::rigid_modes::RigidBasis;
use crate::contact::active_set::{ContactProblem, ContactSolution};
use crate::contact::condensed_contact::CondensedContact;
use crate::contact::dependent::DependentConstraints;
use crate::contact::friction::FrictionProblem;
use crate::contact::limits::{OtherTangent, TangentialLimit};
use crate::contact::pair::PairResponse;
use crate::contact::status::{FixedStatus, LimitState};
use crate::interface::s_con::{ConState, Expected};
use crate::schur::local::multiply_add;

/// Most normal jumps of all pairs for which the coupled problem is solved; its matrix is dense.
pub const MAX_JUMPS: usize = 6_000;

/// The coupled contact problem.
#[derive(Clone, Debug)]
pub struct CoupledContact<'a> {
    interface: &'a Interface,
    motions: &'a RigidBasis,
    /// H − Cᵀ A⁻¹ C.
    h: MatRef<'a, f64>,
    diagonal: Vec<f64>,
    /// D of all pairs.
    rows: DependentConstraints,
    /// The limits of tangential jumps of all pairs.
    tangents: Vec<TangentialLimit>,
    scale: f64,
}

/// A change of U and of the normal jumps.
#[derive(Clone, Debug, PartialEq)]
pub struct CoupledStep {
    /// δ.
    pub u: Vec<f64>,
    /// The statuses of every pair after the step, and τ.
    pub expected: Vec<Expected>,
    /// The solution of the contact problem of all pairs.
    pub contact: ContactSolution,
    /// The constraints of every pair with wrong status, if friction kept the iteration from converging.
    pub violated_limits: Vec<Vec<usize>>,
}

/// A change of U and of all pairs.
#[derive(Clone, Debug)]
pub struct CoupledChange<L> {
    /// The change of U.
    pub u: Vec<f64>,
    /// The changes of the pairs.
    pub pairs: Vec<PairChange<L>>,
}

/// The change of the jumps of a pair, and a value for each limit: the change of its force, or its new state.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct PairChange<L> {
    /// Changes of jumps (m).
    pub jumps: Vec<f64>,
    /// The value of every limit.
    pub limits: Vec<L>,
}

/// The right-hand side after δ is eliminated.
struct Condensed {
    /// A⁻¹ r.
    z: Vec<f64>,
    /// d − Cᵀ A⁻¹ r.
    c: Vec<f64>,
    /// Scale of its terms.
    c_scale: Vec<f64>,
    /// The zero change of jumps.
    rest: Vec<f64>,
}

impl<'a> CoupledContact<'a> {
    /// The contact problem of all pairs; `None` if they have too many normal jumps.
    pub fn new(problem: &'a InterfaceProblem<'_>) -> Option<Self> {
        let (interface, motions) = (problem.interface, &problem.motions);
        let laws = &interface.laws;
        (laws.len() == interface.pair_interface_dofs.len()).then(|| Self {
            interface,
            motions,
            h: interface.condensed_laws(motions),
            diagonal: diagonal_of(laws),
            rows: all_rows(laws),
            tangents: all_tangents(laws),
            scale: problem.scale,
        })
    }

    /// The step from U to the solution, where `state` are the responses of the pairs at U and `r` is the residual.
    pub fn solve(&self, u: &[f64], r: &[f64], state: &ConState) -> CoupledStep {
        let all = |of: fn(&PairResponse) -> &Vec<f64>| -> Vec<f64> {
            state.responses.iter().flat_map(of).copied().collect()
        };
        let mut condensed = self.condense(
            r,
            all(|p| &p.contact_residual),
            all(|p| &p.contact_residual_scale),
        );
        self.motions.set_load(&mut condensed.c);
        let mut status = self.side_by_side(state.responses.iter().map(|p| &p.status[..]));
        let gaps = self.side_by_side(state.responses.iter().map(|p| &p.gaps[..]));
        // Slips go on in the direction that they had.
        let mut center = all(|p| &p.change_before);
        center.resize(self.h.nrows(), 0.0);
        let problem = FrictionProblem {
            contact: ContactProblem {
                center: &center,
                ..self.problem(&condensed, &gaps, u)
            },
            tangents: &self.tangents,
            last_patch: &self.interface.last_patch,
        };
        let contact = problem.solve(&mut status);
        let mut violated_limits = Vec::new();
        if !contact.converged && self.has_friction() {
            let mut wrong = vec![false; status.len()];
            problem
                .violated_limits(&status)
                .into_iter()
                .for_each(|i| wrong[i] = true);
            let of_pair = |(law, wrong): (&CondensedContact, Vec<bool>)| {
                let conditions = law.conditions.iter().zip(wrong);
                conditions
                    .filter(|(_, wrong)| *wrong)
                    .map(|(&j, _)| j)
                    .collect()
            };
            let by_pair = self.by_pair(&wrong);
            violated_limits = self
                .interface
                .laws
                .iter()
                .zip(by_pair)
                .map(of_pair)
                .collect();
        }
        let statuses = self.by_pair(&status).into_iter();
        CoupledStep {
            u: self.change_of_u(r, &condensed, &contact.jumps),
            expected: statuses.zip(self.by_pair(&contact.jumps)).collect(),
            contact,
            violated_limits,
        }
    }

    /// Distance of another solution with friction from the solution U, as the largest difference of a jump (m); `state`
    /// are the responses of the pairs at U and `r` is the residual.
    pub fn other_solution(&self, u: &[f64], r: &[f64], state: &ConState) -> Option<f64> {
        let all = |of: fn(&PairResponse) -> &Vec<f64>| -> Vec<f64> {
            state.responses.iter().flat_map(of).copied().collect()
        };
        let condensed = self.condense(
            r,
            all(|p| &p.contact_residual),
            all(|p| &p.contact_residual_scale),
        );
        let gaps = self.side_by_side(state.responses.iter().map(|p| &p.gaps[..]));
        let problem = FrictionProblem {
            contact: self.problem(&condensed, &gaps, u),
            tangents: &self.tangents,
            last_patch: &self.interface.last_patch,
        };
        let jumps = all(|p| &p.jumps);
        let largest = |x: &[f64]| x.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        problem.other_solution(&vec![0.0; jumps.len()], largest(&jumps).max(largest(u)))
    }

    /// The change of U, and of jumps and forces of every pair, under loads `r` on Γ and `loads` on the normal jumps,
    /// where limits keep their statuses. Unrestrained motions are zero unless it `moves`.
    pub fn solve_fixed(
        &self,
        r: &[f64],
        loads: &[Vec<f64>],
        statuses: &[Vec<FixedStatus>],
        moves: bool,
    ) -> CoupledChange<f64> {
        let loads = loads.concat();
        let scale = loads.iter().map(|x| x.abs()).collect();
        let condensed = self.condense(r, loads, scale);
        let fixed = self.side_by_side(statuses.iter().map(Vec::as_slice));
        let bounds: Vec<f64> = fixed.iter().map(FixedStatus::distance_to_bound).collect();
        let problem = FrictionProblem {
            contact: ContactProblem {
                scale: match moves {
                    // A load, however small, counts: displacements are the unknowns here, not a scale of its round-off.
                    true => 0.0,
                    false => self.scale,
                },
                ..self.problem(&condensed, &bounds, &[])
            },
            tangents: &self.tangents,
            last_patch: &self.interface.last_patch,
        };
        let change = problem.change(&fixed);
        CoupledChange {
            u: self.change_of_u(r, &condensed, &change.jumps),
            pairs: self.pair_changes(&change.jumps, &change.forces),
        }
    }

    /// The change of U and of the jumps of every pair that satisfies the contact laws, from these `states` of all
    /// limits, under the unbalanced `r` on Γ and `loads` on the normal jumps; the new states; and whether the iteration
    /// converged. Round-off is measured by the change, not by the displacements so far.
    pub fn solve_laws(
        &self,
        r: &[f64],
        loads: &[Vec<f64>],
        states: &[Vec<LimitState>],
    ) -> (CoupledChange<LimitState>, bool) {
        let states = self.side_by_side(states.iter().map(Vec::as_slice));
        let forces: Vec<f64> = states.iter().map(|state| state.force).collect();
        let (of_jumps, of_rows) = forces.split_at(self.h.nrows());
        let mut acting: Vec<f64> = of_jumps.iter().map(|force| -force).collect();
        let by_rows = self.rows.subtract_transposed(of_rows, &mut acting);
        let mut scale: Vec<f64> = of_jumps.iter().map(|force| force.abs()).collect();
        for (i, by_rows) in by_rows {
            scale[i] += by_rows;
        }
        let mut c = loads.concat();
        for (c, (acting, scale)) in c.iter_mut().zip(acting.iter().zip(&mut scale)) {
            *scale += c.abs();
            *c -= acting;
        }
        let mut condensed = self.condense(r, c, scale);
        self.motions.set_load(&mut condensed.c);
        let gaps: Vec<f64> = states.iter().map(|state| state.gap).collect();
        let problem = FrictionProblem {
            contact: ContactProblem {
                scale: 0.0,
                ..self.problem(&condensed, &gaps, &[])
            },
            tangents: &self.tangents,
            last_patch: &self.interface.last_patch,
        };
        let mut status: Vec<_> = states.iter().map(|state| state.status).collect();
        let solution = problem.solve(&mut status);
        let of_rows = (0..self.rows.len()).map(|j| self.rows.value(j, &solution.jumps));
        let moved = solution.jumps.iter().copied().chain(of_rows);
        let then: Vec<LimitState> = (states.iter().zip(moved))
            .zip(solution.forces.iter().zip(status))
            .map(|((before, moved), (&force, status))| LimitState {
                force,
                gap: before.gap - moved,
                status,
            })
            .collect();
        let change = CoupledChange {
            u: self.change_of_u(r, &condensed, &solution.jumps),
            pairs: self.pair_changes(&solution.jumps, &then),
        };
        (change, solution.converged)
    }

    /// Splits a change of all jumps, with the values of all limits, by pair.
    fn pair_changes<L: Copy>(&self, jumps: &[f64], limits: &[L]) -> Vec<PairChange<L>> {
        let pairs = self.by_pair(jumps).into_iter().zip(self.by_pair(limits));
        let of_pair = |(jumps, limits)| PairChange { jumps, limits };
        pairs.map(of_pair).collect()
    }

    fn condense(&self, r: &[f64], mut c: Vec<f64>, mut c_scale: Vec<f64>) -> Condensed {
        let mut z = r.to_vec();
        self.interface.solver.solve(&mut z);
        let mut first = 0;
        for (p, law) in self.interface.laws.iter().enumerate() {
            let z_p = self.interface.restrict(p, &z);
            for (column, &z) in law.s_t_gamma.col_iter().zip(&z_p) {
                for (i, s) in column.iter().enumerate() {
                    c[first + i] -= s * z;
                    c_scale[first + i] += (s * z).abs();
                }
            }
            first += law.len();
        }
        let rest = vec![0.0; c.len()];
        Condensed {
            z,
            c,
            c_scale,
            rest,
        }
    }

    fn problem<'b>(
        &'b self,
        condensed: &'b Condensed,
        bounds: &'b [f64],
        u: &[f64],
    ) -> ContactProblem<'b> {
        ContactProblem {
            h: self.h,
            diagonal: &self.diagonal,
            c: &condensed.c,
            c_scale: &condensed.c_scale,
            rows: &self.rows,
            bounds,
            center: &condensed.rest,
            scale: u.iter().fold(self.scale, |m, u| m.max(u.abs())),
        }
    }

    /// δ = A⁻¹ (r − C τ).
    fn change_of_u(&self, r: &[f64], condensed: &Condensed, jumps: &[f64]) -> Vec<f64> {
        let mut u = condensed.z.clone();
        if jumps.iter().any(|&t| t != 0.0) {
            u.copy_from_slice(r);
            let mut first = 0;
            for (p, law) in self.interface.laws.iter().enumerate() {
                let of_pair: Vec<f64> = (jumps[first..first + law.len()].iter())
                    .map(|t| -t)
                    .collect();
                let mut held = vec![0.0; law.s_t_gamma.ncols()];
                multiply_add(law.s_t_gamma.transpose(), &of_pair, &mut held);
                self.interface.extend(p, &held, &mut u);
                first += law.len();
            }
            self.interface.solver.solve(&mut u);
        }
        u
    }

    /// True if any pair has friction.
    pub fn has_friction(&self) -> bool {
        !self.tangents.is_empty()
    }

    /// True if any point can slip in two directions.
    pub fn has_cones(&self) -> bool {
        let mut tangents = self.tangents.iter();
        tangents.any(|tangent| tangent.other != OtherTangent::Nothing)
    }

    /// Concatenation of the values of all pairs: those of normal jumps, then those of linearly dependent constraints.
    fn side_by_side<'b, T: Copy + 'b>(
        &self,
        of_pairs: impl Iterator<Item = &'b [T]> + Clone,
    ) -> Vec<T> {
        let laws = self.interface.laws.iter();
        let split = laws.zip(of_pairs).map(|(law, own)| own.split_at(law.len()));
        let jumps = split.clone().flat_map(|(jumps, _)| jumps);
        let dependent = split.flat_map(|(_, dependent)| dependent);
        jumps.chain(dependent).copied().collect()
    }

    /// Splits values of all normal jumps, and of linearly dependent constraints if included, by pair.
    fn by_pair<T: Copy>(&self, all: &[T]) -> Vec<Vec<T>> {
        let (mut jumps, mut dependent) = all.split_at(self.h.nrows());
        let mut take = |law: &CondensedContact| {
            let (own, others) = jumps.split_at(law.len());
            let (own_rows, other_rows) = dependent.split_at(law.rows.len().min(dependent.len()));
            (jumps, dependent) = (others, other_rows);
            [own, own_rows].concat()
        };
        self.interface.laws.iter().map(&mut take).collect()
    }
}

/// The limits of the tangential jumps of all pairs; jumps of all pairs are numbered first, then the linearly dependent
/// constraints of all.
fn all_tangents(laws: &[CondensedContact]) -> Vec<TangentialLimit> {
    let jumps: usize = laws.iter().map(CondensedContact::len).sum();
    let (mut first, mut first_row) = (0, jumps);
    let mut all = Vec::new();
    for law in laws {
        let place = |limit: usize| match limit < law.len() {
            true => first + limit,
            false => first_row + limit - law.len(),
        };
        all.extend(law.tangents.iter().map(|tangent| tangent.renamed(place)));
        first += law.len();
        first_row += law.rows.len();
    }
    all.sort_by_key(|tangent| tangent.limit);
    all
}

/// D of all pairs, whose normal jumps are numbered consecutively.
fn all_rows(laws: &[CondensedContact]) -> DependentConstraints {
    let mut rows = DependentConstraints::default();
    let mut first = 0;
    for law in laws {
        rows.append(&law.rows, first);
        first += law.len();
    }
    rows
}
