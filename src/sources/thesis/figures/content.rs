//! The content of the figures.

use crate::report::figure::{Axis, Bar, Panel, Picture, STYLES, Series, spreads};
use crate::sources::thesis::data::{CONFIGS, Data, Frame};
use crate::sources::thesis::published::{GT8600, GTX280};
use crate::sources::thesis::scenes::SceneKey;
use crate::sources::thesis::structures::{self, STRUCTURES};
use crate::sources::thesis::sweeps::{grid_sweep, resolution_sweep};
use crate::sources::thesis::tables::side::representative;
use crate::sources::thesis::variant::Variant;
use crate::workloads::trace::backend::Config;

/// The suffix of the file's name, the caption, the picture.
type Drawn = (String, String, Picture);

/// A kind of figure.
pub struct Kind {
    /// The figure's number in the thesis, or `bars`.
    pub id: &'static str,
    /// The beginning of its files' names.
    pub file: &'static str,
    /// The figure in a sentence.
    pub what: &'static str,
    /// The published device that the thesis shows in it.
    pub device: &'static str,
    /// What has to be measured for it.
    pub needs: &'static str,
    /// Draws the pictures of a device.
    pub pictures: fn(&Data, usize) -> Vec<Drawn>,
}

/// All kinds, in the thesis's order.
pub const KINDS: [Kind; 5] = [
    Kind {
        id: "5.1",
        file: "figure-5.1",
        what: "figure 5.1",
        device: GTX280,
        needs: "the grid at several resolutions: grid:factor=... or grid:x=...",
        pictures: grid_resolution,
    },
    Kind {
        id: "5.2",
        file: "figure-5.2",
        what: "figure 5.2",
        device: GT8600,
        needs: "grid, kdtree or bvh at two image resolutions or more",
        pictures: image_resolution,
    },
    Kind {
        id: "5.3",
        file: "figure-5.3",
        what: "figure 5.3",
        device: GTX280,
        needs: "pattern=four at three image resolutions or more",
        pictures: four_rays,
    },
    Kind {
        id: "5.4",
        file: "figure-5.4",
        what: "figure 5.4",
        device: GTX280,
        needs: "tiles=N at two image resolutions or more",
        pictures: tiles,
    },
    Kind {
        id: "bars",
        file: "frame-times",
        what: "bars of frame times",
        device: GTX280,
        needs: "frame times",
        pictures: bars,
    },
];

fn words(config: Config) -> &'static str {
    match config {
        Config::P => "primary rays",
        Config::PS => "primary and shadow rays",
        Config::PSR => "primary, shadow and reflected rays",
        Config::AO => "primary and ambient rays",
        Config::DIFFUSE => "primary and diffuse rays",
    }
}

/// A panel of lines; the axes follow from the points.
fn panel(title: String, x_label: &str, series: Vec<Series>) -> Panel {
    let points = || series.iter().flat_map(|s| &s.points);
    Panel {
        title,
        x: Axis::of_sizes(x_label, points().map(|p| p.0)),
        y: Axis::of_values(TIME, true, points().map(|p| p.1)),
        series,
        groups: Vec::new(),
        bars: Vec::new(),
        bands: Vec::new(),
        marks: Vec::new(),
    }
}

const TIME: &str = "mean frame time [ms]";

/// Panels under one title; their axes of time are all linear, or all logarithmic if one panel asks for it.
fn picture(title: String, mut panels: Vec<Panel>) -> Picture {
    fn times(panel: &Panel) -> impl Iterator<Item = f64> {
        panel.series.iter().flat_map(|s| s.points.iter().map(|p| p.1))
    }
    let log = panels.iter().any(|panel| spreads(times(panel)));
    for panel in panels.iter_mut().filter(|panel| panel.bars.is_empty()) {
        panel.y = Axis::of_values(TIME, log, times(panel));
    }
    let columns = match panels.len() {
        1 => 1,
        2 | 4 => 2,
        _ => 3,
    };
    Picture { title, panels, columns }
}

