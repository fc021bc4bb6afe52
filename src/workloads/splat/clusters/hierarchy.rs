//! The nodes above clusters. Twin of `kernels/splat/clusters/leaves.wgsl` and `kernels/splat/clusters/nodes.wgsl`.

use super::layout::LEVELS;
use super::{Bounds, KeyLayout, Nodes};

/// The nodes above clusters with these keys, which have the bits of the layout, and these boxes.
pub fn nodes(layout: &KeyLayout, cluster_keys: &[u32], boxes: &[Bounds]) -> Nodes {
    let count = layout.nodes() as usize;
    let mut nodes = Nodes { masks: vec![0; count], boxes: vec![Bounds::EMPTY; count] };
    for (&key, bounds) in cluster_keys.iter().zip(boxes) {
        for level in 0..LEVELS {
            let node = layout.node_of(key, level) as usize;
            nodes.masks[node] |= 1 << KeyLayout::child_of(key, level);
            nodes.boxes[node] = nodes.boxes[node].union(bounds);
        }
    }
    nodes
}
