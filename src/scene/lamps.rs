//! Surfaces that shine become point lights.
//!
//! A lamp is a set of shining triangles that hang together. Its light stands at the middle of its area, a thousandth of
//! the scene's diagonal before it on the side of its normals, and has the colour of its emission times its area. If there
//! are more than [`MAX_LIGHTS`], neighbours are merged: the group of lamps that reaches farthest is halved, until there are
//! as many groups. Our lights do not fade with distance, so that units mean nothing: all are scaled so that together
//! their brightest channel is 1.

use super::{Light, Triangle};
use crate::math::{Aabb, Vertex};
use glam::{DVec3, Vec3};
use std::collections::HashMap;

/// Most lights that a file's lamps make: every one is a shadow ray per pixel.
pub const MAX_LIGHTS: usize = 4;

/// Memory per triangle that shines, at most: its lamp twice, its corners' places, a tree's link and a pointer.
pub const BYTES: usize = 2 * size_of::<Lamp>() + 3 * 42 + 2 * size_of::<usize>();

/// A lamp, or several.
#[derive(Clone, Copy, Debug, Default)]
struct Lamp {
    /// Sum of the middles of triangles, weighted by area.
    middle: DVec3,
    normal: DVec3,
    area: f64,
    /// Emission times area.
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

/// The lights of all triangles whose material has an emission.
pub fn lights(vertices: &[Vertex], triangles: &[Triangle], emission: &[Vec3]) -> Vec<Light> {
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

/// Shining triangles that share positions, in the order of their first triangle.
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

/// The root of a tree of a union-find forest; halves the way to it.
fn root(parent: &mut [usize], mut i: usize) -> usize {
    while parent[i] != i {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    i
}

/// At most [`MAX_LIGHTS`] groups of lamps, each as one.
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
