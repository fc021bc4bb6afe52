//! Reads recorded runs into [`Data`]: which device and scene a row belongs to, and which of two rows counts.

use super::data::{CONFIGS, Counts, Data, Failure, Frame, Scene};
use super::scenes::SceneKey;
use super::structures;
use super::structures::Step;
use super::variant::Variant;
use crate::sources::convention::Steps;
use crate::sources::rows::{self, Built, Devices, choose_built, choose_frames, unlike_devices};
use crate::sources::rt2;
use crate::sources::runs::{RecordedRun, with_traces};
use crate::workloads::trace::record::{ConfigurationRecord, CounterSums, SceneRecord};
use crate::workloads::trace::simt::model::Gpu;
use std::collections::HashMap;

/// True if a run has rows that the thesis's tables can show: all but those of another document's own structures.
pub fn has_rows(run: &RecordedRun) -> bool {
    let of_thesis = |structure: &str, variant: &str| !rt2::structures::is_own(structure, &Variant::parse(variant));
    run.journal.structures.iter().any(|s| of_thesis(&s.structure, &s.variant))
        || run.journal.configurations.iter().any(|c| of_thesis(&c.structure, &c.variant))
}

/// Everything that runs have measured. Of several measurements of the same, the last complete one counts; of unlike
/// conditions, one fills the rows ([`choose_frames`]).
pub fn data(runs: &[RecordedRun]) -> Data {
    read(&with_traces(runs))
}

fn read(runs: &[&RecordedRun]) -> Data {
    let mut data = Data::default();
    let mut devices = Devices::default();
    let mut scenes: HashMap<SceneKey, usize> = HashMap::new();
    let (mut built, mut frames) = (Vec::new(), Vec::new());
    for run in runs {
        let provenance = &run.journal.provenance;
        let devices = devices.add(provenance);
        for record in &run.journal.structures {
            add_scene(&mut data, &mut scenes, scene_key(&record.scene), &record.scene);
            built.push(Built::of(scene_key(&record.scene), record, provenance));
        }
        let of_thesis = |record: &&ConfigurationRecord| CONFIGS.contains(&record.config);
        for record in run.journal.configurations.iter().filter(of_thesis) {
            let key = row_key(record);
            add_scene(&mut data, &mut scenes, key.clone(), &record.scene);
            let Some(&(device, info)) = devices.get(record.device) else { continue };
            match Frame::of(device, key.clone(), info, record) {
                Some(frame) => frames.push((frame, record)),
                None => data.failures.push(Failure::of(device, key, record)),
            }
        }
        data.notes.extend(run.notes());
    }
    data.scenes.sort_by(|a, b| a.key.cmp(&b.key));
    data.devices = devices.named();
    let (built, notes) = choose_built(built);
    data.built = built.into_iter().collect();
    data.notes.extend(notes);
    let (frames, notes) = choose_frames(frames, &data.devices);
    data.notes.extend(notes);
    for (frame, record) in frames {
        data.devices[frame.device].checked |= frame.conditions.checked;
        add_counts(&mut data, &frame, record);
        add_frame(&mut data, frame);
    }
    data.notes.extend(unlike_devices(&data.devices, &data.frames));
    data
}

/// The work of frames on a GPU by the SIMT model; `None` where no warps of its width were counted. Scenes and
/// structures are those of the runs that counted them.
pub fn modelled(runs: &[RecordedRun], gpu: &Gpu) -> Option<Data> {
    let of_thesis = |record: &ConfigurationRecord| CONFIGS.contains(&record.config);
    let modelled = rows::modelled(runs, gpu, of_thesis, row_key)?;
    let Data { scenes, built, .. } = read(&modelled.runs);
    let mut data = Data {
        modelled: true,
        devices: vec![modelled.device],
        scenes,
        built,
        notes: modelled.notes,
        ..Data::default()
    };
    modelled.frames.into_iter().for_each(|frame| add_frame(&mut data, frame));
    Some(data)
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
