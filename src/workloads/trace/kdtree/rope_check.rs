//! Invariants of ropes, over a kd-tree that is sound.

use crate::math::Aabb;
use crate::workloads::trace::common::check::{Verdict, ensure};
use crate::workloads::trace::kdtree::rope_layout::{LEAF_ROWS, NO_ROPE, RopeLeaf, RopeTree, leaf_count, node_rows};
use crate::workloads::trace::kdtree::{KdNode, KdTree};

/// Points of every face from which a rope is followed.
const POINTS: u32 = 2;

/// How far the volume of all leaves may be from the root's, as a share of it.
const VOLUME: f64 = 1.0e-6;

pub(crate) fn check(ropes: &RopeTree) -> Verdict {
    let RopeTree { tree, rows, .. } = ropes;
    let (nodes, leaves) = (tree.nodes.len(), leaf_count(tree.nodes.len()));
    let expected = node_rows(nodes) + LEAF_ROWS * leaves;
    ensure!(rows.len() == expected, "{} rows of nodes and leaves instead of {expected}", rows.len());
    if tree.bounds.is_empty() {
        return Ok(());
    }
    let walk = Walk { tree, pushed: ropes.pushed, cells: cells(tree) };
    let mut number = 0;
    for (index, node) in tree.nodes.iter().enumerate() {
        let own = ropes.node(index as u32);
        if !node.is_leaf() {
            ensure!(own == *node, "node {index} is {own:?} in the rows, {node:?} in the tree");
            continue;
        }
        let row = (node_rows(nodes) + LEAF_ROWS * number) as u32;
        ensure!(own == KdNode { word: row, ..*node }, "leaf {index} is {own:?} in the rows, its own begin at {row}");
        number += 1;
    }
    walk.volume(ropes.leaves())?;
    let indices = (0..nodes).filter(|&index| tree.nodes[index].is_leaf());
    ropes.leaves().iter().zip(indices).try_for_each(|(leaf, index)| walk.leaf(leaf, index))
}

/// A node's cell and its parent; the root's parent is itself.
struct Cell {
    space: Aabb,
    parent: u32,
}

fn cells(tree: &KdTree) -> Vec<Cell> {
    let mut cells: Vec<Cell> = Vec::with_capacity(tree.nodes.len());
    tree.for_each_cell(|_, &space, _| cells.push(Cell { space, parent: 0 }));
    for (index, node) in tree.nodes.iter().enumerate().filter(|(_, node)| !node.is_leaf()) {
        cells[index + 1].parent = index as u32;
        cells[node.right() as usize].parent = index as u32;
    }
    cells
}

struct Walk<'a> {
    tree: &'a KdTree,
    pushed: bool,
    cells: Vec<Cell>,
}

/// A face of a leaf, and what lies behind it.
struct Face {
    leaf: usize,
    axis: usize,
    upper: bool,
    /// Coordinate of its plane.
    plane: f32,
    cell: Aabb,
}

