//! The contact problem with friction: normal jumps t ≤ g with forces λ ≥ 0, tangential jumps w that stick where they
//! are as long as |λ_t| ≤ b, and slip under λ_t = ±b, against the slip.
//!
//! The bound b is given, or grows with the normal force, b = c + μ λ: then the matrix of the slipping ones isn't
//! symmetric, and no energy has the solution for its minimum. A status for every limit makes the problem linear; all
//! wrong statuses are exchanged at once until none is wrong, as semismooth Newton does, and where these don't become
//! fewer, from those at the end of a path that leads to a solution (Lemke's method).

mod discs;
mod lemke;
mod linear;
mod other;
#[cfg(test)]
mod points;

use serde::{Deserialize, Serialize};

use self::linear::Linear;
use super::active_set::{ContactProblem, ContactSolution, FORCE_TOLERANCE, GAP_TOLERANCE};
use super::limits::TangentialLimit;

/// Exchanges of all wrong statuses in a row without fewer of them before these are given up.
const PATIENCE: usize = 8;
/// Ways to a solution that are tried then.
const ATTEMPTS: usize = 3;

/// Round-off of dependent limits, relative to that of others, beyond which they aren't where they should be.
const ASTRAY: f64 = 1e4;

/// What bounds a tangential force: |λ_t| ≤ cohesion + coefficient·λ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ForceBound {
    /// Coefficient of friction.
    pub coefficient: f64,
    /// What it is without normal force (N/m).
    pub cohesion: f64,
    /// Whether it is 0 where the contact is open.
    pub only_closed: bool,
}

impl ForceBound {
    /// The bound under this normal force (N/m).
    pub fn at(&self, normal: f64, is_closed: bool) -> f64 {
        match self.only_closed && !is_closed {
            true => 0.0,
            false => self.cohesion + self.coefficient * normal.max(0.0),
        }
    }
}

/// A tangential condition, its number and that of its point's normal one, and what bounds its force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TangentialCondition {
    /// Its number among the conditions.
    pub number: usize,
    /// That of the normal one.
    pub normal: usize,
    /// What bounds its force.
    pub bound: ForceBound,
}

/// What a limit is for the linear problem.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Status {
    /// Nothing acts: a normal jump below its bound, a tangential one of an open contact.
    Open,
    /// At its bound: closed, or sticking.
    #[default]
    Closed,
    /// Slipping in the direction of its tangent, under λ_t = b.
    Forward,
    /// Slipping against it, under λ_t = −b.
    Backward,
    /// Slipping along a direction in space.
    Slipping,
    /// Slipping while its contact is about to open: without pressure, under what is left of the cohesion.
    Parting,
}

impl Status {
    /// Open or closed.
    pub fn new(open: bool) -> Self {
        match open {
            true => Self::Open,
            false => Self::Closed,
        }
    }

    /// That of a tangential limit that slips by so much.
    fn of_slip(slip: f64) -> Self {
        match slip {
            ahead if ahead > 0.0 => Self::Forward,
            back if back < 0.0 => Self::Backward,
            _ => Self::Closed,
        }
    }

    /// Whether its jump is known.
    pub fn is_closed(self) -> bool {
        self == Self::Closed
    }

    /// The sign of the force under which it slips, 0 where it doesn't.
    fn sign(self) -> f64 {
        match self {
            Self::Forward => 1.0,
            Self::Backward => -1.0,
            Self::Open | Self::Closed | Self::Slipping | Self::Parting => 0.0,
        }
    }
}

/// The contact problem with friction.
#[derive(Clone, Copy, Debug)]
pub struct FrictionProblem<'a> {
    /// All limits; those of tangential jumps are where these stick.
    pub contact: ContactProblem<'a>,
    /// Which are those.
    pub tangents: &'a [TangentialLimit],
}

