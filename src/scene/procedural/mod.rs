//! Built-in scenes: the same triangles on every machine, of any size, for every character that a structure may meet.
//!
//! A scene is one file with an `INFO` in it and one line in `SCENES`. All have the parameter `triangles`, which they
//! meet within a few percent. Lengths are metres, y points up.

mod hall;
mod mesh;
mod noise;
mod room;
mod scan;
mod shapes;
mod sphereflake;
mod stadium;
mod surface_nets;
mod teapot;
mod terrain;

use super::{Light, Scene, did_you_mean};
use crate::error::{Error, Result};
use glam::Vec3;

/// A parameter of a built-in scene: a whole number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parameter {
    /// As written in `name:key=value`.
    pub name: &'static str,
    /// One line.
    pub meaning: &'static str,
    /// Value if not given.
    pub default: u64,
    /// Smallest value.
    pub min: u64,
    /// Largest value.
    pub max: u64,
}

impl Parameter {
    /// The parameter that every scene has.
    const fn triangles(default: u64, min: u64) -> Parameter {
        Parameter { name: "triangles", meaning: "number of triangles, approximately", default, min, max: 8_000_000 }
    }
}

/// A built-in scene.
#[derive(Clone, Copy, Debug)]
pub struct SceneInfo {
    /// As given to [`crate::scene::load`].
    pub name: &'static str,
    /// What is peculiar about it, one line.
    pub character: &'static str,
    /// What can be set.
    pub parameters: &'static [Parameter],
    build: fn(&Values) -> Scene,
}

/// All built-in scenes.
const SCENES: &[SceneInfo] = &[scan::INFO, terrain::INFO, sphereflake::INFO, stadium::INFO, hall::INFO, room::INFO];

/// All built-in scenes.
pub fn list() -> Vec<SceneInfo> {
    SCENES.to_vec()
}

/// The parameters' values, all within their ranges.
struct Values<'a> {
    parameters: &'a [Parameter],
    values: Vec<u64>,
}

impl Values<'_> {
    /// How many triangles are wanted.
    fn triangles(&self) -> usize {
        let index = self.parameters.iter().position(|p| p.name == "triangles");
        index.map_or(0, |i| self.values[i] as usize)
    }
}

/// Builds `name[:key=value,...]`.
pub(super) fn build(what: &str) -> Result<Scene> {
    let (name, settings) = what.split_once(':').unwrap_or((what, ""));
    let Some(info) = SCENES.iter().find(|info| info.name == name) else {
        let known: Vec<&str> = SCENES.iter().map(|info| info.name).collect();
        let hint = format!("{}; or name a file such as mesh.ply", did_you_mean(name, &known));
        return Err(Error::argument(what, format!("no file and no built-in scene is called `{name}`"), hint));
    };
    let mut values: Vec<u64> = info.parameters.iter().map(|p| p.default).collect();
    for setting in settings.split(',').filter(|s| !s.is_empty()) {
        let (index, value) = setting_of(info, what, setting)?;
        values[index] = value;
    }
    let mut scene = (info.build)(&Values { parameters: info.parameters, values: values.clone() });
    let set: Vec<String> = info
        .parameters
        .iter()
        .zip(&values)
        .filter(|(p, value)| **value != p.default)
        .map(|(p, value)| format!("{}={value}", p.name))
        .collect();
    scene.name = if set.is_empty() { name.to_owned() } else { format!("{name}:{}", set.join(",")) };
    Ok(scene)
}

/// One `key=value`: the parameter's index and the value.
fn setting_of(info: &SceneInfo, what: &str, setting: &str) -> Result<(usize, u64)> {
    let Some((key, text)) = setting.split_once('=') else {
        return Err(Error::argument(what, format!("`{setting}` is not of the form key=value"), example(info)));
    };
    let Some(index) = info.parameters.iter().position(|p| p.name == key) else {
        let known: Vec<&str> = info.parameters.iter().map(|p| p.name).collect();
        let problem = format!("scene {} has no parameter `{key}`", info.name);
        return Err(Error::argument(what, problem, did_you_mean(key, &known)));
    };
    let Parameter { min, max, .. } = info.parameters[index];
    match text.replace('_', "").parse() {
        Ok(value) if (min..=max).contains(&value) => Ok((index, value)),
        Ok(value) => Err(Error::argument(
            what,
            format!("{key}={value} is out of range"),
            format!("scene {} takes {min} to {max}", info.name),
        )),
        Err(_) => Err(Error::argument(
            what,
            format!("{key}: `{text}` is not a whole number"),
            format!("give a number from {min} to {max}"),
        )),
    }
}

fn example(info: &SceneInfo) -> String {
    match info.parameters.first() {
        Some(p) => format!("write for instance {}:{}={}", info.name, p.name, p.default),
        None => format!("write {} alone", info.name),
    }
}

/// A scene of a mesh and what stands around it.
fn assemble(mesh: mesh::Mesh, lights: Vec<Light>, background: Vec3, camera_path: Option<&str>) -> Scene {
    Scene {
        vertices: mesh.vertices,
        triangles: mesh.triangles,
        materials: mesh.materials,
        lights,
        background,
        camera_path: camera_path.map(str::to_owned),
        ..Scene::default()
    }
}
