//! Claims about clusters, nodes and their memory: exact counts and sizes.

use super::{Judged, case, count, usual_but, whole};
use crate::compare::judge::{Outcome, all, less};
use crate::sources::claims::{Basis, Case};
use crate::sources::splat::data::{Measurement, View};

/// Times the mean that are many, and below which they are not.
const MANY: (f64, f64) = (4.0, 2.0);
/// Clusters that are a few tens of thousands, and more than those.
const TENS_OF_THOUSANDS: (f64, f64) = (40_000.0, 50_000.0);

/// The first row of each scene under each condition: both techniques have the same clusters.
fn once<'a>(rows: Vec<&'a Measurement>, conditions: &[&str]) -> Vec<&'a Measurement> {
    let mut found: Vec<&Measurement> = Vec::new();
    for m in rows {
        let like = |other: &&Measurement| {
            other.scene == m.scene && conditions.iter().all(|axis| other.axis(axis) == m.axis(axis))
        };
        if !found.iter().any(like) {
            found.push(m);
        }
    }
    found
}

/// Clusters of a frame at least, for claim 9.
const FEWEST: f64 = 100.0;

/// Claim 9.
pub fn load_is_uneven(view: &View) -> Judged {
    let of = |m: &Measurement| {
        let (clusters, assignments) = m.metric("clusters_mean").zip(m.metric("assignments_mean"))?;
        let fullest = m.metric("fullest_cluster_mean").or_else(|| m.metric("fullest_cluster"))?;
        let mean = assignments / clusters;
        let times = Some(fullest / mean).filter(|times| times.is_finite())?;
        let outcome = match times {
            times if times >= MANY.0 => Outcome::Agrees,
            times if times < MANY.1 => Outcome::Contradicts,
            _ => Outcome::Undecided,
        };
        let numbers =
            format!("{} photons in the fullest, {mean:.1} in a mean cluster: {times:.1} times", whole(fullest));
        Some(case(view, m, "", outcome, numbers))
    };
    // Of a few clusters none says how uneven many are
    let has_many = |m: &&Measurement| m.metric("clusters_mean").is_some_and(|clusters| clusters >= FEWEST);
    let rows = usual_but(view, "").into_iter().filter(has_many).collect();
    let rows = once(rows, &["resolution", "tile", "radius", "paths", "light", "camera_path", "frames"]);
    Judged::by(Basis::Counts, rows.into_iter().filter_map(of).collect())
}

/// Claim 10.
pub fn morton_is_better(view: &View) -> Judged {
    let of = |(morton, concat): (&Measurement, &Measurement)| {
        let both = |name: &str| morton.metric(name).zip(concat.metric(name));
        let (nodes, tests) = both("inner_nodes_mean").zip(both("box_tests_mean"))?;
        let outcome = all([nodes, tests].map(|(morton, concat)| less(count(morton), count(concat))));
        let numbers = format!(
            "inner nodes {} and {}, box tests {} and {}: {:.2} and {:.2} times",
            whole(nodes.0),
            whole(nodes.1),
            whole(tests.0),
            whole(tests.1),
            nodes.1 / nodes.0,
            tests.1 / tests.0
        );
        Some(case(view, morton, "", outcome, numbers))
    };
    Judged::by(Basis::Counts, view.pairs("key", "morton", "concat").into_iter().filter_map(of).collect())
}

/// Claim 11: the number of each view and tile, and more clusters for smaller tiles.
pub fn number_of_clusters(view: &View) -> Judged {
    let rows: Vec<&Measurement> =
        usual_but(view, "").into_iter().filter(|m| m.metric("clusters_max").is_some()).collect();
    let at = |m: &Measurement| format!("{}, tile {}", m.axis("resolution"), m.axis("tile"));
    let mut cases = Vec::new();
    for m in once(rows, &["resolution", "tile", "light", "camera_path"]) {
        let Some(clusters) = m.metric("clusters_max") else { continue };
        let outcome = match clusters {
            clusters if clusters <= TENS_OF_THOUSANDS.0 => Outcome::Agrees,
            clusters if clusters > TENS_OF_THOUSANDS.1 => Outcome::Contradicts,
            _ => Outcome::Undecided,
        };
        let numbers = format!("at most {} clusters", whole(clusters));
        cases.push(Case { scene: m.scene.to_string(), what: at(m), outcome, numbers });
    }
    for group in view.sweeps("tile") {
        for pair in group.windows(2) {
            let ((_, small), (_, large)) = (pair[0], pair[1]);
            let Some((many, few)) = small.metric("clusters_mean").zip(large.metric("clusters_mean")) else { continue };
            let numbers = format!("{} clusters, {} at tile {}", whole(many), whole(few), large.axis("tile"));
            let what = format!("{} {}", small.technique(), at(small));
            cases.push(Case { scene: small.scene.to_string(), what, outcome: less(count(few), count(many)), numbers });
        }
    }
    Judged::by(Basis::Counts, cases)
}

