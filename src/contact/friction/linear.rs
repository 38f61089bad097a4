//! The linear problem of fixed statuses.
//!
//! With t known where a limit is closed, and μ the forces of dependent rows D that are closed or slip,
//!
//! ```text
//! λ = c − H t − Dᵀ μ,    λ_i = 0 where open,    λ_i = ±(c_i + μ_i λ_n) where slipping,    D t = d where closed
//! ```
//!
//! are as many equations as unknowns. The ones of slipping limits make the matrix unsymmetric.

use faer::linalg::solvers::{PartialPivLu, SolveCore};
use faer::{Conj, Mat, MatMut};

use super::{FrictionProblem, Status};
use crate::contact::open_factor::scale_of;
use crate::vector::largest;

/// Pivot of the scaled matrix, or size of what it makes of something of size 1, below which it is taken as singular.
const SINGULAR: f64 = 1e-13;
/// Stiffness of the springs that make it regular then, in that scale.
pub(super) const SPRING: f64 = 1e-12;
/// How much closed rows that depend on each other give way, in that scale: their forces share what one could carry.
pub(super) const YIELD: f64 = 1e-6;
/// Part of that where refinements leave more than this of what is solved for: soft bodies between stiff ones carry a small
/// part of what their rows could.
const LESS: f64 = 1e-3;
const BENT: f64 = 1e-12;
/// Most refinements of a solution that springs have bent.
const MAX_REFINEMENTS: usize = 40;

/// The solution of the linear problem.
#[derive(Clone, Debug)]
pub(super) struct Linear {
    /// t, exactly the bound where closed.
    pub jumps: Vec<f64>,
    /// λ, then μ; 0 where open.
    pub forces: Vec<f64>,
    /// What is left of the equations, relative to their terms.
    pub unbalanced: f64,
}

/// A x = b in the scale of energies.
pub(super) struct System {
    pub a: Mat<f64>,
    /// Which limits the unknowns are of: jumps that aren't closed, then rows that are closed or slip.
    pub unknowns: Vec<usize>,
    /// What an unknown is in that scale: jump or force times this.
    pub scale: Vec<f64>,
    /// What an equation is divided by.
    pub of_equation: Vec<f64>,
    /// A spring on every jump, and what gives way in every closed row, where A is singular.
    pub springs: Vec<f64>,
    /// Whether rows give way less where they bend what they are to hold.
    pub may_yield_less: bool,
}

impl Linear {
    /// Solves `problem` for the statuses of its limits.
    pub fn solve(problem: &FrictionProblem<'_>, status: &[Status]) -> Self {
        let gap = &problem.contact;
        let m = gap.c.len();
        let mut jumps: Vec<f64> = (0..m)
            .map(|i| match status[i] {
                Status::Closed => gap.bounds[i],
                _ => gap.center[i],
            })
            .collect();
        let mut forces = vec![0.0; status.len()];
        let system = System::new(problem, status);
        let left = problem.left(status, &jumps, &forces);
        let b = left.iter().zip(&system.of_equation);
        let b = b.map(|(r, s)| r / s).collect();
        let x = system.solve(b, || problem.is_balanced(status, &jumps, &left));
        for ((&i, x), scale) in system.unknowns.iter().zip(x).zip(&system.scale) {
            match jumps.get_mut(i) {
                Some(t) => *t += x / scale,
                None => forces[i] = x / scale,
            }
        }
        let unbalanced = problem.unbalanced(status, &jumps, &forces);
        problem.complete(status, &jumps, &mut forces);
        Self {
            jumps,
            forces,
            unbalanced,
        }
    }
}

