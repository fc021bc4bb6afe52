// The nodes of the tree, and lists of inner nodes whose children have boxes.
// Nodes are as src/workloads/trace/bvh/layout.rs says.
@group(0) @binding(3) var<storage, read_write> nodes: array<vec4<u32>>;
@group(0) @binding(4) var<storage, read_write> slots: array<u32>;       // the node that each inner node is
// Of the i-th kept node: children without a box
@group(0) @binding(5) var<storage, read_write> waiting: array<atomic<u32>>;
@group(0) @binding(6) var<storage, read_write> lengths: array<atomic<u32>>; // of the list of each level, depth, leaves
@group(0) @binding(7) var<storage, read_write> next: array<u32>;
