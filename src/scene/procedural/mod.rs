//! Built-in scenes. They cover the distributions of geometry that matter for acceleration structures, have the same
//! triangles on every machine, and can be scaled to any size.
//!
//! A scene is a module with an `INFO` and a line in `SCENES`. All have the parameter `triangles`, which they meet
//! within a few percent. Lengths are in metres, and y points up.

mod enclosure;
mod hall;
mod integrating;
mod mesh;
mod noise;
mod plane;
mod room;
mod scan;
mod shapes;
mod sphereflake;
mod spikes;
mod stadium;
mod surface_nets;
mod teapot;
mod terrain;

use super::{Light, Scene, did_you_mean};
use crate::error::{Error, Result};
use glam::Vec3;

/// An integer parameter of a built-in scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parameter {
    /// The key in `name:key=value`.
    pub name: &'static str,
    /// Description for listings, one line.
    pub meaning: &'static str,
    /// The value if none is given.
    pub default: u64,
    /// The smallest allowed value.
    pub min: u64,
    /// The largest allowed value.
    pub max: u64,
}

impl Parameter {
    /// The parameter that every scene has.
    const fn triangles(default: u64, min: u64) -> Parameter {
        Parameter { name: "triangles", meaning: "number of triangles, approximately", default, min, max: 8_000_000 }
    }
}

/// Name, description and parameters of a built-in scene.
#[derive(Clone, Copy, Debug)]
pub struct SceneInfo {
    /// The name that [`crate::scene::load`] accepts.
    pub name: &'static str,
    /// Description of its geometry, one line.
    pub character: &'static str,
    /// The parameters that it accepts.
    pub parameters: &'static [Parameter],
    /// Refuses values that cannot be together, and says why.
    check: fn(&Values) -> Result<(), String>,
    build: fn(&Values) -> Scene,
}

const SCENES: &[SceneInfo] = &[
    scan::INFO,
    terrain::INFO,
    sphereflake::INFO,
    stadium::INFO,
    hall::INFO,
    room::INFO,
    integrating::INFO,
    enclosure::INFO,
    plane::INFO,
];

/// Descriptions of all built-in scenes.
pub fn list() -> Vec<SceneInfo> {
    SCENES.to_vec()
}

/// Values of all parameters; each is in its range.
struct Values<'a> {
    parameters: &'a [Parameter],
    values: Vec<u64>,
}

impl Values<'_> {
    /// The requested number of triangles.
    fn triangles(&self) -> usize {
        self.get("triangles") as usize
    }

    /// The value of a parameter; 0 if the scene does not have it.
    fn get(&self, name: &str) -> u64 {
        let index = self.parameters.iter().position(|p| p.name == name);
        index.map_or(0, |i| self.values[i])
    }
}

/// Refuses a name or a parameter that [`build`] would refuse; builds nothing.
///
/// # Errors
/// [`Error::Input`].
pub(super) fn check(what: &str) -> Result<()> {
    parse(what).map(drop)
}

/// Builds `name[:key=value,...]`.
pub(super) fn build(what: &str) -> Result<Scene> {
    let (info, values) = parse(what)?;
    let mut scene = (info.build)(&Values { parameters: info.parameters, values: values.clone() });
    let set: Vec<String> = info
        .parameters
        .iter()
        .zip(&values)
        .filter(|(p, value)| **value != p.default)
        .map(|(p, value)| format!("{}={value}", p.name))
        .collect();
    scene.name = if set.is_empty() { info.name.to_owned() } else { format!("{}:{}", info.name, set.join(",")) };
    Ok(scene)
}

/// The scene and the values of its parameters.
fn parse(spec: &str) -> Result<(&'static SceneInfo, Vec<u64>)> {
    let (name, settings) = spec.split_once(':').unwrap_or((spec, ""));
    let Some(info) = SCENES.iter().find(|info| info.name == name) else {
        let known: Vec<&str> = SCENES.iter().map(|info| info.name).collect();
        let hint = format!("{}; or name a file such as mesh.ply", did_you_mean(name, &known));
        return Err(Error::argument(spec, format!("no file and no built-in scene is called `{name}`"), hint));
    };
    let mut values: Vec<u64> = info.parameters.iter().map(|p| p.default).collect();
    for setting in settings.split(',').filter(|s| !s.is_empty()) {
        let (index, value) = setting_of(info, spec, setting)?;
        values[index] = value;
    }
    let all = Values { parameters: info.parameters, values };
    if let Err(problem) = (info.check)(&all) {
        return Err(Error::argument(spec, problem, example(info)));
    }
    Ok((info, all.values))
}

/// Parses `key=value`: the index of the parameter, and its value.
fn setting_of(info: &SceneInfo, spec: &str, setting: &str) -> Result<(usize, u64)> {
    let Some((key, text)) = setting.split_once('=').map(|(key, text)| (key.trim(), text.trim())) else {
        return Err(Error::argument(spec, format!("`{setting}` is not of the form key=value"), example(info)));
    };
    let Some(index) = info.parameters.iter().position(|p| p.name == key) else {
        let known: Vec<&str> = info.parameters.iter().map(|p| p.name).collect();
        let problem = format!("scene {} has no parameter `{key}`", info.name);
        return Err(Error::argument(spec, problem, did_you_mean(key, &known)));
    };
    let Parameter { min, max, .. } = info.parameters[index];
    match text.replace('_', "").parse() {
        Ok(value) if (min..=max).contains(&value) => Ok((index, value)),
        Ok(value) => Err(Error::argument(
            spec,
            format!("{key}={value} is out of range"),
            format!("scene {} takes {min} to {max}", info.name),
        )),
        Err(_) => Err(Error::argument(
            spec,
            format!("{key}: `{text}` is not a whole number"),
            format!("give a number from {min} to {max}"),
        )),
    }
}

/// For scenes all of whose values can be together.
fn accept(_: &Values) -> Result<(), String> {
    Ok(())
}

fn example(info: &SceneInfo) -> String {
    match info.parameters.first() {
        Some(p) => format!("write for instance {}:{}={}", info.name, p.name, p.default),
        None => format!("write {} alone", info.name),
    }
}

/// A scene with this mesh.
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
