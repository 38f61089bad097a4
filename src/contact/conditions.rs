//! Conditions that bound one jump alike, as those of two nodes that a tie or an equation joins: all carry force, in
//! proportion to their areas, so that their pressures are equal; friction in proportion to their strengths.

use std::collections::BTreeMap;

use super::jumps::JumpOf;
use super::shared_jump::{SharedJumps, Sharer};
use super::tangent::TangentialCondition;

/// Relative difference of factors and of strengths below which they are equal.
const SAME: f64 = 1e-9;

/// A normal condition of a jump.
#[derive(Clone, Copy, Debug)]
struct Member {
    condition: usize,
    /// Its jump is this multiple of the jump.
    factor: f64,
}

/// A member with friction.
struct Rubbing<'a> {
    /// The bound of its tangential force: per force of the jump, and the constant part (N/m).
    strength: [f64; 2],
    tangents: Vec<&'a TangentialCondition>,
}

/// Conditions of a group as data for shared jumps.
#[derive(Clone, Copy, Debug)]
pub struct Conditions<'a> {
    /// The jump of each.
    pub of: &'a [JumpOf],
    /// The bound of each (m).
    pub gaps: &'a [f64],
    /// The area of the point of each (m, in space m²).
    pub areas: &'a [f64],
    /// The tangential ones.
    pub friction: &'a [TangentialCondition],
    /// The largest prescribed displacement (m).
    pub scale: f64,
    /// The round-off of the bound of each (m): bounds that differ by no more are equal.
    pub round_off: &'a [f64],
}

impl Conditions<'_> {
    /// The conditions that share the jumps which these define, and of every shared jump the condition that stands for its
    /// bound, with its factor.
    pub fn shared(&self, defining: &[usize]) -> (SharedJumps, BTreeMap<usize, (usize, f64)>) {
        let mut of_jumps: Vec<Vec<Member>> = vec![Vec::new(); defining.len()];
        for (condition, of) in self.of.iter().enumerate() {
            if let JumpOf::Unknown { number, factor } = *of
                && !self.is_tangential(condition)
            {
                of_jumps[number].push(Member { condition, factor });
            }
        }
        let (mut sharers, mut bearers) = (Vec::new(), BTreeMap::new());
        for (jump, all) in of_jumps.into_iter().enumerate() {
            if all.len() < 2 || self.is_tangential(defining[jump]) {
                continue;
            }
            let bound = |of: &Member| self.gaps[of.condition] / of.factor;
            let tightest = all.iter().min_by(|a, b| bound(a).total_cmp(&bound(b)));
            let Some(tightest) = tightest.copied() else {
                continue;
            };
            let round_off = |of: &Member| self.round_off[of.condition];
            let are_alike = |a: &Member, b: &Member| {
                (bound(a) - bound(b)).abs() <= round_off(a).max(round_off(b))
            };
            let mut bounding = all.into_iter();
            let Some(first) = bounding.find(|of| are_alike(of, &tightest)) else {
                continue;
            };
            let members: Vec<Member> = std::iter::once(first)
                .chain(bounding.filter(|of| are_alike(of, &first)))
                .collect();
            if members.len() == 1 {
                continue;
            }
            bearers.insert(jump, (first.condition, first.factor));
            let parts = self.parts(&members).into_iter().zip(&members).skip(1);
            sharers.extend(parts.map(|(part, other)| Sharer {
                jump,
                condition: other.condition,
                factor: other.factor,
                part,
                raise: other.factor * bound(&first) - self.gaps[other.condition],
            }));
            sharers.extend(self.slips(&members, defining).into_iter().flatten());
        }
        (SharedJumps(sharers), bearers)
    }

    /// The parts of the jump's force that members carry under one pressure.
    fn parts(&self, members: &[Member]) -> Vec<f64> {
        let weight = |of: &Member| of.factor * self.areas[of.condition];
        let total: f64 = members.iter().map(weight).sum();
        let part = |of: &Member| self.areas[of.condition] / total;
        members.iter().map(part).collect()
    }

    /// The tangential conditions that share slips, if the `members` with friction have one slip, under strengths in one
    /// proportion whatever the pressure is. Otherwise each has a limit of its own.
    fn slips(&self, members: &[Member], defining: &[usize]) -> Option<Vec<Sharer>> {
        let equal = |i: usize, j: usize| {
            (self.gaps[i] - self.gaps[j]).abs() <= self.round_off[i].max(self.round_off[j])
        };
        let same = |a: f64, b: f64| (a - b).abs() <= SAME * a.abs().max(b.abs());
        let mut rubbing: Vec<Rubbing<'_>> = Vec::new();
        for (part, member) in self.parts(members).into_iter().zip(members) {
            let tangents: Vec<&TangentialCondition> = self.tangential(member.condition).collect();
            if let Some(one) = tangents.first() {
                let strength = [part * one.bound.coefficient, one.bound.cohesion];
                rubbing.push(Rubbing { strength, tangents });
            }
        }
        let first = rubbing.first()?;
        let total = [0, 1].map(|k| rubbing.iter().map(|of| of.strength[k]).sum::<f64>());
        let one_law = |of: &Rubbing<'_>| {
            let [pressed, cohesive] = of.strength;
            of.tangents.len() == first.tangents.len()
                && of.tangents[0].bound.only_closed == first.tangents[0].bound.only_closed
                && same(pressed * total[1], cohesive * total[0])
        };
        if !rubbing.iter().all(one_law) {
            return None;
        }
        let kind = usize::from(total[0] == 0.0);
        let slip_of = |condition: usize| match self.of[condition] {
            JumpOf::Unknown { number, factor } if same(factor, 1.0) => Some(Some(number)),
            JumpOf::Prescribed => Some(None),
            _ => None,
        };
        let mut slips = Vec::new();
        for (k, tangent) in first.tangents.iter().enumerate() {
            let slip = slip_of(tangent.number)?;
            let conditions: Vec<usize> = rubbing.iter().map(|of| of.tangents[k].number).collect();
            let one_slip = |&j: &usize| slip_of(j) == Some(slip) && equal(j, tangent.number);
            if !conditions.iter().all(one_slip) {
                return None;
            }
            let Some(jump) = slip else { continue };
            let known = defining[jump];
            if !conditions.contains(&known) {
                return None;
            }
            for (&condition, of) in conditions.iter().zip(&rubbing) {
                if condition != known {
                    slips.push(Sharer {
                        jump,
                        condition,
                        factor: 1.0,
                        part: of.strength[kind] / total[kind],
                        raise: self.gaps[known] - self.gaps[condition],
                    });
                }
            }
        }
        Some(slips)
    }

    fn is_tangential(&self, j: usize) -> bool {
        self.friction
            .binary_search_by_key(&j, |tangential| tangential.number)
            .is_ok()
    }

    /// The tangential conditions of a normal one's point.
    fn tangential(&self, normal: usize) -> impl Iterator<Item = &TangentialCondition> {
        self.friction.iter().filter(move |one| one.normal == normal)
    }
}
