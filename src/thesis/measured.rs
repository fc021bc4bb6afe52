//! Recorded runs as [`Data`]: which device and scene each row belongs to, and which of two rows counts.

use super::convention::Steps;
use super::data::{Built, Counts, Data, Device, Failure, Frame, Scene};
use super::runs::RecordedRun;
use super::scenes::SceneKey;
use super::variant::Variant;
use super::workload::{self, Candidate, Workload};
use crate::record::schema::{
    ConfigurationRecord, CounterSums, Environment, Provenance, SceneRecord, Status, StructureRecord,
};
use crate::record::summary::Row;
use crate::workloads::trace::backend::{DeviceInfo, DeviceType};

/// Everything that runs have measured. Of several measurements of the same, the last complete one counts; where frames
/// differ in what they show, one workload fills the rows ([`workload`]).
pub fn data(runs: &[RecordedRun]) -> Data {
    let mut data = Data::default();
    let mut identities: Vec<Vec<String>> = Vec::new();
    let (mut built, mut frames) = (Vec::new(), Vec::new());
    for run in runs {
        let provenance = &run.journal.provenance;
        let identity = identity(&provenance.device, &provenance.environment);
        let device = identities.iter().position(|known| *known == identity).unwrap_or_else(|| {
            identities.push(identity);
            data.devices.push(device(&provenance.device, &provenance.environment));
            identities.len() - 1
        });
        for record in &run.journal.structures {
            add_scene(&mut data, SceneKey::of(&record.scene), &record.scene);
            built.push(built_of(record, provenance));
        }
        for record in &run.journal.configurations {
            let key = SceneKey::of_row(record);
            add_scene(&mut data, key.clone(), &record.scene);
            match frame_of(device, &key, &provenance.device, record) {
                Some(frame) => frames.push((frame, record)),
                None => data.failures.push(failure_of(device, key, record)),
            }
        }
        data.notes.extend(run_notes(run));
    }
    data.scenes.sort_by(|a, b| a.key.cmp(&b.key));
    tell_apart(&mut data.devices);
    add_built(&mut data, built);
    let (frames, notes) = workload::of_frames(frames, |device| data.devices[device].label.clone());
    data.notes.extend(notes);
    for (frame, record) in frames {
        data.devices[frame.device].checked |= frame.workload.checked;
        add_counts(&mut data, &frame, record);
        add_frame(&mut data, frame);
    }
    let notes = workload::unlike_devices(&data);
    data.notes.extend(notes);
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

fn add_scene(data: &mut Data, key: SceneKey, record: &SceneRecord) {
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

/// A structure, and of which content of its scene it was built.
fn built_of(record: &StructureRecord, provenance: &Provenance) -> (Built, Workload) {
    let mib = |bytes: u64| bytes as f64 / f64::from(1 << 20);
    let built = Built {
        scene: SceneKey::of(&record.scene),
        structure: record.structure.clone(),
        variant: Variant::parse(&record.variant),
        properties: record.properties.clone(),
        build_ms: Some(record.build_ms),
        places: None,
        threads: Some(record.build_threads),
        builds: provenance.plan.builds.max(1),
        processor: provenance.environment.cpu.clone(),
        thesis_mib: Some(mib(record.memory.thesis_bytes)),
        allocated_mib: Some(mib(record.memory.structure_bytes + record.memory.geometry_bytes)),
        repeated: false,
    };
    (built, Workload { scene: record.scene.hash.clone(), ..Workload::default() })
}

/// Each structure once by every builder, the last one last, and all of a scene of the same triangles.
fn add_built(data: &mut Data, rows: Vec<(Built, Workload)>) {
    let candidates = rows.iter().map(|(built, workload)| Candidate {
        group: built.scene.clone(),
        workload,
        structure: &built.structure,
        variant: &built.variant,
    });
    let candidates: Vec<_> = candidates.collect();
    let keep: Vec<bool> = workload::choose(&candidates).iter().map(Option::is_none).collect();
    for ((mut built, _), keep) in rows.into_iter().zip(keep) {
        if !keep {
            let note = format!("structures of another content of {} were left out", built.scene);
            if !data.notes.contains(&note) {
                data.notes.push(note);
            }
            continue;
        }
        let same = |b: &Built| {
            b.scene == built.scene
                && b.structure == built.structure
                && b.variant == built.variant
                && b.by() == built.by()
        };
        if let Some(known) = data.built.iter().position(same) {
            data.built.remove(known);
            built.repeated = true;
        }
        data.built.push(built);
    }
}

/// A measurement's times, if it has usable ones.
fn frame_of(device: usize, scene: &SceneKey, info: &DeviceInfo, record: &ConfigurationRecord) -> Option<Frame> {
    let row = Row::new(info, record);
    let usable = record.status == Status::Ok && record.verified;
    let (min_ms, max_ms, mean_ms) = (row.frame_ms_min?, row.frame_ms_max?, row.frame_ms_mean?);
    // The twins have Rust's own checks, always: that says nothing about wgpu's
    let checked = info.checked && info.device_type != DeviceType::CpuTwin;
    usable.then(|| Frame {
        device,
        scene: scene.clone(),
        structure: record.structure.clone(),
        variant: Variant::parse(&record.variant),
        config: record.config,
        width: record.width,
        height: record.height,
        workload: Workload::of(record, checked),
        min_ms,
        max_ms,
        mean_ms,
        places: None,
        noise_pct: row.noise_pct,
        repeated: false,
    })
}

fn failure_of(device: usize, scene: SceneKey, record: &ConfigurationRecord) -> Failure {
    let name = if record.variant == "default" { String::new() } else { format!(":{}", record.variant) };
    let size = format!("{}x{}", record.width, record.height);
    let message = match record.status {
        Status::Error => record.message.clone(),
        Status::Ok if !record.verified => "not verified".into(),
        Status::Ok => "no times".into(),
    };
    Failure {
        device,
        what: format!("{scene} {}{name} {:?} {size}", record.structure, record.config),
        structure: record.structure.clone(),
        variant: Variant::parse(&record.variant),
        config: record.config,
        width: record.width,
        height: record.height,
        scene,
        message,
    }
}

fn add_frame(data: &mut Data, mut frame: Frame) {
    let same = |f: &&mut Frame| {
        (f.device, f.config, f.width, f.height) == (frame.device, frame.config, frame.width, frame.height)
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

/// Counts of every ray type that a measurement traced; of the same measurement the last counts.
fn add_counts(data: &mut Data, frame: &Frame, record: &ConfigurationRecord) {
    let Some(counters) = record.counters.as_ref().filter(|_| frame.width == frame.height) else { return };
    for (ray, sums) in counters.iter().enumerate().filter(|(_, sums)| sums.rays > 0) {
        let counts = counts_of(frame, ray, sums);
        let same = |c: &&mut Counts| {
            (c.device, c.config, c.ray, c.resolution) == (frame.device, frame.config, ray, frame.width)
                && (&c.scene, &c.structure, &c.variant) == (&counts.scene, &counts.structure, &counts.variant)
        };
        match data.counts.iter_mut().find(same) {
            Some(known) => *known = counts,
            None => data.counts.push(counts),
        }
    }
}

fn counts_of(frame: &Frame, ray: usize, sums: &CounterSums) -> Counts {
    let per_ray = |sum: fn(&CounterSums) -> u64| sum(sums) as f64 / sums.rays as f64;
    Counts {
        device: frame.device,
        config: frame.config,
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
    }
}
