//! Jumps t = b·u: contact constraints B u ≤ g as bounds t ≤ g, and slips as tangential jumps.
//!
//! A condition `b·v ≤ g` bounds the normal jump t = b·v of the two sides, less the part that supports prescribe.
//! Solving that equation for one of its unknowns replaces this unknown by t, so that a pair's problem has only bounds t
//! ≤ g; t = 0 is the bilateral problem (16). With friction the tangential jumps become unknowns in the same manner.
//! Where more conditions meet than there are directions, a condition's remainder is a combination of other jumps.

use std::collections::{BTreeMap, HashMap};

/// Coefficients of unit normals are of order one; elimination reduces a condition that depends on others to round-off.
const ROUND_OFF: f64 = 1e-10;
/// Share of its largest coefficient below which a condition's remainder counts as nearly parallel to others.
const PARALLEL: f64 = 0.1;

/// Unknowns whose combination a displacement is once the jumps are unknowns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Variable {
    /// A component of a node along an axis of its frame.
    Displacement(u32),
    /// The jump of a condition's two sides.
    Jump(u32),
}

/// Σ coefficient·variable.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sum {
    /// The coefficient of every variable.
    pub terms: BTreeMap<Variable, f64>,
}

/// The jump of two sides, b·v: unknowns and coefficients.
pub type JumpRow = Vec<(u32, f64)>;

impl Sum {
    fn add(&mut self, variable: Variable, coefficient: f64) {
        *self.terms.entry(variable).or_default() += coefficient;
    }

    /// The largest coefficient of a displacement.
    fn largest_displacement(&self) -> f64 {
        let coefficient = |(variable, c): (&Variable, &f64)| match variable {
            Variable::Displacement(_) => c.abs(),
            Variable::Jump(_) => 0.0,
        };
        self.terms.iter().map(coefficient).fold(0.0, f64::max)
    }

    /// The sum in terms of jumps alone, if it contains no more up to round-off: unknown jumps, and the parts of the
    /// first `tied` jumps, which are known.
    fn of_jumps(&self, tied: usize) -> Option<(JumpOf, Vec<(usize, f64)>)> {
        let (mut terms, mut known) = (Vec::new(), Vec::new());
        for (&variable, &factor) in self.terms.iter().filter(|(_, c)| c.abs() > ROUND_OFF) {
            let Variable::Jump(number) = variable else {
                return None;
            };
            match (number as usize).checked_sub(tied) {
                Some(number) => terms.push((number, factor)),
                None => known.push((number as usize, factor)),
            }
        }
        let of = match terms[..] {
            [] => JumpOf::Prescribed,
            [(number, factor)] if factor > 0.0 => JumpOf::Unknown { number, factor },
            _ => JumpOf::Combination(terms),
        };
        Some((of, known))
    }

    /// Replaces `variable` by `value`.
    fn substitute(&mut self, variable: Variable, value: &Self) {
        let Some(factor) = self.terms.remove(&variable) else {
            return;
        };
        for (&v, c) in &value.terms {
            self.add(v, factor * c);
        }
    }
}

/// Relation of a condition's jump to the unknown jumps.
#[derive(Clone, Debug, PartialEq)]
pub enum JumpOf {
    /// `factor`·t of an unknown jump t, factor > 0. The condition that defines t has factor 1; an equivalent condition
    /// shares t.
    Unknown {
        /// Number of the jump.
        number: usize,
        /// Factor.
        factor: f64,
    },
    /// Σ factor·t of several unknown jumps, or a negative multiple of one: numbers and factors.
    Combination(Vec<(usize, f64)>),
    /// Prescribed by supports on both sides, or by ties whose jumps it combines.
    Prescribed,
    /// The known jump of a tie, by its number among ties.
    Tied(usize),
}

/// The condition that defines each of these `jumps` as an unknown.
pub fn defining_conditions(of: &[JumpOf], jumps: usize) -> Vec<usize> {
    let mut defining = vec![0; jumps];
    for (j, of) in of.iter().enumerate().rev() {
        if let JumpOf::Unknown {
            number,
            factor: 1.0,
        } = *of
        {
            defining[number] = j;
        }
    }
    defining
}

