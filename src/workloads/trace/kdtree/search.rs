//! kd-tree without a full stack: restart (Foley and Sugerman 2005), pushdown and short stack (Horn et al. 2007). Twin
//! of `kernels/trace/kdtree/search.wgsl` and of `trail.wgsl`, which it includes.
//!
//! A restart resumes by the path taken, not by the distance reached: from afar, many cells have ends that round to the
//! same distance, and none of them may be skipped or visited endlessly.

use crate::error::Result;
use crate::math::Ray;
use crate::workloads::trace::algorithm::{Algorithm, Parameter, Parameters, Traversal};
use crate::workloads::trace::backend::Prepared;
use crate::workloads::trace::count::Count;
use crate::workloads::trace::cpu::TwinInput;
use crate::workloads::trace::kdtree::RopeTree;
use crate::workloads::trace::kdtree::ropes::ROPES;
use crate::workloads::trace::kdtree::stack::STACK;
use crate::workloads::trace::kdtree::{BUILDER, KIND, KdNode, KdTree as Tree};
use crate::workloads::trace::options::{Axis, GROUP, Kind, OptionInfo};
use crate::workloads::trace::selection::Selection;
use crate::workloads::trace::simt::{
    Event::{Leaf, Pop, Restart, Step, Test},
    Lockstep,
    Part::One,
    Read, choice, maybe, repeat,
};
use crate::workloads::trace::traverse::{Best, TraverseIndependent, Triangles};

/// The kd-tree of the thesis.
pub static KDTREE: Algorithm = Algorithm {
    name: "kdtree",
    alias: "",
    summary: "SAH kd-tree; a short stack of four with pushdown and restart, a full stack, or ropes",
    paper: "Shevtsov et al. 2007; Wald and Havran 2006; Horn et al. 2007; Popov et al. 2007",
    builder: &BUILDER,
    traversal: |selection| match selection.value("search") {
        "stack" => &STACK,
        "ropes" => &ROPES,
        _ => &SEARCH,
    },
    options: OPTIONS,
};

/// From leaf to leaf without a full stack.
pub static SEARCH: Traversal = Traversal {
    kernel: "trace/kdtree/search.wgsl",
    structure: &KIND,
    parameters,
    slots: |parameters| match parameters.flag("PRIVATE_STACK") {
        true => &[("nodes", "trace/kdtree/nodes.wgsl"), ("short_stack", "trace/kdtree/short_stack_private.wgsl")],
        false => &[("nodes", "trace/kdtree/nodes.wgsl"), ("short_stack", "trace/kdtree/short_stack_workgroup.wgsl")],
    },
    twin: Some(twin),
    lockstep: Some(|_| LOCKSTEP),
    ..Traversal::INDEPENDENT
};

/// How its lanes wait for each other.
const LOCKSTEP: Lockstep = Lockstep::apart(&[repeat(&[choice(&[
    maybe(&[One(Leaf), repeat(&[One(Test)]), choice(&[maybe(&[One(Pop)]), maybe(&[One(Restart)])])]),
    maybe(&[One(Step)]),
])])])
.reading(&[Read::one::<KdNode>(Step), Read::one::<KdNode>(Leaf)]);

/// Most entries of a short stack.
const MAX_SHORT_STACK: u32 = 32;

const OPTIONS: &[OptionInfo] = &[
    OptionInfo::new(
        Axis::Traversal,
        "search",
        "short-stack",
        "after a leaf: restart at the root, at the deepest node without a branch above (pushdown), pop from a short \
         stack and push down, pop from a stack of all far children, or follow the leaf's rope to its neighbour",
        Kind::Word(&["restart", "pushdown", "short-stack", "stack", "ropes"]),
    ),
    OptionInfo::new(Axis::Traversal, "stack", "4", "entries of the short stack", Kind::Count(1, MAX_SHORT_STACK))
        .idle_if(has_no_stack),
    OptionInfo::new(
        Axis::Traversal,
        "memory",
        "workgroup",
        "where the short stack lies",
        Kind::Word(&["workgroup", "private"]),
    )
    .idle_if(has_no_stack),
    GROUP,
];

fn has_no_stack(s: &Selection) -> Option<String> {
    let search = s.value("search");
    (search != "short-stack").then(|| format!("search={search} has no short stack"))
}

