//! What traversals count. The list at the end of this file is the only one: the Rust types, and the WGSL that counting
//! and timed kernels include, are made from it.

use crate::math::Ray;
use crate::workloads::trace::simt::Mark;
use crate::workloads::trace::traverse::{Lanes, Search, Traverser};
use bytemuck::{Pod, Zeroable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt::Write;

/// Names of the ray types, in the order of counters: those of the thesis of 2009, then incoherent ones.
pub const RAY_TYPES: [&str; 5] = ["primary", "shadow", "reflected", "ambient", "diffuse"];

/// One value per ray type, in the order of [`RAY_TYPES`].
pub type ByRayType<T> = [T; RAY_TYPES.len()];

/// Makes everything that has one item per counter. A counter is `event: field`; the traversal reports events.
macro_rules! counters {
    ($($(#[doc = $meaning:literal])+ $event:ident: $field:ident,)+) => {
        /// What one ray type of one pixel cost, as the counting kernels write it.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
        #[repr(C)]
        pub struct Counters {
            $($(#[doc = $meaning])+ pub $field: u32,)+
        }

        /// Counters of one ray type, summed over a path.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
        #[serde(default)] // a counter that a record does not have yet is 0
        pub struct CounterSums {
            $($(#[doc = $meaning])+ pub $field: u64,)+
        }

        impl CounterSums {
            /// Adds one pixel's counters.
            pub fn add(&mut self, counters: &Counters) {
                $(self.$field += u64::from(counters.$field);)+
            }

            /// The sums of both.
            #[must_use]
            pub fn with(&self, other: &CounterSums) -> CounterSums {
                CounterSums { $($field: self.$field + other.$field,)+ }
            }

            /// Name and sum of each counter.
            pub fn values(&self) -> Vec<(&'static str, u64)> {
                vec![$((stringify!($field), self.$field)),+]
            }

            /// Sums by name; `None` where there is none of rays. A counter that is not there is 0.
            pub fn read(get: impl Fn(&str) -> Option<u64>) -> Option<CounterSums> {
                get("rays").map(|_| CounterSums { $($field: get(stringify!($field)).unwrap_or(0),)+ })
            }
        }

        /// What traversals report of one ray.
        pub trait Count: Send + Sync {
            $($(#[doc = $meaning])+ fn $event(&mut self);)+

            /// So many tests of nodes' boxes.
            #[inline(always)]
            fn box_tests(&mut self, tests: u32) {
                (0..tests).for_each(|_| self.box_test());
            }

            /// What only a replay in warps needs.
            #[inline(always)]
            fn mark(&mut self, _mark: Mark) {}

            /// The node, cell, leaf or triangle reference that is read for what was reported last. Only a replay in
            /// warps needs it.
            #[inline(always)]
            fn read(&mut self, _index: u32) {}
        }

        impl Count for CountOff {
            $(#[inline(always)] fn $event(&mut self) {})+
        }

        impl Count for Counters {
            $(#[inline(always)] fn $event(&mut self) { self.$field += 1; })+
        }

        /// Event and field of each counter, in the order of [`Counters`].
        const LIST: &[(&str, &str)] = &[$((stringify!($event), stringify!($field))),+];
    };
}

/// A way of counting the rays of frames.
pub trait Tally: Count + Copy + Default {
    /// What was counted.
    fn total(&self) -> Counters;

    /// Traverses rays of a type in this way.
    fn traverse(
        by: &dyn Traverser,
        of: (usize, Search),
        rays: &Lanes<Ray>,
        alive: u64,
        counters: &mut Lanes<Self>,
    ) -> Lanes<u32>;
}

/// Counts nothing and costs nothing: the timed twins.
#[derive(Clone, Copy, Default)]
pub struct CountOff;

impl Tally for CountOff {
    fn total(&self) -> Counters {
        Counters::default()
    }

    fn traverse(
        by: &dyn Traverser,
        (_, search): (usize, Search),
        rays: &Lanes<Ray>,
        alive: u64,
        _: &mut Lanes<CountOff>,
    ) -> Lanes<u32> {
        by.uncounted(search, rays, alive)
    }
}

impl Tally for Counters {
    fn total(&self) -> Counters {
        *self
    }

    fn traverse(
        by: &dyn Traverser,
        of: (usize, Search),
        rays: &Lanes<Ray>,
        alive: u64,
        counters: &mut Lanes<Counters>,
    ) -> Lanes<u32> {
        by.counted(of, rays, alive, counters)
    }
}

impl Counters {
    /// Traversal steps: nodes visited, or cells for a grid.
    pub fn steps(&self) -> u32 {
        self.inner + self.leaves
    }
}

impl CounterSums {
    /// Traversal steps: nodes visited, or cells for a grid.
    pub fn steps(&self) -> u64 {
        self.inner + self.leaves
    }
}

/// WGSL of the counting kernels, or of the timed ones, where every function is empty: `begin_pixel()` for invocations
/// with several pixels, `begin_ray(kind)`, for each counter `count_EVENT()` and `add_FIELD(n)`, and `mark_EVENT()` for
/// what is never counted there.
pub fn wgsl(counting: bool) -> String {
    let mut text = String::new();
    let mut line = |arguments: std::fmt::Arguments| writeln!(text, "{arguments}").expect("a String takes all text");
    if counting {
        line(format_args!("struct Counters {{"));
        LIST.iter().for_each(|(_, field)| line(format_args!("    {field}: u32,")));
        line(format_args!("}}\nconst RAY_TYPES: u32 = {}u;", RAY_TYPES.len()));
        line(format_args!("var<private> counters: array<Counters, RAY_TYPES>; // of this invocation, by ray type"));
        line(format_args!("var<private> ray_kind: u32;"));
    }
    let reset = if counting { "counters = array<Counters, RAY_TYPES>();" } else { "" };
    line(format_args!("fn begin_pixel() {{ {reset} }}"));
    let begin = if counting { "ray_kind = kind; count_ray();" } else { "" };
    line(format_args!("fn begin_ray(kind: u32) {{ {begin} }}"));
    for (event, field) in LIST {
        let add = if counting { format!("counters[ray_kind].{field} += n;") } else { String::new() };
        line(format_args!("fn add_{field}(n: u32) {{ {add} }}"));
        line(format_args!("fn count_{event}() {{ add_{field}(1u); }}"));
    }
    // What only a replay in warps and static costs need
    ["vote", "turn"].iter().for_each(|mark| line(format_args!("fn mark_{mark}() {{}}")));
    text
}

counters! {
    /// A ray of this type sets out.
    ray: rays,
    /// An inner node is visited, or a cell of a grid.
    inner: inner,
    /// A leaf is visited (not counted by grids).
    leaf: leaves,
    /// A ray/triangle test.
    test: tests,
    /// An entry is taken from a stack.
    pop: pops,
    /// A restart at (or below) the root.
    restart: restarts,
    /// A rope is followed from a leaf to its neighbour, or a link from a node to its parent.
    rope: ropes,
    /// A search by ropes is given up, and the ray is finished by the search with a trail.
    fallback: fallbacks,
    /// A visit of an inner node of a BIH that enters neither child.
    skip: skips,
    /// A test of a node's box against the ray, in a tree of boxes; those of empty children and of the whole scene are
    /// not counted.
    box_test: boxes,
}
