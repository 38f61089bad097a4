//! Loads of one kind, by place: as steps add to them, replace them and let them go on.

use std::collections::BTreeMap;

use super::amplitude::{Amplitude, Moment};
use crate::mesh::abaqus::LinePlace;

/// Amplitudes by name in capitals.
pub(super) type Amplitudes = BTreeMap<String, Amplitude>;

/// A line of data of a step: where it stands, its step, counted from 1, and the name of its amplitude in capitals.
#[derive(Clone)]
pub(super) struct Origin {
    pub(super) place: LinePlace,
    pub(super) step: usize,
    pub(super) amplitude: Option<String>,
}

/// Values at one place that add up.
#[derive(Clone)]
struct Entry {
    origin: Origin,
    values: Vec<(f64, Option<String>)>,
}

/// Values by place.
#[derive(Clone)]
pub(super) struct Table<K>(BTreeMap<K, Entry>);

impl<K> Default for Table<K> {
    fn default() -> Self {
        Self(BTreeMap::new())
    }
}

impl<K: Ord + Clone> Table<K> {
    /// Gives a place its value, in place of any other.
    pub(super) fn set(&mut self, key: K, value: f64, origin: &Origin) {
        let values = vec![(value, origin.amplitude.clone())];
        let origin = origin.clone();
        self.0.insert(key, Entry { origin, values });
    }

    /// Adds to what the same step gave a place, and replaces what steps before it did.
    pub(super) fn add(&mut self, key: K, value: f64, origin: &Origin) {
        match self.0.get_mut(&key) {
            Some(entry) if entry.origin.step == origin.step => {
                entry.values.push((value, origin.amplitude.clone()));
            }
            _ => self.set(key, value, origin),
        }
    }

    /// Forgets what came before a step.
    pub(super) fn begin(&mut self, step: usize) {
        self.forget(step, |_| true);
    }

    /// Forgets what came before a step at places that a load of it `replaces`.
    pub(super) fn forget(&mut self, step: usize, replaces: impl Fn(&K) -> bool) {
        self.0
            .retain(|key, entry| entry.origin.step == step || !replaces(key));
    }

    /// The values at a moment, and where they come from.
    pub(super) fn at(&self, amplitudes: &Amplitudes, moment: Moment) -> BTreeMap<K, f64> {
        let values = self.0.iter();
        values
            .map(|(key, entry)| {
                let parts = entry.values.iter().map(|(value, amplitude)| {
                    let amplitude = amplitude.as_ref().and_then(|name| amplitudes.get(name));
                    value * amplitude.map_or(1.0, |amplitude| amplitude.at(moment))
                });
                (key.clone(), parts.sum())
            })
            .collect()
    }

    /// The first value whose amplitude isn't linear between two moments of a step.
    pub(super) fn bend(
        &self,
        amplitudes: &Amplitudes,
        from: Moment,
        to: Moment,
    ) -> Option<LinePlace> {
        let bends = |name: &Option<String>| {
            let amplitude = name.as_ref().and_then(|name| amplitudes.get(name));
            amplitude.is_some_and(|amplitude| amplitude.bends(from, to))
        };
        let mut entries = self.0.values();
        let bent = entries.find(|entry| entry.values.iter().any(|(_, name)| bends(name)));
        bent.map(|entry| entry.origin.place)
    }

    /// Holds what amplitudes over the time of a step are at its end.
    pub(super) fn hold(&mut self, amplitudes: &Amplitudes, end: Moment) {
        for entry in self.0.values_mut() {
            for (value, name) in &mut entry.values {
                let amplitude = name.as_ref().and_then(|name| amplitudes.get(name));
                if let Some(amplitude) = amplitude.filter(|amplitude| !amplitude.is_total) {
                    *value *= amplitude.at(end);
                    *name = None;
                }
            }
        }
    }

    /// Place of the line that gives the value of a key.
    pub(super) fn place(&self, key: &K) -> Option<LinePlace> {
        self.0.get(key).map(|entry| entry.origin.place)
    }
}
