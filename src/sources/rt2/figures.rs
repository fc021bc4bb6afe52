//! Bar charts like the document's figures 4.4 to 4.6, and one of steps per ray.

use super::data::{Cost, Data, Measurement};
use super::models::SceneKey;
use super::published::Published;
use super::structures::{BVH, CULLED, KDTREES, MIN_MAX, ROPES, SORT, STACK, SWEEP, SWEPT, Structure, WITH_ROPES};
use crate::error::Result;
use crate::report::figure::{Axis, Bar, Figure, Missing, Panel, Picture, spreads};
use crate::sources::rows::{BuiltBy, builders};

/// The number of groups of bars whose names have room next to each other.
const GROUPS: usize = 5;

/// What the bars of a structure show of a scene: the height, and the lower and upper end of the whiskers.
type Height = (f64, (f64, f64));

/// Structures with their colours.
type Bars<'a> = &'a [&'a Structure];

/// What the three figures and the one of steps need.
const NEEDS: [(&str, &str, &str); 4] = [
    (
        "4.4",
        "figure 4.4",
        "frame times of the kd-tree with a stack or ropes, or of the swept BVH (its own numbers are in no text)",
    ),
    ("4.5", "figure 4.5", "build times of builders that sort in every node (its own numbers are in no text)"),
    ("4.6", "figure 4.6", "a kd-tree with a stack or ropes, or a swept BVH (its own numbers are in no text)"),
    ("steps", "steps per ray", "counts of the kd-tree with a stack or ropes, or of the swept BVH"),
];

/// All figures that there is data for, and the others.
///
/// # Errors
/// None in practice: drawing goes to memory.
pub fn all(data: Option<&Data>, published: &Published) -> Result<(Vec<Figure>, Vec<Missing>)> {
    let mut figures = Vec::new();
    if let Some(data) = data {
        for device in 0..data.devices.len() {
            figures.extend(of_device(data, published, device)?);
        }
        for (index, by) in builders(data.built.iter()).iter().enumerate() {
            figures.extend(build_times(data, index, by)?);
        }
        figures.extend(memory(data)?);
    }
    let absent = NEEDS.iter().filter(|(id, ..)| !figures.iter().any(|figure| figure.id == *id));
    let missing = absent.map(|(id, what, needs)| Missing { id, what: (*what).into(), needs }).collect();
    figures.sort_by_key(|figure| NEEDS.iter().position(|(id, ..)| *id == figure.id));
    Ok((figures, missing))
}

/// The end of the names of a further device's or builder's figures.
fn end_of_names(what: &str, index: usize) -> String {
    if index == 0 { String::new() } else { format!("-{what}{}", index + 1) }
}

/// Figure 4.4 and the steps per ray of a device.
fn of_device(data: &Data, published: &Published, device: usize) -> Result<Vec<Figure>> {
    let size = data.size(device, published.size(), None);
    let label = format!("{}x{}, P, {}", size.0, size.1, data.devices[device].label);
    let at = |scene: &SceneKey, structure: &Structure| data.measurement((device, size), scene, structure);
    let rate = |scene: &SceneKey, structure: &Structure| {
        let times = &at(scene, structure)?.frame;
        let per_second = Measurement::per_second;
        Some((per_second(times.mean_ms), (per_second(times.max_ms), per_second(times.min_ms))))
    };
    let steps = |scene: &SceneKey, structure: &Structure| {
        at(scene, structure)?.cost(Cost::Steps).map(|steps| (steps.value, (steps.value, steps.value)))
    };
    let (scenes, end) = (data.scenes_of(device), end_of_names("device", device));
    let bars: Bars = &[&ROPES, &STACK, &BVH, &CULLED];
    let first = draw(&scenes, bars, rate, ("frames per second", "whiskers: slowest and fastest frame"), &label)?;
    let second = draw(&scenes, bars, steps, ("steps per ray", "inner nodes and leaves per primary ray"), &label)?;
    let figure = |picture: Option<Picture>, id, file: &str, caption: &str| {
        picture.map(|picture| Figure::draw(id, format!("{file}{end}"), format!("{caption} ({label})."), &picture))
    };
    let figures = [
        figure(first, "4.4", "figure-4.4", "Figure 4.4: frames per second"),
        figure(second, "steps", "steps-per-ray", "Inner nodes and leaves per primary ray"),
    ];
    figures.into_iter().flatten().collect()
}

/// Figure 4.5 of a builder.
fn build_times(data: &Data, index: usize, by: &BuiltBy) -> Result<Option<Figure>> {
    let time = |scene: &SceneKey, structure: &Structure| {
        data.built(Some(*by), scene, &[structure])?.build_ms.map(|ms| (ms, (ms, ms)))
    };
    let bars: Bars = &[&MIN_MAX, &SWEEP, &SORT];
    let label = by.in_words();
    let axis = ("build time [ms]", "BVH and sort sort in every node");
    let Some(picture) = draw(&data.scenes_built(), bars, time, axis, &label)? else { return Ok(None) };
    let name = format!("figure-4.5{}", end_of_names("builder", index));
    Figure::draw("4.5", name, format!("Figure 4.5: build times ({label})."), &picture).map(Some)
}

/// Figure 4.6: bytes of the model.
fn memory(data: &Data) -> Result<Option<Figure>> {
    let size = |scene: &SceneKey, structure: &Structure| {
        let any = [KDTREES, SWEPT, WITH_ROPES].into_iter().find(|trees| trees.contains(&structure))?;
        let bytes = data.built(None, scene, any)?.memory?.rt2_bytes;
        let mib = bytes as f64 / f64::from(1 << 20);
        (bytes > 0).then_some((mib, (mib, mib)))
    };
    let bars: Bars = &[&STACK, &BVH, &ROPES];
    let axis = ("memory [MiB]", "by the model, without geometry");
    let Some(picture) = draw(&data.scenes_built(), bars, size, axis, "by the model")? else { return Ok(None) };
    let caption = "Figure 4.6: memory of structures by the model, without geometry.".into();
    Figure::draw("4.6", "figure-4.6".into(), caption, &picture).map(Some)
}

/// Bars in groups by scene, in panels of a few groups; `None` without any bar.
fn draw(
    scenes: &[SceneKey],
    structures: Bars,
    height: impl Fn(&SceneKey, &Structure) -> Option<Height>,
    (y_label, x_label): (&str, &str),
    label: &str,
) -> Result<Option<Picture>> {
    let with_bars: Vec<&SceneKey> =
        scenes.iter().filter(|scene| structures.iter().any(|s| height(scene, s).is_some())).collect();
    if with_bars.is_empty() {
        return Ok(None);
    }
    let all: Vec<f64> = with_bars
        .iter()
        .flat_map(|scene| structures.iter().filter_map(|s| height(scene, s)))
        .flat_map(|(mean, whiskers)| [mean, whiskers.0, whiskers.1])
        .collect();
    let log = spreads(all.iter().copied());
    // Counterparts of the document's models first; a panel that is not full has bars of the same width
    let (models, others): (Vec<&SceneKey>, Vec<&SceneKey>) = with_bars.iter().partition(|s| s.model().is_some());
    let widest = models.len().max(others.len()).min(GROUPS);
    let panels = models.chunks(GROUPS).chain(others.chunks(GROUPS)).map(|scenes| {
        let (bars, groups) = bars(scenes, structures, &height);
        let x = Axis {
            label: x_label.into(),
            log: false,
            range: (-0.5, widest as f64 - 0.5),
            ticks: (0..groups.len()).map(|group| group as f64).collect(),
        };
        // One axis for all panels, so that their bars compare
        let y = Axis::of_values(y_label, log, all.iter().copied());
        Panel { title: String::new(), x, y, series: Vec::new(), groups, bars, bands: Vec::new(), marks: Vec::new() }
    });
    let mut title = y_label.split(" [").next().unwrap_or(y_label).to_owned();
    title = crate::report::html::capital(&title);
    Ok(Some(Picture { title: format!("{title}, {label}"), panels: panels.collect(), columns: 1 }))
}

fn bars(
    scenes: &[&SceneKey],
    structures: Bars,
    height: &impl Fn(&SceneKey, &Structure) -> Option<Height>,
) -> (Vec<Bar>, Vec<String>) {
    let width = 0.84 / structures.len() as f64;
    let mut bars = Vec::new();
    for (group, scene) in scenes.iter().enumerate() {
        for (index, structure) in structures.iter().enumerate() {
            let Some((mean, whiskers)) = height(scene, structure) else { continue };
            let from = group as f64 - 0.42 + width * index as f64;
            let label = structure.title.to_owned();
            bars.push(Bar { label, style: structure.colour, span: (from, from + 0.92 * width), mean, whiskers });
        }
    }
    (bars, scenes.iter().map(|scene| scene.short()).collect())
}
