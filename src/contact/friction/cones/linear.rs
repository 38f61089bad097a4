//! The linear problem of known statuses: open, closed, sticking and slipping.
//!
//! With the jumps of closed and sticking limits known,
//!
//! ```text
//! λ = 0 where open,    D t = d where closed
//! ```
//!
//! and the linear laws of slipping points ([`LinearLaw`](crate::contact::law::LinearLaw)) are equations for the other
//! jumps and forces.

use faer::Mat;

use super::FrictionCones;
use crate::contact::active_set::FORCE_TOLERANCE;
use crate::contact::friction::system::{SPRING, System, YIELD};
use crate::contact::law::{PointLaw, PointStatus};
use crate::contact::laws::{Iterate, Statuses};

/// Equation under assembly: Σ factor·force + Σ factor·jump = constant, over limits.
#[derive(Default)]
struct Equation {
    forces: Vec<(usize, f64)>,
    /// Overshoots of bounds and their factors.
    jumps: Vec<(usize, f64)>,
    constant: f64,
    /// Divisor of the row, and the stiffness of the spring that keeps it regular.
    scale: f64,
    spring: f64,
}

impl FrictionCones<'_> {
    /// Solution of the linear problem of a `state`, from a nearby iterate.
    pub(super) fn step(&self, place: &Iterate, state: &Statuses) -> Iterate {
        let m = place.jumps.len();
        let (mut jumps, mut of_rows) = (place.jumps.clone(), place.forces[m..].to_vec());
        let equations = self.equations(state);
        for (i, equation) in equations.iter().enumerate() {
            match (equation, i < m) {
                (None, true) => jumps[i] = self.contact.bounds[i],
                (None, false) => of_rows[i - m] = 0.0,
                _ => {}
            }
        }
        let start = self.place(jumps, of_rows);
        let system = self.system(&equations);
        let left: Vec<f64> = (equations.iter().flatten())
            .map(|equation| {
                let forces = equation.forces.iter().map(|&(i, c)| c * start.forces[i]);
                let jumps = equation
                    .jumps
                    .iter()
                    .map(|&(i, c)| c * self.laws.violation(i, &start));
                (equation.constant - forces.sum::<f64>() - jumps.sum::<f64>()) / equation.scale
            })
            .collect();
        // Round-off mustn't drive balanced motions without resistance.
        let rests = |system: &System, left: &[f64]| {
            system.unknowns.iter().zip(left).all(|(&i, left)| {
                let scale = self.force_scale(i, &start) / self.sizes[i];
                i < m && left.abs() <= FORCE_TOLERANCE * scale
            })
        };
        let is_balanced = rests(&system, &left);
        let x = system.solve(left, || is_balanced);
        let (mut jumps, mut of_rows) = (start.jumps, start.forces[m..].to_vec());
        for ((&i, x), scale) in system.unknowns.iter().zip(x).zip(&system.scale) {
            match jumps.get_mut(i) {
                Some(t) => *t += x / scale,
                None => of_rows[i - m] += x / scale,
            }
        }
        self.place(jumps, of_rows)
    }

    /// The equations of all limits; `None` where a jump or force is known.
    fn equations(&self, state: &Statuses) -> Vec<Option<Equation>> {
        let m = self.contact.c.len();
        let mut equations: Vec<Option<Equation>> = (0..state.closed.len())
            .map(|i| self.normal(i, state.closed[i]))
            .collect();
        for (point, act) in self.laws.points.iter().zip(&state.points) {
            for i in point.limits() {
                equations[i] = match (act, i < m) {
                    (PointStatus::Open, true) => Some(self.force_is(i)),
                    (PointStatus::Sticks, false) => Some(self.overshoot_is_zero(i)),
                    _ => None,
                };
            }
            let is_closed = point.is_closed(&state.closed);
            for (k, law) in point.linear(act, is_closed).into_iter().enumerate() {
                equations[law.limit] = match (act, point.normal) {
                    (&PointStatus::Parts { direction, turning }, Some(n)) => {
                        Some(self.parts(point, n, k, direction, turning))
                    }
                    _ => Some(Equation {
                        forces: law.forces,
                        jumps: law.slips,
                        constant: law.constant,
                        spring: if law.limit < m { SPRING } else { 0.0 },
                        ..self.force_is(law.limit)
                    }),
                };
            }
        }
        equations
    }

    /// The equation of a normal limit or row; `None` where its jump or force is known.
    fn normal(&self, i: usize, closed: bool) -> Option<Equation> {
        let of_jump = i < self.contact.c.len();
        match (of_jump, closed) {
            (true, false) => Some(self.force_is(i)),
            (false, true) => Some(self.overshoot_is_zero(i)),
            _ => None,
        }
    }

    /// The equation λ = 0, to which terms may be added.
    fn force_is(&self, i: usize) -> Equation {
        Equation {
            forces: vec![(i, 1.0)],
            scale: self.sizes[i],
            spring: SPRING,
            ..Equation::default()
        }
    }

    fn overshoot_is_zero(&self, i: usize) -> Equation {
        Equation {
            jumps: vec![(i, 1.0)],
            scale: 1.0 / self.sizes[i],
            spring: -YIELD,
            ..Equation::default()
        }
    }

    /// Equation k of a point about to open: λ_n = 0 with limit n, and λ_t along e with κ times the slip across it, so
    /// that the residual of λ_n = 0 is free of the round-off of the slip's force.
    fn parts(&self, point: &PointLaw, n: usize, k: usize, e: [f64; 2], across: f64) -> Equation {
        let mut equation = self.force_is(n);
        equation.spring = 0.0;
        if let ([Some(first), Some(second)], 1) = (point.tangents, k) {
            equation.scale = self.sizes[first];
            let weight = self.laws.stiffness[first] / (self.laws.stiffness[first] + across);
            let normal = [(first, -weight * e[1]), (second, weight * e[0])];
            equation.forces = normal.to_vec();
            equation.jumps = normal.map(|(i, c)| (i, -across * c)).to_vec();
        }
        equation
    }

    /// The equations of all unknown jumps and forces.
    fn system(&self, equations: &[Option<Equation>]) -> System {
        let m = self.contact.c.len();
        let unknowns: Vec<usize> = (0..equations.len())
            .filter(|&i| equations[i].is_some())
            .collect();
        let mut column = vec![None; equations.len()];
        for (k, &i) in unknowns.iter().enumerate() {
            column[i] = Some(k);
        }
        let n = unknowns.len();
        let mut a = Mat::<f64>::zeros(n, n);
        self.fill(&mut a, equations, &unknowns, &column);
        let scale: Vec<f64> = (unknowns.iter())
            .map(|&i| match i < m {
                true => self.sizes[i],
                false => 1.0 / self.sizes[i],
            })
            .collect();
        let of_equation: Vec<f64> = equations.iter().flatten().map(|e| e.scale).collect();
        for (l, of_unknown) in scale.iter().enumerate() {
            for (k, of_equation) in of_equation.iter().enumerate() {
                a[(k, l)] /= of_equation * of_unknown;
            }
        }
        // Forces of jumps decrease with the jumps.
        let springs = (equations
            .iter()
            .zip(0..)
            .filter_map(|(e, i)| Some((e.as_ref()?, i))))
        .map(|(e, i): (_, usize)| if i < m { -e.spring } else { e.spring })
        .collect();
        System {
            a,
            unknowns,
            scale,
            springs,
        }
    }

    /// Adds the equations to the matrix, whose columns are those of the `unknowns`; `column` is the index of each among
    /// them.
    fn fill(
        &self,
        a: &mut Mat<f64>,
        equations: &[Option<Equation>],
        unknowns: &[usize],
        column: &[Option<usize>],
    ) {
        let (contact, m) = (&self.contact, self.contact.c.len());
        // Column by column, as in memory: these are most of the matrix' entries.
        let jumps: Vec<(usize, usize, f64)> = (equations.iter().flatten().enumerate())
            .flat_map(|(k, equation)| equation.forces.iter().map(move |&(i, c)| (k, i, c)))
            .filter(|&(_, i, _)| i < m)
            .collect();
        for (l, &j) in unknowns.iter().enumerate() {
            for &(k, i, factor) in &jumps {
                let response = match j < m {
                    true => contact.h[(i, j)],
                    false => {
                        let own = contact.rows.row(j - m).iter().find(|(jump, _)| *jump == i);
                        own.map_or(0.0, |(_, c)| *c)
                    }
                };
                a[(k, l)] -= factor * response;
            }
        }
        for (k, equation) in equations.iter().flatten().enumerate() {
            for &(i, factor) in equation.forces.iter().filter(|(i, _)| *i >= m) {
                if let Some(own) = column[i] {
                    a[(k, own)] += factor;
                }
            }
            for &(i, factor) in &equation.jumps {
                let one = [(i, 1.0)];
                let row = if i < m {
                    &one[..]
                } else {
                    contact.rows.row(i - m)
                };
                for &(j, c) in row {
                    if let Some(own) = column[j] {
                        a[(k, own)] += factor * c;
                    }
                }
            }
        }
    }
}
