//! The contact problem on a patch: points that stay open are condensed out, and checked afterwards.
//!
//! Most conditions of a model never touch, but their jumps are unknowns of H. With λ_o = 0 on the jumps o of open points,
//!
//! ```text
//! H̃ = H_pp − H_po H_oo⁻¹ H_op,   c̃ = c_p − H_po H_oo⁻¹ c_o,   t_o = H_oo⁻¹ (c_o − H_op t_p)
//! ```
//!
//! leave a problem of the same form on the patch p, which is solved in the same manner. Points whose t_o exceeds its
//! bound join the patch until none is left: then the solution is that of the whole problem.

use std::rc::Rc;

use faer::linalg::solvers::SolveCore;
use faer::{Conj, Mat, MatMut};

use super::{FrictionProblem, Status};
use crate::contact::active_set::{ContactProblem, ContactSolution, GAP_TOLERANCE};
use crate::contact::dependent::DependentConstraints;
use crate::contact::laws::Iterate;
use crate::contact::open_factor::{factorize, scale_of};
use crate::contact::patch::{CondensedPatch, LARGE, LastPatch};
use crate::contact::status::FixedStatus;
use crate::contact::tangent::{OtherTangent, TangentialLimit};

/// Number of jumps up to which the whole problem is cheaper to solve than to condense.
const FEW: usize = 300;
/// Maximum number of patch enlargements.
const ROUNDS: usize = 8;
/// Stiffness of the springs on bodies that the first patch leaves free, relative to that of the jumps, the stiffest
/// first.
const SPRINGS: [f64; 3] = [1e-2, 1e-4, 1e-6];

/// A patch of a problem.
struct Patch<'a> {
    problem: &'a FrictionProblem<'a>,
    condensed: Rc<CondensedPatch>,
}