impl Walk<'_> {
    /// The leaves fill the root. One without volume is filled by nothing.
    fn volume(&self, leaves: &[RopeLeaf]) -> Verdict {
        let volume = |cell: &Aabb| (cell.max.as_dvec3() - cell.min.as_dvec3()).element_product();
        let (root, sum) = (volume(&self.tree.bounds), leaves.iter().map(|leaf| volume(&leaf.cell())).sum::<f64>());
        ensure!((sum - root).abs() <= VOLUME * root, "the leaves have a volume of {sum}, the root has {root}");
        Ok(())
    }

    fn leaf(&self, leaf: &RopeLeaf, index: usize) -> Verdict {
        let (node, cell) = (self.tree.nodes[index], self.cells[index].space);
        ensure!(leaf.cell() == cell, "leaf {index} has the box {:?}, its cell is {cell:?}", leaf.cell());
        ensure!(
            (leaf.first, leaf.count) == (node.first(), node.count()),
            "leaf {index} has {} triangle references from {}, its node {} from {}",
            leaf.count,
            leaf.first,
            node.count(),
            node.first()
        );
        for axis in 0..3 {
            for upper in [false, true] {
                let plane = if upper { cell.max[axis] } else { cell.min[axis] };
                self.rope(&Face { leaf: index, axis, upper, plane, cell }, leaf.rope(axis, !upper))?;
            }
        }
        Ok(())
    }

    fn rope(&self, face: &Face, rope: u32) -> Verdict {
        let Face { leaf, axis, upper, plane, cell } = *face;
        let name =
            format!("the rope of leaf {leaf} on axis {axis}, {}", if upper { "upper face" } else { "lower face" });
        let root = &self.tree.bounds;
        let on_root = plane == if upper { root.max[axis] } else { root.min[axis] };
        ensure!(
            on_root == (rope == NO_ROPE),
            "{name}: {}",
            if on_root { "leads out of the root" } else { "is missing" }
        );
        if on_root {
            return Ok(());
        }
        ensure!((rope as usize) < self.tree.nodes.len(), "{name}: leads to node {rope}, behind the last one");
        let target = &self.cells[rope as usize];
        for number in 0..POINTS {
            let point = face.point(number);
            let (found, behind) = (self.leaf_behind(face, point, rope), self.leaf_behind(face, point, 0));
            ensure!(found == behind, "{name}: leads to leaf {found}, but leaf {behind} lies behind {point:?}");
        }
        let begin = if upper { target.space.min[axis] } else { target.space.max[axis] };
        ensure!(begin == plane, "{name}: leads to node {rope}, which begins at {begin} and not at {plane}");
        let others = [(axis + 1) % 3, (axis + 2) % 3];
        let covered = others.iter().all(|&a| target.space.min[a] <= cell.min[a] && target.space.max[a] >= cell.max[a]);
        ensure!(covered, "{name}: leads to node {rope}, which does not cover the face");
        if !self.pushed {
            let parent = &self.cells[target.parent as usize];
            ensure!(parent.space.contains(cell), "{name}: leads to node {rope}, below one that touches the face");
            return Ok(());
        }
        let node = self.tree.nodes[rope as usize];
        let cut = node.is_leaf()
            || (node.axis() != axis && cell.min[node.axis()] < node.split() && node.split() < cell.max[node.axis()]);
        ensure!(cut, "{name}: leads to node {rope}, whose plane does not cut the face");
        Ok(())
    }

    /// The leaf below a node that a point just beyond a face lies in.
    fn leaf_behind(&self, face: &Face, point: [f32; 3], start: u32) -> usize {
        let mut index = start as usize;
        loop {
            let node = self.tree.nodes[index];
            if node.is_leaf() {
                return index;
            }
            let (at, split) = (point[node.axis()], node.split());
            // A plane that the face lies in is passed by what lies beyond an upper face
            let right = if node.axis() == face.axis && !face.upper { split < at } else { split <= at };
            index = if right { node.right() as usize } else { index + 1 };
        }
    }
}

impl Face {
    /// A point of the face that depends on a number, the same every time.
    fn point(&self, number: u32) -> [f32; 3] {
        let mut state = (self.leaf as u32 ^ number << 30).wrapping_mul(0x9e37_79b9) ^ (self.axis as u32) << 8;
        [0, 1, 2].map(|axis| {
            if axis == self.axis {
                return self.plane;
            }
            state = (state ^ state >> 15).wrapping_mul(0x2c1b_3c6d);
            let share = f64::from(state >> 8) / f64::from(1 << 24);
            let (min, max) = (self.cell.min[axis], self.cell.max[axis]);
            let point = (f64::from(min) + (f64::from(max) - f64::from(min)) * share) as f32;
            // What lies in the upper border is the next cell's
            if point < max { point } else { min }
        })
    }
}
