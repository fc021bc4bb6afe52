//! Lines of a journal, borrowed from the bytes of the line. What comparing does not need is skipped without being
//! stored.

use super::{LeanRow, Name, Names, Times};
use crate::record::row::{Settings, Status, TimingSource};
use crate::record::run::{End, Provenance};
use crate::record::statistics;
use serde::Deserialize;
use serde::de::IgnoredAny;
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
    Resumed(IgnoredAny),
}

impl<'de: 'a, 'a> Deserialize<'de> for Line<'a> {
    /// Two passes over the line: a tagged enum of serde would copy the whole line into a tree first.
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Line<'a>, D::Error> {
        use serde::de::Error;
        let raw: &'de serde_json::value::RawValue = Deserialize::deserialize(deserializer)?;
        let text = raw.get();
        let tag: Tag = serde_json::from_str(text).map_err(D::Error::custom)?;
        let line = match &*tag.record {
            "run" => serde_json::from_str(text).map(|run| Line::Run(Box::new(run))),
            "input" => serde_json::from_str(text).map(Line::Input),
            "artifact" => serde_json::from_str(text).map(Line::Artifact),
            "row" => serde_json::from_str(text).map(Line::Row),
            "end" => serde_json::from_str(text).map(Line::End),
            "resumed" => serde_json::from_str(text).map(Line::Resumed),
            other => return Err(D::Error::custom(format!("unknown record `{other}`"))),
        };
        line.map_err(D::Error::custom)
    }
}
