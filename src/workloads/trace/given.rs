//! Given rays. Twin of `kernels/trace/given.wgsl`.

use crate::math::{Hit, MISS, Ray};
use crate::workloads::trace::count::CountOff;
use crate::workloads::trace::traverse::{GROUP, Traverser, Triangles, bits, set_of};
use bytemuck::{Pod, Zeroable};
use glam::Vec3;

/// A ray as kernels read and write it: 32 bytes, two vec4. One without direction is not traced and hits nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct TraceRay {
    /// Start, in the scene's coordinates in memory.
    pub origin: Vec3,
    /// Padding of WGSL's vec4; always zero.
    pub pad0: f32,
    /// Direction, of a length near 1 for the nearest hit: nothing scales it.
    pub direction: Vec3,
    /// Padding of WGSL's vec4; always zero.
    pub pad1: f32,
}

impl TraceRay {
    /// A ray with zero padding.
    pub fn new(origin: Vec3, direction: Vec3) -> TraceRay {
        TraceRay { origin, pad0: 0.0, direction, pad1: 0.0 }
    }
}

/// Traces up to 64 rays as one work-group; `hits` is as long as `given`. With a limit it finds out whether anything is
/// hit before that distance (`t` and `triangle` are then 0), otherwise the nearest hit.
pub fn trace_group(
    traversal: &dyn Traverser,
    triangles: Triangles,
    given: &[TraceRay],
    any_before: Option<f32>,
    hits: &mut [Hit],
) {
    let alive = set_of((0..given.len()).filter(|&lane| given[lane].direction != Vec3::ZERO));
    let rays = std::array::from_fn(|lane| {
        let ray = &given[lane.min(given.len() - 1)];
        Ray::new(ray.origin.into(), ray.direction.into())
    });
    let mut counters = [CountOff; GROUP];
    hits.fill(Hit::NONE);
    if let Some(limit) = any_before {
        let occluded = traversal.any_hits(0, &rays, limit, alive, &mut counters);
        bits(occluded).for_each(|lane| hits[lane] = Hit { t: 0.0, triangle: 0 });
        return;
    }
    let triangle_refs = traversal.nearest_hits(0, &rays, alive, &mut counters);
    for (lane, hit) in hits.iter_mut().enumerate().filter(|(lane, _)| triangle_refs[*lane] != MISS) {
        let triangle_ref = &triangles.triangle_refs[triangle_refs[lane] as usize];
        *hit = Hit { t: triangles.surface(&rays[lane], triangle_ref).t, triangle: triangle_ref.triangle };
    }
}
