// Rays that leave the lights, uniform over all directions. One invocation per path. Twin: src/workloads/splat/emit.rs.

//!include splat/list.wgsl
//!include splat/rays.wgsl
//!include splat/random.wgsl

struct EmitJob {
    seed: u32,
    first_path: u32, // of this batch
    paths: u32,      // of this batch, whose rays are in the buffers
    row_groups: u32,
    lights: u32,
    is_first: u32,   // the first batch clears the counts of arrivals
    pad0: u32,
    pad1: u32,
}

struct Source {
    position: vec3<f32>,
    first_path: u32,     // lights follow each other, and so do their paths
    path_flux: vec3<f32>,
    paths: u32,
}

@group(0) @binding(0) var<uniform> job: EmitJob;
@group(0) @binding(1) var<storage, read> sources: array<Source>;
@group(0) @binding(2) var<storage, read_write> rays: array<TraceRay>;
@group(0) @binding(3) var<storage, read_write> carried: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> arrived: array<u32>;

// The light of a path.
fn source_of(path: u32) -> Source {
    var first = 0u;
    var end = job.lights;
    while (end - first > 1u) {
        let middle = first + (end - first) / 2u;
        if (sources[middle].first_path <= path) {
            first = middle;
        } else {
            end = middle;
        }
    }
    return sources[first];
}

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local_index: u32) {
    let index = list_index(group, local_index, job.row_groups);
    if (job.is_first != 0u && index < MAX_HITS) {
        arrived[index] = 0u;
    }
    if (index >= job.paths) {
        return;
    }
    let path = job.first_path + index;
    let source = source_of(path);
    rays[index] = trace_ray(source.position, unit_vector(job.seed, path, 0u));
    carried[index] = vec4<f32>(source.path_flux, 0.0);
}
