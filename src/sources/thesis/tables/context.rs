//! What all tables share: their rows, cells with published numbers, and notes on what is missing.

use crate::report::{Cell, Column, Number, Row, Table};
use crate::sources::thesis::ORIGIN;
use crate::sources::thesis::data::Data;
use crate::sources::thesis::scenes::{SceneKey, ThesisScene};
use crate::sources::{Options, Rows};
use crate::workloads::trace::backend::Config;
use std::collections::HashSet;

/// The number of failed measurements that a note spells out.
const MAX_SPELT_OUT: usize = 4;

/// The numbers that tables show, and the options.
pub struct Context<'a> {
    /// The measured numbers, or the published ones.
    pub data: &'a Data,
    /// The published numbers.
    pub published: &'a Data,
    /// By the SIMT model of each GPU.
    pub modelled: &'a [Data],
    /// The options.
    pub options: &'a Options,
    /// Side of the image in tables of one size.
    pub resolution: u32,
}

impl Context<'_> {
    /// Scenes of a table's rows: the thesis's nine, then the others that were measured.
    pub fn scenes(&self) -> Vec<SceneKey> {
        let mut scenes: Vec<SceneKey> = ThesisScene::ALL.into_iter().map(SceneKey::Thesis).collect();
        if self.options.rows != Rows::Source {
            scenes.extend(self.data.scenes.iter().map(|s| s.key.clone()).filter(|key| key.thesis().is_none()));
        }
        scenes
    }

    /// A cell: the same question to the measured and to the published numbers.
    pub fn cell<N: Into<Number>>(&self, ask: impl Fn(&Data) -> Option<N>) -> Cell {
        let published = if self.options.published { ask(self.published) } else { None };
        Cell::Number { value: ask(self.data).map(N::into), published: published.map(N::into) }
    }

    /// The same for what depends on the device: a measured one, and the published one that it is compared with.
    pub fn device_cell(&self, device: usize, other: usize, ask: impl Fn(&Data, usize) -> Option<Number>) -> Cell {
        let published = if self.options.published { ask(self.published, other) } else { None };
        Cell::Number { value: ask(self.data, device), published }
    }

    /// A published device by its name.
    pub fn published_device(&self, label: &str) -> usize {
        self.published.devices.iter().position(|d| d.label == label).unwrap_or(0)
    }

    /// The name of a device in titles; the thesis's second one has its own tables, measured or not.
    pub fn label(&self, device: usize) -> &str {
        self.data.devices.get(device).map_or("a second device", |d| d.label.as_str())
    }

    /// A table with the notes that follow from its rows: the absent scenes, and scenes that are not the thesis's.
    pub fn table(
        &self,
        id: &str,
        title: String,
        keys: &[&str],
        columns: Vec<Column>,
        rows: Vec<(SceneKey, Row)>,
    ) -> Table {
        let notes = self.absences(&rows);
        Table {
            origin: ORIGIN,
            id: id.into(),
            title,
            keys: keys.iter().map(|key| (*key).to_owned()).collect(),
            columns,
            rows: rows.into_iter().map(|(_, row)| row).collect(),
            notes,
            with_published: self.options.published,
            is_published: self.data.published,
        }
    }

    /// Notes on scenes without any number, on gaps, and on scenes that are not the thesis's.
    fn absences(&self, rows: &[(SceneKey, Row)]) -> Vec<String> {
        let mut absent: Vec<&SceneKey> = Vec::new();
        let (mut gaps, mut tessellations, mut others) = (false, Vec::new(), false);
        let filled: HashSet<&SceneKey> = rows.iter().filter(|(_, row)| row.is_filled()).map(|(key, _)| key).collect();
        for (key, row) in rows {
            if !filled.contains(key) {
                if !absent.contains(&key) {
                    absent.push(key);
                }
                continue;
            }
            gaps |= row.cells.iter().any(|cell| !cell.is_filled());
            match key.tessellation_of() {
                Some(scene) if !tessellations.contains(&(key, scene)) => tessellations.push((key, scene)),
                None if key.thesis().is_none() => others = true,
                _ => {}
            }
        }
        let mut notes = Vec::new();
        let verb = if self.data.published { "Not published" } else { "Not measured" };
        if !absent.is_empty() {
            let names: Vec<String> = absent.iter().map(ToString::to_string).collect();
            notes.push(format!("{verb}: {}.", names.join(", ")));
        }
        if gaps {
            notes.push(format!("A dash: {}.", verb.to_lowercase()));
        }
        for (key, scene) in tessellations {
            notes
                .push(format!("{key} is another tessellation than the thesis's {} and has its own row.", scene.name()));
        }
        if others {
            notes.push("Scenes with a number in brackets (their triangles) are not the thesis's.".into());
        }
        notes
    }

    /// A published table without rows: it is about another device than the one that was asked for.
    pub fn of_another_device(&self, id: &str, title: &str, wanted: usize, where_it_is: &str) -> Table {
        let label = &self.published.devices[wanted].label;
        Table {
            origin: ORIGIN,
            id: id.into(),
            title: format!("{title}, {label}"),
            keys: vec!["scene".into()],
            columns: Vec::new(),
            rows: Vec::new(),
            notes: vec![format!("The thesis has no numbers of the {label} in this table: they are in {where_it_is}.")],
            with_published: false,
            is_published: true,
        }
    }

    /// Measurements without a number, of a device and a ray configuration.
    pub fn failures(&self, device: usize, config: Config, sides: &[u32]) -> Option<String> {
        let of_table = self
            .data
            .failures
            .iter()
            .filter(|f| f.device == device && f.config == config && (sides.is_empty() || sides.contains(&f.width)));
        let all: Vec<String> = of_table.map(|f| format!("{} ({})", f.what, f.message)).collect();
        if all.is_empty() {
            return None;
        }
        let spelt = all[..all.len().min(MAX_SPELT_OUT)].join("; ");
        let more = all.len().saturating_sub(MAX_SPELT_OUT);
        let more = if more > 0 { format!("; and {more} more") } else { String::new() };
        Some(format!("Measured without a usable result, so without a number: {spelt}{more}."))
    }
}

/// A note on measurements that were made more than once.
pub fn repeated(count: usize) -> Option<String> {
    (count > 0)
        .then(|| format!("{count} of these measurements were made more than once; the last complete one is shown."))
}
