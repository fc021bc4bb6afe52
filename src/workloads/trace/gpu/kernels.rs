//! Kernel variants: an entry file, a traversal, a set of constants, and the bindings that go with them.

use crate::device::vulkan::{Binding, BindingKind, ReadBuffer, TEXTURE_WIDTH, Texel};
use crate::device::{Constants, Feature, KernelFile, Source, assemble};
use crate::error::{Error, Result};
use crate::math;
use crate::workloads::trace::backend::{AMBIENT_RAYS, Config};
use crate::workloads::trace::intersect::{TriangleTest, moller_trumbore};
use crate::workloads::trace::method::{Pattern, ShadowRays, Threads};
use crate::workloads::trace::{Axis, COMMON_OPTIONS, Method, OptionInfo, Parameter, Selection, algorithms, count};
use std::sync::LazyLock;

pub use crate::workloads::kernel_files::FILES;

const COUNT_ON: &str = "generated/count_on.wgsl";
const COUNT_OFF: &str = "generated/count_off.wgsl";

/// The binding of the driver's structure.
pub(super) const DRIVER_TREE: u32 = 14;

/// The binding of the number of groups of pixels that persistent threads have taken.
pub(super) const TAKEN: u32 = 15;

/// Every file that a kernel can include: those of `kernels/`, and generated ones.
pub fn files() -> &'static [KernelFile] {
    static ALL: LazyLock<Vec<KernelFile>> = LazyLock::new(|| {
        let generated = |counting| -> &'static str { count::wgsl(counting).leak() };
        let generated = [(COUNT_ON, generated(true)), (COUNT_OFF, generated(false))];
        FILES.iter().copied().chain(generated).collect()
    });
    &ALL
}

/// Which entry file, and how it is specialised.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Entry {
    /// `trace/render.wgsl`, or `trace/persistent.wgsl`.
    Render {
        /// Ray configuration.
        config: Config,
        /// With counters, or timed.
        counting: bool,
    },
    /// A pass of a staged frame: `trace/staged/primary.wgsl`, `trace/staged/bounce.wgsl`.
    Staged {
        /// Ray configuration.
        config: Config,
        /// With counters, or timed.
        counting: bool,
        /// Which pass.
        pass: StagedPass,
    },
    /// A pass of a frame of packets: `trace/subgroup/hits.wgsl`, `trace/subgroup/shade.wgsl`.
    Packets {
        /// Ray configuration.
        config: Config,
        /// With counters, or timed.
        counting: bool,
        /// Which pass.
        pass: PacketPass,
    },
    /// `trace/given.wgsl`.
    Trace {
        /// Any hit instead of the nearest one.
        any_hit: bool,
    },
}

/// A pass of a staged frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum StagedPass {
    /// All primary rays; makes the first list.
    Primary,
    /// Reflected rays for a list; makes the next one.
    Bounce,
    /// Reflected rays for the last list.
    LastBounce,
}

/// A pass of a frame of packets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PacketPass {
    /// Nearest hits of primary rays.
    Hits,
    /// Surfaces, light and secondary rays.
    Shade,
}

impl StagedPass {
    /// The passes of a frame, in their order.
    pub fn all(config: Config) -> Vec<StagedPass> {
        let bounce = |bounce| if bounce == config.bounces() { StagedPass::LastBounce } else { StagedPass::Bounce };
        std::iter::once(StagedPass::Primary).chain((1..=config.bounces()).map(bounce)).collect()
    }
}

/// One kernel variant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Kernel {
    /// Entry file and its constants.
    pub entry: Entry,
    /// The traversal's file, and constants.
    pub method: Method,
    /// Entries of a full stack, see [`stack_size`].
    pub stack_size: u32,
    /// Threads of a driver that computes on the CPU, where cheaper operations give the same results; 0 for a GPU.
    pub software_threads: u32,
    /// Scene and structure are in textures instead of storage buffers.
    pub textures: bool,
    /// Corners of triangles are read in leaf order.
    pub leaf_order: bool,
}

