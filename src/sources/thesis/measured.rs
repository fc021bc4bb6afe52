//! Reads recorded runs into [`Data`]: which device and scene a row belongs to, and which of two rows counts.

use super::data::{Built, Counts, Data, Device, Failure, Frame, Scene};
use super::scenes::SceneKey;
use super::structures::Step;
use super::variant::Variant;
use super::{conditions, structures};
use crate::compare::pair::{Comparable, Conditions, choose};
use crate::device::{DeviceInfo, DeviceType};
use crate::record::row::Status;
use crate::record::run::{Environment, Provenance};
use crate::sources::convention::Steps;
use crate::sources::runs::RecordedRun;
use crate::workloads::trace::record::{ConfigurationRecord, CounterSums, SceneRecord, StructureRecord};
use std::collections::HashMap;

/// True if a run has rows that the thesis's tables can show.
pub fn has_rows(run: &RecordedRun) -> bool {
    !run.journal.structures.is_empty() || !run.journal.configurations.is_empty()
}

/// Everything that runs have measured. Of several measurements of the same, the last complete one counts; of unlike
/// conditions, one fills the rows ([`conditions`]).
pub fn data(runs: &[RecordedRun]) -> Data {
    let mut data = Data::default();
    let mut identities: Vec<Vec<String>> = Vec::new();
    let mut scenes: HashMap<SceneKey, usize> = HashMap::new();
    let (mut built, mut frames) = (Vec::new(), Vec::new());
    for run in runs {
        let provenance = &run.journal.provenance;
        let mut index_of = |info: &DeviceInfo| {
            let identity = identity(info, &provenance.environment);
            identities.iter().position(|known| *known == identity).unwrap_or_else(|| {
                identities.push(identity);
                data.devices.push(device(info, &provenance.environment));
                identities.len() - 1
            })
        };
        let devices: Vec<(usize, &DeviceInfo)> =
            provenance.devices.iter().map(|device| (index_of(&device.info), &device.info)).collect();
        for record in &run.journal.structures {
            add_scene(&mut data, &mut scenes, scene_key(&record.scene), &record.scene);
            built.push(built_of(record, provenance));
        }
        for record in &run.journal.configurations {
            let key = row_key(record);
            add_scene(&mut data, &mut scenes, key.clone(), &record.scene);
            let Some(&(device, info)) = devices.get(record.device) else { continue };
            match frame_of(device, &key, info, record) {
                Some(frame) => frames.push((frame, record)),
                None => data.failures.push(failure_of(device, key, record)),
            }
        }
        data.notes.extend(run_notes(run));
    }
    data.scenes.sort_by(|a, b| a.key.cmp(&b.key));
    disambiguate_names(&mut data.devices);
    add_built(&mut data, built);
    let (frames, notes) = conditions::choose_frames(frames, |device| data.devices[device].label.clone());
    data.notes.extend(notes);
    for (frame, record) in frames {
        data.devices[frame.device].checked |= frame.conditions.checked;
        add_counts(&mut data, &frame, record);
        add_frame(&mut data, frame);
    }
    let notes = conditions::unlike_devices(&data);
    data.notes.extend(notes);
    data
}

/// The number of rows whose passes were interleaved with those of other rows, and of all rows with times.
pub fn interleaved_rows(runs: &[RecordedRun]) -> (usize, usize) {
    let rows = runs.iter().flat_map(|run| &run.journal.configurations);
    let turns: Vec<usize> = rows.filter(|r| r.status == Status::Ok && r.verified).map(|r| r.interleaved_with).collect();
    (turns.iter().filter(|number| **number > 1).count(), turns.len())
}

