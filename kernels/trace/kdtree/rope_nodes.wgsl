// Nodes of a kd-tree with ropes: two in a row of 16 bytes. A leaf's first word is the number of its first row, of which
// it has four (`RopeLeaf` of src/workloads/trace/kdtree/rope_layout.rs).

fn read_kd_node(i: u32) -> vec2<u32> {
    let row = read_node16(i / 2u);
    return select(row.xy, row.zw, (i & 1u) == 1u);
}

fn leaf_first(node: vec2<u32>) -> u32 {
    return read_node16(node.x).w;
}
