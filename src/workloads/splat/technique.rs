//! How indirect light is estimated, as it is typed: `NAME[:KEY=VALUE,..]`.

use super::setting::{Estimate, EstimateKernel, Form, Weight};
use super::splatting::setting::{Atomics, BucketSetting, Gather, MAX_BLUR, Order, Share, Tasks};
use crate::error::{Error, Result};
use crate::workloads::words::{list, name};
use std::fmt;

/// A technique with its options. Options without effect have their defaults.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Technique {
    /// Which photons a sample gets.
    pub gather: Gather,
    /// Weight by distance.
    pub kernel: EstimateKernel,
    /// Weight by direction.
    pub weight: Weight,
    /// Factor.
    pub form: Form,
}

const NAMES: [(&str, Gather); 4] = [
    ("reference", Gather::Reference),
    ("tiled", Gather::Tiled),
    ("per-sample", Gather::PerSample { order: Order::Any, tasks: Tasks::Sample }),
    ("buckets", Gather::Buckets(BucketSetting::DEFAULT)),
];
const KERNELS: [(&str, EstimateKernel); 2] =
    [("epanechnikov", EstimateKernel::Epanechnikov), ("constant", EstimateKernel::Constant)];
const WEIGHTS: [(&str, Weight); 2] = [("side", Weight::Side), ("cosine", Weight::Cosine)];
const FORMS: [(&str, Form); 2] = [("normalised", Form::Normalised), ("source", Form::Source)];
const ORDERS: [(&str, Order); 2] = [("any", Order::Any), ("sorted", Order::Sorted)];
const TASKS: [(&str, Tasks); 2] = [("sample", Tasks::Sample), ("queue", Tasks::Queue)];
const ATOMICS: [(&str, Atomics); 3] =
    [("fixed", Atomics::Fixed), ("exchange", Atomics::Exchange), ("float", Atomics::Float)];
const SHARES: [(&str, Share); 2] = [("all", Share::All), ("centre", Share::Centre)];

/// The axes of options, in the order of columns.
pub const OPTIONS: [&str; 9] = ["kernel", "weight", "form", "order", "tasks", "atomics", "share", "blur", "level"];

impl Technique {
    /// Reads one element of a list of `--technique`; `all` is every technique without options but `reference`.
    ///
    /// # Errors
    /// [`Error::Input`] for a name, key or value that does not exist, for a key that is given twice, and for one
    /// without effect.
    pub fn parse_all(text: &str) -> Result<Vec<Technique>> {
        match text {
            "all" => Ok(NAMES[1..].iter().map(|&(_, gather)| Technique { gather, ..Technique::default() }).collect()),
            _ => Ok(vec![Technique::parse(text)?]),
        }
    }

    /// Reads `NAME[:KEY=VALUE,..]`.
    ///
    /// # Errors
    /// Those of [`Technique::parse_all`].
    pub fn parse(text: &str) -> Result<Technique> {
        let wrong = |problem: String, hint: String| Error::argument(format!("--technique {text}"), problem, hint);
        let (of, options) = text.split_once(':').unwrap_or((text, ""));
        let Some((_, gather)) = NAMES.iter().find(|(name, _)| *name == of) else {
            return Err(wrong(format!("there is no technique '{of}'"), format!("one of {}", list(&NAMES))));
        };
        let mut technique = Technique { gather: *gather, ..Technique::default() };
        let mut seen = Vec::new();
        for option in options.split(',').filter(|option| !option.is_empty()) {
            let (key, value) = option.split_once('=').unwrap_or((option, ""));
            if seen.contains(&key) {
                return Err(wrong(format!("{key} is given twice"), "give it once".into()));
            }
            seen.push(key);
            match technique.set(key, value) {
                Ok(true) => {}
                Ok(false) => {
                    let known = technique.keys().join(", ");
                    return Err(wrong(format!("{of} has no option '{key}'"), format!("one of {known}")));
                }
                Err(all) => {
                    return Err(wrong(format!("'{value}' is no value for {key}"), format!("one of {all}")));
                }
            }
        }
        if let Gather::Buckets(BucketSetting { share: Share::All, .. }) = technique.gather
            && seen.contains(&"kernel")
        {
            let problem = "kernel has no effect where all of a photon's flux counts".to_owned();
            return Err(wrong(problem, "give share=centre, or leave kernel out".into()));
        }
        Ok(technique)
    }

    /// Sets an option; false if the technique does not have it.
    ///
    /// # Errors
    /// What the values are.
    fn set(&mut self, key: &str, value: &str) -> std::result::Result<bool, String> {
        fn of<T: Copy>(all: &[(&str, T)], value: &str) -> std::result::Result<T, String> {
            all.iter().find(|(name, _)| *name == value).map(|(_, value)| *value).ok_or_else(|| list(all))
        }
        let number = |range: std::ops::RangeInclusive<u32>| {
            let number = value.parse().ok().filter(|number| range.contains(number));
            number.ok_or_else(|| format!("{} to {}", range.start(), range.end()))
        };
        match (&mut self.gather, key) {
            (_, "form") => self.form = of(&FORMS, value)?,
            (_, "kernel") => self.kernel = of(&KERNELS, value)?,
            (Gather::Buckets(buckets), "atomics") => buckets.atomics = of(&ATOMICS, value)?,
            (Gather::Buckets(buckets), "share") => buckets.share = of(&SHARES, value)?,
            (Gather::Buckets(buckets), "blur") => buckets.blur = number(0..=MAX_BLUR)?,
            (Gather::Buckets(buckets), "level") => buckets.level = number(1..=5)?,
            (Gather::Buckets(_), _) => return Ok(false),
            (_, "weight") => self.weight = of(&WEIGHTS, value)?,
            (Gather::PerSample { order, .. }, "order") => *order = of(&ORDERS, value)?,
            (Gather::PerSample { tasks, .. }, "tasks") => *tasks = of(&TASKS, value)?,
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// Name on the command line.
    pub fn name(self) -> &'static str {
        let same = |other: Gather| std::mem::discriminant(&other) == std::mem::discriminant(&self.gather);
        NAMES.iter().find(|(_, gather)| same(*gather)).map_or("", |(name, _)| name)
    }

    /// The keys of its options.
    fn keys(self) -> Vec<&'static str> {
        OPTIONS.into_iter().filter(|key| !matches!(Technique::set(&mut self.clone(), key, ""), Ok(false))).collect()
    }

