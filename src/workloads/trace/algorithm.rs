//! What is registered: builders, traversals, and the algorithms that `--structure` names, each a pair of both.

use super::cpu::Twin;
use super::method::Group;
use super::options::OptionInfo;
use super::selection::Selection;
use super::simt::Lockstep;
use super::structure::{Structure, StructureKind};
use crate::device::{Features, Interrupted, VulkanDevice};
use crate::error::Result;
use crate::scene::Scene;
use crate::workloads::trace::build::gpu::BuildTimes;
use crate::workloads::trace::common::estimate::Estimate;
use std::hash::{Hash, Hasher};
use std::sync::Arc;

/// A name of `--structure`: a builder and a traversal.
pub struct Algorithm {
    /// Name on the command line and in every table.
    pub name: &'static str,
    /// Another name that it is known by; empty if it has none.
    pub alias: &'static str,
    /// One line for `--help`.
    pub summary: &'static str,
    /// Source paper; empty if none.
    pub paper: &'static str,
    /// What builds the structure.
    pub builder: &'static Builder,
    /// What walks it, which options may decide.
    pub traversal: fn(&Selection) -> &'static Traversal,
    /// What can be set about the traversal.
    pub options: &'static [OptionInfo],
}

/// Builds a structure. Selections with the same builder and equal build options share one built structure.
pub struct Builder {
    /// A name, different from those of other builders.
    pub name: &'static str,
    /// What can be set.
    pub options: &'static [OptionInfo],
    /// False if it uses only one thread.
    pub parallel: bool,
    /// What it builds for a traversal that needs more than others, such as ropes: selections that differ in it share no
    /// structure. Empty for all others.
    pub purpose: fn(&Selection) -> &'static str,
    /// Builds it.
    pub build: fn(&Selection, &Scene) -> Result<Made>,
    /// Estimates its memory before it is built, where that is possible.
    pub estimate: Option<fn(&Selection, &Scene) -> Result<Estimate>>,
    /// Builds the same bytes on a device, where it can.
    pub on_device: Option<OnDevice>,
}

/// Builds a structure on a device; `None` for options with which it is built on the CPU alone.
pub type OnDevice = fn(&Selection, &Scene, &VulkanDevice, Interrupted) -> Result<Option<(Made, BuildTimes)>>;

/// What a builder makes.
pub struct Made {
    /// The structure.
    pub structure: Arc<dyn Structure>,
    /// How it was built where not as selected; empty otherwise.
    pub note: String,
}

impl Made {
    /// A structure that was built as selected.
    pub fn of(structure: impl Structure) -> Made {
        Made { structure: Arc::new(structure), note: String::new() }
    }
}

/// A way through a structure: a kernel, and its twin on the CPU.
pub struct Traversal {
    /// The file below `kernels/` that has the function `traverse`.
    pub kernel: &'static str,
    /// The structures that it walks.
    pub structure: &'static StructureKind,
    /// What the kernel and its twin are specialised by.
    pub parameters: fn(&Selection) -> Parameters,
    /// Slots of the kernel file, and the files that they take.
    pub slots: fn(&Parameters) -> &'static [(&'static str, &'static str)],
    /// True where the rays of a work-group go together, so that its shape decides what is counted.
    pub cooperative: bool,
    /// True if it may read triangles in leaf order ([`super::method::TriangleLayout`]).
    pub leaf_order: bool,
    /// Where primary rays go in packets of a subgroup, in a pass of their own: the pixels of a work-group of that pass.
    pub packets: Option<fn(&Parameters) -> Group>,
    /// What the kernel demands of a device.
    pub needs: Features,
    /// How exactly its hits agree with those of other traversals.
    pub agreement: Agreement,
    /// The same on the CPU, operation for operation; `None` if there is none.
    pub twin: Option<Twin>,
    /// How its lanes wait for each other, as the loops of the kernel are written; `None` where that is not modelled.
    pub lockstep: Option<fn(&Parameters) -> Lockstep>,
}

