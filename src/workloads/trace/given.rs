//! Given rays. Twin of `kernels/trace/given.wgsl`.

use crate::math::{Hit, MISS, Ray, T_MAX};
use crate::workloads::trace::backend::GivenRay;
use crate::workloads::trace::count::CountOff;
use crate::workloads::trace::traverse::{GROUP, Traverse, Triangles, bits};

/// Traces up to 64 rays as one work-group; `hits` is as long as `given`.
pub fn trace_group<T: Traverse>(
    traversal: &T,
    triangles: Triangles,
    given: &[GivenRay],
    any_hit: bool,
    hits: &mut [Hit],
) {
    let alive = if given.len() >= GROUP { u64::MAX } else { (1 << given.len()) - 1 };
    let rays = std::array::from_fn(|lane| {
        let ray = &given[lane.min(given.len() - 1)];
        Ray::new(ray.origin.into(), ray.direction.into())
    });
    let mut counters = [CountOff; GROUP];
    hits.fill(Hit::NONE);
    if any_hit {
        let occluded = traversal.any_hits(&rays, T_MAX, alive, &mut counters);
        bits(occluded).for_each(|lane| hits[lane] = Hit { t: 0.0, triangle: 0 });
        return;
    }
    let triangle_refs = traversal.nearest_hits(&rays, alive, &mut counters);
    for (lane, hit) in hits.iter_mut().enumerate().filter(|(lane, _)| triangle_refs[*lane] != MISS) {
        let triangle_ref = &triangles.triangle_refs[triangle_refs[lane] as usize];
        *hit = Hit { t: triangles.surface(&rays[lane], triangle_ref).t, triangle: triangle_ref.triangle };
    }
}
