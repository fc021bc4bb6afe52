//! The instructions of a kernel by the events that its parts are about.
//!
//! Kernels call functions `count_EVENT` (empty where nothing is counted) where a traversal does something that is
//! counted, `mark_EVENT` where a replay in warps needs to know more, and `begin_ray` where a ray sets out. Such a call
//! marks the smallest block, function or loop around it: instructions belong to the innermost one that has a mark
//! outside of its inner loops; where that has several marks, to the first one of [`EVENT_MARKS`] among them. What is
//! executed once an event is so told from what is executed once a ray.
//!
//! Instructions are those of a scalar machine: an operation on a vector counts once for each component, a read or write
//! of memory once for each 16 bytes; functions count wherever they are called; private variables are registers, unless
//! an index selects an element. Of two branches without a mark the shorter one counts, of others both; a loop without a
//! mark does not count at all. An event that is in several places has their mean. [`of_binary`] and [`of_math`] have
//! what takes several instructions.

use super::count::constant;
use std::collections::{BTreeMap, BTreeSet};
use wgpu::naga::proc::TypeResolution;
use wgpu::naga::valid::{FunctionInfo, ModuleInfo};
use wgpu::naga::{
    AddressSpace, BinaryOperator, Block, Expression, Function, Handle, MathFunction, Module, ScalarKind, Statement,
    TypeInner, VectorSize,
};

/// Names of marks. Where a part has several, it is about the first of them.
pub const EVENT_MARKS: [&str; 11] =
    ["ray", "turn", "box_test", "inner", "leaf", "test", "restart", "rope", "fallback", "vote", "pop"];

/// Instructions of each mark, on average over the places that have it.
pub(super) fn regions(module: &Module, info: &ModuleInfo, entry: usize) -> BTreeMap<&'static str, f64> {
    let mut regions = Regions { module, info, found: Found::new() };
    let main = &module.entry_points[entry].function;
    regions.block(main, info.get_entry_point(entry), &main.body, "ray");
    let mean = |(mark, (instructions, places)): (&'static str, (u64, u64))| {
        (places > 0).then(|| (mark, instructions as f64 / places as f64))
    };
    regions.found.into_iter().filter_map(mean).collect()
}

/// By mark: instructions of all its parts, and places where it is.
type Found = BTreeMap<&'static str, (u64, u64)>;

struct Regions<'m> {
    module: &'m Module,
    info: &'m ModuleInfo,
    found: Found,
}

/// The mark that a call of this function is.
fn mark_of(function: &Function) -> Option<&'static str> {
    let name = function.name.as_deref()?;
    let event = match name {
        "begin_ray" => "ray",
        _ => name.strip_prefix("count_").or(name.strip_prefix("mark_"))?,
    };
    EVENT_MARKS.into_iter().find(|mark| *mark == event)
}

impl<'m> Regions<'m> {
    /// What is found by `walk` alone.
    fn apart(&mut self, walk: impl FnOnce(&mut Self)) -> Found {
        let before = std::mem::take(&mut self.found);
        walk(self);
        std::mem::replace(&mut self.found, before)
    }

    /// Adds both ways if one has a mark, otherwise the shorter one.
    fn join(&mut self, [a, b]: [Found; 2]) {
        let is_marked = |found: &Found| found.values().any(|(_, places)| *places > 0);
        let length = |found: &Found| found.values().map(|(instructions, _)| instructions).sum::<u64>();
        let ways = match is_marked(&a) || is_marked(&b) {
            true => vec![a, b],
            false if length(&b) < length(&a) => vec![b],
            false => vec![a],
        };
        for (mark, (instructions, places)) in ways.into_iter().flatten() {
            let sum = self.found.entry(mark).or_default();
            *sum = (sum.0 + instructions, sum.1 + places);
        }
    }

    fn add(&mut self, owner: &'static str, instructions: u64) {
        self.found.entry(owner).or_default().0 += instructions;
    }

    /// Marks in a block, but not in its loops.
    fn marks(&self, function: &'m Function, block: &'m Block, found: &mut BTreeSet<&'static str>) {
        for statement in block {
            match statement {
                Statement::Call { function, .. } => {
                    let called = &self.module.functions[*function];
                    match mark_of(called) {
                        Some(mark) => _ = found.insert(mark),
                        None => self.marks(called, &called.body, found),
                    }
                }
                Statement::Block(block) => self.marks(function, block, found),
                Statement::If { condition, accept, reject } => match constant(self.module, function, *condition) {
                    Some(taken) => self.marks(function, if taken { accept } else { reject }, found),
                    None => [accept, reject].into_iter().for_each(|block| self.marks(function, block, found)),
                },
                Statement::Switch { cases, .. } => cases.iter().for_each(|c| self.marks(function, &c.body, found)),
                _ => {}
            }
        }
    }

    /// What a part is about: the first mark in it, or what the part around it is about.
    fn owner(&self, function: &'m Function, blocks: &[&'m Block], around: &'static str) -> &'static str {
        let mut found = BTreeSet::new();
        blocks.iter().for_each(|block| self.marks(function, block, &mut found));
        EVENT_MARKS.into_iter().find(|mark| found.contains(mark)).unwrap_or(around)
    }

    fn inner(&mut self, function: &'m Function, info: &'m FunctionInfo, block: &'m Block, around: &'static str) {
        let owner = self.owner(function, &[block], around);
        self.block(function, info, block, owner);
    }

