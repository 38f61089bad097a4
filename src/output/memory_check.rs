//! Whether the hosts have the memory that a run needs, asked before it is allocated.

use std::collections::BTreeMap;

use crate::comm::Comm;
use crate::error::Failure;
use crate::output::memory::available_memory_bytes;
use crate::plan::cost::CostEstimate;

/// Share of the estimate that is needed for certain.
const CERTAIN: f64 = 0.7;

/// What a host has, and what its ranks need.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Host {
    available: f64,
    needed: f64,
    ranks: usize,
}

/// Refuses a run for which a host has too little memory, limits of control groups among it; each of
/// its ranks has one of `costs`. Returns what the hosts have together, on the root (bytes).
/// Collective.
///
/// # Errors
/// The first host with too little.
pub fn afford(comm: &Comm, costs: &[CostEstimate]) -> Result<f64, Failure> {
    // Where the system doesn't tell, nothing is refused.
    let available = available_memory_bytes().map_or(f64::INFINITY, |bytes| bytes as f64);
    let mut hosts: BTreeMap<String, Host> = BTreeMap::new();
    let ranks = comm.collect(&(comm.host_name(), available));
    for ((name, available), cost) in ranks.into_iter().zip(costs) {
        let host = hosts.entry(name).or_default();
        host.available = available;
        host.needed += cost.bytes;
        host.ranks += 1;
    }
    comm.agree(check(&hosts))?;
    Ok(hosts.values().map(|host| host.available).sum())
}

fn check(hosts: &BTreeMap<String, Host>) -> Result<(), Failure> {
    let gigabytes = |bytes: f64| bytes / 1e9;
    match hosts
        .iter()
        .find(|(_, host)| CERTAIN * host.needed > host.available)
    {
        None => Ok(()),
        Some((name, host)) => Err(Failure::internal(format!(
            "the {} ranks on '{name}' need about {:.1} GB of memory, and {:.1} GB are available there; \
             expected more memory or more machines",
            host.ranks,
            gigabytes(host.needed),
            gigabytes(host.available)
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_host_with_too_little_memory_is_named() {
        let host = |available: f64, needed: f64| Host {
            available,
            needed,
            ranks: 4,
        };
        let of = |second: Host| {
            let all = [("first", host(8e9, 6e9)), ("second", second)];
            check(&all.map(|(name, host)| (name.to_string(), host)).into())
        };
        assert!(of(host(8e9, 9e9)).is_ok());
        assert!(of(host(f64::INFINITY, 9e12)).is_ok());
        let refused = of(host(8e9, 16e9)).unwrap_err().message;
        for words in ["4 ranks on 'second'", "16.0 GB", "8.0 GB"] {
            assert!(refused.contains(words), "{refused}");
        }
    }
}
