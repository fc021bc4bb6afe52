//! Assembles a kernel: an entry file, a traversal, a set of constants. WGSL has no include and an `override` may not
//! size an array, so that both are done here, in text; a line map turns naga's lines back into files and lines.

use crate::math;
use crate::workloads::trace::backend::Config;
use crate::workloads::trace::gpu::tokens::tokens;
use crate::workloads::trace::intersect::{TriangleTest, moller_trumbore};
use crate::workloads::trace::method::{Pattern, ShadowRays, Vote};
use crate::workloads::trace::{Method, Traversal};
use std::fmt::Write;

/// Every file of `kernels/`, compiled into the program.
pub const FILES: &[(&str, &str)] = &[
    ("trace/render.wgsl", include_str!("../../../../kernels/trace/render.wgsl")),
    ("trace/given.wgsl", include_str!("../../../../kernels/trace/given.wgsl")),
    ("lib/geom.wgsl", include_str!("../../../../kernels/lib/geom.wgsl")),
    ("trace/intersect/watertight.wgsl", include_str!("../../../../kernels/trace/intersect/watertight.wgsl")),
    ("trace/intersect/moller_trumbore.wgsl", include_str!("../../../../kernels/trace/intersect/moller_trumbore.wgsl")),
    ("trace/scene.wgsl", include_str!("../../../../kernels/trace/scene.wgsl")),
    ("trace/buffers.wgsl", include_str!("../../../../kernels/trace/buffers.wgsl")),
    ("trace/textures.wgsl", include_str!("../../../../kernels/trace/textures.wgsl")),
    ("trace/shade.wgsl", include_str!("../../../../kernels/trace/shade.wgsl")),
    ("lib/count_off.wgsl", include_str!("../../../../kernels/lib/count_off.wgsl")),
    ("lib/count_on.wgsl", include_str!("../../../../kernels/lib/count_on.wgsl")),
    ("trace/store_timed.wgsl", include_str!("../../../../kernels/trace/store_timed.wgsl")),
    ("trace/store_counted.wgsl", include_str!("../../../../kernels/trace/store_counted.wgsl")),
    ("lib/independent.wgsl", include_str!("../../../../kernels/lib/independent.wgsl")),
    ("lib/cooperative.wgsl", include_str!("../../../../kernels/lib/cooperative.wgsl")),
    ("trace/grid/walk.wgsl", include_str!("../../../../kernels/trace/grid/walk.wgsl")),
    (
        "trace/kdtree/short_stack_workgroup.wgsl",
        include_str!("../../../../kernels/trace/kdtree/short_stack_workgroup.wgsl"),
    ),
    (
        "trace/kdtree/short_stack_private.wgsl",
        include_str!("../../../../kernels/trace/kdtree/short_stack_private.wgsl"),
    ),
    ("trace/bvh/node.wgsl", include_str!("../../../../kernels/trace/bvh/node.wgsl")),
    ("trace/brute/scan.wgsl", include_str!("../../../../kernels/trace/brute/scan.wgsl")),
    ("trace/grid/dda.wgsl", include_str!("../../../../kernels/trace/grid/dda.wgsl")),
    ("trace/grid/coop.wgsl", include_str!("../../../../kernels/trace/grid/coop.wgsl")),
    ("trace/grid/packet.wgsl", include_str!("../../../../kernels/trace/grid/packet.wgsl")),
    ("trace/kdtree/search.wgsl", include_str!("../../../../kernels/trace/kdtree/search.wgsl")),
    ("trace/bvh/packet.wgsl", include_str!("../../../../kernels/trace/bvh/packet.wgsl")),
    ("trace/bvh/stack.wgsl", include_str!("../../../../kernels/trace/bvh/stack.wgsl")),
];

/// Which entry file, and how it is specialised.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Entry {
    /// `render.wgsl`.
    Render {
        /// Ray configuration.
        config: Config,
        /// With counters, or timed.
        counting: bool,
    },
    /// `trace.wgsl`.
    Trace {
        /// Any hit instead of the nearest one.
        any_hit: bool,
    },
}

/// One kernel variant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Kernel {
    /// Entry file and its constants.
    pub entry: Entry,
    /// File in `traverse/`, and constants.
    pub method: Method,
    /// Entries of a full stack, see [`stack_size`].
    pub stack_size: u32,
    /// Threads of a driver that computes on the CPU, where the same results come by operations that are cheaper there; 0
    /// for a GPU.
    pub software_threads: u32,
    /// Scene and structure lie in textures, not in storage buffers.
    pub textures: bool,
}

/// Texels in a row of those textures. Every device has at least so many.
pub const TEXTURE_WIDTH: u32 = 4096;

/// Stack entries for a tree of `depth` levels and the EMPTY at the bottom: a multiple of 32, so that few different
/// kernels are compiled.
pub fn stack_size(depth: u32) -> u32 {
    (depth + 2).next_multiple_of(32)
}