/// What a ray does after a leaf without a hit. With a short stack of no entries it restarts at once; with pushdown at
/// the deepest node above which it never had to branch (Horn et al. 2007), without at the root (Foley and Sugerman
/// 2005).
fn parameters(s: &Selection) -> Parameters {
    let search = s.value("search");
    let stack = if search == "short-stack" { s.count("stack").unwrap_or_default() } else { 0 };
    Parameters::of(&[
        ("SHORT_STACK", Parameter::Word(stack)),
        ("PUSHDOWN", Parameter::Flag(search != "restart")),
        ("PRIVATE_STACK", Parameter::Flag(s.value("memory") == "private")),
    ])
}

/// A stack of as many entries as the thesis's has room for: clearing a larger one would cost every ray.
const SMALL: usize = 4;

fn twin(input: TwinInput<'_>) -> Result<Box<dyn Prepared + '_>> {
    Ok(match input.method.parameters.word("SHORT_STACK") as usize <= SMALL {
        true => input.with(KdTree::<SMALL>::of(&input)?),
        false => input.with(KdTree::<{ MAX_SHORT_STACK as usize }>::of(&input)?),
    })
}

/// See the module. It has room for `MOST` entries of a short stack.
pub struct KdTree<'a, const MOST: usize> {
    triangles: Triangles<'a>,
    tree: &'a Tree,
    /// Where leaves are those of a tree with ropes.
    ropes: Option<&'a RopeTree>,
    /// Entries of the short stack.
    short_stack: usize,
    pushdown: bool,
}

#[derive(Clone, Copy, Default)]
struct Entry {
    node: u32,
    t_min: f32,
    t_max: f32,
}

struct Descent<const MOST: usize> {
    node: u32,
    t_min: f32,
    t_max: f32,
    /// Where the ray enters the tree, or 0.
    t_begin: f32,
    /// Where the ray leaves the tree, or its limit.
    t_end: f32,
    restart_node: u32,
    /// The ray has not branched yet: the restart node follows.
    pushdown: bool,
    /// Entries of the ring.
    ring: usize,
    /// Entries ever pushed less those popped; modulo `ring` it is a place in it.
    top: usize,
    /// Entries that are still in the ring.
    held: usize,
    stack: [Entry; MOST],
    /// The trail (after Laine 2010): one bit for each branch on the way from `restart_node` to `node`, the deepest in
    /// the lowest bit; set where the ray is on the far side, so that both sides are done when it comes back.
    trail: u64,
    /// Bits of the trail.
    branches: u32,
    /// Branches of the trail that a restart still has to go through.
    replay: u32,
    /// The ray has branched at a plane that it lies in: the far sides do not begin behind the near ones.
    in_plane: bool,
}

impl<const MOST: usize> Descent<MOST> {
    /// Goes one inner node down.
    #[inline]
    fn descend(&mut self, ray: &Ray, node: KdNode) {
        let inv = ray.inv_direction[node.axis()];
        let (t_from, t_to) = node.distances(ray);
        // Ordered along the ray. A plane behind the origin has t_to < 0 <= t_min: only the far side is left, which is
        // the side of the origin, as in the thesis. A cell whose two ends round to one distance is still visited,
        // as a triangle may lie in it alone.
        let (left, right) = (self.node + 1, node.right());
        let (near, far) = if inv < 0.0 { (right, left) } else { (left, right) };
        if t_from > self.t_max {
            self.node = near;
        } else if t_to < self.t_min {
            self.node = far;
        } else {
            self.branch(near, far, t_from, t_to);
        }
        if self.pushdown {
            self.restart_node = self.node;
        }
    }

    /// The ray overlaps both children: goes to the near one, or after a restart to the one that the trail says.
    #[inline]
    fn branch(&mut self, near: u32, far: u32, t_from: f32, t_to: f32) {
        self.pushdown = false;
        self.in_plane |= t_from != t_to;
        let t_far = self.t_min.max(t_from);
        if self.replay > 0 {
            self.replay -= 1;
            if self.trail >> self.replay & 1 == 1 {
                self.node = far;
                self.t_min = t_far;
                return;
            }
        } else {
            self.trail <<= 1;
            self.branches += 1;
        }
        if self.ring > 0 {
            self.stack[self.top % self.ring] = Entry { node: far, t_min: t_far, t_max: self.t_max };
            self.top += 1;
            self.held = (self.held + 1).min(self.ring);
        }
        self.node = near;
        self.t_max = self.t_max.min(t_to);
    }