/// The number of a condition none of whose unknowns may be replaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoUnknown(pub usize);

/// Jumps solved for one unknown each.
#[derive(Clone, Debug, Default)]
pub struct Jumps {
    /// The unknown that each jump replaces.
    pub pivots: Vec<u32>,
    /// The replaced unknowns in terms of the remaining ones.
    pub replaced: BTreeMap<u32, Sum>,
    /// Relation of every condition's jump to the unknown ones.
    pub of: Vec<JumpOf>,
    /// The unknowns that the jumps of ties replace; these jumps are numbered before all others.
    pub tied: Vec<u32>,
    /// The known jumps contained in each condition: numbers and factors.
    pub known: BTreeMap<usize, Vec<(usize, f64)>>,
}

/// Predicate for the conditions of ties.
pub type IsTied<'a> = &'a dyn Fn(usize) -> bool;

/// A jump that replaced an unknown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OwnJump {
    /// An unknown of the contact problem, by its number among these unknowns.
    Unknown(usize),
    /// Jump of a tie, by its number among ties.
    Tied(usize),
}

impl Jumps {
    /// The jump of the variable with this number.
    pub fn own(&self, number: u32) -> OwnJump {
        let number = number as usize;
        match number.checked_sub(self.tied.len()) {
            Some(unknown) => OwnJump::Unknown(unknown),
            None => OwnJump::Tied(number),
        }
    }

    /// The condition of each tie's jump.
    pub fn tied_conditions(&self) -> Vec<usize> {
        let mut conditions = vec![0; self.tied.len()];
        for (j, of) in self.of.iter().enumerate() {
            if let JumpOf::Tied(number) = *of {
                conditions[number] = j;
            }
        }
        conditions
    }

    /// Subtracts the parts of known jumps from the bounds of conditions.
    pub fn subtract_known(&self, bounds: &mut [f64]) {
        let tied = self.tied_conditions();
        let values: Vec<f64> = tied.iter().map(|&j| bounds[j]).collect();
        for (&j, known) in &self.known {
            let sum: f64 = known.iter().map(|&(k, factor)| factor * values[k]).sum();
            bounds[j] -= sum;
        }
    }

    /// Solves each of `rows`, t = b·v, in their order, for one of its unknowns, the `tied` ones first, as the jumps of
    /// ties are known and may occur in others.
    ///
    /// `may_go` tells which unknowns may be replaced (not those that others share), `stiffness` how stiff the body is
    /// around them: the softer side follows the stiffer one, because a stiff side in terms of a soft one is a small
    /// difference of large forces. If rows depend on others, the nearly parallel ones come last, as combinations of
    /// these would have large factors.
    ///
    /// # Errors
    /// The first condition none of whose unknowns may be replaced.
    pub fn new(
        rows: &[JumpRow],
        tied: IsTied<'_>,
        may_go: impl Fn(u32) -> bool,
        stiffness: impl Fn(u32) -> f64,
    ) -> Result<Self, NoUnknown> {
        let as_given = Self::solve(rows, tied, 0.0, &may_go, &stiffness)?;
        let depends = |(j, of): (usize, &JumpOf)| match of {
            JumpOf::Combination(_) => true,
            JumpOf::Prescribed => tied(j) && !rows[j].is_empty(),
            JumpOf::Unknown { .. } | JumpOf::Tied(_) => false,
        };
        match as_given.of.iter().enumerate().any(depends) {
            true => Self::solve(rows, tied, PARALLEL, &may_go, &stiffness),
            false => Ok(as_given),
        }
    }

