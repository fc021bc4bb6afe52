// One invocation for each element of a list, in rows of work-groups: a dispatch may have more than one row.

fn list_index(group: vec3<u32>, local_index: u32, row_groups: u32) -> u32 {
    return (group.y * row_groups + group.x) * GROUP_SIZE + local_index;
}

// What a kernel needs to know of its list.
struct List {
    count: u32,
    row_groups: u32, // work-groups in a row of the dispatch
    inverse_pi: f32,
    pad: u32,
}
