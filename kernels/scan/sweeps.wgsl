// Sums over a work-group in its memory: the up-sweep and the down-sweep of a balanced tree (Blelloch 1990; Harris,
// Sengupta and Owens 2007).

struct Place {
    // Nothing but the index is needed
    @builtin(local_invocation_id) id: vec3<u32>,
}

var<workgroup> partial: array<u32, GROUP_SIZE>;

fn begin_sweep(lane: u32, place: Place) {}

// The invocation's part of the group's words.
fn rank_of(lane: u32, place: Place) -> u32 {
    return lane;
}

// Sums of pairs, of pairs of pairs, and so on: the last word becomes the sum of all.
fn sweep_up(rank: u32, value: u32) {
    partial[rank] = value;
    for (var distance = 1u; distance < GROUP_SIZE; distance *= 2u) {
        workgroupBarrier();
        let right = (rank + 1u) * 2u * distance - 1u;
        if (right < GROUP_SIZE) {
            partial[right] = add(partial[right - distance], partial[right]);
        }
    }
    workgroupBarrier();
}

// The sum of all values.
fn group_sum(lane: u32, place: Place, value: u32) -> u32 {
    sweep_up(lane, value);
    return partial[GROUP_SIZE - 1u];
}

// The sum of the values of lower ranks.
fn exclusive_sum(rank: u32, place: Place, value: u32) -> u32 {
    sweep_up(rank, value);
    if (rank == 0u) {
        partial[GROUP_SIZE - 1u] = 0u;
    }
    for (var distance = GROUP_SIZE / 2u; distance > 0u; distance /= 2u) {
        workgroupBarrier();
        let right = (rank + 1u) * 2u * distance - 1u;
        if (right < GROUP_SIZE) {
            let left = partial[right - distance];
            partial[right - distance] = partial[right];
            partial[right] += left;
        }
    }
    workgroupBarrier();
    return partial[rank];
}
