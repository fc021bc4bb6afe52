//! Cameras and punctual lights. What is malformed is a warning: it concerns no geometry.

use super::json::{Loose, Whole};
use super::reader::GltfReader;
use super::schema::{NodeLight, Text};
use crate::scene::text::Fault;
use crate::scene::{Light, Pose, Scene, SceneCamera, lamps};
use glam::{DMat4, DVec3, Vec3};
use serde::Deserialize;

#[derive(Deserialize)]
pub struct Camera<'a> {
    #[serde(default, borrow)]
    name: Loose<Text<'a>>,
    #[serde(rename = "type", default, borrow)]
    kind: Loose<Text<'a>>,
    perspective: Option<Perspective>,
}

#[derive(Deserialize)]
struct Perspective {
    yfov: f32,
}

#[derive(Clone, Copy, Deserialize)]
pub struct PunctualLight {
    #[serde(rename = "type")]
    kind: Kind,
    color: Option<[f32; 3]>,
    intensity: Option<f32>,
}

#[derive(Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Kind {
    Directional,
    Point,
    Spot,
}

/// The lights of a file.
#[derive(Default)]
pub struct PunctualLights {
    /// Position and power of point and spot lights.
    points: Vec<(Vec3, Vec3)>,
    /// Direction and power of directional lights.
    directions: Vec<(Vec3, Vec3)>,
}

impl GltfReader<'_> {
    /// Takes the camera of a node, if it is the requested one.
    pub(super) fn node_camera(&mut self, node: u32, camera: Loose<Whole>, name: Option<&str>, world: &DMat4) {
        let index = match camera {
            Loose::Given(Whole(index)) => index,
            Loose::Malformed => return self.notes.malformed(|| format!("nodes[{node}].camera is not an index")),
            Loose::Absent => return,
        };
        if self.scene.camera.is_some() {
            return;
        }
        let GltfReader { lists, notes, known_cameras, .. } = self;
        let camera = known_cameras.entry(index).or_insert_with(|| {
            let camera = lists.cameras.parse::<Camera>(index);
            if camera.is_none() {
                notes.malformed(|| lists.cameras.problem::<Camera>(index, format_args!("nodes[{node}].camera")));
            }
            camera
        });
        let Some(Camera { name: own, kind, perspective }) = camera else { return };
        let own = match own {
            Loose::Given(Text(own)) => Some(&**own),
            Loose::Absent | Loose::Malformed => None,
        };
        match perspective {
            _ if !self.camera.is_none_or(|wanted| [own, name].contains(&Some(wanted))) => {}
            Some(lens) => {
                let field_of_view = lens.yfov;
                self.add_camera(field_of_view, world);
            }
            None if matches!(kind, Loose::Given(Text(kind)) if kind == "orthographic") => {
                self.notes.orthographic = true;
            }
            None => self.notes.malformed(|| format!("cameras[{index}] has no perspective")),
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
    pub(super) fn node_light(&mut self, node: u32, light: Loose<NodeLight>, world: &DMat4) -> Result<(), Fault> {
        let index = match light {
            Loose::Given(NodeLight { light: Whole(index) }) => index,
            Loose::Malformed => {
                self.notes.malformed(|| format!("nodes[{node}] has a light that is not an index"));
                return Ok(());
            }
            Loose::Absent => return Ok(()),
        };
        let GltfReader { lists, notes, known_lights, .. } = self;
        let light = *known_lights.entry(index).or_insert_with(|| {
            let light = lists.lights.parse::<PunctualLight>(index);
            if light.is_none() {
                notes.malformed(|| lists.lights.problem::<PunctualLight>(index, format_args!("nodes[{node}]")));
            }
            light
        });
        let Some(PunctualLight { kind, color, intensity }) = light else { return Ok(()) };
        self.limits.repeat(4 * size_of::<Light>())?;
        let power = Vec3::from(color.unwrap_or([1.0; 3])) * intensity.unwrap_or(1.0);
        let (place, list) = match kind {
            Kind::Directional => {
                let direction = world.transform_vector3(DVec3::NEG_Z).normalize_or_zero();
                (direction.as_vec3(), &mut self.lights.directions)
            }
            Kind::Point | Kind::Spot => (self.place(world, DVec3::ZERO), &mut self.lights.points),
        };
        if place.is_finite() && power.is_finite() {
            list.push((place, power));
        } else {
            self.notes.malformed(|| format!("nodes[{node}] has a light at {place} of colour {power}, not finite"));
        }
        Ok(())
    }
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
