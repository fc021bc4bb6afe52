// The boxes of the nodes of a level, from those of their children, and the bits of these nodes in the level above. One
// invocation per node. Twin: src/workloads/splat/clusters/hierarchy.rs.

//!include splat/clusters/lookup.wgsl
//!include splat/list.wgsl

struct NodeJob {
    nodes: u32,        // of the level
    row_groups: u32,
    first: u32,        // node of the level
    first_child: u32,  // node of the level below
    first_parent: u32, // node of the level above
    clusters: u32,     // most of them
    is_root: u32,
    pad: u32,
}

@group(0) @binding(0) var<uniform> job: NodeJob;
@group(0) @binding(1) var<storage, read> places: array<u32>;
@group(0) @binding(2) var<storage, read> boxes: array<u32>;
@group(0) @binding(3) var<storage, read_write> masks: array<atomic<u32>>;
@group(0) @binding(4) var<storage, read_write> node_boxes: array<u32>;

fn mask_at(word: u32) -> u32 {
    return atomicLoad(&masks[word]);
}

// A word of a child's box. ABOVE_CLUSTERS: the children are clusters.
fn word_of(child: u32, i: u32) -> u32 {
    if (ABOVE_CLUSTERS) {
        return boxes[6u * child + i];
    }
    return node_boxes[6u * child + i];
}

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local_index: u32) {
    let node = list_index(group, local_index, job.row_groups);
    if (node >= job.nodes) {
        return;
    }
    let mask = mask_at(job.first + node);
    if (mask == 0u) {
        return;
    }
    var low = vec3<u32>(NONE, NONE, NONE);
    var high = vec3<u32>(0u, 0u, 0u);
    for (var rest = mask; rest != 0u; rest = rest & (rest - 1u)) {
        let key = node * 32u + firstTrailingBit(rest);
        var child = job.first_child + key;
        if (ABOVE_CLUSTERS) {
            child = min(identifier_of(key, job.first), job.clusters - 1u);
        }
        low = min(low, vec3<u32>(word_of(child, 0u), word_of(child, 1u), word_of(child, 2u)));
        high = max(high, vec3<u32>(word_of(child, 3u), word_of(child, 4u), word_of(child, 5u)));
    }
    let at = 6u * (job.first + node);
    node_boxes[at] = low.x;
    node_boxes[at + 1u] = low.y;
    node_boxes[at + 2u] = low.z;
    node_boxes[at + 3u] = high.x;
    node_boxes[at + 4u] = high.y;
    node_boxes[at + 5u] = high.z;
    if (job.is_root == 0u) {
        atomicOr(&masks[job.first_parent + (node >> 5u)], 1u << (node & 31u));
    }
}