    /// Solves `rows`, last those that elimination reduces to less than a share `least` of their largest coefficient.
    fn solve(
        rows: &[JumpRow],
        tied: IsTied<'_>,
        least: f64,
        may_go: &impl Fn(u32) -> bool,
        stiffness: &impl Fn(u32) -> f64,
    ) -> Result<Self, NoUnknown> {
        let mut uses: HashMap<u32, usize> = HashMap::new();
        for row in rows {
            for &(v, _) in row {
                *uses.entry(v).or_default() += 1;
            }
        }
        let mut jumps = Self {
            of: vec![JumpOf::Prescribed; rows.len()],
            ..Self::default()
        };
        let of_kind = |is_tied: bool| -> Vec<usize> {
            let all = 0..rows.len();
            all.filter(|&j| !rows[j].is_empty() && tied(j) == is_tied)
                .collect()
        };
        for is_tied in [true, false] {
            let mut waiting = of_kind(is_tied);
            for least in [least, 0.0] {
                for j in std::mem::take(&mut waiting) {
                    let terms = &rows[j];
                    let rest = jumps.remainder(&rows[j]);
                    let largest = terms.iter().fold(0.0, |m: f64, (_, c)| m.max(c.abs()));
                    if rest.largest_displacement() < least * largest {
                        waiting.push(j);
                        continue;
                    }
                    let elsewhere =
                        |v: u32| uses[&v] - usize::from(terms.iter().any(|&(own, _)| own == v));
                    let found = jumps.solve_for_one(rest, is_tied, elsewhere, may_go, stiffness);
                    let (of, known) = found.ok_or(NoUnknown(j))?;
                    jumps.of[j] = of;
                    if !known.is_empty() {
                        jumps.known.insert(j, known);
                    }
                }
            }
        }
        Ok(jumps)
    }

    /// A condition's jump in terms of the unknowns not replaced so far.
    fn remainder(&self, row: &JumpRow) -> Sum {
        let mut rest = Sum::default();
        for &(v, c) in row {
            rest.add(Variable::Displacement(v), c);
        }
        for &(v, _) in row {
            if let Some(value) = self.replaced.get(&v) {
                rest.substitute(Variable::Displacement(v), value);
            }
        }
        rest
    }

    /// Solves t = `rest` for its best unknown, or expresses it by jumps that are unknowns already. The best unknown
    /// occurs in the fewest other conditions, which `elsewhere` counts: it is replaced there, too, and conditions
    /// solved for widely shared unknowns would all end up with the unknowns of all others.
    fn solve_for_one(
        &mut self,
        mut rest: Sum,
        is_tied: bool,
        elsewhere: impl Fn(u32) -> usize,
        may_go: &impl Fn(u32) -> bool,
        stiffness: &impl Fn(u32) -> f64,
    ) -> Option<(JumpOf, Vec<(usize, f64)>)> {
        let candidates = rest.terms.iter().filter_map(|(&v, &c)| match v {
            Variable::Displacement(v) if may_go(v) => Some((v, c)),
            _ => None,
        });
        let largest = candidates.clone().map(|(_, c)| c.abs()).fold(0.0, f64::max);
        if largest < ROUND_OFF {
            return rest.of_jumps(self.tied.len());
        }
        let (pivot, coefficient) = candidates
            .filter(|(_, c)| c.abs() >= 0.5 * largest)
            .min_by(|&(v, _), &(w, _)| {
                (elsewhere(v).cmp(&elsewhere(w)))
                    .then(stiffness(v).total_cmp(&stiffness(w)))
                    .then(v.cmp(&w))
            })?;
        let own = match is_tied {
            true => JumpOf::Tied(self.tied.len()),
            false => JumpOf::Unknown {
                number: self.pivots.len(),
                factor: 1.0,
            },
        };
        rest.add(
            Variable::Jump((self.tied.len() + self.pivots.len()) as u32),
            -1.0,
        );
        match is_tied {
            true => self.tied.push(pivot),
            false => self.pivots.push(pivot),
        }
        let eliminated = Variable::Displacement(pivot);
        rest.terms
            .retain(|&v, c| v != eliminated && c.abs() > 1e-15);
        rest.terms.values_mut().for_each(|c| *c /= -coefficient);
        if elsewhere(pivot) > 0 {
            for other in self.replaced.values_mut() {
                other.substitute(eliminated, &rest);
            }
        }
        self.replaced.insert(pivot, rest);
        Some((own, Vec::new()))
    }
}

#[cfg(test)]
mod tests;
