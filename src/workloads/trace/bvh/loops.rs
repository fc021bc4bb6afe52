//! Other forms of the loops of `bvh-stack`. Twin of `kernels/trace/bvh/if_if.wgsl` and `speculative.wgsl`.
//!
//! If-if visits and tests what while-while does, in the same order: it differs in what rays of one instruction stream
//! wait for. Persistent threads ([`crate::workloads::trace::method::Threads`]) run the loops of while-while.

use crate::error::Result;
use crate::math::Ray;
use crate::workloads::trace::algorithm::{Parameter, Parameters};
use crate::workloads::trace::backend::Prepared;
use crate::workloads::trace::bvh::Bvh;
use crate::workloads::trace::bvh::BvhNode;
use crate::workloads::trace::bvh::stack::{Down, EMPTY, InPairs, LEAF, Stack, StackSearch, leaf_triangle_refs};
use crate::workloads::trace::count::Count;
use crate::workloads::trace::cpu::TwinInput;
use crate::workloads::trace::options::{Axis, Kind, OptionInfo};
use crate::workloads::trace::selection::Selection;
use crate::workloads::trace::simt::{
    Event::{Child, Leaf, Pop, Step, Test, Turn},
    Lockstep, Mark,
    Part::One,
    Read, maybe, repeat,
};
use crate::workloads::trace::traverse::{Best, TraverseIndependent};

/// Which loops a ray runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Down to a leaf, then through its triangles.
    WhileWhile,
    /// A step or a triangle at a time.
    IfIf,
    /// Down to a second leaf, then through the triangles of both.
    Speculative,
}

/// The form of the loops.
pub const LOOP: OptionInfo = OptionInfo::new(
    Axis::Traversal,
    "loop",
    "while-while",
    "form of the loops (Aila and Laine 2009): persistent threads run while-while, speculative postpones a leaf",
    Kind::Word(&["while-while", "if-if", "persistent", "speculative"]),
);

/// The constant of the kernel.
const NAME: &str = "LOOP";

impl Form {
    /// Of a selection.
    pub(super) fn of(s: &Selection) -> Form {
        match s.value("loop") {
            "if-if" => Form::IfIf,
            "speculative" => Form::Speculative,
            _ => Form::WhileWhile,
        }
    }

    fn from(parameters: &Parameters) -> Form {
        let forms = [Form::WhileWhile, Form::IfIf, Form::Speculative];
        forms[parameters.word(NAME) as usize]
    }
}

/// The parameters with a form of the loops.
pub(super) fn with_form(parameters: Parameters, form: Form) -> Parameters {
    parameters.and(NAME, Parameter::Word(form as u32))
}

/// The kernel's file with the loops.
pub(super) fn slots(parameters: &Parameters) -> &'static [(&'static str, &'static str)] {
    match Form::from(parameters) {
        Form::WhileWhile => &[("loop", "trace/bvh/while_while.wgsl")],
        Form::IfIf => &[("loop", "trace/bvh/if_if.wgsl")],
        Form::Speculative => &[("loop", "trace/bvh/speculative.wgsl")],
    }
}

/// How lanes wait for each other in while-while, also where threads are persistent. Nodes of several children have a
/// loop over these.
pub(in crate::workloads::trace) const WHILE_WHILE: Lockstep = Lockstep::apart(&[repeat(&[
    repeat(&[One(Step), repeat(&[One(Child)]), repeat(&[One(Pop)])]),
    maybe(&[One(Leaf), repeat(&[One(Test)]), repeat(&[One(Pop)])]),
])]);

const IF_IF: Lockstep = Lockstep::apart(&[
    maybe(&[One(Leaf)]),
    repeat(&[
        maybe(&[One(Step), repeat(&[One(Pop)]), maybe(&[One(Leaf)])]),
        maybe(&[One(Test), repeat(&[One(Pop)]), maybe(&[One(Leaf)])]),
    ]),
]);

