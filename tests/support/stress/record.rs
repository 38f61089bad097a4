//! A record of the results of random scenes, a line of text each, to compare two programs.

pub mod comparison;

use std::collections::BTreeMap;
use std::fmt::{self, Display, Formatter};
use std::str::FromStr;

use super::friction::Law;
use super::trial::{Trial, Verdict};

/// Coefficient of friction up to which more scenes have to be right.
const USUAL: f64 = 0.5;
/// The columns of a line.
const COLUMNS: [&str; 12] = [
    "suite", "operator", "law", "seed", "verdict", "exit", "sweeps", "newton", "solves", "solver",
    "backward", "seconds",
];
/// The mark of a column without a value.
const NONE: &str = "-";

/// The key of a scene: its suite, the requested interface solver, and its seed.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Key {
    pub suite: String,
    pub operator: String,
    pub seed: u64,
}

/// The record of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// `none`, `given`, `coulomb<=0.5` or `coulomb`.
    pub law: String,
    pub verdict: Verdict,
    /// The exit code; `None` if the program hung or was killed.
    pub exit: Option<i32>,
    /// Sums over all load steps of a run with a report: sweeps, steps of Newton's method and linear problems solved.
    pub counts: Option<[u64; 3]>,
    /// The method, and the solver of contact conditions.
    pub solver: Option<String>,
    /// Equilibrium of the certificate.
    pub backward: Option<f64>,
    /// Time taken by the program (s).
    pub seconds: f64,
    /// Fallback methods, the program's message of a failure, and the reason for a verdict that isn't right.
    pub words: String,
}

/// All scenes of a record.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Record {
    pub rows: BTreeMap<Key, Row>,
}

/// The name of a law of friction; `None` is a scene without friction.
pub fn law_name(law: Option<Law>) -> &'static str {
    match law {
        None => "none",
        Some(Law::Given) => "given",
        Some(Law::Coulomb(most)) if most <= USUAL => "coulomb<=0.5",
        Some(Law::Coulomb(_)) => "coulomb",
    }
}

impl Row {
    /// The record of a trial with this law.
    pub fn new(law: Option<Law>, trial: &Trial) -> Self {
        let text = |key: &str| Some(trial.report.as_ref()?.get(key)?.as_str()?.to_owned());
        let count = |key: &str| Some(trial.reported(&[key])? as u64);
        let counts = ["sweeps", "active_set_iterations", "linear_solves"].map(count);
        let counts = match counts {
            [Some(sweeps), Some(newton), Some(solves)] => Some([sweeps, newton, solves]),
            _ => None,
        };
        let solver = text("method").zip(text("contact_operator"));
        let mut words = trial.listed("fallbacks").unwrap_or_default();
        words.push(trial.message.trim());
        words.push(trial.reason.trim());
        words.dedup();
        words.retain(|words| !words.is_empty());
        Self {
            law: law_name(law).into(),
            verdict: trial.verdict,
            exit: trial.exit,
            counts,
            solver: solver.map(|(method, operator)| format!("{method}/{operator}")),
            backward: trial.reported(&["certificate", "equilibrium"]),
            seconds: trial.seconds,
            words: words
                .join("; ")
                .split_whitespace()
                .collect::<Vec<_>>()
                .join(" "),
        }
    }
}

impl Record {
    /// The lines, in the order of suites, operators and seeds, below a line with the columns' names.
    pub fn to_text(&self) -> String {
        let head = COLUMNS.map(str::to_owned);
        let head = (head, "why".to_owned());
        let rows = self.rows.iter().map(|(key, row)| columns(key, row));
        let all: Vec<([String; 12], String)> = std::iter::once(head).chain(rows).collect();
        let width = |k: usize| all.iter().map(|(columns, _)| columns[k].len()).max();
        let widths: [usize; 12] = std::array::from_fn(|k| width(k).unwrap_or(0));
        let line = |(columns, words): &([String; 12], String)| {
            let padded = columns
                .iter()
                .zip(widths)
                .map(|(text, w)| format!("{text:<w$}"));
            let line = padded.collect::<Vec<_>>().join(" ") + " " + words;
            line.trim_end().to_owned() + "\n"
        };
        all.iter().map(line).collect()
    }
}

