//! Memory of this process: its peak, its limit, and whether the limit suffices.

use std::collections::BTreeMap;
use std::fs::read_to_string;
use std::path::{Path, PathBuf};

use super::cost::CostEstimate;
use crate::comm::{Comm, host_name};
use crate::error::Failure;

/// Peak resident memory of this process (bytes); 0 if the system doesn't report it.
pub fn peak_memory_bytes() -> u64 {
    read_to_string("/proc/self/status")
        .ok()
        .and_then(|status| kibibytes(&status, "VmHWM:"))
        .unwrap_or(0)
}

/// Memory available on the machine, or allowed by the control groups of this process if less (bytes); `None` if the
/// system doesn't report it.
pub fn available_memory_bytes() -> Option<u64> {
    let left = read_to_string("/proc/meminfo")
        .ok()
        .and_then(|meminfo| kibibytes(&meminfo, "MemAvailable:"));
    let groups = read_to_string("/proc/self/cgroup").unwrap_or_default();
    let limits = limit_files(&groups);
    // A group without a limit has "max", or a number larger than any machine's memory.
    let limits = limits
        .iter()
        .filter_map(|file| read_to_string(file).ok()?.trim().parse().ok());
    limits.chain(left).chain(address_space()).min()
}

/// Rest of the address space allowed to this process (`ulimit -v`), if limited (bytes).
fn address_space() -> Option<u64> {
    let limits = read_to_string("/proc/self/limits").ok()?;
    let limit = limit_of(&limits, "Max address space")?;
    let status = read_to_string("/proc/self/status").ok()?;
    Some(limit.saturating_sub(kibibytes(&status, "VmSize:")?))
}

/// The soft limit `name` in Linux' table of limits (bytes); `None` if unlimited.
fn limit_of(limits: &str, name: &str) -> Option<u64> {
    let line = limits.lines().find_map(|line| line.strip_prefix(name))?;
    line.split_whitespace().next()?.parse().ok()
}

/// The files with the limits of the control groups in `/proc/self/cgroup` and of their ancestors, of versions 1 and 2.
fn limit_files(groups: &str) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for line in groups.lines() {
        let mut fields = line.splitn(3, ':');
        let (_, Some(controllers), Some(group)) = (fields.next(), fields.next(), fields.next())
        else {
            continue;
        };
        let (root, name) = match controllers {
            "" => ("/sys/fs/cgroup", "memory.max"),
            list if list.split(',').any(|controller| controller == "memory") => {
                ("/sys/fs/cgroup/memory", "memory.limit_in_bytes")
            }
            _ => continue,
        };
        let above = Path::new(group.trim_start_matches('/')).ancestors();
        files.extend(above.map(|group| Path::new(root).join(group).join(name)));
    }
    files
}

/// The entry `name` of a Linux status table (bytes).
fn kibibytes(list: &str, name: &str) -> Option<u64> {
    let line = list.lines().find_map(|line| line.strip_prefix(name))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024)
}

/// Fraction of the estimate that is certainly needed.
pub const CERTAIN_SHARE: f64 = 0.8;
/// Fraction of the estimate that is most likely needed.
pub const LIKELY_SHARE: f64 = 1.0;

/// The memory of a host, and the need of its ranks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Host {
    available: f64,
    needed: f64,
    ranks: usize,
}

/// Refuses a run if a host has less memory, including limits of control groups, than this `share` of the estimated need
/// of its ranks, given by `costs`. Returns the memory of all hosts together, on the root (bytes). Collective.
///
/// # Errors
/// The first host with too little memory.
pub fn check_memory(comm: &Comm, costs: &[CostEstimate], share: f64) -> Result<f64, Failure> {
    // If the system doesn't report memory, nothing is refused.
    let available = available_memory_bytes().map_or(f64::INFINITY, |bytes| bytes as f64);
    let mut hosts: BTreeMap<String, Host> = BTreeMap::new();
    let ranks = comm.collect(&(host_name(), available));
    for ((name, available), cost) in ranks.into_iter().zip(costs) {
        let host = hosts.entry(name).or_default();
        host.available = available;
        host.needed += cost.bytes;
        host.ranks += 1;
    }
    comm.agree(check(&hosts, share))?;
    Ok(hosts.values().map(|host| host.available).sum())
}

fn check(hosts: &BTreeMap<String, Host>, share: f64) -> Result<(), Failure> {
    let gigabytes = |bytes: f64| bytes / 1e9;
    match hosts
        .iter()
        .find(|(_, host)| share * host.needed > host.available)
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
    fn the_high_water_mark_counts_kibibytes() {
        let status = "Name:\tsolver\nVmPeak:\t  9000 kB\nVmHWM:\t    1234 kB\nVmRSS:\t 7 kB\n";
        assert_eq!(kibibytes(status, "VmHWM:"), Some(1234 * 1024));
        assert_eq!(kibibytes("VmHWM:\tmany kB\n", "VmHWM:"), None);
    }

    #[test]
    fn control_groups_and_those_above_them_have_limits() {
        let groups = "12:cpu,cpuacct:/job\n4:memory:/slurm/job_7/step_0\n0::/user.slice\n";
        let files: Vec<String> = limit_files(groups)
            .iter()
            .map(|file| file.display().to_string())
            .collect();
        assert_eq!(
            files,
            [
                "/sys/fs/cgroup/memory/slurm/job_7/step_0/memory.limit_in_bytes",
                "/sys/fs/cgroup/memory/slurm/job_7/memory.limit_in_bytes",
                "/sys/fs/cgroup/memory/slurm/memory.limit_in_bytes",
                "/sys/fs/cgroup/memory/memory.limit_in_bytes",
                "/sys/fs/cgroup/user.slice/memory.max",
                "/sys/fs/cgroup/memory.max",
            ]
        );
    }

    #[test]
    fn a_limit_is_the_one_that_holds_now() {
        let limits = "Limit                     Soft Limit           Hard Limit           Units     \n\
                      Max resident set          unlimited            unlimited            bytes     \n\
                      Max address space         2048000              4096000              bytes     \n";
        assert_eq!(limit_of(limits, "Max address space"), Some(2_048_000));
        assert_eq!(limit_of(limits, "Max resident set"), None);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn this_machine_has_memory() {
        assert!(available_memory_bytes().unwrap() > 1 << 20);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn memory_that_was_used_counts_after_it_is_freed() {
        let used = vec![1_u8; 64 << 20];
        std::hint::black_box(&used);
        drop(used);
        assert!(peak_memory_bytes() >= 64 << 20);
    }

    #[test]
    fn a_host_with_too_little_memory_is_named() {
        let host = |available: f64, needed: f64| Host {
            available,
            needed,
            ranks: 4,
        };
        let of = |second: Host| {
            let all = [("first", host(8e9, 6e9)), ("second", second)];
            check(
                &all.map(|(name, host)| (name.to_string(), host)).into(),
                CERTAIN_SHARE,
            )
        };
        assert!(of(host(8e9, 9e9)).is_ok());
        assert!(of(host(f64::INFINITY, 9e12)).is_ok());
        let refused = of(host(8e9, 16e9)).unwrap_err().message;
        for words in ["4 ranks on 'second'", "16.0 GB", "8.0 GB"] {
            assert!(refused.contains(words), "{refused}");
        }
    }
}
