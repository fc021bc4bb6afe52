// Nodes of a kd-tree, 8 bytes each.

fn read_kd_node(i: u32) -> vec2<u32> {
    return read_node8(i);
}

fn leaf_first(node: vec2<u32>) -> u32 {
    return node.x;
}