/// Claim 16.
pub fn normals_lower_assignments(view: &View) -> Judged {
    let mut cases = Vec::new();
    for normals in ["faces", "cells"] {
        for (off, on) in view.pairs("normals", "off", normals) {
            let Some((a, b)) = off.metric("assignments_mean").zip(on.metric("assignments_mean")) else { continue };
            let clusters = off.metric("clusters_mean").zip(on.metric("clusters_mean"));
            let clusters = clusters.map_or(String::new(), |(a, b)| format!(", clusters {} and {}", whole(a), whole(b)));
            let numbers = format!("assignments {} and {}: {:.2} times{clusters}", whole(a), whole(b), b / a);
            let what = format!("normals={normals}");
            cases.push(case(view, off, &what, less(count(b), count(a)), numbers));
        }
    }
    Judged::by(Basis::Counts, cases)
}

/// Bytes of identifiers by key as allocated; where they were not recorded, of flags by the thesis's accounting.
struct Flags {
    bytes: u64,
    is_allocated: bool,
}

impl Flags {
    fn of(m: &Measurement) -> Option<Flags> {
        let of = |part: &str| m.part(part, "bytes").map(|bytes| bytes as u64);
        let allocated = of("identifiers by key").map(|bytes| Flags { bytes, is_allocated: true });
        allocated.or_else(|| Some(Flags { bytes: of("source-flags")?, is_allocated: false }))
    }

    /// Bytes for keys of so many bits: 4 for each key, with unique=bits for each word of 32.
    fn expected(&self, m: &Measurement, bits: f64) -> u64 {
        let keys_of_one = if self.is_allocated && m.axis("unique") == "bits" { 32 } else { 1 };
        (4 << (bits as u64).min(40)) / keys_of_one
    }
}

/// Claim 17: identifiers by key of keys that are equally wide, over scenes and views.
pub fn flags_follow_the_key(view: &View) -> Judged {
    let mut groups: Vec<Vec<(&Measurement, Flags)>> = Vec::new();
    for m in view.rows.iter().copied() {
        let Some(flags) = Flags::of(m) else { continue };
        let like = |(other, of_other): &(&Measurement, Flags)| {
            let same = |axes: &[&str]| axes.iter().all(|axis| other.axis(axis) == m.axis(axis));
            let widths = (m.metric("key_bits"), other.metric("key_bits"));
            widths.0 == widths.1
                && flags.is_allocated == of_other.is_allocated
                && same(&["unique"])
                && (widths.0.is_some() || same(&["resolution", "tile", "normals"]))
        };
        match groups.iter_mut().find(|group| group.first().is_some_and(like)) {
            Some(group) => group.push((m, flags)),
            None => groups.push(vec![(m, flags)]),
        }
    }
    let of = |group: &Vec<(&Measurement, Flags)>| {
        let (first, flags) = group.first()?;
        let place = |m: &Measurement| (m.scene.clone(), m.axis("camera_path").to_owned());
        let mut places: Vec<_> = group.iter().map(|(m, _)| place(m)).collect();
        places.sort();
        places.dedup();
        if places.len() < 2 {
            return None;
        }
        let mut sizes: Vec<u64> = group.iter().map(|(_, flags)| flags.bytes).collect();
        sizes.sort_unstable();
        sizes.dedup();
        let expected = first.metric("key_bits").map(|bits| flags.expected(first, bits));
        let agrees = sizes.len() == 1 && expected.is_none_or(|bytes| sizes == [bytes]);
        let outcome = if agrees { Outcome::Agrees } else { Outcome::Contradicts };
        let words: Vec<String> = sizes.iter().map(|bytes| whole(*bytes as f64)).collect();
        let how = if flags.is_allocated { "allocated" } else { "by the thesis's accounting" };
        let numbers = format!("{} bytes {how} on {} scenes and views", words.join(", "), places.len());
        let axis = |name: &str| first.axis(name);
        let keys = match first.metric("key_bits") {
            Some(bits) => format!("keys of {bits:.0} bits"),
            None => format!("{}, tile {}, normals {}", axis("resolution"), axis("tile"), axis("normals")),
        };
        let what = format!("{keys}, unique={}", axis("unique"));
        Some(Case { scene: "all scenes".into(), what, outcome, numbers })
    };
    Judged::by(Basis::Sizes, groups.iter().filter_map(of).collect())
}
