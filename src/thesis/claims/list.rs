//! The claims, in the order of SPEC section 10.

use super::{Basis, Case, cases, options};
use crate::thesis::data::Data;

/// A claim: its words, and how to find its cases.
pub struct Claim {
    /// Number in SPEC section 10; a letter where it has two halves.
    pub id: &'static str,
    /// Its words.
    pub statement: &'static str,
    /// What has to be measured.
    pub needs: &'static str,
    /// Frame times say something about a GPU only on a GPU; a claim of the other kinds is judged once, not per device.
    pub basis: Basis,
    /// Cases from frame times, sizes or build times.
    pub cases: fn(&Data, usize) -> Vec<Case>,
    /// Cases from counts, where there is a way.
    pub by_counts: Option<fn(&Data) -> Vec<Case>>,
    /// What to know about its cases.
    pub remark: &'static str,
}

/// All claims.
pub const CLAIMS: [Claim; 15] = [
    Claim {
        id: "1",
        statement: "Build time: grid < BVH < kd-tree",
        needs: "grid, bvh and kdtree of a scene",
        basis: Basis::BuildTimes,
        cases: |data, _| cases::build_times(data),
        by_counts: None,
        remark: "Measured builds are single ones and taken as uncertain by 5 %.",
    },
    Claim {
        id: "2",
        statement: "Memory: BVH < kd-tree < grid",
        needs: "grid, bvh and kdtree of a scene",
        basis: Basis::Sizes,
        cases: |data, _| cases::memory(data),
        by_counts: None,
        remark: "By the thesis's accounting, geometry included.",
    },
    Claim {
        id: "3",
        statement: "P and PS: BVH packets are fastest on ordinary scenes",
        needs: "grid, kdtree and bvh on a scene that is not uniform, P or PS",
        basis: Basis::FrameTimes,
        cases: cases::bvh_fastest,
        by_counts: None,
        remark: "Ordinary is what is not uniform: a rule-sized grid's fullest cell has eight times sqrt(n) / 16 triangles or more, which is what an even surface would give it.",
    },
    Claim {
        id: "4",
        statement: "PSR with more than a few percent of mirrors: kd-tree < BVH < grid in time",
        needs: "grid, kdtree and bvh, PSR, on a scene of which more than 3 % mirrors",
        basis: Basis::FrameTimes,
        cases: cases::mirrors,
        by_counts: None,
        remark: "A few percent: 3 % of the surface. Of the printed numbers: scenes where reflections cost 10 % or more.",
    },
    Claim {
        id: "5",
        statement: "The grid is slowest on every non-uniform scene",
        needs: "grid, kdtree and bvh on a scene that is not uniform",
        basis: Basis::FrameTimes,
        cases: cases::grid_slowest,
        by_counts: None,
        remark: "The thesis itself grants one exception, the scene with the fewest triangles.",
    },
    Claim {
        id: "6a",
        statement: "Time per ray falls as resolution rises",
        needs: "grid, kdtree and bvh at two resolutions",
        basis: Basis::FrameTimes,
        cases: cases::time_per_ray_falls,
        by_counts: None,
        remark: "From the smallest to the largest resolution that all three structures have.",
    },
    Claim {
        id: "6b",
        statement: "Time per ray falls most for BVH packets",
        needs: "grid, kdtree and bvh at two resolutions",
        basis: Basis::FrameTimes,
        cases: cases::bvh_gains_most,
        by_counts: None,
        remark: "From the smallest to the largest resolution that all three structures have.",
    },
    Claim {
        id: "7",
        statement: "A short stack of four more than doubles the speed of restart",
        needs: "kdtree and kdtree:search=restart",
        basis: Basis::FrameTimes,
        cases: options::short_stack,
        by_counts: Some(options::short_stack_counts),
        remark: "",
    },
    Claim {
        id: "8",
        statement: "Not letting rays vote that want neither child speeds reflected rays up (up to 20 %)",
        needs: "bvh and bvh:vote=original, PSR, on a scene of which more than 3 % mirrors",
        basis: Basis::FrameTimes,
        cases: options::vote,
        by_counts: Some(options::vote_counts),
        remark: "",
    },
    Claim {
        id: "9",
        statement: "Shadow rays from the light beat shadow rays to the light",
        needs: "a structure by default and with shadows=to-light, PS",
        basis: Basis::FrameTimes,
        cases: options::shadow_direction,
        by_counts: Some(options::shadow_direction_counts),
        remark: "",
    },
    Claim {
        id: "10a",
        statement: "The resolution rule 4 n^(1/4) is near the best for uniform geometry",
        needs: "grid with at least one coarser and one finer factor, P, on a uniform scene",
        basis: Basis::FrameTimes,
        cases: options::rule_near,
        by_counts: Some(options::rule_near_counts),
        remark: "Near: at most 15 % above the best that was measured.",
    },
    Claim {
        id: "10b",
        statement: "The resolution rule is far from the best for a teapot in a stadium",
        needs: "grid with at least one coarser and one finer factor, P, on robots or the built-in stadium",
        basis: Basis::FrameTimes,
        cases: options::rule_far,
        by_counts: Some(options::rule_far_counts),
        remark: "Far: at least 50 % above the best that was measured.",
    },
    Claim {
        id: "11a",
        statement: "grid-coop is slower than the plain grid",
        needs: "grid and grid-coop with the same resolution",
        basis: Basis::FrameTimes,
        cases: |data, device| options::other_grid(data, device, "grid-coop"),
        by_counts: None,
        remark: "",
    },
    Claim {
        id: "11b",
        statement: "grid-packet is slower than the plain grid",
        needs: "grid and grid-packet with the same resolution",
        basis: Basis::FrameTimes,
        cases: |data, device| options::other_grid(data, device, "grid-packet"),
        by_counts: None,
        remark: "",
    },
    Claim {
        id: "12",
        statement: "How many threads fit on a processor is worth about 20 %",
        needs: "a structure by default and with group=WxH (kdtree also memory=private), PSR",
        basis: Basis::FrameTimes,
        cases: options::occupancy,
        by_counts: None,
        remark: "A stand-in: wgpu has no register limit, so work-group shape and the memory of the stack are varied. \
                 It agrees where the best or worst choice differs by 10 % or more from the default.",
    },
];
