//! What was measured, beside with which structure: numbers are compared only where this is the same.
//!
//! Runs may differ in it for one scene, configuration and size. Then one workload fills the rows: the one that was
//! measured with most structures; of equals the one with most options, then the later one. The others are left out and
//! named, so that no row of a table and no claim sets one beside another.

use super::data::{Data, Frame};
use super::scenes::SceneKey;
use super::variant::Variant;
use crate::record::schema::ConfigurationRecord;
use crate::workloads::trace::backend::Config;

/// What the frames of a measurement show. Default where it is not known, as of what the thesis printed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Workload {
    /// Content hash of the scene.
    pub scene: String,
    /// Name of the camera path.
    pub path: String,
    /// Content hash of the camera path.
    pub path_hash: String,
    /// Frames of the path.
    pub frames: usize,
    /// True if all kernels of the run had wgpu's checks. Checks of one structure are an option of it.
    pub checked: bool,
}

impl Workload {
    /// That of a record, in a run with or without checks.
    pub fn of(record: &ConfigurationRecord, checked: bool) -> Workload {
        Workload {
            scene: record.scene.hash.clone(),
            path: record.camera_path.name.clone(),
            path_hash: record.camera_path.hash.clone(),
            frames: record.frames,
            checked,
        }
    }

    /// What is special about it beside another, in words.
    fn beside(&self, other: &Workload) -> String {
        let mut words = Vec::new();
        if self.frames != other.frames {
            words.push(if self.frames == 1 { "1 frame".to_owned() } else { format!("{} frames", self.frames) });
        }
        if self.path_hash != other.path_hash {
            words.push(["camera path", self.path.as_str(), short(&self.path_hash)].join(" ").replace("  ", " "));
        }
        if self.scene != other.scene {
            words.push(format!("scene {}", short(&self.scene)));
        }
        if self.checked != other.checked {
            words.push(if self.checked { "shader checks on" } else { "shader checks off" }.into());
        }
        words.join(", ").trim_end().to_owned()
    }
}

/// As much of a hash as a reader compares.
fn short(hash: &str) -> &str {
    hash.get(..8).unwrap_or(hash)
}

/// A row that is chosen or left out.
pub struct Candidate<'a, G> {
    /// Rows of one group are compared with each other.
    pub group: G,
    /// What it shows.
    pub workload: &'a Workload,
    /// Structure's name.
    pub structure: &'a str,
    /// Its options.
    pub variant: &'a Variant,
}

/// For each candidate, in the order in which they were measured: nothing if its workload is the group's, otherwise the
/// group's.
pub fn choose<'a, G: PartialEq>(candidates: &[Candidate<'a, G>]) -> Vec<Option<&'a Workload>> {
    let mut groups: Vec<Vec<&Candidate<'a, G>>> = Vec::new();
    for candidate in candidates {
        match groups.iter_mut().find(|group| group[0].group == candidate.group) {
            Some(group) => group.push(candidate),
            None => groups.push(vec![candidate]),
        }
    }
    let chosen: Vec<(&G, &'a Workload)> = groups.iter().map(|group| (&group[0].group, best(group))).collect();
    let of_group = |candidate: &Candidate<'a, G>| {
        let (_, workload) = chosen.iter().find(|(group, _)| **group == candidate.group)?;
        (*workload != candidate.workload).then_some(*workload)
    };
    candidates.iter().map(of_group).collect()
}

/// The workload of a group.
fn best<'a, G>(group: &[&Candidate<'a, G>]) -> &'a Workload {
    let rank = |(place, candidate): (usize, &&Candidate<'a, G>)| {
        let same = || group.iter().filter(|c| c.workload == candidate.workload);
        let mut structures: Vec<&str> = same().map(|c| c.structure).collect();
        let mut variants: Vec<(&str, &Variant)> = same().map(|c| (c.structure, c.variant)).collect();
        structures.sort_unstable();
        structures.dedup();
        variants.sort_unstable();
        variants.dedup();
        (structures.len(), variants.len(), place, candidate.workload)
    };
    let ranked = group.iter().enumerate().map(rank);
    // A group has at least the candidate that it was made for
    ranked
        .max_by_key(|(structures, variants, place, _)| (*structures, *variants, *place))
        .map_or(group[0].workload, |r| r.3)
}

