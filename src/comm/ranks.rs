//! Work and times of each rank.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::comm::clock::Times;

/// Time that each phase of a run took, in seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PhaseSeconds {
    /// The whole run.
    pub total: f64,
    /// Reading the problem.
    pub read: f64,
    /// Assembling K and f.
    pub assemble: f64,
    /// Factorizing the subdomains and condensing them on Γ.
    pub factorize: f64,
    /// Assembling and factorizing the interface problem, and the bilateral start.
    pub interface: f64,
    /// All sweeps.
    pub sweeps: f64,
    /// Back-substitution, stresses and the certificate.
    pub recover: f64,
    /// Writing the results.
    pub write: f64,
}

impl PhaseSeconds {
    /// The phases by name, in the order of a run, without the total.
    pub fn phases(&self) -> [(&'static str, f64); 7] {
        [
            ("read", self.read),
            ("assemble", self.assemble),
            ("factorize", self.factorize),
            ("interface", self.interface),
            ("sweeps", self.sweeps),
            ("recover", self.recover),
            ("write", self.write),
        ]
    }

    /// The time of every phase on its slowest rank.
    pub fn slowest(ranks: &[Self]) -> Self {
        let worst = |of: fn(&Self) -> f64| ranks.iter().map(of).fold(0.0, f64::max);
        Self {
            total: worst(|seconds| seconds.total),
            read: worst(|seconds| seconds.read),
            assemble: worst(|seconds| seconds.assemble),
            factorize: worst(|seconds| seconds.factorize),
            interface: worst(|seconds| seconds.interface),
            sweeps: worst(|seconds| seconds.sweeps),
            recover: worst(|seconds| seconds.recover),
            write: worst(|seconds| seconds.write),
        }
    }
}

/// The phases of a rank, measured by three clocks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RankSeconds {
    /// Wall-clock time.
    pub elapsed: PhaseSeconds,
    /// Processor time, without messages and waiting.
    pub work: PhaseSeconds,
    /// Modelled time, on a core of its own and with the model network.
    pub modelled: PhaseSeconds,
}

impl RankSeconds {
    /// Adds times to a phase.
    pub fn add(&mut self, of: fn(&mut PhaseSeconds) -> &mut f64, times: Times) {
        *of(&mut self.elapsed) += times.elapsed;
        *of(&mut self.work) += times.work;
        *of(&mut self.modelled) += times.modelled;
    }
}

/// The report of a rank.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct RankReport {
    /// Time in each phase.
    #[serde(flatten)]
    pub seconds: PhaseSeconds,
    /// Processor time of each phase, without messages and waiting; with several threads, of the first one.
    pub work: PhaseSeconds,
    /// Modelled time of each phase with a core for each rank: its work, and messages over a network of 12.5 GB/s and 2
    /// µs.
    pub modelled: PhaseSeconds,
    /// Peak resident memory (bytes).
    pub peak_memory_bytes: u64,
    /// Bytes that it sent to other ranks, broadcasts counted once.
    pub bytes_sent: u64,
    /// Number of messages that it sent, broadcasts counted once.
    pub messages_sent: u64,
    /// Length of the critical path, in messages.
    pub longest_chain: u64,
    /// Number of subdomains that it owns.
    pub subdomains: usize,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_phase_is_that_of_the_rank_slowest_in_it() {
        let ranks = [(1.0, 5.0), (2.0, 4.0)].map(|(read, write)| PhaseSeconds {
            read,
            write,
            ..PhaseSeconds::default()
        });
        let slowest = PhaseSeconds::slowest(&ranks);
        assert_eq!((slowest.read, slowest.write), (2.0, 5.0));
    }
}
