//! What the paper printed, from `results/spheres-paper`, compiled in: the times in the form of measurements, so that
//! the same code reads both, and the metrics.

use super::data::{Data, Measurement, Place, Terms};
use super::scenes::{Role, SceneKey};
use super::setting::{Renderer, Setting, Stage};
use crate::report::Number;
use crate::sources::rows::Device;
use serde::Deserialize;
use serde::de::DeserializeOwned;

/// A file of `results/spheres-paper`, by its name there.
macro_rules! file {
    ($name:literal) => {
        ($name, include_str!(concat!("../../../results/spheres-paper/", $name)))
    };
}

/// A printed time.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Time {
    /// The version.
    pub stage: Stage,
    /// The scene's name.
    pub scene: String,
    /// Its number of spheres.
    pub spheres: u64,
    /// The renderer.
    pub renderer: Renderer,
    /// Mean milliseconds per frame.
    pub mean_ms: Number,
}

/// Printed metrics.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Metrics {
    /// The version.
    pub stage: Stage,
    /// The scene's name.
    pub scene: String,
    /// The renderer.
    pub renderer: Renderer,
    /// Number of processors.
    pub processors: u32,
    /// Speed-up over sequential.
    pub speed_up: Number,
    /// Karp-Flatt metric.
    pub karp_flatt: Number,
}

/// The number of processors of a renderer.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Processors {
    /// The renderer.
    pub renderer: Renderer,
    /// The number.
    pub processors: u32,
    /// How it is counted.
    pub counted_as: String,
}

/// Everything that was printed.
#[derive(Clone, Debug)]
pub struct Published {
    /// The times.
    pub data: Data,
    /// Speed-up and Karp-Flatt metric.
    pub metrics: Vec<Metrics>,
    /// Processors by renderer.
    pub processors: Vec<Processors>,
}

/// All rows of a compiled-in file; the tests read every one of them.
fn rows<T: DeserializeOwned>((name, text): (&str, &str)) -> Vec<T> {
    let rows: Result<Vec<T>, csv::Error> = csv::Reader::from_reader(text.as_bytes()).deserialize().collect();
    rows.unwrap_or_else(|e| panic!("results/spheres-paper/{name}, which is compiled in, is damaged: {e}"))
}

/// The published numbers.
pub fn data() -> Published {
    let processors: Vec<Processors> = rows(file!("processors.csv"));
    let threads = processors.iter().find(|p| p.renderer == Renderer::Threads).map(|p| p.processors as usize);
    let device = |label: &str| Device { label: label.into(), ..Device::default() };
    let devices = vec![device("Apple M1"), device("GPU of the Apple M1")];
    let mut data = Data::with_devices(devices, vec![threads, None]);
    data.places = vec![Place { machine: 0, gpu: Some(1) }];
    for time in rows::<Time>(file!("times.csv")) {
        let setting = Setting::in_version(time.renderer, time.stage.version());
        data.put(Measurement {
            machine: 0,
            device: usize::from(time.renderer == Renderer::Gpu),
            scene: SceneKey::of(&time.scene, time.spheres, ""),
            threads: time.renderer.has_threads().then_some(threads).flatten(),
            setting,
            terms: Terms::default(),
            mean_ms: time.mean_ms.value,
            min_ms: time.mean_ms.value,
            max_ms: time.mean_ms.value,
            places: time.mean_ms.places,
            // No noise is known, and none is added
            noise_pct: Some(0.0),
            work: None,
            repeated: false,
        });
    }
    // Table 4 repeats numbers of table 3: that is no second measurement
    data.measurements.iter_mut().for_each(|m| m.repeated = false);
    Published { data, metrics: rows(file!("metrics.csv")), processors }
}

impl Published {
    /// The printed metrics of a renderer in a version.
    pub fn metrics(&self, stage: Stage, role: Role, renderer: Renderer) -> Option<&Metrics> {
        self.metrics.iter().find(|m| (m.stage, m.scene.as_str(), m.renderer) == (stage, role.name(), renderer))
    }

    /// A renderer's number of processors, and how it is counted.
    pub fn processors(&self, renderer: Renderer) -> Option<&Processors> {
        self.processors.iter().find(|p| p.renderer == renderer)
    }
}
