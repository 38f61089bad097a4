//! `*AMPLITUDE`: a factor over time.

use super::axes::numbers;
use crate::error::InputError;
use crate::mesh::abaqus::{Block, Source};
use crate::name;

/// A factor over time, piecewise linear.
#[derive(Clone)]
pub(super) struct Amplitude {
    points: Vec<(f64, f64)>,
    /// True if its time is the total time of the deck, false for the time of the step.
    pub(super) is_total: bool,
}

/// A point in time, as step time and total time.
#[derive(Clone, Copy)]
pub(super) struct DeckTime {
    pub(super) in_step: f64,
    pub(super) total: f64,
}

impl Amplitude {
    pub(super) fn read(source: &Source, block: &Block) -> Result<Self, InputError> {
        let definition = block
            .parameter("DEFINITION")
            .unwrap_or("TABULAR")
            .to_uppercase();
        let value = block
            .parameter("VALUE")
            .unwrap_or("RELATIVE")
            .to_uppercase();
        let is_read = ["TABULAR", "SMOOTH STEP"].contains(&definition.as_str());
        if !is_read || value != "RELATIVE" || block.parameter("USER").is_some() {
            let message = format!(
                "*AMPLITUDE of DEFINITION={}, VALUE={} isn't read; expected a table of times and relative values",
                name::shown(&definition),
                name::shown(&value)
            );
            return Err(source.error(block.place, message));
        }
        let mut row = Vec::new();
        for data in &block.data {
            row.extend(numbers(source, data, "a time or a value of the amplitude")?);
        }
        if row.is_empty() || row.len() % 2 == 1 {
            let message = format!(
                "*AMPLITUDE has {} numbers; expected pairs of a time and a value",
                row.len()
            );
            return Err(source.error(block.place, message));
        }
        let points: Vec<(f64, f64)> = row.chunks(2).map(|pair| (pair[0], pair[1])).collect();
        if let Some(pair) = points.windows(2).find(|pair| pair[1].0 < pair[0].0) {
            let message = format!(
                "the time {} comes after {}; expected times that grow",
                pair[1].0, pair[0].0
            );
            return Err(source.error(block.place, message));
        }
        let is_total = block
            .parameter("TIME")
            .is_some_and(|time| time.to_uppercase().starts_with("TOTAL"));
        Ok(Self { points, is_total })
    }

    /// The value at a time; constant before the first and after the last point.
    pub(super) fn at(&self, at: DeckTime) -> f64 {
        let time = if self.is_total { at.total } else { at.in_step };
        let next = self.points.partition_point(|(at, _)| *at <= time);
        match (
            next.checked_sub(1).map(|last| self.points[last]),
            self.points.get(next),
        ) {
            (Some((t0, a0)), Some((t1, a1))) => a0 + (a1 - a0) * (time - t0) / (t1 - t0),
            (Some((_, last)), None) => last,
            (None, first) => first.map_or(0.0, |(_, value)| *value),
        }
    }

    /// True if it isn't linear between two times of the same step.
    pub(super) fn bends(&self, from: DeckTime, to: DeckTime) -> bool {
        let time = |at: DeckTime| {
            if self.is_total { at.total } else { at.in_step }
        };
        let (start, end) = (self.at(from), self.at(to));
        let (from, to) = (time(from), time(to));
        let within = self.points.iter().filter(|(at, _)| from < *at && *at < to);
        let chord = |at: f64| start + (end - start) * (at - from) / (to - from);
        within
            .into_iter()
            .any(|&(at, value)| (value - chord(at)).abs() > 1e-9 * (start.abs() + end.abs()))
    }
}