/// Begin of the line that says over how many threads a software driver deals the work-groups.
const THREADS: &str = "const THREADS";

/// An assembled kernel.
#[derive(Clone, Debug)]
pub struct Source {
    /// WGSL.
    pub text: String,
    /// For each line of `text`: file and line (counted from 1) that it came from.
    pub lines: Vec<(&'static str, usize)>,
}

impl Source {
    /// The file and line of line `line` (counted from 1) of the text, as `kernels/FILE:LINE`.
    pub fn locate(&self, line: usize) -> String {
        match self.lines.get(line.wrapping_sub(1)) {
            Some((file, line)) => format!("kernels/{file}:{line}"),
            None => format!("line {line} of the assembled kernel"),
        }
    }

    /// First 16 digits of BLAKE3 of the text's tokens, without the number of the driver's threads: the identity of a measured
    /// kernel, the same on every machine. Comments and white space do not change it.
    pub fn hash(&self) -> String {
        let lines = self.text.split_inclusive('\n').filter(|line| !line.starts_with(THREADS));
        let tokens = tokens(&lines.collect::<String>());
        blake3::hash(tokens.as_bytes()).to_hex()[..16].to_string()
    }
}

/// File of a traversal below `kernels/`.
pub fn traversal_file(traversal: Traversal) -> &'static str {
    match traversal {
        Traversal::Brute => "trace/brute/scan.wgsl",
        Traversal::Grid => "trace/grid/dda.wgsl",
        Traversal::GridCoop => "trace/grid/coop.wgsl",
        Traversal::GridPacket => "trace/grid/packet.wgsl",
        Traversal::KdTree(_) => "trace/kdtree/search.wgsl",
        Traversal::Bvh(_) => "trace/bvh/packet.wgsl",
        Traversal::BvhStack => "trace/bvh/stack.wgsl",
    }
}

impl Kernel {
    /// A name for labels and messages.
    pub fn label(&self) -> String {
        let traversal = traversal_file(self.method.traversal).trim_start_matches("traverse/").trim_end_matches(".wgsl");
        match self.entry {
            Entry::Render { config, counting } => {
                format!("{traversal} {config:?}{}", if counting { " counting" } else { "" })
            }
            Entry::Trace { any_hit } => format!("{traversal} trace{}", if any_hit { " any hit" } else { "" }),
        }
    }

    /// The WGSL of this variant.
    ///
    /// # Errors
    /// A message with file and line for an include that does not exist (a mistake in `kernels/`).
    pub fn assemble(&self) -> Result<Source, String> {
        let (entry, counting) = match self.entry {
            Entry::Render { counting, .. } => ("trace/render.wgsl", counting),
            Entry::Trace { .. } => ("trace/given.wgsl", false),
        };
        let private = matches!(self.method.traversal, Traversal::KdTree(search) if search.private);
        let short_stack =
            if private { "trace/kdtree/short_stack_private.wgsl" } else { "trace/kdtree/short_stack_workgroup.wgsl" };
        let intersect = match self.method.intersect {
            TriangleTest::Watertight => "trace/intersect/watertight.wgsl",
            TriangleTest::MollerTrumbore => "trace/intersect/moller_trumbore.wgsl",
        };
        let mut assembly = Assembly {
            slots: [
                ("short_stack", short_stack),
                ("intersect", intersect),
                ("memory", if self.textures { "trace/textures.wgsl" } else { "trace/buffers.wgsl" }),
                ("traversal", traversal_file(self.method.traversal)),
                ("counting", if counting { "lib/count_on.wgsl" } else { "lib/count_off.wgsl" }),
                ("store", if counting { "trace/store_counted.wgsl" } else { "trace/store_timed.wgsl" }),
            ],
            seen: Vec::new(),
            source: Source { text: String::new(), lines: Vec::new() },
        };
        for line in self.prelude().lines() {
            assembly.push(line, "(prelude)", 1);
        }
        assembly.include(entry, "(prelude)", 1)?;
        Ok(assembly.source)
    }

