//! How indirect light is estimated, as it is typed: `NAME[:KEY=VALUE,..]`.

use super::setting::{Estimate, EstimateKernel, Weight};
use crate::error::{Error, Result};
use crate::workloads::words::{list, name};
use std::fmt;

/// A technique with its options.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Technique {
    /// Weight by distance.
    pub kernel: EstimateKernel,
    /// Weight by direction.
    pub weight: Weight,
}

/// The only technique so far: each sample over all photons.
const REFERENCE: &str = "reference";

const KERNELS: [(&str, EstimateKernel); 2] =
    [("epanechnikov", EstimateKernel::Epanechnikov), ("constant", EstimateKernel::Constant)];
const WEIGHTS: [(&str, Weight); 2] = [("side", Weight::Side), ("cosine", Weight::Cosine)];

impl Technique {
    /// Reads one element of a list of `--technique`; `all` is every technique without options.
    ///
    /// # Errors
    /// [`Error::Input`] for a name, key or value that does not exist, and for a key that is given twice.
    pub fn parse_all(text: &str) -> Result<Vec<Technique>> {
        if text == "all" { Ok(vec![Technique::default()]) } else { Ok(vec![Technique::parse(text)?]) }
    }

    /// Reads `NAME[:KEY=VALUE,..]`.
    ///
    /// # Errors
    /// Those of [`Technique::parse_all`].
    pub fn parse(text: &str) -> Result<Technique> {
        let wrong = |problem: String, hint: String| Error::argument(format!("--technique {text}"), problem, hint);
        let (of, options) = text.split_once(':').unwrap_or((text, ""));
        if of != REFERENCE {
            return Err(wrong(format!("there is no technique '{of}'"), format!("one of {REFERENCE}")));
        }
        let (mut technique, mut seen) = (Technique::default(), Vec::new());
        for option in options.split(',').filter(|option| !option.is_empty()) {
            let (key, value) = option.split_once('=').unwrap_or((option, ""));
            if seen.contains(&key) {
                return Err(wrong(format!("{key} is given twice"), "give it once".into()));
            }
            seen.push(key);
            let no_value = |all: String| wrong(format!("'{value}' is no value for {key}"), format!("one of {all}"));
            match key {
                "kernel" => {
                    let found = KERNELS.iter().find(|(name, _)| *name == value);
                    technique.kernel = found.ok_or_else(|| no_value(list(&KERNELS)))?.1;
                }
                "weight" => {
                    let found = WEIGHTS.iter().find(|(name, _)| *name == value);
                    technique.weight = found.ok_or_else(|| no_value(list(&WEIGHTS)))?.1;
                }
                _ => return Err(wrong(format!("{of} has no option '{key}'"), "one of kernel, weight".into())),
            }
        }
        Ok(technique)
    }

    /// Name on the command line.
    pub fn name(self) -> &'static str {
        REFERENCE
    }

    /// The options by their axes.
    pub fn axes(self) -> [(&'static str, String); 2] {
        [("kernel", name(&KERNELS, self.kernel).to_owned()), ("weight", name(&WEIGHTS, self.weight).to_owned())]
    }

    /// Reads the axes of a case.
    ///
    /// # Errors
    /// Those of [`Technique::parse`].
    pub fn of_axes<'a>(axis: impl Fn(&'static str) -> &'a str) -> Result<Technique> {
        Technique::parse(&format!("{}:kernel={},weight={}", axis("technique"), axis("kernel"), axis("weight")))
    }

    /// The density estimate for photons of a radius.
    pub fn estimate(self, radius: f32) -> Estimate {
        Estimate { kernel: self.kernel, weight: self.weight, radius }
    }
}

impl fmt::Display for Technique {
    /// With the options that are not the defaults.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let (own, usual) = (self.axes(), Technique::default().axes());
        let options = own.iter().zip(&usual).filter(|(own, usual)| own != usual);
        let options: Vec<String> = options.map(|((key, value), _)| format!("{key}={value}")).collect();
        let colon = if options.is_empty() { "" } else { ":" };
        write!(f, "{}{colon}{}", self.name(), options.join(","))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn techniques_are_read_as_they_are_written() {
        for kernel in KERNELS {
            for weight in WEIGHTS {
                let technique = Technique { kernel: kernel.1, weight: weight.1 };
                assert_eq!(Technique::parse(&technique.to_string()).unwrap(), technique);
                let axes = technique.axes();
                let axis = |name| axes.iter().find(|(axis, _)| *axis == name).map_or(REFERENCE, |(_, value)| value);
                assert_eq!(Technique::of_axes(axis).unwrap(), technique);
            }
        }
    }

    #[test]
    fn what_does_not_exist_is_refused() {
        for text in
            ["", "x", "reference:x=1", "reference:kernel=x", "reference:kernel", "reference:weight=side,weight=side"]
        {
            let error = Technique::parse(text).unwrap_err().to_string();
            assert!(error.contains("--technique"), "{error}");
        }
    }
}
