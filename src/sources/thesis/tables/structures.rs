//! Tables 5.1 and 5.3 to 5.6, which do not depend on the device.

use super::context::{Context, repeated};
use crate::report::{Cell, Column, Form, Row, Table};
use crate::scene::catalogue;
use crate::sources::rows::BuiltBy;
use crate::sources::thesis::data::{Built, Data};
use crate::sources::thesis::scenes::SceneKey;
use crate::sources::thesis::structures::{BVH, GRID, KDTREE, STRUCTURES, title};
use crate::workloads::trace::Properties;

/// A column of table 5.4, 5.5 or 5.6: heading, unit, form, and its number.
type PropertyColumn = (&'static str, &'static str, Form, fn(&Built) -> Option<f64>);

/// Table 5.1.
pub fn scenes(context: &Context) -> Table {
    let columns = ["triangles", "vertices", "lights"].map(|name| Column::new(name, "", Form::Whole));
    let rows = context.scenes().into_iter().map(|key| {
        let cells = vec![
            context.cell(|data| Some(data.scene(&key)?.triangles as f64)),
            context.cell(|data| Some(data.scene(&key)?.vertices as f64)),
            context.cell(|data| Some(data.scene(&key)?.lights?.max(path_lights(data, &key)) as f64)),
        ];
        (key.clone(), Row { keys: vec![key.to_string()], cells })
    });
    let rows: Vec<_> = rows.collect();
    let mut table = context.table("5.1", "Scenes".into(), &["scene"], columns.into(), rows);
    if !context.data.published {
        let lit = |key: &&SceneKey| path_lights(context.data, key) > 0;
        let lit: Vec<String> =
            context.data.scenes.iter().map(|s| &s.key).filter(lit).map(ToString::to_string).collect();
        if !lit.is_empty() {
            table.notes.push(format!("Light of the camera path, because the file has none: {}.", lit.join(", ")));
        }
        table.notes.push(
            "Other lights are those of the scene's file or the catalogue's; with 0 the camera path brings its own."
                .into(),
        );
    }
    table
}

/// Lights of the camera path that a thesis's scene is measured with, where its file has none. Records have the file's
/// number only; the catalogue has the one that the scene is measured with.
fn path_lights(data: &Data, key: &SceneKey) -> u64 {
    let without = key.thesis().filter(|_| data.scene(key).is_some_and(|scene| scene.lights == Some(0)));
    let lights = without.and_then(|scene| catalogue::find(scene.name())?.lights);
    lights.unwrap_or(0) as u64
}

/// Table 5.3: one per processor and number of threads, the fewest threads first. A column of two processors would
/// compare the processors and not the structures, and a run on all cores would hide one on a single core, as the
/// thesis's was.
pub fn build_times(context: &Context) -> Vec<Table> {
    if context.data.published {
        return vec![build_times_by(context, None)];
    }
    let scenes = context.scenes();
    let has_any = |by: &BuiltBy| {
        scenes.iter().any(|key| STRUCTURES.iter().any(|s| context.data.thesis_built_by(Some(*by), key, s).is_some()))
    };
    let builders: Vec<BuiltBy> = context.data.builders().into_iter().filter(has_any).collect();
    if builders.is_empty() {
        return vec![build_times_by(context, None)];
    }
    builders.into_iter().map(|by| build_times_by(context, Some(by))).collect()
}

/// Build times of one builder, or of any builder.
fn build_times_by(context: &Context, by: Option<BuiltBy>) -> Table {
    let columns = STRUCTURES.map(|s| Column::new(title(s), "ms", Form::Time));
    let time = |data: &Data, key: &SceneKey, structure: &str| {
        // The thesis had another processor
        let by = by.filter(|_| !data.published);
        data.thesis_built_by(by, key, structure)?.time()
    };
    let row = |key: &SceneKey| Row {
        keys: vec![key.to_string()],
        cells: STRUCTURES.map(|s| context.cell(|data| time(data, key, s))).into(),
    };
    let rows: Vec<_> = context.scenes().into_iter().map(|key| (key.clone(), row(&key))).collect();
    let built: Vec<&Built> = shown(context, by, &rows, &STRUCTURES);
    let title = by.map_or("Build times".into(), |by| format!("Build times, {}", by.in_words()));
    let mut table = context.table("5.3", title, &["scene"], columns.into(), rows);
    if !context.data.published {
        table.notes.extend(times_built(&built));
    }
    if context.options.published {
        table.notes.push("Published: one core of an Athlon64 X2, 2 GHz.".into());
    }
    table.notes.extend(repeated(built.iter().filter(|b| b.repeated).count()));
    table
}

