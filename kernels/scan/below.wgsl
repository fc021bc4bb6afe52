// A level of several groups: the level above has the sums before each of them. What wraps has been noted by its
// reduction.
@group(0) @binding(3) var<storage, read> sums: array<u32>;

fn note_wrap() {}

fn sum_before(group: u32) -> u32 {
    return sums[group];
}

fn end_level(is_last: bool, sum: u32) {}