/// How exactly the hits of a traversal agree with the reference, on devices that compute as their twins do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Agreement {
    /// To the bit, counters included.
    Exact,
    /// This share of the rays may have another hit.
    Share(f64),
    /// Hits agree within the tolerance of devices that round differently, and nothing is counted.
    HitsOnly,
}

/// What a traversal is specialised by: values by the names that they have in its kernel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Parameters([Option<(&'static str, Parameter)>; Parameters::MOST]);

/// The value of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Parameter {
    /// `u32` in the kernel.
    Word(u32),
    /// `bool` in the kernel.
    Flag(bool),
}

impl Traversal {
    /// A traversal without parameters whose rays do not wait for each other, to be completed with a kernel, a structure
    /// and a twin.
    pub const INDEPENDENT: Traversal = Traversal {
        kernel: "",
        structure: &StructureKind::NONE,
        parameters: |_| Parameters::NONE,
        slots: |_| &[],
        cooperative: false,
        leaf_order: false,
        packets: None,
        needs: Features::of(&[]),
        agreement: Agreement::Exact,
        twin: None,
        lockstep: None,
    };

    /// The same for one whose work-groups go together.
    pub const COOPERATIVE: Traversal = Traversal { cooperative: true, ..Traversal::INDEPENDENT };
}

impl Parameters {
    const MOST: usize = 8;

    /// No parameters.
    pub const NONE: Parameters = Parameters([None; Parameters::MOST]);

    /// These parameters, at most eight.
    pub fn of(parameters: &[(&'static str, Parameter)]) -> Parameters {
        let mut all = Parameters::NONE;
        all.0[..parameters.len()].copy_from_slice(&parameters.iter().copied().map(Some).collect::<Vec<_>>());
        all
    }

    /// These and one more, eight at most.
    #[must_use]
    pub fn and(mut self, name: &'static str, value: Parameter) -> Parameters {
        let free = self.0.iter_mut().find(|place| place.is_none()).expect("at most eight parameters");
        *free = Some((name, value));
        self
    }

    /// Names and values, in the order in which they were given.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, Parameter)> {
        self.0.into_iter().flatten()
    }

    /// The value of a parameter of type `u32`.
    pub fn word(&self, name: &str) -> u32 {
        match self.find(name) {
            Parameter::Word(value) => value,
            Parameter::Flag(_) => panic!("{name} is a flag"),
        }
    }

    /// The value of a parameter of type `bool`.
    pub fn flag(&self, name: &str) -> bool {
        match self.find(name) {
            Parameter::Flag(value) => value,
            Parameter::Word(_) => panic!("{name} is a word"),
        }
    }

    fn find(&self, name: &str) -> Parameter {
        let found = self.iter().find(|(known, _)| *known == name);
        found.unwrap_or_else(|| panic!("the traversal has no parameter {name}")).1
    }
}

impl Algorithm {
    /// All options, in the order of tables: the builder's, the traversal's, and those that all have.
    pub fn options(&self) -> impl Iterator<Item = &'static OptionInfo> + use<> {
        self.own_options().chain(super::options::COMMON_OPTIONS)
    }

    /// The options of its builder and its traversal.
    pub fn own_options(&self) -> impl Iterator<Item = &'static OptionInfo> + use<> {
        self.builder.options.iter().chain(self.options)
    }
}

/// Registrations are known by a name that no other one of their type has.
macro_rules! known_by {
    ($($type:ident $name:ident),+) => {$(
        impl PartialEq for $type {
            fn eq(&self, other: &Self) -> bool {
                self.$name == other.$name
            }
        }

        impl Eq for $type {}

        impl Hash for $type {
            fn hash<H: Hasher>(&self, state: &mut H) {
                self.$name.hash(state);
            }
        }

        impl std::fmt::Debug for $type {
            fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str(self.$name)
            }
        }
    )+};
}
known_by!(Algorithm name, Builder name, Traversal kernel);
