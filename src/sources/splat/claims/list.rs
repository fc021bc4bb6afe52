//! The claims: those of the thesis, and those about its method that a run can judge.

use super::{Judged, clusters, quality, times, work};
use crate::sources::claims::{Basis, Case};
use crate::sources::splat::data::View;
use crate::sources::splat::published::Published;

/// A claim, and how its cases are found.
pub struct Claim {
    /// The claim's number; a letter where it has two halves.
    pub id: &'static str,
    /// The claim itself.
    pub statement: &'static str,
    /// What has to be measured.
    pub needs: &'static str,
    /// What it is judged by on a GPU.
    pub basis: Basis,
    /// True if times of any device decide it, for this device.
    pub is_about_any_device: bool,
    /// Its cases.
    pub judge: fn(&View) -> Judged,
    /// The same of printed numbers.
    pub printed: fn(&Published) -> Vec<Case>,
    /// A warning about its cases.
    pub remark: &'static str,
}

/// What most claims have in common.
const CLAIM: Claim = Claim {
    id: "",
    statement: "",
    needs: "",
    basis: Basis::Counts,
    is_about_any_device: false,
    judge: |_| Judged::by(Basis::Counts, Vec::new()),
    printed: |_| Vec::new(),
    remark: "",
};

/// All claims.
pub const CLAIMS: [Claim; 18] = [
    Claim {
        id: "1",
        statement: "Samples, keys and unique clusters take a small share of the frame: less than 1 % of one with \
                    per-sample, 5 % of one with buckets",
        needs: "per-sample or buckets with unique=flags, on a device with times of stages",
        basis: Basis::FrameTimes,
        judge: times::keys_are_cheap,
        printed: times::printed_keys,
        remark: "Judged by the stages keys and unique; the samples' own stage traces rays here. Printed: 0.68 ms for \
                 the three kernels, by the frames of figure 5.2.",
        ..CLAIM
    },
    Claim {
        id: "2",
        statement: "The time for unique clusters by flags is the same for any number of clusters and any tile",
        needs: "rows with unique=flags of one size of image and equally many flags, on unlike scenes or with unlike \
                tiles, on a device with times of stages",
        basis: Basis::FrameTimes,
        judge: times::flags_are_constant,
        remark: "Taken for the same: within 10 % and the noise; for another: beyond twice that.",
        ..CLAIM
    },
    Claim {
        id: "3",
        statement: "Flags and their prefix sum are faster than sorting the keys of each tile",
        needs: "rows that differ in unique=flags and unique=sort alone, on a device with times of stages",
        basis: Basis::FrameTimes,
        judge: times::flags_beat_sort,
        remark: "The thesis says it without a measurement.",
        ..CLAIM
    },
    Claim {
        id: "4",
        statement: "Bounds of clusters with an intermediate step are 8 to 10 times faster than by atomics alone",
        needs: "rows that differ in bounds=direct and bounds=two-step alone",
        basis: Basis::FrameTimes,
        judge: times::two_steps_beat_one,
        remark: "Taken for at least 8 times; without a GPU for at most an eighth of the atomic operations on global \
                 memory. With the step these are 0 by construction: they move to work-group memory, whose cost counts \
                 do not show.",
        ..CLAIM
    },
    Claim {
        id: "5a",
        statement: "Per-sample: the estimate takes most of the frame (77 % there)",
        needs: "per-sample, on a device with times of stages or with counted work",
        basis: Basis::FrameTimes,
        judge: work::estimate_dominates,
        printed: work::printed_estimate,
        remark: "Taken for more than half. By counts: photon evaluations against box tests and list entries of two \
                 walks, each counted alike; less than twice as many decide nothing.",
        ..CLAIM
    },
    Claim {
        id: "5b",
        statement: "Buckets: the estimate takes less than 5 % of the frame (2 % there), splatting most of it (68 %)",
        needs: "buckets, on a device with times of stages",
        basis: Basis::FrameTimes,
        judge: work::splatting_dominates,
        printed: work::printed_splatting,
        remark: "Counts cannot decide it: a direction that is tested costs another time than a box test with an atomic \
                 addition. Without a GPU both numbers are given, and it is undecided.",
        ..CLAIM
    },
    Claim {
        id: "6",
        statement: "Buckets make a frame 4 to 5 times faster; splatting costs about the same with both techniques",
        needs: "per-sample and buckets under the same conditions",
        basis: Basis::FrameTimes,
        judge: work::buckets_are_faster,
        printed: work::printed_gain,
        remark: "Taken for at least 4 times, and for a quotient of at most 1.5; beyond 2 it is not the same. By \
                 counts, the frame alone: evaluations, directions tested, and box tests with entries or additions, \
                 twice for the two walks of per-sample, counted alike.",
        ..CLAIM
    },
    Claim {
        id: "7",
        statement: "The per-sample estimate's time is proportional to assignments weighted by samples",
        needs: "per-sample along a path of at least three frames with unlike work, on a device with times of stages",
        basis: Basis::FrameTimes,
        is_about_any_device: true,
        judge: work::estimate_follows_evaluations,
        remark: "Correlation of the stage's times with photon evaluations over the frames: agrees from 0.9 on, \
                 contradicts below 0.5.",
        ..CLAIM
    },
    Claim {
        id: "8",
        statement: "The bucket estimate's time does not depend on photons, radius or assignments",
        needs: "buckets with unlike radii or numbers of paths, else equal",
        basis: Basis::FrameTimes,
        judge: work::buckets_are_constant,
        remark: "Taken for independent: within 10 % and the noise, contradicted beyond twice that. Directions tested \
                 are 54 for each sample by construction, so that their count decides nothing.",
        ..CLAIM
    },
    Claim {
        id: "9",
        statement: "The load is uneven: the fullest cluster holds many times the mean",
        needs: "rows with clusters",
        judge: clusters::load_is_uneven,
        remark: "Taken for many times: at least 4; contradicted below 2. Over the clusters that have samples.",
        ..CLAIM
    },
    Claim {
        id: "10",
        statement: "Morton keys give a better tree than concatenated ones: fewer inner nodes and box tests",
        needs: "rows that differ in key=morton and key=concat alone",
        judge: clusters::morton_is_better,
        ..CLAIM
    },
    Claim {
        id: "11",
        statement: "The number of clusters depends on view and tile, and stays within a few tens of thousands",
        needs: "rows with clusters; for the second half with unlike tiles",
        judge: clusters::number_of_clusters,
        remark: "Taken for a few tens of thousands: at most 40,000; contradicted beyond 50,000.",
        ..CLAIM
    },
    Claim {
        id: "12",
        statement: "Leaving out the read-back of counts gains only little",
        needs: "rows that differ in sync=device and sync=readback alone",
        basis: Basis::FrameTimes,
        judge: times::read_back_costs_little,
        remark: "Taken for little: at most 10 % of the frame and the noise; contradicted beyond 25 %.",
        ..CLAIM
    },
    Claim {
        id: "13",
        statement: "Buckets have larger errors than per-sample at equal photons; a depth-aware blur lessens them",
        needs: "per-sample and buckets under the same conditions, and buckets with blur=0 and more, each compared with \
                a path-traced reference",
        basis: Basis::Pictures,
        judge: quality::buckets_err,
        remark: "By root mean squared errors, which do not tell jumps at borders of clusters from other errors.",
        ..CLAIM
    },
    Claim {
        id: "14",
        statement: "A larger radius needs fewer photons for the same noise and adds bias; a smaller one the reverse",
        needs: "one technique with at least two radii, best at two numbers of paths each, compared with a path-traced \
                reference",
        basis: Basis::Pictures,
        judge: quality::radius_trades,
        remark: "With two radii and two numbers of paths the squared error is split into a part that falls with the \
                 number of paths and the rest, which is bias. With one number of paths noise is undecided, and a mean \
                 that is nearer to the path-traced one at the larger radius contradicts.",
        ..CLAIM
    },
    Claim {
        id: "15",
        statement: "A light under open sky wastes paths",
        needs: "rows that say how many paths arrive at each hit",
        judge: quality::open_sky_wastes,
        remark: "Sponza has no roof over its court: it contradicts if less than 1 % of the paths are lost. Another \
                 scene that loses less than 5 % is taken for closed and not judged.",
        ..CLAIM
    },
    Claim {
        id: "16",
        statement: "Bits of normals in keys, or cones, lower the number of assignments",
        needs: "rows that differ in normals=off and normals=faces or cells alone",
        judge: clusters::normals_lower_assignments,
        remark: "The thesis names it and did not build it. More bits also make more clusters.",
        ..CLAIM
    },
    Claim {
        id: "17",
        statement: "Memory for flags and identifiers depends on the key's width alone, not on scene or view",
        needs: "rows with clusters of at least two scenes or views whose keys have the same width",
        basis: Basis::Sizes,
        judge: clusters::flags_follow_the_key,
        remark: "By bytes of identifiers by key as allocated, rows with one value of unique; where key_bits was \
                 recorded they must be 4 bytes for each key (with bits: for 32 keys). Where it was not, keys are taken \
                 for equally wide at the same size of image, tile and bits of normals.",
        ..CLAIM
    },
];