impl FrictionProblem<'_> {
    /// Solution on a patch; `None` where none is small enough and holds the bodies, or none leads to a solution.
    pub(super) fn solve_on_patch(&self, status: &mut [Status]) -> Option<ContactSolution> {
        if self.contact.c.len() <= FEW {
            return None;
        }
        let normal_of = self.normals();
        let mut is_in = self.first_patch(&normal_of, status)?;
        let (mut now, mut steps, mut fell_back) = (status.to_vec(), 0, false);
        for _ in 0..ROUNDS {
            let joins = |i: &usize| normal_of[*i].is_none_or(|n| is_in[n]);
            let patch = Patch::new(self, joins)?;
            let (found, of_patch) = patch.on_patch(&now, |problem, status| problem.solve(status));
            patch.write_statuses(&of_patch, &mut now);
            (steps, fell_back) = (steps + found.steps, fell_back || found.fell_back);
            let whole = ContactSolution {
                jumps: patch.all_jumps(&found.jumps),
                forces: patch.all_forces(&found.forces),
                ..found
            };
            let beyond = patch.beyond(&whole.jumps);
            if beyond.is_empty() {
                status.copy_from_slice(&now);
                return whole.converged.then_some(ContactSolution {
                    steps,
                    fell_back,
                    ..whole
                });
            }
            for n in beyond.into_iter().filter_map(|i| normal_of[i]) {
                is_in[n] = true;
                now[n] = Status::Closed;
            }
        }
        None
    }

    /// Change of jumps and forces with fixed statuses, as in [`Self::change`], on the patch of the closed ones.
    pub(super) fn change_on_patch(&self, fixed: &[FixedStatus]) -> Option<Iterate> {
        if self.contact.c.len() <= FEW {
            return None;
        }
        let normal_of = self.normals();
        let is_in = held(&normal_of, fixed, FixedStatus::Open);
        let patch = Patch::new(self, |&i| normal_of[i].is_none_or(|n| is_in[n]))?;
        let (change, _) = patch.on_patch(fixed, |problem, fixed| problem.change(fixed));
        Some(Iterate {
            jumps: patch.all_jumps(&change.jumps),
            forces: patch.all_forces(&change.forces),
        })
    }

    /// The normal jump with which every jump opens, itself for a normal one; `None` for jumps that needn't open.
    fn normals(&self) -> Vec<Option<usize>> {
        let m = self.contact.c.len();
        let mut normal_of: Vec<Option<usize>> = (0..m).map(Some).collect();
        let mut stay = vec![false; m];
        for (i, _) in self.contact.rows.iter().flatten() {
            stay[*i] = true;
        }
        for tangent in self.tangents {
            let TangentialLimit { limit, bound, .. } = *tangent;
            let normal = tangent.normal.filter(|&n| n < m);
            let opens = bound.only_closed && !matches!(tangent.other, OtherTangent::Prescribed(_));
            match normal {
                Some(n) if limit < m => {
                    stay[n] |= stay[limit] || !opens;
                    normal_of[limit] = Some(n);
                }
                Some(n) => stay[n] = true,
                None if limit < m => normal_of[limit] = None,
                None => {}
            }
        }
        let opens = |n: &usize| !stay[*n];
        normal_of.into_iter().map(|n| n.filter(opens)).collect()
    }

    /// Normal jumps of the first patch: those in compression, and, if these leave a body free, those that close as the
    /// loads move it against springs; `None` where no such patch is small enough.
    fn first_patch(&self, normal_of: &[Option<usize>], status: &[Status]) -> Option<Vec<bool>> {
        let mut is_in = self.in_compression(normal_of, status);
        let patch = |is_in: &[bool]| Patch::new(self, |&i| normal_of[i].is_none_or(|n| is_in[n]));
        for spring in SPRINGS {
            if patch(&is_in).is_some() {
                return Some(is_in);
            }
            let jumps = self.held_by_springs(normal_of, &is_in, spring)?;
            for n in normal_of.iter().flatten() {
                is_in[*n] |= jumps[*n] > self.contact.bounds[*n];
            }
        }
        patch(&is_in).is_some().then_some(is_in)
    }

    /// All jumps with the points of a patch closed and sticking, and the others open against springs of this stiffness,
    /// relative to their own; `None` where the patch is too large, or a body remains free.
    fn held_by_springs(
        &self,
        normal_of: &[Option<usize>],
        is_in: &[bool],
        spring: f64,
    ) -> Option<Vec<f64>> {
        let contact = &self.contact;
        let m = contact.c.len();
        let is_open = |&i: &usize| normal_of[i].is_some_and(|n| !is_in[n]);
        let open: Vec<usize> = (0..m).filter(is_open).collect();
        if ((m - open.len()) as f64) > LARGE * m as f64 {
            return None;
        }
        let mut jumps = contact.bounds[..m].to_vec();
        open.iter().for_each(|&i| jumps[i] = 0.0);
        let mut left = contact.c.to_vec();
        contact.subtract(&jumps, &mut left);
        let scale: Vec<f64> = (open.iter())
            .map(|&i| scale_of(contact.h[(i, i)], contact.diagonal[i]))
            .collect();
        let of_open = Mat::from_fn(open.len(), open.len(), |a, b| contact.h[(open[a], open[b])]);
        let factor = factorize(of_open.as_ref(), &scale, spring)?;
        let mut freed = Mat::from_fn(open.len(), 1, |a, _| {
            left[open[a]] + spring * scale[a] * contact.center[open[a]]
        });
        factor.solve_in_place_with_conj(Conj::No, freed.as_mut());
        for (a, &i) in open.iter().enumerate() {
            jumps[i] = freed[(a, 0)];
        }
        Some(jumps)
    }

    /// Normal jumps of closed points; if these are most, those in compression when all are closed.
    fn in_compression(&self, normal_of: &[Option<usize>], status: &[Status]) -> Vec<bool> {
        let contact = &self.contact;
        let mut held = held(normal_of, status, Status::Open);
        let jumps = normal_of.iter().flatten().filter(|n| held[**n]).count();
        if jumps as f64 <= LARGE * held.len() as f64 {
            return held;
        }
        let jump = |i: usize| match status[i] {
            Status::Open => contact.center[i],
            _ => contact.bounds[i],
        };
        let jumps: Vec<f64> = (0..held.len()).map(jump).collect();
        let mut forces = contact.c.to_vec();
        contact.subtract(&jumps, &mut forces);
        held.iter_mut()
            .zip(forces)
            .for_each(|(held, force)| *held &= force > 0.0);
        held
    }
}

/// Normal jumps of points whose status isn't `open`.
fn held<S: PartialEq>(normal_of: &[Option<usize>], statuses: &[S], open: S) -> Vec<bool> {
    let mut held = vec![false; normal_of.len()];
    for (normal, status) in normal_of.iter().zip(statuses) {
        if let (Some(n), true) = (normal, *status != open) {
            held[*n] = true;
        }
    }
    held
}

impl<'a> Patch<'a> {
    /// The patch of jumps that `joins` selects; `None` where it is too large or leaves a body free.
    fn new(problem: &'a FrictionProblem<'a>, joins: impl Fn(&usize) -> bool) -> Option<Self> {
        let jumps: Vec<usize> = (0..problem.contact.c.len()).filter(joins).collect();
        let condensed = problem.last_patch.condensed(&problem.contact, jumps)?;
        Some(Self { problem, condensed })
    }

    /// Limits of the patch, those of dependent rows last.
    fn limits(&self) -> Vec<usize> {
        let contact = &self.problem.contact;
        let rows = contact.c.len()..contact.bounds.len();
        self.condensed.jumps.iter().copied().chain(rows).collect()
    }

