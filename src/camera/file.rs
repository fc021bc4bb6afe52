//! Reads a camera path file (TOML). `camera-paths/README.md` describes the format.

use super::keyframes::{Aim, Key, KeyframePath};
use super::orbit::{LightOrbit, Orbit};
use super::path::{CameraPath, Motion, PathLight};
use super::recorded::{RecordedFrames, RecordedPose};
use crate::error::{Error, Result};
use crate::names;
use crate::scene::placement::MAX_COORDINATE;
use glam::{DVec3, Vec3};
use serde::Deserialize;
use std::ops::Range;
use toml::Spanned;

/// The largest number of frames of a path. All views of a path are held in memory.
const MAX_FRAMES: usize = 1_000_000;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    kind: Spanned<String>,
    #[serde(default)]
    description: String,
    frames: Option<Spanned<usize>>,
    field_of_view: Option<Spanned<f32>>,
    up: Option<Spanned<[f32; 3]>>,
    #[serde(default)]
    lights: Vec<FileLight>,
    // Keys of orbits.
    distance: Option<Spanned<f32>>,
    height: Option<Spanned<f32>>,
    start: Option<Spanned<f32>>,
    light_distance: Option<Spanned<f32>>,
    light_height: Option<Spanned<f32>>,
    light_start: Option<Spanned<f32>>,
    light_colour: Option<Spanned<[f32; 3]>>,
    // Keys of walks.
    relative: Option<Spanned<bool>>,
    keys: Option<Vec<Spanned<FileKey>>>,
    // Recorded frames; a row is time, position, direction, up.
    poses: Option<Spanned<Vec<Spanned<[f64; 10]>>>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileLight {
    position: Spanned<[f64; 3]>,
    colour: Option<Spanned<[f32; 3]>>,
    #[serde(default)]
    relative: bool,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileKey {
    time: Spanned<f32>,
    position: Spanned<[f64; 3]>,
    target: Option<Spanned<[f64; 3]>>,
    direction: Option<Spanned<[f32; 3]>>,
    up: Option<Spanned<[f32; 3]>>,
}

/// Name and text of the file; converts spans of bytes into line numbers.
struct PathText<'a> {
    place: &'a str,
    text: &'a str,
}

impl PathText<'_> {
    fn fault(&self, span: Range<usize>, problem: impl Into<String>, hint: impl Into<String>) -> Error {
        let before = &self.text.as_bytes()[..span.start.min(self.text.len())];
        let line = 1 + before.iter().filter(|&&b| b == b'\n').count();
        Error::file(&names::file(self.place), Some(line), problem, hint)
    }

    /// The given value or `default`.
    ///
    /// # Errors
    /// The value does not lie inside `range` (both bounds excluded).
    fn number(&self, value: &Option<Spanned<f32>>, key: &str, default: f32, range: Range<f32>) -> Result<f32> {
        let Some(given) = value else { return Ok(default) };
        let number = *given.get_ref();
        if number > range.start && number < range.end {
            return Ok(number);
        }
        let hint = format!("it must lie between {} and {}", range.start, range.end);
        Err(self.fault(given.span(), format!("{key} = {number} is out of range"), hint))
    }

    fn vector(&self, value: &Spanned<[f32; 3]>, key: &str) -> Result<Vec3> {
        let vector = Vec3::from(*value.get_ref());
        if vector.is_finite() && vector.abs().max_element() <= MAX_COORDINATE as f32 {
            return Ok(vector);
        }
        Err(self.fault(value.span(), format!("{key} is not finite or too large"), "give three plain numbers"))
    }

    /// A point in the coordinates of the scene's file, or relative to the scene's bounds.
    fn point(&self, value: &Spanned<[f64; 3]>, key: &str) -> Result<DVec3> {
        let point = DVec3::from(*value.get_ref());
        if point.is_finite() && point.abs().max_element() <= MAX_COORDINATE {
            return Ok(point);
        }
        Err(self.fault(value.span(), format!("{key} is not finite or too large"), "give three plain numbers"))
    }

    /// The unit vector of a direction that is not zero.
    fn direction(&self, value: &Spanned<[f32; 3]>, key: &str) -> Result<Vec3> {
        let vector = self.vector(value, key)?.normalize_or_zero();
        if vector == Vec3::ZERO {
            return Err(self.fault(value.span(), format!("{key} is zero"), "give it a direction"));
        }
        Ok(vector)
    }

    fn colour(&self, value: &Option<Spanned<[f32; 3]>>, key: &str) -> Result<Vec3> {
        let Some(given) = value else { return Ok(Vec3::ONE) };
        let colour = self.vector(given, key)?;
        if colour.min_element() < 0.0 {
            return Err(self.fault(given.span(), format!("{key} is negative"), "colours are 0 or more, linear"));
        }
        Ok(colour)
    }

    /// Refuses a key that this kind of path does not have.
    fn refuse<T>(&self, value: &Option<Spanned<T>>, key: &str, kind: &str) -> Result<()> {
        match value {
            None => Ok(()),
            Some(given) => {
                Err(self.fault(given.span(), format!("`{key}` has no meaning for kind {kind}"), "remove it"))
            }
        }
    }
}