/// The columns of a row, and the words after them.
fn columns(key: &Key, row: &Row) -> ([String; 12], String) {
    fn or_none(value: Option<impl Display>) -> String {
        value.map_or(NONE.into(), |value| value.to_string())
    }
    let [sweeps, newton, solves] = [0, 1, 2].map(|k| or_none(row.counts.map(|counts| counts[k])));
    let columns = [
        key.suite.clone(),
        key.operator.clone(),
        row.law.clone(),
        key.seed.to_string(),
        row.verdict.name().replace(' ', "-"),
        or_none(row.exit),
        sweeps,
        newton,
        solves,
        or_none(row.solver.as_ref()),
        or_none(row.backward.map(|error| format!("{error:.1e}"))),
        format!("{:.2}", row.seconds),
    ];
    (columns, row.words.clone())
}

impl FromStr for Record {
    type Err = String;

    /// Reads the lines; those that begin with `#` and the one with the columns' names are skipped.
    fn from_str(text: &str) -> Result<Self, String> {
        let mut rows = BTreeMap::new();
        for (number, line) in text.lines().enumerate() {
            if line.is_empty() || line.starts_with('#') || line.starts_with(COLUMNS[0]) {
                continue;
            }
            let at = |why: String| format!("line {}: {why}", number + 1);
            let (key, row) = parsed(line).map_err(at)?;
            let name = key.to_string();
            if rows.insert(key, row).is_some() {
                return Err(at(format!("{name} is there twice")));
            }
        }
        Ok(Self { rows })
    }
}

/// A line.
fn parsed(line: &str) -> Result<(Key, Row), String> {
    let mut words = line.split_whitespace();
    let mut column = |name: &str| {
        let word = words.next();
        word.ok_or(format!(
            "there is no {name}; expected {}",
            COLUMNS.join(", ")
        ))
    };
    let [suite, operator, law] = [column("suite")?, column("operator")?, column("law")?];
    let seed = number("seed", column("seed")?)?;
    let verdict = column("verdict")?;
    let known = |v: &Verdict| v.name().replace(' ', "-") == verdict;
    let verdict = Verdict::ALL.into_iter().find(known);
    let verdict = verdict.ok_or(format!("no verdict is called that: {line}"))?;
    let exit = optional("exit", column("exit")?)?;
    let [sweeps, newton, solves] = [
        optional("sweeps", column("sweeps")?)?,
        optional("newton", column("newton")?)?,
        optional("solves", column("solves")?)?,
    ];
    let solver = Some(column("solver")?).filter(|&word| word != NONE);
    let backward = optional("backward", column("backward")?)?;
    let seconds = number("seconds", column("seconds")?)?;
    let key = Key {
        suite: suite.into(),
        operator: operator.into(),
        seed,
    };
    let row = Row {
        law: law.into(),
        verdict,
        exit,
        counts: sweeps.zip(newton).zip(solves).map(|((a, b), c)| [a, b, c]),
        solver: solver.map(str::to_owned),
        backward,
        seconds,
        words: words.collect::<Vec<_>>().join(" "),
    };
    Ok((key, row))
}

fn number<T: FromStr>(name: &str, word: &str) -> Result<T, String> {
    let wrong = |_| format!("`{word}` is no number of column {name}");
    word.parse().map_err(wrong)
}

fn optional<T: FromStr>(name: &str, word: &str) -> Result<Option<T>, String> {
    match word {
        NONE => Ok(None),
        _ => number(name, word).map(Some),
    }
}

impl Display for Key {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{} {} {}", self.suite, self.operator, self.seed)
    }
}
