//! What all tables share: rows by scene, cells with published numbers, notes on what is missing.

use crate::report::{Cell, Column, Number, Row, Table};
use crate::sources::spheres::ORIGIN;
use crate::sources::spheres::data::{Data, Measurement, Place, Terms, View};
use crate::sources::spheres::published::Published;
use crate::sources::spheres::scenes::{Role, SceneKey};
use crate::sources::{Options, Rows};

/// The number of failed measurements that a note spells out.
const MAX_SPELT_OUT: usize = 4;

/// The numbers that tables show, and the options.
pub struct Context<'a> {
    /// The measured numbers; `None` for what was published alone.
    pub data: Option<&'a Data>,
    /// What was published.
    pub published: &'a Published,
    /// The options.
    pub options: &'a Options,
}

/// What one table is about: a machine with one GPU, or the paper's.
pub struct Side<'a> {
    /// The rows.
    pub view: View<'a>,
    /// The published ones to compare with.
    pub printed: Option<View<'a>>,
    /// True if the rows themselves are published ones.
    pub is_published: bool,
}

/// A table before its notes: its number, title, headings of the keys, columns, rows by scene.
pub struct Draft {
    /// The table's number.
    pub id: &'static str,
    /// The title, to which the machine is added.
    pub title: String,
    /// Headings of the columns that name a row.
    pub keys: &'static [&'static str],
    /// The other columns.
    pub columns: Vec<Column>,
    /// The rows.
    pub rows: Vec<(SceneKey, Row)>,
    /// Notes of the table's own.
    pub notes: Vec<String>,
}

impl<'a> Context<'a> {
    /// What each table is made for.
    pub fn sides(&self) -> Vec<Side<'a>> {
        let printed = self.printed();
        let Some(data) = self.data else {
            return vec![Side { view: printed, printed: None, is_published: true }];
        };
        let side = |view| Side { view, printed: self.options.published.then_some(printed), is_published: false };
        if data.places.is_empty() {
            // A source that was asked for by its name, of runs of another workload
            let place = Place { machine: 0, gpu: None };
            return vec![side(View { data, place, terms: Terms::default() })];
        }
        data.places.iter().map(|place| side(data.main_view(*place, self.options.resolution))).collect()
    }

    /// The published rows.
    pub fn printed(&self) -> View<'a> {
        let data = &self.published.data;
        View { data, place: data.places[0], terms: Terms::default() }
    }

    /// The scenes of a table's rows: the paper's, measured or not, then the others that were measured.
    pub fn scenes(&self, side: &Side) -> Vec<SceneKey> {
        let measured = side.view.scenes();
        let mut scenes = Vec::new();
        for role in Role::PAPER {
            let before = scenes.len();
            scenes.extend(measured.iter().filter(|scene| scene.role == role).cloned());
            if scenes.len() == before {
                scenes.push(SceneKey::published(role));
            }
        }
        if self.options.rows != Rows::Source {
            scenes.extend(measured.into_iter().filter(|scene| !scene.is_of_paper()));
        }
        scenes
    }

    /// A table with the notes that follow from its rows.
    pub fn table(&self, side: &Side, draft: Draft) -> Table {
        let Draft { id, title, keys, columns, rows, notes: own } = draft;
        let mut notes = Vec::new();
        let filled = |role: Role| rows.iter().any(|(scene, row)| scene.role == role && row.is_filled());
        let absent: Vec<&str> = Role::PAPER.into_iter().filter(|role| !filled(*role)).map(Role::name).collect();
        let verb = if side.is_published { "Not published" } else { "Not measured" };
        if !absent.is_empty() {
            notes.push(format!("{verb}: {}.", absent.join(", ")));
        }
        if rows.iter().any(|(_, row)| row.is_filled() && !row.cells.iter().all(Cell::is_filled)) {
            notes.push(format!("A dash: {}, or without a meaning.", verb.to_lowercase()));
        }
        notes.extend(own);
        let has_published = rows.iter().any(|(_, row)| row.cells.iter().any(Cell::has_published));
        let title = if side.is_published { title } else { format!("{title}, {}", side.label()) };
        Table {
            origin: ORIGIN,
            id: id.into(),
            title,
            keys: keys.iter().map(|key| (*key).to_owned()).collect(),
            columns,
            rows: rows.into_iter().map(|(_, row)| row).collect(),
            notes,
            with_published: has_published,
            is_published: side.is_published,
        }
    }
}

