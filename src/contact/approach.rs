//! Approaches: contact conditions as bounds.
//!
//! A condition `b·v ≤ g` bounds the approach t = b·v of the two sides. Solving that equation for
//! one of its unknowns makes t an unknown in that one's place, so that a pair's problem has nothing
//! but bounds t ≤ g; t = 0 is the bilateral problem (16). Where more conditions meet than there are
//! directions, what is left of a condition is a combination of approaches.

use std::collections::HashMap;

/// Coefficients of unit normals are of order one; what elimination leaves of a condition that
/// depends on others is round-off.
const ROUND_OFF: f64 = 1e-10;

/// What a displacement is made of once the approaches are unknowns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Variable {
    /// A component of a node along an axis of its frame.
    Displacement(u32),
    /// The approach of a condition's two sides.
    Approach(u32),
}

/// constant + Σ coefficient·variable.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Affine {
    /// Constant (m): what supports prescribe.
    pub constant: f64,
    /// Terms, a variable once.
    pub terms: Vec<(Variable, f64)>,
}

/// The approach of two sides, b·v, in terms of a block's unknowns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ApproachRow {
    /// What supports contribute (m).
    pub constant: f64,
    /// Unknowns and coefficients.
    pub terms: Vec<(u32, f64)>,
}

impl Affine {
    fn add(&mut self, variable: Variable, coefficient: f64) {
        match self.terms.iter_mut().find(|(v, _)| *v == variable) {
            Some((_, c)) => *c += coefficient,
            None => self.terms.push((variable, coefficient)),
        }
    }

