//! Runs of the thesis's scenes and structures.

use rtbench::device::DeviceType;
use rtbench::sources::runs::RecordedRun;
use rtbench::workloads::trace::rays::Config;
use rtbench::workloads::trace::record::{ConfigurationRecord, SceneRecord, StructureRecord};

pub use crate::sources::synthetic::{Builder, sums};

pub fn scene(name: &str) -> SceneRecord {
    let (name, triangles, vertices, mirror_share) = match name {
        "bunny" => ("bun_zipper", 69_451, 35_947, 0.0),
        "dragon" => ("dragon_vrip", 871_414, 437_645, 0.0),
        "robots" => ("robots", 71_708, 136_640, 0.1),
        "museum" => ("museum", 14_380, 17_889, 0.2),
        "conference" => ("conference", 207_512, 229_642, 0.05),
        other => (other, 5000, 2500, 0.0),
    };
    SceneRecord { name: name.into(), triangles, vertices, lights: 1, mirror_share, ..SceneRecord::default() }
}

impl Builder {
    /// A measurement of a square image.
    pub fn frame(
        &mut self,
        name: &str,
        structure: &str,
        config: Config,
        side: u32,
        ms: f64,
    ) -> &mut ConfigurationRecord {
        self.row(scene(name), structure, config, (side, side), ms)
    }

    /// Grid, kd-tree and BVH at once.
    pub fn trio(&mut self, name: &str, config: Config, side: u32, [grid, kdtree, bvh]: [f64; 3]) {
        let grid_name = if name == "robots" { "grid:x=128" } else { "grid" };
        self.frame(name, grid_name, config, side, grid);
        self.frame(name, "kdtree", config, side, kdtree);
        self.frame(name, "bvh", config, side, bvh);
    }

    /// A built structure: build time, size in MiB, and for grids the cells on every side.
    pub fn built(&mut self, name: &str, structure: &str, ms: f64, mib: f64, cells: u32) -> &mut StructureRecord {
        let record = self.structure(scene(name), structure, ms);
        record.memory.thesis_bytes = (mib * f64::from(1 << 20)) as u64;
        record.memory.structure_bytes = record.memory.thesis_bytes;
        let is_grid = record.structure == "grid";
        let p = &mut record.properties;
        if is_grid {
            (p.cells_x, p.cells_y, p.cells_z) = (Some(cells), Some(2 * cells), Some(3 * cells));
        } else {
            (p.leaves, p.nodes) = (Some(7), Some(13));
        }
        p.references_per_triangle = Some(9.0);
        p.max_cell_triangles = is_grid.then_some(1000);
        record
    }
}

/// A bit of everything that tables, figures and claims can show.
pub fn everything() -> Vec<RecordedRun> {
    let mut first = Builder::new();
    for (name, grid) in
        [("bunny", "grid"), ("robots", "grid:x=128"), ("museum", "grid"), ("conference", "grid"), ("hall", "grid")]
    {
        first.built(name, grid, 10.0, 30.0, 16);
        first.built(name, "kdtree", 90.0, 20.0, 0);
        first.built(name, "bvh", 30.0, 10.0, 0);
        for (config, factor) in [(Config::P, 1.0), (Config::PS, 2.0), (Config::PSR, 3.0)] {
            if name == "bunny" && config == Config::PSR {
                continue;
            }
            for side in [256, 512, 1024] {
                let ms = factor * f64::from(side) / 100.0;
                first.trio(name, config, side, [3.0 * ms, 2.0 * ms, ms]);
            }
        }
    }
    for (structure, ms) in [
        ("grid:factor=2", 40.0),
        ("grid:factor=8", 36.0),
        ("kdtree:search=restart", 60.0),
        ("bvh:shadows=to-light", 30.0),
    ] {
        first.frame("bunny", structure, Config::P, 1024, ms);
    }
    first.built("bunny", "grid:factor=2", 10.0, 30.0, 8);
    first.built("bunny", "grid:factor=8", 10.0, 30.0, 32);
    for side in [256, 300, 400] {
        first.frame("bunny", "bvh:pattern=four", Config::P, side, f64::from(side) / 50.0);
        first.frame("bunny", "bvh:tiles=2", Config::P, side, f64::from(side) / 40.0);
        first.frame("bunny", "bvh:tiles=4", Config::P, side, f64::from(side) / 30.0);
    }
    first.frame("museum", "kdtree:memory=private", Config::PSR, 1024, 45.0);
    first.frame("museum", "grid:group=16x4", Config::PSR, 1024, 99.0);
    let mut second = Builder::new().device("Slow GPU", DeviceType::IntegratedGpu);
    second.trio("bunny", Config::P, 512, [60.0, 50.0, 40.0]);
    second.trio("museum", Config::PSR, 512, [60.0, 50.0, 40.0]);
    second.frame("museum", "bvh:group=32x2", Config::PSR, 512, 44.0);
    vec![first.run, second.run]
}
