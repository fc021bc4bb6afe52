//! kd-tree, one ray at a time with a full stack: every far child is kept. Twin of `kernels/trace/kdtree/stack.wgsl`.

use crate::math::{MISS, Ray};
use crate::workloads::trace::algorithm::Traversal;
use crate::workloads::trace::count::Count;
use crate::workloads::trace::kdtree::{KIND, KdNode, KdTree};
use crate::workloads::trace::simt::{
    Event::{Leaf, Pop, Step, Test},
    Lockstep,
    Part::One,
    Read, maybe, repeat,
};
use crate::workloads::trace::traverse::{Best, STACK_SIZE, TraverseIndependent, Triangles};

/// Depth first, near child first.
pub static STACK: Traversal = Traversal {
    kernel: "trace/kdtree/stack.wgsl",
    structure: &KIND,
    slots: |_| &[("nodes", "trace/kdtree/nodes.wgsl")],
    twin: Some(|input| Ok(input.with(KdStack::new(input.triangles(), input.structure()?)))),
    lockstep: Some(|_| LOCKSTEP),
    ..Traversal::INDEPENDENT
};

/// How its lanes wait for each other.
const LOCKSTEP: Lockstep =
    Lockstep::apart(&[repeat(&[repeat(&[One(Step)]), maybe(&[One(Leaf), repeat(&[One(Test)]), maybe(&[One(Pop)])])])])
        .reading(&[Read::one::<KdNode>(Step), Read::one::<KdNode>(Leaf)]);

/// See the module.
pub struct KdStack<'a> {
    triangles: Triangles<'a>,
    tree: &'a KdTree,
}

/// A node, and the part of the ray in its cell.
#[derive(Clone, Copy, Default)]
struct Part {
    node: u32,
    t_min: f32,
    t_max: f32,
}

struct Walk {
    part: Part,
    /// Far children to visit.
    stack: [Part; STACK_SIZE],
    depth: usize,
    /// The ray has branched at a plane that it lies in: the far sides do not begin behind the near ones.
    in_plane: bool,
}

impl<'a> KdStack<'a> {
    /// A traversal of a built tree.
    pub fn new(triangles: Triangles<'a>, tree: &'a KdTree) -> Self {
        KdStack { triangles, tree }
    }

    /// Goes down, near child first, to a leaf. A cell whose two ends round to one distance is still visited, as a
    /// triangle may lie in it alone.
    #[inline(always)]
    fn walk_to_leaf<C: Count>(&self, ray: &Ray, walk: &mut Walk, count: &mut C) -> KdNode {
        let part = &mut walk.part;
        loop {
            let node = self.tree.nodes[part.node as usize];
            if node.is_leaf() {
                return node;
            }
            count.inner();
            count.read(part.node);
            let (t_from, t_to) = node.distances(ray);
            let (left, right) = (part.node + 1, node.right());
            let backwards = ray.inv_direction[node.axis()] < 0.0;
            let (near, far) = if backwards { (right, left) } else { (left, right) };
            if t_from > part.t_max {
                part.node = near;
            } else if t_to < part.t_min {
                part.node = far;
            } else {
                walk.in_plane |= t_from != t_to;
                walk.stack[walk.depth] = Part { node: far, t_min: part.t_min.max(t_from), t_max: part.t_max };
                walk.depth += 1;
                *part = Part { node: near, t_max: part.t_max.min(t_to), ..*part };
            }
        }
    }
}

impl TraverseIndependent for KdStack<'_> {
    fn traverse<const ANY: bool, C: Count>(&self, ray: &Ray, limit: f32, count: &mut C) -> u32 {
        let Some((t_min, t_max)) = self.tree.interval(ray, limit) else {
            return MISS;
        };
        let part = Part { node: 0, t_min, t_max };
        let mut walk = Walk { part, stack: [Part::default(); STACK_SIZE], depth: 0, in_plane: false };
        let mut best = Best::before(limit);
        loop {
            let leaf = self.walk_to_leaf(ray, &mut walk, count);
            count.leaf();
            count.read(walk.part.node);
            if self.triangles.test::<ANY, C>(ray, leaf.first(), leaf.count(), &mut best, count) {
                return best.triangle_ref;
            }
            // Exactly at the border of this leaf's cell the next leaf may hold a triangle at the same distance with a
            // lower index
            if (best.t < walk.part.t_max && !walk.in_plane) || walk.depth == 0 {
                return best.triangle_ref;
            }
            count.pop();
            walk.depth -= 1;
            walk.part = walk.stack[walk.depth];
        }
    }
}
