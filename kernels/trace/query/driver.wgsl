// The driver's own structure through a ray query. The index of a triangle in it is that of its triangle reference. The
// driver's test decides what is hit; of equal distances any triangle may win.

enable wgpu_ray_query;

//!include lib/independent.wgsl

@group(0) @binding(14) var driver_tree: acceleration_structure;

fn traverse(ray: Ray, limit: f32, any: bool, alive: bool) -> u32 {
    if (!alive) {
        return MISS;
    }
    let flags = select(RAY_FLAG_FORCE_OPAQUE, RAY_FLAG_FORCE_OPAQUE | RAY_FLAG_TERMINATE_ON_FIRST_HIT, any);
    var query: ray_query;
    rayQueryInitialize(&query, driver_tree, RayDesc(flags, 0xffu, 0.0, limit, ray.origin, ray.direction));
    while (rayQueryProceed(&query)) {}
    let found = rayQueryGetCommittedIntersection(&query);
    return select(found.primitive_index, MISS, found.kind == RAY_QUERY_INTERSECTION_NONE);
}