/// The number of builds that a time is the median of.
fn times_built(built: &[&Built]) -> Option<String> {
    let mut numbers: Vec<usize> = built.iter().map(|b| b.builds).collect();
    numbers.sort_unstable();
    numbers.dedup();
    match numbers[..] {
        [] => None,
        [1] => Some("Each structure was built once.".into()),
        [number] => Some(format!("Each time is the median of {number} builds.")),
        _ => {
            let words: Vec<String> = numbers.iter().map(ToString::to_string).collect();
            Some(format!("Times are medians of unlike numbers of builds: {}.", words.join(" or ")))
        }
    }
}

/// The structures behind a table's rows.
fn shown<'a>(
    context: &Context<'a>,
    by: Option<BuiltBy>,
    rows: &[(SceneKey, Row)],
    structures: &[&str],
) -> Vec<&'a Built> {
    let data = context.data;
    rows.iter().flat_map(|(key, _)| structures.iter().filter_map(|s| data.thesis_built_by(by, key, s))).collect()
}

/// Table 5.4.
pub fn grid(context: &Context) -> Table {
    let columns: [PropertyColumn; 6] = [
        ("x", "cells", Form::Whole, |b| whole(b, |p| p.cells_x)),
        ("y", "cells", Form::Whole, |b| whole(b, |p| p.cells_y)),
        ("z", "cells", Form::Whole, |b| whole(b, |p| p.cells_z)),
        ("fullest cell", "triangles", Form::Whole, |b| whole(b, |p| p.max_cell_triangles)),
        ("references", "per triangle", Form::Fixed(2), |b| b.properties.references_per_triangle),
        SIZE,
    ];
    let mut table = properties(context, "5.4", GRID, "Properties of the uniform grid", &columns);
    let by_rule = |key: &&SceneKey| {
        let setting = key.thesis().and_then(|scene| scene.grid_setting());
        setting.is_some() && context.data.thesis_built(key, GRID).is_none()
    };
    for key in context.data.scenes.iter().map(|s| &s.key).filter(by_rule) {
        if let Some((axis, cells)) = key.thesis().and_then(|scene| scene.grid_setting()) {
            table.notes.push(format!(
                "The thesis set the grid of {key} by hand: measure --structure grid:{axis}={cells} to fill its row."
            ));
        }
    }
    table
}

/// Table 5.5.
pub fn kdtree(context: &Context) -> Table {
    let columns: [PropertyColumn; 5] = [
        ("leaves", "", Form::Whole, |b| whole(b, |p| p.leaves)),
        ("empty leaves", "", Form::Whole, |b| whole(b, |p| p.empty_leaves)),
        ("largest leaf", "triangles", Form::Whole, |b| whole(b, |p| p.max_leaf_triangles)),
        ("references", "per triangle", Form::Fixed(2), |b| b.properties.references_per_triangle),
        SIZE,
    ];
    properties(context, "5.5", KDTREE, "Properties of the kd-tree", &columns)
}

/// Table 5.6.
pub fn bvh(context: &Context) -> Table {
    let columns: [PropertyColumn; 2] = [("nodes", "", Form::Whole, |b| whole(b, |p| p.nodes)), SIZE];
    properties(context, "5.6", BVH, "Properties of the BVH", &columns)
}

const SIZE: PropertyColumn = ("size", "MiB", Form::Fixed(2), |b| b.thesis_mib);

fn whole(built: &Built, property: fn(&Properties) -> Option<u32>) -> Option<f64> {
    property(&built.properties).map(f64::from)
}

fn properties(context: &Context, id: &str, structure: &str, title: &str, columns: &[PropertyColumn]) -> Table {
    let mut headings: Vec<Column> =
        columns.iter().map(|(name, unit, form, _)| Column::new(name, unit, *form)).collect();
    if !context.data.published {
        headings.push(Column::new("allocated", "MiB", Form::Fixed(2)));
    }
    let rows: Vec<_> = context
        .scenes()
        .into_iter()
        .map(|key| {
            let column = |of: &fn(&Built) -> Option<f64>| context.cell(|data| of(data.thesis_built(&key, structure)?));
            let mut cells: Vec<Cell> = columns.iter().map(|(.., of)| column(of)).collect();
            if !context.data.published {
                let allocated = context.data.thesis_built(&key, structure).and_then(Built::allocated_mib);
                cells.push(Cell::number(allocated));
            }
            (key.clone(), Row { keys: vec![key.to_string()], cells })
        })
        .collect();
    // Unlike a build time, a property does not depend on the builder
    let again = |b: &&&Built| b.repeated || context.data.all_built(&b.scene, structure, &b.variant).count() > 1;
    let count = shown(context, None, &rows, &[structure]).iter().filter(again).count();
    let mut table = context.table(id, title.into(), &["scene"], headings, rows);
    if !context.data.published {
        table.notes.push("Sizes include the geometry: as the thesis counts them, and as allocated.".into());
    }
    table.notes.extend(repeated(count));
    table
}
