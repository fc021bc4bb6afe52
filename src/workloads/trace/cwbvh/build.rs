//! Compressed wide BVHs of obvhs, and of our own BVHs.
//!
//! obvhs builds by PLOC with reinsertion and collapses as the paper says (H. Ylitie, T. Karras and S. Laine: Efficient
//! Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs, 2017). Which children a node has and where they lie
//! is taken from it; boxes are fitted to the triangles and encoded anew, since obvhs works in a scaled scene and rounds
//! for its own traversal.

use super::encode::{Below, Child, Source, encode};
use super::layout::{CwNode, Cwbvh, MAX_LEAF, WIDTH};
use crate::error::Result;
use crate::math::Aabb;
use crate::scene::Scene;
use crate::workloads::trace::bvh::ploc::Given;
use crate::workloads::trace::bvh::{Bvh, MAX_DEPTH};
use crate::workloads::trace::common::prims;
use crate::workloads::trace::wide::collapse::Choice;
use crate::workloads::trace::wide::octants;
use obvhs::BvhBuildParams;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh_from_tris;

/// A tree by obvhs; `None` where PLOC would take excessive time, or its tree is deeper than [`MAX_DEPTH`].
///
/// # Errors
/// [`crate::Error::Refused`] if there are more triangles than a structure can hold.
pub fn by_obvhs(scene: &Scene, params: BvhBuildParams) -> Result<Option<Cwbvh>> {
    let Some(given) = Given::of(scene, params.pre_split)? else { return Ok(None) };
    if given.triangles.is_empty() {
        return Ok(Some(empty(given.bounds)));
    }
    let tree = build_cwbvh_from_tris(&given.obvhs_triangles(), params, &mut Default::default());
    let source = OfObvhs::new(&given, &tree);
    Ok(source.map(|source| encode(&source, 0, given.bounds)))
}

/// A tree collapsed from a BVH with leaves of at most three triangles.
pub fn from_bvh(bvh: &Bvh) -> Cwbvh {
    if bvh.triangle_refs.is_empty() {
        return empty(bvh.bounds);
    }
    encode(&OfBvh { bvh, choice: Choice::of(bvh, WIDTH), axes: octants::axes(WIDTH, bvh.bounds) }, 0, bvh.bounds)
}

fn empty(bounds: Aabb) -> Cwbvh {
    Cwbvh { bounds, nodes: vec![CwNode::EMPTY], triangle_refs: Vec::new(), depth: 0 }
}

struct OfBvh<'a> {
    bvh: &'a Bvh,
    choice: Choice<'a>,
    axes: Vec<usize>,
}

impl OfBvh<'_> {
    fn child(&self, index: u32) -> Child {
        let node = self.bvh.nodes[index as usize];
        let range = node.first as usize..(node.first + node.count) as usize;
        debug_assert!(range.len() <= MAX_LEAF || node.count == 0);
        let below = match node.count {
            0 => Below::Node(index),
            _ => Below::Leaf(self.bvh.triangle_refs[range].to_vec()),
        };
        Child { aabb: node.aabb(), below }
    }
}

impl Source for OfBvh<'_> {
    fn children(&self, node: u32) -> [Option<Child>; WIDTH] {
        let mut children = [const { None }; WIDTH];
        if self.bvh.nodes[node as usize].count > 0 {
            children[0] = Some(self.child(node)); // the root is a leaf
            return children;
        }
        let chosen = self.choice.children(node as usize);
        for (&child, place) in chosen.as_slice().iter().zip(chosen.places(self.bvh, Some(self.axes.as_slice()))) {
            children[place] = Some(self.child(child));
        }
        children
    }
}

struct OfObvhs<'a> {
    given: &'a Given<'a>,
    tree: &'a CwBvh,
    /// Of every child, by node and place.
    boxes: Vec<[Aabb; WIDTH]>,
}

impl<'a> OfObvhs<'a> {
    /// `None` if the tree is too deep.
    fn new(given: &'a Given<'a>, tree: &'a CwBvh) -> Option<OfObvhs<'a>> {
        let mut source = OfObvhs { given, tree, boxes: vec![[Aabb::EMPTY; WIDTH]; tree.nodes.len()] };
        let mut parents_first = vec![(0_usize, 1)];
        let mut next = 0;
        while let Some(&(index, level)) = parents_first.get(next) {
            if level > MAX_DEPTH {
                return None;
            }
            parents_first.extend(source.inner(index).map(|(_, child)| (child, level + 1)));
            next += 1;
        }
        for &(index, _) in parents_first.iter().rev() {
            let mut boxes = [Aabb::EMPTY; WIDTH];
            for (place, child) in source.inner(index) {
                boxes[place] = source.boxes[child].iter().fold(Aabb::EMPTY, |all, b| all.union(*b));
            }
            let node = &tree.nodes[index];
            for place in (0..WIDTH).filter(|&place| node.is_leaf(place) && !node.is_child_empty(place)) {
                let limit = given.limit(&node.child_aabb(place));
                let parts = source.leaf(index, place).into_iter().map(|triangle| given.part(triangle, limit));
                boxes[place] = parts.fold(Aabb::EMPTY, Aabb::union);
            }
            source.boxes[index] = boxes;
        }
        Some(source)
    }

    /// Places and nodes of a node's inner children.
    fn inner(&self, index: usize) -> impl Iterator<Item = (usize, usize)> + use<'a> {
        let node = &self.tree.nodes[index];
        let is_inner = move |place: &usize| !node.is_child_empty(*place) && !node.is_leaf(*place);
        (0..WIDTH).filter(is_inner).map(move |place| (place, node.child_node_index(place) as usize))
    }

    /// The triangles of a leaf, each once.
    fn leaf(&self, index: usize, place: usize) -> Vec<u32> {
        let (first, count) = self.tree.nodes[index].child_primitives(place);
        self.given.leaf(&self.tree.primitive_indices[first as usize..(first + count) as usize])
    }
}

impl Source for OfObvhs<'_> {
    fn children(&self, node: u32) -> [Option<Child>; WIDTH] {
        let (index, from) = (node as usize, &self.tree.nodes[node as usize]);
        std::array::from_fn(|place| {
            let below = match (from.is_child_empty(place), from.is_leaf(place)) {
                (true, _) => return None,
                (false, false) => Below::Node(from.child_node_index(place)),
                (false, true) => {
                    let triangle_ref = |triangle| prims::triangle_ref(self.given.scene, triangle);
                    Below::Leaf(self.leaf(index, place).into_iter().map(triangle_ref).collect())
                }
            };
            Some(Child { aabb: self.boxes[index][place], below })
        })
    }
}
