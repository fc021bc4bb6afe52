//! Nodes of 80 bytes from a tree of at most eight children a node, whose boxes are known exactly.

use super::layout::{CwNode, Cwbvh, INNER, WIDTH};
use crate::math::Aabb;
use crate::workloads::trace::TriangleRef;
use crate::workloads::trace::wide::Planes;

/// A child of a node that is to be encoded.
pub(super) struct Child {
    /// Its box.
    pub aabb: Aabb,
    /// What it leads to.
    pub below: Below,
}

/// What a child leads to.
pub(super) enum Below {
    /// A node of the source.
    Node(u32),
    /// One to three triangles.
    Leaf(Vec<TriangleRef>),
}

/// A tree with its children at the places that they are to have.
pub(super) trait Source {
    /// The children of a node, by place.
    fn children(&self, node: u32) -> [Option<Child>; WIDTH];
}

/// The tree below node `root` of the source. Boxes are rounded outwards by the operations that traversals decode them
/// with: the published kernels have rounding errors there instead, which may lose hits.
pub(super) fn encode(source: &impl Source, root: u32, bounds: Aabb) -> Cwbvh {
    let mut tree = Cwbvh { bounds, nodes: vec![CwNode::EMPTY], triangle_refs: Vec::new(), depth: 0 };
    let mut waiting = vec![(root, 0, 1)];
    while let Some((from, index, level)) = waiting.pop() {
        tree.depth = tree.depth.max(level);
        let children = source.children(from);
        let around = children.iter().flatten().fold(Aabb::EMPTY, |all, child| all.union(child.aabb));
        let grid = Planes::around(around, u16::from(u8::MAX));
        let mut node = CwNode {
            origin: grid.lo.into(),
            exponents: grid.step.to_array().map(|step| (step.to_bits() >> 23) as u8),
            first_child: tree.nodes.len() as u32,
            first_ref: tree.triangle_refs.len() as u32,
            ..CwNode::EMPTY
        };
        let (mut offset, first_waiting) = (0, waiting.len());
        for (place, child) in children.into_iter().enumerate() {
            let Some(Child { aabb, below }) = child else { continue };
            let numbers = grid.numbers(aabb);
            assert!(grid.aabb(numbers).contains(aabb), "planes do not reach around {aabb:?}");
            node.set_numbers(place, numbers);
            match below {
                Below::Node(next) => {
                    node.inner |= 1 << place;
                    node.meta[place] = (1 << 5) | (INNER + place as u8);
                    waiting.push((next, tree.nodes.len(), level + 1));
                    tree.nodes.push(CwNode::EMPTY);
                }
                Below::Leaf(triangle_refs) => {
                    let count = triangle_refs.len() as u8;
                    node.meta[place] = ((1 << count) - 1) << 5 | offset;
                    offset += count;
                    tree.triangle_refs.extend(triangle_refs);
                }
            }
        }
        // Depth first, from the first child on
        waiting[first_waiting..].reverse();
        tree.nodes[index] = node;
    }
    tree
}
