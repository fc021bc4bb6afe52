//!include trace/build/job.wgsl
//!include trace/build/ordered.wgsl
//!include trace/build/lists.wgsl

@group(0) @binding(1) var<storage, read> list: array<u32>;
@group(0) @binding(2) var<storage, read_write> heights: array<u32>; // of the i-th kept node
@group(0) @binding(8) var<storage, read> kept: array<u32>;

fn box_of(node: u32) -> Box {
    return Box(ordered(nodes[node * 2u].xyz), ordered(nodes[node * 2u + 1u].xyz));
}

const NONE = 0xffffffffu;

// Writes the node of a kept inner node. Returns its parent if that one waits for no other child, otherwise NONE.
fn refit(rank: u32, height: u32) -> u32 {
    heights[rank] = height;
    let pair = 2u + 2u * rank;
    let box = around(box_of(pair), box_of(pair + 1u));
    let slot = slots[kept[rank]];
    nodes[slot * 2u] = vec4<u32>(floats(box.lo), pair);
    nodes[slot * 2u + 1u] = vec4<u32>(floats(box.hi), 0u);
    if (slot == 0u) {
        atomicStore(&lengths[DEPTH], height);
        return NONE;
    }
    let parent = slot / 2u - 1u;
    return select(NONE, parent, atomicSub(&waiting[parent], 1u) == 1u);
}
