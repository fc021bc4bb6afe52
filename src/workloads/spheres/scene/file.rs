//! Scene files (JSON). `docs/schema/spheres-scene.schema.json` is made of the types here.

use super::{Camera, Light, Scene, Sphere, fields};
use crate::error::{Error, Result};
use crate::record::schema::of;
use glam::{DVec3, Vec3};
use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde::Deserialize;
use std::path::Path;

/// Share of the light that a reflection keeps where the file says none.
pub const INTENSITY: f32 = 0.5;

/// The least distance of a hit as a share of the scene's extent where the file says none: 0.001 at an extent of 20.
pub const EPSILON: f64 = 5e-5;

/// Longest part of a message of the JSON reader that is shown, in characters.
const MAX_MESSAGE: usize = 200;

/// Spheres, one camera and one light. Lengths are in any unit, y points up, and colours are linear.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "camelCase")]
struct File {
    #[serde(deserialize_with = "fields::object")]
    camera: FileCamera,
    #[serde(deserialize_with = "fields::object")]
    light_data: FileLight,
    #[serde(default, deserialize_with = "fields::object")]
    #[schemars(default)]
    rendering: FileRendering,
    #[serde(deserialize_with = "fields::spheres")]
    #[schemars(length(min = 1, max = 100_000))]
    spheres: Vec<FileSphere>,
}

/// A pinhole camera that circles a vertical axis; up is +y.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "camelCase")]
struct FileCamera {
    /// The viewer's place at time 0.
    #[serde(deserialize_with = "fields::vector")]
    #[schemars(inner(range(min = -1e18, max = 1e18)))]
    position: [f64; 3],
    /// Viewing direction at time 0, of any length but 0, not vertical.
    #[serde(deserialize_with = "fields::forward")]
    #[schemars(inner(range(min = -1e18, max = 1e18)))]
    #[schemars(extend("anyOf" = [
        { "prefixItems": [{ "not": { "const": 0 } }] },
        { "prefixItems": [true, true, { "not": { "const": 0 } }] },
    ]))]
    forward: [f64; 3],
    /// Vertical field of view in degrees.
    #[serde(deserialize_with = "fields::fov")]
    #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 180))]
    fov: f64,
    /// A point of the orbit's axis.
    #[serde(deserialize_with = "fields::vector")]
    #[schemars(inner(range(min = -1e18, max = 1e18)))]
    focus_point: [f64; 3],
    /// Radians per second; the sign is the direction, and 0 is no orbit.
    #[serde(deserialize_with = "fields::number")]
    #[schemars(range(min = -1e18, max = 1e18))]
    orbit_velocity: f64,
}

/// One directional light and ambient light, as linear RGB.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "camelCase")]
struct FileLight {
    /// The direction in which the light shines, of any length but 0.
    #[serde(deserialize_with = "fields::direction")]
    #[schemars(inner(range(min = -1e18, max = 1e18)), extend("not" = { "items": { "const": 0 } }))]
    directional_light_direction: [f64; 3],
    /// The light that a surface gets which faces it.
    #[serde(deserialize_with = "fields::light")]
    #[schemars(inner(range(min = 0, max = 1e18)))]
    directional_light_color: [f64; 3],
    /// The light that every surface gets.
    #[serde(deserialize_with = "fields::light")]
    #[schemars(inner(range(min = 0, max = 1e18)))]
    ambient_light_color: [f64; 3],
}

/// What is the same for all surfaces.
#[derive(Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields, rename_all = "camelCase")]
struct FileRendering {
    /// Share of the light that a reflection keeps, before the surface's colour.
    #[serde(deserialize_with = "fields::share")]
    #[schemars(range(min = 0, max = 1))]
    intensity: f64,
    /// The least distance of a hit, as a share of the diagonal of the box around all spheres.
    #[serde(deserialize_with = "fields::share")]
    #[schemars(range(min = 0, max = 1))]
    epsilon: f64,
}

impl Default for FileRendering {
    fn default() -> FileRendering {
        FileRendering { intensity: f64::from(INTENSITY), epsilon: EPSILON }
    }
}

/// A sphere that reflects.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FileSphere {
    /// Its centre.
    #[serde(deserialize_with = "fields::vector")]
    #[schemars(inner(range(min = -1e18, max = 1e18)))]
    position: [f64; 3],
    /// Its radius, whose square must be a normal single-precision number.
    #[serde(deserialize_with = "fields::radius")]
    #[schemars(range(min = 1.1e-19, max = 1e18))]
    radius: f64,
    /// Linear RGB.
    #[serde(deserialize_with = "fields::colour")]
    #[schemars(inner(range(min = 0, max = 1)))]
    color: [f64; 3],
}

/// JSON Schema of scene files.
pub fn schema() -> serde_json::Value {
    of::<File>("A scene of spheres for rtbench", SchemaSettings::draft2020_12().for_deserialize())
}

/// Reads the text of a file. `name` becomes the scene's name; errors name `path`.
pub(super) fn parse(name: &str, path: &Path, text: &str) -> Result<Scene> {
    let file = read(text).map_err(|(line, problem)| {
        Error::file(path, Some(line), problem, "docs/schema/spheres-scene.schema.json describes the format")
    })?;
    let FileCamera { position, forward, fov, focus_point, orbit_velocity } = file.camera;
    let camera = Camera {
        position: DVec3::from(position),
        forward: DVec3::from(forward),
        fov,
        focus_point: DVec3::from(focus_point),
        orbit_velocity,
    };
    let single = |v: [f64; 3]| Vec3::from(v.map(|x| x as f32));
    let light = Light {
        direction: DVec3::from(file.light_data.directional_light_direction),
        color: single(file.light_data.directional_light_color),
        ambient: single(file.light_data.ambient_light_color),
    };
    let sphere =
        |s: &FileSphere| Sphere { position: single(s.position), radius: s.radius as f32, color: single(s.color) };
    let spheres = file.spheres.iter().map(sphere).collect();
    let FileRendering { intensity, epsilon } = file.rendering;
    Ok(Scene::new(name, camera, light, (intensity as f32, epsilon), spheres))
}

/// The file, or the line and the problem.
fn read(text: &str) -> Result<File, (usize, String)> {
    #[derive(Deserialize)]
    #[serde(transparent)]
    struct Root(#[serde(deserialize_with = "fields::object")] File);

    let mut json = serde_json::Deserializer::from_str(text);
    let parsed = serde_path_to_error::deserialize::<_, Root>(&mut json);
    let (place, error) = match parsed {
        Ok(Root(file)) => match json.end() {
            Ok(()) => return Ok(file),
            Err(error) => (String::new(), error),
        },
        Err(error) => (error.path().to_string(), error.into_inner()),
    };
    let message = error.to_string();
    let message = message.rsplit_once(" at line ").map_or(message.as_str(), |(message, _)| message);
    let shown = |text: &str| text.chars().filter(|c| !c.is_control()).take(MAX_MESSAGE).collect::<String>();
    let place = if place.is_empty() || place == "." { String::new() } else { format!("{}: ", shown(&place)) };
    Err((error.line(), format!("{place}{}", shown(message))))
}
