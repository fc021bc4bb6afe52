//! What the thesis printed, from `results/splat-thesis`, compiled in: labels and ends of axes of charts, sizes, and
//! numbers in sentences.

use super::scenes::Role;
use super::stages::Group;
use crate::report::Number;
use serde::Deserialize;
use serde::de::DeserializeOwned;

/// The devices whose charts were printed.
pub const DEVICES: [&str; 2] = ["NVIDIA RTX 2080", "AMD Radeon RX 480"];

/// A file of `results/splat-thesis`, by its name there.
macro_rules! file {
    ($name:literal) => {
        ($name, include_str!(concat!("../../../results/splat-thesis/", $name)))
    };
}

/// A label of figure 5.2.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct StageTime {
    /// The scene's name.
    pub scene: String,
    /// The technique.
    pub technique: String,
    /// The group of stages.
    pub group: Group,
    /// Milliseconds per frame.
    pub time_ms: Number,
    /// The device, inferred.
    pub device: String,
}

/// The ends of a chart's axes: upper bounds.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Chart {
    /// Number of the figure.
    pub figure: String,
    /// The scene's name.
    pub scene: String,
    /// The device.
    pub device: String,
    /// The technique.
    pub technique: String,
    /// End of the axis of milliseconds.
    pub time_max_ms: Number,
    /// End of the axis of assignments, if there is one.
    pub assignments_max: Option<Number>,
    /// `kernels`: times of all kernels, stacked; `frames`: frame time and assignments.
    pub shows: String,
}

/// A scene of the thesis.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Scene {
    /// Its name; empty for a picture whose scene is not named.
    pub scene: String,
    /// Triangles in titles of charts.
    pub triangles_in_titles: Option<u64>,
    /// Triangles in captions.
    pub triangles_in_captions: Option<u64>,
    /// Photons.
    pub photons: Option<u64>,
    /// Radius in the scene's units, which are not known.
    pub radius_units: Option<Number>,
}

/// A GPU of the thesis.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Gpu {
    /// Its name.
    pub device: String,
    /// What it was used for.
    #[serde(rename = "use")]
    pub used_for: String,
    /// Numbers of its charts.
    pub charts: String,
}

/// A size.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Size {
    /// Of what.
    pub quantity: String,
    /// As printed; absent where it is not.
    pub printed: Option<Number>,
    /// The printed unit.
    pub unit: String,
    /// What it follows from.
    pub formula: String,
    /// Exact bytes, where the formula has no unknown.
    pub bytes: Option<u64>,
    /// What the printed number agrees with.
    pub agrees_as: String,
}

/// Bits that a key needs, computed by the printed formula.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct KeyBits {
    /// Rows of the image.
    pub height_px: u32,
    /// Side of a tile.
    pub tile_px: u32,
    /// Vertical field of view.
    pub field_of_view_deg: f64,
    /// Far by near.
    pub far_over_near: f64,
    /// Slices of depth, not rounded.
    pub slices: Number,
    /// Bits of the slice.
    pub depth_bits: u32,
    /// Columns of tiles at 16 to 9.
    pub columns: u32,
    /// Bits of the column.
    pub x_bits: u32,
}

/// A kernel of the thesis.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Kernel {
    /// Its name; empty if it cannot be read.
    pub kernel: String,
    /// `both`, or one of the techniques.
    pub technique: String,
    /// The group of stages.
    pub group: Group,
    /// What it does.
    pub does: String,
    /// The stage of rtbench that does the same.
    pub stage_here: String,
}

/// A number in a sentence.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Statement {
    /// Section or figure.
    pub place: String,
    /// Of what.
    pub quantity: String,
    /// The number, or a key's widths.
    pub value: String,
    /// Its unit; may be empty.
    pub unit: String,
    /// `own`, or `quoted` from another work.
    pub whose: String,
}

/// Everything that was printed.
#[derive(Clone, Debug)]
#[allow(missing_docs)] // The names of the fields say what they are
pub struct Published {
    pub stage_times: Vec<StageTime>,
    pub charts: Vec<Chart>,
    pub scenes: Vec<Scene>,
    pub gpus: Vec<Gpu>,
    pub sizes: Vec<Size>,
    pub key_bits: Vec<KeyBits>,
    pub kernels: Vec<Kernel>,
    pub statements: Vec<Statement>,
}

/// All rows of a compiled-in file; the tests read every one of them.
fn rows<T: DeserializeOwned>((name, text): (&str, &str)) -> Vec<T> {
    let rows: Result<Vec<T>, csv::Error> = csv::Reader::from_reader(text.as_bytes()).deserialize().collect();
    rows.unwrap_or_else(|e| panic!("results/splat-thesis/{name}, which is compiled in, is damaged: {e}"))
}

/// The published numbers.
pub fn data() -> Published {
    Published {
        stage_times: rows(file!("stage_times.csv")),
        charts: rows(file!("chart_axes.csv")),
        scenes: rows(file!("scenes.csv")),
        gpus: rows(file!("devices.csv")),
        sizes: rows(file!("memory.csv")),
        key_bits: rows(file!("key_bits.csv")),
        kernels: rows(file!("kernels.csv")),
        statements: rows(file!("statements.csv")),
    }
}

impl Published {
    /// Milliseconds of a group in a scene.
    pub fn group_ms(&self, role: Role, technique: &str, group: Group) -> Option<Number> {
        let is =
            |t: &&StageTime| (t.scene.as_str(), t.technique.as_str(), t.group) == (role.published(), technique, group);
        self.stage_times.iter().find(is).map(|t| t.time_ms)
    }

    /// Milliseconds of all groups together, with the decimal that they were printed with.
    pub fn total_ms(&self, role: Role, technique: &str) -> Option<Number> {
        let of = |group: Group| self.group_ms(role, technique, group).map(|number| number.value);
        let sum: Option<f64> = Group::ALL.into_iter().map(of).sum();
        sum.map(|value| Number { value, places: Some(1) })
    }

    /// The axes of the chart of frame times of a scene on a device ([`DEVICES`]).
    pub fn chart(&self, role: Role, technique: &str, device: usize) -> Option<&Chart> {
        let wanted = ("frames", role.published(), technique, DEVICES[device]);
        let is = |c: &&Chart| (c.shows.as_str(), c.scene.as_str(), c.technique.as_str(), c.device.as_str()) == wanted;
        self.charts.iter().find(is)
    }

    /// A number in a sentence, by what it is a number of.
    pub fn statement(&self, quantity: &str) -> Option<Number> {
        let statement = self.statements.iter().find(|s| s.quantity == quantity)?;
        let places = statement.value.split_once('.').map_or(0, |(_, decimals)| decimals.len());
        statement.value.parse().ok().map(|value| Number { value, places: Some(places) })
    }
}
