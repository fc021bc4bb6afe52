// The exclusive scan of each group of words, on top of what lies before the group. Twin:
// src/workloads/scan/exclusive.rs.

//!include scan/job.wgsl
//!slot before
//!slot values
//!slot sweep

// The group's words. Every eighth one is followed by a gap, so that invocations which walk through eight words each are
// in different banks.
var<workgroup> words: array<u32, GROUP_ELEMENTS + GROUP_SIZE>;

fn word(i: u32) -> u32 {
    return i + i / PER_INVOCATION;
}

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(workgroup_id) id: vec3<u32>, @builtin(local_invocation_index) lane: u32, place: Place) {
    begin_sweep(lane, place);
    let group = id.y * job.row_groups + id.x;
    for (var i = lane; i < GROUP_ELEMENTS; i += GROUP_SIZE) {
        let index = group * GROUP_ELEMENTS + i;
        var value = 0u;
        if (index < job.length) {
            value = read_value(index);
        }
        words[word(i)] = value;
    }
    workgroupBarrier();
    let rank = rank_of(lane, place);
    let first = rank * PER_INVOCATION;
    var sum = 0u;
    for (var i = 0u; i < PER_INVOCATION; i += 1u) {
        sum = add(sum, words[word(first + i)]);
    }
    var running = sum_before(min(group, job.groups - 1u)) + exclusive_sum(rank, place, sum);
    for (var i = 0u; i < PER_INVOCATION; i += 1u) {
        let value = words[word(first + i)];
        words[word(first + i)] = running;
        running += value;
    }
    end_level(rank == GROUP_SIZE - 1u, running);
    workgroupBarrier();
    for (var i = lane; i < GROUP_ELEMENTS; i += GROUP_SIZE) {
        let index = group * GROUP_ELEMENTS + i;
        if (index < job.length) {
            write_value(index, words[word(i)]);
        }
    }
}
