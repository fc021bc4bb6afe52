// Given rays: the nearest hit, or with ANY_HIT whether anything is hit before a limit. One invocation per ray. A ray
// without direction is not traced and hits nothing.
// Twin: src/workloads/trace/given.rs.

//!include lib/geom.wgsl
//!include trace/scene.wgsl
//!slot counting

var<private> lane: u32;

//!slot traversal

struct GivenRay {
    origin: vec4<f32>,
    direction: vec4<f32>,
}

struct GivenHit {
    t: f32,
    triangle: u32,
}

struct Job {
    rays: u32,
    row_groups: u32, // work-groups in a row of the dispatch
    limit: f32,      // with ANY_HIT, in units of the direction's length
    pad: u32,
}

@group(0) @binding(0) var<uniform> job: Job;
@group(0) @binding(3) var<storage, read> given: array<GivenRay>;
@group(0) @binding(8) var<storage, read_write> hits: array<GivenHit>;

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local_index: u32) {
    lane = local_index;
    let index = (group.y * job.row_groups + group.x) * GROUP_SIZE + local_index;
    let source = given[min(index, job.rays - 1u)];
    let alive = index < job.rays && any(source.direction.xyz != vec3<f32>(0.0, 0.0, 0.0));
    let ray = make_ray(source.origin.xyz, source.direction.xyz);
    var hit = GivenHit(T_MAX, MISS);
    if (ANY_HIT) {
        if (any_hit(ray, job.limit, alive) && alive) {
            hit = GivenHit(0.0, 0u);
        }
    } else {
        let triangle_ref = nearest_hit(ray, alive);
        if (triangle_ref != MISS && alive) {
            let corners = read_corners(triangle_ref);
            let found = surface_hit(ray, corners.a, corners.b, corners.c);
            hit = GivenHit(found.t, corners.triangle);
        }
    }
    if (index < job.rays) {
        hits[index] = hit;
    }
}
