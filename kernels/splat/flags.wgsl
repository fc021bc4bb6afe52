// One for each slot that holds a photon, and zero for the others: what the prefix sum makes places of. Twin:
// `compacted` of src/workloads/splat/photons.rs, together with splat/scatter.wgsl.

//!include splat/list.wgsl

@group(0) @binding(0) var<uniform> list: List;
@group(0) @binding(1) var<storage, read> positions: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read_write> flags: array<u32>;

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local_index: u32) {
    let slot = list_index(group, local_index, list.row_groups);
    if (slot < list.count) {
        flags[slot] = select(0u, 1u, positions[slot].w > 0.0);
    }
}
