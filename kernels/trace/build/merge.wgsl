// Partners merge at the place of the lower one; other clusters move up. Twin: `merge` of
// src/workloads/trace/build/ploc.rs.

//!include trace/build/job.wgsl
//!include trace/build/ordered.wgsl
//!include trace/build/cluster.wgsl

@group(0) @binding(1) var<storage, read> partners: array<u32>;
@group(0) @binding(2) var<storage, read> places: array<u32>;  // clusters that remain before each
@group(0) @binding(3) var<storage, read> merging: array<u32>; // clusters that merge before each
@group(0) @binding(4) var<storage, read> clusters: array<vec4<u32>>;
@group(0) @binding(5) var<storage, read_write> merged: array<vec4<u32>>;
// Two rows each: lower corner and left child, upper corner and right child
@group(0) @binding(6) var<storage, read_write> inner: array<vec4<u32>>;
@group(0) @binding(7) var<storage, read_write> triangles: array<u32>; // of each inner node

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var i = id.x; i < job.count; i += job.stride) {
        let partner = partners[i];
        let is_mutual = partner != i && partners[partner] == i;
        let place = 2u * places[i];
        let lo = clusters[2u * i];
        let hi = clusters[2u * i + 1u];
        if (!is_mutual) {
            merged[place] = lo;
            merged[place + 1u] = hi;
        } else if (i < partner) {
            let other_lo = clusters[2u * partner];
            let other_hi = clusters[2u * partner + 1u];
            let box = around(box_at(lo, hi), box_at(other_lo, other_hi));
            let own = job.first + merging[i];
            let count = hi.w + other_hi.w;
            merged[place] = vec4<u32>(floats(box.lo), job.leaves + own);
            merged[place + 1u] = vec4<u32>(floats(box.hi), count);
            inner[2u * own] = vec4<u32>(floats(box.lo), lo.w);
            inner[2u * own + 1u] = vec4<u32>(floats(box.hi), other_lo.w);
            triangles[own] = count;
        }
    }
}
