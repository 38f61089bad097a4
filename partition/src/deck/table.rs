//! Loads of one kind by key, where steps add, replace or keep them.

use std::collections::BTreeMap;

use super::amplitude::{Amplitude, DeckTime};
use crate::mesh::abaqus::LinePlace;

/// Amplitudes by name in capitals.
pub(super) type Amplitudes = BTreeMap<String, Amplitude>;

/// The origin of a value: its line, its step, counted from 1, and the name of its amplitude in capitals.
#[derive(Clone)]
pub(super) struct Origin {
    pub(super) place: LinePlace,
    pub(super) step: usize,
    pub(super) amplitude: Option<String>,
}

/// The values of one key, which add up.
#[derive(Clone)]
struct Entry {
    origin: Origin,
    values: Vec<(f64, Option<String>)>,
}

/// Values by key.
#[derive(Clone)]
pub(super) struct Table<K>(BTreeMap<K, Entry>);

impl<K> Default for Table<K> {
    fn default() -> Self {
        Self(BTreeMap::new())
    }
}

impl<K: Ord + Clone> Table<K> {
    /// Sets the value of a key, replacing any other.
    pub(super) fn set(&mut self, key: K, value: f64, origin: &Origin) {
        let values = vec![(value, origin.amplitude.clone())];
        let origin = origin.clone();
        self.0.insert(key, Entry { origin, values });
    }

    /// Adds a value to those of the same step, and replaces those of earlier steps.
    pub(super) fn add(&mut self, key: K, value: f64, origin: &Origin) {
        match self.0.get_mut(&key) {
            Some(entry) if entry.origin.step == origin.step => {
                entry.values.push((value, origin.amplitude.clone()));
            }
            _ => self.set(key, value, origin),
        }
    }

    /// Removes the values of earlier steps.
    pub(super) fn begin(&mut self, step: usize) {
        self.forget(step, |_| true);
    }

    /// Removes the values of earlier steps whose key a load of this step `replaces`.
    pub(super) fn forget(&mut self, step: usize, replaces: impl Fn(&K) -> bool) {
        self.0
            .retain(|key, entry| entry.origin.step == step || !replaces(key));
    }

    /// The values at a time.
    pub(super) fn at(&self, amplitudes: &Amplitudes, time: DeckTime) -> BTreeMap<K, f64> {
        let values = self.0.iter();
        values
            .map(|(key, entry)| {
                let parts = entry.values.iter().map(|(value, amplitude)| {
                    let amplitude = amplitude.as_ref().and_then(|name| amplitudes.get(name));
                    value * amplitude.map_or(1.0, |amplitude| amplitude.at(time))
                });
                (key.clone(), parts.sum())
            })
            .collect()
    }

    /// The first value whose amplitude isn't linear between two times of a step.
    pub(super) fn bend(
        &self,
        amplitudes: &Amplitudes,
        from: DeckTime,
        to: DeckTime,
    ) -> Option<LinePlace> {
        let bends = |name: &Option<String>| {
            let amplitude = name.as_ref().and_then(|name| amplitudes.get(name));
            amplitude.is_some_and(|amplitude| amplitude.bends(from, to))
        };
        let mut entries = self.0.values();
        let bent = entries.find(|entry| entry.values.iter().any(|(_, name)| bends(name)));
        bent.map(|entry| entry.origin.place)
    }

    /// Freezes amplitudes in step time at their value at the end of the step.
    pub(super) fn hold(&mut self, amplitudes: &Amplitudes, end: DeckTime) {
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

    /// The line that gives the value of a key.
    pub(super) fn place(&self, key: &K) -> Option<LinePlace> {
        self.0.get(key).map(|entry| entry.origin.place)
    }
}
