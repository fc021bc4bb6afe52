// Traversals that a whole work-group does together.

var<workgroup> group_flag: atomic<u32>;
var<workgroup> group_answer: u32;

// True for all if it is true for any. Must be called by the whole work-group; the answer is uniform.
fn group_any(mine: bool) -> bool {
    if (mine) {
        atomicOr(&group_flag, 1u);
    }
    workgroupBarrier();
    if (lane == 0u) {
        group_answer = atomicExchange(&group_flag, 0u);
    }
    return workgroupUniformLoad(&group_answer) != 0u;
}
