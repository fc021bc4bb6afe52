//! Numbers and how they are written.

use serde::{Deserialize, Deserializer, de};

/// How the numbers of a column are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// A whole number.
    Whole,
    /// A number with so many decimals.
    Fixed(usize),
    /// A gain in percent, without decimals: the quotient of two gains says nothing and is not written.
    Gain,
    /// A time: two decimals, but at least three significant digits and none beyond the point from 10,000 on.
    Time,
}

impl Form {
    /// Writes a number.
    pub fn write(self, value: f64) -> String {
        match self {
            Form::Whole | Form::Gain => format!("{value:.0}"),
            Form::Fixed(places) => format!("{value:.places$}"),
            Form::Time if value.abs() >= 10_000.0 => format!("{value:.0}"),
            Form::Time if value.abs() >= 1.0 || value == 0.0 => format!("{value:.2}"),
            Form::Time => significant(value),
        }
    }
}

/// Three significant digits of a number below one, without an exponent down to a millionth.
fn significant(value: f64) -> String {
    let places = (2.0 - value.abs().log10().floor()).clamp(2.0, 8.0) as usize;
    format!("{value:.places$}")
}

/// Writes the quotient of a measured and a published number.
pub(crate) fn ratio(value: f64) -> String {
    match value.abs() {
        v if v >= 100.0 => format!("{value:.0}"),
        v if v >= 10.0 => format!("{value:.1}"),
        v if v >= 0.1 || v == 0.0 => format!("{value:.2}"),
        _ => significant(value),
    }
}

/// A number. One that was printed keeps its decimals: more of them would claim a precision that nobody measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Number {
    /// The number itself.
    pub value: f64,
    /// The decimals that it was printed with; `None` where it was measured or computed.
    pub places: Option<usize>,
}

impl Number {
    /// Writes the number as it was printed, or in the form of its column.
    pub fn write(self, form: Form) -> String {
        self.places.map_or_else(|| form.write(self.value), |places| Form::Fixed(places).write(self.value))
    }
}

impl From<f64> for Number {
    fn from(value: f64) -> Number {
        Number { value, places: None }
    }
}

impl<'de> Deserialize<'de> for Number {
    /// Reads the text of a file of published values, and keeps the number of its decimals.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Number, D::Error> {
        let text = String::deserialize(deserializer)?;
        let value = text.parse().map_err(|_| de::Error::custom(format!("'{text}' is no number")))?;
        Ok(Number { value, places: Some(text.split_once('.').map_or(0, |(_, decimals)| decimals.len())) })
    }
}
