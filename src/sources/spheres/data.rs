//! The numbers behind tables, figures and claims: measurements of a machine, by scene and setting.

use super::scenes::{Role, SceneKey};
use super::setting::{Renderer, Setting, Stage, Version};
use crate::compare::judge::{UNKNOWN_NOISE_PCT, Uncertain};
use crate::report::Number;
use crate::sources::rows::Device;
use std::collections::HashMap;

/// What rows must have in common to be compared, in addition to the scene and the precision.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Terms {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Most rays along a path.
    pub trips: u32,
    /// Frames of a period of the orbit.
    pub frames: usize,
    /// Timed passes.
    pub passes: usize,
    /// Untimed frames before each pass.
    pub warmup_frames: usize,
}

/// A machine, with one of its GPUs where it has any.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Index of the processor among the devices.
    pub machine: usize,
    /// Index of the GPU, or of the driver that computes on the processor.
    pub gpu: Option<usize>,
}

/// What the frames of a row consist of, over all frames of a pass.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Work {
    /// Live rays and their hits, by bounce.
    pub bounces: Vec<(u64, u64)>,
    /// Live rays times spheres.
    pub tests: u64,
    /// The same of searches for dead paths and for lanes beyond the end of a row.
    pub wasted_tests: u64,
    /// Searches of whole vectors.
    pub vectors: u64,
    /// Share of lanes with a live ray.
    pub occupancy: Option<f64>,
    /// Paths, or vectors of paths, that ended at a miss.
    pub exits_on_miss: u64,
    /// Spheres of a vector's search for which nothing was stored.
    pub skips_no_hit: u64,
    /// The same without root and division.
    pub skips_no_discriminant: u64,
    /// What the renderer runs on.
    pub instructions: String,
}

/// Frame times of a row, in milliseconds.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // The names of most fields say what they are
pub struct Measurement {
    /// Index of the processor of the row's machine.
    pub machine: usize,
    /// Index of the device that rendered.
    pub device: usize,
    pub scene: SceneKey,
    pub setting: Setting,
    /// Threads that rendered; `None` for renderers without a pool.
    pub threads: Option<usize>,
    pub terms: Terms,
    pub mean_ms: f64,
    pub min_ms: f64,
    pub max_ms: f64,
    /// Decimals of the mean, if it was printed.
    pub places: Option<usize>,
    /// Spread over passes in percent; `None` after a single pass.
    pub noise_pct: Option<f64>,
    pub work: Option<Work>,
    /// True if it replaced an earlier one of the same.
    pub repeated: bool,
}

/// A picture of half precision, compared with that of single precision.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // The names of most fields say what they are
pub struct HalfPicture {
    pub machine: usize,
    pub device: usize,
    pub scene: SceneKey,
    pub setting: Setting,
    pub terms: Terms,
    /// Root of the mean squared difference of linear RGB clamped to 0 to 1.
    pub rmse: f64,
    /// Largest difference, if it was recorded.
    pub largest: Option<f64>,
}

/// A row without a number.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // The names of the fields say what they are
pub struct Failure {
    pub machine: usize,
    pub device: usize,
    pub scene: SceneKey,
    pub setting: Setting,
    pub terms: Terms,
    pub message: String,
}

/// What two measurements of the same have in common.
type Identity = (usize, usize, Terms, SceneKey, Setting);

/// All numbers of runs.
#[derive(Clone, Debug, Default)]
pub struct Data {
    /// Processors and GPUs, in the order of the runs.
    pub devices: Vec<Device>,
    /// Threads of each device; `None` where not known.
    pub threads: Vec<Option<usize>>,
    /// What tables are made for.
    pub places: Vec<Place>,
    /// Rows with times.
    pub measurements: Vec<Measurement>,
    /// Their indices.
    known: HashMap<Identity, usize>,
    /// Pictures of half precision.
    pub halves: Vec<HalfPicture>,
    /// Rows without a usable result.
    pub failures: Vec<Failure>,
    /// What a reader should know about the runs as a whole.
    pub notes: Vec<String>,
}

impl Terms {
    /// Size, trips, frames and passes in words.
    pub fn in_words(&self) -> String {
        let counted = |number: usize, one: &str, more: &str| {
            if number == 1 { format!("1 {one}") } else { format!("{number} {more}") }
        };
        let trips = counted(self.trips as usize, "trip", "trips");
        let frames = counted(self.frames, "frame", "frames");
        format!("{}x{}, {trips}, {frames}, {}", self.width, self.height, counted(self.passes, "pass", "passes"))
    }
}

impl Place {
    /// True for a device of this place.
    pub fn has(&self, machine: usize, device: usize) -> bool {
        self.machine == machine && (device == machine || self.gpu == Some(device))
    }
}

impl Measurement {
    /// The mean time with its noise.
    pub fn time(&self) -> Uncertain {
        Uncertain::time(self.mean_ms, self.noise_pct.unwrap_or(UNKNOWN_NOISE_PCT))
    }

    /// The mean time as it was printed or measured.
    pub fn number(&self) -> Number {
        Number { value: self.mean_ms, places: self.places }
    }
}

