//! Lines of a journal, borrowed from the bytes of the line. What comparing does not need is skipped without being
//! stored.

use super::{LeanRow, Name, Names, Times};
use crate::record::row::{Settings, Status, TimingSource};
use crate::record::run::{End, Provenance};
use crate::record::statistics;
use serde::de::Visitor;
use serde::{Deserialize, Deserializer};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// A text without a copy where it has no escapes.
#[derive(Deserialize, PartialEq, Eq, PartialOrd, Ord)]
#[serde(transparent)]
pub(super) struct Text<'a>(#[serde(borrow)] Cow<'a, str>);

impl std::ops::Deref for Text<'_> {
    type Target = str;

    fn deref(&self) -> &str {
        &self.0
    }
}

pub(super) enum Line<'a> {
    Run(Box<Provenance>),
    Input(InputLine<'a>),
    Artifact(ArtifactLine<'a>),
    Row(RowLine<'a>),
    End(End),
    Resumed,
}

/// Parses a line.
///
/// # Errors
/// The parser's.
pub(super) fn parse(bytes: &[u8]) -> serde_json::Result<Line<'_>> {
    // The tag is the first field; a tagged enum of serde would copy the whole line into a tree
    if bytes.starts_with(br#"{"record":"row","#) {
        return serde_json::from_slice(bytes).map(Line::Row);
    }
    let tag: Tag = serde_json::from_slice(bytes)?;
    match &*tag.record {
        "run" => serde_json::from_slice(bytes).map(|run| Line::Run(Box::new(run))),
        "input" => serde_json::from_slice(bytes).map(Line::Input),
        "artifact" => serde_json::from_slice(bytes).map(Line::Artifact),
        "row" => serde_json::from_slice(bytes).map(Line::Row),
        "end" => serde_json::from_slice(bytes).map(Line::End),
        "resumed" => Ok(Line::Resumed),
        other => Err(serde::de::Error::custom(format!("unknown record `{other}`"))),
    }
}

#[derive(Deserialize)]
struct Tag<'a> {
    #[serde(borrow)]
    record: Text<'a>,
}

#[derive(Deserialize)]
pub(super) struct KeyLine<'a> {
    #[serde(borrow)]
    pub axes: BTreeMap<Text<'a>, Text<'a>>,
    #[serde(borrow)]
    pub inputs: BTreeMap<Text<'a>, Text<'a>>,
}

#[derive(Deserialize)]
pub(super) struct MetricLine<'a> {
    #[serde(borrow)]
    name: Text<'a>,
    #[serde(borrow, default)]
    of: Option<Text<'a>>,
    value: WholeNumber,
}

/// The value of a metric, if it is a whole number.
struct WholeNumber(Option<u64>);

impl<'de> Deserialize<'de> for WholeNumber {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<WholeNumber, D::Error> {
        deserializer.deserialize_any(WholeNumberVisitor)
    }
}

struct WholeNumberVisitor;

impl Visitor<'_> for WholeNumberVisitor {
    type Value = WholeNumber;

    fn expecting(&self, formatter: &mut std::fmt::Formatter) -> std::fmt::Result {
        formatter.write_str("a number, a word, true or false")
    }

    fn visit_u64<E>(self, value: u64) -> Result<WholeNumber, E> {
        Ok(WholeNumber(Some(value)))
    }

    fn visit_i64<E>(self, _: i64) -> Result<WholeNumber, E> {
        Ok(WholeNumber(None))
    }

    fn visit_f64<E>(self, _: f64) -> Result<WholeNumber, E> {
        Ok(WholeNumber(None))
    }

    fn visit_str<E>(self, _: &str) -> Result<WholeNumber, E> {
        Ok(WholeNumber(None))
    }

    fn visit_bool<E>(self, _: bool) -> Result<WholeNumber, E> {
        Ok(WholeNumber(None))
    }
}

#[derive(Deserialize)]
pub(super) struct InputLine<'a> {
    #[serde(borrow)]
    pub kind: Text<'a>,
    #[serde(borrow)]
    pub name: Text<'a>,
    #[serde(borrow)]
    pub hash: Text<'a>,
}

#[derive(Deserialize)]
pub(super) struct ArtifactLine<'a> {
    #[serde(borrow)]
    pub key: KeyLine<'a>,
    #[serde(borrow)]
    pub metrics: Vec<MetricLine<'a>>,
}

#[derive(Deserialize)]
struct KernelLine<'a> {
    #[serde(borrow)]
    hash: Text<'a>,
}

#[derive(Deserialize)]
struct SamplesLine {
    device_ns: Option<Vec<Vec<u64>>>,
    wall_ns: Vec<Vec<u64>>,
}

#[derive(Deserialize)]
pub(super) struct RowLine<'a> {
    #[serde(borrow)]
    key: KeyLine<'a>,
    settings: Settings,
    device: usize,
    status: Status,
    #[serde(borrow)]
    message: Text<'a>,
    #[serde(borrow)]
    outputs: BTreeMap<Text<'a>, Text<'a>>,
    #[serde(borrow)]
    metrics: Vec<MetricLine<'a>>,
    #[serde(borrow)]
    kernels: Vec<KernelLine<'a>>,
    timing_source: Option<TimingSource>,
    samples: Option<SamplesLine>,
}

/// Names and values as numbers of texts.
pub(super) fn texts(names: &mut Names, texts: &BTreeMap<Text, Text>) -> Box<[(Name, Name)]> {
    texts.iter().map(|(name, value)| (names.intern(name), names.intern(value))).collect()
}

/// The whole numbers among metrics.
pub(super) fn exact(names: &mut Names, metrics: &[MetricLine]) -> Box<[(Name, u64)]> {
    let mut column = String::new();
    let whole = metrics.iter().filter_map(|metric| Some((metric, metric.value.0?)));
    whole
        .map(|(metric, value)| {
            let name = match &metric.of {
                Some(part) => {
                    column.clear();
                    column.push_str(part);
                    column.push('.');
                    column.push_str(&metric.name);
                    names.intern(&column)
                }
                None => names.intern(&metric.name),
            };
            (name, value)
        })
        .collect()
}

impl RowLine<'_> {
    /// The row, with its texts in `names`.
    pub(super) fn lean(&self, names: &mut Names) -> LeanRow {
        let hashes: Vec<&str> = self.kernels.iter().map(|kernel| &*kernel.hash).collect();
        LeanRow {
            axes: texts(names, &self.key.axes),
            inputs: texts(names, &self.key.inputs),
            device: self.device,
            settings: self.settings,
            status: self.status,
            message: names.intern(&self.message),
            outputs: texts(names, &self.outputs),
            exact: exact(names, &self.metrics),
            kernels: names.intern(&hashes.join(" ")),
            times: self.times(),
        }
    }

    fn times(&self) -> Option<Times> {
        let samples = self.samples.as_ref().filter(|_| self.status == Status::Ok)?;
        let passes = match self.timing_source? {
            TimingSource::Device => samples.device_ns.as_deref()?,
            TimingSource::Wall => &samples.wall_ns,
        };
        let frames = statistics::frames(passes)?;
        let mean = |pass: &Vec<u64>| (pass.iter().sum::<u64>() as f64 / 1e6 / pass.len().max(1) as f64) as f32;
        Some(Times {
            mean_ms: frames.mean_ms,
            noise_pct: frames.noise_pct,
            passes_ms: passes.iter().map(mean).collect(),
        })
    }
}
