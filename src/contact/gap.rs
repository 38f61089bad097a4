//! Gap variables: contact conditions as sign conditions.
//!
//! A condition `b·v ≤ g` is met by the slack s = g − b·v ≥ 0. Solving it for one of its unknowns
//! makes s an unknown in that one's place, so that a pair's problem has nothing but bounds s ≥ 0;
//! s = 0 is the bilateral problem (16).

use std::collections::HashMap;

/// What a displacement is made of once the gaps are unknowns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Variable {
    /// A component of a node along an axis of its frame.
    Displacement(u32),
    /// The slack of a condition.
    Gap(u32),
}

/// constant + Σ coefficient·variable.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Affine {
    /// Constant [m].
    pub constant: f64,
    /// Terms, a variable once.
    pub terms: Vec<(Variable, f64)>,
}

impl Affine {
    fn add(&mut self, variable: Variable, coefficient: f64) {
        match self.terms.iter_mut().find(|(v, _)| *v == variable) {
            Some((_, c)) => *c += coefficient,
            None => self.terms.push((variable, coefficient)),
        }
    }

    /// Puts `value` in the place of `variable`.
    fn substitute(&mut self, variable: Variable, value: &Self) {
        let Some(place) = self.terms.iter().position(|(v, _)| *v == variable) else {
            return;
        };
        let (_, factor) = self.terms.swap_remove(place);
        self.constant += factor * value.constant;
        for &(v, c) in &value.terms {
            self.add(v, factor * c);
        }
    }
}

/// Why a condition can't become a gap variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dependence {
    /// It follows from conditions before it: no unknown is left to solve it for.
    OnOthers,
    /// Both its sides are prescribed.
    Prescribed,
}

/// Conditions solved for one unknown each.
#[derive(Clone, Debug, Default)]
pub struct GapVariables {
    /// The unknowns that the gaps replace, by number, in terms of those that stay.
    pub replaced: HashMap<u32, Affine>,
}

impl GapVariables {
    /// Solves each of `conditions`, Σ coefficient·v ≤ gap, for one of its unknowns.
    ///
    /// `may_go` tells which unknowns may be replaced (not those on Γ, which other blocks share).
    ///
    /// # Errors
    /// The first condition that can't be solved, and why.
    pub fn new(
        conditions: &[(Vec<(u32, f64)>, f64)],
        may_go: impl Fn(u32) -> bool,
    ) -> Result<Self, (usize, Dependence)> {
        let mut uses: HashMap<u32, usize> = HashMap::new();
        for (row, _) in conditions {
            for &(v, _) in row {
                *uses.entry(v).or_default() += 1;
            }
        }
        let mut gaps = Self::default();
        for (j, (row, gap)) in conditions.iter().enumerate() {
            if row.is_empty() {
                return Err((j, Dependence::Prescribed));
            }
            let mut rest = Affine {
                constant: -gap,
                terms: Vec::with_capacity(row.len() + 1),
            };
            for &(v, c) in row {
                rest.add(Variable::Displacement(v), c);
            }
            for &(v, _) in row {
                if let Some(value) = gaps.replaced.get(&v) {
                    rest.substitute(Variable::Displacement(v), value);
                }
            }
            rest.add(Variable::Gap(j as u32), 1.0);
            let own: Vec<u32> = row.iter().map(|&(v, _)| v).collect();
            gaps.solve_for_one(j, rest, |v| uses[&v] == 1 && own.contains(&v), &may_go)?;
        }
        Ok(gaps)
    }

    /// Solves `rest` = 0 for its best unknown; `nowhere_else` tells which ones no other condition
    /// has.
    fn solve_for_one(
        &mut self,
        j: usize,
        mut rest: Affine,
        nowhere_else: impl Fn(u32) -> bool,
        may_go: &impl Fn(u32) -> bool,
    ) -> Result<(), (usize, Dependence)> {
        let candidates = rest.terms.iter().filter_map(|&(v, c)| match v {
            Variable::Displacement(v) if may_go(v) => Some((v, c)),
            _ => None,
        });
        let largest = candidates.clone().map(|(_, c)| c.abs()).fold(0.0, f64::max);
        // Coefficients of unit normals are of order one; what elimination leaves of a condition
        // that depends on others is round-off.
        if largest < 1e-10 {
            return Err((j, Dependence::OnOthers));
        }
        let Some((pivot, coefficient)) = candidates
            .filter(|(_, c)| c.abs() >= 0.5 * largest)
            .min_by_key(|&(v, _)| (!nowhere_else(v), v))
        else {
            return Err((j, Dependence::OnOthers));
        };
        let gone = Variable::Displacement(pivot);
        rest.terms.retain(|&(v, c)| v != gone && c.abs() > 1e-15);
        rest.constant /= -coefficient;
        for (_, c) in &mut rest.terms {
            *c /= -coefficient;
        }
        if !nowhere_else(pivot) {
            for other in self.replaced.values_mut() {
                other.substitute(gone, &rest);
            }
        }
        self.replaced.insert(pivot, rest);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Value of b·v for v given by `free` unknowns and the gaps.
    fn left_side(
        row: &[(u32, f64)],
        gaps: &GapVariables,
        v: impl Fn(u32) -> f64,
        s: &[f64],
    ) -> f64 {
        row.iter()
            .map(|&(i, c)| {
                let value = gaps.replaced.get(&i).map_or_else(
                    || v(i),
                    |a| {
                        a.constant
                            + a.terms
                                .iter()
                                .map(|&(t, c)| match t {
                                    Variable::Displacement(i) => {
                                        assert!(!gaps.replaced.contains_key(&i));
                                        c * v(i)
                                    }
                                    Variable::Gap(j) => c * s[j as usize],
                                })
                                .sum::<f64>()
                    },
                );
                c * value
            })
            .sum()
    }

    #[test]
    fn a_chain_of_conditions_leaves_every_slack_what_it_is_called() {
        // 0 against 1, 1 against 2, 2 against 0 in another direction, 3 alone.
        let conditions = vec![
            (vec![(0, 1.0), (1, -1.0)], 0.1),
            (vec![(1, 1.0), (2, -0.8), (5, 0.6)], 0.2),
            (vec![(2, 1.0), (0, 0.7), (5, -0.3)], -0.3),
            (vec![(3, -1.0)], 0.4),
        ];
        let gaps = GapVariables::new(&conditions, |_| true).unwrap();
        let s = [0.5, 0.25, 0.125, 2.0];
        for ((row, g), s_j) in conditions.iter().zip(s) {
            let v = |i: u32| (f64::from(i) + 1.0).sqrt();
            assert!((g - left_side(row, &gaps, v, &s) - s_j).abs() < 1e-14);
        }
    }

    #[test]
    fn a_condition_given_twice_is_recognised() {
        let condition = (vec![(0, 1.0), (1, -1.0)], 0.0);
        let error = GapVariables::new(&[condition.clone(), condition], |_| true).unwrap_err();
        assert_eq!(error, (1, Dependence::OnOthers));
    }

    #[test]
    fn an_unknown_on_the_interface_stays() {
        let gaps = GapVariables::new(&[(vec![(0, 1.0), (1, -1.0)], 0.0)], |v| v != 0).unwrap();
        assert!(gaps.replaced.contains_key(&1));
    }
}
