//! Converts emissive surfaces to point lights.
//!
//! Consecutive emissive triangles of one material, in one object and one instance, are one lamp. A lamp becomes a point
//! light at the centroid of its area, moved by a thousandth of the scene's diagonal along its normal. A lamp that emits
//! in all directions (a tube, a bulb) has its light outside of it, towards the centre of the scene. If there are more
//! than [`MAX_LIGHTS`] lamps, farthest-point sampling selects [`MAX_LIGHTS`] of them, beginning with the most powerful;
//! each takes over the power of the lamps nearest to it.
//!
//! The power of a lamp is its area times its emittance. Point lights have no attenuation in this program, so the lights
//! are scaled such that their mean channels sum up to 1.

use crate::scene::{Light, Scene};
use glam::{DVec3, Vec3};
use std::ops::Range;

/// The largest number of lights that lamps are converted to; every light costs a shadow ray per pixel.
pub const MAX_LIGHTS: usize = 8;

/// The triangles of one lamp.
struct Lamp {
    triangles: Range<usize>,
    /// Number of the object or instance that the triangles belong to.
    group: usize,
    /// Emittance, in linear RGB.
    emitted: DVec3,
}

/// The emissive surfaces of a scene.
#[derive(Default)]
pub struct Emitters {
    lamps: Vec<Lamp>,
    group: usize,
}

/// The point light of a lamp.
struct LampLight {
    position: Vec3,
    power: DVec3,
}

impl Emitters {
    /// Starts a new object or instance.
    pub fn new_group(&mut self) {
        self.group += 1;
    }

    /// Adds emissive triangles.
    pub fn add(&mut self, triangles: Range<usize>, emitted: DVec3) {
        match self.lamps.last_mut() {
            Some(last)
                if last.group == self.group && last.emitted == emitted && last.triangles.end == triangles.start =>
            {
                last.triangles.end = triangles.end;
            }
            _ => self.lamps.push(Lamp { triangles, group: self.group, emitted }),
        }
    }

    /// Sets the lights of the scene.
    pub fn set_lights(self, scene: &mut Scene) {
        let bounds = scene.bounds();
        let offset = bounds.diagonal() * 1e-3;
        let mut sources: Vec<LampLight> =
            self.lamps.iter().filter_map(|lamp| lamp_light(scene, lamp, bounds.center(), offset)).collect();
        let total: f64 = sources.iter().map(|s| s.power.element_sum() / 3.0).sum();
        if !(total > 0.0 && total.is_finite()) {
            return;
        }
        let lamps = sources.len();
        let lights = farthest_point_sampling(&mut sources);
        if lamps > lights.len() {
            scene.warnings.push(format!("{lamps} emissive surfaces merged into {} point lights", lights.len()));
        }
        scene.lights = lights.iter().map(|s| Light::new(s.position, (s.power / total).as_vec3())).collect();
    }
}

/// The light of a lamp; `None` if the lamp has no area.
fn lamp_light(scene: &Scene, lamp: &Lamp, middle: Vec3, offset: f32) -> Option<LampLight> {
    let (mut area, mut center, mut facing) = (0.0, DVec3::ZERO, DVec3::ZERO);
    for index in lamp.triangles.clone() {
        let [a, b, c] = scene.corners(index as u32).map(|corner| corner.as_dvec3());
        let normal = (b - a).cross(c - a) * 0.5;
        area += normal.length();
        center += (a + b + c) / 3.0 * normal.length();
        facing += normal;
    }
    if area <= 0.0 {
        return None;
    }
    let center = (center / area).as_vec3();
    let position = if facing.length() > 0.1 * area {
        center + facing.normalize().as_vec3() * offset
    } else {
        let corners = lamp.triangles.clone().flat_map(|index| scene.corners(index as u32));
        let reach = corners.map(|corner| center.distance(corner.into())).fold(0.0, f32::max);
        center + (middle - center).normalize_or(Vec3::NEG_Z) * (reach + offset)
    };
    Some(LampLight { position, power: lamp.emitted * area })
}

/// Selects at most [`MAX_LIGHTS`] lights, and adds the power of each other light to the nearest of them.
fn farthest_point_sampling(sources: &mut Vec<LampLight>) -> Vec<LampLight> {
    // The sort is stable: lights of equal power stay in file order.
    sources.sort_by(|a, b| b.power.element_sum().total_cmp(&a.power.element_sum()));
    let mut lights = vec![sources.remove(0)];
    // Squared distance of every remaining light to the nearest selected one
    let mut gaps: Vec<f32> = sources.iter().map(|s| s.position.distance_squared(lights[0].position)).collect();
    while lights.len() < MAX_LIGHTS && !sources.is_empty() {
        let farthest = (0..gaps.len()).fold(0, |best, i| if gaps[i] > gaps[best] { i } else { best });
        let light = sources.remove(farthest);
        gaps.remove(farthest);
        for (gap, source) in gaps.iter_mut().zip(sources.iter()) {
            *gap = gap.min(source.position.distance_squared(light.position));
        }
        lights.push(light);
    }
    for source in sources.iter() {
        let far = |light: &LampLight| light.position.distance_squared(source.position);
        if let Some(nearest) = lights.iter_mut().min_by(|a, b| far(a).total_cmp(&far(b))) {
            nearest.power += source.power;
        }
    }
    lights
}
