//! Collapse of a BVH into a tree of more children a node.
//!
//! Which nodes of the BVH remain is decided as by H. Ylitie, T. Karras and S. Laine (Efficient Incoherent Ray Traversal
//! on GPUs Through Compressed Wide BVHs, 2017, section 3.1): dynamic programming over the BVH finds the tree of least
//! surface area in nodes. `cost(n, i)` is the least cost of what lies below node `n` as at most `i` roots: for one root
//! that of a node with up to `width` children, which are the roots of both sides; for more, of both sides or of fewer
//! roots. Ours: leaves are those of the BVH, which are never merged; and every node costs a little besides its area, so
//! that of equal areas fewer nodes win.

use super::layout::{Slot, Wide};
use super::octants;
use super::quantise::Planes;
use crate::workloads::trace::bvh::stack::LEAF;
use crate::workloads::trace::bvh::{Bvh, BvhNode};
use crate::workloads::trace::common::sah::half_area;

/// Most children that a node can have.
pub const MAX_WIDTH: usize = 8;

/// What a node costs besides its area, as a share of the root's.
const NODE: f32 = 1.0e-7;

/// A BVH with at most `width` children a node: 2, 4 or 8. Its leaves are those of the BVH, in their order. Children
/// come first in their node, or with `octants` lie where [`super::octants`] puts them.
pub fn collapse(bvh: Bvh, width: usize, octants: bool) -> Wide {
    let axes = octants.then(|| octants::axes(width, bvh.bounds));
    let planes = Planes::around(bvh.bounds, u16::MAX);
    let mut slots = vec![Slot::EMPTY; width];
    let (mut depth, mut stack) = (0, 0);
    let root = bvh.nodes[0];
    if root.count > 0 {
        slots[0] = Slot::around(root.aabb(), root.reference(), &planes);
        (depth, stack) = (1, 0);
    } else if root.first > 0 {
        let choice = Choice::of(&bvh, width);
        let mut waiting = vec![Waiting { node: 0, index: 0, depth: 1, pending: 0 }];
        while let Some(Waiting { node, index, depth: level, pending }) = waiting.pop() {
            let children = choice.children(node as usize);
            let first = (slots.len() / width) as u32;
            let (most, pending) = (pending + children.len as u32, pending + children.len as u32 - 1);
            (depth, stack) = (depth.max(level), stack.max(most - 1));
            let mut next = first;
            for (&child, place) in children.as_slice().iter().zip(children.places(&bvh, axes.as_deref())) {
                let node = bvh.nodes[child as usize];
                let is_leaf = node.count > 0;
                let reference = if is_leaf { node.reference() } else { next };
                slots[index as usize * width + place] = Slot::around(node.aabb(), reference, &planes);
                if !is_leaf {
                    waiting.push(Waiting { node: child, index: next, depth: level + 1, pending });
                    next += 1;
                }
            }
            // Depth first, from the first child on
            let inner = (next - first) as usize;
            let from = waiting.len() - inner;
            waiting[from..].reverse();
            slots.resize(slots.len() + inner * width, Slot::EMPTY);
        }
        debug_assert!(slots.len() / width < LEAF as usize);
    }
    Wide { bounds: bvh.bounds, width, slots, octants, triangle_refs: bvh.triangle_refs, depth, stack, planes }
}

/// A node of the BVH that is to become node `index`.
struct Waiting {
    node: u32,
    index: u32,
    depth: u32,
    /// Entries of a stack that may wait below it.
    pending: u32,
}

/// The children of a node.
#[derive(Default)]
pub struct Children {
    of: [u32; MAX_WIDTH],
    len: usize,
}

impl Children {
    /// Nodes of the BVH, from left to right.
    pub fn as_slice(&self) -> &[u32] {
        &self.of[..self.len]
    }