/// Parses a path. `name` becomes the path's name; errors name `place` as the file.
pub(super) fn parse(name: &str, place: &str, text: &str) -> Result<CameraPath> {
    let source = PathText { place, text };
    let file: File = toml::from_str(text).map_err(|e| {
        let problem = e.message().lines().collect::<Vec<_>>().join(" ");
        source.fault(e.span().unwrap_or(0..0), problem, "camera-paths/README.md describes the format")
    })?;
    if file.kind.get_ref() != "frames" {
        source.refuse(&file.poses, "poses", file.kind.get_ref())?;
    }
    let mut frames = match &file.frames {
        None => 400,
        Some(frames) if (1..=MAX_FRAMES).contains(frames.get_ref()) => *frames.get_ref(),
        Some(frames) => {
            let hint = format!("it must be 1 to {MAX_FRAMES}");
            return Err(source.fault(frames.span(), format!("frames = {}", frames.get_ref()), hint));
        }
    };
    let up = file.up.as_ref().map_or(Ok(Vec3::Y), |up| source.direction(up, "up"))?;
    let field_of_view = source.number(&file.field_of_view, "field_of_view", 45.0, 0.0..180.0)?;
    let motion = match file.kind.get_ref().as_str() {
        "orbit" => {
            refuse_walk(&source, &file, "orbit")?;
            refuse_light(&source, &file, "orbit")?;
            Motion::Orbit(orbit(&source, &file)?)
        }
        "light-orbit" => {
            refuse_walk(&source, &file, "light-orbit")?;
            if let Some(light) = file.lights.first() {
                let problem = "`lights` have no meaning for kind light-orbit";
                return Err(source.fault(light.position.span(), problem, "its one light is given by light_distance"));
            }
            Motion::LightOrbit(LightOrbit {
                camera: orbit(&source, &file)?,
                light_distance: source.number(&file.light_distance, "light_distance", 2.0, -1e6..1e6)?,
                light_height: source.number(&file.light_height, "light_height", 1.0, -1e6..1e6)?,
                light_start: source.number(&file.light_start, "light_start", 0.0, -1e6..1e6)?,
                light_colour: source.colour(&file.light_colour, "light_colour")?,
            })
        }
        "walk" => {
            refuse_orbit(&source, &file, "walk")?;
            refuse_light(&source, &file, "walk")?;
            Motion::Keyframes(keyframes(&source, &file, up)?)
        }
        "frames" => {
            refuse_walk(&source, &file, "frames")?;
            refuse_orbit(&source, &file, "frames")?;
            refuse_light(&source, &file, "frames")?;
            source.refuse(&file.frames, "frames", "frames: each pose is one")?;
            source.refuse(&file.up, "up", "frames: each pose has its own")?;
            let recorded = recorded(&source, &file)?;
            frames = recorded.poses.len();
            Motion::Recorded(recorded)
        }
        other => {
            let hint = "kinds are orbit, light-orbit, walk, frames";
            return Err(source.fault(file.kind.span(), format!("kind {other:?} is unknown"), hint));
        }
    };
    let lights = file.lights.iter().map(|light| {
        Ok(PathLight {
            position: source.point(&light.position, "position")?,
            colour: source.colour(&light.colour, "colour")?,
            relative: light.relative,
        })
    });
    Ok(CameraPath {
        name: name.to_owned(),
        description: file.description,
        frames,
        field_of_view,
        up,
        motion,
        lights: lights.collect::<Result<_>>()?,
        hash: blake3::hash(text.as_bytes()).to_hex().to_string(),
        place: place.to_owned(),
    })
}

fn refuse_walk(source: &PathText, file: &File, kind: &str) -> Result<()> {
    if let Some(key) = file.keys.as_ref().and_then(|keys| keys.first()) {
        return Err(source.fault(key.span(), format!("`keys` have no meaning for kind {kind}"), "use kind = \"walk\""));
    }
    source.refuse(&file.relative, "relative", kind)
}

fn refuse_orbit(source: &PathText, file: &File, kind: &str) -> Result<()> {
    source.refuse(&file.distance, "distance", kind)?;
    source.refuse(&file.height, "height", kind)?;
    source.refuse(&file.start, "start", kind)
}

fn refuse_light(source: &PathText, file: &File, kind: &str) -> Result<()> {
    source.refuse(&file.light_distance, "light_distance", kind)?;
    source.refuse(&file.light_height, "light_height", kind)?;
    source.refuse(&file.light_start, "light_start", kind)?;
    source.refuse(&file.light_colour, "light_colour", kind)
}

