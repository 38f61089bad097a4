//! Table of times over the ranks.

use crate::comm::ranks::{PhaseSeconds, RankReport};

/// The time of each phase over the ranks, and its fraction of the mean total.
pub(super) fn lines(ranks: &[RankReport]) -> Vec<String> {
    let seconds: Vec<PhaseSeconds> = ranks.iter().map(|rank| rank.seconds).collect();
    let totals: Vec<f64> = seconds.iter().map(|rank| rank.total).collect();
    let total = Spread::of(&totals);
    let mut lines = vec!["seconds            min        mean         max    share".to_owned()];
    for (p, (name, _)) in PhaseSeconds::default().phases().into_iter().enumerate() {
        let phase: Vec<f64> = seconds.iter().map(|rank| rank.phases()[p].1).collect();
        lines.push(Spread::of(&phase).line(name, total.mean));
    }
    lines.push(total.line("total", total.mean));
    let memory = ranks.iter().map(|rank| rank.peak_memory_bytes);
    let mebibytes = |bytes: u64| bytes as f64 / f64::from(1 << 20);
    lines.push(format!(
        "memory      {:.0} MiB on all ranks, {:.0} MiB on the largest",
        mebibytes(memory.clone().sum()),
        mebibytes(memory.max().unwrap_or(0)),
    ));
    lines
}

/// Least, mean and largest of a time over the ranks.
struct Spread {
    min: f64,
    mean: f64,
    max: f64,
}

impl Spread {
    fn of(values: &[f64]) -> Self {
        let count = values.len().max(1) as f64;
        let max = values.iter().copied().fold(0.0, f64::max);
        Self {
            min: values.iter().copied().fold(max, f64::min),
            mean: values.iter().sum::<f64>() / count,
            max,
        }
    }

    fn line(&self, name: &str, whole: f64) -> String {
        let Self { min, mean, max } = self;
        let share = match whole > 0.0 {
            true => 100.0 * mean / whole,
            false => 0.0,
        };
        format!("{name:<10}  {min:>10.4}  {mean:>10.4}  {max:>10.4}  {share:>5.1} %")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_timing_table_spans_from_the_fastest_to_the_slowest_rank() {
        let rank = |factorize: f64| RankReport {
            seconds: PhaseSeconds {
                total: 8.0,
                factorize,
                ..PhaseSeconds::default()
            },
            peak_memory_bytes: 3 << 20,
            ..RankReport::default()
        };
        let table = lines(&[rank(1.0), rank(2.0), rank(6.0)]);
        let row = |name| {
            let row = table.iter().find(|line| line.starts_with(name)).unwrap();
            row.split_whitespace().skip(1).collect::<Vec<_>>().join(" ")
        };
        assert_eq!(row("factorize"), "1.0000 3.0000 6.0000 37.5 %");
        assert_eq!(row("total"), "8.0000 8.0000 8.0000 100.0 %");
        assert!(row("memory").starts_with("9 MiB on all ranks, 3 MiB"));
    }

    #[test]
    fn no_rank_and_no_time_print_no_nonsense() {
        let table = [lines(&[]), lines(&[RankReport::default()])]
            .concat()
            .concat();
        assert!(!table.contains("NaN") && !table.contains("inf"), "{table}");
    }
}
