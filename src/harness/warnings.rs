//! What spoils times before anything is measured: the program's build, the machine's state, the device's kind. Each
//! warning says what to do.

use crate::device::DeviceType;
use crate::record::run::{DeviceRecord, Environment, Program};
use serde::Serialize;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// A reason to distrust times.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Warning {
    /// What it is about, in one word: the same in every version.
    pub about: &'static str,
    /// What is wrong, one line.
    pub problem: String,
    /// What to do about it.
    pub hint: String,
}

impl Warning {
    fn new(about: &'static str, problem: impl Into<String>, hint: impl Into<String>) -> Warning {
        Warning { about, problem: problem.into(), hint: hint.into() }
    }
}

impl std::fmt::Display for Warning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} ({})", self.problem, self.hint)
    }
}

/// What spoils the times of a run by this program on this machine and these devices. `root` is the folder that has
/// `sys` and `proc`: `/`, except in tests. Where the system does not tell something, there is no warning about it.
pub fn find(program: &Program, environment: &Environment, devices: &[DeviceRecord], root: &Path) -> Vec<Warning> {
    let mut warnings = Vec::new();
    if program.profile != "release" {
        let problem = format!("the program is a {} build", program.profile);
        warnings.push(Warning::new("build", problem, "build it with cargo build --release"));
    }
    warnings.extend(governor(root));
    warnings.extend(load(environment));
    for device in devices {
        warnings.extend(kind(device));
        if device.info.checked && device.info.device_type != DeviceType::CpuTwin {
            let problem = format!("kernels on {} are compiled with bounds checks and loop bounds", device.info.name);
            warnings.push(Warning::new("checks", problem, "leave out --checked"));
        }
    }
    warnings.extend(battery(root));
    warnings.extend(throttling(root));
    warnings.extend(quota(root));
    warnings
}

/// Frequency governors of the processors other than `performance`.
fn governor(root: &Path) -> Option<Warning> {
    let all: Vec<String> =
        processors(root).iter().filter_map(|cpu| read(&cpu.join("cpufreq/scaling_governor"))).collect();
    let slow: BTreeSet<&str> = all.iter().map(String::as_str).filter(|governor| *governor != "performance").collect();
    if slow.is_empty() {
        return None;
    }
    let names = slow.into_iter().collect::<Vec<_>>().join(", ");
    let problem = format!("processors change their clock: the frequency governor is {names}, not performance");
    Some(Warning::new("governor", problem, "sudo cpupower frequency-set -g performance"))
}

/// A load average above half of the threads that the process may use.
fn load(environment: &Environment) -> Option<Warning> {
    let (load, threads) = (environment.load_average[0], environment.logical_cpus);
    if load <= threads as f64 / 2.0 {
        return None;
    }
    let problem = format!("the machine is busy: a load of {load:.2} over the last minute on {threads} processors");
    Some(Warning::new("load", problem, "end other programs and wait a minute"))
}

fn kind(device: &DeviceRecord) -> Option<Warning> {
    if !device.info.device_type.computes_on_cpu() {
        return None;
    }
    let (name, kind) = (&device.info.name, device.info.device_type.in_words());
    let problem = format!("{name} computes on the CPU ({kind}): its times rank nothing for a GPU");
    Some(Warning::new("device", problem, "choose a GPU with --adapter; `rtbench devices` lists them"))
}

/// A battery of the system that is being discharged.
fn battery(root: &Path) -> Option<Warning> {
    let supplies = children(&root.join("sys/class/power_supply"));
    let discharging = supplies.iter().any(|supply| {
        let is = |file: &str, value: &str| read(&supply.join(file)).is_some_and(|text| text == value);
        // Mice and keyboards have batteries of the scope Device
        is("type", "Battery") && is("status", "Discharging") && !is("scope", "Device")
    });
    let hint = "connect the power supply";
    discharging.then(|| Warning::new("battery", "the machine runs on its battery, which lowers clocks", hint))
}

/// How often processors lowered their clock for heat since the system started, where they count it.
fn throttling(root: &Path) -> Option<Warning> {
    let of = |file: &str| {
        let counts = processors(root);
        let counts = counts.iter().filter_map(|cpu| read(&cpu.join("thermal_throttle").join(file))?.parse().ok());
        counts.max().unwrap_or(0u64)
    };
    // A package's count is the same in each of its processors
    let most = of("core_throttle_count").max(of("package_throttle_count"));
    if most == 0 {
        return None;
    }
    let problem = format!("processors lowered their clock for heat, up to {most} times since the system started");
    Some(Warning::new("heat", problem, "cool the machine, and compare the number after the run"))
}

/// A limit on processor time below the number of processors: once it is used up, all threads stop until the next
/// period.
fn quota(root: &Path) -> Option<Warning> {
    let groups = read(&root.join("proc/self/cgroup"))?;
    let limits = groups.lines().filter_map(|line| {
        let mut fields = line.splitn(3, ':').skip(1);
        let (controllers, group) = (fields.next()?, fields.next()?);
        let second = controllers.is_empty();
        if !second && !controllers.split(',').any(|controller| controller == "cpu") {
            return None;
        }
        let mounts: &[&str] = if second { &["", "unified"] } else { &["cpu", "cpu,cpuacct"] };
        mounts
            .iter()
            .filter_map(|mount| quota_of(&root.join("sys/fs/cgroup").join(mount), group, second))
            .reduce(f64::min)
    });
    let limit = limits.reduce(f64::min)?;
    if limit >= processors(root).len() as f64 {
        return None;
    }
    let problem = format!("a control group limits the process to the time of {limit:.2} processors");
    let hint = "lift the limit (docker --cpus, CPUQuota of systemd), or give whole processors (docker --cpuset-cpus)";
    Some(Warning::new("quota", problem, hint))
}

/// The lowest limit, in processors, of a control group and those that it is in; `None` where there is none.
fn quota_of(mount: &Path, group: &str, second: bool) -> Option<f64> {
    let group = mount.join(group.trim_start_matches('/'));
    let folders = group.ancestors().take_while(|folder| folder.starts_with(mount));
    let limit = |folder: &Path| {
        let (quota, period) = match second {
            true => {
                let text = read(&folder.join("cpu.max"))?;
                let (quota, period) = text.split_once(' ')?;
                (quota.to_owned(), period.to_owned())
            }
            false => (read(&folder.join("cpu.cfs_quota_us"))?, read(&folder.join("cpu.cfs_period_us"))?),
        };
        // `max` and -1 are no limit
        let (quota, period): (f64, f64) = (quota.parse().ok()?, period.parse().ok()?);
        (quota > 0.0 && period > 0.0).then(|| quota / period)
    };
    folders.filter_map(limit).reduce(f64::min)
}

/// The folders of the processors, `cpu0` and so on.
fn processors(root: &Path) -> Vec<PathBuf> {
    let is_processor = |path: &PathBuf| {
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        name.strip_prefix("cpu").is_some_and(|number| !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit()))
    };
    children(&root.join("sys/devices/system/cpu")).into_iter().filter(is_processor).collect()
}

/// What is in a folder, in order; nothing where it cannot be read.
fn children(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten();
    let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.sort();
    paths
}

/// The trimmed text of a file; `None` where it cannot be read.
fn read(path: &Path) -> Option<String> {
    Some(std::fs::read_to_string(path).ok()?.trim().to_owned())
}