fn orbit(source: &PathText, file: &File) -> Result<Orbit> {
    let distance = match &file.distance {
        None => None,
        given => Some(source.number(given, "distance", 0.0, 0.0..1e6)?),
    };
    let height = source.number(&file.height, "height", 0.5, -1e6..1e6)?;
    Ok(Orbit { distance, height, start: source.number(&file.start, "start", 0.0, -1e6..1e6)? })
}

fn recorded(source: &PathText, file: &File) -> Result<RecordedFrames> {
    let rows = file.poses.as_ref().map(Spanned::get_ref).filter(|rows| (1..=MAX_FRAMES).contains(&rows.len()));
    let Some(rows) = rows else {
        let problem = "recorded frames need `poses`, a row for each";
        let hint = format!("give 1 to {MAX_FRAMES} rows of time, position, direction and up: ten numbers");
        return Err(source.fault(file.kind.span(), problem, hint));
    };
    let pose = |row: &Spanned<[f64; 10]>| {
        let position = DVec3::from_slice(&row.get_ref()[1..4]);
        let vector = |at: usize| DVec3::from_slice(&row.get_ref()[at..at + 3]).as_vec3();
        let fault = |problem: &str| source.fault(row.span(), problem, "repair the row");
        // A unit vector keeps its bits.
        let unit = |v: Vec3| if v.is_normalized() { v } else { v.normalize_or_zero() };
        let (time, direction, up) = (row.get_ref()[0], unit(vector(4)), unit(vector(7)));
        let sound = time.is_finite() && position.is_finite();
        if !sound || position.abs().max_element() > MAX_COORDINATE {
            return Err(fault("time or position is not finite or too large"));
        }
        // This comparison is also false for zero and for NaN.
        if !(direction.cross(up).length() >= 1e-3) {
            return Err(fault("direction or up is zero, or the camera looks along its up vector"));
        }
        Ok(RecordedPose::InFile { position, time, direction, up })
    };
    Ok(RecordedFrames { poses: rows.iter().map(pose).collect::<Result<_>>()? })
}

fn keyframes(source: &PathText, file: &File, up: Vec3) -> Result<KeyframePath> {
    let given = file.keys.as_deref().unwrap_or_default();
    if given.len() < 2 {
        let problem = format!("a walk needs two keys or more, but there are {}", given.len());
        let span = given.first().map_or(file.kind.span(), Spanned::span);
        return Err(source.fault(span, problem, "add [[keys]] with time, position and target"));
    }
    let mut keys: Vec<Key> = Vec::with_capacity(given.len());
    for spanned in given {
        let key = spanned.get_ref();
        let time = *key.time.get_ref();
        let sound = time.is_finite() && time.abs() < 1e9;
        if !sound || keys.last().is_some_and(|before| time <= before.time) {
            let problem = format!("time = {time} is not greater than the time of the key before");
            return Err(source.fault(key.time.span(), problem, "the keys' times must increase"));
        }
        let position = source.point(&key.position, "position")?;
        let aim = match (&key.target, &key.direction) {
            (Some(target), None) => {
                let at = source.point(target, "target")?;
                if at == position {
                    let problem = "the camera's position is its target";
                    return Err(source.fault(target.span(), problem, "move one of them"));
                }
                Aim::Target(at)
            }
            (None, Some(direction)) => Aim::Direction(source.direction(direction, "direction")?),
            _ => {
                let problem = "a key needs either a target or a direction";
                return Err(source.fault(spanned.span(), problem, "give exactly one of them"));
            }
        };
        let own_up = key.up.as_ref().map(|up| source.direction(up, "up")).transpose()?;
        // In relative coordinates the direction to a target depends on the scene; `views` checks it again.
        let along = match aim {
            Aim::Target(target) if !file.relative.as_ref().is_some_and(|r| *r.get_ref()) => {
                (target - position).normalize_or_zero().as_vec3()
            }
            Aim::Direction(direction) => direction,
            Aim::Target(_) => Vec3::ZERO,
        };
        let along = along.normalize_or_zero();
        if along != Vec3::ZERO && along.cross(own_up.unwrap_or(up)).length() < 1e-3 {
            let spans = [key.direction.as_ref().map(Spanned::span), key.target.as_ref().map(Spanned::span)];
            let span = spans.into_iter().flatten().next().unwrap_or(spanned.span());
            return Err(source.fault(span, "the camera looks along its up vector", "give this key another `up`"));
        }
        keys.push(Key { time, position, aim, up: own_up });
    }
    Ok(KeyframePath { keys, relative: file.relative.as_ref().is_some_and(|r| *r.get_ref()) })
}
