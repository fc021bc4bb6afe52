//! What tables, figures and claims are made of: numbers by scene, structure, variant and device. The published numbers
//! and those of recorded runs have the same form, so that everything is computed of both in the same way.

use super::convention::Steps;
use super::number::Number;
use super::scenes::{SceneKey, ThesisScene};
use super::variant::Variant;
use super::workload::Workload;
use crate::workloads::trace::Properties;
use crate::workloads::trace::backend::{Config, DeviceType};
use std::cmp::Reverse;

/// The structures of the thesis, in its order.
pub const STRUCTURES: [&str; 3] = ["grid", "kdtree", "bvh"];

/// The thesis's name for a structure, as a table's heading.
pub fn structure_title(structure: &str) -> &str {
    match structure {
        "kdtree" => "kd-tree",
        "bvh" => "BVH",
        other => other,
    }
}

/// All numbers of one source.
#[derive(Clone, Debug, Default)]
pub struct Data {
    /// True for what the thesis printed.
    pub published: bool,
    /// Devices, in the order of the runs.
    pub devices: Vec<Device>,
    /// Scenes: the thesis's in its order, then the others by name.
    pub scenes: Vec<Scene>,
    /// Frame times, one per configuration.
    pub frames: Vec<Frame>,
    /// Counts per ray.
    pub counts: Vec<Counts>,
    /// Built structures, each once by every processor and number of threads.
    pub built: Vec<Built>,
    /// Measurements without a usable result.
    pub failures: Vec<Failure>,
    /// The register limit's rows of tables 5.7 and 5.8: only the thesis has them.
    pub register_limit: Vec<RegisterLimit>,
    /// What a reader should know about the source as a whole.
    pub notes: Vec<String>,
}

/// A device that was measured.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Device {
    /// Name in titles and columns; unique.
    pub label: String,
    /// Kind; `None` for the thesis's cards.
    pub kind: Option<DeviceType>,
    /// Driver, processor, system and the like, by heading; empty where unknown.
    pub facts: Vec<(&'static str, String)>,
    /// True if kernels had wgpu's checks in at least one of the rows that are used.
    pub checked: bool,
}

impl Device {
    /// True if its times say nothing about a GPU: the CPU twins and software rasterisers.
    pub fn is_software(&self) -> bool {
        matches!(self.kind, Some(DeviceType::CpuTwin | DeviceType::SoftwareRasteriser))
    }
}

/// A scene that occurs.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Which.
    pub key: SceneKey,
    /// Triangles.
    pub triangles: u64,
    /// Vertices.
    pub vertices: u64,
    /// Lights, where known.
    pub lights: Option<u64>,
    /// Share of the surface that mirrors, 0 to 1, where known.
    pub mirror_share: Option<f64>,
}

/// Frame times of one configuration, in milliseconds.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Index into [`Data::devices`].
    pub device: usize,
    /// Scene.
    pub scene: SceneKey,
    /// Structure's name.
    pub structure: String,
    /// Its options.
    pub variant: Variant,
    /// Rays.
    pub config: Config,
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// What its frames show.
    pub workload: Workload,
    /// Fastest frame.
    pub min_ms: f64,
    /// Slowest frame.
    pub max_ms: f64,
    /// Mean over frames.
    pub mean_ms: f64,
    /// Decimals of the three, where they were printed.
    pub places: Option<[usize; 3]>,
    /// Spread over passes in percent; `None` after a single pass.
    pub noise_pct: Option<f64>,
    /// True if an earlier measurement of the same was replaced by this one.
    pub repeated: bool,
}

/// Averages per ray of one type. A device that rounds in another way counts other numbers, so they belong to one.
#[derive(Clone, Debug, PartialEq)]
pub struct Counts {
    /// Index into [`Data::devices`].
    pub device: usize,
    /// Rays that were traced; counts of primary rays exist under all three.
    pub config: Config,
    /// Scene.
    pub scene: SceneKey,
    /// Structure's name.
    pub structure: String,
    /// Its options.
    pub variant: Variant,
    /// Ray type: 0 primary, 1 shadow, 2 reflected.
    pub ray: usize,
    /// Side of the square image in pixels that they were counted at.
    pub resolution: u32,
    /// Traversal steps.
    pub steps: Steps,
    /// Ray/triangle tests.
    pub tests: f64,
    /// Restarts, where the structure has them.
    pub restarts: Option<f64>,
}

/// A built structure.
#[derive(Clone, Debug, PartialEq)]
pub struct Built {
    /// Scene.
    pub scene: SceneKey,
    /// Structure's name.
    pub structure: String,
    /// Its options.
    pub variant: Variant,
    /// Its properties; the thesis has some of them.
    pub properties: Properties,
    /// Build time in milliseconds.
    pub build_ms: Option<f64>,
    /// Its decimals, where it was printed.
    pub places: Option<usize>,
    /// Threads that built it.
    pub threads: Option<usize>,
    /// How often it was built: the time is the median.
    pub builds: usize,
    /// Processor that built it.
    pub processor: String,
    /// MiB by the thesis's accounting, geometry included.
    pub thesis_mib: Option<f64>,
    /// MiB as allocated, geometry included.
    pub allocated_mib: Option<f64>,
    /// True if an earlier one was replaced by this one.
    pub repeated: bool,
}

