//! The limits of a pair: t ≤ g, D t ≤ d.

use serde::{Deserialize, Serialize};

use super::dependent::DependentConstraints;
use super::normal_jump::{NormalJumpOf, defining_conditions};

/// The bounds t ≤ g and D t ≤ d, and the conditions that they come from.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Limits {
    /// g of every normal jump, the tightest of its conditions, then d of every dependent one (m).
    #[serde(with = "crate::bytes")]
    pub bounds: Vec<f64>,
    /// D.
    pub rows: DependentConstraints,
    /// Which condition each bound is, and its factor.
    tightest: Vec<(usize, f64)>,
    /// The condition that each normal jump is the unknown of.
    pub defining: Vec<usize>,
    /// Number of conditions.
    pub conditions: usize,
    /// The largest displacement prescribed in the pair, initial gaps among them (m).
    pub scale: f64,
}

impl Limits {
    /// The bounds on `jumps` unknowns that conditions with these `gaps` make; `scale` bounds
    /// the displacements that are prescribed.
    pub fn new(jumps: usize, of: &[NormalJumpOf], gaps: &[f64], scale: f64) -> Self {
        let mut limits = Self {
            bounds: vec![f64::INFINITY; jumps],
            rows: DependentConstraints::default(),
            tightest: vec![(0, 1.0); jumps],
            defining: defining_conditions(of, jumps),
            conditions: of.len(),
            scale,
        };
        for (j, (of, gap)) in of.iter().zip(gaps).enumerate() {
            match of {
                &NormalJumpOf::Unknown { number, factor } => {
                    let bound = gap / factor;
                    if bound < limits.bounds[number] {
                        limits.bounds[number] = bound;
                        limits.tightest[number] = (j, factor);
                    }
                }
                NormalJumpOf::Combination(terms) => {
                    limits.rows.push(terms.clone());
                    limits.bounds.push(*gap);
                    limits.tightest.push((j, 1.0));
                }
                NormalJumpOf::Prescribed => {}
            }
        }
        limits
    }

    /// Number of normal jumps.
    pub fn jumps(&self) -> usize {
        self.bounds.len() - self.rows.len()
    }

    /// g − t, then d − D t, 0 for the rows of D that aren't `open`.
    pub(super) fn gaps(&self, t: &[f64], open: &[bool]) -> Vec<f64> {
        let m = t.len();
        let mut gaps: Vec<f64> = self.bounds.iter().zip(t).map(|(g, t)| g - t).collect();
        gaps.extend((0..self.rows.len()).map(|j| {
            let left = self.bounds[m + j] - self.rows.value(j, t);
            if open[m + j] { left.max(0.0) } else { 0.0 }
        }));
        gaps
    }

    /// The limits of several groups as those of one pair, whose normal jumps, linearly dependent constraints and
    /// conditions follow each other in the same order.
    pub fn join(groups: &[Self]) -> Self {
        let mut all = Self::default();
        let mut dependent = (Vec::new(), Vec::new());
        for group in groups {
            let m = group.jumps();
            let shifted =
                |&(condition, factor): &(usize, f64)| (all.conditions + condition, factor);
            let (own, rows) = group.tightest.split_at(m);
            all.rows.append(&group.rows, all.bounds.len());
            dependent.0.extend(&group.bounds[m..]);
            dependent.1.extend(rows.iter().map(shifted));
            all.bounds.extend(&group.bounds[..m]);
            all.tightest.extend(own.iter().map(shifted));
            all.defining
                .extend(group.defining.iter().map(|j| all.conditions + j));
            all.conditions += group.conditions;
            all.scale = all.scale.max(group.scale);
        }
        all.bounds.append(&mut dependent.0);
        all.tightest.append(&mut dependent.1);
        all
    }

    /// Forces of all conditions for those of the limits.
    pub fn forces(&self, of_limits: &[f64]) -> Vec<f64> {
        let mut forces = vec![0.0; self.conditions];
        for (force, &(condition, factor)) in of_limits.iter().zip(&self.tightest) {
            forces[condition] = force / factor;
        }
        forces
    }

    /// Which conditions are closed where these limits are `open`.
    pub fn closed(&self, open: &[bool]) -> Vec<bool> {
        let mut closed = vec![false; self.conditions];
        for (&(condition, _), open) in self.tightest.iter().zip(open) {
            closed[condition] = !open;
        }
        closed
    }

    /// Which limits are open where these conditions are `closed`, and what every closed one lacks of
    /// its bound when the conditions lack `missing`; 0 for the open ones.
    pub fn fixed(&self, closed: &[bool], missing: &[f64]) -> (Vec<bool>, Vec<f64>) {
        let of_condition = |&(condition, factor): &(usize, f64)| match closed[condition] {
            true => (false, missing[condition] / factor),
            false => (true, 0.0),
        };
        self.tightest.iter().map(of_condition).unzip()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unknown(number: usize, factor: f64) -> NormalJumpOf {
        NormalJumpOf::Unknown { number, factor }
    }

    fn limits(gap: f64) -> Limits {
        let combination = NormalJumpOf::Combination(vec![(0, 1.0), (1, -2.0)]);
        let of = [
            unknown(0, 1.0),
            combination,
            unknown(1, 1.0),
            unknown(1, 2.0),
        ];
        Limits::new(2, &of, &[gap, 2.5, 8.0, 6.0], 0.1)
    }

    #[test]
    fn the_tightest_condition_bounds_a_normal_jump() {
        let limits = limits(1.0);
        assert_eq!(limits.bounds, [1.0, 3.0, 2.5]);
        assert_eq!(limits.forces(&[7.0, 8.0, 9.0]), [7.0, 9.0, 0.0, 4.0]);
        assert_eq!(
            limits.closed(&[false, true, false]),
            [true, true, false, false]
        );
    }

    #[test]
    fn pairs_that_are_joined_keep_their_conditions() {
        let joined = Limits::join(&[limits(1.0), limits(2.0)]);
        assert_eq!(joined.bounds, [1.0, 3.0, 2.0, 3.0, 2.5, 2.5]);
        assert_eq!(joined.defining, [0, 2, 4, 6]);
        assert_eq!(joined.rows.row(1), [(2, 1.0), (3, -2.0)]);
        let forces = joined.forces(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        assert_eq!(forces, [1.0, 5.0, 0.0, 1.0, 3.0, 6.0, 0.0, 2.0]);
    }
}