    /// Result of a function of the problem on the patch, whose statuses are `now` in the whole problem, and the
    /// statuses after it.
    fn on_patch<S: Copy, T>(
        &self,
        now: &[S],
        ask: impl FnOnce(&FrictionProblem<'_>, &mut [S]) -> T,
    ) -> (T, Vec<S>) {
        let whole = &self.problem.contact;
        let CondensedPatch { jumps, open, h, .. } = &*self.condensed;
        let of_patch = |all: &[f64]| -> Vec<f64> { jumps.iter().map(|&i| all[i]).collect() };
        let (mut c, mut c_scale) = (of_patch(whole.c), of_patch(whole.c_scale));
        let freed = self.open_jumps(&vec![0.0; jumps.len()]);
        for (&i, freed) in open.iter().zip(&freed) {
            let held = whole.h.col(i);
            for (k, &j) in jumps.iter().enumerate() {
                c[k] -= held[j] * freed;
                c_scale[k] += (held[j] * freed).abs();
            }
        }
        let (m, in_patch) = (whole.c.len(), jumps.len());
        let place = |i: usize| match i.checked_sub(m) {
            Some(row) => in_patch + row,
            None => jumps.partition_point(|&j| j < i),
        };
        let mut rows = DependentConstraints::default();
        for row in whole.rows.iter() {
            rows.push(row.iter().map(|&(i, c)| (place(i), c)).collect());
        }
        let is_in = |i: usize| i >= m || jumps.binary_search(&i).is_ok();
        let tangents = self.problem.tangents.iter();
        let tangents: Vec<TangentialLimit> = (tangents.filter(|tangent| is_in(tangent.limit)))
            .map(|tangent| tangent.renamed(place))
            .collect();
        let limits = self.limits();
        let bounds: Vec<f64> = limits.iter().map(|&i| whole.bounds[i]).collect();
        let mut status: Vec<S> = limits.iter().map(|&i| now[i]).collect();
        let problem = FrictionProblem {
            contact: ContactProblem {
                h: h.as_ref(),
                diagonal: &of_patch(whole.diagonal),
                c: &c,
                c_scale: &c_scale,
                rows: &rows,
                bounds: &bounds,
                center: &of_patch(whole.center),
                scale: whole.scale,
            },
            tangents: &tangents,
            last_patch: &LastPatch::default(),
        };
        (ask(&problem, &mut status), status)
    }

    /// Writes the statuses of the patch, and open ones elsewhere, to `now`.
    fn write_statuses(&self, of_patch: &[Status], now: &mut [Status]) {
        now.fill(Status::Open);
        for (i, status) in self.limits().into_iter().zip(of_patch) {
            now[i] = *status;
        }
    }

    /// Open jumps t_o for these jumps of the patch.
    fn open_jumps(&self, of_patch: &[f64]) -> Vec<f64> {
        let contact = &self.problem.contact;
        let CondensedPatch {
            jumps,
            open,
            factor,
            ..
        } = &*self.condensed;
        let mut all = vec![0.0; contact.c.len()];
        for (&i, t) in jumps.iter().zip(of_patch) {
            all[i] = *t;
        }
        // The second pass removes round-off.
        for _ in 0..2 {
            let mut left = contact.c.to_vec();
            contact.subtract(&all, &mut left);
            let mut freed: Vec<f64> = open.iter().map(|&i| left[i]).collect();
            let n = freed.len();
            let column = MatMut::from_column_major_slice_mut(&mut freed, n, 1);
            factor.solve_in_place_with_conj(Conj::No, column);
            for (&i, freed) in open.iter().zip(freed) {
                all[i] += freed;
            }
        }
        open.iter().map(|&i| all[i]).collect()
    }

    /// All jumps for these of the patch.
    fn all_jumps(&self, of_patch: &[f64]) -> Vec<f64> {
        let mut jumps = vec![0.0; self.problem.contact.c.len()];
        for (&i, t) in self.condensed.open.iter().zip(self.open_jumps(of_patch)) {
            jumps[i] = t;
        }
        for (&i, t) in self.condensed.jumps.iter().zip(of_patch) {
            jumps[i] = *t;
        }
        jumps
    }

    /// All forces for these of the patch.
    fn all_forces(&self, of_patch: &[f64]) -> Vec<f64> {
        let mut forces = vec![0.0; self.problem.contact.bounds.len()];
        for (i, force) in self.limits().into_iter().zip(of_patch) {
            forces[i] = *force;
        }
        forces
    }

    /// Open normal jumps beyond their bounds.
    fn beyond(&self, jumps: &[f64]) -> Vec<usize> {
        let contact = &self.problem.contact;
        let largest = jumps.iter().fold(contact.scale, |m, t| m.max(t.abs()));
        let mut is_tangential = vec![false; jumps.len()];
        for tangent in self.problem.tangents {
            if let Some(is) = is_tangential.get_mut(tangent.limit) {
                *is = true;
            }
        }
        let is_beyond = |&i: &usize| {
            !is_tangential[i] && jumps[i] > contact.bounds[i] + GAP_TOLERANCE * largest
        };
        self.condensed
            .open
            .iter()
            .copied()
            .filter(is_beyond)
            .collect()
    }
}
