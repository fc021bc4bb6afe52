//! The fastest measured setting of each renderer, against its last version in the paper's structure.

use super::context::{Context, Draft, Side};
use crate::report::{Cell, Column, Form, Row, Table};
use crate::sources::spheres::data::{Measurement, View};
use crate::sources::spheres::scenes::SceneKey;
use crate::sources::spheres::setting::{Renderer, Stage, WORDS};

/// The fastest row of a renderer in single precision.
pub fn fastest<'a>(view: &View<'a>, scene: &SceneKey, renderer: Renderer) -> Option<&'a Measurement> {
    let is = |m: &&Measurement| m.scene == *scene && m.setting.renderer == renderer && !m.setting.half;
    view.rows().filter(is).min_by(|a, b| a.mean_ms.total_cmp(&b.mean_ms))
}

/// The table.
pub fn table(context: &Context, side: &Side) -> Table {
    let columns = vec![
        Column::of("fastest", "setting", "", Form::Whole),
        Column::of("fastest", "instructions", "", Form::Whole),
        Column::of("fastest", "time", "ms", Form::Time),
        Column::of("paper's structure", "time", "ms", Form::Time),
        Column::of("gain", "over it", "", Form::Fixed(2)),
        Column::of("gain", "over sequential", "", Form::Fixed(2)),
    ];
    let mut rows = Vec::new();
    if !side.is_published {
        for scene in context.scenes(side) {
            for renderer in Renderer::ALL {
                let best = fastest(&side.view, &scene, renderer);
                let own = side.view.stage(&scene, renderer, Stage::Exits);
                let sequential = fastest(&side.view, &scene, Renderer::Sequential);
                let gain = |of: Option<&Measurement>| of.zip(best).map(|(of, best)| of.mean_ms / best.mean_ms);
                let instructions = best.and_then(|m| m.work.as_ref()).map(|w| w.instructions.clone());
                let cells = vec![
                    Cell::Words { value: best.map(|m| m.setting.switches()), published: None },
                    Cell::Words { value: instructions.filter(|i| !i.is_empty()), published: None },
                    Cell::number(best.map(|m| m.mean_ms)),
                    Cell::number(own.map(|m| m.mean_ms)),
                    Cell::number(gain(own)),
                    Cell::number(gain(sequential)),
                ];
                let row = Row { keys: vec![scene.to_string(), renderer.title().to_owned()], cells };
                // A scene of the paper that was not measured has a row of dashes
                if row.is_filled() || (scene.is_of_paper() && renderer == Renderer::Sequential) {
                    rows.push((scene.clone(), row));
                }
            }
        }
    }
    let notes = vec![
        "The paper's structure here: one-pass, all exits, 4 lanes, the hit stored in the loop. Over sequential: against \
         the fastest sequential setting."
            .to_owned(),
        WORDS.to_owned(),
    ];
    let title = "Fastest settings".to_owned();
    context.table(side, Draft { id: "best", title, keys: &["scene", "renderer"], columns, rows, notes })
}
