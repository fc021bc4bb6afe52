// No photon is in any list yet.

//!include splat/list.wgsl

@group(0) @binding(0) var<uniform> list: List;
@group(0) @binding(1) var<storage, read_write> counts: array<u32>;

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local_index: u32) {
    let index = list_index(group, local_index, list.row_groups);
    if (index < list.count) {
        counts[index] = 0u;
    }
}
