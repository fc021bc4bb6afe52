//! Under which conditions a row was measured. Rows of unlike conditions are not compared, unless the user asks for it.

use crate::device::DeviceType;
use crate::error::{Error, Result};
use crate::record::run::{Environment, Provenance};
use crate::record::stream::{LeanRow, LeanRun, Names};

/// Conditions that every workload has, as `--across` takes them; each kind of input is another one.
pub const GENERAL: [&str; 5] = ["device", "driver", "machine", "kernel", "settings"];

/// A device of a run, as far as times depend on it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DeviceIdentity {
    /// Name, and what else decides its speed.
    pub device: String,
    /// Driver and its version.
    pub driver: String,
    /// The machine around it: processor, threads, and variables that change what is measured.
    pub machine: String,
}

/// A machine in words.
fn machine(environment: &Environment) -> String {
    let variables = environment.variables.iter().map(|(name, value)| format!(", {name}={value}"));
    format!("{} with {} threads{}", environment.cpu, environment.logical_cpus, variables.collect::<String>())
}

/// The devices of a run.
pub fn devices(provenance: &Provenance) -> Vec<DeviceIdentity> {
    let identity = |(index, device): (usize, &crate::record::run::DeviceRecord)| {
        let info = &device.info;
        let of_part = provenance.merged.iter().find(|part| part.devices.contains(&index));
        let environment = of_part.map_or(&provenance.environment, |part| &part.environment);
        let mut name = info.name.clone();
        if info.device_type.computes_on_cpu() {
            let cpu = &environment.cpu;
            if !cpu.is_empty() && !name.contains(cpu.as_str()) {
                name += &format!(" on {cpu}");
            }
            if let Some(threads) = info.threads {
                name += &format!(", {threads} threads");
            }
        }
        // The twins always have Rust's checks, which are not wgpu's
        if info.checked && info.device_type != DeviceType::CpuTwin {
            name += ", with shader checks";
        }
        let driver = if info.driver.is_empty() { info.backend.clone() } else { info.driver.clone() };
        DeviceIdentity { device: name, driver, machine: machine(environment) }
    };
    provenance.devices.iter().enumerate().map(identity).collect()
}

/// One condition in which two rows differ.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Difference {
    /// Its name, as `--across` takes it.
    pub condition: String,
    /// What it is for the older row.
    pub old: String,
    /// What it is for the newer row.
    pub new: String,
}

impl Difference {
    /// As text: `driver A, not B`.
    pub fn describe(&self) -> String {
        match (self.old.is_empty(), self.new.is_empty()) {
            (false, false) => format!("{} {}, not {}", self.condition, self.new, self.old),
            _ => self.condition.clone(),
        }
    }
}

/// A run with what its rows share.
#[derive(Debug)]
pub struct ComparedRun {
    /// The run.
    pub run: LeanRun,
    /// Its devices.
    pub devices: Vec<DeviceIdentity>,
}

impl ComparedRun {
    /// Prepares a run.
    pub fn new(run: LeanRun) -> ComparedRun {
        ComparedRun { devices: devices(&run.provenance), run }
    }

    /// The device of a row.
    pub fn device(&self, row: &LeanRow) -> Option<&DeviceIdentity> {
        self.devices.get(row.device)
    }
}

/// The name of a kind of input as a condition.
fn condition(kind: &str) -> String {
    kind.replace('_', "-")
}

/// The conditions in which two rows differ.
pub fn differences(names: &Names, old: (&ComparedRun, &LeanRow), new: (&ComparedRun, &LeanRow)) -> Vec<Difference> {
    let mut found = Vec::new();
    let mut add = |condition: String, old: String, new: String| found.push(Difference { condition, old, new });
    let short = |name: u32| names.text(name).get(..8).unwrap_or(names.text(name)).to_owned();
    if old.1.inputs != new.1.inputs {
        for (kind, hash) in &old.1.inputs {
            match new.1.inputs.iter().find(|(other, _)| other == kind) {
                Some((_, other)) if other == hash => {}
                Some((_, other)) => add(condition(names.text(*kind)), short(*hash), short(*other)),
                None => add(condition(names.text(*kind)), String::new(), String::new()),
            }
        }
        for (kind, _) in new.1.inputs.iter().filter(|(kind, _)| !old.1.inputs.iter().any(|(other, _)| other == kind)) {
            add(condition(names.text(*kind)), String::new(), String::new());
        }
    }
    if let (Some(before), Some(now)) = (old.0.device(old.1), new.0.device(new.1)) {
        if before.device != now.device {
            add("device".into(), before.device.clone(), now.device.clone());
        }
        if before.driver != now.driver {
            add("driver".into(), before.driver.clone(), now.driver.clone());
        }
        if before.machine != now.machine {
            add("machine".into(), before.machine.clone(), now.machine.clone());
        }
    }
    if old.1.kernels != new.1.kernels {
        add("kernel".into(), short(old.1.kernels), short(new.1.kernels));
    }
    if old.1.settings != new.1.settings {
        let (before, now) = (old.1.settings, new.1.settings);
        let parts = [
            ("passes", before.passes, now.passes),
            ("warm-up frames", before.warmup_frames, now.warmup_frames),
            ("builds", before.builds, now.builds),
            ("threads", before.threads, now.threads),
        ];
        let unlike: Vec<_> = parts.iter().filter(|(_, before, now)| before != now).collect();
        let text = |pick: fn(&(&str, usize, usize)) -> usize| {
            unlike.iter().map(|part| format!("{} {}", pick(part), part.0)).collect::<Vec<_>>().join(", ")
        };
        add("settings".into(), text(|part| part.1), text(|part| part.2));
    }
    found
}

/// Checks the names of conditions that may differ.
///
/// # Errors
/// [`Error::Input`] for a name that is neither one of [`GENERAL`] nor a kind of input of these runs.
pub fn check_across(across: &[String], names: &Names, runs: &[ComparedRun]) -> Result<()> {
    let mut known: Vec<String> = GENERAL.map(str::to_owned).into();
    for run in runs {
        for (kind, ..) in &run.run.inputs {
            let name = condition(names.text(*kind));
            if !known.contains(&name) {
                known.push(name);
            }
        }
    }
    match across.iter().find(|name| !known.contains(name)) {
        Some(unknown) => {
            let problem = format!("there is no condition '{unknown}'");
            Err(Error::argument("--across", problem, format!("a list of {}", known.join(", "))))
        }
        None => Ok(()),
    }
}