    /// Leaves a leaf: goes to the far side of the deepest branch that is on its near side, by a pop or by a restart.
    /// False where there is none.
    #[inline]
    fn leave_leaf<C: Count>(&mut self, count: &mut C) -> bool {
        let done = self.trail.trailing_ones();
        if done >= self.branches {
            return false;
        }
        self.trail = self.trail >> done | 1;
        self.branches -= done;
        if self.held > 0 {
            count.pop();
            self.top -= 1;
            self.held -= 1;
            let entry = self.stack[self.top % self.ring];
            (self.node, self.t_min, self.t_max) = (entry.node, entry.t_min, entry.t_max);
        } else {
            count.restart();
            (self.node, self.t_min, self.t_max) = (self.restart_node, self.t_begin, self.t_end);
            self.replay = self.branches;
        }
        true
    }

    /// True if nothing nearer than `t` can follow. Exactly at the border of this leaf's cell the next leaf may hold a
    /// triangle at the same distance with a lower index.
    #[inline]
    fn ends_before(&self, t: f32) -> bool {
        t < self.t_max && !self.in_plane
    }
}

impl<'a, const MOST: usize> KdTree<'a, MOST> {
    fn of(input: &TwinInput<'a>) -> Result<Self> {
        let parameters = input.method.parameters;
        let (short_stack, pushdown) = (parameters.word("SHORT_STACK") as usize, parameters.flag("PUSHDOWN"));
        Ok(KdTree { triangles: input.triangles(), tree: input.structure()?, ropes: None, short_stack, pushdown })
    }

    /// A search that restarts after every leaf, at the deepest node above which it never had to branch.
    pub(crate) fn without_stack(triangles: Triangles<'a>, ropes: &'a RopeTree) -> Self {
        KdTree { triangles, tree: &ropes.tree, ropes: Some(ropes), short_stack: 0, pushdown: true }
    }

    /// The index of what is read for a leaf.
    #[inline(always)]
    fn leaf_index(&self, node: u32) -> u32 {
        self.ropes.map_or(node, |ropes| ropes.node(node).first())
    }

    #[inline]
    fn start_descent(&self, ray: &Ray, limit: f32) -> Option<Descent<MOST>> {
        let (t_min, t_end) = self.tree.interval(ray, limit)?;
        Some(Descent {
            node: 0,
            t_min,
            t_max: t_end,
            t_begin: t_min,
            t_end,
            restart_node: 0,
            pushdown: self.pushdown,
            ring: self.short_stack.min(MOST),
            top: 0,
            held: 0,
            stack: [Entry::default(); MOST],
            trail: 0,
            branches: 0,
            replay: 0,
            in_plane: false,
        })
    }
}

impl<const MOST: usize> KdTree<'_, MOST> {
    /// The triangle reference of the nearest hit before `limit`, with `ANY` of some hit there, or
    /// [`crate::math::MISS`]. `best` is what another search of the same ray has found already.
    #[inline]
    pub(crate) fn search<const ANY: bool, C: Count>(
        &self,
        ray: &Ray,
        limit: f32,
        mut best: Best,
        count: &mut C,
    ) -> u32 {
        let Some(mut d) = self.start_descent(ray, limit) else {
            return best.triangle_ref;
        };
        loop {
            let node = self.tree.nodes[d.node as usize];
            if node.is_leaf() {
                count.leaf();
                count.read(self.leaf_index(d.node));
                if self.triangles.test::<ANY, C>(ray, node.first(), node.count(), &mut best, count) {
                    return best.triangle_ref;
                }
                if d.ends_before(best.t) || !d.leave_leaf(count) {
                    return best.triangle_ref;
                }
            } else {
                count.inner();
                count.read(d.node);
                d.descend(ray, node);
            }
        }
    }
}

impl<const MOST: usize> TraverseIndependent for KdTree<'_, MOST> {
    fn traverse<const ANY: bool, C: Count>(&self, ray: &Ray, limit: f32, count: &mut C) -> u32 {
        self.search::<ANY, C>(ray, limit, Best::before(limit), count)
    }
}
