//! Emitting surfaces as point lights.
//!
//! Emitting triangles that follow each other in one object and place, of one material, are one lamp. A lamp becomes a point
//! light in the middle of its area, a thousandth of the scene's diagonal in front of it; one that faces all ways (a tube, a
//! bulb) has its light outside, on the side of the scene's middle. Where there are more than [`MAX_LIGHTS`], the lamps that
//! are farthest from each other stay, beginning with the most powerful, and take over the power of those that are nearest to
//! them.
//!
//! A lamp's power is its area times what it emits. Point lights of this program do not fade with distance, so their
//! luminances are shares of the whole: together they are one.

use crate::scene::{Light, Scene};
use glam::{DVec3, Vec3};
use std::ops::Range;

/// Most lights: each costs a shadow ray per pixel.
pub const MAX_LIGHTS: usize = 8;

/// Triangles of one lamp.
struct Lamp {
    triangles: Range<usize>,
    /// Object and place.
    group: usize,
    /// What a unit of area emits, linear RGB.
    emitted: DVec3,
}

/// The emitting surfaces of a scene.
#[derive(Default)]
pub struct Emitters {
    lamps: Vec<Lamp>,
    group: usize,
}

/// A lamp in the whole.
struct Source {
    position: Vec3,
    power: DVec3,
}

impl Emitters {
    /// Something else begins: an object or a place.
    pub fn new_group(&mut self) {
        self.group += 1;
    }

    /// These triangles emit light.
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

    /// Lights the scene.
    pub fn light(self, scene: &mut Scene) {
        let bounds = scene.bounds();
        let offset = bounds.diagonal() * 1e-3;
        let mut sources: Vec<Source> =
            self.lamps.iter().filter_map(|lamp| source(scene, lamp, bounds.center(), offset)).collect();
        let total: f64 = sources.iter().map(|s| s.power.element_sum() / 3.0).sum();
        if !(total > 0.0 && total.is_finite()) {
            return;
        }
        let lamps = sources.len();
        let lights = strongest_and_farthest(&mut sources);
        if lamps > lights.len() {
            scene.warnings.push(format!("{lamps} emitting surfaces shown as {} point lights", lights.len()));
        }
        scene.lights = lights.iter().map(|s| Light::new(s.position, (s.power / total).as_vec3())).collect();
    }
}

fn source(scene: &Scene, lamp: &Lamp, middle: Vec3, offset: f32) -> Option<Source> {
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
    Some(Source { position, power: lamp.emitted * area })
}

fn strongest_and_farthest(sources: &mut Vec<Source>) -> Vec<Source> {
    // Stable: of equal ones the first in the file
    sources.sort_by(|a, b| b.power.element_sum().total_cmp(&a.power.element_sum()));
    let mut lights = vec![sources.remove(0)];
    // Distance of every other to its nearest light
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
        let far = |light: &Source| light.position.distance_squared(source.position);
        if let Some(nearest) = lights.iter_mut().min_by(|a, b| far(a).total_cmp(&far(b))) {
            nearest.power += source.power;
        }
    }
    lights
}
