//! Times and speed-ups over threads, lanes and numbers of spheres.

use super::context::{Context, Draft, Side, keys};
use crate::report::{Cell, Column, Form, Row, Table};
use crate::sources::spheres::curves::{Curve, OverScenes, by_lanes, by_spheres, by_threads};
use crate::sources::spheres::data::Measurement;
use crate::sources::spheres::scenes::{Role, SceneKey};
use crate::sources::spheres::setting::{Renderer, WORDS};

const ID: &str = "scaling";

/// Three tables.
pub fn tables(context: &Context, side: &Side) -> Vec<Table> {
    let threads = side.of(context, |m| m.setting.threads.is_some());
    let lanes = side.of(context, |m| m.setting.renderer.has_lanes() && !m.setting.half);
    let generated = side.of(context, |m| m.scene.role == Role::Generated && !m.setting.half);
    let has_generated = generated.view.rows().any(|m| m.scene.role == Role::Generated);
    vec![
        over_threads(context, &threads),
        over_lanes(context, &lanes),
        over_spheres(context, if has_generated { &generated } else { side }),
    ]
}

fn over_threads(context: &Context, side: &Side) -> Table {
    let columns = vec![
        Column::new("time", "ms", Form::Time),
        Column::new("over one thread", "", Form::Fixed(2)),
        Column::new("share of the threads", "", Form::Fixed(2)),
    ];
    let of = |curve: &Curve| {
        let one = curve.points.iter().find(|(n, _)| *n == 1).map(|(_, m)| *m).or_else(|| curve.base(&side.view, true));
        rows(curve, |number, m| {
            let gain = one.map(|one| one.mean_ms / m.mean_ms);
            vec![Cell::number(m.mean_ms), Cell::number(gain), Cell::number(gain.map(|gain| gain / number as f64))]
        })
    };
    let curves = if side.is_published { Vec::new() } else { by_threads(&side.view) };
    let notes = vec![
        "Over one thread: against the same renderer with one thread; where that was not measured, without a pool."
            .to_owned(),
        WORDS.to_owned(),
    ];
    let keys = &["scene", "renderer", "switches", "threads"];
    draft(context, side, ("Times over threads", keys), columns, curves.iter().flat_map(of).collect(), notes)
}

fn over_lanes(context: &Context, side: &Side) -> Table {
    let columns = vec![Column::new("time", "ms", Form::Time), Column::new("over sequential", "", Form::Fixed(2))];
    let of = |curve: &Curve| {
        let sequential = curve.base(&side.view, false);
        rows(curve, |_, m| {
            vec![Cell::number(m.mean_ms), Cell::number(sequential.map(|sequential| sequential.mean_ms / m.mean_ms))]
        })
    };
    let curves = if side.is_published { Vec::new() } else { by_lanes(&side.view) };
    let notes = vec![
        "Over sequential: with the same algorithm, exit on a miss and record of the hit.".to_owned(),
        WORDS.to_owned(),
    ];
    let keys = &["scene", "renderer", "switches", "lanes"];
    draft(context, side, ("Times over lanes", keys), columns, curves.iter().flat_map(of).collect(), notes)
}

/// A row for each point of a curve.
fn rows(curve: &Curve, cells: impl Fn(usize, &Measurement) -> Vec<Cell>) -> Vec<(SceneKey, Row)> {
    let row = |(number, m): &(usize, &Measurement)| {
        let keys = [curve.scene.to_string(), curve.setting.renderer.title().into(), curve.words(), number.to_string()];
        (curve.scene.clone(), Row { keys: keys.into(), cells: cells(*number, m) })
    };
    curve.points.iter().map(row).collect()
}

fn draft(
    context: &Context,
    side: &Side,
    (title, keys): (&str, &'static [&'static str]),
    columns: Vec<Column>,
    rows: Vec<(SceneKey, Row)>,
    notes: Vec<String>,
) -> Table {
    context.table(side, Draft { id: ID, title: title.to_owned(), keys, columns, rows, notes })
}

fn over_spheres(context: &Context, side: &Side) -> Table {
    let of_renderer = by_spheres(&side.view);
    let printed = side.printed.map(|view| by_spheres(&view)).unwrap_or_default();
    let at = |all: &[OverScenes], scene: &SceneKey, renderer: Renderer| {
        let of = all.iter().find(|of| of.setting.renderer == renderer)?;
        of.points.iter().find(|(s, _)| s == scene).map(|(_, m)| m.number())
    };
    let mut columns: Vec<Column> = Renderer::ALL.iter().map(|r| Column::new(r.title(), "ms", Form::Time)).collect();
    columns.push(Column::new("sequential", "ns/test", Form::Time));
    let mut scenes = context.scenes(side);
    scenes.sort_by_key(|scene| scene.spheres);
    let row = |scene: SceneKey| {
        let cell = |renderer: &Renderer| {
            let published = scene.is_of_paper().then(|| SceneKey::published(scene.role));
            let published = published.and_then(|scene| at(&printed, &scene, *renderer));
            Cell::Number { value: at(&of_renderer, &scene, *renderer), published }
        };
        let per_test = |m: &Measurement| {
            let tests = m.work.as_ref().map(|w| w.tests).filter(|tests| *tests > 0)?;
            Some(1e6 * m.mean_ms * m.terms.frames as f64 / tests as f64)
        };
        let sequential = of_renderer.iter().find(|of| of.setting.renderer == Renderer::Sequential);
        let sequential = sequential.and_then(|of| of.points.iter().find(|(s, _)| *s == scene));
        let mut cells: Vec<Cell> = Renderer::ALL.iter().map(cell).collect();
        cells.push(Cell::number(sequential.and_then(|(_, m)| per_test(m))));
        (scene.clone(), Row { keys: keys(&scene), cells })
    };
    let rows = scenes.into_iter().map(row).collect();
    let settings: Vec<String> = of_renderer.iter().map(|of| of.setting.to_string()).collect();
    let mut notes =
        vec!["Of each renderer the setting that was measured on most scenes, of equals the fastest.".into()];
    if !settings.is_empty() {
        notes.push(format!("{}.", settings.join("; ")));
    }
    draft(context, side, ("Times over the number of spheres", &["scene", "spheres"]), columns, rows, notes)
}
