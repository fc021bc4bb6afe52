//! The numbers behind tables, figures and claims, by scene and structure.

use super::models::{Model, SceneKey};
use super::structures::{Structure, is_own};
use crate::compare::judge::{UNKNOWN_NOISE_PCT, Uncertain};
use crate::sources::convention::Steps;
use crate::sources::rows::{self, BuiltBy, Device};
use crate::workloads::trace::record::CounterSums;
use crate::workloads::trace::simt::model::CLOSE;
use std::collections::HashMap;
use std::ops::Deref;

/// Frame times of one configuration.
pub type Frame = rows::Frame<SceneKey>;

/// A built structure.
pub type Built = rows::Built<SceneKey>;

/// A configuration without a number.
pub type Failure = rows::Failure<SceneKey>;

/// Frame times, and what their primary rays cost.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurement {
    /// The times.
    pub frame: Frame,
    /// Counts of all primary rays; `None` where nothing was counted.
    pub primary: Option<CounterSums>,
}

/// Width and height of an image in pixels.
pub type Size = (u32, u32);

/// Something that belongs to a scene.
pub trait OfScene {
    /// The scene.
    fn scene(&self) -> &SceneKey;
}

impl OfScene for Measurement {
    fn scene(&self) -> &SceneKey {
        &self.frame.scene
    }
}

impl OfScene for Built {
    fn scene(&self) -> &SceneKey {
        &self.scene
    }
}

/// A list in its order that is also found by scene, so that tables of many scenes take time in proportion to them.
#[derive(Clone, Debug)]
pub struct ByScene<T> {
    items: Vec<T>,
    /// Indices of the items of each scene.
    scenes: HashMap<SceneKey, Vec<usize>>,
}

impl<T> Default for ByScene<T> {
    fn default() -> Self {
        ByScene { items: Vec::new(), scenes: HashMap::new() }
    }
}

impl<T> Deref for ByScene<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        &self.items
    }
}

impl<T: OfScene> ByScene<T> {
    /// Adds an item at the end.
    pub fn push(&mut self, item: T) {
        self.scenes.entry(item.scene().clone()).or_default().push(self.items.len());
        self.items.push(item);
    }

    /// The items of a scene, in their order.
    pub fn of(&self, scene: &SceneKey) -> impl DoubleEndedIterator<Item = &T> {
        let indices = self.scenes.get(scene).map_or(&[][..], Vec::as_slice);
        indices.iter().map(|&index| &self.items[index])
    }

    /// Replaces the item of the same scene that `is_same` accepts, or adds it. True if it replaced one.
    pub fn put(&mut self, item: T, is_same: impl Fn(&T) -> bool) -> bool {
        let indices = self.scenes.get(item.scene()).map_or(&[][..], Vec::as_slice);
        match indices.iter().find(|index| is_same(&self.items[**index])) {
            Some(&index) => {
                self.items[index] = item;
                true
            }
            None => {
                self.push(item);
                false
            }
        }
    }
}

/// All numbers of runs.
#[derive(Clone, Debug, Default)]
pub struct Data {
    /// Devices, in the order of the runs.
    pub devices: Vec<Device>,
    /// Rows with primary rays only, one per configuration.
    pub measurements: ByScene<Measurement>,
    /// Structures, each once by every processor and number of threads.
    pub built: ByScene<Built>,
    /// Measurements without a usable result.
    pub failures: Vec<Failure>,
    /// What a reader should know about the runs as a whole.
    pub notes: Vec<String>,
}

/// What a frame costs in a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cost {
    /// The mean frame time in milliseconds.
    Time,
    /// Inner nodes and leaves per primary ray.
    Steps,
    /// Work by the SIMT model in place of the mean frame time, in millions of instructions over resident
    /// warps.
    Work,
}

impl Cost {
    /// The unit.
    pub fn unit(self) -> &'static str {
        match self {
            Cost::Time => "ms",
            Cost::Steps => "steps per ray",
            Cost::Work => "M",
        }
    }
}

