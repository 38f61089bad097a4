//! Comparison of a new record with an old one: worse scenes, and better ones.

use std::collections::BTreeMap;
use std::fmt::{self, Display, Formatter};

use super::super::trial::Verdict;
use super::{Key, Record, Row};

/// Ratio of sweeps or linear solves to the earlier ones, and least difference, from which on they count as more.
const TIMES_AS_MANY: f64 = 1.5;
const MORE: u64 = 5;
/// Target of the backward error.
const BACKWARD_ERROR: f64 = 1e-14;

/// A scene whose result changed: its key, and a description.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Change {
    pub key: Key,
    pub words: String,
}

/// Sums over the scenes of a suite, an operator and a law in both records.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Sums {
    scenes: usize,
    /// Numbers before and now.
    right: [usize; 2],
    unclear: [usize; 2],
    solves: [u64; 2],
    seconds: [f64; 2],
}

/// Two records, scene by scene.
#[derive(Clone, Debug, Default)]
pub struct Comparison {
    pub worse: Vec<Change>,
    pub better: Vec<Change>,
    /// Scenes missing in the new record, and scenes only there.
    pub missing: Vec<Key>,
    pub added: usize,
    sums: BTreeMap<[String; 3], Sums>,
}

impl Comparison {
    /// Compares a new record with an old one.
    pub fn new(old: &Record, new: &Record) -> Self {
        let added = new.rows.keys().filter(|key| !old.rows.contains_key(key));
        let mut comparison = Self {
            added: added.count(),
            ..Self::default()
        };
        for (key, before) in &old.rows {
            match new.rows.get(key) {
                Some(now) => comparison.add(key, before, now),
                None => comparison.missing.push(key.clone()),
            }
        }
        comparison
    }

    /// True if any scene is worse than before, or missing.
    pub fn is_worse(&self) -> bool {
        !(self.worse.is_empty() && self.missing.is_empty())
    }

    fn add(&mut self, key: &Key, before: &Row, now: &Row) {
        let change = |words: Vec<String>| {
            (!words.is_empty()).then(|| Change {
                key: key.clone(),
                words: words.join(", "),
            })
        };
        self.worse.extend(change(falls_short(before, now)));
        self.better.extend(change(falls_short(now, before)));
        let of = [&key.suite, &key.operator, &before.law].map(String::clone);
        let sums = self.sums.entry(of).or_default();
        sums.scenes += 1;
        for (k, row) in [before, now].into_iter().enumerate() {
            sums.right[k] += usize::from(row.verdict == Verdict::Right);
            sums.unclear[k] += usize::from(row.verdict == Verdict::Unclear);
            sums.solves[k] += row.counts.map_or(0, |[_, _, solves]| solves);
            sums.seconds[k] += row.seconds;
        }
    }
}

/// Rank of a verdict: no answer is better than a wrong one.
fn badness(verdict: Verdict) -> usize {
    match verdict {
        Verdict::Right => 0,
        Verdict::Unclear => 1,
        Verdict::NotConverged | Verdict::Refused => 2,
        Verdict::Hung => 3,
        Verdict::Wrong | Verdict::Differs | Verdict::Missed | Verdict::Crashed => 4,
    }
}

/// The respects in which one row is worse than another, with the better value first.
fn falls_short(good: &Row, bad: &Row) -> Vec<String> {
    let mut words = Vec::new();
    if badness(bad.verdict) > badness(good.verdict) {
        let exit = |row: &Row| row.exit.map_or("-".into(), |exit| exit.to_string());
        words.push(format!(
            "{} (exit {}) | {} (exit {})",
            good.verdict.name(),
            exit(good),
            bad.verdict.name(),
            exit(bad)
        ));
    } else if good.verdict != bad.verdict {
        // The counts of a worse answer don't matter.
        return words;
    }
    if let Some((good, bad)) = good.counts.zip(bad.counts) {
        for (k, name) in [(0, "sweeps"), (2, "linear solves")] {
            let many = bad[k] as f64 > TIMES_AS_MANY * good[k] as f64 && bad[k] >= good[k] + MORE;
            if many {
                words.push(format!("{name} {} | {}", good[k], bad[k]));
            }
        }
    }
    // A report leaves out numbers that aren't finite.
    let reported = |row: &Row| row.counts.map(|_| row.backward.unwrap_or(f64::INFINITY));
    if let Some((good, bad)) = reported(good).zip(reported(bad))
        && good <= BACKWARD_ERROR
        && bad > BACKWARD_ERROR
    {
        words.push(format!("backward error {good:.1e} | {bad:.1e}"));
    }
    words
}

impl Display for Sums {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let percent = |k: usize| 100.0 * self.right[k] as f64 / self.scenes.max(1) as f64;
        let ratio = |old: f64, new: f64| if old > 0.0 { new / old } else { 1.0 };
        let [old, new] = self.seconds;
        let [solved_old, solved_new] = self.solves.map(|solves| solves as f64);
        write!(
            f,
            "{:>6} {:>6} {:>7.2} {:>3} | {:>5} {:>7.2} {:>3} | {:>6.2} {:>6.2}",
            self.scenes,
            self.right[0],
            percent(0),
            self.unclear[0],
            self.right[1],
            percent(1),
            self.unclear[1],
            ratio(solved_old, solved_new),
            ratio(old, new)
        )
    }
}

impl Display for Comparison {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{:<44} scenes  right       %   ? | right       %   ? | solves   time",
            "suite, operator, law: before | now, ? unclear"
        )?;
        let mut total = Sums::default();
        for (of, sums) in &self.sums {
            writeln!(f, "{:<44} {sums}", of.join(" "))?;
            total.scenes += sums.scenes;
            for k in 0..2 {
                total.right[k] += sums.right[k];
                total.unclear[k] += sums.unclear[k];
                total.solves[k] += sums.solves[k];
                total.seconds[k] += sums.seconds[k];
            }
        }
        writeln!(f, "{:<44} {total}", "all")?;
        for (name, changes, order) in [
            ("worse", &self.worse, "before | now"),
            ("better", &self.better, "now | before"),
        ] {
            writeln!(f, "{name}: {} ({order})", changes.len())?;
            for Change { key, words } in changes {
                writeln!(f, "  {key}: {words}")?;
            }
        }
        writeln!(
            f,
            "missing in the new record: {}, added: {}",
            self.missing.len(),
            self.added
        )?;
        self.missing
            .iter()
            .try_for_each(|key| writeln!(f, "  {key}"))
    }
}
