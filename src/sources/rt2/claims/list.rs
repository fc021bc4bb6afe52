//! The claims, in the order in which docs/rt2-2010.md lists them.

use super::{Frames, any, builds, frames, printed, sizes};
use crate::sources::claims::{Basis, Case};
use crate::sources::rt2::data::Data;
use crate::sources::rt2::models::SceneKey;
use crate::sources::rt2::published::Published;
use crate::sources::rt2::structures::{BVH, CULLED, ROPES, STACK, Structure};

/// How a claim's cases are found.
pub enum Cases {
    /// From frame times of a device, or from steps in their place.
    Frames(fn(&Frames, &Published) -> Vec<Case>),
    /// From build times, sizes, properties or counts, which need no device.
    Rows(fn(&Data, &Published) -> Vec<Case>),
}

/// A claim, and how its cases are found.
pub struct Claim {
    /// The claim's number; a letter where it has several parts.
    pub id: &'static str,
    /// The claim itself.
    pub statement: &'static str,
    /// What has to be measured.
    pub needs: &'static str,
    /// What it is judged by.
    pub basis: Basis,
    /// Its cases.
    pub cases: Cases,
    /// The same cases of what was printed.
    pub printed: fn(&Published) -> Vec<Case>,
    /// The structures whose failed measurements are named, of a claim about frames.
    pub structures: &'static [&'static Structure],
    /// The scenes of these measurements.
    pub scenes: fn(&SceneKey) -> bool,
    /// Measurements that are not judged, with the reason.
    pub left_out: fn(&Data) -> Vec<String>,
    /// What to beware of in its cases.
    pub remark: &'static str,
}

/// What most claims have in common.
const CLAIM: Claim = Claim {
    id: "",
    statement: "",
    needs: "",
    basis: Basis::FrameTimes,
    cases: Cases::Rows(|_, _| Vec::new()),
    printed: |_| Vec::new(),
    structures: &[],
    scenes: any,
    left_out: |_| Vec::new(),
    remark: "",
};

fn is_counterpart(scene: &SceneKey) -> bool {
    scene.model().is_some()
}

