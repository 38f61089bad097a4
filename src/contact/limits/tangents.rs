//! The limits of tangential jumps, with the strength of all conditions that share them.

use std::collections::BTreeMap;

use super::{Limits, OtherTangent, TangentialLimit};
use crate::contact::shared_jump::Sharer;
use crate::contact::tangent::{TangentialCondition, with_other};

impl Limits {
    /// The limits of these tangential conditions, some of whose slips are `prescribed`.
    pub(super) fn tangents_of(
        &self,
        friction: &[TangentialCondition],
        prescribed: impl Fn(usize) -> Option<f64>,
    ) -> Vec<TangentialLimit> {
        let of_condition: BTreeMap<usize, (usize, f64)> = (self.tightest.iter().enumerate())
            .map(|(limit, &(condition, factor))| (condition, (limit, factor)))
            .collect();
        let other_tangent = |other: usize| match (of_condition.get(&other), prescribed(other)) {
            (Some(&(limit, _)), _) => OtherTangent::Limit(limit),
            (None, Some(slip)) if slip != 0.0 => OtherTangent::Prescribed(slip),
            _ => OtherTangent::Nothing,
        };
        let bound_of = |sharer: &Sharer| {
            let place = friction.binary_search_by_key(&sharer.condition, |one| one.number);
            let tangential = &friction[place.ok()?];
            Some((tangential.normal, tangential.bound))
        };
        let mut tangents: Vec<TangentialLimit> = with_other(friction)
            .filter_map(|(tangential, other)| {
                let normal = self.limit_of(tangential.normal, &of_condition);
                let (limit, _) = *of_condition.get(&tangential.number)?;
                let (mut bound, own) = (tangential.bound, tangential.bound.coefficient);
                // Differences from its own coefficient, so that equal ones keep their bits.
                let mut part = self.part_of(tangential.normal, normal);
                let mut beside = 0.0;
                for (normal, other) in self.shared.of_jump(limit).filter_map(bound_of) {
                    let of_other = self.part_of(normal, self.limit_of(normal, &of_condition));
                    part += of_other;
                    beside += (other.coefficient - own) * of_other;
                    bound.cohesion += other.cohesion;
                }
                bound.coefficient = own * part + beside;
                Some(TangentialLimit {
                    limit,
                    normal: normal.map(|(limit, _)| limit),
                    bound,
                    other: other.map_or(OtherTangent::Nothing, other_tangent),
                })
            })
            .collect();
        tangents.sort_by_key(|tangent| tangent.limit);
        tangents
    }

    /// The limit whose force a normal condition carries, alone or with others, and its factor.
    fn limit_of(
        &self,
        normal: usize,
        of_condition: &BTreeMap<usize, (usize, f64)>,
    ) -> Option<(usize, f64)> {
        let of_sharer = self.shared.of_condition(normal);
        let of_sharer = of_sharer.map(|sharer| (sharer.jump, sharer.factor));
        of_sharer.or_else(|| of_condition.get(&normal).copied())
    }

    /// The force of a normal condition per force of its `limit`.
    fn part_of(&self, normal: usize, limit: Option<(usize, f64)>) -> f64 {
        match (self.shared.of_condition(normal), limit) {
            (Some(sharer), _) => sharer.part,
            (None, Some((limit, factor))) => self.shared.rest(limit) / factor,
            (None, None) => 1.0,
        }
    }
}