impl Entry {
    /// A name for labels and messages.
    fn label(self) -> String {
        match self {
            Entry::Render { config, counting } => format!("{config:?}{}", if counting { " counting" } else { "" }),
            Entry::Staged { config, counting, pass } => {
                format!("{config:?} {pass:?}{}", if counting { " counting" } else { "" })
            }
            Entry::Packets { config, counting, pass } => {
                format!("{config:?} {pass:?}{}", if counting { " counting" } else { "" })
            }
            Entry::Trace { any_hit } => format!("trace{}", if any_hit { " any hit" } else { "" }),
        }
    }
}

/// What follows from primary hits.
fn secondary(config: Config) -> &'static str {
    match config {
        Config::P | Config::PS | Config::PSR => "trace/secondary/mirrored.wgsl",
        Config::AO => "trace/secondary/ambient.wgsl",
        Config::DIFFUSE => "trace/secondary/diffuse.wgsl",
    }
}

/// Stack entries for a tree of `depth` levels and the EMPTY at the bottom: a multiple of 32, so that few different
/// kernels are compiled.
pub fn stack_size(depth: u32) -> u32 {
    (depth + 2).next_multiple_of(32)
}

impl Kernel {
    /// A name for labels and messages.
    pub fn label(&self) -> String {
        let traversal = self.method.traversal.kernel.trim_start_matches("trace/").trim_end_matches(".wgsl");
        format!("{traversal} {}", self.entry.label())
    }

    /// The WGSL of this variant.
    ///
    /// # Errors
    /// A message with file and line for an include that does not exist (a mistake in `kernels/`).
    pub fn assemble(&self) -> Result<Source, String> {
        let (entry, counting) = match self.entry {
            Entry::Render { counting, .. } => match self.method.threads {
                Threads::PerPixel => ("trace/render.wgsl", counting),
                Threads::Persistent => ("trace/persistent.wgsl", counting),
            },
            Entry::Staged { counting, pass: StagedPass::Primary, .. } => ("trace/staged/primary.wgsl", counting),
            Entry::Staged { counting, .. } => ("trace/staged/bounce.wgsl", counting),
            Entry::Packets { counting, pass: PacketPass::Hits, .. } => ("trace/subgroup/hits.wgsl", counting),
            Entry::Packets { counting, pass: PacketPass::Shade, .. } => ("trace/subgroup/shade.wgsl", counting),
            Entry::Trace { .. } => ("trace/given.wgsl", false),
        };
        let intersect = match self.method.intersect {
            TriangleTest::Watertight => "trace/intersect/watertight.wgsl",
            TriangleTest::MollerTrumbore => "trace/intersect/moller_trumbore.wgsl",
        };
        let mut slots = vec![
            ("intersect", intersect),
            ("memory", if self.textures { "trace/textures.wgsl" } else { "trace/buffers.wgsl" }),
            (
                "triangles",
                if self.leaf_order { "trace/triangles_leaf_order.wgsl" } else { "trace/triangles_indexed.wgsl" },
            ),
            ("traversal", self.method.traversal.kernel),
            ("counting", if counting { COUNT_ON } else { COUNT_OFF }),
            ("store", if counting { "trace/store_counted.wgsl" } else { "trace/store_timed.wgsl" }),
        ];
        if let Entry::Render { config, .. } | Entry::Packets { config, .. } = self.entry {
            slots.push(("secondary", secondary(config)));
        }
        if let Entry::Staged { pass, .. } = self.entry {
            let is_last = pass == StagedPass::LastBounce;
            slots.push(("append", if is_last { "trace/staged/end.wgsl" } else { "trace/staged/append.wgsl" }));
        }
        let chosen = |counted, timed| if counting { counted } else { timed };
        let packet_test = match self.method.intersect {
            TriangleTest::Watertight => "trace/subgroup/watertight.wgsl",
            TriangleTest::MollerTrumbore => "trace/subgroup/moller_trumbore.wgsl",
        };
        slots.extend([
            ("update", chosen("trace/staged/update_counted.wgsl", "trace/staged/update_timed.wgsl")),
            ("count_rows", chosen("trace/subgroup/count_on.wgsl", "trace/subgroup/count_off.wgsl")),
            ("packet_test", packet_test),
        ]);
        slots.extend((self.method.traversal.slots)(&self.method.parameters));
        assemble(files(), entry, &slots, self.constants())
    }

