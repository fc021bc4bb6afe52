//! What the document printed, from `results/rt2-2010`, compiled in: orders and percentages. The values of its bar
//! charts are in no text.

use super::models::Model;
use serde::Deserialize;
use serde::de::DeserializeOwned;

/// A file of `results/rt2-2010`, by its name there.
macro_rules! file {
    ($name:literal) => {
        ($name, include_str!(concat!("../../../results/rt2-2010/", $name)))
    };
}

/// What a figure shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Frames per second; figure 4.4.
    FrameRate,
    /// Build time; figure 4.5.
    BuildTime,
    /// Bytes; figure 4.6.
    Memory,
}

/// A model of the document.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Scene {
    /// The model.
    pub model: Model,
    /// Its triangles in thousands.
    pub triangles_thousands: u32,
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

/// The order of three structures by a quantity: fastest or smallest first.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Order {
    /// Of this model.
    pub model: Model,
    /// By this quantity.
    pub quantity: Quantity,
    /// The three structures by their short names; empty where the text does not say.
    pub first: String,
    /// The second.
    pub second: String,
    /// The third.
    pub third: String,
}

/// A gain of one structure over another in percent.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Gain {
    /// Of this model.
    pub model: Model,
    /// By this quantity.
    pub quantity: Quantity,
    /// The better structure, if the gain is positive.
    pub of: String,
    /// The other one.
    pub over: String,
    /// The gain as printed.
    pub percent: f64,
}

/// A parameter of a structure.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Parameter {
    /// The structure.
    pub structure: String,
    /// What the number is of.
    pub parameter: String,
    /// The number.
    pub value: u32,
    /// Its unit.
    pub unit: String,
}

/// Everything that was printed.
#[derive(Clone, Debug, PartialEq)]
pub struct Published {
    /// The three models.
    pub scenes: Vec<Scene>,
    /// Orders by model and quantity.
    pub orders: Vec<Order>,
    /// Percentages.
    pub gains: Vec<Gain>,
    /// Parameters.
    pub parameters: Vec<Parameter>,
}

/// All rows of a compiled-in file; the tests read every one of them.
fn rows<T: DeserializeOwned>((name, text): (&str, &str)) -> Vec<T> {
    let rows: Result<Vec<T>, csv::Error> = csv::Reader::from_reader(text.as_bytes()).deserialize().collect();
    rows.unwrap_or_else(|e| panic!("results/rt2-2010/{name}, which is compiled in, is damaged: {e}"))
}

/// The published numbers.
pub fn data() -> Published {
    Published {
        scenes: rows(file!("scenes.csv")),
        orders: rows(file!("orders.csv")),
        gains: rows(file!("gains.csv")),
        parameters: rows(file!("parameters.csv")),
    }
}

impl Order {
    /// The place of a structure, 0 to 2; `None` where the text does not say.
    pub fn place(&self, structure: &str) -> Option<usize> {
        [&self.first, &self.second, &self.third].into_iter().position(|name| name == structure)
    }

    /// `ropes, kd, BVH`; a dash for a structure that is not named.
    pub fn in_words(&self) -> String {
        let name = |name: &String| if name.is_empty() { "–".to_owned() } else { name.clone() };
        [&self.first, &self.second, &self.third].map(name).join(", ")
    }
}

impl Published {
    /// The order of a model's structures.
    pub fn order(&self, model: Model, quantity: Quantity) -> Option<&Order> {
        self.orders.iter().find(|order| (order.model, order.quantity) == (model, quantity))
    }

    /// The gain that was printed of a model, in percent.
    pub fn gain(&self, model: Model, quantity: Quantity) -> Option<f64> {
        self.gains.iter().find(|gain| (gain.model, gain.quantity) == (model, quantity)).map(|gain| gain.percent)
    }

    /// Size of the document's images.
    pub fn size(&self) -> (u32, u32) {
        self.scenes.first().map_or((0, 0), |scene| (scene.width, scene.height))
    }
}
