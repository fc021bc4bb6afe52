// One level of a scan: groups of GROUP_ELEMENTS words, each the work of a work-group of GROUP_SIZE invocations.

struct Job {
    length: u32,     // words of the level
    row_groups: u32, // work-groups in a row of the dispatch
    groups: u32,     // groups of the level
    pad: u32,
}

@group(0) @binding(0) var<uniform> job: Job;

// The sum of two parts of the level. One that wraps round is noted: the level's sum is then 2^32 or more.
fn add(a: u32, b: u32) -> u32 {
    let sum = a + b;
    if (sum < a) {
        note_wrap();
    }
    return sum;
}