/// The frames that fill the rows, and what is said about the others.
pub fn of_frames<T>(rows: Vec<(Frame, T)>, device: impl Fn(usize) -> String) -> (Vec<(Frame, T)>, Vec<String>) {
    let candidates = rows.iter().map(|(frame, _)| Candidate {
        group: (frame.device, frame.scene.clone(), frame.config, frame.width, frame.height),
        workload: &frame.workload,
        structure: &frame.structure,
        variant: &frame.variant,
    });
    let candidates: Vec<_> = candidates.collect();
    let mut left_out: Vec<(usize, SceneKey, String, usize)> = Vec::new();
    let chosen = choose(&candidates);
    for ((frame, _), kept) in rows.iter().zip(&chosen) {
        let Some(kept) = kept else { continue };
        let words = format!("{} (kept: {})", frame.workload.beside(kept), kept.beside(&frame.workload));
        match left_out.iter_mut().find(|l| (l.0, &l.1, &l.2) == (frame.device, &frame.scene, &words)) {
            Some(known) => known.3 += 1,
            None => left_out.push((frame.device, frame.scene.clone(), words, 1)),
        }
    }
    let keep: Vec<bool> = chosen.iter().map(Option::is_none).collect();
    let note = |(index, scene, words, number): &(usize, SceneKey, String, usize)| {
        format!(
            "{} of {scene} on {} left out, because measurements of other frames stand in the same rows: {words}; the \
             ones with most structures are kept, of equals the later ones",
            if *number == 1 { "1 measurement".to_owned() } else { format!("{number} measurements") },
            device(*index),
        )
    };
    let notes = left_out.iter().map(note).collect();
    (rows.into_iter().zip(keep).filter(|(_, keep)| *keep).map(|(row, _)| row).collect(), notes)
}

/// Two devices and what differs between their frames of a scene.
struct Unlike {
    devices: (usize, usize),
    words: String,
    rows: Vec<(Config, u32)>,
}

/// Devices that measured unlike workloads of the same scene, configuration and size: their times are not to be compared.
pub fn unlike_devices(data: &Data) -> Vec<String> {
    let mut pairs: Vec<Unlike> = Vec::new();
    for frame in &data.frames {
        let same = |f: &&Frame| {
            f.device < frame.device
                && f.scene == frame.scene
                && f.structure == frame.structure
                && (f.config, f.width, f.height) == (frame.config, frame.width, frame.height)
        };
        for other in data.frames.iter().filter(same).filter(|f| f.workload != frame.workload) {
            let (here, there) = (frame.workload.beside(&other.workload), other.workload.beside(&frame.workload));
            let (devices, words) = ((other.device, frame.device), format!("{}: {there} / {here}", frame.scene));
            let row = (frame.config, frame.width);
            match pairs.iter_mut().find(|p| p.devices == devices && p.words == words) {
                Some(known) if known.rows.contains(&row) => {}
                Some(known) => known.rows.push(row),
                None => pairs.push(Unlike { devices, words, rows: vec![row] }),
            }
        }
    }
    let label = |device: usize| data.devices[device].label.as_str();
    let note = |p: &Unlike| {
        let (a, b) = (label(p.devices.0), label(p.devices.1));
        let rows: Vec<String> = p.rows.iter().map(|(config, side)| format!("{config:?} {side}")).collect();
        let rows = rows.join(", ");
        format!("{a} and {b} measured unlike frames, so their times do not compare: {} ({rows})", p.words)
    };
    pairs.iter().map(note).collect()
}
