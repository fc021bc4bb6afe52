//! The numbers behind tables, figures and claims, by scene, structure, variant and device. Published and measured
//! numbers have the same form, so that the same code reads both.

#![allow(missing_docs)] // The names of most fields say what they are

use super::indexed::Indexed;
use super::scenes::{SceneKey, ThesisScene};
use super::variant::Variant;
use crate::sources::convention::Steps;
use crate::sources::rows;
use crate::workloads::trace::backend::Config;
use std::cmp::Reverse;

pub use crate::sources::rows::Device;

/// All numbers of the thesis, or of runs.
#[derive(Clone, Debug, Default)]
pub struct Data {
    /// True for the numbers that the thesis printed.
    pub published: bool,
    /// True for what the SIMT model computes for a GPU: in place of frame times there are millions of issued
    /// instructions over resident warps, and no counts.
    pub modelled: bool,
    /// Devices, in the order of the runs.
    pub devices: Vec<Device>,
    /// The thesis's scenes in its order, then the others by name.
    pub scenes: Vec<Scene>,
    /// Frame times, one per configuration.
    pub frames: Indexed<Frame>,
    /// Counts per ray.
    pub counts: Indexed<Counts>,
    /// Built structures, each once by every processor and number of threads.
    pub built: Indexed<Built>,
    /// Measurements without a usable result.
    pub failures: Vec<Failure>,
    /// Rows of tables 5.7 and 5.8: only the thesis could limit registers.
    pub register_limit: Vec<RegisterLimit>,
    /// What a reader should know about the runs as a whole.
    pub notes: Vec<String>,
}

/// A scene with its properties.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    pub key: SceneKey,
    pub triangles: u64,
    pub vertices: u64,
    /// `None` where unknown.
    pub lights: Option<u64>,
    /// Share of the surface that mirrors, 0 to 1; `None` where unknown.
    pub mirror_share: Option<f64>,
}

/// Frame times of one configuration.
pub type Frame = rows::Frame<SceneKey>;

/// A built structure.
pub type Built = rows::Built<SceneKey>;

/// A configuration without a number.
pub type Failure = rows::Failure<SceneKey>;

/// Averages per ray of one type. A device that rounds in another way counts other numbers, so they belong to one.
#[derive(Clone, Debug, PartialEq)]
pub struct Counts {
    /// Index into [`Data::devices`].
    pub device: usize,
    /// Rays that were traced; counts of primary rays exist under all three.
    pub config: Config,
    pub scene: SceneKey,
    pub structure: String,
    pub variant: Variant,
    /// Ray type: 0 primary, 1 shadow, 2 reflected.
    pub ray: usize,
    /// Side of the square image that the rays belong to.
    pub resolution: u32,
    pub steps: Steps,
    pub tests: f64,
    /// `None` for a structure without restarts.
    pub restarts: Option<f64>,
}

/// A row of table 5.7 or 5.8.
#[derive(Clone, Debug, PartialEq)]
pub struct RegisterLimit {
    /// Index into [`Data::devices`].
    pub device: usize,
    pub scene: ThesisScene,
    pub structure: String,
    pub registers: u32,
    /// In percent.
    pub occupancy: u32,
    pub mean_ms: f64,
    /// Speed-up by the limit, as printed.
    pub speedup: Option<i32>,
}

/// The ray configurations of the thesis, in its order.
pub const CONFIGS: [Config; 3] = [Config::P, Config::PS, Config::PSR];

/// The configuration whose column shows a ray type: the one that adds it, as in tables 5.9 to 5.11.
pub fn config_adding(ray: usize) -> Config {
    CONFIGS[ray.min(2)]
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
        self.frames.of(scene, structure, variant).find(|f| {
            (f.device, f.config, f.width, f.height) == (device, config, side, side)
                && f.structure == structure
                && f.scene == *scene
                && f.variant == *variant
        })
    }

    /// The same with the thesis's options: the defaults, or its own resolution of the grid.
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

    /// Counts of a ray type at the largest resolution, under the configuration that adds it; of several devices those
    /// of the first.
    pub fn counts_of(&self, scene: &SceneKey, structure: &str, variant: &Variant, ray: usize) -> Option<&Counts> {
        let wanted = |c: &&Counts| c.config == config_adding(ray) && c.is(scene, structure, variant, ray);
        self.counts.of(scene, structure, variant).filter(wanted).max_by_key(|c| (c.resolution, Reverse(c.device)))
    }

    /// Counts of the same measurement as `other`, but with these options.
    pub fn counts_with(&self, other: &Counts, variant: &Variant) -> Option<&Counts> {
        self.counts.of(&other.scene, &other.structure, variant).find(|c| {
            (c.device, c.config, c.resolution) == (other.device, other.config, other.resolution)
                && c.is(&other.scene, &other.structure, variant, other.ray)
        })
    }

    /// Counts of a ray type that belong to a frame time.
    pub fn counts_of_frame(&self, frame: &Frame, ray: usize) -> Option<&Counts> {
        self.counts.of(&frame.scene, &frame.structure, &frame.variant).find(|c| {
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

    /// The properties of a scene.
    pub fn scene(&self, key: &SceneKey) -> Option<&Scene> {
        self.scenes.iter().find(|s| s.key == *key)
    }
}
