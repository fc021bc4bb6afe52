//! Lights and the camera.

use super::InventorReader;
use super::node_type::NodeType;
use super::state::State;
use super::tree::Node;
use crate::scene::text::Fault;
use crate::scene::{Light, Pose, Scene, SceneCamera};
use glam::DVec3;
use std::f64::consts::FRAC_PI_4;

/// Distance of a directional light, in diagonals of the scene.
const FAR: f32 = 10.0;

/// Direction and colour of a directional light.
pub type DistantLight = (DVec3, DVec3);

impl InventorReader {
    /// Adds a light, if it is on. A light with an error in a field is ignored, and the error added to the faults.
    ///
    /// # Errors
    /// The lights exceed the memory limit.
    pub(super) fn light(&mut self, node: &Node, state: &State) -> Result<(), Fault> {
        let directional = node.kind == NodeType::DirectionalLight;
        let (name, default) = if directional { ("direction", DVec3::NEG_Z) } else { ("location", DVec3::Z) };
        let read = || -> Result<Option<(DVec3, DVec3)>, Fault> {
            let colour = node.vector("color", DVec3::ONE)? * node.number("intensity", 1.0)?;
            let place = node.vector(name, default)?;
            let finite = colour.is_finite() && place.is_finite();
            let problem = || Fault::new(None, "a number of the light is not finite", "");
            node.flag("on", true)?.then_some(finite.then_some((place, colour)).ok_or_else(problem)).transpose()
        };
        let (place, colour) = match read() {
            Ok(Some(found)) => found,
            Ok(None) => return Ok(()),
            Err(fault) => {
                self.faults.push(Fault { problem: format!("{}: the light is ignored", fault.problem), ..fault });
                return Ok(());
            }
        };
        if directional {
            let direction = state.transform.transform_vector3(place);
            self.mesh.charge_repeated(size_of::<DistantLight>() + size_of::<Light>())?;
            self.distant_lights.push((direction, colour));
            return Ok(());
        }
        if node.kind == NodeType::SpotLight {
            self.mesh.warnings.add("spot light: shines in all directions");
        }
        self.mesh.set_transform(state.transform);
        if let Some(problem) = self.mesh.light(place, colour)? {
            self.faults.push(Fault::new(Some(node.line), problem, ""));
        }
        Ok(())
    }

    /// Sets the scene's camera, if this is the first. A camera with an error is ignored, and the error added to the
    /// faults.
    pub(super) fn view(&mut self, node: &Node, state: &State) {
        if self.camera.is_none()
            && let Err(fault) = self.first_view(node, state)
        {
            self.faults.push(Fault { problem: format!("{}: the camera is ignored", fault.problem), ..fault });
        }
    }

    fn first_view(&mut self, node: &Node, state: &State) -> Result<(), Fault> {
        let turn = node.rotation("orientation")?;
        let position = state.transform.transform_point3(node.vector("position", DVec3::Z)?);
        let position = (position - self.mesh.offset()).as_vec3();
        let along = |v: DVec3| state.transform.transform_vector3(turn * v).normalize_or_zero().as_vec3();
        let (direction, up) = (along(DVec3::NEG_Z), along(DVec3::Y));
        let field_of_view = node.number("heightAngle", FRAC_PI_4)?.to_degrees() as f32;
        if position.is_finite() && direction.cross(up).length() > 1e-3 && field_of_view > 0.0 && field_of_view < 180.0 {
            let pose = Pose { time: 0.0, position, direction, up };
            self.camera = Some(SceneCamera { field_of_view, frames: vec![pose] });
        } else {
            self.mesh.warnings.add("the camera has no valid direction or field of view: ignored");
        }
        Ok(())
    }
}

/// Adds the directional lights to the scene as point lights at a distance of [`FAR`] diagonals.
pub fn add_distant_lights(scene: &mut Scene, lights: &[DistantLight]) {
    let bounds = scene.bounds();
    let mut invalid = 0;
    for (direction, colour) in lights {
        let direction = direction.normalize_or_zero().as_vec3();
        let position = bounds.center() - direction * bounds.diagonal() * FAR;
        let light = Light::new(position, colour.as_vec3());
        if direction != glam::Vec3::ZERO && light.position.is_finite() && light.colour.is_finite() {
            scene.lights.push(light);
        } else {
            invalid += 1;
        }
    }
    if invalid > 0 {
        scene.warnings.push(format!("directional lights without a valid direction or colour ignored: {invalid}"));
    }
}
