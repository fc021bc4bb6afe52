//! Built structures. Build times of unlike processors or numbers of threads are neither compared nor put into one
//! column.

#![allow(missing_docs)] // The names of most fields say what they are

use super::Variant;
use crate::compare::pair::{Comparable, Conditions, choose};
use crate::record::run::Provenance;
use crate::report::Number;
use crate::workloads::trace::Properties;
use crate::workloads::trace::record::{Memory, StructureRecord};
use std::collections::HashMap;
use std::fmt::Display;
use std::hash::Hash;

/// A built structure.
#[derive(Clone, Debug, PartialEq)]
pub struct Built<S> {
    pub scene: S,
    pub structure: String,
    pub variant: Variant,
    /// A source may have published some of them.
    pub properties: Properties,
    pub build_ms: Option<f64>,
    /// Decimals of the build time, if it was printed.
    pub places: Option<usize>,
    pub threads: Option<usize>,
    /// The number of builds: the time is their median.
    pub builds: usize,
    /// Processor that built it.
    pub processor: String,
    /// MiB by the thesis's accounting, geometry included.
    pub thesis_mib: Option<f64>,
    /// Sizes as recorded; `None` for published values.
    pub memory: Option<Memory>,
    /// True if this one replaced an earlier one.
    pub repeated: bool,
}

/// Processor and number of threads: only build times that have both in common can be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BuiltBy<'a> {
    /// The processor; empty if unknown.
    pub processor: &'a str,
    /// The number of threads.
    pub threads: usize,
}

impl BuiltBy<'_> {
    /// `2 threads of an Example CPU`, without the article.
    pub fn in_words(&self) -> String {
        let processor = if self.processor.is_empty() { "an unknown processor" } else { self.processor };
        format!("{} of {processor}", threads_in_words(self.threads))
    }
}

/// `one thread`, `2 threads`.
pub fn threads_in_words(number: usize) -> String {
    if number == 1 { "one thread".into() } else { format!("{number} threads") }
}

impl<S> Built<S> {
    /// A recorded structure, and the content of its scene as conditions.
    pub fn of(scene: S, record: &StructureRecord, provenance: &Provenance) -> (Built<S>, Conditions) {
        let built = Built {
            scene,
            structure: record.structure.clone(),
            variant: Variant::parse(&record.variant),
            properties: record.properties.clone(),
            build_ms: Some(record.build_ms),
            places: None,
            threads: Some(record.build_threads),
            builds: provenance.plan.settings.builds.max(1),
            processor: provenance.environment.cpu.clone(),
            thesis_mib: Some(mib(record.memory.thesis_bytes)),
            memory: Some(record.memory),
            repeated: false,
        };
        (built, Conditions { scene: record.scene.hash.clone(), ..Conditions::default() })
    }

    /// The builder.
    pub fn by(&self) -> BuiltBy<'_> {
        BuiltBy { processor: &self.processor, threads: self.threads.unwrap_or(1) }
    }

    /// The build time, with its printed decimals.
    pub fn time(&self) -> Option<Number> {
        self.build_ms.map(|value| Number { value, places: self.places })
    }

    /// MiB as allocated, geometry included.
    pub fn allocated_mib(&self) -> Option<f64> {
        self.memory.map(|memory| mib(memory.structure_bytes + memory.geometry_bytes))
    }
}

fn mib(bytes: u64) -> f64 {
    bytes as f64 / f64::from(1 << 20)
}

/// All builders, the fewest threads first because the documents of the sources name one or none; then in the order of
/// the runs.
pub fn builders<'a, S: 'a>(built: impl IntoIterator<Item = &'a Built<S>>) -> Vec<BuiltBy<'a>> {
    let mut builders: Vec<BuiltBy> = Vec::new();
    for by in built.into_iter().map(Built::by) {
        if !builders.contains(&by) {
            builders.push(by);
        }
    }
    builders.sort_by_key(|by| by.threads);
    builders
}

/// Each structure once by every builder, the last one last, and notes on the others. All structures of a scene are of
/// the same content.
pub fn choose_built<S: Clone + Eq + Hash + Display>(rows: Vec<(Built<S>, Conditions)>) -> (Vec<Built<S>>, Vec<String>) {
    let comparable = rows.iter().map(|(built, conditions)| Comparable {
        group: built.scene.clone(),
        conditions,
        structure: &built.structure,
        variant: &built.variant,
    });
    let comparable: Vec<_> = comparable.collect();
    let keep: Vec<bool> = choose(&comparable).iter().map(Option::is_none).collect();
    let mut last: HashMap<_, usize> = HashMap::new();
    let mut kept: Vec<Option<Built<S>>> = Vec::new();
    let mut notes: Vec<String> = Vec::new();
    for ((mut built, _), keep) in rows.into_iter().zip(keep) {
        if !keep {
            let note = format!("structures of another content of {} were left out", built.scene);
            if !notes.contains(&note) {
                notes.push(note);
            }
            continue;
        }
        let by = (built.processor.clone(), built.threads);
        let place = (built.scene.clone(), built.structure.clone(), built.variant.clone(), by);
        if let Some(known) = last.insert(place, kept.len()) {
            kept[known] = None;
            built.repeated = true;
        }
        kept.push(Some(built));
    }
    (kept.into_iter().flatten().collect(), notes)
}