    /// Constants that the kernels take from Rust, so that both sides have the same.
    fn prelude(&self) -> String {
        let mut text = String::new();
        let mut float = |name: &str, value: f32| writeln!(text, "const {name}: f32 = {value:?}f;").unwrap();
        float("T_MAX", math::T_MAX);
        float("INVERSE_OF_ZERO", math::INVERSE_OF_ZERO);
        float("PLANE_SHIFT", math::PLANE_SHIFT);
        float("PLANE_SHIFT_MIN", math::PLANE_SHIFT_MIN);
        float("SLACK", math::SLACK);
        float("DETERMINANT_MIN", moller_trumbore::DETERMINANT_MIN);
        let mut word = |name: &str, value: u32| writeln!(text, "const {name}: u32 = {value}u;").unwrap();
        word("MISS", math::MISS);
        word("STACK_SIZE", self.stack_size);
        word("GROUP_WIDTH", self.method.group.width);
        word("GROUP_HEIGHT", self.method.group.height);
        word("GROUP_SIZE", self.method.group.size());
        word("TEXTURE_WIDTH", TEXTURE_WIDTH);
        if let Traversal::KdTree(search) = self.method.traversal {
            word("SHORT_STACK", search.stack);
        }
        writeln!(text, "{THREADS}: u32 = {}u;", self.software_threads.max(1)).unwrap();
        let mut flag = |name: &str, value: bool| writeln!(text, "const {name}: bool = {value};").unwrap();
        flag("SOFTWARE", self.software_threads > 0);
        match self.method.traversal {
            Traversal::KdTree(search) => flag("PUSHDOWN", search.pushdown),
            Traversal::Bvh(vote) => flag("ORIGINAL_VOTE", vote == Vote::Original),
            _ => {}
        }
        match self.entry {
            Entry::Render { config, .. } => {
                flag("SHADOWS", config.shadows());
                flag("TO_LIGHT", self.method.shadows == ShadowRays::ToLight);
                flag("FOUR_RAYS", self.method.pattern == Pattern::Four);
                writeln!(text, "const BOUNCES: u32 = {}u;", config.bounces()).unwrap();
            }
            Entry::Trace { any_hit } => flag("ANY_HIT", any_hit),
        }
        text
    }
}

struct Assembly {
    slots: [(&'static str, &'static str); 6],
    seen: Vec<&'static str>,
    source: Source,
}

impl Assembly {
    fn push(&mut self, line: &str, file: &'static str, number: usize) {
        self.source.text.push_str(line);
        self.source.text.push('\n');
        self.source.lines.push((file, number));
    }

    /// Adds a file, and before the lines that ask for them, others; each once.
    fn include(&mut self, name: &str, from: &str, line: usize) -> Result<(), String> {
        let Some(&(name, text)) = FILES.iter().find(|(file, _)| *file == name) else {
            return Err(format!("kernels/{from}:{line}: no such kernel file: {name}"));
        };
        if self.seen.contains(&name) {
            return Ok(());
        }
        self.seen.push(name);
        for (index, text) in text.lines().enumerate() {
            if let Some(included) = text.strip_prefix("//!include ") {
                self.include(included.trim(), name, index + 1)?;
            } else if let Some(slot) = text.strip_prefix("//!slot ") {
                let slot = slot.trim();
                let Some((_, file)) = self.slots.iter().find(|(known, _)| *known == slot) else {
                    return Err(format!("kernels/{name}:{}: no such slot: {slot}", index + 1));
                };
                self.include(file, name, index + 1)?;
            } else {
                self.push(text, name, index + 1);
            }
        }
        Ok(())
    }
}

/// Every method of which a kernel exists in its own right: each traversal, and each way to specialise one.
pub fn methods() -> Vec<Method> {
    use crate::workloads::trace::method::{Group, KdSearch, MAX_SHORT_STACK};
    let thesis = KdSearch::THESIS;
    let searches = [
        thesis,
        KdSearch { private: true, ..thesis },
        KdSearch { stack: 0, ..thesis },
        KdSearch { stack: 0, pushdown: false, ..thesis },
        KdSearch { stack: 3, ..thesis },
        KdSearch { stack: MAX_SHORT_STACK, ..thesis },
    ];
    let alone =
        [Traversal::Brute, Traversal::Grid, Traversal::BvhStack].into_iter().chain(searches.map(Traversal::KdTree));
    let together =
        [Traversal::GridCoop, Traversal::GridPacket, Traversal::Bvh(Vote::Corrected), Traversal::Bvh(Vote::Original)];
    let mut methods: Vec<Method> = alone.chain(together).map(Method::from).collect();
    let packets = [(8, 4), (4, 4)].map(|(width, height)| Group { width, height });
    methods.extend(packets.iter().flat_map(|&group| together.map(|t| Method { group, ..t.into() })));
    let plain = Method::from(Traversal::BvhStack);
    methods.extend([
        Method { shadows: ShadowRays::ToLight, ..plain },
        Method { intersect: TriangleTest::MollerTrumbore, ..plain },
        Method { pattern: Pattern::Four, ..plain },
        Method { group: Group { width: 64, height: 1 }, ..plain },
        Method { group: Group { width: 16, height: 16 }, ..plain },
    ]);
    methods
}

/// All variants that the program can run, with a stack of 32: what the static checks go through.
pub fn all() -> Vec<Kernel> {
    let mut entries: Vec<Entry> = [false, true].map(|any_hit| Entry::Trace { any_hit }).to_vec();
    for config in Config::ALL {
        entries.extend([false, true].map(|counting| Entry::Render { config, counting }));
    }
    let mut all = Vec::new();
    for method in methods() {
        for &entry in &entries {
            for textures in [false, true] {
                let kernel = |software_threads| Kernel { entry, method, stack_size: 32, software_threads, textures };
                all.extend([0, 2].map(kernel));
            }
        }
    }
    all
}
