//! The radius of photons as it is typed.

use crate::error::{Error, Result};
use crate::scene::Placement;
use std::fmt;

/// `SHARE` of the extent's diagonal, or `Nu` in units of the scene's file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Radius {
    /// Above 0, at most [`Radius::MAX_SHARE`].
    Share(f64),
    /// Above 0.
    Units(f64),
}

impl Radius {
    /// Largest share of the diagonal.
    pub const MAX_SHARE: f64 = 10.0;

    /// Reads `SHARE` or `Nu`.
    ///
    /// # Errors
    /// [`Error::Input`].
    pub fn parse(text: &str) -> Result<Radius> {
        let wrong = |problem: &str| {
            let hint = format!(
                "give a share of the extent's diagonal, above 0 and at most {}, as 0.03, or a length in the scene's \
                 units, as 15u",
                Radius::MAX_SHARE
            );
            Err(Error::argument("--radius", format!("'{text}' {problem}"), hint))
        };
        let (number, radius): (&str, fn(f64) -> Radius) = match text.strip_suffix('u') {
            Some(number) => (number, Radius::Units),
            None => (text, Radius::Share),
        };
        match number.trim().parse::<f64>() {
            Ok(value) if !(value > 0.0 && value.is_finite()) => wrong("is not above 0"),
            Ok(value) => match radius(value) {
                Radius::Share(share) if share > Radius::MAX_SHARE => wrong("is too large a share"),
                radius => Ok(radius),
            },
            Err(_) => wrong("is no radius"),
        }
    }

    /// The length in the scene's units in memory.
    ///
    /// # Errors
    /// [`Error::Input`] for a length whose square is no float.
    pub fn length(self, diagonal: f32, placement: &Placement) -> Result<f32> {
        let length = match self {
            Radius::Share(share) => f64::from(diagonal) * share,
            Radius::Units(units) => units / placement.length(1.0),
        };
        let (square, radius) = ((length * length) as f32, length as f32);
        if square.is_normal() && radius.is_normal() {
            return Ok(radius);
        }
        let problem = format!("{self} is {length:e} in memory, the square of which is no float");
        Err(Error::argument("--radius", problem, "give a length of the scene's order"))
    }
}

impl fmt::Display for Radius {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Radius::Share(share) => write!(f, "{share}"),
            Radius::Units(units) => write!(f, "{units}u"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_radius_is_a_share_or_a_length() {
        assert_eq!(Radius::parse("0.10").unwrap(), Radius::Share(0.1));
        assert_eq!(Radius::parse("15.0u").unwrap().to_string(), "15u");
        for text in ["", "u", "0", "-1", "NaN", "inf", "11", "1 m", "0u", "1e999"] {
            assert!(Radius::parse(text).unwrap_err().to_string().contains("--radius"), "{text}");
        }
    }

    #[test]
    fn a_length_is_in_the_units_of_memory() {
        let identity = Placement::IDENTITY;
        assert_eq!(Radius::Share(0.5).length(8.0, &identity).unwrap(), 4.0);
        assert_eq!(Radius::Units(3.0).length(8.0, &identity).unwrap(), 3.0);
        let scaled = Placement { exponent: 3, ..identity };
        assert_eq!(Radius::Units(3.0).length(8.0, &scaled).unwrap(), 24.0);
        assert!(Radius::Units(1e30).length(8.0, &identity).is_err());
        assert!(Radius::Units(1e-30).length(8.0, &identity).is_err());
    }
}
