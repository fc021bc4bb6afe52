//! The claims, in the order in which docs/thesis-2009.md lists them.

use super::{Case, cases, occupancy, options, resolution};
use crate::sources::claims::Basis;
use crate::sources::thesis::data::{CONFIGS, Data, Failure};
use crate::sources::thesis::scenes::SceneKey;
use crate::sources::thesis::structures::{BVH, GRID, KDTREE, RESOLUTION_OPTIONS, STRUCTURES, family};
use crate::sources::thesis::variant::Variant;
use crate::workloads::trace::backend::Config;

/// A claim, and how its cases are found.
pub struct Claim {
    /// The claim's number; a letter where it has two halves.
    pub id: &'static str,
    /// The claim itself.
    pub statement: &'static str,
    /// What has to be measured.
    pub needs: &'static str,
    /// What it is judged by: a claim about frame times is judged for each device, others once.
    pub basis: Basis,
    /// Cases from frame times, sizes or build times.
    pub cases: fn(&Data, usize) -> Vec<Case>,
    /// Cases from a device's counts, if counts can decide the claim.
    pub by_counts: Option<fn(&Data, usize) -> Vec<Case>>,
    /// The measurements that it is judged by; those that failed are named.
    pub scope: Scope,
    /// Measurements that are not judged, with the reason.
    pub left_out: fn(&Data) -> Vec<String>,
    /// What to beware of in its cases.
    pub remark: &'static str,
}

/// The measurements that a claim is judged by.
pub struct Scope {
    /// The structures.
    pub structures: &'static [&'static str],
    /// The ray configurations.
    pub configs: &'static [Config],
    /// Options that are compared; otherwise only the thesis's.
    pub options: &'static [&'static str],
    /// The scenes.
    pub scenes: fn(&Data, &SceneKey) -> bool,
}

impl Scope {
    /// No frame times.
    const NONE: Scope = Scope { structures: &[], configs: &[], options: &[], scenes: |_, _| false };
    /// The three structures as the thesis set them.
    const TRIO: Scope = Scope { structures: &STRUCTURES, configs: &CONFIGS, options: &[], scenes: |_, _| true };

    /// True if a measurement belongs to it.
    pub fn has(&self, data: &Data, failure: &Failure) -> bool {
        let base = Variant::of_thesis(failure.scene.thesis(), family(&failure.structure));
        // If resolutions are compared, the rule's is one of them
        let by_rule = failure.variant.is_default() && self.options.contains(&"factor");
        let compared = |base: &Variant| {
            failure.variant.only_beyond(base).is_some_and(|(option, _)| self.options.contains(&option))
        };
        (failure.variant == base || by_rule || compared(&base) || compared(&Variant::default()))
            && self.structures.contains(&failure.structure.as_str())
            && self.configs.contains(&failure.config)
            && (self.scenes)(data, &failure.scene)
    }
}

fn ordinary(data: &Data, scene: &SceneKey) -> bool {
    cases::is_uniform(data, scene) == Some(false)
}

fn uniform(data: &Data, scene: &SceneKey) -> bool {
    cases::is_uniform(data, scene) == Some(true)
}

fn nothing(_: &Data) -> Vec<String> {
    Vec::new()
}

const RESOLUTIONS: Scope =
    Scope { structures: &[GRID], configs: &[Config::P], options: &RESOLUTION_OPTIONS, scenes: uniform };

/// Claims about frame times that the SIMT model cannot judge: near the best (10a) is within its margin, and it has no
/// registers (12).
pub const NOT_MODELLED: [&str; 2] = ["10a", "12"];

