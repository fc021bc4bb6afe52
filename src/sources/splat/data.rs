//! The numbers behind tables, figures and claims: measurements by device, scene and axes.

use super::axes::{self, Axes};
use super::scenes::SceneKey;
use super::stages::{self, Group};
use crate::compare::judge::{UNKNOWN_NOISE_PCT, Uncertain};
use crate::record::row::{Metric, Settings, Value, metric};
use crate::sources::rows::Device;

/// A row with a result.
#[derive(Clone, Debug)]
#[allow(missing_docs)] // The names of most fields say what they are
pub struct Measurement {
    /// Index of the device.
    pub device: usize,
    pub scene: SceneKey,
    pub axes: Axes,
    pub settings: Settings,
    /// Milliseconds of a frame over all frames and passes.
    pub mean_ms: f64,
    /// Spread over passes in percent; `None` after a single pass.
    pub noise_pct: Option<f64>,
    /// Milliseconds of each frame, mean over the passes.
    pub frames_ms: Vec<f64>,
    /// Labels of the stages; empty without times of stages.
    pub stages: Vec<String>,
    /// Milliseconds `[frame][stage]`, mean over the passes.
    pub stage_ms: Vec<Vec<f64>>,
    pub metrics: Vec<Metric>,
}

/// A row without a number.
#[derive(Clone, Debug)]
#[allow(missing_docs)] // The names of the fields say what they are
pub struct Failure {
    pub device: usize,
    pub scene: SceneKey,
    pub axes: Axes,
    pub settings: Settings,
    pub message: String,
}

/// All numbers of runs.
#[derive(Clone, Debug, Default)]
pub struct Data {
    /// In the order of the runs.
    pub devices: Vec<Device>,
    /// Rows with times.
    pub measurements: Vec<Measurement>,
    /// Rows without a usable result.
    pub failures: Vec<Failure>,
    /// What a reader should know about the runs as a whole.
    pub notes: Vec<String>,
}

/// The rows of a device.
#[derive(Clone, Debug)]
pub struct View<'a> {
    /// The device, if it has rows.
    pub device: Option<&'a Device>,
    /// The rows, by scene and axes.
    pub rows: Vec<&'a Measurement>,
    /// Those without a result.
    pub failures: Vec<&'a Failure>,
    /// The values that most rows have.
    pub usual: Axes,
}

impl Measurement {
    /// The value of an axis.
    pub fn axis(&self, name: &str) -> &str {
        axes::value(&self.axes, name)
    }

    /// The technique's name.
    pub fn technique(&self) -> &str {
        self.axis("technique")
    }

    /// A metric of the whole row.
    pub fn metric(&self, name: &str) -> Option<f64> {
        metric(&self.metrics, None, name).and_then(Value::number)
    }

    /// A metric of a part.
    pub fn part(&self, part: &str, name: &str) -> Option<f64> {
        metric(&self.metrics, Some(part), name).and_then(Value::number)
    }

    /// A metric of `frame-1`, `frame-2` and so on, as far as there are any.
    pub fn by_frame(&self, name: &str) -> Vec<f64> {
        (1..).map_while(|frame: usize| self.part(&format!("frame-{frame}"), name)).collect()
    }

    /// Milliseconds of the stages that `is` accepts, mean over the frames; `None` if there is none.
    pub fn stages_ms(&self, is: impl Fn(&str) -> bool) -> Option<f64> {
        let which: Vec<usize> = (0..self.stages.len()).filter(|index| is(&self.stages[*index])).collect();
        let of_frame = |frame: &Vec<f64>| which.iter().filter_map(|stage| frame.get(*stage)).sum::<f64>();
        let sum: f64 = self.stage_ms.iter().map(of_frame).sum();
        (!which.is_empty() && !self.stage_ms.is_empty()).then(|| sum / self.stage_ms.len() as f64)
    }

    /// Milliseconds of a group.
    pub fn group_ms(&self, group: Group) -> Option<f64> {
        self.stages_ms(|stage| stages::group(stage) == Some(group))
    }

    /// Milliseconds of all stages.
    pub fn total_ms(&self) -> Option<f64> {
        self.stages_ms(|_| true)
    }

    /// A time of this row with its noise.
    pub fn uncertain(&self, ms: f64) -> Uncertain {
        Uncertain::time(ms, self.noise_pct.unwrap_or(UNKNOWN_NOISE_PCT))
    }

    /// True for a row of the same device, scene and settings that is equal in all axes but these.
    pub fn is_like(&self, other: &Measurement, but: &[&str]) -> bool {
        (self.device, &self.scene, self.settings) == (other.device, &other.scene, other.settings)
            && axes::same_but(&self.axes, &other.axes, but)
    }
}

impl Data {
    /// The rows of each device that has any; one without rows if there is none.
    pub fn views(&self) -> Vec<View<'_>> {
        let has = |device: &usize| {
            self.measurements.iter().any(|m| m.device == *device) || self.failures.iter().any(|f| f.device == *device)
        };
        let views: Vec<View> = (0..self.devices.len()).filter(has).map(|device| self.view(device)).collect();
        let none = || View { device: None, rows: Vec::new(), failures: Vec::new(), usual: Axes::new() };
        if views.is_empty() { vec![none()] } else { views }
    }

    fn view(&self, device: usize) -> View<'_> {
        let mut rows: Vec<&Measurement> = self.measurements.iter().filter(|m| m.device == device).collect();
        rows.sort_by_key(|m| order(m));
        let usual = axes::usual(rows.iter().map(|m| &m.axes));
        let failures = self.failures.iter().filter(|f| f.device == device).collect();
        View { device: self.devices.get(device), rows, failures, usual }
    }
}