impl FrictionProblem<'_> {
    /// The limits whose jump or force is unknown.
    fn unknowns(&self, status: &[Status]) -> Vec<usize> {
        let m = self.contact.c.len();
        let is_unknown = |&i: &usize| match i < m {
            true => !status[i].is_closed(),
            false => status[i] != Status::Open,
        };
        (0..status.len()).filter(is_unknown).collect()
    }

    /// The bound of every slipping limit, with the sign of its force: what is independent of forces, and the share
    /// of which one of the limits.
    fn slipping(&self, status: &[Status]) -> Vec<Option<Slipping>> {
        let mut all = vec![None; status.len()];
        for tangent in self.tangents {
            let sign = status[tangent.limit].sign();
            if sign != 0.0 {
                let of_normal = tangent.normal.filter(|&n| status[n].is_closed());
                all[tangent.limit] = Some(Slipping {
                    constant: sign * tangent.bound.cohesion,
                    normal: of_normal.map(|n| (n, sign * tangent.bound.coefficient)),
                });
            }
        }
        all
    }

    /// The normal limit of every tangential one that slips while its contact is about to open: its force is 0, and the
    /// other force what that takes.
    fn parting(&self, status: &[Status]) -> Vec<Option<usize>> {
        let mut all = vec![None; status.len()];
        for tangent in self.tangents {
            if status[tangent.limit] == Status::Parting {
                all[tangent.limit] = tangent.normal;
            }
        }
        all
    }

    /// c − H t − Dᵀ μ.
    fn free_forces(&self, jumps: &[f64], forces: &[f64]) -> Vec<f64> {
        let mut left = self.contact.c.to_vec();
        self.contact.subtract(jumps, &mut left);
        self.contact
            .rows
            .subtract_transposed(&forces[jumps.len()..], &mut left);
        left
    }

    /// What jumps and forces leave of the equations of the unknowns.
    fn left(&self, status: &[Status], jumps: &[f64], forces: &[f64]) -> Vec<f64> {
        let m = jumps.len();
        let free = self.free_forces(jumps, forces);
        let (slipping, parting) = (self.slipping(status), self.parting(status));
        let force = |n: usize| if n < m { free[n] } else { forces[n] };
        let allowed = |i: usize| {
            slipping[i].as_ref().map_or(0.0, |slipping| {
                let of_normal = slipping.normal.map_or(0.0, |(n, share)| share * force(n));
                slipping.constant + of_normal
            })
        };
        let unknowns = self.unknowns(status).into_iter();
        unknowns
            .map(|i| match (i < m, status[i].is_closed()) {
                _ if parting[i].is_some() => parting[i].map_or(0.0, force),
                (true, _) => free[i] - allowed(i),
                (false, true) => self.contact.bounds[i] - self.contact.rows.value(i - m, jumps),
                (false, false) => allowed(i) - forces[i],
            })
            .collect()
    }

    /// Gives every closed or slipping limit its force.
    fn complete(&self, status: &[Status], jumps: &[f64], forces: &mut [f64]) {
        let m = jumps.len();
        let free = self.free_forces(jumps, forces);
        let is_free = |&i: &usize| status[i].is_closed() || status[i] == Status::Parting;
        for i in (0..m).filter(is_free) {
            forces[i] = free[i];
        }
        for n in self.parting(status).into_iter().flatten() {
            forces[n] = 0.0;
        }
        for (i, slipping) in self.slipping(status).into_iter().enumerate() {
            if let Some(slipping) = slipping {
                let of_normal = slipping.normal.map_or(0.0, |(n, share)| share * forces[n]);
                forces[i] = slipping.constant + of_normal;
            }
        }
    }

    /// The largest of what is left of the equations at jumps that aren't closed, relative to their terms.
    fn unbalanced(&self, status: &[Status], jumps: &[f64], forces: &[f64]) -> f64 {
        let left = self.left(status, jumps, forces);
        let unknowns = self.unknowns(status).into_iter().zip(left);
        let of_jumps = unknowns
            .filter(|&(i, left)| i < jumps.len() && status[i] != Status::Parting && left != 0.0);
        let relative = of_jumps.map(|(i, left)| {
            let by_rows = self.contact.rows.iter().zip(&forces[jumps.len()..]);
            let by_rows = by_rows.map(|(row, force)| {
                let share = row.iter().find(|&&(jump, _)| jump == i);
                share.map_or(0.0, |(_, share)| (share * force).abs())
            });
            left.abs() / (self.contact.scale_of(i, jumps) + by_rows.sum::<f64>())
        });
        relative.fold(0.0, |m, x| if x.is_nan() { x } else { f64::max(m, x) })
    }

    /// Whether nothing but round-off is `left` of the equations, so that round-off mustn't drive what moves freely.
    fn is_balanced(&self, status: &[Status], jumps: &[f64], left: &[f64]) -> bool {
        let m = jumps.len();
        let mut unknowns = self.unknowns(status).into_iter().zip(left);
        unknowns.all(|(i, left)| {
            let tolerance = super::FORCE_TOLERANCE;
            i < m && left.abs() <= tolerance * self.contact.scale_of(i, jumps)
        })
    }
}

/// The force of a slipping limit: a constant, and a share of the force of another limit.
#[derive(Clone, Copy, Debug)]
struct Slipping {
    constant: f64,
    normal: Option<(usize, f64)>,
}

