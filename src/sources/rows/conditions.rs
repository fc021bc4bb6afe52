//! Frames that may fill the same rows, because they were measured under the same conditions ([`crate::compare::pair`]).

use super::{Device, Frame};
use crate::compare::pair::{Comparable, choose};
use crate::workloads::trace::backend::Config;
use std::collections::HashMap;
use std::fmt::Display;
use std::hash::Hash;

/// The frames that fill the rows, and a note on the others.
pub fn choose_frames<S: Clone + Eq + Hash + Display, T>(
    rows: Vec<(Frame<S>, T)>,
    devices: &[Device],
) -> (Vec<(Frame<S>, T)>, Vec<String>) {
    let comparable = rows.iter().map(|(frame, _)| Comparable {
        group: (frame.device, frame.scene.clone(), frame.config, frame.width, frame.height),
        conditions: &frame.conditions,
        structure: &frame.structure,
        variant: &frame.variant,
    });
    let comparable: Vec<_> = comparable.collect();
    let mut left_out: Vec<(usize, S, String, usize)> = Vec::new();
    let chosen = choose(&comparable);
    for ((frame, _), kept) in rows.iter().zip(&chosen) {
        let Some(kept) = kept else { continue };
        let (here, there) = (frame.conditions.difference_from(kept), kept.difference_from(&frame.conditions));
        let words = format!("{here} (kept: {there})");
        match left_out.iter_mut().find(|l| (l.0, &l.1, &l.2) == (frame.device, &frame.scene, &words)) {
            Some(known) => known.3 += 1,
            None => left_out.push((frame.device, frame.scene.clone(), words, 1)),
        }
    }
    let keep: Vec<bool> = chosen.iter().map(Option::is_none).collect();
    let note = |(index, scene, words, number): &(usize, S, String, usize)| {
        format!(
            "{} of {scene} on {} left out, because measurements of other frames are in the same rows: {words}; the \
             ones with most structures are kept, of equals the later ones",
            if *number == 1 { "1 measurement".to_owned() } else { format!("{number} measurements") },
            devices[*index].label,
        )
    };
    let notes = left_out.iter().map(note).collect();
    (rows.into_iter().zip(keep).filter(|(_, keep)| *keep).map(|(row, _)| row).collect(), notes)
}

/// Two devices and the difference between their frames of a scene.
struct Difference {
    devices: (usize, usize),
    words: String,
    rows: Vec<(Config, u32)>,
}

/// Notes on devices that measured the same scene, configuration and size under unlike conditions: their times do not
/// compare.
pub fn unlike_devices<S: Clone + Eq + Hash + Display>(devices: &[Device], frames: &[Frame<S>]) -> Vec<String> {
    if devices.len() < 2 {
        return Vec::new();
    }
    let place = |f: &Frame<S>| (f.scene.clone(), f.structure.clone(), f.config, f.width, f.height);
    let mut places: HashMap<_, Vec<&Frame<S>>> = HashMap::new();
    for frame in frames.iter() {
        places.entry(place(frame)).or_default().push(frame);
    }
    let mut found: Vec<Difference> = Vec::new();
    for frame in frames.iter() {
        let others = places.get(&place(frame)).into_iter().flatten().filter(|f| f.device < frame.device);
        for other in others.filter(|f| f.conditions != frame.conditions) {
            let here = frame.conditions.difference_from(&other.conditions);
            let there = other.conditions.difference_from(&frame.conditions);
            let (devices, words) = ((other.device, frame.device), format!("{}: {there} / {here}", frame.scene));
            let row = (frame.config, frame.width);
            match found.iter_mut().find(|p| p.devices == devices && p.words == words) {
                Some(known) if known.rows.contains(&row) => {}
                Some(known) => known.rows.push(row),
                None => found.push(Difference { devices, words, rows: vec![row] }),
            }
        }
    }
    let label = |device: usize| devices[device].label.as_str();
    let note = |p: &Difference| {
        let (a, b) = (label(p.devices.0), label(p.devices.1));
        let rows: Vec<String> = p.rows.iter().map(|(config, side)| format!("{config:?} {side}")).collect();
        let rows = rows.join(", ");
        format!("{a} and {b} measured unlike frames, so their times do not compare: {} ({rows})", p.words)
    };
    found.iter().map(note).collect()
}
