//! Converts emissive surfaces to point lights.
//!
//! A lamp is a connected set of emissive triangles. Its light lies at the centroid of its area, moved by a thousandth
//! of the scene's diagonal along its normals; its colour is the emission times the area. If there are more than
//! [`MAX_LIGHTS`] lamps, neighbours are merged: the group of lamps with the largest extent is split in halves until
//! there are [`MAX_LIGHTS`] groups. Lights in this program have no attenuation, so absolute units have no meaning: all
//! colours are scaled such that the brightest channel of their sum is 1.

use super::{Light, Triangle};
use crate::math::{Aabb, Vertex};
use glam::{DVec3, Vec3};
use std::collections::HashMap;

/// The largest number of lights that lamps are converted to; every light costs a shadow ray per pixel.
pub const MAX_LIGHTS: usize = 4;

/// Upper bound of the memory per emissive triangle, in bytes: its lamp twice, the entries of its corners in the map, a
/// link of the union-find forest, and a pointer.
pub(crate) const BYTES: usize = 2 * size_of::<Lamp>() + 3 * 42 + 2 * size_of::<usize>();

/// The sums over one or several lamps.
#[derive(Clone, Copy, Debug, Default)]
struct Lamp {
    /// Sum of the triangles' centroids, weighted by area.
    middle: DVec3,
    /// Sum of the triangles' unit normals, weighted by area.
    normal: DVec3,
    area: f64,
    /// Sum of emission times area.
    power: DVec3,
}

impl Lamp {
    fn add(&mut self, other: &Lamp) {
        self.middle += other.middle;
        self.normal += other.normal;
        self.area += other.area;
        self.power += other.power;
    }

    fn position(&self) -> DVec3 {
        self.middle / self.area
    }
}

/// The lights of all triangles that have a material with an emission; `emission` is indexed by material.
pub(crate) fn lights(vertices: &[Vertex], triangles: &[Triangle], emission: &[Vec3]) -> Vec<Light> {
    let lamps = lamps(vertices, triangles, emission);
    if lamps.is_empty() {
        return Vec::new();
    }
    let before = 1e-3 * f64::from(Aabb::from_points(vertices.iter().map(|v| v.position)).diagonal());
    let groups = merge(lamps);
    let brightest = groups.iter().map(|lamp| lamp.power).sum::<DVec3>().max_element();
    let light = |lamp: &Lamp| {
        let position = lamp.position() + lamp.normal.normalize_or_zero() * before;
        Light::new(position.as_vec3(), (lamp.power / brightest).as_vec3())
    };
    groups.iter().map(light).filter(|l| l.position.is_finite() && l.colour.is_finite()).collect()
}

/// The lamps: emissive triangles are connected if they share a position. They are in the order of their first triangle.
fn lamps(vertices: &[Vertex], triangles: &[Triangle], emission: &[Vec3]) -> Vec<Lamp> {
    let shines = |t: &&Triangle| emission[t.material as usize].max_element() > 0.0;
    let shining: Vec<&Triangle> = triangles.iter().filter(shines).collect();
    let mut parent: Vec<usize> = (0..shining.len()).collect();
    let mut owner = HashMap::new();
    for (i, triangle) in shining.iter().enumerate() {
        for vertex in triangle.vertices {
            let place = vertices[vertex as usize].position.to_array().map(f32::to_bits);
            let other = *owner.entry(place).or_insert(i);
            let (a, b) = (root(&mut parent, i), root(&mut parent, other));
            parent[a.max(b)] = a.min(b);
        }
    }
    let mut lamps = vec![Lamp::default(); shining.len()];
    for (i, triangle) in shining.iter().enumerate() {
        let [a, b, c] = triangle.vertices.map(|v| vertices[v as usize]);
        let [p, q, r] = [a, b, c].map(|v| v.position.as_dvec3());
        let area = 0.5 * (q - p).cross(r - p).length();
        let normal = (a.normal + b.normal + c.normal).as_dvec3() / 3.0;
        let power = emission[triangle.material as usize].as_dvec3() * area;
        let part = Lamp { middle: (p + q + r) / 3.0 * area, normal: normal * area, area, power };
        lamps[root(&mut parent, i)].add(&part);
    }
    lamps.retain(|lamp| lamp.area > 0.0);
    lamps
}

/// The root of `i` in a union-find forest; halves the path to it.
fn root(parent: &mut [usize], mut i: usize) -> usize {
    while parent[i] != i {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    i
}

/// Merges the lamps into at most [`MAX_LIGHTS`].
fn merge(lamps: Vec<Lamp>) -> Vec<Lamp> {
    let mut groups = vec![lamps];
    while groups.len() < MAX_LIGHTS {
        let reach = |group: &Vec<Lamp>| {
            let bounds = Aabb::from_points(group.iter().map(|lamp| lamp.position().as_vec3()));
            bounds.extent().max_element()
        };
        let Some(widest) = (0..groups.len()).max_by(|&a, &b| reach(&groups[a]).total_cmp(&reach(&groups[b]))) else {
            break;
        };
        let group = &groups[widest];
        let bounds = Aabb::from_points(group.iter().map(|lamp| lamp.position().as_vec3()));
        let (extent, middle) = (bounds.extent(), bounds.center());
        let axis = (0..3).max_by(|&a, &b| extent[a].total_cmp(&extent[b])).unwrap_or(0);
        let low = |lamp: &Lamp| (lamp.position()[axis] as f32) < middle[axis];
        let (low, high): (Vec<Lamp>, Vec<Lamp>) = group.iter().partition(|lamp| low(lamp));
        if low.is_empty() || high.is_empty() {
            break;
        }
        groups[widest] = low;
        groups.push(high);
    }
    let one = |group: &Vec<Lamp>| {
        let mut sum = Lamp::default();
        group.iter().for_each(|lamp| sum.add(lamp));
        sum
    };
    groups.iter().map(one).collect()
}