    /// Their places in the node: one after another, or by octants in these axes.
    pub fn places(&self, bvh: &Bvh, axes: Option<&[usize]>) -> Vec<usize> {
        let boxes = || self.as_slice().iter().map(|&child| bvh.nodes[child as usize].aabb()).collect::<Vec<_>>();
        axes.map_or_else(|| (0..self.len).collect(), |axes| octants::places(&boxes(), axes))
    }
}

/// Which nodes of a BVH remain.
pub struct Choice<'a> {
    bvh: &'a Bvh,
    width: usize,
    /// For node `n` as at most `i` roots, at `n * (width - 1) + i - 1`: how many of them come from its left side. As
    /// one root, of its `width` children. 0: fewer roots are cheaper.
    lefts: Vec<u8>,
}

impl<'a> Choice<'a> {
    /// The cheapest choice for nodes of up to `width` children.
    pub fn of(bvh: &'a Bvh, width: usize) -> Choice<'a> {
        assert!((2..=MAX_WIDTH).contains(&width), "{width} children a node");
        let most = width - 1; // roots of one side
        let mut choice = Choice { bvh, width, lefts: vec![0; bvh.nodes.len() * most] };
        // cost(n, i) at the same place as lefts. Leaves cost the same in every tree, so they are left out
        let mut costs = vec![0.0_f32; bvh.nodes.len() * most];
        let unit = half_area(&bvh.bounds).max(f64::MIN_POSITIVE);
        for &node in parents_first(bvh).iter().rev() {
            let (at, left) = (node as usize * most, bvh.nodes[node as usize].first as usize * most);
            let right = left + most;
            let cheapest = |costs: &[f32], roots: usize| {
                let sum = |of_left: usize| costs[left + of_left - 1] + costs[right + roots - of_left - 1];
                let from = roots.saturating_sub(most).max(1);
                let sums = (from..=most.min(roots - 1)).map(|of_left| (sum(of_left), of_left as u8));
                sums.reduce(|best, other| if other.0 < best.0 { other } else { best }).expect("roots on both sides")
            };
            let area = (half_area(&bvh.nodes[node as usize].aabb()) / unit) as f32;
            let (below, of_left) = cheapest(&costs, width);
            (costs[at], choice.lefts[at]) = (below + area + NODE, of_left);
            for roots in 2..=most {
                let (sum, of_left) = cheapest(&costs, roots);
                let fewer = costs[at + roots - 2];
                let place = at + roots - 1;
                (costs[place], choice.lefts[place]) = if sum < fewer { (sum, of_left) } else { (fewer, 0) };
            }
        }
        choice
    }

    /// The children of a node that remains.
    pub fn children(&self, node: usize) -> Children {
        let mut children = Children::default();
        self.sides(node, self.lefts[node * (self.width - 1)], self.width, &mut children);
        children
    }

    /// Adds a node as at most so many roots.
    fn add(&self, node: usize, mut roots: usize, children: &mut Children) {
        let is_leaf = self.bvh.nodes[node].count > 0;
        while !is_leaf && roots > 1 {
            match self.lefts[node * (self.width - 1) + roots - 1] {
                0 => roots -= 1,
                of_left => return self.sides(node, of_left, roots, children),
            }
        }
        children.of[children.len] = node as u32;
        children.len += 1;
    }

    fn sides(&self, node: usize, of_left: u8, roots: usize, children: &mut Children) {
        let left = self.bvh.nodes[node].first as usize;
        self.add(left, of_left as usize, children);
        self.add(left + 1, roots - of_left as usize, children);
    }
}

/// Inner nodes, every one after its parent.
fn parents_first(bvh: &Bvh) -> Vec<u32> {
    let is_inner = |node: &u32| bvh.nodes[*node as usize].count == 0 && bvh.nodes[*node as usize] != BvhNode::NONE;
    let mut order: Vec<u32> = Some(0).into_iter().filter(is_inner).collect();
    let mut next = 0;
    while let Some(&node) = order.get(next) {
        let first = bvh.nodes[node as usize].first;
        order.extend([first, first + 1].into_iter().filter(is_inner));
        next += 1;
    }
    order
}
