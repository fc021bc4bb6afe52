//! The static cost of a kernel: what its text consists of after naga, counted without a device.
//!
//! A kernel is parsed and validated by the naga that wgpu compiles it with, and the instructions of its entry point
//! `main` and of all functions that it reaches are counted. The rules:
//!
//! - Each instruction counts once as it is in the text: loops are not multiplied, both branches of an `if` count, and a
//!   function counts once, however often it is called. An operation on a vector or a matrix counts once.
//! - An `if` whose condition is a constant counts only the branch that is taken, and not itself. Functions, variables
//!   and bindings that only the other branch uses do not count either.
//! - Literals, constants, arguments, and results of calls are no instructions. What naga evaluates while it parses is a
//!   literal.
//!
//! What belongs to which class is in the documentation of [`KernelCost`]'s fields. The counts tell what changed in a
//! kernel; they are no estimate of its time, and the instructions of a GPU after its driver are others.

mod count;
mod regions;

pub use regions::EVENT_MARKS;

use super::super::kernel::Source;
use crate::error::{Error, Result};
use std::collections::BTreeMap;
use wgpu::naga;
use wgpu::naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};

/// Counts of instructions by class, and sizes. The rules are those of the module `device::vulkan::cost`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct KernelCost {
    /// Unary and binary operators, conversions, `select`, `any`, `all`, and built-in functions of mathematics, bits and
    /// packing.
    pub arithmetic: u64,
    /// Reads of buffers, uniforms, textures and work-group memory. A read of a whole struct or vector counts once.
    pub load: u64,
    /// Writes to buffers, textures and work-group memory.
    pub store: u64,
    /// Reads of variables of a function or an invocation. Drivers keep most of these in registers.
    pub private_load: u64,
    /// Writes to variables of a function or an invocation. An initial value is a write, unless it is a constant outside
    /// of all loops.
    pub private_store: u64,
    /// Atomic operations, loads and stores included.
    pub atomic: u64,
    /// `if`, `switch`, `loop` (with `for` and `while`) and `break if`, one each; `&&` and `||` whose right side has to
    /// be guarded are an `if`. Jumps (`break`, `continue`, `return`) belong to these.
    pub branch: u64,
    /// Calls of functions of the kernel.
    pub call: u64,
    /// Barriers; `workgroupUniformLoad` is two barriers and a load.
    pub barrier: u64,
    /// Operations of a subgroup.
    pub subgroup: u64,
    /// Operations of ray queries.
    pub ray_query: u64,
    /// What only selects or assembles values and addresses: member and element access, swizzles, constructors, and
    /// sizes of arrays and textures.
    pub other: u64,
    /// Bytes of work-group memory.
    pub workgroup_bytes: u64,
    /// Bytes of all variables of functions and invocations, as if none of them shared memory.
    pub private_bytes: u64,
    /// Buffers and textures that are read or written.
    pub bindings: u64,
}

impl KernelCost {
    /// Name and value of each quantity, in the order of tables.
    pub fn quantities(&self) -> [(&'static str, u64); 15] {
        [
            ("arithmetic", self.arithmetic),
            ("load", self.load),
            ("store", self.store),
            ("private_load", self.private_load),
            ("private_store", self.private_store),
            ("atomic", self.atomic),
            ("branch", self.branch),
            ("call", self.call),
            ("barrier", self.barrier),
            ("subgroup", self.subgroup),
            ("ray_query", self.ray_query),
            ("other", self.other),
            ("workgroup_bytes", self.workgroup_bytes),
            ("private_bytes", self.private_bytes),
            ("bindings", self.bindings),
        ]
    }
}

impl Source {
    /// The static cost of the kernel's entry point `main`.
    ///
    /// # Errors
    /// [`Error::Device`] with file and line for text that is not valid WGSL or has no such entry point (a mistake in
    /// `kernels/`).
    pub fn cost(&self) -> Result<KernelCost> {
        let (module, info, main) = self.parse()?;
        Ok(count::count(&module, &info, main))
    }

    /// Instructions of the entry point `main` by the events that its parts are about: `ray` once a ray, the others once
    /// an event. The rules are those of the module `device::vulkan::cost::regions`.
    ///
    /// # Errors
    /// As [`Source::cost`].
    pub fn event_costs(&self) -> Result<BTreeMap<&'static str, f64>> {
        let (module, info, main) = self.parse()?;
        Ok(regions::regions(&module, &info, main))
    }

    fn parse(&self) -> Result<(naga::Module, ModuleInfo, usize)> {
        let wrong = |location: Option<naga::SourceLocation>, problem: &dyn std::fmt::Display| {
            let place = location.map_or("the kernel".to_owned(), |location| self.locate(location.line_number as usize));
            Error::Device(format!("{place}: {problem}"))
        };
        let module = naga::front::wgsl::parse_str(&self.text)
            .map_err(|error| wrong(error.location(&self.text), &error.message()))?;
        let info = Validator::new(ValidationFlags::all(), Capabilities::all())
            .validate(&module)
            .map_err(|error| wrong(error.location(&self.text), &with_causes(error.as_inner())))?;
        let main = module.entry_points.iter().position(|entry| entry.name == "main");
        let main = main.ok_or_else(|| wrong(None, &"there is no entry point main"))?;
        Ok((module, info, main))
    }
}

/// An error's message with those of its causes.
fn with_causes(error: &dyn std::error::Error) -> String {
    let causes = std::iter::successors(error.source(), |cause| cause.source());
    causes.fold(error.to_string(), |text, cause| format!("{text}: {cause}"))
}
