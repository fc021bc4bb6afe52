//! Cameras and punctual lights. What is malformed is a warning: it concerns no geometry.

use super::json::{Loose, Whole};
use super::reader::GltfReader;
use super::schema::{NodeLight, Text};
use crate::scene::text::Fault;
use crate::scene::{Light, Pose, Scene, SceneCamera, lamps};
use glam::{DMat4, DVec3, Vec3};
use serde::Deserialize;

#[derive(Deserialize)]
struct Camera<'a> {
    #[serde(default, borrow)]
    name: Loose<Text<'a>>,
    perspective: Option<Perspective>,
}

#[derive(Deserialize)]
struct Perspective {
    yfov: f32,
}

#[derive(Deserialize)]
struct PunctualLight<'a> {
    #[serde(borrow, rename = "type")]
    kind: Text<'a>,
    color: Option<[f32; 3]>,
    intensity: Option<f32>,
}

/// The lights of a file.
#[derive(Default)]
pub struct PunctualLights {
    /// Position and power of point and spot lights.
    points: Vec<(Vec3, Vec3)>,
    /// Direction and power of directional lights.
    directions: Vec<(Vec3, Vec3)>,
}

impl<'a> GltfReader<'a> {
    /// Takes the camera of a node, if it is the requested one.
    pub(super) fn node_camera(&mut self, node: u32, camera: Loose<Whole>, name: Option<&str>, world: &DMat4) {
        let index = match camera {
            Loose::Given(Whole(index)) => index,
            Loose::Malformed => return self.notes.malformed(malformed(format!("nodes[{node}].camera"))),
            Loose::Absent => return,
        };
        if self.scene.camera.is_some() {
            return;
        }
        let cameras = self.json.list("cameras", "camera", self.root.cameras);
        let camera = cameras.and_then(|list| list.get::<Camera>(index, format_args!("nodes[{node}].camera")));
        match camera {
            Err(fault) => self.notes.malformed(fault),
            Ok(Camera { name: own, perspective }) => {
                let own = own.given();
                let names = [own.as_ref().map(|Text(own)| &**own), name];
                match perspective {
                    _ if !self.camera.is_none_or(|wanted| names.contains(&Some(wanted))) => {}
                    Some(lens) => self.add_camera(lens.yfov, world),
                    None => self.notes.orthographic = true,
                }
            }
        }
    }

    fn add_camera(&mut self, field_of_view: f32, world: &DMat4) {
        let field_of_view = field_of_view.to_degrees();
        let position = self.place(world, DVec3::ZERO);
        let direction = world.transform_vector3(DVec3::NEG_Z).normalize_or_zero().as_vec3();
        let up = world.transform_vector3(DVec3::Y).normalize_or_zero().as_vec3();
        let looks = position.is_finite() && direction.cross(up).length() > 1e-3;
        if looks && field_of_view > 0.0 && field_of_view < 180.0 {
            let pose = Pose { time: 0.0, position, direction, up };
            self.scene.camera = Some(SceneCamera { field_of_view, frames: vec![pose] });
        } else {
            self.scene.warnings.push("the camera has no valid direction or field of view: ignored".into());
        }
    }

    /// Adds the light of a node. Spot lights become point lights.
    pub(super) fn node_light(&mut self, node: u32, light: Loose<NodeLight>, world: &DMat4) {
        let index = match light {
            Loose::Given(NodeLight { light: Whole(index) }) => index,
            Loose::Malformed => return self.notes.malformed(malformed(format!("the light of nodes[{node}]"))),
            Loose::Absent => return,
        };
        let raw = match &self.root.extensions {
            Loose::Given(extensions) => match &extensions.lights {
                Loose::Given(lights) => lights.lights,
                Loose::Absent | Loose::Malformed => None,
            },
            Loose::Absent | Loose::Malformed => None,
        };
        let lights = self.json.list("lights", "light", raw);
        match lights.and_then(|list| list.get::<PunctualLight>(index, format_args!("nodes[{node}]"))) {
            Ok(PunctualLight { kind, color, intensity }) => {
                let power = Vec3::from(color.unwrap_or([1.0; 3])) * intensity.unwrap_or(1.0);
                match &*kind.0 {
                    "directional" => {
                        self.lights.directions.push((world.transform_vector3(DVec3::NEG_Z).as_vec3(), power));
                    }
                    "point" | "spot" => self.lights.points.push((self.place(world, DVec3::ZERO), power)),
                    _ => self.notes.malformed(malformed(format!("the type of lights[{index}]"))),
                }
            }
            Err(fault) => self.notes.malformed(fault),
        }
    }
}

fn malformed(place: String) -> Fault {
    Fault::new(None, format!("{place} is not valid"), "")
}

impl PunctualLights {
    /// Adds the lights to the scene; without any, emissive surfaces become lights.
    pub fn add_to(&self, scene: &mut Scene, emission: &[Vec3]) {
        let bounds = scene.bounds();
        let far = bounds.diagonal() * 10.0;
        let from = |d: Vec3| bounds.center() - d.normalize_or_zero() * far;
        // Candela and lux are not comparable. If there are both kinds of lights, each kind gets half of the brightness.
        let share = if self.points.is_empty() || self.directions.is_empty() { 1.0 } else { 0.5 };
        let directions: Vec<(Vec3, Vec3)> = self.directions.iter().map(|&(d, power)| (from(d), power)).collect();
        for group in [&self.points, &directions] {
            let brightest = group.iter().map(|(_, power)| *power).sum::<Vec3>().max_element();
            let lights = group.iter().map(|&(position, power)| Light::new(position, power * share / brightest));
            scene.lights.extend(lights.filter(|l| l.position.is_finite() && l.colour.is_finite()));
        }
        if scene.lights.is_empty() {
            scene.lights = lamps::lights(&scene.vertices, &scene.triangles, emission);
        }
    }
}