    /// The bindings of the entry file; those that a traversal does not use are bound as well.
    pub(super) fn layout(&self) -> Vec<Binding> {
        let input = |texel| ReadBuffer::kind(self.textures, texel);
        let render = !matches!(self.entry, Entry::Trace { .. });
        let mut layout = vec![
            Binding::new(0, if render { BindingKind::MovingUniform } else { BindingKind::Uniform }),
            Binding::new(1, input(Texel::Bytes16)),
            Binding::new(2, input(Texel::Bytes16)),
            Binding::new(3, if render { input(Texel::Bytes16) } else { BindingKind::Read }),
            Binding::new(6, input(self.method.traversal.structure.node_texel)),
            Binding::new(7, BindingKind::Uniform),
            Binding::new(8, BindingKind::ReadWrite),
        ];
        if self.method.traversal.needs.has(Feature::RayQuery) {
            layout.push(Binding::new(DRIVER_TREE, BindingKind::AccelerationStructure));
        }
        if render {
            layout.extend([4, 5].map(|number| Binding::new(number, input(Texel::Bytes16))));
        }
        if self.leaf_order {
            layout.push(Binding::new(13, input(Texel::Bytes16)));
        }
        if matches!(self.entry, Entry::Render { .. }) && self.method.threads == Threads::Persistent {
            layout.push(Binding::new(TAKEN, BindingKind::ReadWrite));
        }
        if let Entry::Staged { pass, .. } = self.entry {
            if pass != StagedPass::LastBounce {
                layout.extend([9, 10].map(|number| Binding::new(number, BindingKind::ReadWrite)));
            }
            if pass != StagedPass::Primary {
                layout.extend([11, 12].map(|number| Binding::new(number, BindingKind::Read)));
            }
        }
        layout
    }

    fn constants(&self) -> Constants {
        let mut constants = Constants::default();
        constants.float("T_MAX", math::T_MAX);
        constants.float("INVERSE_OF_ZERO", math::INVERSE_OF_ZERO);
        constants.float("PLANE_SHIFT", math::PLANE_SHIFT);
        constants.float("PLANE_SHIFT_MIN", math::PLANE_SHIFT_MIN);
        constants.float("SLACK", math::SLACK);
        constants.float("DETERMINANT_MIN", moller_trumbore::DETERMINANT_MIN);
        constants.unsigned("MISS", math::MISS);
        constants.unsigned("STACK_SIZE", self.stack_size);
        constants.unsigned("GROUP_WIDTH", self.method.group.width);
        constants.unsigned("GROUP_HEIGHT", self.method.group.height);
        constants.unsigned("GROUP_SIZE", self.method.group.size());
        constants.unsigned("TEXTURE_WIDTH", TEXTURE_WIDTH);
        constants.machine("THREADS", self.software_threads.max(1));
        constants.flag("SOFTWARE", self.software_threads > 0);
        for (name, value) in self.method.parameters.iter() {
            match value {
                Parameter::Word(value) => constants.unsigned(name, value),
                Parameter::Flag(value) => constants.flag(name, value),
            }
        }
        match self.entry {
            Entry::Render { config, .. } | Entry::Staged { config, .. } | Entry::Packets { config, .. } => {
                if config == Config::AO {
                    constants.unsigned("AMBIENT_RAYS", AMBIENT_RAYS);
                }
                constants.flag("SHADOWS", config.shadows());
                constants.flag("TO_LIGHT", self.method.shadows == ShadowRays::ToLight);
                constants.flag("FOUR_RAYS", self.method.pattern == Pattern::Four);
                constants.unsigned("BOUNCES", config.bounces());
            }
            Entry::Trace { any_hit } => constants.flag("ANY_HIT", any_hit),
        }
        constants
    }
}