/// Figure 5.1: one line per scene.
fn grid_resolution(data: &Data, device: usize) -> Vec<Drawn> {
    let mut drawn = Vec::new();
    for config in CONFIGS {
        let mut series = Vec::new();
        for scene in &data.scenes {
            let points = grid_sweep(data, device, &scene.key, config);
            if points.len() < 2 {
                continue;
            }
            let value = |p: &crate::sources::thesis::sweeps::Point| (f64::from(p.cells), p.frame.mean_ms);
            let side = points[0].frame.width;
            series.push(Series {
                label: format!("{} at {side}x{side}", scene.key),
                style: series.len() % STYLES,
                // Beyond the last colour, colours begin again with hollow markers
                faint: series.len() >= STYLES,
                ringed: points.iter().find(|p| p.is_rule).map(value),
                points: points.iter().map(value).collect(),
            });
        }
        if !series.is_empty() {
            let title = format!("Frame time against grid resolution, {config:?}, {}", data.devices[device].label);
            let panel = panel(String::new(), "cells on the shortest side", series);
            let caption =
                format!("Figure 5.1: frame time against grid resolution ({}); ringed: the rule.", words(config));
            drawn.push((format!("-{config:?}").to_lowercase(), caption, picture(title, vec![panel])));
        }
    }
    drawn
}

fn values(frames: &[&Frame]) -> Vec<(f64, f64)> {
    frames.iter().map(|f| (f64::from(f.width), f.mean_ms)).collect()
}

/// A line over image sides.
fn line(label: String, style: usize, faint: bool, frames: &[&Frame]) -> Series {
    Series { label, style, faint, points: values(frames), ringed: None }
}

const SIDE: &str = "pixels a side";

/// Figure 5.2: a panel per scene, a line per structure.
fn image_resolution(data: &Data, device: usize) -> Vec<Drawn> {
    let mut drawn = Vec::new();
    for config in CONFIGS {
        let mut panels = Vec::new();
        for scene in &data.scenes {
            let of = |structure: &&str| {
                let variant = Variant::of_thesis(scene.key.thesis(), structure);
                let frames = resolution_sweep(data, device, &scene.key, (structure, &variant), config);
                let title = structures::title(structure).to_owned();
                (frames.len() > 1).then(|| line(title, structures::colour(structure), false, &frames))
            };
            let series: Vec<Series> = STRUCTURES.iter().filter_map(of).collect();
            if !series.is_empty() {
                panels.push(panel(scene.key.to_string(), SIDE, series));
            }
        }
        if !panels.is_empty() {
            let title = format!("Frame time against image resolution, {config:?}, {}", data.devices[device].label);
            let caption = format!("Figure 5.2: frame time against image resolution ({}).", words(config));
            drawn.push((format!("-{config:?}").to_lowercase(), caption, picture(title, panels)));
        }
    }
    drawn
}

/// Figure 5.3: the fine sweep, of the picture and of four distinct rays; a panel per scene.
fn four_rays(data: &Data, device: usize) -> Vec<Drawn> {
    let mut panels = Vec::new();
    for scene in &data.scenes {
        let mut series = Vec::new();
        for structure in STRUCTURES {
            let base = Variant::of_thesis(scene.key.thesis(), structure);
            let variants = variants_with(data, &scene.key, structure, |v| v.is(&base, "pattern", "four"));
            let Some(four) = variants.first() else { continue };
            let sweep = |variant: &Variant| resolution_sweep(data, device, &scene.key, (structure, variant), Config::P);
            let frames = sweep(four);
            if frames.len() < 3 {
                continue;
            }
            let style = structures::colour(structure);
            series.push(line(format!("{}, four rays", structures::title(structure)), style, false, &frames));
            // Only sizes that both have: other sizes of the image are no part of the fine sweep
            let both = |f: &&Frame| frames.iter().any(|four| four.width == f.width);
            let frames: Vec<&Frame> = sweep(&base).into_iter().filter(both).collect();
            if frames.len() > 1 {
                series.push(line(format!("{}, image", structures::title(structure)), style, true, &frames));
            }
        }
        if !series.is_empty() {
            panels.push(panel(scene.key.to_string(), SIDE, series));
        }
    }
    if panels.is_empty() {
        return Vec::new();
    }
    let title = format!("Fine sweep of image resolutions, P, {}", data.devices[device].label);
    let caption =
        "Figure 5.3: frame time in a fine sweep of resolutions: of the image, and of four distinct rays repeated \
                   over it, so that every block does the same at every resolution."
            .into();
    vec![(String::new(), caption, picture(title, panels))]
}

