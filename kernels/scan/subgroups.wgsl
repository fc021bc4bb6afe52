// Sums over a work-group by its subgroups, of any size and however invocations are spread over them. (naga takes the
// operations without `enable subgroups`, which it does not know.)

struct Place {
    @builtin(subgroup_id) subgroup: u32,
    @builtin(num_subgroups) subgroups: u32,
}

// Of each subgroup, whose first invocation writes them.
var<workgroup> sizes: array<u32, GROUP_SIZE>;
var<workgroup> partial: array<u32, GROUP_SIZE>;

// True in one invocation of each subgroup, all of whose invocations must call it. (naga has no subgroupElect.)
fn is_first() -> bool {
    return subgroupExclusiveAdd(1u) == 0u;
}

fn begin_sweep(lane: u32, place: Place) {
    let size = subgroupAdd(1u);
    if (is_first()) {
        sizes[place.subgroup] = size;
    }
}

// The invocation's part of the group's words: ranks follow subgroups, so that a subgroup has neighbouring parts.
fn rank_of(lane: u32, place: Place) -> u32 {
    var rank = subgroupExclusiveAdd(1u);
    for (var i = 0u; i < place.subgroup; i += 1u) {
        rank += sizes[i];
    }
    return rank;
}

// The sum of the values before this one in its subgroup. The subgroup's sum goes into `partial`.
fn subgroup_sum(place: Place, value: u32) -> u32 {
    let before = subgroupExclusiveAdd(value);
    // Wraps in the first invocation up to which the sum is 2^32 or more
    let noted = add(before, value);
    let sum = subgroupAdd(value);
    if (is_first()) {
        partial[place.subgroup] = sum;
    }
    return before;
}

// The sum of all values.
fn group_sum(lane: u32, place: Place, value: u32) -> u32 {
    subgroup_sum(place, value);
    workgroupBarrier();
    var sum = 0u;
    for (var i = 0u; i < place.subgroups; i += 1u) {
        sum = add(sum, partial[i]);
    }
    return sum;
}

// The sum of the values of lower ranks.
fn exclusive_sum(rank: u32, place: Place, value: u32) -> u32 {
    var before = subgroup_sum(place, value);
    workgroupBarrier();
    var sum = 0u;
    for (var i = 0u; i < place.subgroups; i += 1u) {
        if (i == place.subgroup) {
            before += sum;
        }
        sum = add(sum, partial[i]);
    }
    return before;
}
