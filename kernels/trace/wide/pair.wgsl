// Two children a node: what loops over pairs read, as from trace/bvh/node.wgsl. Twin:
// src/workloads/trace/wide/layout.rs.

//!include trace/wide/node.wgsl

fn read_left(node: u32) -> Slot {
    return read_slot(2u * node);
}

fn read_right(node: u32) -> Slot {
    return read_slot(2u * node + 1u);
}