/// Two runs are of the same device if this is equal. A device that computes on the CPU is another one on another CPU.
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
fn disambiguate_names(devices: &mut [Device]) {
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
    let name = format!("the run of {} on {}", journal.provenance.started, journal.provenance.device_names());
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

fn scene_key(record: &SceneRecord) -> SceneKey {
    SceneKey::of(&record.name, record.triangles, record.vertices)
}

/// The scene of a measurement, which also has a camera path.
fn row_key(record: &ConfigurationRecord) -> SceneKey {
    let (scene, path) = (&record.scene, &record.camera_path.name);
    scene_key(scene).along(&scene.name, scene.triangles, path, record.config.shadows())
}

/// Adds a scene; of equal ones the last counts. `known` has the index of each.
fn add_scene(data: &mut Data, known: &mut HashMap<SceneKey, usize>, key: SceneKey, record: &SceneRecord) {
    let scene = Scene {
        triangles: record.triangles,
        vertices: record.vertices,
        lights: Some(record.lights),
        mirror_share: Some(record.mirror_share),
        key,
    };
    match known.get(&scene.key) {
        Some(&index) => data.scenes[index] = scene,
        None => {
            known.insert(scene.key.clone(), data.scenes.len());
            data.scenes.push(scene);
        }
    }
}

/// A structure, and the content of its scene as conditions.
fn built_of(record: &StructureRecord, provenance: &Provenance) -> (Built, Conditions) {
    let mib = |bytes: u64| bytes as f64 / f64::from(1 << 20);
    let built = Built {
        scene: scene_key(&record.scene),
        structure: record.structure.clone(),
        variant: Variant::parse(&record.variant),
        properties: record.properties.clone(),
        build_ms: Some(record.build_ms),
        places: None,
        threads: Some(record.build_threads),
        builds: provenance.plan.settings.builds.max(1),
        processor: provenance.environment.cpu.clone(),
        thesis_mib: Some(mib(record.memory.thesis_bytes)),
        allocated_mib: Some(mib(record.memory.structure_bytes + record.memory.geometry_bytes)),
        repeated: false,
    };
    (built, Conditions { scene: record.scene.hash.clone(), ..Conditions::default() })
}

/// Each structure once by every builder, the last one last. All structures of a scene are of the same content.
fn add_built(data: &mut Data, rows: Vec<(Built, Conditions)>) {
    let comparable = rows.iter().map(|(built, conditions)| Comparable {
        group: built.scene.clone(),
        conditions,
        structure: &built.structure,
        variant: &built.variant,
    });
    let comparable: Vec<_> = comparable.collect();
    let keep: Vec<bool> = choose(&comparable).iter().map(Option::is_none).collect();
    let mut last: HashMap<_, usize> = HashMap::new();
    let mut kept: Vec<Option<Built>> = Vec::new();
    for ((mut built, _), keep) in rows.into_iter().zip(keep) {
        if !keep {
            let note = format!("structures of another content of {} were left out", built.scene);
            if !data.notes.contains(&note) {
                data.notes.push(note);
            }
            continue;
        }
        let by = (built.processor.clone(), built.threads);
        let place = (built.scene.clone(), built.structure.clone(), built.variant.clone(), by);
        if let Some(known) = last.insert(place, kept.len()) {
            kept[known] = None;
            built.repeated = true;
        }
        kept.push(Some(built));
    }
    data.built = kept.into_iter().flatten().collect();
}

/// A measurement's times, if it has usable ones.
fn frame_of(device: usize, scene: &SceneKey, info: &DeviceInfo, record: &ConfigurationRecord) -> Option<Frame> {
    let times = record.frame_statistics()?;
    let usable = record.status == Status::Ok && record.verified;
    let (min_ms, max_ms, mean_ms) = (times.min_ms, times.max_ms, times.mean_ms);
    // The CPU twins always have Rust's checks, which are not wgpu's
    let checked = info.checked && info.device_type != DeviceType::CpuTwin;
    usable.then(|| Frame {
        device,
        scene: scene.clone(),
        structure: record.structure.clone(),
        variant: Variant::parse(&record.variant),
        config: record.config,
        width: record.width,
        height: record.height,
        conditions: conditions_of(record, checked),
        min_ms,
        max_ms,
        mean_ms,
        places: None,
        noise_pct: times.noise_pct,
        repeated: false,
    })
}

fn conditions_of(record: &ConfigurationRecord, checked: bool) -> Conditions {
    Conditions {
        scene: record.scene.hash.clone(),
        path: record.camera_path.name.clone(),
        path_hash: record.camera_path.hash.clone(),
        frames: record.frames,
        checked,
    }
}

fn failure_of(device: usize, scene: SceneKey, record: &ConfigurationRecord) -> Failure {
    let name = if record.variant == "default" { String::new() } else { format!(":{}", record.variant) };
    let size = format!("{}x{}", record.width, record.height);
    let message = match record.status {
        Status::Skipped | Status::Wrong | Status::Failed => record.message.clone(),
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
    let case = (frame.device, frame.config, frame.width, frame.height);
    let same = |f: &Frame| (f.device, f.config, f.width, f.height) == case;
    frame.repeated = data.frames.of(&frame.scene, &frame.structure, &frame.variant).any(same);
    data.frames.put(frame, same);
}

/// Counts of every ray type that a measurement traced; of the same measurement the last counts.
fn add_counts(data: &mut Data, frame: &Frame, record: &ConfigurationRecord) {
    let Some(counters) = record.counters.as_ref().filter(|_| frame.width == frame.height) else { return };
    for (ray, sums) in counters.iter().enumerate().filter(|(_, sums)| sums.rays > 0) {
        let counts = counts_of(frame, ray, sums);
        let case = (frame.device, frame.config, ray, frame.width);
        data.counts.put(counts, |c| (c.device, c.config, c.ray, c.resolution) == case);
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
        steps: match structures::step(&frame.structure) {
            Step::Cell => Steps::Cells(per_ray(CounterSums::steps)),
            Step::Node => {
                Steps::Nodes { inner: per_ray(|s| s.inner), leaves: per_ray(|s| s.leaves), pops: per_ray(|s| s.pops) }
            }
        },
        tests: per_ray(|s| s.tests),
        restarts: structures::restarts(&frame.structure).then(|| per_ray(|s| s.restarts)),
    }
}
