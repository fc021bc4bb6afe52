//! Tables 1 to 4: mean time per frame in the paper's structure.

use super::context::{Context, Draft, Side, keys};
use crate::report::{Column, Form, Row, Table};
use crate::sources::spheres::data::Measurement;
use crate::sources::spheres::scenes::SceneKey;
use crate::sources::spheres::setting::{Renderer, Stage};

/// A table: its number, version and columns.
type Times = (&'static str, Stage, &'static [Renderer]);

const TABLES: [Times; 4] = [
    ("1", Stage::TwoPass, &[Renderer::Sequential, Renderer::SimdThreads, Renderer::Gpu]),
    ("2", Stage::TwoPass, &Renderer::CPU),
    ("3", Stage::OnePass, &Renderer::ALL),
    ("4", Stage::Exits, &Renderer::ALL),
];

/// One of the four tables.
pub fn table(context: &Context, side: &Side, id: &str) -> Table {
    let (id, stage, renderers) = *TABLES.iter().find(|table| table.0 == id).unwrap_or(&TABLES[0]);
    let columns = renderers.iter().map(|renderer| Column::new(renderer.title(), "ms", Form::Time)).collect();
    let row = |scene: SceneKey| {
        let cell = |renderer: &Renderer| {
            side.cell(&scene, |view, scene| view.stage(scene, *renderer, stage).map(Measurement::number))
        };
        let cells = renderers.iter().map(cell).collect();
        (scene.clone(), Row { keys: keys(&scene), cells })
    };
    let rows = context.scenes(side).into_iter().map(row).collect();
    let mut notes = Vec::new();
    if id == "1" {
        notes.push("The paper's table 1 calls SIMD with threads \"SIMD\".".to_owned());
    }
    if id == "4" {
        notes.push("The exits change SIMD alone: the other columns are those of table 3.".to_owned());
    }
    if !side.is_published {
        notes.push("In the paper's structure: 4 lanes, the hit stored in the loop. Table best has the fastest.".into());
    }
    if side.printed.is_some() {
        notes.push(
            "Image, positions of spheres and constants of the paper are not known, so a ratio to its times says nothing."
                .into(),
        );
    }
    notes.extend(side.notes());
    let title = format!("Mean time per frame, {}", stage.title());
    context.table(side, Draft { id, title, keys: &["scene", "spheres"], columns, rows, notes })
}
