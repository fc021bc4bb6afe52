//! The numbers that the thesis printed, from `results/thesis-2009`, compiled in.

use super::data::{Built, Counts, Data, Device, Frame, RegisterLimit, Scene, config_adding};
use super::scenes::{SceneKey, ThesisScene};
use super::structures::{BVH, GRID, KDTREE};
use super::variant::Variant;
use crate::compare::pair::Conditions;
use crate::report::Number;
use crate::sources::convention::Steps;
use crate::workloads::trace::Properties;
use crate::workloads::trace::backend::{Config, RAY_TYPES};
use serde::Deserialize;
use serde::de::DeserializeOwned;

/// The faster of the two devices, of tables 5.8 to 5.14 and B.1 to B.3.
pub const GTX280: &str = "GTX280";
/// The slower one, of tables 5.7 and B.4 to B.6 and of figure 5.2.
pub const GT8600: &str = "8600GT";

/// The index of a card by its full name.
pub fn device_of(gpu: &str) -> Option<usize> {
    let name = gpu.replace(' ', "");
    super::SOURCE.devices.iter().position(|device| name.ends_with(device))
}

/// A file of `results/thesis-2009`, by its name there.
macro_rules! file {
    ($name:literal) => {
        ($name, include_str!(concat!("../../../results/thesis-2009/", $name)))
    };
}

#[derive(Deserialize)]
struct SceneRow {
    scene: String,
    triangles: u64,
    vertices: u64,
    lights: Option<u64>,
}

#[derive(Deserialize)]
struct DeviceRow {
    device: String,
    compute_capability: String,
    processors: u32,
    clock_mhz: u32,
    memory_mb: u32,
    bandwidth_gb_s: f64,
}

#[derive(Deserialize)]
struct BuildRow {
    scene: String,
    grid_ms: Number,
    kdtree_ms: Number,
    bvh_ms: Number,
}

/// A row of any of the three property files: the columns are those of [`Properties`], and the size.
#[derive(Deserialize)]
struct PropertyRow {
    scene: String,
    cells_x: Option<u32>,
    cells_y: Option<u32>,
    cells_z: Option<u32>,
    max_cell_triangles: Option<u32>,
    references_per_triangle: Option<f64>,
    leaves: Option<u32>,
    empty_leaves: Option<u32>,
    max_leaf_triangles: Option<u32>,
    nodes: Option<u32>,
    size_mib: f64,
}

#[derive(Deserialize)]
struct CountRow {
    structure: String,
    scene: String,
    ray_type: String,
    steps_per_ray: f64,
    primitive_tests_per_ray: f64,
    restarts_per_ray: Option<f64>,
}

#[derive(Deserialize)]
struct FrameRow {
    device: String,
    config: Config,
    scene: String,
    resolution: u32,
    structure: String,
    min_ms: Number,
    max_ms: Number,
    mean_ms: Number,
}

#[derive(Deserialize)]
struct LimitRow {
    device: String,
    scene: String,
    structure: String,
    registers: u32,
    occupancy_percent: u32,
    mean_ms: f64,
    speedup_percent: Option<i32>,
}

/// All rows of a compiled-in file; the tests read every one of them.
fn rows<T: DeserializeOwned>((name, text): (&str, &str)) -> Vec<T> {
    let rows: Result<Vec<T>, csv::Error> = csv::Reader::from_reader(text.as_bytes()).deserialize().collect();
    rows.unwrap_or_else(|e| panic!("results/thesis-2009/{name}, which is compiled in, is damaged: {e}"))
}

fn scene(name: &str) -> ThesisScene {
    ThesisScene::named(name).unwrap_or_else(|| panic!("results/thesis-2009 names the unknown scene {name}"))
}