impl System {
    fn new(problem: &FrictionProblem<'_>, status: &[Status]) -> Self {
        let gap = &problem.contact;
        let m = gap.c.len();
        let unknowns = problem.unknowns(status);
        let of_jump = |j: usize| scale_of(gap.h[(j, j)], gap.diagonal[j]).sqrt();
        let of_row = |j: usize| {
            let terms = gap.rows.row(j).iter();
            let squares = terms.map(|&(i, c)| (c / of_jump(i)).powi(2));
            squares.sum::<f64>().sqrt()
        };
        let scale = |&i: &usize| if i < m { of_jump(i) } else { of_row(i - m) };
        let scale: Vec<f64> = unknowns.iter().map(scale).collect();
        let (mut of_equation, mut springs) = (scale.clone(), vec![SPRING; unknowns.len()]);
        let (slipping, parting) = (problem.slipping(status), problem.parting(status));
        for (k, &i) in unknowns.iter().enumerate() {
            if let Some(n) = parting[i] {
                springs[k] = 0.0;
                of_equation[k] = if n < m {
                    of_jump(n)
                } else {
                    1.0 / of_row(n - m)
                };
            } else if i < m {
                continue;
            } else if status[i].is_closed() {
                springs[k] = -YIELD;
            } else {
                (of_equation[k], springs[k]) = (1.0 / scale[k], 0.0);
            }
        }
        let mut place = vec![None; status.len()];
        for (k, &i) in unknowns.iter().enumerate() {
            place[i] = Some(k);
        }
        let n = unknowns.len();
        let mut a = Mat::<f64>::zeros(n, n);
        // The force of limit i, times −share, in equation k.
        let subtract = |a: &mut Mat<f64>, k: usize, i: usize, share: f64| {
            if i >= m {
                if let Some(column) = place[i] {
                    a[(k, column)] += share;
                }
                return;
            }
            for (column, &j) in unknowns.iter().enumerate() {
                a[(k, column)] -= share
                    * match j < m {
                        true => gap.h[(i, j)],
                        false => {
                            let own = gap.rows.row(j - m).iter().find(|(jump, _)| *jump == i);
                            own.map_or(0.0, |(_, c)| *c)
                        }
                    };
            }
        };
        for (k, &i) in unknowns.iter().enumerate() {
            if let Some(n) = parting[i] {
                subtract(&mut a, k, n, -1.0);
            } else if i < m {
                subtract(&mut a, k, i, -1.0);
            } else if status[i].is_closed() {
                for &(j, c) in gap.rows.row(i - m) {
                    if let Some(column) = place[j] {
                        a[(k, column)] += c;
                    }
                }
            } else {
                a[(k, k)] += 1.0;
            }
            if let Some((n, share)) = slipping[i].and_then(|slipping| slipping.normal) {
                let sign = if i < m { 1.0 } else { -1.0 };
                subtract(&mut a, k, n, sign * share);
            }
        }
        for (column, of_column) in scale.iter().enumerate() {
            for (k, of_equation) in of_equation.iter().enumerate() {
                a[(k, column)] /= of_equation * of_column;
            }
        }
        Self {
            a,
            unknowns,
            scale,
            of_equation,
            springs,
            may_yield_less: false,
        }
    }

    /// A⁻¹ b, 0 where A is singular and b `is_balanced`.
    pub fn solve(&self, b: Vec<f64>, is_balanced: impl Fn() -> bool) -> Vec<f64> {
        let n = b.len();
        let lu = self.a.partial_piv_lu();
        if !is_singular(&lu, n) {
            return self.refine(&lu, &b, 1);
        }
        if is_balanced() {
            return vec![0.0; n];
        }
        let x = self.refine(&self.held(1.0), &b, MAX_REFINEMENTS);
        let missed = |x: &[f64]| largest(&self.left(&b, x));
        if !self.may_yield_less || missed(&x) <= BENT * largest(&b) {
            return x;
        }
        let stiffer = self.refine(&self.held(LESS), &b, MAX_REFINEMENTS);
        match missed(&stiffer) < missed(&x) {
            true => stiffer,
            false => x,
        }
    }

    /// A with its springs, of which those of rows are a part only.
    fn held(&self, part: f64) -> PartialPivLu<f64> {
        let mut held = self.a.clone();
        for (k, &spring) in self.springs.iter().enumerate() {
            let of_row = spring.abs() == YIELD;
            held[(k, k)] += if of_row { part * spring } else { spring };
        }
        held.partial_piv_lu()
    }

    /// b − A x.
    fn left(&self, b: &[f64], x: &[f64]) -> Vec<f64> {
        let mut left = b.to_vec();
        for (column, &x) in self.a.col_iter().zip(x) {
            for (left, a) in left.iter_mut().zip(column.iter()) {
                *left -= a * x;
            }
        }
        left
    }

    /// A⁻¹ b by factors that are nearly those of A.
    fn refine(&self, lu: &PartialPivLu<f64>, b: &[f64], most: usize) -> Vec<f64> {
        let mut x = b.to_vec();
        apply(lu, &mut x);
        let mut last = f64::INFINITY;
        for _ in 0..most {
            let mut left = self.left(b, &x);
            let size = left.iter().fold(0.0, |m: f64, r| m.max(r.abs()));
            if size == 0.0 || size > 0.9 * last || size.is_nan() {
                break;
            }
            last = size;
            apply(lu, &mut left);
            for (x, dx) in x.iter_mut().zip(left) {
                *x += dx;
            }
        }
        x
    }
}

/// Whether A is singular but for round-off. Where what is unresisted has little of the last unknowns, no pivot says so,
/// but it is most of A⁻¹ times anything.
fn is_singular(lu: &PartialPivLu<f64>, n: usize) -> bool {
    if (0..n).any(|k| lu.U()[(k, k)].abs() <= SINGULAR) {
        return true;
    }
    let mut x: Vec<f64> = (0..n).map(|i| (1.0 + 12.9898 * i as f64).sin()).collect();
    let size = largest(&x);
    apply(lu, &mut x);
    size <= SINGULAR * largest(&x)
}

fn apply(lu: &PartialPivLu<f64>, x: &mut [f64]) {
    let n = x.len();
    lu.solve_in_place_with_conj(Conj::No, MatMut::from_column_major_slice_mut(x, n, 1));
}