impl FrictionProblem<'_> {
    /// Solves the problem from the statuses that its limits have at first, and leaves there those of the solution.
    pub fn solve(&self, status: &mut [Status]) -> ContactSolution {
        if self.tangents.is_empty() {
            let mut open: Vec<bool> = status.iter().map(|status| !status.is_closed()).collect();
            let solution = self.contact.solve(&mut open);
            for (status, open) in status.iter_mut().zip(open) {
                *status = Status::new(open);
            }
            return solution;
        }
        if self.has_discs() {
            return self.solve_discs(status);
        }
        let start = status.to_vec();
        let mut solution = self.exchange(status);
        for attempt in 0..ATTEMPTS {
            if solution.converged {
                break;
            }
            let before = solution.steps;
            let (reached, exchanges) = self.follow(attempt);
            let center = match &reached {
                Some(end) => {
                    status.copy_from_slice(&end.status);
                    &end.jumps
                }
                None => {
                    status.copy_from_slice(&start);
                    self.contact.center
                }
            };
            // Where nothing resists, what slips both ways is between both there, and not just anywhere.
            let contact = ContactProblem {
                center,
                ..self.contact
            };
            let tangents = self.tangents;
            solution = FrictionProblem { contact, tangents }.exchange(status);
            solution.steps += before + exchanges;
            solution.fell_back = true;
        }
        solution
    }

    /// Exchanges all wrong statuses at once until none is wrong, or they don't become fewer.
    fn exchange(&self, status: &mut [Status]) -> ContactSolution {
        self.settle(status, |_| 0.0);
        let (mut fewest, mut patience, mut steps) = (usize::MAX, PATIENCE, 0);
        loop {
            steps += 1;
            let linear = Linear::solve(self, status);
            let wrong = self.wrong(status, &linear);
            if wrong.len() < fewest {
                (fewest, patience) = (wrong.len(), PATIENCE);
            } else {
                patience -= 1;
            }
            if wrong.is_empty() || patience == 0 {
                return self.solution(linear, steps, wrong.is_empty());
            }
            for (i, right) in wrong {
                status[i] = right;
            }
            self.settle(status, |i| -self.way(i, &linear));
        }
    }

    /// The change of jumps and forces where limits keep these statuses; `bounds` are what the closed ones lack, and the
    /// share of the bound of their point that those have that slip: the change of that force follows from that of the
    /// normal one, in the direction that the force has, which `turns` by κ times the slip across it.
    pub fn change(&self, status: &[Status], turns: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let slips = |status: &Status| status.sign() != 0.0 || *status == Status::Parting;
        if !status.iter().any(slips) {
            let open: Vec<bool> = status.iter().map(|status| !status.is_closed()).collect();
            let trial = self.contact.linear(&open);
            return (trial.jumps, trial.forces);
        }
        if turns.iter().any(|turn| *turn != 0.0) {
            return self.change_discs(status, turns);
        }
        let mut tangents = self.tangents.to_vec();
        for tangent in &mut tangents {
            tangent.bound.cohesion = 0.0;
            if status[tangent.limit].sign() != 0.0 {
                tangent.bound.coefficient *= self.contact.bounds[tangent.limit];
            }
        }
        let (contact, tangents) = (self.contact, &tangents[..]);
        let linear = Linear::solve(&FrictionProblem { contact, tangents }, status);
        (linear.jumps, linear.forces)
    }

    /// The limits whose status is wrong where they have these.
    pub fn unsettled(&self, status: &[Status]) -> Vec<usize> {
        if self.has_discs() {
            return self.unsettled_discs(status);
        }
        let linear = Linear::solve(self, status);
        let wrong = self.wrong(status, &linear).into_iter();
        wrong.map(|(i, _)| i).collect()
    }

    /// The jumps and forces of fixed statuses, all of them right or not.
    fn solution(&self, linear: Linear, steps: usize, right: bool) -> ContactSolution {
        let Linear {
            mut jumps,
            mut forces,
            unbalanced,
        } = linear;
        let mut tangents = self.tangents.iter().map(|tangent| tangent.limit).peekable();
        for (i, force) in forces.iter_mut().enumerate() {
            if tangents.next_if_eq(&i).is_some() {
                continue;
            }
            *force = force.max(0.0);
            if let Some(t) = jumps.get_mut(i) {
                *t = t.min(self.contact.bounds[i]);
            }
        }
        ContactSolution {
            jumps,
            forces,
            steps,
            fell_back: false,
            converged: right && unbalanced <= FORCE_TOLERANCE,
            slides: false,
        }
    }

    /// Gives tangential limits a status that goes with that of their normal one: what closes goes on in the
    /// direction of its `slip`.
    fn settle(&self, status: &mut [Status], slip: impl Fn(usize) -> f64) {
        for tangent in self.tangents {
            let is_closed = tangent.normal.is_some_and(|n| status[n].is_closed());
            let is_closed = is_closed || !tangent.bound.only_closed;
            let own = &mut status[tangent.limit];
            *own = match (is_closed, *own) {
                (false, _) => Status::Open,
                (true, Status::Open) => Status::of_slip(slip(tangent.limit)),
                (true, known) => known,
            };
        }
    }

    /// The limits whose status is wrong beyond round-off, ascending, and what it should be.
    fn wrong(&self, status: &[Status], linear: &Linear) -> Vec<(usize, Status)> {
        let mut tangents = self.tangents.iter().peekable();
        let all = (0..status.len()).filter_map(|i| {
            let tangent = tangents.next_if(|tangent| tangent.limit == i);
            let right = match tangent {
                Some(tangent) => self.tangential_status(tangent, status, linear),
                None => self.normal_status(i, status, linear),
            };
            (right != status[i]).then_some((i, right))
        });
        all.collect()
    }

    fn normal_status(&self, i: usize, status: &[Status], linear: &Linear) -> Status {
        match status[i] {
            Status::Closed => Status::new(
                linear.forces[i] < -self.force_round_off(i, linear)
                    || self.is_astray(i, linear) && self.way(i, linear) > 0.0,
            ),
            _ => Status::new(self.way(i, linear) >= -self.gap_round_off(i, linear)),
        }
    }

    fn tangential_status(
        &self,
        tangent: &TangentialLimit,
        status: &[Status],
        linear: &Linear,
    ) -> Status {
        let i = tangent.limit;
        let pressed = tangent.normal.map_or(0.0, |n| linear.forces[n]);
        let bound = tangent.bound.at(pressed, true);
        let slip = -self.way(i, linear);
        let is_none = slip.abs() <= self.gap_round_off(i, linear);
        match status[i] {
            Status::Open => Status::Open,
            // The force of its normal says first that this is open.
            _ if self.opens(tangent, status, linear) => status[i],
            Status::Closed if self.is_astray(i, linear) => Status::of_slip(slip),
            Status::Closed => {
                let over = linear.forces[i].abs() - bound;
                match over > self.force_round_off(i, linear) {
                    true if linear.forces[i] > 0.0 => Status::Forward,
                    true => Status::Backward,
                    false => Status::Closed,
                }
            }
            Status::Forward if slip < 0.0 && !is_none => Status::Closed,
            Status::Backward if slip > 0.0 && !is_none => Status::Closed,
            Status::Parting if slip * linear.forces[i] < 0.0 && !is_none => Status::Closed,
            Status::Parting if linear.forces[i].abs() > bound => Status::of_slip(linear.forces[i]),
            slipping => slipping,
        }
    }

    /// Whether the normal limit of a tangential one is about to open, and that one with it.
    fn opens(&self, tangent: &TangentialLimit, status: &[Status], linear: &Linear) -> bool {
        let opens = |n: usize| !self.normal_status(n, status, linear).is_closed();
        tangent.bound.only_closed && tangent.normal.is_some_and(opens)
    }

    /// Whether limit i, which is closed, isn't where it should be: what it depends on is held elsewhere.
    fn is_astray(&self, i: usize, linear: &Linear) -> bool {
        i >= self.contact.c.len()
            && self.way(i, linear).abs() > ASTRAY * self.gap_round_off(i, linear)
    }

    /// How far limit i is from its bound: the gap that is left, or the way back to where it sticks (m).
    fn way(&self, i: usize, linear: &Linear) -> f64 {
        self.contact.bounds[i] - self.value(i, &linear.jumps)
    }

    /// The jump of limit i where those that are unknowns are these.
    fn value(&self, i: usize, jumps: &[f64]) -> f64 {
        match jumps.get(i) {
            Some(t) => *t,
            None => self.contact.rows.value(i - jumps.len(), jumps),
        }
    }

    fn gap_round_off(&self, i: usize, linear: &Linear) -> f64 {
        let m = self.contact.c.len();
        let size = match i < m {
            true => 1.0,
            false => self.contact.rows.size(i - m).max(1.0),
        };
        let jumps = linear.jumps.iter();
        let largest = jumps.fold(self.contact.scale, |m, t| m.max(t.abs()));
        GAP_TOLERANCE * largest * size
    }

    fn force_round_off(&self, i: usize, linear: &Linear) -> f64 {
        let m = self.contact.c.len();
        let scale = match i < m {
            true => self.contact.scale_of(i, &linear.jumps),
            false => {
                let row = self.contact.rows.row(i - m).iter();
                let scales = row.map(|&(j, c)| c.abs() * self.contact.scale_of(j, &linear.jumps));
                scales.sum()
            }
        };
        FORCE_TOLERANCE * scale
    }
}

#[cfg(test)]
mod tests;
