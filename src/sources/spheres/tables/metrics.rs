//! Speed-ups and Karp-Flatt metrics of every version, scene and renderer.

use super::context::{Context, Draft, Side};
use crate::report::{Cell, Column, Form, Number, Row, Table};
use crate::sources::spheres::data::{Measurement, View};
use crate::sources::spheres::metrics::{karp_flatt, remark};
use crate::sources::spheres::scenes::SceneKey;
use crate::sources::spheres::setting::{Renderer, Stage};

/// Sequential time by a row's time, both of one version.
fn speed_up(view: &View, scene: &SceneKey, m: &Measurement, stage: Stage) -> Option<f64> {
    Some(view.stage(scene, Renderer::Sequential, stage)?.mean_ms / m.mean_ms)
}

/// Processors of a renderer, and how they are counted.
fn processors(context: &Context, side: &Side, m: &Measurement) -> Option<(f64, String)> {
    let renderer = m.setting.renderer;
    if side.is_published {
        return context.published.processors(renderer).map(|p| (f64::from(p.processors), p.counted_as.clone()));
    }
    match (renderer, context.options.processors) {
        (Renderer::Gpu, Some(number)) => Some((f64::from(number), "--processors".into())),
        _ => side.view.processors(m).map(|(number, words)| (number as f64, words)),
    }
}

/// Speed-up and metric by the formula of a published time.
fn recomputed(context: &Context, scene: &SceneKey, renderer: Renderer, stage: Stage) -> Option<(f64, Option<f64>)> {
    let printed = context.printed();
    let scene = printed.scene(scene.role).filter(|_| scene.is_of_paper())?;
    let speed_up = speed_up(&printed, &scene, printed.stage(&scene, renderer, stage)?, stage)?;
    let processors = context.published.processors(renderer)?.processors;
    Some((speed_up, karp_flatt(speed_up, f64::from(processors))))
}

/// The row of a renderer in a version; `None` where there is nothing.
fn row(context: &Context, side: &Side, scene: &SceneKey, renderer: Renderer, stage: Stage) -> Option<Row> {
    let measured = side.view.stage(scene, renderer, stage);
    let printed = context.published.metrics(stage, scene.role, renderer);
    let by_formula = recomputed(context, scene, renderer, stage);
    let shows_published = side.is_published || side.printed.is_some();
    if measured.is_none() && !(shows_published && by_formula.is_some()) {
        return None;
    }
    let own = measured.and_then(|m| speed_up(&side.view, scene, m, stage));
    let counted = measured.and_then(|m| processors(context, side, m));
    let number = counted.as_ref().map(|(number, _)| *number);
    let e = own.zip(number).and_then(|(own, number)| karp_flatt(own, number));
    let words = own.map(|own| remark(own, number)).filter(|words| !words.is_empty()).map(str::to_owned);
    let cell = |value: Option<f64>, printed: Option<Number>, by_formula: Option<f64>| {
        if side.is_published {
            return [Cell::Number { value: printed, published: None }, Cell::number(by_formula)];
        }
        let of = |number: Option<Number>| number.filter(|_| side.printed.is_some());
        [
            Cell::Number { value: value.map(Number::from), published: of(printed) },
            Cell::Number { value: None, published: of(by_formula.map(Number::from)) },
        ]
    };
    let [s, s_recomputed] = cell(own, printed.map(|p| p.speed_up), by_formula.map(|(s, _)| s));
    let [e, e_recomputed] = cell(e, printed.map(|p| p.karp_flatt), by_formula.and_then(|(_, e)| e));
    let of_paper = context.published.processors(renderer).filter(|_| side.printed.is_some() && by_formula.is_some());
    let mut cells = vec![
        Cell::Number { value: number.map(whole), published: of_paper.map(|p| whole(f64::from(p.processors))) },
        Cell::Words { value: counted.map(|(_, words)| words), published: of_paper.map(|p| p.counted_as.clone()) },
        s,
        e,
        Cell::Words { value: words, published: None },
    ];
    cells.extend([s_recomputed, e_recomputed].into_iter().filter(|_| shows_published));
    Some(Row { keys: [scene.to_string(), stage.title().into(), renderer.title().into()].into(), cells })
}

fn whole(value: f64) -> Number {
    Number { value, places: Some(0) }
}

/// The table.
pub fn table(context: &Context, side: &Side) -> Table {
    let mut columns = vec![
        Column::of("processors", "p", "", Form::Gain),
        Column::of("processors", "counted as", "", Form::Whole),
        Column::new("S", "", Form::Time),
        Column::new("e", "", Form::Time),
        Column::new("remark", "", Form::Whole),
    ];
    let shows_published = side.is_published || side.printed.is_some();
    if shows_published {
        columns.extend(["S", "e"].map(|name| Column::of("from the printed times", name, "", Form::Time)));
    }
    let mut rows = Vec::new();
    for scene in context.scenes(side) {
        for stage in Stage::ALL {
            // The exits change SIMD alone; the paper has metrics of the GPU for its last version, too
            let is_new = |r: &Renderer| stage != Stage::Exits || r.has_lanes() || *r == Renderer::Gpu;
            for renderer in Renderer::ALL.into_iter().filter(is_new) {
                let row = row(context, side, &scene, renderer, stage);
                rows.extend(row.map(|row| (scene.clone(), row)));
            }
        }
    }
    let mut notes = vec![
        "S: sequential time by time, both of one version and with the hit stored in the loop. e = (1/S - 1/p) / (1 - \
         1/p), Karp and Flatt: the serial share of p equal processors, which lanes, slow cores and a GPU's units are not."
            .to_owned(),
    ];
    notes.push(
        "Remarks: a single processor (p = 1) has no e; slower than sequential (S < 1) is an e above 1, faster than so \
         many processors (S > p) one below 0."
            .into(),
    );
    if shows_published {
        notes.push(
            "No printed e follows from this formula: 0.680, 0.0023, 0.206 and 0.0020 would be 0.615, 0.00037, 0.141 and \
             0.000027. All four follow, the first but for its last digit, if 1/p is added instead of subtracted."
                .into(),
        );
    }
    if !side.is_published && context.options.processors.is_none() && side.view.place.gpu.is_some() {
        notes.push("No driver says how many processors a GPU has: --processors N gives it a metric.".into());
    }
    notes.extend(side.notes());
    let title = "Speed-up and Karp-Flatt metric".to_owned();
    let draft = Draft { id: "metrics", title, keys: &["scene", "version", "renderer"], columns, rows, notes };
    context.table(side, draft)
}