/// The published numbers.
pub fn data() -> Data {
    let devices = devices();
    // The files name no other device than those of `devices`
    let device = |name: &str| devices.iter().position(|d| d.label == name).unwrap_or(0);
    let frames = rows(file!("frame_times_ms.csv")).into_iter().map(|row: FrameRow| Frame {
        device: device(&row.device),
        variant: Variant::of_thesis(Some(scene(&row.scene)), &row.structure),
        scene: SceneKey::Thesis(scene(&row.scene)),
        structure: row.structure,
        config: row.config,
        width: row.resolution,
        height: row.resolution,
        conditions: Conditions::default(),
        min_ms: row.min_ms.value,
        max_ms: row.max_ms.value,
        mean_ms: row.mean_ms.value,
        // Every number of this file has its decimals
        places: Some([row.min_ms, row.max_ms, row.mean_ms].map(|n| n.places.unwrap_or(0))),
        noise_pct: None,
        repeated: false,
    });
    let limits = rows(file!("register_limit.csv")).into_iter().map(|row: LimitRow| RegisterLimit {
        device: device(&row.device),
        scene: scene(&row.scene),
        structure: row.structure,
        registers: row.registers,
        occupancy: row.occupancy_percent,
        mean_ms: row.mean_ms,
        speedup: row.speedup_percent,
    });
    Data {
        published: true,
        scenes: scenes(),
        frames: frames.collect(),
        counts: counts().into_iter().collect(),
        built: built().into_iter().collect(),
        register_limit: limits.collect(),
        devices,
        ..Data::default()
    }
}

/// The faster device first: its tables come first.
fn devices() -> Vec<Device> {
    let mut rows: Vec<DeviceRow> = rows(file!("devices.csv"));
    rows.sort_by_key(|row| row.device != GTX280);
    let device = |row: DeviceRow| Device {
        label: row.device,
        facts: vec![
            ("compute capability", row.compute_capability),
            ("processors", row.processors.to_string()),
            ("clock", format!("{} MHz", row.clock_mhz)),
            ("memory", format!("{} MB", row.memory_mb)),
            ("bandwidth", format!("{} GB/s", row.bandwidth_gb_s)),
        ],
        ..Device::default()
    };
    rows.into_iter().map(device).collect()
}

fn scenes() -> Vec<Scene> {
    let scene = |row: SceneRow| Scene {
        key: SceneKey::Thesis(scene(&row.scene)),
        triangles: row.triangles,
        vertices: row.vertices,
        lights: row.lights,
        mirror_share: None,
    };
    rows(file!("scenes.csv")).into_iter().map(scene).collect()
}

fn counts() -> Vec<Counts> {
    let count = |row: CountRow| {
        let ray = RAY_TYPES.iter().position(|name| *name == row.ray_type).unwrap_or(0);
        Counts {
            // Tables 5.9 to 5.11 are of the first device
            device: 0,
            config: config_adding(ray),
            scene: SceneKey::Thesis(scene(&row.scene)),
            variant: Variant::of_thesis(Some(scene(&row.scene)), &row.structure),
            structure: row.structure,
            ray,
            resolution: 1024,
            steps: Steps::Printed(row.steps_per_ray),
            tests: row.primitive_tests_per_ray,
            restarts: row.restarts_per_ray,
        }
    };
    rows(file!("traversal_counts.csv")).into_iter().map(count).collect()
}

/// Tables 5.3 to 5.6.
fn built() -> Vec<Built> {
    type Time = fn(&BuildRow) -> Number;
    let times: Vec<BuildRow> = rows(file!("build_times_ms.csv"));
    let files: [(&str, Time, _); 3] = [
        (GRID, |row| row.grid_ms, file!("grid_properties.csv")),
        (KDTREE, |row| row.kdtree_ms, file!("kdtree_properties.csv")),
        (BVH, |row| row.bvh_ms, file!("bvh_properties.csv")),
    ];
    let mut built = Vec::new();
    for (structure, time, file) in files {
        for row in rows::<PropertyRow>(file) {
            let time = times.iter().find(|times| times.scene == row.scene).map(time);
            built.push(Built {
                scene: SceneKey::Thesis(scene(&row.scene)),
                structure: structure.into(),
                variant: Variant::of_thesis(Some(scene(&row.scene)), structure),
                properties: Properties {
                    cells_x: row.cells_x,
                    cells_y: row.cells_y,
                    cells_z: row.cells_z,
                    max_cell_triangles: row.max_cell_triangles,
                    references_per_triangle: row.references_per_triangle,
                    leaves: row.leaves,
                    empty_leaves: row.empty_leaves,
                    max_leaf_triangles: row.max_leaf_triangles,
                    nodes: row.nodes,
                    ..Properties::default()
                },
                build_ms: time.map(|n| n.value),
                places: time.and_then(|n| n.places),
                threads: Some(1),
                builds: 1,
                processor: "Athlon64 X2, 2 GHz".into(),
                thesis_mib: Some(row.size_mib),
                memory: None,
                repeated: false,
            });
        }
    }
    built
}
