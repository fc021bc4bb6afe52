// The Morton code of every triangle: the bits of its centroid's cell on three axes in turn. Twin:
// src/workloads/trace/build/codes.rs.

//!include trace/build/job.wgsl
//!include trace/build/ordered.wgsl
//!include trace/build/read_box.wgsl

@group(0) @binding(3) var<storage, read_write> keys: array<u32>;

// Two zeros behind each of the lower ten bits.
fn spread(cell: vec3<u32>) -> vec3<u32> {
    var x = cell;
    x = (x | (x << vec3<u32>(16u))) & vec3<u32>(0x030000ffu);
    x = (x | (x << vec3<u32>(8u))) & vec3<u32>(0x0300f00fu);
    x = (x | (x << vec3<u32>(4u))) & vec3<u32>(0x030c30c3u);
    return (x | (x << vec3<u32>(2u))) & vec3<u32>(0x09249249u);
}

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var i = id.x; i < job.count; i += job.stride) {
        let cell = (half_centroid(read_box(i)) - job.lo) * job.scale;
        let bits = spread(vec3<u32>(min(cell, vec3<f32>(CELLS - 1.0))));
        keys[i] = bits.x | (bits.y << 1u) | (bits.z << 2u);
    }
}
