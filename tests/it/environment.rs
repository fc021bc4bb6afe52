//! What spoils times is found, each in a folder of fake system files; a quiet machine gives no warning.

use crate::fakes;
use rtbench::device::DeviceType;
use rtbench::harness::warnings::{self, Warning};
use rtbench::record::journal::Journal;
use rtbench::record::run::{DeviceRecord, Environment, Program};
use std::path::Path;
use std::process::Command;

/// Writes files below a folder.
fn write(root: &Path, files: &[(&str, &str)]) {
    for (path, text) in files {
        let path = root.join(path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, format!("{text}\n")).unwrap();
    }
}

/// A quiet machine of two processors with a GPU, and a release build.
fn quiet() -> (Program, Environment, Vec<DeviceRecord>, tempfile::TempDir) {
    let mut provenance = fakes::provenance();
    provenance.program.profile = "release".into();
    provenance.environment.logical_cpus = 2;
    provenance.devices[0].info.device_type = DeviceType::DiscreteGpu;
    let root = tempfile::tempdir().unwrap();
    write(
        root.path(),
        &[
            ("proc/self/cgroup", "0::/user.slice/app.scope"),
            ("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "performance"),
            ("sys/devices/system/cpu/cpu1/cpufreq/scaling_governor", "performance"),
            ("sys/devices/system/cpu/cpu0/thermal_throttle/core_throttle_count", "0"),
            ("sys/devices/system/cpu/cpufreq/boost", "1"),
            ("sys/class/power_supply/BAT0/type", "Battery"),
            ("sys/class/power_supply/BAT0/status", "Charging"),
            ("sys/fs/cgroup/user.slice/cpu.max", "max 100000"),
        ],
    );
    (provenance.program, provenance.environment, provenance.devices, root)
}

/// The warnings of the quiet machine with these files.
fn with_files(files: &[(&str, &str)]) -> Vec<Warning> {
    let (program, environment, devices, root) = quiet();
    write(root.path(), files);
    warnings::find(&program, &environment, &devices, root.path())
}

/// Checks that there is one warning, about this, with these words, and with something to do.
fn only(found: &[Warning], about: &str, words: &[&str]) {
    assert_eq!(found.iter().map(|warning| warning.about).collect::<Vec<_>>(), [about], "{found:?}");
    let text = found[0].to_string();
    assert!(words.iter().all(|word| text.contains(word)), "{text}");
    assert!(!found[0].hint.is_empty() && !text.contains('\n'));
}

#[test]
fn a_quiet_machine_gives_no_warning() {
    assert_eq!(with_files(&[]), []);
    // A system that tells nothing
    let (program, environment, devices, _) = quiet();
    let nowhere = tempfile::tempdir().unwrap();
    assert_eq!(warnings::find(&program, &environment, &devices, nowhere.path()), []);
}

#[test]
fn the_program_and_the_device_are_looked_at() {
    let (program, environment, devices, root) = quiet();
    let debug = Program { profile: "debug".into(), ..program.clone() };
    only(&warnings::find(&debug, &environment, &devices, root.path()), "build", &["debug", "--release"]);
    let busy = Environment { load_average: [1.5, 0.0, 0.0], ..environment.clone() };
    only(&warnings::find(&program, &busy, &devices, root.path()), "load", &["1.50", "2 processors"]);
    let mut checked = devices.clone();
    checked[0].info.checked = true;
    only(&warnings::find(&program, &environment, &checked, root.path()), "checks", &["--checked"]);
    for kind in [DeviceType::SoftwareRasteriser, DeviceType::CpuTwin] {
        let mut software = devices.clone();
        software[0].info.device_type = kind;
        only(&warnings::find(&program, &environment, &software, root.path()), "device", &["llvmpipe", "--adapter"]);
    }
    // Several at once
    let found = warnings::find(&debug, &busy, &checked, root.path());
    assert_eq!(found.iter().map(|warning| warning.about).collect::<Vec<_>>(), ["build", "load", "checks"]);
}

#[test]
fn the_system_is_looked_at() {
    let governor = ("sys/devices/system/cpu/cpu1/cpufreq/scaling_governor", "powersave");
    only(&with_files(&[governor]), "governor", &["powersave", "cpupower"]);
    let battery = ("sys/class/power_supply/BAT0/status", "Discharging");
    only(&with_files(&[battery]), "battery", &["power supply"]);
    let mouse = ("sys/class/power_supply/BAT0/scope", "Device");
    assert_eq!(with_files(&[battery, mouse]), [], "a mouse's battery");
    let heat = ("sys/devices/system/cpu/cpu0/thermal_throttle/core_throttle_count", "17");
    only(&with_files(&[heat]), "heat", &["17"]);
    let package = ("sys/devices/system/cpu/cpu1/thermal_throttle/package_throttle_count", "4");
    only(&with_files(&[package]), "heat", &["4 times"]);
    // A file of another form is no warning, and no panic
    assert_eq!(with_files(&[("sys/devices/system/cpu/cpu0/thermal_throttle/core_throttle_count", "many")]), []);
}

#[test]
fn control_groups_of_both_versions_are_looked_at() {
    // A limit of a parent holds as well
    let parent = ("sys/fs/cgroup/user.slice/cpu.max", "150000 100000");
    only(&with_files(&[parent]), "quota", &["1.50 processors"]);
    let lower = ("sys/fs/cgroup/user.slice/app.scope/cpu.max", "50000 100000");
    only(&with_files(&[parent, lower]), "quota", &["0.50 processors"]);
    // All processors that there are, no limit, nonsense
    for text in ["200000 100000", "max 100000", "", "a b", "100000 0", "-1 100000"] {
        assert_eq!(with_files(&[("sys/fs/cgroup/user.slice/cpu.max", text)]), [], "{text:?}");
    }
    let first = [
        ("proc/self/cgroup", "3:cpuset:/x\n2:cpu,cpuacct:/job\n1:memory:/other\n0::/"),
        ("sys/fs/cgroup/cpu,cpuacct/job/cpu.cfs_period_us", "100000"),
    ];
    let quota = |quota| ("sys/fs/cgroup/cpu,cpuacct/job/cpu.cfs_quota_us", quota);
    only(&with_files(&[first[0], first[1], quota("25000")]), "quota", &["0.25 processors"]);
    assert_eq!(with_files(&[first[0], first[1], quota("-1")]), []);
}

fn rtbench(arguments: &[&str]) -> std::process::Output {
    Command::new(env!("CARGO_BIN_EXE_rtbench")).args(arguments).output().unwrap()
}

#[test]
fn the_command_prints_what_a_run_records() {
    let out = tempfile::tempdir().unwrap();
    let folder = out.path().join("run");
    let sweep = "sweep --backend cpu --scene scan:triangles=3000 --structure bvh-stack --config P --resolution 8 \
                 --frames 1 --passes 1 --quiet --out";
    let arguments: Vec<&str> = sweep.split_whitespace().chain([folder.to_str().unwrap()]).collect();
    let run = rtbench(&arguments);
    assert_eq!(run.status.code(), Some(0), "{}", String::from_utf8_lossy(&run.stderr));
    let journal = Journal::read(&folder.join("journal.jsonl")).unwrap();
    let output = rtbench(&["env", "--backend", "cpu", "--format", "json"]);
    assert_eq!(output.status.code(), Some(0));
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let recorded = serde_json::to_value(&journal.provenance).unwrap();
    assert_eq!(json["program"], recorded["program"]);
    assert_eq!(json["devices"], recorded["devices"]);
    for field in ["os", "kernel", "cpu", "logical_cpus", "memory_bytes", "variables"] {
        assert_eq!(json["environment"][field], recorded["environment"][field], "{field}");
    }
    // The device computes on the CPU: both say so
    let about: Vec<&str> =
        json["warnings"].as_array().unwrap().iter().map(|warning| warning["about"].as_str().unwrap()).collect();
    assert!(about.contains(&"device"), "{about:?}");
    let software = |warnings: &[String]| warnings.iter().any(|text| text.contains("computes on the CPU"));
    assert!(software(&journal.provenance.environment.warnings), "{:?}", journal.provenance.environment.warnings);
    let text = String::from_utf8(rtbench(&["env", "--backend", "cpu"]).stdout).unwrap();
    for part in ["program\n", "  git_revision", "environment\n", "devices\n", "warnings\n", "computes on the CPU"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert_eq!(rtbench(&["env", "--backend", "cpu", "--adapter", "x"]).status.code(), Some(2));
}
