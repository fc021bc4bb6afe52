//! Lights and the camera.

use super::Reader;
use super::kind::Kind;
use super::state::State;
use super::tree::Node;
use crate::scene::text::Fault;
use crate::scene::{Light, Pose, Scene, SceneCamera};
use glam::DVec3;
use std::f64::consts::FRAC_PI_4;

/// How many diagonals of the scene a directional light is away.
const FAR: f32 = 10.0;

/// Direction and colour of a light that is far away.
pub type Sun = (DVec3, DVec3);

impl Reader {
    /// A light.
    pub(super) fn light(&mut self, node: &Node, state: &State) -> Result<(), Fault> {
        if !node.flag("on", true)? {
            return Ok(());
        }
        let colour = node.vector("color", DVec3::ONE)? * node.number("intensity", 1.0)?;
        if node.kind == Kind::DirectionalLight {
            let direction = state.transform.transform_vector3(node.vector("direction", DVec3::NEG_Z)?);
            self.mesh.charge(size_of::<Sun>() + size_of::<Light>())?;
            self.suns.push((direction, colour));
            return Ok(());
        }
        if node.kind == Kind::SpotLight {
            self.mesh.warnings.add("spot light: shines to all sides");
        }
        self.mesh.set_transform(state.transform);
        self.mesh.light(node.vector("location", DVec3::Z)?, colour)
    }

    /// A perspective camera, if it is the first.
    pub(super) fn view(&mut self, node: &Node, state: &State) -> Result<(), Fault> {
        if self.camera.is_some() {
            return Ok(());
        }
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
            self.mesh.warnings.add("the camera cannot look: it is left out");
        }
        Ok(())
    }
}

/// Adds the directional lights, far away from all there is.
pub fn shine(scene: &mut Scene, suns: &[Sun]) {
    let bounds = scene.bounds();
    let mut dark = 0;
    for (direction, colour) in suns {
        let direction = direction.normalize_or_zero().as_vec3();
        let position = bounds.center() - direction * bounds.diagonal() * FAR;
        let light = Light::new(position, colour.as_vec3());
        if direction != glam::Vec3::ZERO && light.position.is_finite() && light.colour.is_finite() {
            scene.lights.push(light);
        } else {
            dark += 1;
        }
    }
    if dark > 0 {
        scene.warnings.push(format!("directional lights that shine nowhere left out: {dark}"));
    }
}
