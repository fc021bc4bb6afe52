// Each triangle is a cluster. Twin: src/workloads/trace/build/ploc.rs.

//!include trace/build/job.wgsl
//!include trace/build/ordered.wgsl
//!include trace/build/read_box.wgsl

@group(0) @binding(3) var<storage, read> order: array<u32>;
@group(0) @binding(4) var<storage, read_write> clusters: array<vec4<u32>>; // see trace/build/cluster.wgsl

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var i = id.x; i < job.count; i += job.stride) {
        let box = read_box(order[i]);
        clusters[2u * i] = vec4<u32>(floats(box.lo), i);
        clusters[2u * i + 1u] = vec4<u32>(floats(box.hi), 1u);
    }
}
