// The boxes of the few inner nodes above all levels that have passes of their own: one invocation goes up from each
// node of the last list. Twin: src/workloads/trace/build/lbvh.rs.

//!include trace/build/refit_node.wgsl

// A leaf has no levels below it.
fn height_of(node: u32) -> u32 {
    if (nodes[node * 2u + 1u].w > 0u) {
        return 0u;
    }
    return heights[nodes[node * 2u].w / 2u - 1u];
}

@compute @workgroup_size(1)
fn main() {
    let count = atomicLoad(&lengths[job.level]);
    // A software driver ends a loop after 65,535 iterations
    for (var row = 0u; row < count; row += 32768u) {
        for (var i = row; i < min(row + 32768u, count); i += 1u) {
            var rank = list[i];
            while (rank != NONE) {
                let pair = 2u + 2u * rank;
                rank = refit(rank, 1u + max(height_of(pair), height_of(pair + 1u)));
            }
        }
    }
}