impl Data {
    /// No numbers yet, of these devices with their numbers of threads.
    pub fn with_devices(devices: Vec<Device>, threads: Vec<Option<usize>>) -> Data {
        Data { devices, threads, ..Data::default() }
    }

    /// Adds a measurement in place of an earlier one of the same.
    pub fn put(&mut self, mut new: Measurement) {
        let identity = (new.machine, new.device, new.terms, new.scene.clone(), new.setting.clone());
        match self.known.get(&identity) {
            Some(&index) => {
                new.repeated = true;
                self.measurements[index] = new;
            }
            None => {
                self.known.insert(identity, self.measurements.len());
                self.measurements.push(new);
            }
        }
    }

    /// The rows of a place that `of` accepts, at the terms that most of these rows have; of equals the largest image,
    /// then the most trips and frames. `width` asks for the width of the image.
    pub fn view(&self, place: Place, width: Option<u32>, of: impl Fn(&Measurement) -> bool) -> View<'_> {
        let at_place = || self.measurements.iter().filter(|m| place.has(m.machine, m.device));
        let of_width = |terms: &Terms| width.is_none_or(|width| terms.width == width);
        let all: Vec<Terms> = at_place().filter(|m| of(m)).map(|m| m.terms).filter(of_width).collect();
        let rows = |terms: &Terms| all.iter().filter(|other| *other == terms).count();
        let terms = all.iter().copied().max_by_key(|terms| (rows(terms), *terms));
        View { data: self, place, terms: terms.unwrap_or(Terms { width: width.unwrap_or(0), ..Terms::default() }) }
    }

    /// The same for the rows of the paper's tables: single precision on its own scenes, or on any where none of them
    /// was measured.
    pub fn main_view(&self, place: Place, width: Option<u32>) -> View<'_> {
        let of_paper = |m: &Measurement| !m.setting.half && m.scene.is_of_paper();
        let view = self.view(place, width, of_paper);
        if view.rows().next().is_some() { view } else { self.view(place, width, |m| !m.setting.half) }
    }
}

/// Rows that can be compared: those of a place at equal terms.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// All numbers.
    pub data: &'a Data,
    /// The place.
    pub place: Place,
    /// What the rows have in common.
    pub terms: Terms,
}

impl<'a> View<'a> {
    /// The rows.
    pub fn rows(&self) -> impl Iterator<Item = &'a Measurement> + use<'a> {
        let (place, terms) = (self.place, self.terms);
        self.data.measurements.iter().filter(move |m| place.has(m.machine, m.device) && m.terms == terms)
    }

    /// Scenes with rows, in the order of tables.
    pub fn scenes(&self) -> Vec<SceneKey> {
        let mut scenes: Vec<SceneKey> = self.rows().map(|m| m.scene.clone()).collect();
        scenes.sort();
        scenes.dedup();
        scenes
    }

    /// The scene of a role; of several, the first.
    pub fn scene(&self, role: Role) -> Option<SceneKey> {
        self.scenes().into_iter().find(|scene| scene.role == role)
    }

    /// Threads of the machine; `None` where not known.
    pub fn all_threads(&self) -> Option<usize> {
        self.data.threads.get(self.place.machine).copied().flatten()
    }

    /// True for a row whose pool has the machine's number of threads, or that has no pool.
    pub fn has_all_threads(&self, m: &Measurement) -> bool {
        m.setting.threads.is_none() || m.setting.threads == self.all_threads()
    }

    /// The row with the switches of a setting and all threads of the machine. Of several levels of instructions it is
    /// the one chosen by the program, then the one of 128 bits.
    pub fn like(&self, scene: &SceneKey, setting: &Setting) -> Option<&'a Measurement> {
        let level = |level: &str| match level {
            "" => 0,
            "sse2" | "neon" => 1,
            _ => 2,
        };
        let is = |m: &&Measurement| m.scene == *scene && m.setting.is_like(setting) && self.has_all_threads(m);
        self.rows().filter(is).min_by_key(|m| (level(&m.setting.level), m.setting.threads))
    }

    /// A renderer's row in a version.
    pub fn version(&self, scene: &SceneKey, renderer: Renderer, version: Version) -> Option<&'a Measurement> {
        self.like(scene, &Setting::in_version(renderer, version))
    }

    /// A renderer's row in a stage of the paper's structure.
    pub fn stage(&self, scene: &SceneKey, renderer: Renderer, stage: Stage) -> Option<&'a Measurement> {
        self.version(scene, renderer, stage.version())
    }

    /// Processors of a row, and how they are counted: threads, lanes, or both. A GPU has none of its own.
    pub fn processors(&self, m: &Measurement) -> Option<(usize, String)> {
        let threads = || m.threads.or_else(|| self.all_threads());
        let threads_in_words = |n: usize| if n == 1 { "1 thread".to_owned() } else { format!("{n} threads") };
        let lanes = m.setting.lanes;
        match m.setting.renderer {
            Renderer::Sequential => Some((1, "one thread".into())),
            Renderer::Threads => threads().map(|n| (n, threads_in_words(n))),
            Renderer::Simd => Some((lanes, format!("{lanes} lanes"))),
            Renderer::SimdThreads => threads().map(|n| (n * lanes, format!("{} x {lanes} lanes", threads_in_words(n)))),
            Renderer::Gpu => None,
        }
    }
}
