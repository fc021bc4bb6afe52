//! The work of a frame: rays and hits per bounce, tests, and what vectors waste.

use super::context::{Context, Draft, Side};
use crate::report::{Cell, Column, Form, Row, Table};
use crate::sources::spheres::data::{Measurement, Work};
use crate::sources::spheres::scenes::SceneKey;
use crate::sources::spheres::setting::{Renderer, Stage};

const ID: &str = "work";

/// Rays and hits of each scene, and the work of each version and renderer.
pub fn tables(context: &Context, side: &Side) -> Vec<Table> {
    vec![bounces(context, side), renderers(context, side)]
}

/// Work and measurement of a row with counts.
fn counted(m: &Measurement) -> Option<(&Measurement, &Work)> {
    m.work.as_ref().map(|work| (m, work))
}

fn bounces(context: &Context, side: &Side) -> Table {
    let columns = vec![
        Column::of("per frame", "rays", "", Form::Whole),
        Column::of("per frame", "hits", "", Form::Whole),
        Column::of("share", "of the pixels", "", Form::Fixed(4)),
        Column::of("share", "that hits", "", Form::Fixed(4)),
    ];
    let mut rows = Vec::new();
    for scene in context.scenes(side) {
        // Every renderer counts the same rays and hits
        let found = side.view.rows().filter(|m| m.scene == scene && !m.setting.half).find_map(counted);
        let Some((m, work)) = found else {
            let cells = columns.iter().map(|_| Cell::number(None)).collect();
            rows.push((scene.clone(), Row { keys: vec![scene.to_string(), String::new()], cells }));
            continue;
        };
        let frames = m.terms.frames.max(1) as f64;
        let pixels = f64::from(m.terms.width) * f64::from(m.terms.height) * frames;
        for (index, (rays, hits)) in work.bounces.iter().enumerate() {
            let (rays, hits) = (*rays as f64, *hits as f64);
            let cells = vec![
                Cell::number(rays / frames),
                Cell::number(hits / frames),
                Cell::number(rays / pixels),
                Cell::number((rays > 0.0).then(|| hits / rays)),
            ];
            rows.push((scene.clone(), Row { keys: vec![scene.to_string(), (index + 1).to_string()], cells }));
        }
    }
    let notes = vec!["Bounce 1 is the primary ray. Rays of paths that missed before are not in it.".to_owned()];
    let title = "Rays and hits per bounce".to_owned();
    context.table(side, Draft { id: ID, title, keys: &["scene", "bounce"], columns, rows, notes })
}

/// The cells of a row with counts.
fn cells(m: &Measurement, work: &Work, scene: &SceneKey) -> Vec<Cell> {
    let frames = m.terms.frames.max(1) as f64;
    let all = (work.tests + work.wasted_tests) as f64;
    let of_vectors = |count: u64| {
        let spheres = work.vectors as f64 * scene.spheres as f64;
        Cell::number((spheres > 0.0).then(|| count as f64 / spheres))
    };
    let paths = f64::from(m.terms.width) * f64::from(m.terms.height) * frames;
    // A row's last vector may reach beyond its end
    let vectors = f64::from(m.terms.width.div_ceil(m.setting.lanes.max(1) as u32)) * f64::from(m.terms.height) * frames;
    let paths = if m.setting.lanes > 1 { vectors } else { paths };
    vec![
        Cell::number(work.tests as f64 / frames),
        Cell::number((all > 0.0).then(|| work.wasted_tests as f64 / all)),
        Cell::number(work.occupancy),
        Cell::number((paths > 0.0).then(|| work.exits_on_miss as f64 / paths)),
        of_vectors(work.skips_no_hit),
        of_vectors(work.skips_no_discriminant),
    ]
}

fn renderers(context: &Context, side: &Side) -> Table {
    let columns = vec![
        Column::of("per frame", "tests", "", Form::Whole),
        Column::of("share", "wasted", "", Form::Fixed(3)),
        Column::of("share", "occupied lanes", "", Form::Fixed(3)),
        Column::of("fires", "exit on a miss", "/path", Form::Fixed(3)),
        Column::of("fires", "no hit", "/test", Form::Fixed(3)),
        Column::of("fires", "no discriminant", "/test", Form::Fixed(3)),
    ];
    let mut rows = Vec::new();
    for scene in context.scenes(side) {
        for stage in Stage::ALL {
            for renderer in Renderer::ALL {
                let is_new = stage != Stage::Exits || renderer.has_lanes();
                let found = side.view.stage(&scene, renderer, stage).filter(|_| is_new).and_then(counted);
                let Some((m, work)) = found else { continue };
                let keys = [scene.to_string(), stage.title().into(), renderer.title().into()];
                rows.push((scene.clone(), Row { keys: keys.into(), cells: cells(m, work, &scene) }));
            }
        }
    }
    let notes = vec![
        "Tests of live rays; wasted are those of dead paths and of lanes beyond the end of a row, as a share of all. The \
         exit on a miss: of all paths, or vectors of paths, those that it ended before their last trip. The other two: \
         of all tests of whole vectors."
            .to_owned(),
    ];
    let title = "Tests, lanes and exits".to_owned();
    let keys = &["scene", "version", "renderer"];
    context.table(side, Draft { id: ID, title, keys, columns, rows, notes })
}
