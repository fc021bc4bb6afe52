//! A number with what is known of how it is written.

use super::table::Form;
use serde::{Deserialize, Deserializer, de};

/// A number; one that was printed keeps its decimals, since further ones would claim a precision that nobody measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Number {
    /// The number itself.
    pub value: f64,
    /// Decimals that it was printed with; `None` where it was measured or computed.
    pub places: Option<usize>,
}

impl Number {
    /// As it was printed, or in the form of its column.
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
    /// From the text of a published file.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Number, D::Error> {
        let text = String::deserialize(deserializer)?;
        let value = text.parse().map_err(|_| de::Error::custom(format!("'{text}' is no number")))?;
        Ok(Number { value, places: Some(text.split_once('.').map_or(0, |(_, decimals)| decimals.len())) })
    }
}
