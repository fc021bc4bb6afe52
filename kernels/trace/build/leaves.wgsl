// The boxes of leaves. Twin: src/workloads/trace/build/lbvh.rs.

//!include trace/build/job.wgsl
//!include trace/build/ordered.wgsl
//!include trace/build/read_box.wgsl

@group(0) @binding(3) var<storage, read> order: array<u32>;
@group(0) @binding(4) var<storage, read> leaves: array<u32>;
@group(0) @binding(5) var<storage, read_write> nodes: array<vec4<u32>>;

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var i = id.x; i < job.count; i += job.stride) {
        let lower = leaves[i] * 2u;
        let first = nodes[lower].w;
        let last = first + nodes[lower + 1u].w - 1u;
        var box = NOTHING;
        // As many steps for every leaf: branches would cost a software driver more than what they leave out
        for (var k = 0u; k < job.max_leaf; k += 1u) {
            box = around(box, read_box(order[min(first + k, last)]));
        }
        let lo = floats(box.lo);
        let hi = floats(box.hi);
        nodes[lower].x = lo.x;
        nodes[lower].y = lo.y;
        nodes[lower].z = lo.z;
        nodes[lower + 1u].x = hi.x;
        nodes[lower + 1u].y = hi.y;
        nodes[lower + 1u].z = hi.z;
    }
}
