//! How much memory this process has needed.

/// Peak resident memory of this process (bytes); 0 where the system doesn't tell.
pub fn peak_memory_bytes() -> u64 {
    std::fs::read_to_string("/proc/self/status")
        .ok()
        .and_then(|status| high_water_mark(&status))
        .unwrap_or(0)
}

/// The high-water mark in Linux' `/proc/self/status` (bytes).
fn high_water_mark(status: &str) -> Option<u64> {
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
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

    #[cfg(target_os = "linux")]
    #[test]
    fn memory_that_was_used_counts_after_it_is_freed() {
        let used = vec![1_u8; 64 << 20];
        std::hint::black_box(&used);
        drop(used);
        assert!(peak_memory_bytes() >= 64 << 20);
    }
}