/// All claims.
pub const CLAIMS: [Claim; 15] = [
    Claim {
        id: "1",
        statement: "Build time: grid < BVH < kd-tree",
        needs: "grid, bvh and kdtree of a scene, built on equally many threads (--threads 1, as in the thesis)",
        basis: Basis::BuildTimes,
        cases: |data, _| cases::build_times(data),
        by_counts: None,
        scope: Scope::NONE,
        left_out: cases::unlike_builds,
        remark: "Few builds each: differences below 20 % decide nothing.",
    },
    Claim {
        id: "2",
        statement: "Memory: BVH < kd-tree < grid",
        needs: "grid, bvh and kdtree of a scene",
        basis: Basis::Sizes,
        cases: |data, _| cases::memory(data),
        by_counts: None,
        scope: Scope::NONE,
        left_out: nothing,
        remark: "By the thesis's accounting, geometry included.",
    },
    Claim {
        id: "3",
        statement: "P and PS: BVH packets are fastest on ordinary scenes",
        needs: "grid, kdtree and bvh on a scene that is not uniform, P or PS",
        basis: Basis::FrameTimes,
        cases: cases::bvh_fastest,
        by_counts: None,
        scope: Scope { configs: &[Config::P, Config::PS], scenes: ordinary, ..Scope::TRIO },
        left_out: nothing,
        remark: "Ordinary is what is not uniform: a rule-sized grid's fullest cell has eight times sqrt(n) / 16 \
                 triangles or more, which is what an even surface would give it.",
    },
    Claim {
        id: "4",
        statement: "PSR with more than a few percent of mirrors: kd-tree < BVH < grid in time",
        needs: "grid, kdtree and bvh, PSR, on a scene of which more than 3 % mirrors",
        basis: Basis::FrameTimes,
        cases: cases::mirrors,
        by_counts: None,
        scope: Scope { configs: &[Config::PSR], scenes: cases::is_shiny, ..Scope::TRIO },
        left_out: nothing,
        remark: "A few percent: 3 % of the surface. Of the printed numbers: scenes where reflections cost 10 % or \
                 more.",
    },
    Claim {
        id: "5",
        statement: "The grid is slowest on every non-uniform scene",
        needs: "grid, kdtree and bvh on a scene that is not uniform",
        basis: Basis::FrameTimes,
        cases: cases::grid_slowest,
        by_counts: None,
        scope: Scope { scenes: ordinary, ..Scope::TRIO },
        left_out: nothing,
        remark: "The thesis itself grants one exception, the scene with the fewest triangles.",
    },
    Claim {
        id: "6a",
        statement: "Time per ray falls as resolution rises",
        needs: "grid, kdtree and bvh at two resolutions",
        basis: Basis::FrameTimes,
        cases: cases::time_per_ray_falls,
        by_counts: None,
        scope: Scope::TRIO,
        left_out: nothing,
        remark: "From the smallest to the largest resolution that all three structures have.",
    },
    Claim {
        id: "6b",
        statement: "Time per ray falls most for BVH packets",
        needs: "grid, kdtree and bvh at two resolutions",
        basis: Basis::FrameTimes,
        cases: cases::bvh_gains_most,
        by_counts: None,
        scope: Scope::TRIO,
        left_out: nothing,
        remark: "From the smallest to the largest resolution that all three structures have.",
    },
    Claim {
        id: "7",
        statement: "A short stack of four more than doubles the speed of restart",
        needs: "kdtree and kdtree:search=restart with the same rays and size",
        basis: Basis::FrameTimes,
        cases: options::short_stack,
        by_counts: Some(options::short_stack_counts),
        scope: Scope { structures: &[KDTREE], options: &["search"], ..Scope::TRIO },
        left_out: nothing,
        remark: "",
    },
    Claim {
        id: "8",
        statement: "Not letting rays vote that want neither child speeds reflected rays up (up to 20 %)",
        needs: "bvh and bvh:vote=original, PSR, on a scene of which more than 3 % mirrors",
        basis: Basis::FrameTimes,
        cases: options::vote,
        by_counts: Some(options::vote_counts),
        scope: Scope { structures: &[BVH], configs: &[Config::PSR], options: &["vote"], scenes: cases::is_shiny },
        left_out: nothing,
        remark: "",
    },
    Claim {
        id: "9",
        statement: "Shadow rays from the light beat shadow rays to the light",
        needs: "a structure by default and with shadows=to-light, PS (judged by counts, PSR will do)",
        basis: Basis::FrameTimes,
        cases: options::shadow_direction,
        by_counts: Some(options::shadow_direction_counts),
        scope: Scope { configs: &[Config::PS], options: &["shadows"], ..Scope::TRIO },
        left_out: nothing,
        remark: "",
    },
    Claim {
        id: "10a",
        statement: "The resolution rule 4 n^(1/4) is near the best for uniform geometry",
        needs: "grid with at least one coarser and one finer factor, P, on a uniform scene",
        basis: Basis::FrameTimes,
        cases: resolution::rule_near,
        by_counts: Some(resolution::rule_near_counts),
        scope: RESOLUTIONS,
        left_out: nothing,
        remark: "Near: at most 15 % above the best that was measured.",
    },
    Claim {
        id: "10b",
        statement: "The resolution rule is far from the best for a teapot in a stadium",
        needs: "grid with at least one coarser and one finer factor, P, on robots or the built-in stadium",
        basis: Basis::FrameTimes,
        cases: resolution::rule_far,
        by_counts: Some(resolution::rule_far_counts),
        scope: Scope { scenes: resolution::is_stadium, ..RESOLUTIONS },
        left_out: nothing,
        remark: "Far: at least 50 % above the best that was measured.",
    },
    Claim {
        id: "11a",
        statement: "grid-coop is slower than the plain grid",
        needs: "grid and grid-coop with the same resolution",
        basis: Basis::FrameTimes,
        cases: |data, device| options::other_grid(data, device, "grid-coop"),
        by_counts: None,
        scope: Scope { structures: &[GRID, "grid-coop"], ..Scope::TRIO },
        left_out: nothing,
        remark: "",
    },
    Claim {
        id: "11b",
        statement: "grid-packet is slower than the plain grid",
        needs: "grid and grid-packet with the same resolution",
        basis: Basis::FrameTimes,
        cases: |data, device| options::other_grid(data, device, "grid-packet"),
        by_counts: None,
        scope: Scope { structures: &[GRID, "grid-packet"], ..Scope::TRIO },
        left_out: nothing,
        remark: "",
    },
    Claim {
        id: "12",
        statement: "Limiting registers, so that more threads fit on a processor, makes it faster by about 20 %",
        needs: "kdtree and kdtree:memory=private, or a structure with group=WxH of more or less than 64 threads \
                and with the default group, PSR",
        basis: Basis::FrameTimes,
        cases: occupancy::occupancy,
        by_counts: None,
        scope: Scope { configs: &[Config::PSR], options: &["group", "memory"], ..Scope::TRIO },
        left_out: nothing,
        remark: "Of measured numbers it judges substitute options, not registers: wgpu cannot limit them. What lets \
                 more threads fit is here the kd-tree's short stack in private instead of work-group memory, and a \
                 smaller instead of a larger work-group (a shape of as many threads has no direction and is not \
                 judged). A case agrees where that makes it 10 to 30 % faster, and contradicts where it makes it \
                 slower or more than 40 % faster.",
    },
];
