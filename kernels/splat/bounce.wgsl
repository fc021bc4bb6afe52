// One hit of all paths: photons are stored, and paths go on. One invocation per path. Twin:
// src/workloads/splat/bounce.rs.

//!include splat/list.wgsl
//!include splat/surface.wgsl
//!include splat/random.wgsl

struct BounceJob {
    seed: u32,
    first_path: u32, // of this batch
    paths: u32,      // of this batch
    row_groups: u32,
    number: u32,     // of the hit along its path, from 1
    per_path: u32,   // slots of a path: all hits but the first
    epsilon: f32,    // how far rays start off the surface
    divisor: f32,    // of stored flux
}

@group(0) @binding(0) var<uniform> job: BounceJob;
@group(0) @binding(2) var<storage, read> hits: array<TraceHit>;
@group(0) @binding(3) var<storage, read_write> rays: array<TraceRay>;
@group(0) @binding(4) var<storage, read_write> carried: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> positions: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> directions: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> fluxes: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> arrived: array<atomic<u32>>;

var<workgroup> group_arrived: atomic<u32>;

fn store(path: u32, position: vec4<f32>, direction: vec4<f32>, flux: vec4<f32>) {
    if (job.number >= 2u) {
        let slot = path * job.per_path + job.number - 2u;
        positions[slot] = position;
        directions[slot] = direction;
        fluxes[slot] = flux;
    }
}

//!include lib/cosine_direction.wgsl

// True if the path hits something.
fn follow(index: u32) -> bool {
    let path = job.first_path + index;
    let hit = hits[index];
    if (hit.triangle == MISS) {
        let nothing = vec4<f32>(0.0, 0.0, 0.0, 0.0);
        store(path, nothing, nothing, nothing);
        rays[index] = no_ray();
        return false;
    }
    let origin = rays[index].origin.xyz;
    let direction = rays[index].direction.xyz;
    let flux = carried[index].xyz;
    let surface = surface_at(origin, direction, hit.triangle, job.epsilon);
    let stored = flushed(flux / job.divisor);
    store(path, vec4<f32>(surface.point, f32(job.number)), vec4<f32>(direction, f32(path)), vec4<f32>(stored, 0.0));
    carried[index] = vec4<f32>(flushed(flux * surface.albedo), 0.0);
    let vector = unit_vector(job.seed, path, job.number);
    rays[index] = trace_ray(surface.point, cosine_direction(surface.normal, vector));
    return true;
}

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local_index: u32) {
    if (local_index == 0u) {
        atomicStore(&group_arrived, 0u);
    }
    workgroupBarrier();
    let index = list_index(group, local_index, job.row_groups);
    if (index < job.paths) {
        if (follow(index)) {
            atomicAdd(&group_arrived, 1u);
        }
    }
    workgroupBarrier();
    if (local_index == 0u) {
        atomicAdd(&arrived[job.number - 1u], atomicLoad(&group_arrived));
    }
}
