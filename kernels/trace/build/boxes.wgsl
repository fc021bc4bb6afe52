// The box of every triangle, and a box around the centroids of those of each invocation. Twins:
// src/workloads/trace/common/prims.rs, src/workloads/trace/build/codes.rs.

//!include trace/build/job.wgsl
//!include trace/build/ordered.wgsl

struct Vertex {
    position: vec4<f32>,
    normal: vec4<f32>,
}

//!slot memory

@group(0) @binding(3) var<storage, read_write> boxes: array<u32>;
@group(0) @binding(4) var<storage, read_write> parts: array<u32>; // six words an invocation

fn corner(i: u32) -> vec3<u32> {
    return ordered(bitcast<vec3<u32>>(read_position(i)));
}

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    var centroids = NOTHING;
    for (var i = id.x; i < job.count; i += job.stride) {
        let triangle = read_triangle_ref(i);
        let a = corner(triangle.x);
        let b = corner(triangle.y);
        let c = corner(triangle.z);
        let box = Box(min(min(a, b), c), max(max(a, b), c));
        let at = i * 6u;
        boxes[at] = box.lo.x;
        boxes[at + 1u] = box.lo.y;
        boxes[at + 2u] = box.lo.z;
        boxes[at + 3u] = box.hi.x;
        boxes[at + 4u] = box.hi.y;
        boxes[at + 5u] = box.hi.z;
        let centroid = ordered(bitcast<vec3<u32>>(half_centroid(box)));
        centroids = around(centroids, Box(centroid, centroid));
    }
    let at = id.x * 6u;
    parts[at] = centroids.lo.x;
    parts[at + 1u] = centroids.lo.y;
    parts[at + 2u] = centroids.lo.z;
    parts[at + 3u] = centroids.hi.x;
    parts[at + 4u] = centroids.hi.y;
    parts[at + 5u] = centroids.hi.z;
}
