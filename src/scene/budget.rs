//! The memory that this process may use.

use std::sync::LazyLock;
use sysinfo::{MemoryRefreshKind, ProcessRefreshKind, ProcessesToUpdate, RefreshKind, System};

/// Assumed where the system does not tell its memory.
const UNKNOWN: u64 = 2 << 30;

/// The memory in bytes that this process may use: that of the machine, or less if a control group limits it (version 1
/// or 2, that of the process or that of the container).
pub fn process_bytes() -> usize {
    static BYTES: LazyLock<u64> = LazyLock::new(|| {
        let kinds = RefreshKind::nothing().with_memory(MemoryRefreshKind::nothing().with_ram());
        let Ok(mut system) = System::new_with_specifics(kinds) else { return UNKNOWN };
        let container = system.cgroup_limits().map(|limits| limits.total_memory);
        let group = sysinfo::get_current_pid().ok().and_then(|own| {
            let kind = ProcessRefreshKind::nothing().without_tasks();
            system.refresh_processes_specifics(ProcessesToUpdate::Some(&[own]), false, kind);
            system.process(own)?.cgroup_limits().map(|limits| limits.total_memory)
        });
        let all = [Some(system.total_memory()), container, group];
        all.into_iter().flatten().filter(|&bytes| bytes > 0).min().unwrap_or(UNKNOWN)
    });
    usize::try_from(*BYTES).unwrap_or(usize::MAX)
}

/// Parses a size in bytes: a number of at least 1, with a suffix K, M, G or T for powers of 1024, or none.
pub fn size(text: &str) -> Option<usize> {
    let digits = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let unit = match text[digits.len()..].to_ascii_lowercase().as_str() {
        "" | "b" => 0,
        "k" | "kb" | "kib" => 10,
        "m" | "mb" | "mib" => 20,
        "g" | "gb" | "gib" => 30,
        "t" | "tb" | "tib" => 40,
        _ => return None,
    };
    let plain = digits.bytes().all(|b| b.is_ascii_digit() || b == b'.');
    let bytes = digits.parse::<f64>().ok().filter(|_| plain)? * (1u64 << unit) as f64;
    (1.0..1e15).contains(&bytes).then_some(bytes as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_have_suffixes() {
        for (text, bytes) in [
            ("64M", Some(64 << 20)),
            ("2G", Some(2 << 30)),
            ("1.5k", Some(1536)),
            ("1t", Some(1 << 40)),
            ("512MiB", Some(512 << 20)),
            ("1000", Some(1000)),
            ("", None),
            ("0", None),
            ("M", None),
            ("-1M", None),
            ("1e3", None),
            ("9999T", None),
            ("64X", None),
            ("nan", None),
        ] {
            assert_eq!(size(text), bytes, "{text}");
        }
    }

    #[test]
    fn the_process_has_memory() {
        assert!(process_bytes() >= 1 << 20);
    }
}