    /// The options that it has, by their axes.
    fn options(self) -> impl Iterator<Item = (&'static str, String)> {
        self.axes().into_iter().filter(|(_, value)| !value.is_empty())
    }

    /// The options by their axes, empty where the technique does not have them; so is the usual form.
    pub fn axes(self) -> [(&'static str, String); 9] {
        let kernel = name(&KERNELS, self.kernel);
        let values = match self.gather {
            Gather::Reference | Gather::Tiled => [kernel, name(&WEIGHTS, self.weight), "", "", "", ""],
            Gather::PerSample { order, tasks } => {
                [kernel, name(&WEIGHTS, self.weight), name(&ORDERS, order), name(&TASKS, tasks), "", ""]
            }
            Gather::Buckets(BucketSetting { atomics, share, .. }) => {
                let kernel = if share == Share::Centre { kernel } else { "" };
                [kernel, "", "", "", name(&ATOMICS, atomics), name(&SHARES, share)]
            }
        };
        let (blur, level) = match self.gather {
            Gather::Buckets(BucketSetting { blur, level, .. }) => (blur.to_string(), level.to_string()),
            _ => Default::default(),
        };
        let [kernel, weight, order, tasks, atomics, share] = values.map(str::to_owned);
        let form = if self.form == Form::default() { String::new() } else { name(&FORMS, self.form).to_owned() };
        let values = [kernel, weight, form, order, tasks, atomics, share, blur, level];
        let mut values = values.into_iter();
        OPTIONS.map(|axis| (axis, values.next().unwrap_or_default()))
    }

    /// Reads the axes of a case.
    ///
    /// # Errors
    /// Those of [`Technique::parse`].
    pub fn of_axes<'a>(axis: impl Fn(&'static str) -> &'a str) -> Result<Technique> {
        let options = OPTIONS.iter().map(|&key| (key, axis(key))).filter(|(_, value)| !value.is_empty());
        let options: Vec<String> = options.map(|(key, value)| format!("{key}={value}")).collect();
        Technique::parse(&format!("{}:{}", axis("technique"), options.join(",")))
    }

    /// The density estimate for photons of a radius.
    pub fn estimate(self, radius: f32) -> Estimate {
        Estimate { kernel: self.kernel, weight: self.weight, form: self.form, radius }
    }
}

impl fmt::Display for Technique {
    /// With the options that are not the defaults.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let named = NAMES.iter().find(|(name, _)| *name == self.name());
        let gather = named.map_or(Gather::default(), |(_, gather)| *gather);
        let usual = Technique { gather, ..Technique::default() }.axes();
        let is_usual = |key: &str, value: &str| {
            let default = usual.iter().find(|(known, _)| *known == key).map_or("", |(_, value)| value);
            value == default || key == "kernel" && value == KERNELS[0].0
        };
        let options = self.options().filter(|(key, value)| !is_usual(key, value));
        let options: Vec<String> = options.map(|(key, value)| format!("{key}={value}")).collect();
        let colon = if options.is_empty() { "" } else { ":" };
        write!(f, "{}{colon}{}", self.name(), options.join(","))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const OF: [&str; 12] = [
        "reference",
        "reference:kernel=constant,weight=cosine",
        "tiled:weight=cosine,form=source",
        "per-sample",
        "per-sample:kernel=constant,order=sorted",
        "per-sample:form=source,tasks=queue",
        "buckets",
        "buckets:form=source,atomics=float",
        "buckets:atomics=exchange,blur=3",
        "buckets:share=centre",
        "buckets:kernel=constant,share=centre",
        "buckets:level=3",
    ];

    #[test]
    fn techniques_are_read_as_they_are_written() {
        for text in OF {
            let technique = Technique::parse(text).unwrap();
            assert_eq!(technique.to_string(), text);
            let axes = technique.axes();
            let axis = |name| axes.iter().find(|(axis, _)| *axis == name).map_or(technique.name(), |(_, value)| value);
            assert_eq!(Technique::of_axes(axis).unwrap(), technique);
        }
        assert_eq!(Technique::parse_all("all").unwrap().len(), 3);
    }

    #[test]
    fn what_does_not_exist_is_refused() {
        for text in [
            "",
            "x",
            "reference:x=1",
            "reference:kernel=x",
            "reference:kernel",
            "reference:weight=side,weight=side",
            "reference:order=any",
            "tiled:tasks=queue",
            "per-sample:blur=1",
            "buckets:weight=side",
            "buckets:kernel=constant",
            "buckets:level=0",
            "buckets:level=6",
            "buckets:blur=-1",
            "buckets:blur=17",
        ] {
            let error = Technique::parse(text).unwrap_err().to_string();
            assert!(error.contains("--technique"), "{error}");
        }
    }
}
