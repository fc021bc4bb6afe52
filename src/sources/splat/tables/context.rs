//! What all tables share: rows by device, keys of rows, notes on what is missing.

use crate::report::{Cell, Column, Number, Row, Table};
use crate::sources::splat::ORIGIN;
use crate::sources::splat::data::{Data, Measurement, View};
use crate::sources::splat::published::Published;
use crate::sources::splat::scenes::Role;
use crate::sources::{Options, Rows};

/// The number of failed measurements that a note spells out.
const MAX_SPELT_OUT: usize = 4;

/// Headings of the columns that name a row.
pub const KEYS: [&str; 6] = ["scene", "technique", "size", "tile", "radius", "paths"];

/// The numbers that tables show, and the options.
pub struct Context<'a> {
    /// The measured numbers; `None` for what was published alone.
    pub data: Option<&'a Data>,
    /// What was published.
    pub published: &'a Published,
    /// The options.
    pub options: &'a Options,
}

/// A table before its notes.
pub struct Draft {
    /// The table's number.
    pub id: &'static str,
    /// The title, to which the device is added.
    pub title: String,
    /// Headings of the columns that name a row.
    pub keys: Vec<&'static str>,
    /// The other columns.
    pub columns: Vec<Column>,
    /// The rows.
    pub rows: Vec<Row>,
    /// Notes of the table's own.
    pub notes: Vec<String>,
}

impl Draft {
    /// A table whose rows have the usual keys.
    pub fn new(id: &'static str, title: &str, columns: Vec<Column>) -> Draft {
        Draft { id, title: title.into(), keys: KEYS.into(), columns, rows: Vec::new(), notes: Vec::new() }
    }
}

impl<'a> Context<'a> {
    /// The rows of each device, those that the options ask for; none without data.
    pub fn views(&self) -> Vec<View<'a>> {
        let mut views = self.data.map(Data::views).unwrap_or_default();
        for view in &mut views {
            let of_width = |m: &&Measurement| {
                let width = m.axis("resolution").split('x').next().and_then(|width| width.parse().ok());
                self.options.resolution.is_none() || self.options.resolution == width
            };
            let of_thesis = |m: &&Measurement| self.options.rows != Rows::Source || m.scene.role != Role::Other;
            view.rows.retain(|m| of_width(m) && of_thesis(m));
        }
        views
    }

    /// A table for each device, or one of published numbers.
    pub fn tables(&self, of: impl Fn(&View) -> Draft, printed: impl Fn() -> Draft) -> Vec<Table> {
        if self.data.is_none() {
            return vec![self.table(None, printed())];
        }
        self.views().iter().map(|view| self.table(Some(view), of(view))).collect()
    }

    /// A table with the notes that follow from its rows.
    pub fn table(&self, view: Option<&View>, draft: Draft) -> Table {
        let Draft { id, title, keys, columns, rows, notes: own } = draft;
        let is_published = view.is_none();
        let mut notes = Vec::new();
        if rows.is_empty() {
            let words = if is_published { "The thesis prints no numbers of this" } else { "Nothing was measured" };
            notes.push(format!("{words}."));
        }
        if rows.iter().any(|row| row.is_filled() && !row.cells.iter().all(Cell::is_filled)) {
            let words = if is_published { "not printed" } else { "not measured" };
            notes.push(format!("A dash: {words}, or without a meaning."));
        }
        notes.extend(own);
        if let Some(view) = view {
            notes.extend(device_notes(view));
        }
        let with_published = rows.iter().any(|row| row.cells.iter().any(Cell::has_published));
        let title = view.map_or(title.clone(), |view| format!("{title}, {}", view.label()));
        let keys = keys.into_iter().map(str::to_owned).collect();
        Table { origin: ORIGIN, id: id.into(), title, keys, columns, rows, notes, with_published, is_published }
    }

    /// A number, with the published one where it is asked for.
    pub fn cell(&self, value: Option<f64>, published: Option<Number>) -> Cell {
        let published = published.filter(|_| self.options.published);
        Cell::Number { value: value.map(Number::from), published }
    }

    /// Scenes of the thesis without rows, where tables name them.
    pub fn absent(&self, rows: &[&Measurement]) -> Vec<Role> {
        let is_absent = |role: &Role| !rows.iter().any(|m| m.scene.role == *role);
        if self.options.rows == Rows::Measured {
            return Vec::new();
        }
        Role::THESIS.into_iter().filter(is_absent).collect()
    }

    /// Index of the device whose published numbers are shown.
    pub fn published_device(&self) -> usize {
        self.options.device.unwrap_or(0)
    }
}

/// The keys of a row.
pub fn keys(view: &View, m: &Measurement) -> Vec<String> {
    let axis = |name: &str| m.axis(name).to_owned();
    vec![m.scene.to_string(), view.words(m), axis("resolution"), axis("tile"), axis("radius"), axis("paths")]
}

/// The keys of a row of the thesis.
pub fn printed_keys(published: &Published, role: Role, technique: &str) -> Vec<String> {
    let scene = published.scenes.iter().find(|scene| role.published().starts_with(&scene.scene));
    let radius = scene.and_then(|scene| scene.radius_units).map_or(String::new(), |r| format!("{:.1}u", r.value));
    [role.published(), technique, "1920x1080", "32", &radius, ""].map(str::to_owned).into()
}

/// What was said of a device's rows.
fn device_notes(view: &View) -> Vec<String> {
    let mut notes = Vec::new();
    if view.is_software() && !view.rows.is_empty() {
        notes.push(format!("{} computes on the CPU: its times are no GPU's.", view.label()));
    }
    notes
}

/// A note that names rows without a usable result; `None` if there is none.
pub fn failures(view: &View) -> Option<String> {
    if view.failures.is_empty() {
        return None;
    }
    let words = |f: &&super::super::data::Failure| {
        let axis = |name: &str| super::super::axes::value(&f.axes, name);
        format!("{} {} radius {} ({})", f.scene, axis("technique"), axis("radius"), f.message)
    };
    let spelt: Vec<String> = view.failures.iter().take(MAX_SPELT_OUT).map(words).collect();
    let more = view.failures.len().saturating_sub(MAX_SPELT_OUT);
    let more = if more > 0 { format!("; and {more} more") } else { String::new() };
    Some(format!("Measured without a usable result, so without a number: {}{more}.", spelt.join("; ")))
}
