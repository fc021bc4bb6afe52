//! Counts the instructions of an entry point in naga's intermediate representation.

use super::KernelCost;
use std::collections::HashSet;
use wgpu::naga::proc::TypeResolution;
use wgpu::naga::valid::{FunctionInfo, ModuleInfo};
use wgpu::naga::{
    AddressSpace, Block, Expression, Function, GlobalVariable, Handle, Literal, LocalVariable, Module,
    RayQueryFunction, Statement, Type, TypeInner,
};

/// Counts the entry point of this index in a valid module.
pub(super) fn count(module: &Module, info: &ModuleInfo, entry: usize) -> KernelCost {
    let mut counting = Counting { module, cost: KernelCost::default(), functions: Vec::new(), globals: HashSet::new() };
    counting.function(&module.entry_points[entry].function, info.get_entry_point(entry));
    let mut done = 0;
    while let Some(&function) = counting.functions.get(done) {
        counting.function(&module.functions[function], &info[function]);
        done += 1;
    }
    counting.globals();
    counting.cost
}

struct Counting<'m> {
    module: &'m Module,
    cost: KernelCost,
    /// Functions that are called, each once.
    functions: Vec<Handle<Function>>,
    /// Global variables that are read, written or passed on.
    globals: HashSet<Handle<GlobalVariable>>,
}

/// The function that is being counted.
struct Body<'m> {
    function: &'m Function,
    info: &'m FunctionInfo,
    /// Its variables that are read, written or passed on.
    locals: HashSet<Handle<LocalVariable>>,
}

/// Where a pointer leads to.
enum Memory {
    /// Variables of a function or an invocation.
    Private,
    /// Everything that invocations share.
    Shared,
    /// Shared, of an atomic type.
    Atomic,
}

impl<'m> Counting<'m> {
    fn function(&mut self, function: &'m Function, info: &'m FunctionInfo) {
        let mut body = Body { function, info, locals: HashSet::new() };
        self.block(&mut body, &function.body);
        let sizes = body.locals.iter().map(|&local| self.size(function.local_variables[local].ty));
        self.cost.private_bytes += sizes.sum::<u64>();
    }

    /// Adds the sizes of global variables, and the number of bindings.
    fn globals(&mut self) {
        for &global in &self.globals {
            let variable = &self.module.global_variables[global];
            let size = self.size(variable.ty);
            match variable.space {
                AddressSpace::WorkGroup => self.cost.workgroup_bytes += size,
                AddressSpace::Private => self.cost.private_bytes += size,
                _ => self.cost.bindings += u64::from(variable.binding.is_some()),
            }
        }
    }

    fn size(&self, ty: Handle<Type>) -> u64 {
        self.module.types[ty].inner.size(self.module.to_ctx()).into()
    }

    fn block(&mut self, body: &mut Body<'m>, block: &'m Block) {
        for statement in block {
            self.statement(body, statement);
        }
    }

    fn statement(&mut self, body: &mut Body<'m>, statement: &'m Statement) {
        match statement {
            Statement::Emit(range) => range.clone().for_each(|handle| self.expression(body, handle)),
            Statement::Block(block) => self.block(body, block),
            Statement::If { condition, accept, reject } => match constant(self.module, body.function, *condition) {
                Some(taken) => self.block(body, if taken { accept } else { reject }),
                None => {
                    self.cost.branch += 1;
                    self.block(body, accept);
                    self.block(body, reject);
                }
            },
            Statement::Switch { selector: _, cases } => {
                self.cost.branch += 1;
                cases.iter().for_each(|case| self.block(body, &case.body));
            }
            Statement::Loop { body: inner, continuing, break_if } => {
                self.cost.branch += 1 + u64::from(break_if.is_some());
                self.block(body, inner);
                self.block(body, continuing);
            }
            Statement::Break | Statement::Continue | Statement::Return { .. } | Statement::Kill => {}
            Statement::ControlBarrier(_) | Statement::MemoryBarrier(_) => self.cost.barrier += 1,
            Statement::Store { pointer, value: _ } => {
                self.touch(body, *pointer);
                match self.memory(body, *pointer) {
                    Memory::Private => self.cost.private_store += 1,
                    Memory::Shared => self.cost.store += 1,
                    Memory::Atomic => self.cost.atomic += 1,
                }
            }
            Statement::ImageStore { image, .. } => {
                self.touch(body, *image);
                self.cost.store += 1;
            }
            Statement::Atomic { pointer, .. } => {
                self.touch(body, *pointer);
                self.cost.atomic += 1;
            }
            Statement::ImageAtomic { image, .. } => {
                self.touch(body, *image);
                self.cost.atomic += 1;
            }
            Statement::WorkGroupUniformLoad { pointer, result: _ } => {
                self.touch(body, *pointer);
                self.cost.load += 1;
                self.cost.barrier += 2;
            }
            Statement::Call { function, arguments, result: _ } => {
                // Pointers and textures may be passed on
                arguments.iter().for_each(|&argument| self.touch(body, argument));
                self.cost.call += 1;
                if !self.functions.contains(function) {
                    self.functions.push(*function);
                }
            }
            Statement::RayQuery { query, fun } => {
                self.touch(body, *query);
                if let RayQueryFunction::Initialize { acceleration_structure, descriptor: _ } = fun {
                    self.touch(body, *acceleration_structure);
                }
                self.cost.ray_query += 1;
            }
            Statement::SubgroupBallot { .. }
            | Statement::SubgroupGather { .. }
            | Statement::SubgroupCollectiveOperation { .. } => self.cost.subgroup += 1,
            // No kernel of a compute pipeline has these, or wgpu does not compile them here
            Statement::RayPipelineFunction(_) | Statement::CooperativeStore { .. } => self.cost.other += 1,
        }
    }