impl Measurement {
    /// Steps per primary ray.
    pub fn steps(&self) -> Option<Steps> {
        let per_ray = |sum: fn(&CounterSums) -> u64| Some(sum(self.primary.as_ref()?) as f64 / self.rays()?);
        Some(Steps::Nodes { inner: per_ray(|s| s.inner)?, leaves: per_ray(|s| s.leaves)?, pops: per_ray(|s| s.pops)? })
    }

    fn rays(&self) -> Option<f64> {
        self.primary.map(|sums| sums.rays as f64).filter(|rays| *rays > 0.0)
    }

    /// Frames per second at a frame time in milliseconds.
    pub fn per_second(ms: f64) -> f64 {
        1e3 / ms
    }

    /// What a frame costs, with its noise.
    pub fn cost(&self, cost: Cost) -> Option<Uncertain> {
        match cost {
            Cost::Time => Some(Uncertain::time(self.frame.mean_ms, self.frame.noise_pct.unwrap_or(UNKNOWN_NOISE_PCT))),
            Cost::Steps => Some(Uncertain::exact(self.steps()?.by(Default::default()))),
            Cost::Work => Some(Uncertain::modelled(self.frame.mean_ms, CLOSE - 1.0)),
        }
    }
}

impl Data {
    /// The size of the images that a device's tables and claims are about: the widest of the asked width; without one
    /// the document's own, if it was measured, otherwise the size with most rows, of equals the largest.
    pub fn size(&self, device: usize, published: Size, width: Option<u32>) -> Size {
        let of_device = || self.measurements.iter().map(|m| &m.frame).filter(move |f| f.device == device);
        // Rows of other structures, such as a grid's, are in no table
        let shown: Vec<Size> =
            of_device().filter(|f| is_own(&f.structure, &f.variant)).map(|f| (f.width, f.height)).collect();
        let sizes = if shown.is_empty() { of_device().map(|f| (f.width, f.height)).collect() } else { shown };
        if let Some(width) = width {
            return sizes.into_iter().filter(|size| size.0 == width).max().unwrap_or((width, width));
        }
        if sizes.contains(&published) {
            return published;
        }
        let rows = |size: &Size| sizes.iter().filter(|other| *other == size).count();
        sizes.iter().copied().max_by_key(|size| (rows(size), *size)).unwrap_or(published)
    }

    /// A structure's measurement on a device.
    pub fn measurement(
        &self,
        (device, size): (usize, Size),
        scene: &SceneKey,
        structure: &Structure,
    ) -> Option<&Measurement> {
        self.measurements.of(scene).find(|m| {
            (m.frame.device, (m.frame.width, m.frame.height)) == (device, size)
                && structure.is(&m.frame.structure, &m.frame.variant)
        })
    }

    /// What a structure's frame costs on a device.
    pub fn cost(&self, place: (usize, Size), scene: &SceneKey, structure: &Structure, cost: Cost) -> Option<Uncertain> {
        self.measurement(place, scene, structure)?.cost(cost)
    }

    /// A built structure of one of these kinds, by this builder or by any; of several, the last.
    pub fn built(&self, by: Option<BuiltBy>, scene: &SceneKey, structures: &[&Structure]) -> Option<&Built> {
        let scene = scene.built();
        self.built
            .of(&scene)
            .rfind(|b| structures.iter().any(|s| s.is(&b.structure, &b.variant)) && by.is_none_or(|by| b.by() == by))
    }

    /// Scenes with measurements of a device, in the order of rows.
    pub fn scenes_of(&self, device: usize) -> Vec<SceneKey> {
        sorted(self.measurements.iter().filter(|m| m.frame.device == device).map(|m| &m.frame.scene))
    }

    /// Scenes with built structures, in the order of rows.
    pub fn scenes_built(&self) -> Vec<SceneKey> {
        sorted(self.built.iter().map(|b| &b.scene))
    }
}

/// Those scenes that are counterparts of a model.
pub fn counterparts(scenes: &[SceneKey], models: &[Model]) -> Vec<SceneKey> {
    scenes.iter().filter(|s| s.model().is_some_and(|model| models.contains(&model))).cloned().collect()
}

fn sorted<'a>(scenes: impl Iterator<Item = &'a SceneKey>) -> Vec<SceneKey> {
    let mut scenes: Vec<SceneKey> = scenes.cloned().collect();
    scenes.sort();
    scenes.dedup();
    scenes
}
