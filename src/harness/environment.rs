//! The program and the machine, for a run's provenance.

use super::warnings;
use crate::record::run::{DeviceRecord, Environment, Program};
use std::path::Path;
use sysinfo::{CpuRefreshKind, MemoryRefreshKind, RefreshKind, System};

/// Beginnings of the names of environment variables that change what is measured: the software rasteriser's and the
/// pool's threads, the choice of drivers and layers, the drivers' own switches.
const VARIABLES: [&str; 10] =
    ["LP_", "RAYON_", "VK_", "MESA_", "GALLIUM_", "GALLIVM_", "RADV_", "ANV_", "WGPU_", "RTBENCH_"];

/// The program's own packages that decide what a kernel becomes or what it is compared with.
const PACKAGES: [&str; 5] = ["wgpu", "naga", "glam", "obvhs", "rayon"];

/// Time of day, UTC, to the second, RFC 3339.
pub fn now() -> String {
    jiff::Timestamp::now().strftime("%Y-%m-%dT%H:%M:%SZ").to_string()
}

/// The same as a part of a folder's name.
pub fn now_for_file_name() -> String {
    jiff::Timestamp::now().strftime("%Y%m%dT%H%M%SZ").to_string()
}

/// Load average over 1, 5 and 15 minutes; zero where the system keeps none.
pub fn load_average() -> [f64; 3] {
    System::load_average().map(|load| [load.one, load.five, load.fifteen]).unwrap_or_default()
}

/// Describes the machine, and what of it, the program and the devices spoils times.
pub fn capture(program: &Program, devices: &[DeviceRecord]) -> Environment {
    let kinds =
        RefreshKind::nothing().with_cpu(CpuRefreshKind::nothing()).with_memory(MemoryRefreshKind::nothing().with_ram());
    let system = System::new_with_specifics(kinds).ok();
    let cpu = system.as_ref().and_then(|s| s.cpus().first().map(|c| c.brand().trim().to_owned()));
    let governor = std::fs::read_to_string("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor").ok();
    let mut environment = Environment {
        os: System::long_os_version().unwrap_or_else(|_| std::env::consts::OS.into()),
        kernel: System::kernel_version().unwrap_or_default(),
        architecture: std::env::consts::ARCH.into(),
        cpu: cpu.filter(|name| !name.is_empty()).unwrap_or_else(|| "unknown".into()),
        logical_cpus: std::thread::available_parallelism().map_or(1, usize::from),
        physical_cpus: System::physical_core_count().ok(),
        governor: governor.map(|g| g.trim().to_owned()),
        memory_bytes: system.as_ref().map_or(0, System::total_memory),
        load_average: load_average(),
        variables: std::env::vars_os()
            .filter_map(|(name, value)| Some((name.into_string().ok()?, value.to_string_lossy().into_owned())))
            .filter(|(name, _)| VARIABLES.iter().any(|start| name.starts_with(start)))
            .collect(),
        warnings: Vec::new(),
    };
    let found = warnings::find(program, &environment, devices, Path::new("/"));
    environment.warnings = found.iter().map(ToString::to_string).collect();
    environment
}

/// Describes the program, from what `build/main.rs` found.
pub fn program() -> Program {
    let lock = include_str!("../../Cargo.lock");
    Program {
        version: env!("CARGO_PKG_VERSION").into(),
        git_revision: env!("RTBENCH_GIT_REVISION").into(),
        git_dirty: env!("RTBENCH_GIT_DIRTY").parse().ok(),
        rustc: env!("RTBENCH_RUSTC").into(),
        profile: env!("RTBENCH_PROFILE").into(),
        target: env!("RTBENCH_TARGET").into(),
        lock_hash: blake3::hash(lock.as_bytes()).to_hex().to_string(),
        packages: PACKAGES.iter().filter_map(|&name| Some((name.into(), locked_version(lock, name)?))).collect(),
        executable_hash: executable_hash(),
    }
}

/// BLAKE3 of the running program's file.
fn executable_hash() -> Option<String> {
    let mut hasher = blake3::Hasher::new();
    hasher.update_reader(std::fs::File::open(std::env::current_exe().ok()?).ok()?).ok()?;
    Some(hasher.finalize().to_hex().to_string())
}

/// The version of one of our own dependencies in our `Cargo.lock`. Where others bring further versions of it, our entry
/// in the lock names the one that we use, as `name version`.
fn locked_version(lock: &str, name: &str) -> Option<String> {
    let package = |name: &str| lock.split("[[package]]").find(|text| text.contains(&format!("\nname = \"{name}\"\n")));
    let field = |text: &str, key: &str| {
        let line = text.lines().find_map(|line| line.strip_prefix(&format!("{key} = \"")))?;
        Some(line.trim_end_matches('"').to_string())
    };
    let ours = package(env!("CARGO_PKG_NAME"))?;
    let named = ours.lines().find_map(|line| line.trim().strip_prefix(&format!("\"{name} ")));
    match named {
        Some(rest) => Some(rest.trim_end_matches(',').trim_end_matches('"').split(' ').next()?.to_string()),
        None => field(package(name)?, "version"),
    }
}

/// For `--version`.
pub const VERSION: &str = concat!(
    env!("CARGO_PKG_VERSION"),
    " (revision ",
    env!("RTBENCH_GIT_REVISION"),
    ", changed since: ",
    env!("RTBENCH_GIT_DIRTY"),
    "; ",
    env!("RTBENCH_RUSTC"),
    "; ",
    env!("RTBENCH_PROFILE"),
    ")"
);

#[cfg(test)]
mod tests {
    use super::locked_version;

    #[test]
    fn the_version_that_we_use_is_recorded() {
        let lock = "[[package]]\nname = \"a\"\nversion = \"1.0.0\"\n\n[[package]]\nname = \"a\"\nversion = \"2.0.0\"\n\n\
                    [[package]]\nname = \"b\"\nversion = \"3.0.0\"\n\n\
                    [[package]]\nname = \"rtbench\"\nversion = \"0\"\ndependencies = [\n \"a 2.0.0\",\n \"b\",\n]\n";
        assert_eq!(locked_version(lock, "a").as_deref(), Some("2.0.0"));
        assert_eq!(locked_version(lock, "b").as_deref(), Some("3.0.0"));
        assert_eq!(locked_version(lock, "c"), None);
    }
}
