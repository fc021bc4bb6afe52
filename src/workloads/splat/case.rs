//! A case of photon splatting, typed; the harness knows it as axes.

use super::cluster_axes::{self, Clustering};
use super::lights::LightChoice;
use super::radius::Radius;
use super::setting::{Energy, Falloff, MAX_HITS, Setting};
use super::technique::Technique;
use crate::error::{Error, Result};
use crate::harness::parse_list;
use crate::harness::workload::{Case, Part};
use crate::workloads::size::{Size, parse_size};
use crate::workloads::trace::Selection;
use crate::workloads::words::{flag, name, word};

/// What one row measures.
#[derive(Clone, Debug, PartialEq)]
pub struct SplatCase {
    /// How indirect light is estimated.
    pub technique: Technique,
    /// Structure and traversal that all rays take, with their options.
    pub selection: Selection,
    /// What decides the photons.
    pub setting: Setting,
    /// The radius of photons.
    pub radius: Radius,
    /// The clusters of techniques that have any. `tiled` has tiles only.
    pub clustering: Option<Clustering>,
    /// Lights as given, see [`light_choices`]; empty for the scene's.
    pub light: String,
    /// Name or file of the camera path; empty for the scene's own.
    pub camera_path: String,
    /// Image size.
    pub size: Size,
    /// Frames that the camera path is thinned to; all where absent.
    pub frames: Option<usize>,
}

const FALLOFFS: [(&str, Falloff); 2] = [("square", Falloff::Square), ("source", Falloff::Source)];
const ENERGIES: [(&str, Energy); 2] = [("flux", Energy::Flux), ("shared", Energy::Shared)];

/// Values of axes for which neither the preset nor the user gives one.
const DEFAULTS: [(&str, &str); 17] = [
    ("technique", "per-sample"),
    ("structure", "bvh-stack"),
    ("paths", "5667"),
    ("hits", "4"),
    ("seed", "1"),
    ("radius", "0.03"),
    ("falloff", "square"),
    ("energy", "flux"),
    ("tile", "32"),
    ("key", "morton"),
    ("normals", "off"),
    ("unique", "flags"),
    ("bounds", "direct"),
    ("hierarchy", "masks"),
    ("space", "view"),
    ("capacity", "33554432"),
    ("sync", "device"),
];

/// Of all pairs of a sample and a photon, techniques with clusters are taken to test one in this many: at the radius
/// that the source's load follows from it is one in 15 to 30, at usable ones one in a hundred and more.
const CLUSTERED: u64 = 100;

/// The value of the axis `frames` for all frames of a path, until the path is read.
const ALL_FRAMES: &str = "all";

/// The value of the axes `light` and `camera_path` where the scene's own are taken.
const OF_SCENE: &str = "";

/// A whole number in a range.
///
/// # Errors
/// [`Error::Input`] for any other text.
pub(super) fn number(axis: &str, text: &str, range: std::ops::RangeInclusive<u32>) -> Result<u32> {
    let number = text.parse().ok().filter(|number| range.contains(number));
    number.ok_or_else(|| {
        let hint = format!("give {} to {}", range.start(), range.end());
        Error::argument(flag(axis), format!("'{text}' is no number in its range"), hint)
    })
}

/// Number of paths. A path's number is a float of a photon, so that 2^24 is the limit.
fn paths(text: &str) -> Result<u32> {
    number("paths", text, 1..=1 << 24)
}

fn hits(text: &str) -> Result<u32> {
    number("hits", text, 2..=MAX_HITS)
}

fn seed(text: &str) -> Result<u32> {
    number("seed", text, 0..=u32::MAX)
}

/// The values of an axis, or its default.
pub(super) fn values<T: PartialEq>(part: &Part, axis: &str, parse: impl Fn(&str) -> Result<T>) -> Result<Vec<T>> {
    match part.of(axis) {
        [] => {
            let default = DEFAULTS.iter().find(|(name, _)| *name == axis).map_or("", |(_, value)| value);
            Ok(vec![parse(default)?])
        }
        texts => parse_list(texts, parse),
    }
}

impl SplatCase {
    /// Every combination of the values of a part, each once. Scenes are not among them.
    ///
    /// # Errors
    /// [`Error::Input`] for the first value that cannot be.
    pub fn all(part: &Part) -> Result<Vec<SplatCase>> {
        let of_scene = |axis: &str| match part.of(axis) {
            [] => vec![OF_SCENE.to_owned()],
            texts => texts.to_vec(),
        };
        let (lights, camera_paths) = (of_scene("light"), of_scene("camera_path"));
        for light in &lights {
            light_choices(light)?;
        }
        if part.of("resolution").is_empty() {
            return Err(Error::argument("--resolution", "no resolution is given", "give --resolution"));
        }
        let sizes = parse_list(part.of("resolution"), parse_size)?;
        let settings = settings(part)?;
        let radii = values(part, "radius", Radius::parse)?;
        let techniques = values(part, "technique", Technique::parse_all)?.concat();
        let selections = values(part, "structure", Selection::parse_all)?.concat();
        cluster_axes::check_given(part, &techniques)?;
        let mut ways: Vec<(Technique, Option<Clustering>)> = Vec::new();
        for &technique in &techniques {
            match technique.gather.has_tiles() {
                true => ways.extend(Clustering::all(part, technique)?.into_iter().map(|c| (technique, Some(c)))),
                false => ways.push((technique, None)),
            }
        }
        let mut cases = Vec::new();
        for (light, camera_path) in lights.iter().flat_map(|light| camera_paths.iter().map(move |path| (light, path))) {
            for (&size, &setting) in sizes.iter().flat_map(|size| settings.iter().map(move |setting| (size, setting))) {
                for (&radius, selection) in radii.iter().flat_map(|radius| selections.iter().map(move |s| (radius, s)))
                {
                    for &(technique, clustering) in &ways {
                        let (selection, light) = (selection.clone(), light.clone());
                        let (camera_path, frames) = (camera_path.clone(), part.frames);
                        let case = SplatCase {
                            technique,
                            selection,
                            setting,
                            radius,
                            clustering,
                            light,
                            camera_path,
                            size,
                            frames,
                        };
                        if !cases.contains(&case) {
                            cases.push(case);
                        }
                    }
                }
            }
        }
        Ok(cases)
    }

