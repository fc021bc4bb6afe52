//! Recorded runs as [`Data`]: which device and scene each row belongs to, and which of two rows counts.

use super::convention::Steps;
use super::data::{Built, Counts, Data, Device, Failure, Frame, Scene};
use super::runs::RecordedRun;
use super::scenes::SceneKey;
use super::variant::Variant;
use crate::backend::{Config, DeviceInfo, DeviceType};
use crate::results::record::{ConfigurationRecord, CounterSums, Environment, SceneRecord, Status, StructureRecord};
use crate::results::summary::Row;

/// Everything that runs have measured. Of several measurements of the same, the last complete one counts.
pub fn data(runs: &[RecordedRun]) -> Data {
    let mut data = Data::default();
    let mut identities: Vec<Vec<String>> = Vec::new();
    for run in runs {
        let provenance = &run.journal.provenance;
        let identity = identity(&provenance.device, &provenance.environment);
        let device = identities.iter().position(|known| *known == identity).unwrap_or_else(|| {
            identities.push(identity);
            data.devices.push(device(&provenance.device, &provenance.environment));
            identities.len() - 1
        });
        // The twins have Rust's own checks, always: that says nothing about wgpu's
        data.devices[device].checked |=
            provenance.device.checked && provenance.device.device_type != DeviceType::CpuTwin;
        for record in &run.journal.structures {
            add_scene(&mut data, &record.scene);
            add_built(&mut data, record, &provenance.environment.cpu);
        }
        for record in &run.journal.configurations {
            add_scene(&mut data, &record.scene);
            add_configuration(&mut data, device, &provenance.device, record);
        }
        data.notes.extend(run_notes(run));
    }
    data.scenes.sort_by(|a, b| a.key.cmp(&b.key));
    tell_apart(&mut data.devices);
    data
}

/// What makes two runs' devices the same. A device that computes on the CPU is another one on another CPU.
fn identity(device: &DeviceInfo, environment: &Environment) -> Vec<String> {
    let mut identity = vec![device.name.clone(), device.backend.clone(), device.driver.clone()];
    if matches!(device.device_type, DeviceType::CpuTwin | DeviceType::SoftwareRasteriser) {
        identity.extend([environment.cpu.clone(), format!("{:?}", device.threads)]);
    }
    identity
}

fn device(device: &DeviceInfo, environment: &Environment) -> Device {
    let kind = match device.device_type {
        DeviceType::CpuTwin => "CPU twins of the kernels",
        DeviceType::SoftwareRasteriser => "software rasteriser",
        DeviceType::IntegratedGpu => "integrated GPU",
        DeviceType::DiscreteGpu => "discrete GPU",
        DeviceType::VirtualGpu => "virtual GPU",
        DeviceType::Other => "unknown",
    };
    let threads = device.threads.map_or(String::new(), |n| n.to_string());
    let memory = format!("{:.1} GiB", environment.memory_bytes as f64 / f64::from(1 << 30));
    Device {
        label: device.name.clone(),
        kind: Some(device.device_type),
        facts: vec![
            ("kind", kind.into()),
            ("driver", [device.backend.as_str(), device.driver.as_str()].join(" ").trim().to_owned()),
            ("threads", threads),
            ("processor", environment.cpu.clone()),
            ("main memory", if environment.memory_bytes > 0 { memory } else { String::new() }),
            ("system", environment.os.clone()),
        ],
        checked: false,
    }
}

/// Devices of the same name get a number.
fn tell_apart(devices: &mut [Device]) {
    let names: Vec<String> = devices.iter().map(|d| d.label.clone()).collect();
    for (index, device) in devices.iter_mut().enumerate() {
        let before = names[..index].iter().filter(|name| **name == device.label).count();
        if before > 0 {
            device.label = format!("{} #{}", device.label, before + 1);
        }
    }
}

fn run_notes(run: &RecordedRun) -> Vec<String> {
    let journal = &run.journal;
    let mut notes = Vec::new();
    let name = format!("the run of {} on {}", journal.provenance.started, journal.provenance.device.name);
    match &journal.end {
        None => notes.push(format!("{name} was killed before its end: what it had measured is used")),
        Some(end) if !end.complete => notes.push(format!("{name} ended early: what it had measured is used")),
        Some(_) => {}
    }
    if let Some(truncated) = &journal.truncated {
        notes.push(format!(
            "{name}: {}",
            truncated.split(" of ").next().unwrap_or(truncated).to_owned() + " is cut off"
        ));
    }
    notes
}

