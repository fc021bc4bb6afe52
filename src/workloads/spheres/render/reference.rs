//! The picture by plain code: each operation in the order that all renderers keep. Nothing here is fast, and nothing is
//! shared with the renderers.

use super::super::count::Counts;
use super::super::options::Algorithm;
use super::super::scene::PackedSphere;
use super::super::view::View;
use glam::Vec3;
use std::ops::Range;

/// A picture and how its paths went.
pub struct Reference {
    /// Linear RGBA, rows from the top.
    pub image: Vec<[f32; 4]>,
    /// Hits of each pixel's path until its first miss.
    pub hits: Vec<u32>,
    /// Rays and hits of each trip; the other counters are 0.
    pub counts: Counts,
    /// Pixels of which a dead path hits again.
    pub hits_again: usize,
}

/// What lighting reads of a trip.
struct Trip {
    live: bool,
    direction: Vec3,
    normal: Vec3,
    color: Vec3,
}

/// Renders a frame with all trips of all paths.
pub fn render(spheres: &[PackedSphere], view: &View, algorithm: Algorithm) -> Reference {
    rows(spheres, view, algorithm, 0..view.height)
}

/// Renders some rows of a frame.
pub fn rows(spheres: &[PackedSphere], view: &View, algorithm: Algorithm, rows: Range<u32>) -> Reference {
    let trips = view.trips as usize;
    let mut result = Reference { image: Vec::new(), hits: Vec::new(), counts: Counts::new(trips), hits_again: 0 };
    for y in rows {
        for x in 0..view.width {
            let (path, again) = path(spheres, view, x, y);
            let color = match algorithm {
                Algorithm::TwoPass => backward(view, &path),
                Algorithm::OnePass => forward(view, &path),
            };
            let hits = path.iter().filter(|trip| trip.live).count();
            result.image.push([color.x, color.y, color.z, 1.0]);
            result.hits.push(hits as u32);
            result.counts.add_path(hits);
            result.hits_again += usize::from(again);
        }
    }
    result
}

/// All trips of a pixel's path, and whether one of them hits after another one has missed.
fn path(spheres: &[PackedSphere], view: &View, x: u32, y: u32) -> (Vec<Trip>, bool) {
    let px = x as f32 + view.half;
    let py = y as f32 + view.half;
    let mut direction = normalized(Vec3::new(
        (view.corner.x + view.right.x * px) + view.down.x * py,
        (view.corner.y + view.right.y * px) + view.down.y * py,
        (view.corner.z + view.right.z * px) + view.down.z * py,
    ));
    let mut origin = view.origin;
    let (mut position, mut normal, mut color) = (view.origin, Vec3::ZERO, Vec3::ZERO);
    let (mut live, mut again) = (true, false);
    let mut trips = Vec::new();
    for _ in 0..view.trips {
        match nearest(spheres, view, origin, direction) {
            Some((t, sphere)) => {
                again |= !live;
                position =
                    Vec3::new(origin.x + direction.x * t, origin.y + direction.y * t, origin.z + direction.z * t);
                normal = normalized(minus(position, sphere.center));
                color = sphere.color;
            }
            None => live = false,
        }
        trips.push(Trip { live, direction, normal, color });
        let twice = view.two * dot(direction, normal);
        direction = normalized(minus(direction, times(normal, twice)));
        origin = position;
    }
    (trips, again)
}

/// The nearest sphere with its distance; of equal distances that of the sphere that comes first.
fn nearest<'a>(
    spheres: &'a [PackedSphere],
    view: &View,
    origin: Vec3,
    direction: Vec3,
) -> Option<(f32, &'a PackedSphere)> {
    let mut result = None;
    let mut best = view.far;
    for sphere in spheres {
        let oc = minus(sphere.center, origin);
        let a = dot(direction, direction);
        let b = dot(oc, direction);
        let q = dot(oc, oc) - sphere.radius2;
        let discriminant = b * b - a * q;
        if discriminant > 0.0 {
            let s = discriminant.sqrt();
            let first = (b - s) / a;
            let t = if first > view.epsilon { first } else { (b + s) / a };
            if t > view.epsilon && t < best {
                best = t;
                result = Some((t, sphere));
            }
        }
    }
    result
}

/// From the last trip to the first.
fn backward(view: &View, path: &[Trip]) -> Vec3 {
    let mut color = Vec3::ZERO;
    for trip in path.iter().rev() {
        if trip.live {
            let lighting = lighting(view, trip);
            color = Vec3::new(
                ((color.x * view.intensity) * trip.color.x) + lighting.x,
                ((color.y * view.intensity) * trip.color.y) + lighting.y,
                ((color.z * view.intensity) * trip.color.z) + lighting.z,
            );
        }
    }
    color
}

/// From the first trip to the last.
fn forward(view: &View, path: &[Trip]) -> Vec3 {
    let mut color = Vec3::ZERO;
    let mut throughput = Vec3::new(view.one, view.one, view.one);
    for trip in path {
        if trip.live {
            let lighting = lighting(view, trip);
            color = Vec3::new(
                color.x + throughput.x * lighting.x,
                color.y + throughput.y * lighting.y,
                color.z + throughput.z * lighting.z,
            );
            throughput = Vec3::new(
                throughput.x * (trip.color.x * view.intensity),
                throughput.y * (trip.color.y * view.intensity),
                throughput.z * (trip.color.z * view.intensity),
            );
        }
    }
    color
}

fn lighting(view: &View, trip: &Trip) -> Vec3 {
    let n = trip.normal;
    let nl = dot(n, view.light);
    let diffuse = if nl > 0.0 { nl } else { 0.0 };
    let mirrored = minus(times(n, view.two * nl), view.light);
    let towards_viewer = -(dot(mirrored, trip.direction));
    let cosine = if nl > 0.0 && towards_viewer > 0.0 { towards_viewer } else { 0.0 };
    let power2 = cosine * cosine;
    let power4 = power2 * power2;
    let power8 = power4 * power4;
    let power16 = power8 * power8;
    let power32 = power16 * power16;
    let channel = |color: f32, ambient: f32, light: f32| (color * (ambient + light * diffuse)) + light * power32;
    Vec3::new(
        channel(trip.color.x, view.ambient.x, view.light_color.x),
        channel(trip.color.y, view.ambient.y, view.light_color.y),
        channel(trip.color.z, view.ambient.z, view.light_color.z),
    )
}

fn dot(a: Vec3, b: Vec3) -> f32 {
    (a.x * b.x + a.y * b.y) + a.z * b.z
}

fn minus(a: Vec3, b: Vec3) -> Vec3 {
    Vec3::new(a.x - b.x, a.y - b.y, a.z - b.z)
}

fn times(a: Vec3, factor: f32) -> Vec3 {
    Vec3::new(a.x * factor, a.y * factor, a.z * factor)
}

fn normalized(a: Vec3) -> Vec3 {
    let length = dot(a, a).sqrt();
    Vec3::new(a.x / length, a.y / length, a.z / length)
}
