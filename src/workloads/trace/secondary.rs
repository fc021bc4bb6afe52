//! What follows from the nearest hits of primary rays. Twin of `kernels/trace/secondary/mirrored.wgsl`, `ambient.wgsl`,
//! `diffuse.wgsl` and `above.wgsl`.
//!
//! Directions of ambient and diffuse rays are drawn from the pixel and the ray's number. They are the same at each
//! frame of a path.

use crate::math::Ray;
use crate::workloads::random::{cosine_direction, unit_vector};
use crate::workloads::trace::backend::{AMBIENT_RAYS, Config, Size};
use crate::workloads::trace::count::Tally;
use crate::workloads::trace::path::{AMBIENT, DIFFUSE, Frame, PRIMARY, Paths, REFLECTED};
use crate::workloads::trace::shade::Surface;
use crate::workloads::trace::traverse::{GROUP, Lanes, Traverser, bits};
use glam::Vec3A;

/// Of all directions; pixels and numbers of rays tell them apart.
const SEED: u32 = 1;

/// Goes on from the primary hits of the group whose top left pixel is `corner`, column and row, to the pixels' colours.
pub fn shade_primary<C: Tally>(
    frame: &Frame,
    traversal: &dyn Traverser,
    corner: (u32, u32),
    paths: &mut Paths<C>,
    triangle_refs: &Lanes<u32>,
) {
    match frame.config {
        Config::P | Config::PS | Config::PSR => mirrored(frame, traversal, paths, triangle_refs),
        Config::AO => ambient(frame, traversal, corner, paths, triangle_refs),
        Config::DIFFUSE => diffuse(frame, traversal, corner, paths, triangle_refs),
    }
}

/// Light and shadow rays, and the segments that follow in mirrors.
fn mirrored<C: Tally>(frame: &Frame, traversal: &dyn Traverser, paths: &mut Paths<C>, triangle_refs: &Lanes<u32>) {
    if !frame.follow_hits(traversal, PRIMARY, paths, triangle_refs) {
        return;
    }
    for _ in 0..frame.config.bounces() {
        if paths.alive == 0 || !frame.follow(traversal, REFLECTED, paths) {
            break;
        }
    }
}

/// The share of ambient rays that hit nothing.
fn ambient<C: Tally>(
    frame: &Frame,
    traversal: &dyn Traverser,
    corner: (u32, u32),
    paths: &mut Paths<C>,
    triangle_refs: &Lanes<u32>,
) {
    let surfaces = frame.surfaces(PRIMARY, paths, triangle_refs);
    if paths.alive == 0 {
        return;
    }
    let mut open = [0u32; GROUP]; // rays that hit nothing
    for number in 0..AMBIENT_RAYS {
        bits(paths.alive).for_each(|lane| paths.counters[AMBIENT][lane].ray());
        let rays = rays_above(frame, paths, &surfaces, corner, number);
        let limit = frame.lengths.ambient;
        let occluded = traversal.any_hits(AMBIENT, &rays, limit, paths.alive, &mut paths.counters[AMBIENT]);
        bits(paths.alive & !occluded).for_each(|lane| open[lane] += 1);
    }
    for lane in bits(paths.alive) {
        paths.colour[lane] = Vec3A::splat(open[lane] as f32 * (1.0 / AMBIENT_RAYS as f32));
    }
}

/// The colour of the surface that the diffuse ray finds, lit from where the ray comes from.
fn diffuse<C: Tally>(
    frame: &Frame,
    traversal: &dyn Traverser,
    corner: (u32, u32),
    paths: &mut Paths<C>,
    triangle_refs: &Lanes<u32>,
) {
    let surfaces = frame.surfaces(PRIMARY, paths, triangle_refs);
    if paths.alive == 0 {
        return;
    }
    bits(paths.alive).for_each(|lane| paths.counters[DIFFUSE][lane].ray());
    paths.rays = rays_above(frame, paths, &surfaces, corner, 0);
    let triangle_refs = traversal.nearest_hits(DIFFUSE, &paths.rays, paths.alive, &mut paths.counters[DIFFUSE]);
    let seen = frame.surfaces(DIFFUSE, paths, &triangle_refs);
    for lane in bits(paths.alive) {
        let Some(seen) = &seen[lane] else { continue };
        let material = &frame.scene.materials[seen.material as usize];
        let cosine = (-seen.normal.dot(paths.rays[lane].direction)).max(0.0);
        paths.colour[lane] = Vec3A::from(material.ambient) + Vec3A::from(material.diffuse) * cosine;
    }
}

/// A ray from each surface.
fn rays_above<C>(
    frame: &Frame,
    paths: &Paths<C>,
    surfaces: &Lanes<Option<Surface>>,
    (column, row): (u32, u32),
    number: u32,
) -> Lanes<Ray> {
    std::array::from_fn(|lane| {
        let Some(surface) = &surfaces[lane] else { return paths.rays[lane] };
        let (x, y) = frame.places[lane];
        Ray::new(surface.point, direction_above(surface.geometric_normal, frame.size, (column + x, row + y), number))
    })
}

/// The direction of ray `number` of a pixel `(column, row)`, distributed as the cosine around a unit normal. Around the
/// normal of a triangle, no ray goes into its own triangle.
pub fn direction_above(normal: Vec3A, size: Size, (column, row): (u32, u32), number: u32) -> Vec3A {
    cosine_direction(normal, unit_vector(SEED, row * size.width + column, number))
}
