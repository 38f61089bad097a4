//! How much memory this process has needed, and how much it may have.

use std::fs::read_to_string;
use std::path::{Path, PathBuf};

/// Peak resident memory of this process (bytes); 0 where the system doesn't tell.
pub fn peak_memory_bytes() -> u64 {
    read_to_string("/proc/self/status")
        .ok()
        .and_then(|status| high_water_mark(&status))
        .unwrap_or(0)
}

/// What the machine has left, or what the control groups that this process is in allow, if that is
/// less (bytes); `None` where the system doesn't tell.
pub fn available_memory_bytes() -> Option<u64> {
    let left = read_to_string("/proc/meminfo")
        .ok()
        .and_then(|meminfo| kibibytes(&meminfo, "MemAvailable:"));
    let groups = read_to_string("/proc/self/cgroup").unwrap_or_default();
    let limits = limit_files(&groups);
    // A group without a limit says "max", or a number that no machine has.
    let limits = limits
        .iter()
        .filter_map(|file| read_to_string(file).ok()?.trim().parse().ok());
    limits.chain(left).min()
}

/// The files with the limits of the control groups that `/proc/self/cgroup` names, and of those above
/// them, of version 1 and 2.
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

/// The high-water mark in Linux' `/proc/self/status` (bytes).
fn high_water_mark(status: &str) -> Option<u64> {
    kibibytes(status, "VmHWM:")
}

/// The entry `name` of a list of Linux' (bytes).
fn kibibytes(list: &str, name: &str) -> Option<u64> {
    let line = list.lines().find_map(|line| line.strip_prefix(name))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_high_water_mark_counts_kibibytes() {
        let status = "Name:\tsolver\nVmPeak:\t  9000 kB\nVmHWM:\t    1234 kB\nVmRSS:\t 7 kB\n";
        assert_eq!(high_water_mark(status), Some(1234 * 1024));
        assert_eq!(high_water_mark("VmHWM:\tmany kB\n"), None);
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
}
