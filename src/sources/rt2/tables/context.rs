//! What all tables share: rows by model and scene, orders and gains with what was printed of them.

use crate::report::{Cell, Column, Form, Number, Row, Table};
use crate::sources::rt2::ORIGIN;
use crate::sources::rt2::data::Data;
use crate::sources::rt2::gains::Reading;
use crate::sources::rt2::models::{Model, SceneKey};
use crate::sources::rt2::published::{Published, Quantity};
use crate::sources::{Options, Rows};

/// The numbers that tables show, and the options.
pub struct Context<'a> {
    /// The measured numbers; `None` for what was published alone.
    pub data: Option<&'a Data>,
    /// What was published.
    pub published: &'a Published,
    /// The options.
    pub options: &'a Options,
}

/// What a row is about.
#[derive(Clone, Debug)]
pub struct Place {
    /// The model that the scene is a counterpart of.
    pub model: Option<Model>,
    /// The scene; `None` for a model of which none was measured.
    pub scene: Option<SceneKey>,
}

/// Which gain a table of percentages shows.
pub struct Gains {
    /// By this quantity.
    pub quantity: Quantity,
    /// Heading of the third key, which tells rows of a scene apart.
    pub key: &'static str,
    /// The words of the third key, and for each whether it is like what the document measured.
    pub kinds: [(&'static str, bool); 2],
}

impl Context<'_> {
    /// The rows of a table: each model's counterparts among these scenes, then the other scenes.
    pub fn places(&self, scenes: &[SceneKey]) -> Vec<Place> {
        let mut places: Vec<Place> = Vec::new();
        for model in Model::ALL {
            let before = places.len();
            let of_model = scenes.iter().filter(|scene| scene.model() == Some(model));
            places.extend(of_model.map(|scene| Place { model: Some(model), scene: Some(scene.clone()) }));
            if places.len() == before {
                places.push(Place { model: Some(model), scene: None });
            }
        }
        if self.options.rows != Rows::Source {
            let others = scenes.iter().filter(|scene| scene.model().is_none());
            places.extend(others.map(|scene| Place { model: None, scene: Some(scene.clone()) }));
        }
        places
    }

    /// The keys of a row: the model, and the scene or the size that was printed.
    pub fn keys(&self, place: &Place) -> Vec<String> {
        let model = place.model.map_or("other", Model::name).to_owned();
        let printed = || {
            let scene = self.published.scenes.iter().find(|s| Some(s.model) == place.model);
            scene.map_or(String::new(), |scene| format!("{} thousand triangles", scene.triangles_thousands))
        };
        let scene = match &place.scene {
            Some(scene) => scene.to_string(),
            None if self.data.is_none() => printed(),
            None => "not measured".into(),
        };
        vec![model, scene]
    }

    /// The order of structures by their numbers, the least first (`most_first`: the greatest), with the printed one.
    /// Equal ones keep the order in which they are given. It needs the numbers of all.
    pub fn order(&self, place: &Place, quantity: Quantity, numbers: &[(&str, Option<f64>)], most_first: bool) -> Cell {
        let known: Option<Vec<(&str, f64)>> = numbers.iter().map(|(name, number)| Some((*name, (*number)?))).collect();
        let words = known.map(|mut known| {
            known.sort_by(|a, b| if most_first { b.1.total_cmp(&a.1) } else { a.1.total_cmp(&b.1) });
            known.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ")
        });
        let printed = place.model.and_then(|model| self.published.order(model, quantity)).map(|o| o.in_words());
        if self.data.is_none() {
            return Cell::Words { value: printed, published: None };
        }
        Cell::Words { value: words, published: printed.filter(|_| self.options.published) }
    }

    /// A table of one gain: rows by scene and kind, the measured ratio, and what it is in both readings of a
    /// percentage. `ratio` is that of the slower to the faster time, by the index of the kind.
    pub fn gains(
        &self,
        id: &str,
        title: String,
        places: &[Place],
        gains: &Gains,
        ratio: impl Fn(&SceneKey, usize) -> Option<f64>,
    ) -> Table {
        let mut columns = vec![Column::new("ratio", "", Form::Fixed(2))];
        for reading in Reading::ALL {
            columns.push(Column::of(&format!("g of {}", reading.formula()), "gain", "%", Form::Gain));
            columns.push(Column::of(&format!("g of {}", reading.formula()), "ratio", "", Form::Fixed(2)));
        }
        let number = |value: Option<f64>, published: Option<f64>| match self.data {
            None => Cell::Number { value: published.map(Number::from), published: None },
            Some(_) => Cell::Number {
                value: value.map(Number::from),
                published: published.filter(|_| self.options.published).map(Number::from),
            },
        };
        let mut rows = Vec::new();
        for place in places {
            for (kind, (words, is_alike)) in gains.kinds.iter().enumerate() {
                if self.data.is_none() && !is_alike {
                    continue;
                }
                let measured = place.scene.as_ref().and_then(|scene| ratio(scene, kind));
                let of_model = place.model.and_then(|model| self.published.gain(model, gains.quantity));
                let printed = of_model.filter(|_| *is_alike);
                let mut cells = vec![number(measured, None)];
                for reading in Reading::ALL {
                    cells.push(number(measured.map(|r| reading.percent(r)), printed));
                    cells.push(number(measured, printed.map(|g| reading.ratio(g))));
                }
                let mut keys = self.keys(place);
                keys.push((*words).to_owned());
                // A scene has a row of each kind that was measured, and a model without any has one
                let row = Row { keys, cells };
                if row.is_filled() || *is_alike {
                    rows.push((place.clone(), row));
                }
            }
        }
        let mut table = self.table(id, title, &["model", "scene", gains.key], columns, rows);
        table.notes.push(
            "A gain of g % is read as a ratio of 1 + g (more in the same time) and of 1 / (1 - g) (less time for the \
             same): the document does not say which."
                .into(),
        );
        table
    }

    /// A table with the notes that follow from its rows.
    pub fn table(
        &self,
        id: &str,
        title: String,
        keys: &[&str],
        columns: Vec<Column>,
        rows: Vec<(Place, Row)>,
    ) -> Table {
        let mut notes = Vec::new();
        let filled = |model: Model| rows.iter().any(|(place, row)| place.model == Some(model) && row.is_filled());
        let absent: Vec<&str> = Model::ALL.into_iter().filter(|model| !filled(*model)).map(Model::name).collect();
        let verb = if self.data.is_none() { "Not published" } else { "Not measured" };
        if !absent.is_empty() {
            notes.push(format!("{verb}: {}.", absent.join(", ")));
        }
        let has_published = rows.iter().any(|(_, row)| row.cells.iter().any(Cell::has_published));
        let gaps = rows.iter().any(|(_, row)| row.is_filled() && !row.cells.iter().all(Cell::is_filled));
        if gaps {
            notes.push(format!("A dash: {}.", verb.to_lowercase()));
        }
        Table {
            origin: ORIGIN,
            id: id.into(),
            title,
            keys: keys.iter().map(|key| (*key).to_owned()).collect(),
            columns,
            rows: rows.into_iter().map(|(_, row)| row).collect(),
            notes,
            with_published: has_published,
            is_published: self.data.is_none(),
        }
    }
}