fn add_scene(data: &mut Data, record: &SceneRecord) {
    let key = SceneKey::of(record);
    let scene = Scene {
        triangles: record.triangles,
        vertices: record.vertices,
        lights: Some(record.lights),
        mirror_share: Some(record.mirror_share),
        key,
    };
    match data.scenes.iter_mut().find(|known| known.key == scene.key) {
        Some(known) => *known = scene,
        None => data.scenes.push(scene),
    }
}

fn add_built(data: &mut Data, record: &StructureRecord, processor: &str) {
    let mib = |bytes: u64| bytes as f64 / f64::from(1 << 20);
    let mut built = Built {
        scene: SceneKey::of(&record.scene),
        structure: record.structure.clone(),
        variant: Variant::parse(&record.variant),
        properties: record.properties.clone(),
        build_ms: Some(record.build_ms),
        threads: Some(record.build_threads),
        processor: processor.to_owned(),
        thesis_mib: Some(mib(record.memory.thesis_bytes)),
        allocated_mib: Some(mib(record.memory.structure_bytes + record.memory.geometry_bytes)),
        repeated: false,
    };
    let same = |b: &&mut Built| b.scene == built.scene && b.structure == built.structure && b.variant == built.variant;
    match data.built.iter_mut().find(same) {
        Some(known) => {
            built.repeated = true;
            *known = built;
        }
        None => data.built.push(built),
    }
}

fn add_configuration(data: &mut Data, device: usize, info: &DeviceInfo, record: &ConfigurationRecord) {
    let scene = SceneKey::of(&record.scene);
    let row = Row::new(info, record);
    let usable = record.status == Status::Ok && record.verified;
    let (true, Some(min_ms), Some(max_ms), Some(mean_ms)) =
        (usable, row.frame_ms_min, row.frame_ms_max, row.frame_ms_mean)
    else {
        let name = if record.variant == "default" { String::new() } else { format!(":{}", record.variant) };
        let size = format!("{}x{}", record.width, record.height);
        let message = match record.status {
            Status::Error => record.message.clone(),
            Status::Ok if !record.verified => "not verified".into(),
            Status::Ok => "no times".into(),
        };
        data.failures.push(Failure {
            device,
            what: format!("{scene} {}{name} {:?} {size}", record.structure, record.config),
            structure: record.structure.clone(),
            config: record.config,
            width: record.width,
            scene,
            message,
        });
        return;
    };
    let mut frame = Frame {
        device,
        scene,
        structure: record.structure.clone(),
        variant: Variant::parse(&record.variant),
        config: record.config,
        width: record.width,
        height: record.height,
        min_ms,
        max_ms,
        mean_ms,
        noise_pct: row.noise_pct,
        repeated: false,
    };
    add_counts(data, &frame, record);
    let same = |f: &&mut Frame| {
        (f.device, f.config, f.width, f.height) == (device, frame.config, frame.width, frame.height)
            && f.scene == frame.scene
            && f.structure == frame.structure
            && f.variant == frame.variant
    };
    match data.frames.iter_mut().find(same) {
        Some(known) => {
            frame.repeated = true;
            *known = frame;
        }
        None => data.frames.push(frame),
    }
}

/// A configuration stands for the ray type that it adds (SPEC section 6); of the same size the last counts. Counts do not depend on the device: that they agree has been verified.
fn add_counts(data: &mut Data, frame: &Frame, record: &ConfigurationRecord) {
    let ray = match record.config {
        Config::P => 0,
        Config::PS => 1,
        Config::PSR => 2,
    };
    let Some(sums) = record.counters.as_ref().map(|counters| counters[ray]) else { return };
    if sums.rays == 0 || frame.width != frame.height {
        return;
    }
    let per_ray = |sum: fn(&CounterSums) -> u64| sum(&sums) as f64 / sums.rays as f64;
    let counts = Counts {
        scene: frame.scene.clone(),
        structure: frame.structure.clone(),
        variant: frame.variant.clone(),
        ray,
        resolution: frame.width,
        steps: if frame.structure.starts_with("grid") {
            Steps::Cells(per_ray(CounterSums::steps))
        } else {
            Steps::Nodes { inner: per_ray(|s| s.inner), leaves: per_ray(|s| s.leaves), pops: per_ray(|s| s.pops) }
        },
        tests: per_ray(|s| s.tests),
        restarts: (frame.structure == "kdtree").then(|| per_ray(|s| s.restarts)),
    };
    let same = |c: &&mut Counts| {
        (&c.scene, &c.structure, &c.variant) == (&counts.scene, &counts.structure, &counts.variant)
            && (c.ray, c.resolution) == (ray, counts.resolution)
    };
    match data.counts.iter_mut().find(same) {
        Some(known) => *known = counts,
        None => data.counts.push(counts),
    }
}