    /// For the harness.
    pub fn to_case(&self, scene: &str) -> Case {
        let SplatCase { technique, selection, setting, radius, clustering, light, camera_path, size, frames } = self;
        let resolution = format!("{}x{}", size.width, size.height);
        let frames_text = frames.map_or(ALL_FRAMES.to_owned(), |frames| frames.to_string());
        let axes = [
            ("scene", scene.to_owned()),
            ("technique", technique.name().to_owned()),
            ("light", light.clone()),
            ("camera_path", camera_path.clone()),
            ("structure", selection.name().to_owned()),
            ("paths", setting.paths.to_string()),
            ("hits", setting.hits.to_string()),
            ("seed", setting.seed.to_string()),
            ("radius", radius.to_string()),
            ("falloff", name(&FALLOFFS, setting.falloff).to_owned()),
            ("energy", name(&ENERGIES, setting.energy).to_owned()),
            ("resolution", resolution.clone()),
            ("frames", frames_text.clone()),
        ];
        let of_technique = technique.axes().into_iter().filter(|(axis, value)| is_kept(axis, value));
        let options = selection.option_axes().into_iter().chain(of_technique);
        let clustering = clustering.iter().flat_map(Clustering::axes);
        let axes = axes.into_iter().chain(options).chain(clustering).map(|(axis, value)| (axis.to_owned(), value));
        Case {
            axes: axes.collect(),
            input: scene.to_owned(),
            group: selection.full_name(),
            turn: format!("{resolution} {frames_text} {camera_path} {light}").trim_end().to_owned(),
            device: 0,
            work: self.tests().saturating_mul(frames.unwrap_or(1) as u64),
        }
    }

    /// Distances between samples and photons that a frame computes at most; of techniques with clusters, which find the
    /// photons near a sample, a hundredth of all.
    pub fn tests(&self) -> u64 {
        let all = self.setting.slots().saturating_mul(self.size.pixels() as u64);
        if self.technique.gather.has_clusters() { all / CLUSTERED } else { all }
    }

    /// Reads what [`SplatCase::to_case`] wrote.
    ///
    /// # Errors
    /// [`Error::Input`] for a case of another origin.
    pub fn parse(case: &Case) -> Result<SplatCase> {
        let frames = match case.axis("frames") {
            ALL_FRAMES => None,
            number => Some(number.parse().map_err(|_| Error::argument("--frames", format!("{number:?}"), ""))?),
        };
        Ok(SplatCase {
            technique: Technique::of_axes(|axis| case.axis(axis))?,
            selection: Selection::parse(&case.group)?,
            setting: Setting {
                paths: paths(case.axis("paths"))?,
                hits: hits(case.axis("hits"))?,
                seed: seed(case.axis("seed"))?,
                falloff: word("falloff", &FALLOFFS, case.axis("falloff"))?,
                energy: word("energy", &ENERGIES, case.axis("energy"))?,
            },
            radius: Radius::parse(case.axis("radius"))?,
            clustering: Clustering::of_axes(|axis| case.axis(axis))?,
            light: case.axis("light").to_owned(),
            camera_path: case.axis("camera_path").to_owned(),
            size: parse_size(case.axis("resolution"))?,
            frames,
        })
    }
}

/// An option without effect is no axis of a case, but for those that rows have always had.
fn is_kept(axis: &str, value: &str) -> bool {
    !value.is_empty() || ["kernel", "weight"].contains(&axis)
}

/// Every combination of what decides the photons.
fn settings(part: &Part) -> Result<Vec<Setting>> {
    let falloffs = values(part, "falloff", |text| word("falloff", &FALLOFFS, text))?;
    let energies = values(part, "energy", |text| word("energy", &ENERGIES, text))?;
    let seeds = values(part, "seed", seed)?;
    let hits = values(part, "hits", hits)?;
    let mut all = Vec::new();
    for paths in values(part, "paths", paths)? {
        for &hits in &hits {
            for &seed in &seeds {
                for &falloff in &falloffs {
                    all.extend(energies.iter().map(|&energy| Setting { paths, hits, seed, falloff, energy }));
                }
            }
        }
    }
    Ok(all)
}

/// The lights of a value of `--light`: `point:x=,y=,z=[,flux=]`, several joined by `+`; none where it is empty.
///
/// # Errors
/// Those of [`LightChoice::parse`].
pub fn light_choices(text: &str) -> Result<Vec<LightChoice>> {
    // A number may have a plus sign, a light begins with a name
    let mut lights: Vec<String> = Vec::new();
    for piece in text.split('+') {
        match lights.last_mut() {
            Some(last) if piece.starts_with(|first: char| first.is_ascii_digit()) => {
                last.push('+');
                last.push_str(piece);
            }
            _ => lights.push(piece.to_owned()),
        }
    }
    match text.is_empty() {
        true => Ok(Vec::new()),
        false => lights.iter().map(|light| LightChoice::parse(light)).collect(),
    }
}