/// Every method with a kernel of its own: each traversal with each value of its options (of ranges the ends), and each
/// way to cast other rays.
pub fn methods() -> Vec<Method> {
    let mut methods = Vec::new();
    let mut add = |text: &str| {
        // An option that has no effect without others is refused
        let Ok(selection) = Selection::parse(text) else { return };
        let method = selection.method();
        if !methods.contains(&method) {
            methods.push(method);
        }
    };
    for algorithm in algorithms() {
        add(algorithm.name);
        for option in algorithm.options {
            option.examples().iter().for_each(|value| add(&format!("{}:{}={value}", algorithm.name, option.key)));
        }
    }
    // What a traversal does otherwise in trees with clipped boxes, and options that need others
    let special = [
        "bvh:build=spatial",
        "bvh-stack:build=spatial",
        "bvh-stack:build=spatial,cull=off",
        "bvh-quantised:build=spatial",
        "bvh8:build=spatial",
        "bvh8:build=spatial,order=octant",
        "bvh4:stack=short,entries=1",
        "bvh8:stack=short,entries=16",
        "cwbvh:build=spatial",
    ];
    special.into_iter().for_each(&mut add);
    let of_kernels = |option: &&OptionInfo| option.axis == Axis::Rays || option.key == "reflections";
    for option in COMMON_OPTIONS.iter().filter(of_kernels) {
        option.examples().iter().for_each(|value| add(&format!("bvh-stack:{}={value}", option.key)));
    }
    methods
}

/// The passes of a frame of packets. That of hits is the same for all ray configurations.
pub fn packet_passes(config: Config, counting: bool) -> [Entry; 2] {
    [
        Entry::Packets { config: Config::P, counting, pass: PacketPass::Hits },
        Entry::Packets { config, counting, pass: PacketPass::Shade },
    ]
}

/// Every entry file that a method uses, with every set of its constants.
fn entries(method: Method) -> Vec<Entry> {
    let mut entries: Vec<Entry> = [false, true].map(|any_hit| Entry::Trace { any_hit }).to_vec();
    for config in Config::ALL {
        if method.traversal.packets.is_some() {
            let passes = [false, true].map(|counting| packet_passes(config, counting)).concat();
            entries.extend(passes.into_iter().filter(|entry| !entries.contains(entry)).collect::<Vec<_>>());
        } else if method.is_staged(config.bounces()) {
            let passes = StagedPass::all(config).into_iter();
            let of = |pass| [false, true].map(|counting| Entry::Staged { config, counting, pass });
            entries.extend(passes.flat_map(of));
        } else {
            entries.extend([false, true].map(|counting| Entry::Render { config, counting }));
        }
    }
    entries
}

/// The kernels of every algorithm without options on a GPU, with a stack of 32: the algorithm's name and the entry, and
/// the text. Of algorithms that differ only in their builders the first one is listed.
///
/// # Errors
/// [`crate::Error::Device`] with file and line for an include that does not exist (a mistake in `kernels/`).
pub fn defaults() -> Result<Vec<(String, Source)>> {
    let mut methods: Vec<Method> = Vec::new();
    let mut defaults = Vec::new();
    for algorithm in algorithms() {
        let method = Selection::parse(algorithm.name)?.method();
        if methods.contains(&method) {
            continue;
        }
        methods.push(method);
        for entry in entries(method) {
            let kernel =
                Kernel { entry, method, stack_size: 32, software_threads: 0, textures: false, leaf_order: false };
            let source = kernel.assemble().map_err(Error::Device)?;
            defaults.push((format!("{} {}", algorithm.name, entry.label()), source));
        }
    }
    Ok(defaults)
}

/// All variants that the program can run, with a stack of 32, for the static checks.
pub fn all() -> Vec<Kernel> {
    let mut all = Vec::new();
    for method in methods() {
        for entry in entries(method) {
            for leaf_order in [false, true].into_iter().filter(|leaf_order| !leaf_order || method.traversal.leaf_order)
            {
                for textures in [false, true] {
                    let kernel = |software_threads| Kernel {
                        entry,
                        method,
                        stack_size: 32,
                        software_threads,
                        textures,
                        leaf_order,
                    };
                    all.extend([0, 2].map(kernel));
                }
            }
        }
    }
    all
}