/// The order of rows: scene, technique, size, then by numbers where values are numbers.
fn order(m: &Measurement) -> (SceneKey, usize, [u64; 6], Axes) {
    let number = |axis: &str| {
        let text = m.axis(axis).trim_end_matches('u');
        text.parse::<f64>().map_or(0, |number| (1e6 * number).round() as u64)
    };
    let (width, height) = m.axis("resolution").split_once('x').unwrap_or_default();
    let side = |text: &str| text.parse().unwrap_or(0);
    let technique = TECHNIQUES.iter().position(|name| *name == m.technique()).unwrap_or(TECHNIQUES.len());
    let numbers = [side(width), side(height), number("tile"), number("radius"), number("paths"), number("hits")];
    (m.scene.clone(), technique, numbers, m.axes.clone())
}

/// The order of techniques.
pub const TECHNIQUES: [&str; 4] = ["per-sample", "buckets", "tiled", "reference"];

impl<'a> View<'a> {
    /// True if the device's times say nothing about a GPU.
    pub fn is_software(&self) -> bool {
        self.device.is_some_and(Device::is_software)
    }

    /// The device's name.
    pub fn label(&self) -> &str {
        self.device.map_or("no device", |device| device.label.as_str())
    }

    /// True if all options of a row are the usual ones.
    pub fn is_usual(&self, m: &Measurement) -> bool {
        axes::unusual(&m.axes, &self.usual).is_empty()
    }

    /// Rows with the usual options.
    pub fn usual_rows(&self) -> impl Iterator<Item = &'a Measurement> {
        self.rows.iter().copied().filter(|m| self.is_usual(m))
    }

    /// Pairs of rows that differ in one axis alone, which has `a` in the first and `b` in the second.
    pub fn pairs(&self, axis: &str, a: &str, b: &str) -> Vec<(&'a Measurement, &'a Measurement)> {
        let firsts = self.rows.iter().copied().filter(|m| m.axis(axis) == a);
        let second =
            |first: &Measurement| self.rows.iter().copied().find(|m| m.axis(axis) == b && m.is_like(first, &[axis]));
        firsts.filter_map(|first| second(first).map(|second| (first, second))).collect()
    }

    /// Rows of both techniques with their usual options that are otherwise equal: per-sample, buckets.
    pub fn techniques(&self) -> Vec<(&'a Measurement, &'a Measurement)> {
        let of = |technique: &'static str| {
            let usual = |m: &Measurement| {
                axes::unusual(&m.axes, &self.usual).iter().all(|(axis, _)| !axes::OF_TECHNIQUE.contains(axis))
            };
            self.rows.iter().copied().filter(move |m| m.technique() == technique && usual(m))
        };
        let second = |first: &Measurement| of("buckets").find(|m| m.is_like(first, &axes::OF_TECHNIQUE));
        of("per-sample").filter_map(|first| second(first).map(|second| (first, second))).collect()
    }

    /// Rows that differ in one axis of numbers alone, by this number, at least two values a group.
    pub fn sweeps(&self, axis: &str) -> Vec<Vec<(f64, &'a Measurement)>> {
        let mut groups: Vec<Vec<(f64, &'a Measurement)>> = Vec::new();
        for row in self.rows.iter().copied() {
            let Ok(number) = row.axis(axis).trim_end_matches('u').parse::<f64>() else { continue };
            // A radius in units and one as a share of the extent have no common order
            let like = |other: &Measurement| {
                other.is_like(row, &[axis]) && other.axis(axis).ends_with('u') == row.axis(axis).ends_with('u')
            };
            match groups.iter_mut().find(|group| group.first().is_some_and(|(_, first)| like(first))) {
                Some(group) => group.push((number, row)),
                None => groups.push(vec![(number, row)]),
            }
        }
        groups.retain(|group| group.len() > 1);
        groups.iter_mut().for_each(|group| group.sort_by(|a, b| a.0.total_cmp(&b.0)));
        groups
    }

    /// A row's technique with what is not usual about it: `buckets blur=4`.
    pub fn words(&self, m: &Measurement) -> String {
        let mut words = m.technique().to_owned();
        for (axis, value) in axes::unusual(&m.axes, &self.usual) {
            words += &format!(" {axis}={value}");
        }
        for axis in ["frames", "camera_path", "light"] {
            let differs = |other: &&&Measurement| other.scene == m.scene && other.axis(axis) != m.axis(axis);
            if self.rows.iter().any(|other| differs(&other)) && !m.axis(axis).is_empty() {
                words += &format!(" {axis}={}", m.axis(axis));
            }
        }
        words
    }

    /// Size, tile, radius and paths on one line.
    pub fn conditions(&self, m: &Measurement) -> String {
        let tile = if m.axis("tile").is_empty() { String::new() } else { format!(", tile {}", m.axis("tile")) };
        format!("{}{tile}, radius {}, {} paths", m.axis("resolution"), m.axis("radius"), m.axis("paths"))
    }
}