/// A configuration without a number.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure {
    /// Scene.
    pub scene: SceneKey,
    /// Index into [`Data::devices`].
    pub device: usize,
    /// Structure with its options, rays and size, in words.
    pub what: String,
    /// Structure's name.
    pub structure: String,
    /// Its options.
    pub variant: Variant,
    /// Rays.
    pub config: Config,
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Why.
    pub message: String,
}

/// A row of table 5.7 or 5.8.
#[derive(Clone, Debug, PartialEq)]
pub struct RegisterLimit {
    /// Index into [`Data::devices`].
    pub device: usize,
    /// Scene.
    pub scene: ThesisScene,
    /// Structure's name.
    pub structure: String,
    /// Registers per thread.
    pub registers: u32,
    /// Occupancy in percent.
    pub occupancy: u32,
    /// Mean frame time.
    pub mean_ms: f64,
    /// Speed-up by the limit, as printed.
    pub speedup: Option<i32>,
}

/// The configuration whose column shows a ray type: the one that adds it (SPEC section 6).
pub fn adding(ray: usize) -> Config {
    Config::ALL[ray.min(2)]
}

impl Frame {
    /// Fastest, slowest and mean frame, as they are written.
    pub fn times(&self) -> [Number; 3] {
        let of = |index: usize, value| Number { value, places: self.places.map(|places| places[index]) };
        [of(0, self.min_ms), of(1, self.max_ms), of(2, self.mean_ms)]
    }
}

impl Counts {
    fn is(&self, scene: &SceneKey, structure: &str, variant: &Variant, ray: usize) -> bool {
        self.ray == ray && self.structure == structure && self.scene == *scene && self.variant == *variant
    }
}

impl Data {
    /// The frame times of a configuration with a square image of `side` pixels.
    pub fn frame(
        &self,
        device: usize,
        scene: &SceneKey,
        (structure, variant): (&str, &Variant),
        config: Config,
        side: u32,
    ) -> Option<&Frame> {
        self.frames.iter().find(|f| {
            (f.device, f.config, f.width, f.height) == (device, config, side, side)
                && f.structure == structure
                && f.scene == *scene
                && f.variant == *variant
        })
    }

    /// The same as the thesis would have measured it: default options, or its own resolution of the grid.
    pub fn thesis_frame(
        &self,
        device: usize,
        scene: &SceneKey,
        structure: &str,
        config: Config,
        side: u32,
    ) -> Option<&Frame> {
        self.frame(device, scene, (structure, &Variant::of_thesis(scene.thesis(), structure)), config, side)
    }

    /// Counts of a ray type, with the thesis's options.
    pub fn thesis_counts(&self, scene: &SceneKey, structure: &str, ray: usize) -> Option<&Counts> {
        self.counts_of(scene, structure, &Variant::of_thesis(scene.thesis(), structure), ray)
    }

    /// Counts of a ray type at the largest resolution, under the configuration that adds it; of several devices those of
    /// the first.
    pub fn counts_of(&self, scene: &SceneKey, structure: &str, variant: &Variant, ray: usize) -> Option<&Counts> {
        let wanted = |c: &&Counts| c.config == adding(ray) && c.is(scene, structure, variant, ray);
        self.counts.iter().filter(wanted).max_by_key(|c| (c.resolution, Reverse(c.device)))
    }

    /// Counts of the same measurement as `other` but with these options.
    pub fn counts_beside(&self, other: &Counts, variant: &Variant) -> Option<&Counts> {
        self.counts.iter().find(|c| {
            (c.device, c.config, c.resolution) == (other.device, other.config, other.resolution)
                && c.is(&other.scene, &other.structure, variant, other.ray)
        })
    }

    /// Counts of a ray type that belong to a frame time.
    pub fn counts_behind(&self, frame: &Frame, ray: usize) -> Option<&Counts> {
        self.counts.iter().find(|c| {
            (c.device, c.config, c.resolution) == (frame.device, frame.config, frame.width)
                && frame.width == frame.height
                && c.is(&frame.scene, &frame.structure, &frame.variant, ray)
        })
    }

    /// Sides of the square images that were measured on a device, from the smallest.
    pub fn sides(&self, device: usize) -> Vec<u32> {
        let square = self.frames.iter().filter(|f| f.device == device && f.width == f.height);
        let mut sides: Vec<u32> = square.map(|f| f.width).collect();
        sides.sort_unstable();
        sides.dedup();
        sides
    }

    /// A scene's entry.
    pub fn scene(&self, key: &SceneKey) -> Option<&Scene> {
        self.scenes.iter().find(|s| s.key == *key)
    }
}
