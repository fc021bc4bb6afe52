//! Reads recorded runs into [`Data`].

use super::data::{Built, Data, Failure, Frame, Measurement};
use super::models::SceneKey;
use super::structures::is_own;
use crate::sources::rows::{self, Devices, Variant, choose_built, choose_frames, unlike_devices};
use crate::sources::runs::{RecordedRun, with_traces};
use crate::workloads::trace::backend::Config;
use crate::workloads::trace::record::{ConfigurationRecord, SceneRecord};
use crate::workloads::trace::simt::model::Gpu;

/// True if a run has rows of structures that this document alone describes.
pub fn has_rows(run: &RecordedRun) -> bool {
    let own = |structure: &str, variant: &str| is_own(structure, &Variant::parse(variant));
    run.journal.structures.iter().any(|s| own(&s.structure, &s.variant))
        || run.journal.configurations.iter().any(|c| own(&c.structure, &c.variant))
}

/// Everything that runs have measured. Of several measurements of the same, the last complete one counts; of unlike
/// conditions, one fills the rows ([`choose_frames`]).
pub fn data(runs: &[RecordedRun]) -> Data {
    let mut data = Data::default();
    let mut devices = Devices::default();
    let (mut built, mut frames) = (Vec::new(), Vec::new());
    let mut with_other_rays = 0;
    for run in with_traces(runs) {
        let provenance = &run.journal.provenance;
        let devices = devices.add(provenance);
        let built_here = run.journal.structures.iter().map(|r| Built::of(scene_key(&r.scene), r, provenance));
        built.extend(built_here);
        for record in &run.journal.configurations {
            if record.config != Config::P {
                with_other_rays += 1;
                continue;
            }
            let key = row_key(record);
            let Some(&(device, info)) = devices.get(record.device) else { continue };
            match Frame::of(device, key.clone(), info, record) {
                Some(frame) => frames.push((frame, record)),
                None => data.failures.push(Failure::of(device, key, record)),
            }
        }
        data.notes.extend(run.notes());
    }
    data.devices = devices.named();
    let (built, notes) = choose_built(built);
    built.into_iter().for_each(|built| data.built.push(built));
    data.notes.extend(notes);
    let (frames, notes) = choose_frames(frames, &data.devices);
    data.notes.extend(notes);
    let kept: Vec<Frame> = frames.iter().map(|(frame, _)| frame.clone()).collect();
    for (frame, record) in frames {
        data.devices[frame.device].checked |= frame.conditions.checked;
        add(&mut data, Measurement { frame, primary: record.counters.map(|by_ray| by_ray[0]) });
    }
    data.notes.extend(unlike_devices(&data.devices, &kept));
    if with_other_rays > 0 {
        let number = if with_other_rays == 1 { "1 row".into() } else { format!("{with_other_rays} rows") };
        data.notes.push(format!(
            "no table of rt2 shows {number} with rays other than primary ones: the document does not say that it \
             measured any"
        ));
    }
    data
}

/// The work of the same frames on a GPU by the SIMT model; `None` where no warps of its width were counted.
pub fn modelled(runs: &[RecordedRun], gpu: &Gpu) -> Option<Data> {
    let modelled = rows::modelled(runs, gpu, |record| record.config == Config::P, row_key)?;
    let mut data = Data { devices: vec![modelled.device], notes: modelled.notes, ..Data::default() };
    modelled.frames.into_iter().for_each(|frame| add(&mut data, Measurement { frame, primary: None }));
    Some(data)
}

fn scene_key(record: &SceneRecord) -> SceneKey {
    SceneKey::of(&record.name, record.triangles)
}

/// The scene of a measurement, which also has a camera path.
fn row_key(record: &ConfigurationRecord) -> SceneKey {
    scene_key(&record.scene).along(&record.camera_path.name, record.config.shadows())
}

/// Adds a measurement in place of an earlier one of the same.
fn add(data: &mut Data, mut new: Measurement) {
    let (structure, variant) = (new.frame.structure.clone(), new.frame.variant.clone());
    let place = (new.frame.device, new.frame.width, new.frame.height);
    let same = |old: &Measurement| {
        let f = &old.frame;
        (f.device, f.width, f.height) == place && f.structure == structure && f.variant == variant
    };
    new.frame.repeated = data.measurements.of(&new.frame.scene).any(same);
    data.measurements.put(new, same);
}