const SPECULATIVE: Lockstep = Lockstep::apart(&[repeat(&[
    repeat(&[One(Step), repeat(&[One(Pop)])]),
    maybe(&[One(Turn), repeat(&[One(Pop)]), repeat(&[One(Step), repeat(&[One(Pop)])])]),
    maybe(&[One(Leaf), repeat(&[One(Test)])]),
    maybe(&[One(Leaf), repeat(&[One(Test)])]),
    repeat(&[One(Pop)]),
])]);

/// Both children of a node.
const PAIRS: &[Read] = &[Read::pair::<BvhNode>(Step)];

/// How lanes wait for each other.
pub(super) fn lockstep(parameters: &Parameters) -> Lockstep {
    let loops = match Form::from(parameters) {
        Form::WhileWhile => WHILE_WHILE,
        Form::IfIf => IF_IF,
        Form::Speculative => SPECULATIVE,
    };
    loops.reading(PAIRS)
}

/// The twin with the loops of the method.
pub(super) fn twin(input: TwinInput) -> Result<Box<dyn Prepared + '_>> {
    let bvh: &Bvh = input.structure()?;
    let search = StackSearch::new(&input, InPairs(bvh));
    Ok(match Form::from(&input.method.parameters) {
        Form::WhileWhile => input.with(search),
        Form::IfIf => input.with(IfIf(search)),
        Form::Speculative => input.with(Speculative(search)),
    })
}

/// A step or a triangle at a time.
struct IfIf<'a>(StackSearch<'a, InPairs<'a, Bvh>>);

/// Two leaves at a time.
struct Speculative<'a>(StackSearch<'a, InPairs<'a, Bvh>>);

/// Triangle references of the leaf at a reference: the first one, and the end; none elsewhere.
#[inline(always)]
fn rest_of<C: Count>(reference: u32, count: &mut C) -> (u32, u32) {
    if reference & LEAF == 0 || reference == EMPTY {
        return (0, 0);
    }
    count.leaf();
    let (first, triangle_refs) = leaf_triangle_refs(reference);
    (first, first + triangle_refs)
}

impl TraverseIndependent for IfIf<'_> {
    fn traverse<const ANY: bool, C: Count>(&self, ray: &Ray, limit: f32, count: &mut C) -> u32 {
        let IfIf(search) = self;
        let mut best = Best::before(limit);
        let mut stack = Stack::new();
        let wide = search.widening.widened(ray);
        let mut reference = search.start(&wide, limit);
        let (mut next, mut end) = rest_of(reference, count);
        while reference != EMPTY {
            if reference & LEAF == 0 {
                let t = search.reach(&best, limit);
                reference = search.down.step_down(&wide, t, reference, &mut stack, count);
                (next, end) = rest_of(reference, count);
            }
            if next < end {
                if search.triangles.test::<ANY, C>(ray, next, 1, &mut best, count) {
                    return best.triangle_ref;
                }
                next += 1;
                if next == end {
                    reference = stack.pop(search.reach(&best, limit), count);
                    (next, end) = rest_of(reference, count);
                }
            }
        }
        best.triangle_ref
    }
}

impl TraverseIndependent for Speculative<'_> {
    fn traverse<const ANY: bool, C: Count>(&self, ray: &Ray, limit: f32, count: &mut C) -> u32 {
        let Speculative(search) = self;
        let mut best = Best::before(limit);
        let mut stack = Stack::new();
        let wide = search.widening.widened(ray);
        let mut reference = search.start(&wide, limit);
        loop {
            let t = search.reach(&best, limit);
            let postponed = search.down.walk_to_leaf(&wide, t, reference, &mut stack, count);
            if postponed == EMPTY {
                return best.triangle_ref;
            }
            count.mark(Mark::Turn);
            reference = stack.pop(t, count);
            reference = search.down.walk_to_leaf(&wide, t, reference, &mut stack, count);
            for leaf in [postponed, reference].into_iter().filter(|&leaf| leaf != EMPTY) {
                count.leaf();
                let (first, triangle_refs) = leaf_triangle_refs(leaf);
                if search.triangles.test::<ANY, C>(ray, first, triangle_refs, &mut best, count) {
                    return best.triangle_ref;
                }
            }
            if reference != EMPTY {
                reference = stack.pop(search.reach(&best, limit), count);
            }
        }
    }
}
