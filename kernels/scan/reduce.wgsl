// Sums of groups of words: one word for each group. Twin: src/workloads/scan/reduce.rs.

//!include scan/job.wgsl
//!include scan/wraps.wgsl
//!slot sweep

@group(0) @binding(1) var<storage, read> values: array<u32>;
@group(0) @binding(3) var<storage, read_write> sums: array<u32>;

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(workgroup_id) id: vec3<u32>, @builtin(local_invocation_index) lane: u32, place: Place) {
    let group = id.y * job.row_groups + id.x;
    // The order of additions does not matter here: neighbours read neighbours
    var sum = 0u;
    for (var i = lane; i < GROUP_ELEMENTS; i += GROUP_SIZE) {
        let index = group * GROUP_ELEMENTS + i;
        if (index < job.length) {
            sum = add(sum, values[index]);
        }
    }
    let total = group_sum(lane, place, sum);
    if (lane == 0u && group < job.groups) {
        sums[group] = total;
    }
}