impl<'a> Side<'a> {
    /// The same machine with another choice of rows: for tables of rows that the paper's tables do not have.
    pub fn of(&self, context: &Context, of: impl Fn(&Measurement) -> bool) -> Side<'a> {
        if self.is_published {
            return Side { ..*self };
        }
        Side { view: self.view.data.view(self.view.place, context.options.resolution, of), ..*self }
    }

    /// Size and devices, in titles.
    pub fn label(&self) -> String {
        format!("{}, {}", self.view.terms.in_words(), self.devices())
    }

    /// The processor and the GPU.
    pub fn devices(&self) -> String {
        let place = self.view.place;
        let name = |device: usize| self.view.data.devices.get(device).map(|device| device.label.as_str());
        let names: Vec<&str> = [name(place.machine), place.gpu.and_then(name)].into_iter().flatten().collect();
        if names.is_empty() { "no device".into() } else { names.join(" and ") }
    }

    /// A cell: the same question to the measured and to the published rows.
    pub fn cell(&self, scene: &SceneKey, ask: impl Fn(&View, &SceneKey) -> Option<Number>) -> Cell {
        let published = self.printed.filter(|_| scene.is_of_paper()).and_then(|view| {
            let scene = view.scene(scene.role)?;
            ask(&view, &scene)
        });
        Cell::Number { value: ask(&self.view, scene), published }
    }

    /// The same for a number without decimals of its own.
    pub fn ratio(&self, scene: &SceneKey, ask: impl Fn(&View, &SceneKey) -> Option<f64>) -> Cell {
        self.cell(scene, |view, scene| ask(view, scene).map(Number::from))
    }

    /// Notes on the times of this place.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if self.is_published {
            return notes;
        }
        let (view, data) = (&self.view, self.view.data);
        if let Some(device) = view.place.gpu.and_then(|gpu| data.devices.get(gpu)).filter(|d| d.is_software()) {
            notes.push(format!("{} computes on the CPU: its times are no GPU's.", device.label));
        }
        let mut others: Vec<Terms> = data
            .measurements
            .iter()
            .filter(|m| view.place.has(m.machine, m.device) && m.terms != view.terms)
            .map(|m| m.terms)
            .collect();
        others.sort_unstable();
        others.dedup();
        if !others.is_empty() {
            let words: Vec<String> = others.iter().map(Terms::in_words).collect();
            notes.push(format!("Measured otherwise as well: {}; see --resolution.", words.join("; ")));
        }
        let failed: Vec<String> = data
            .failures
            .iter()
            .filter(|f| view.place.has(f.machine, f.device) && f.terms == view.terms && !f.setting.half)
            .map(|f| format!("{} {} ({})", f.scene, f.setting, f.message))
            .collect();
        if !failed.is_empty() {
            let more = failed.len().saturating_sub(MAX_SPELT_OUT);
            let more = if more > 0 { format!("; and {more} more") } else { String::new() };
            let spelt = failed[..failed.len().min(MAX_SPELT_OUT)].join("; ");
            notes.push(format!("Measured without a usable result, so without a number: {spelt}{more}."));
        }
        notes
    }
}

/// The keys of a row: the scene and its number of spheres.
pub fn keys(scene: &SceneKey) -> Vec<String> {
    vec![scene.to_string(), scene.spheres.to_string()]
}