    /// This in terms of approaches alone, if it is so but for round-off.
    fn of_approaches(&self) -> Option<ApproachOf> {
        let mut terms = Vec::new();
        for &(variable, factor) in self.terms.iter().filter(|(_, c)| c.abs() > ROUND_OFF) {
            let Variable::Approach(number) = variable else {
                return None;
            };
            terms.push((number as usize, factor));
        }
        let constant = self.constant;
        Some(match terms[..] {
            [] => ApproachOf::Prescribed(constant),
            [(number, factor)] if factor > 0.0 => ApproachOf::Unknown {
                number,
                factor,
                constant,
            },
            _ => ApproachOf::Combination { terms, constant },
        })
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

/// Where the approach of a condition is found.
#[derive(Clone, Debug, PartialEq)]
pub enum ApproachOf {
    /// It is `factor`·t + `constant` of an unknown approach t, factor > 0. The condition whose
    /// unknown that is has 1 and 0; one that says the same again shares it.
    Unknown {
        /// Number of the approach.
        number: usize,
        /// Factor.
        factor: f64,
        /// Constant (m).
        constant: f64,
    },
    /// It is Σ factor·t + `constant` of several unknown approaches, or a negative multiple of one.
    Combination {
        /// Numbers of the approaches and factors.
        terms: Vec<(usize, f64)>,
        /// Constant (m).
        constant: f64,
    },
    /// Supports prescribe it on both sides (m).
    Prescribed(f64),
}

/// A condition that has unknowns on Γ alone, which can't be replaced: its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OnInterface(pub usize);

/// Approaches solved for one unknown each.
#[derive(Clone, Debug, Default)]
pub struct Approaches {
    /// The unknowns that the approaches replace, by number, in terms of those that stay.
    pub replaced: HashMap<u32, Affine>,
    /// Where the approach of each condition is found.
    pub of: Vec<ApproachOf>,
    /// Number of unknown approaches.
    pub len: usize,
}

impl Approaches {
    /// Solves each of `rows`, t = b·v, for one of its unknowns.
    ///
    /// `may_go` tells which unknowns may be replaced (not those on Γ, which other blocks share),
    /// `stiffness` how stiff the body is around them: the softer side follows the stiffer one, because
    /// a stiff side in terms of a soft one is a small difference of large forces.
    ///
    /// # Errors
    /// The first condition that lies on Γ.
    pub fn new(
        rows: &[ApproachRow],
        may_go: impl Fn(u32) -> bool,
        stiffness: impl Fn(u32) -> f64,
    ) -> Result<Self, OnInterface> {
        let mut uses: HashMap<u32, usize> = HashMap::new();
        for row in rows {
            for &(v, _) in &row.terms {
                *uses.entry(v).or_default() += 1;
            }
        }
        let mut approaches = Self::default();
        for (j, row) in rows.iter().enumerate() {
            if row.terms.is_empty() {
                approaches.of.push(ApproachOf::Prescribed(row.constant));
                continue;
            }
            let mut rest = Affine {
                constant: row.constant,
                terms: Vec::with_capacity(row.terms.len() + 1),
            };
            for &(v, c) in &row.terms {
                rest.add(Variable::Displacement(v), c);
            }
            for &(v, _) in &row.terms {
                if let Some(value) = approaches.replaced.get(&v) {
                    rest.substitute(Variable::Displacement(v), value);
                }
            }
            let own: Vec<u32> = row.terms.iter().map(|&(v, _)| v).collect();
            let nowhere_else = |v: u32| uses[&v] == 1 && own.contains(&v);
            let of = approaches
                .solve_for_one(rest, nowhere_else, &may_go, &stiffness)
                .ok_or(OnInterface(j))?;
            approaches.of.push(of);
        }
        Ok(approaches)
    }

    /// Solves t = `rest` for its best unknown, or finds that approaches which are unknowns already
    /// make it; `nowhere_else` tells which unknowns no other condition has.
    fn solve_for_one(
        &mut self,
        mut rest: Affine,
        nowhere_else: impl Fn(u32) -> bool,
        may_go: &impl Fn(u32) -> bool,
        stiffness: &impl Fn(u32) -> f64,
    ) -> Option<ApproachOf> {
        let candidates = rest.terms.iter().filter_map(|&(v, c)| match v {
            Variable::Displacement(v) if may_go(v) => Some((v, c)),
            _ => None,
        });
        let largest = candidates.clone().map(|(_, c)| c.abs()).fold(0.0, f64::max);
        if largest < ROUND_OFF {
            return rest.of_approaches();
        }
        let (pivot, coefficient) = candidates
            .filter(|(_, c)| c.abs() >= 0.5 * largest)
            .min_by(|&(v, _), &(w, _)| {
                (!nowhere_else(v))
                    .cmp(&!nowhere_else(w))
                    .then(stiffness(v).total_cmp(&stiffness(w)))
                    .then(v.cmp(&w))
            })?;
        let number = self.len;
        self.len += 1;
        rest.add(Variable::Approach(number as u32), -1.0);
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
        Some(ApproachOf::Unknown {
            number,
            factor: 1.0,
            constant: 0.0,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(terms: &[(u32, f64)], constant: f64) -> ApproachRow {
        ApproachRow {
            constant,
            terms: terms.to_vec(),
        }
    }

    /// b·v for v given by the unknowns that stay and the approaches `t`.
    fn approach(
        row: &ApproachRow,
        approaches: &Approaches,
        v: impl Fn(u32) -> f64,
        t: &[f64],
    ) -> f64 {
        let replaced = |a: &Affine| {
            let term = |&(variable, c): &(Variable, f64)| match variable {
                Variable::Displacement(i) => {
                    assert!(!approaches.replaced.contains_key(&i));
                    c * v(i)
                }
                Variable::Approach(j) => c * t[j as usize],
            };
            a.constant + a.terms.iter().map(term).sum::<f64>()
        };
        let value = |i: u32| approaches.replaced.get(&i).map_or_else(|| v(i), replaced);
        row.constant + row.terms.iter().map(|&(i, c)| c * value(i)).sum::<f64>()
    }

    #[test]
    fn a_chain_of_conditions_leaves_every_approach_what_it_is_called() {
        // 0 against 1, 1 against 2, 2 against 0 in another direction, 3 alone.
        let rows = vec![
            row(&[(0, 1.0), (1, -1.0)], 0.1),
            row(&[(1, 1.0), (2, -0.8), (5, 0.6)], 0.2),
            row(&[(2, 1.0), (0, 0.7), (5, -0.3)], -0.3),
            row(&[(3, -1.0)], 0.4),
        ];
        let approaches = Approaches::new(&rows, |_| true, |_| 1.0).unwrap();
        let t = [0.5, 0.25, 0.125, 2.0];
        for (row, t_j) in rows.iter().zip(t) {
            let v = |i: u32| (f64::from(i) + 1.0).sqrt();
            assert!((approach(row, &approaches, v, &t) - t_j).abs() < 1e-14);
        }
    }

    #[test]
    fn a_condition_given_twice_shares_its_approach() {
        let rows = [
            row(&[(0, 1.0), (1, -1.0)], 0.0),
            row(&[(0, 2.0), (1, -2.0)], 0.5),
        ];
        let approaches = Approaches::new(&rows, |_| true, |_| 1.0).unwrap();
        assert_eq!(approaches.len, 1);
        let shared = ApproachOf::Unknown {
            number: 0,
            factor: 2.0,
            constant: 0.5,
        };
        assert_eq!(approaches.of[1], shared);
    }

    #[test]
    fn a_condition_that_follows_from_two_others_is_their_combination() {
        let rows = [
            row(&[(0, 1.0), (1, -1.0)], 0.5),
            row(&[(1, 1.0), (2, -1.0)], 0.0),
            row(&[(0, 1.0), (2, -1.0)], 0.25),
        ];
        let approaches = Approaches::new(&rows, |_| true, |_| 1.0).unwrap();
        assert_eq!(approaches.len, 2);
        let ApproachOf::Combination { terms, constant } = &approaches.of[2] else {
            panic!("{:?}", approaches.of[2]);
        };
        let t = [0.3, 0.7];
        let value: f64 = terms.iter().map(|&(i, c)| c * t[i]).sum();
        let v = |i: u32| f64::from(i) + 2.0;
        let expected = approach(&rows[2], &approaches, v, &t);
        assert!((value + constant - expected).abs() < 1e-15);
    }

    #[test]
    fn a_condition_from_the_other_side_is_a_negative_multiple() {
        let rows = [row(&[(0, 1.0)], 0.0), row(&[(0, -1.0)], 0.5)];
        let approaches = Approaches::new(&rows, |_| true, |_| 1.0).unwrap();
        let opposite = ApproachOf::Combination {
            terms: vec![(0, -1.0)],
            constant: 0.5,
        };
        assert_eq!(approaches.of[1], opposite);
    }

    #[test]
    fn conditions_whose_normals_cancel_are_prescribed() {
        let rows = [
            row(&[(0, 1.0), (1, -1.0)], 0.0),
            row(&[(0, 1e-14), (1, -1e-14)], 0.5),
        ];
        let approaches = Approaches::new(&rows, |_| true, |_| 1.0).unwrap();
        assert_eq!(approaches.of[1], ApproachOf::Prescribed(0.5));
    }

    #[test]
    fn a_condition_on_the_interface_alone_is_refused() {
        let rows = [row(&[(0, 1.0), (1, -1.0)], 0.0), row(&[(0, 1.0)], 0.0)];
        let error = Approaches::new(&rows, |v| v != 0, |_| 1.0).unwrap_err();
        assert_eq!(error, OnInterface(1));
    }

    #[test]
    fn an_unknown_on_the_interface_stays() {
        let rows = [row(&[(0, 1.0), (1, -1.0)], 0.0)];
        let approaches = Approaches::new(&rows, |v| v != 0, |_| 1.0).unwrap();
        assert!(approaches.replaced.contains_key(&1));
    }

    #[test]
    fn the_softer_side_follows_the_stiffer_one() {
        let rows = [row(&[(0, 1.0), (1, -1.0)], 0.0)];
        for soft in [0, 1] {
            let stiffness = |v| if v == soft { 1.0 } else { 1e6 };
            let approaches = Approaches::new(&rows, |_| true, stiffness).unwrap();
            assert!(approaches.replaced.contains_key(&soft));
        }
    }
}