    /// Counts an expression that is computed where it is emitted.
    fn expression(&mut self, body: &mut Body<'m>, handle: Handle<Expression>) {
        match &body.function.expressions[handle] {
            Expression::Unary { .. }
            | Expression::Binary { .. }
            | Expression::Select { .. }
            | Expression::Relational { .. }
            | Expression::Derivative { .. }
            | Expression::Math { .. }
            | Expression::As { .. } => self.cost.arithmetic += 1,
            Expression::Load { pointer } => {
                self.touch(body, *pointer);
                match self.memory(body, *pointer) {
                    Memory::Private => self.cost.private_load += 1,
                    Memory::Shared => self.cost.load += 1,
                    Memory::Atomic => self.cost.atomic += 1,
                }
            }
            Expression::ImageLoad { image, .. } | Expression::ImageSample { image, .. } => {
                self.touch(body, *image);
                self.cost.load += 1;
            }
            Expression::ArrayLength(array) | Expression::ImageQuery { image: array, .. } => {
                self.touch(body, *array);
                self.cost.other += 1;
            }
            Expression::RayQueryGetIntersection { query, .. } | Expression::RayQueryVertexPositions { query, .. } => {
                self.touch(body, *query);
                self.cost.ray_query += 1;
            }
            Expression::Compose { .. }
            | Expression::Access { .. }
            | Expression::AccessIndex { .. }
            | Expression::Splat { .. }
            | Expression::Swizzle { .. }
            | Expression::CooperativeLoad { .. }
            | Expression::CooperativeMultiplyAdd { .. } => self.cost.other += 1,
            // These are never emitted: they are there from the beginning, or belong to a statement that was counted
            Expression::Literal(_)
            | Expression::Constant(_)
            | Expression::Override(_)
            | Expression::ZeroValue(_)
            | Expression::FunctionArgument(_)
            | Expression::GlobalVariable(_)
            | Expression::LocalVariable(_)
            | Expression::CallResult(_)
            | Expression::AtomicResult { .. }
            | Expression::WorkGroupUniformLoadResult { .. }
            | Expression::RayQueryProceedResult
            | Expression::SubgroupBallotResult
            | Expression::SubgroupOperationResult { .. } => {}
        }
    }

    /// Notes the variable that a pointer or a texture is of, or a part of.
    fn touch(&mut self, body: &mut Body, mut handle: Handle<Expression>) {
        loop {
            match body.function.expressions[handle] {
                Expression::Access { base, .. } | Expression::AccessIndex { base, .. } => handle = base,
                Expression::GlobalVariable(global) => {
                    self.globals.insert(global);
                    return;
                }
                Expression::LocalVariable(local) => {
                    body.locals.insert(local);
                    return;
                }
                _ => return,
            }
        }
    }

    fn memory(&self, body: &Body, pointer: Handle<Expression>) -> Memory {
        let inner = match &body.info[pointer].ty {
            TypeResolution::Handle(ty) => &self.module.types[*ty].inner,
            TypeResolution::Value(inner) => inner,
        };
        match *inner {
            TypeInner::Pointer { space: AddressSpace::Function | AddressSpace::Private, .. }
            | TypeInner::ValuePointer { space: AddressSpace::Function | AddressSpace::Private, .. } => Memory::Private,
            TypeInner::Pointer { base, .. } if matches!(self.module.types[base].inner, TypeInner::Atomic(_)) => {
                Memory::Atomic
            }
            _ => Memory::Shared,
        }
    }
}

/// The value of a condition that is a constant.
pub(super) fn constant(module: &Module, function: &Function, condition: Handle<Expression>) -> Option<bool> {
    let expression = match function.expressions[condition] {
        Expression::Constant(constant) => &module.global_expressions[module.constants[constant].init],
        ref expression => expression,
    };
    match expression {
        Expression::Literal(Literal::Bool(value)) => Some(*value),
        _ => None,
    }
}
