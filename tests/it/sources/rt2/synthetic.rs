//! Runs of the document's counterparts and structures.

use rtbench::sources::rt2::structures::{
    BIH, BVH, CULLED, MIN_MAX, ROPES, SORT, SPATIAL, STACK, SWEEP, Structure, UNPUSHED,
};
use rtbench::sources::runs::RecordedRun;
use rtbench::workloads::trace::rays::Config;
use rtbench::workloads::trace::record::{ConfigurationRecord, CounterSums, SceneRecord, StructureRecord, by_ray_type};

pub use crate::sources::synthetic::Builder;

/// The document's size.
pub const SIZE: (u32, u32) = (1408, 768);

/// A scene by a short name.
pub fn scene(name: &str) -> SceneRecord {
    let (name, triangles) = match name {
        "alien" => ("scan:triangles=31600", 32_168),
        "even" => ("scan:triangles=104000", 107_516),
        "spiky" => ("scan:triangles=104000,spikes=1000", 108_000),
        "large" => ("scan:triangles=837000", 847_216),
        "dragon" => ("dragon", 871_414),
        "bunny" => ("bunny", 69_451),
        "room" => ("room:triangles=80000", 78_017),
        "flake" => ("sphereflake:triangles=107000", 106_688),
        other => (other, 5000),
    };
    SceneRecord { name: name.into(), triangles, vertices: triangles / 2, ..SceneRecord::default() }
}

/// Counts of a hundred primary rays with so many steps each.
pub fn steps(per_ray: u64) -> CounterSums {
    let (inner, leaves) = (75 * per_ray, 25 * per_ray);
    CounterSums { rays: 100, inner, leaves, tests: 300, ..CounterSums::default() }
}

impl Builder {
    /// A frame of the document's size.
    pub fn shot(&mut self, name: &str, structure: &Structure, ms: f64) -> &mut ConfigurationRecord {
        self.row(scene(name), &structure.selection(), Config::P, SIZE, ms)
    }

    /// The same, with so many steps per primary ray.
    pub fn walk(&mut self, name: &str, structure: &Structure, ms: f64, per_ray: u64) {
        self.shot(name, structure, ms).counters = Some(by_ray_type([steps(per_ray), steps(0), steps(0)]));
    }

    /// A tree with a build time in milliseconds, bytes of the model and leaves.
    pub fn tree(&mut self, name: &str, tree: &Structure, ms: f64, bytes: u64, leaves: u32) -> &mut StructureRecord {
        let record = self.structure(scene(name), &tree.selection(), ms);
        record.memory.rt2_bytes = bytes;
        record.memory.structure_bytes = 2 * bytes;
        record.properties.leaves = Some(leaves);
        record.properties.references_per_triangle = Some(2.0);
        record.properties.sah_cost = Some(30.0);
        record
    }
}

/// Everything that tables, figures and claims can show, as the document has it.
pub fn everything() -> RecordedRun {
    let mut b = Builder::new();
    for (name, lead) in
        [("alien", 1.18), ("even", 1.1), ("spiky", 1.03), ("dragon", 1.3), ("large", 1.3), ("room", 0.9)]
    {
        for (structure, ms, per_ray) in [
            (&ROPES, 9.0, 9),
            (&STACK, 10.0, 12),
            (&BVH, 10.0 * lead, 20),
            (&CULLED, 8.0, 10),
            (&UNPUSHED, 9.5, 12),
            (&SPATIAL, 7.0, 8),
            (&BIH, 30.0, 40),
        ] {
            b.walk(name, structure, ms, per_ray);
        }
        let triangles = scene(name).triangles;
        let leaves = if name == "spiky" { 3 * triangles } else { triangles };
        let kdtree = 20 * leaves;
        let bvh = 45 * triangles;
        let build = match name {
            "dragon" | "large" => 113.0,
            "even" | "spiky" => 25.0,
            _ => 45.0,
        };
        for tree in [&STACK, &SORT] {
            b.tree(name, tree, 100.0, kdtree, leaves as u32);
        }
        b.tree(name, &ROPES, 120.0, kdtree + 48 * leaves, leaves as u32);
        b.tree(name, &UNPUSHED, 110.0, kdtree + 48 * leaves, leaves as u32);
        b.tree(name, &MIN_MAX, 20.0, kdtree, leaves as u32);
        for tree in [&BVH, &CULLED, &SWEEP] {
            b.tree(name, tree, build, bvh, 7);
        }
        let spatial = b.tree(name, &SPATIAL, 200.0, bvh, 7);
        (spatial.properties.spatial_splits, spatial.properties.spatial_overlap) = (Some(5), Some(0.0));
        b.tree(name, &BIH, 5.0, 15 * triangles, 7);
    }
    b.run
}