/// Figure 5.4: the image as a whole and in tiles; a panel per scene and structure.
fn tiles(data: &Data, device: usize) -> Vec<Drawn> {
    let mut panels = Vec::new();
    for scene in &data.scenes {
        for structure in STRUCTURES {
            let base = Variant::of_thesis(scene.key.thesis(), structure);
            let number =
                |v: &Variant| v.only_beyond(&base).and_then(|(k, n)| n.parse::<u32>().ok().filter(|_| k == "tiles"));
            let mut variants = variants_with(data, &scene.key, structure, |v| number(v).is_some());
            variants.sort_by_key(|v| number(v));
            let sweep = |v: &Variant| resolution_sweep(data, device, &scene.key, (structure, v), Config::P);
            let whole = sweep(&base);
            let tiled = variants.into_iter().map(|v| (number(v).unwrap_or(1), sweep(v)));
            let all = [(1, whole)].into_iter().chain(tiled).filter(|(_, frames)| frames.len() > 1);
            let label = |n: u32| if n == 1 { "whole image".into() } else { format!("{n}x{n} tiles") };
            let series: Vec<Series> =
                all.enumerate().map(|(style, (n, frames))| line(label(n), style, false, &frames)).collect();
            if series.len() > 1 {
                panels.push(panel(format!("{}, {}", scene.key, structures::title(structure)), SIDE, series));
            }
        }
    }
    if panels.is_empty() {
        return Vec::new();
    }
    let title = format!("The image split into tiles, P, {}", data.devices[device].label);
    let caption =
        "Figure 5.4: frame time where the image is split into tiles that are rendered one after another.".into();
    vec![(String::new(), caption, picture(title, panels))]
}

/// Variants of a structure that were measured of a scene, each once.
fn variants_with<'a>(
    data: &'a Data,
    scene: &SceneKey,
    structure: &str,
    wanted: impl Fn(&Variant) -> bool,
) -> Vec<&'a Variant> {
    let of = data.frames.iter().filter(|f| f.scene == *scene && f.structure == structure && wanted(&f.variant));
    let mut variants: Vec<&Variant> = of.map(|f| &f.variant).collect();
    variants.sort();
    variants.dedup();
    variants
}

/// Bars of frame times: groups by scene, a bar per structure with its default options.
fn bars(data: &Data, device: usize) -> Vec<Drawn> {
    CONFIGS.into_iter().filter_map(|config| bars_of(data, device, config)).collect()
}

fn bars_of(data: &Data, device: usize, config: Config) -> Option<Drawn> {
    let default = |f: &&Frame| {
        (f.device, f.config) == (device, config)
            && f.width == f.height
            && f.variant == Variant::of_thesis(f.scene.thesis(), &f.structure)
    };
    let side = representative(data, |f| (f.device, f.config) == (device, config))?;
    let frames: Vec<&Frame> = data.frames.iter().filter(default).filter(|f| f.width == side).collect();
    let mut structures: Vec<&str> = frames.iter().map(|f| f.structure.as_str()).collect();
    structures.sort_by_key(|s| (structures::colour(s), *s));
    structures.dedup();
    let with_bars = |key: &&SceneKey| frames.iter().any(|f| f.scene == **key);
    let scenes: Vec<&SceneKey> = data.scenes.iter().map(|s| &s.key).filter(with_bars).collect();
    let width = 0.84 / structures.len() as f64;
    let mut bars = Vec::new();
    for (group, scene) in scenes.iter().enumerate() {
        for (index, structure) in structures.iter().enumerate() {
            let Some(frame) = frames.iter().find(|f| f.scene == **scene && f.structure == *structure) else { continue };
            let from = group as f64 - 0.42 + width * index as f64;
            bars.push(Bar {
                label: structures::title(structure).to_owned(),
                style: structures::colour(structure),
                span: (from, from + 0.92 * width),
                mean: frame.mean_ms,
                whiskers: (frame.min_ms, frame.max_ms),
            });
        }
    }
    let heights = || bars.iter().flat_map(|b| [b.mean, b.whiskers.0, b.whiskers.1]);
    let y = Axis::of_values("frame time [ms]", spreads(heights()), heights());
    let groups: Vec<String> = scenes.iter().map(|key| key.to_string()).collect();
    let x = Axis {
        label: "bar: mean over frames; whiskers: fastest and slowest frame".into(),
        log: false,
        range: (-0.5, groups.len() as f64 - 0.5),
        ticks: (0..groups.len()).map(|group| group as f64).collect(),
    };
    let label = &data.devices[device].label;
    let panel =
        Panel { title: String::new(), x, y, series: Vec::new(), groups, bars, bands: Vec::new(), marks: Vec::new() };
    let title = format!("Frame times at {side}x{side}, {config:?}, {label}");
    let caption = format!("Frame times at {side}x{side} ({}).", words(config));
    Some((format!("-{config:?}").to_lowercase(), caption, picture(title, vec![panel])))
}
