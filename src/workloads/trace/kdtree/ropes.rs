//! kd-tree with ropes, from a leaf straight on to the node behind the face through which a ray leaves it. Twin of
//! `kernels/trace/kdtree/ropes.wgsl`.
//!
//! S. Popov, J. Günther, H.-P. Seidel, P. Slusallek: Stackless KD-Tree Traversal for High Performance GPU Ray Tracing,
//! 2007. Ours is what happens at edges: where a ray leaves a leaf through several faces at once, passes a plane exactly
//! where it enters a node, or meets a cell of no length, a stack visits cells that no rope leads to. Such a ray is
//! given up and finished by the search with a trail ([`super::search`]), which needs no memory either. All others visit
//! the leaves that a stack visits, in the same order.

use crate::math::{MISS, Ray};
use crate::workloads::trace::algorithm::{Parameter, Parameters, Traversal};
use crate::workloads::trace::count::Count;
use crate::workloads::trace::kdtree::KdNode;
use crate::workloads::trace::kdtree::rope_layout::{KIND, NO_ROPE, RopeLeaf, RopeTree};
use crate::workloads::trace::kdtree::search;
use crate::workloads::trace::simt::{
    Event::{Fallback, Leaf, Pop, Restart, Rope, Step, Test},
    Lockstep,
    Part::One,
    Read, choice, maybe, repeat,
};
use crate::workloads::trace::traverse::{Best, TraverseIndependent, Triangles};

/// From leaf to leaf.
pub static ROPES: Traversal = Traversal {
    kernel: "trace/kdtree/ropes.wgsl",
    structure: &KIND,
    parameters: |_| Parameters::of(&[("SHORT_STACK", Parameter::Word(0)), ("PUSHDOWN", Parameter::Flag(true))]),
    slots: |_| &[("nodes", "trace/kdtree/rope_nodes.wgsl"), ("short_stack", "trace/kdtree/short_stack_private.wgsl")],
    twin: Some(|input| Ok(input.with(KdRopes::new(input.triangles(), input.structure()?)))),
    lockstep: Some(|_| LOCKSTEP),
    ..Traversal::INDEPENDENT
};

/// How its lanes wait for each other.
const LOCKSTEP: Lockstep = Lockstep::apart(&[
    repeat(&[repeat(&[One(Step)]), maybe(&[One(Leaf), repeat(&[One(Test)]), maybe(&[One(Rope)])])]),
    maybe(&[
        One(Fallback),
        repeat(&[choice(&[
            maybe(&[One(Leaf), repeat(&[One(Test)]), choice(&[maybe(&[One(Pop)]), maybe(&[One(Restart)])])]),
            maybe(&[One(Step)]),
        ])]),
    ]),
])
.reading(&[Read::one::<KdNode>(Step), Read { event: Leaf, stride: 16, bytes: size_of::<RopeLeaf>() as u64 }]);

/// See the module.
pub struct KdRopes<'a> {
    triangles: Triangles<'a>,
    ropes: &'a RopeTree,
    /// The search that finishes rays that are given up.
    finish: search::KdTree<'a, 0>,
}

/// Where a ray leaves a box, and through which face.
struct Exit {
    t: f32,
    axis: usize,
    /// Through several faces at once.
    edge: bool,
}

impl Exit {
    #[inline(always)]
    fn of(ray: &Ray, leaf: &RopeLeaf) -> Exit {
        let far = [0, 1, 2].map(|axis| {
            let inv = ray.inv_direction[axis];
            let plane = if inv < 0.0 { leaf.min[axis] } else { leaf.max[axis] };
            (plane - ray.origin_max[axis]) * inv
        });
        let x_first = far[0] < far[1];
        let t_xy = if x_first { far[0] } else { far[1] };
        if far[2] < t_xy {
            return Exit { t: far[2], axis: 2, edge: false };
        }
        Exit { t: t_xy, axis: usize::from(!x_first), edge: far[0] == far[1] || far[2] == t_xy }
    }
}

impl<'a> KdRopes<'a> {
    /// A traversal of a built tree with ropes.
    pub fn new(triangles: Triangles<'a>, ropes: &'a RopeTree) -> Self {
        KdRopes { triangles, ropes, finish: search::KdTree::without_stack(triangles, ropes) }
    }

    /// Goes down from a node to the leaf that the ray is in from distance `t` on, with its first row; `None` where it
    /// is in a plane of a node above that leaf at exactly this distance.
    #[inline(always)]
    fn find_leaf<C: Count>(&self, ray: &Ray, start: u32, t: f32, count: &mut C) -> Option<(u32, &RopeLeaf)> {
        let (mut index, mut unsure) = (start, false);
        loop {
            let node = self.ropes.node(index);
            if node.is_leaf() {
                return (!unsure).then(|| (node.first(), self.ropes.leaf_at(node.first())));
            }
            count.inner();
            count.read(index);
            let (t_from, t_to) = node.distances(ray);
            let (before, behind) = (t_from > t, t_to < t);
            unsure |= !(before || behind);
            let backwards = ray.inv_direction[node.axis()] < 0.0;
            index = if behind != backwards { node.right() } else { index + 1 };
        }
    }
}

impl TraverseIndependent for KdRopes<'_> {
    fn traverse<const ANY: bool, C: Count>(&self, ray: &Ray, limit: f32, count: &mut C) -> u32 {
        let Some((mut t, _)) = self.ropes.tree.interval(ray, limit) else {
            return MISS;
        };
        let mut best = Best::before(limit);
        let mut node = 0;
        while let Some((row, leaf)) = self.find_leaf(ray, node, t, count) {
            count.leaf();
            count.read(row);
            if self.triangles.test::<ANY, C>(ray, leaf.first, leaf.count, &mut best, count) {
                return best.triangle_ref;
            }
            let exit = Exit::of(ray, leaf);
            if best.t < exit.t {
                return best.triangle_ref;
            }
            // A cell of no length is treated like an edge
            if exit.edge || exit.t <= t {
                break;
            }
            node = leaf.rope(exit.axis, ray.inv_direction[exit.axis] < 0.0);
            if node == NO_ROPE {
                return best.triangle_ref;
            }
            count.rope();
            t = exit.t;
        }
        count.fallback();
        self.finish.search::<ANY, C>(ray, limit, best, count)
    }
}