    fn block(&mut self, function: &'m Function, info: &'m FunctionInfo, block: &'m Block, owner: &'static str) {
        for statement in block {
            match statement {
                Statement::Emit(range) => {
                    let sum = range.clone().map(|handle| self.expression(function, info, handle)).sum();
                    self.add(owner, sum);
                }
                Statement::Block(block) => self.inner(function, info, block, owner),
                Statement::If { condition, accept, reject } => match constant(self.module, function, *condition) {
                    Some(taken) => self.inner(function, info, if taken { accept } else { reject }, owner),
                    None => {
                        self.add(owner, 1);
                        let ways = [accept, reject].map(|block| self.apart(|s| s.inner(function, info, block, owner)));
                        self.join(ways);
                    }
                },
                Statement::Switch { cases, .. } => {
                    self.add(owner, 1);
                    cases.iter().for_each(|case| self.inner(function, info, &case.body, owner));
                }
                Statement::Loop { body, continuing, break_if } => {
                    let owner = self.owner(function, &[body, continuing], owner);
                    let found = self.apart(|s| {
                        s.add(owner, 1 + u64::from(break_if.is_some()));
                        [body, continuing].into_iter().for_each(|block| s.block(function, info, block, owner));
                    });
                    self.join([found, Found::new()]);
                }
                Statement::Call { function: called, .. } => {
                    let index = *called;
                    let called = &self.module.functions[index];
                    match mark_of(called) {
                        Some(mark) => self.found.entry(mark).or_default().1 += 1,
                        None => {
                            let info = &self.info[index];
                            self.inner(called, info, &called.body, owner);
                        }
                    }
                }
                Statement::Store { pointer, .. } => {
                    let instructions = self.memory(function, info, *pointer);
                    self.add(owner, instructions);
                }
                Statement::Break | Statement::Continue | Statement::Return { .. } | Statement::Kill => {}
                Statement::WorkGroupUniformLoad { .. } => self.add(owner, 3),
                _ => self.add(owner, 1),
            }
        }
    }

    fn type_of(&self, info: &'m FunctionInfo, handle: Handle<Expression>) -> &TypeInner {
        match &info[handle].ty {
            TypeResolution::Handle(ty) => &self.module.types[*ty].inner,
            TypeResolution::Value(inner) => inner,
        }
    }

    /// Components of a value.
    fn components(&self, info: &'m FunctionInfo, handle: Handle<Expression>) -> u64 {
        match *self.type_of(info, handle) {
            TypeInner::Vector { size, .. } => size as u64,
            TypeInner::Matrix { columns, rows, .. } => columns as u64 * rows as u64,
            _ => 1,
        }
    }

    /// Instructions that read or write what a pointer leads to.
    fn memory(&self, function: &'m Function, info: &'m FunctionInfo, pointer: Handle<Expression>) -> u64 {
        let (space, bytes) = match *self.type_of(info, pointer) {
            TypeInner::Pointer { base, space } => (space, self.module.types[base].inner.size(self.module.to_ctx())),
            TypeInner::ValuePointer { size, scalar, space } => {
                let components = size.map_or(1, |size: VectorSize| size as u32);
                (space, components * u32::from(scalar.width))
            }
            _ => (AddressSpace::Function, 4),
        };
        match space {
            AddressSpace::Function | AddressSpace::Private => u64::from(is_indexed(function, pointer)),
            _ => u64::from(bytes.div_ceil(16).max(1)),
        }
    }

    fn expression(&self, function: &'m Function, info: &'m FunctionInfo, handle: Handle<Expression>) -> u64 {
        match &function.expressions[handle] {
            Expression::Binary { op, left, .. } => {
                let is_float = self.type_of(info, *left).scalar_kind() == Some(ScalarKind::Float);
                of_binary(*op, is_float) * self.components(info, handle)
            }
            Expression::Math { fun, arg, .. } => of_math(*fun) * self.components(info, *arg),
            Expression::Relational { argument, .. } => self.components(info, *argument),
            Expression::Unary { .. }
            | Expression::Select { .. }
            | Expression::Derivative { .. }
            | Expression::As { convert: Some(_), .. } => self.components(info, handle),
            Expression::Load { pointer } => self.memory(function, info, *pointer),
            Expression::ImageLoad { .. } | Expression::ImageSample { .. } => 1,
            // Bits that are read as another type, and what selects or assembles registers
            _ => 0,
        }
    }
}

/// True if an index that is not known selects what a pointer leads to.
fn is_indexed(function: &Function, mut pointer: Handle<Expression>) -> bool {
    loop {
        match function.expressions[pointer] {
            Expression::Access { .. } => return true,
            Expression::AccessIndex { base, .. } => pointer = base,
            _ => return false,
        }
    }
}

/// Instructions of an operator, for each component: a division of floats is a reciprocal (which takes as long as four
/// others) and a product.
fn of_binary(operator: BinaryOperator, is_float: bool) -> u64 {
    match operator {
        BinaryOperator::Divide | BinaryOperator::Modulo if is_float => 5,
        _ => 1,
    }
}

/// Instructions of a function, for each component of its argument: roots, logarithms and powers of two take as long as
/// four others.
fn of_math(function: MathFunction) -> u64 {
    match function {
        MathFunction::Sqrt | MathFunction::InverseSqrt | MathFunction::Exp2 | MathFunction::Log2 => 4,
        MathFunction::Exp | MathFunction::Log | MathFunction::Sin | MathFunction::Cos => 5,
        MathFunction::Pow => 9,
        MathFunction::Clamp => 2,
        _ => 1,
    }
}