/// All claims.
pub const CLAIMS: [Claim; 15] = [
    Claim {
        id: "1",
        statement: "The kd-tree with ropes is the fastest of the three on every scene",
        needs: "kdtree:build=sort with search=ropes and search=stack, and bvh-stack:build=sweep,max_leaf=3,cull=off, \
                P",
        cases: Cases::Frames(|frames, _| frames::ropes_fastest(frames)),
        printed: printed::ropes_first,
        structures: &[&ROPES, &STACK, &BVH],
        scenes: is_counterpart,
        remark: "The BVH as printed, which leaves out no box behind the nearest hit.",
        ..CLAIM
    },
    Claim {
        id: "2u",
        statement: "The kd-tree is faster than the BVH as printed (cull=off)",
        needs: "kdtree:build=sort,search=stack and bvh-stack:build=sweep,max_leaf=3,cull=off, P",
        cases: Cases::Frames(|frames, _| frames::kdtree_faster(frames, &BVH)),
        printed: printed::kdtree_before_bvh,
        structures: &[&STACK, &BVH],
        scenes: is_counterpart,
        ..CLAIM
    },
    Claim {
        id: "2c",
        statement: "The kd-tree is faster than a BVH that leaves out boxes behind the nearest hit (cull=on)",
        needs: "kdtree:build=sort,search=stack and bvh-stack:build=sweep,max_leaf=3, P",
        cases: Cases::Frames(|frames, _| frames::kdtree_faster(frames, &CULLED)),
        structures: &[&STACK, &CULLED],
        scenes: is_counterpart,
        remark: "The document's BVH did not do so: this is the same question to a better BVH.",
        ..CLAIM
    },
    Claim {
        id: "2a",
        statement: "The kd-tree's gain over the BVH is 18 % (Alien) and 3 % (Dino)",
        needs: "the same as claim 2u on counterparts of Alien and Dino",
        cases: Cases::Frames(frames::gains),
        structures: &[&STACK, &BVH],
        scenes: is_counterpart,
        remark: "Within 10 points in either reading of a percentage. Both scans of the Dino's size are judged: the \
                 document does not say what of the shape a frame depends on.",
        ..CLAIM
    },
    Claim {
        id: "3",
        statement: "The kd-tree's lead over the BVH is smaller on the pointed shape than on the compact ones",
        needs: "the same as claim 2u on scan:spikes=N and on an evenly meshed scan of Alien's or Dino's size",
        cases: Cases::Frames(|frames, _| frames::lead_on_points(frames)),
        printed: printed::lead_on_points,
        structures: &[&STACK, &BVH],
        scenes: |scene| scene.base() == "scan",
        ..CLAIM
    },
    Claim {
        id: "4",
        statement: "Build time of the two small models: min-max < BVH < sort",
        needs: "kdtree:build=min-max,search=stack, bvh-stack:build=sweep,max_leaf=3,sorting=every-node and \
                kdtree:build=sort,sorting=every-node,search=stack, built on equally many threads",
        basis: Basis::BuildTimes,
        cases: Cases::Rows(|data, _| builds::between(data)),
        printed: printed::bvh_between,
        left_out: builds::unlike_between,
        remark: "Few builds each: differences below 20 % decide nothing.",
        ..CLAIM
    },
    Claim {
        id: "4a",
        statement: "Build time of the largest model: the BVH is the slowest",
        needs: "the same as claim 4 on a counterpart of the Dragon",
        basis: Basis::BuildTimes,
        cases: Cases::Rows(|data, _| builds::slowest(data)),
        printed: printed::bvh_slowest,
        left_out: builds::unlike_slowest,
        remark: "Few builds each: differences below 20 % decide nothing.",
        ..CLAIM
    },
    Claim {
        id: "5",
        statement: "The BVH's gain over sort in build time is 55 % (Alien), 75 % (Dino) and -13 % (Dragon)",
        needs: "bvh-stack:build=sweep,max_leaf=3,sorting=every-node and \
                kdtree:build=sort,sorting=every-node,search=stack, built on equally many threads",
        basis: Basis::BuildTimes,
        cases: Cases::Rows(builds::gains),
        left_out: builds::unlike_gains,
        remark: "Within 10 points in either reading of a percentage; only builders that both sort in every node. A \
                 time that could be within 10 points by its margin of 20 % decides nothing.",
        ..CLAIM
    },
    Claim {
        id: "6",
        statement: "Memory: ropes > BVH on all models; kd-tree < BVH on two, kd-tree > BVH on the pointed one",
        needs: "kdtree:build=sort with search=stack and search=ropes, and bvh-stack:build=sweep,max_leaf=3",
        basis: Basis::Sizes,
        cases: Cases::Rows(|data, _| sizes::orders(data)),
        printed: printed::memory,
        remark: "By the memory model, without geometry. An evenly meshed scan of the Dino's size has not its shape and \
                 is not judged.",
        ..CLAIM
    },
    Claim {
        id: "6a",
        statement: "The pointed shape has more kd-tree leaves per triangle than the compact ones",
        needs: "kdtree:build=sort on scan:spikes=N and on an evenly meshed scan of Alien's or Dino's size",
        basis: Basis::Properties,
        cases: Cases::Rows(|data, _| sizes::leaves_of_points(data)),
        ..CLAIM
    },
    Claim {
        id: "7",
        statement: "Ropes take 48 bytes more for each leaf",
        needs: "kdtree:build=sort with search=stack and search=ropes",
        basis: Basis::Sizes,
        cases: Cases::Rows(|data, _| sizes::bytes_of_ropes(data)),
        remark: "By the memory model: a box and six links are three rows of 16 bytes.",
        ..CLAIM
    },
    Claim {
        id: "8",
        statement: "Several separate objects and empty space favour the BVH",
        needs: "kdtree:build=sort,search=stack and bvh-stack:build=sweep,max_leaf=3 (cull=on or off) on a scan, and on \
                sphereflake or room, P",
        cases: Cases::Frames(|frames, _| frames::separate_objects(frames)),
        structures: &[&STACK, &BVH, &CULLED],
        scenes: |scene| frames::SEPARATE.contains(&scene.base()) || scene.base() == "scan",
        remark: "A conjecture of the document. The ratio of the kd-tree to the BVH, against that on the evenly meshed \
                 scan of the nearest size.",
        ..CLAIM
    },
    Claim {
        id: "9",
        statement: "Object splits suit uneven scenes, spatial splits even ones",
        needs: "bvh-stack:build=spatial,max_leaf=3 and bvh-stack:build=sweep,max_leaf=3",
        basis: Basis::Properties,
        cases: Cases::Rows(|data, _| sizes::suits(data)),
        remark: "By expected costs; a gain below 1 % decides nothing. Even: evenly meshed scans, bunny, dragon; \
                 uneven: room, sponza. The document measured no spatial split.",
        ..CLAIM
    },
    Claim {
        id: "10",
        statement: "A spatial split leaves no overlap of its children",
        needs: "bvh-stack:build=spatial,max_leaf=3 with the properties spatial_splits and spatial_overlap",
        basis: Basis::Properties,
        cases: Cases::Rows(|data, _| sizes::overlap(data)),
        remark: "Before references are un-split and boxes are padded. A tree without spatial splits decides nothing.",
        ..CLAIM
    },
    Claim {
        id: "11",
        statement: "A BIH lets rays skip both children of a node",
        needs: "bih, P, with its counters",
        basis: Basis::Counts,
        cases: Cases::Rows(|data, _| frames::skips(data)),
        remark: "The share of visits of inner nodes that enter neither child: it agrees from 0.1 %, and contradicts \
                 where there is none.",
        ..CLAIM
    },
];
