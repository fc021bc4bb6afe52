//! Figure 4.4: frames per second, the kd-tree's gain over the BVH, and steps per ray.

use super::context::{Context, Gains, Place};
use crate::report::{Cell, Column, Form, Row, Table};
use crate::sources::rt2::data::{Cost, Data, Measurement, Size};
use crate::sources::rt2::models::SceneKey;
use crate::sources::rt2::published::Quantity;
use crate::sources::rt2::structures::{BIH, BVH, CULLED, ROPES, SPATIAL, STACK, Structure, UNPUSHED};

const ID: &str = "4.4";

/// Structures of figure 4.4, like for like: neither BVH nor kd-tree leaves out what lies behind the nearest hit.
const ALIKE: [&Structure; 3] = [&ROPES, &STACK, &BVH];

/// The same with a BVH that does.
const WITH_CULLED: [&Structure; 3] = [&ROPES, &STACK, &CULLED];

/// Structures that the document did not measure.
const BEYOND: [&Structure; 3] = [&UNPUSHED, &SPATIAL, &BIH];

/// The number of failed measurements that a note spells out.
const MAX_SPELT_OUT: usize = 4;

/// The tables of each device; without runs, the printed orders and percentages.
pub fn tables(context: &Context) -> Vec<Table> {
    let Some(data) = context.data else {
        let places = context.places(&[]);
        return vec![
            rates(context, &places, "Frames per second, fastest first", |_, _| None),
            gains(context, &places, "Gain of the kd-tree over the BVH in frames per second".into(), |_, _| None),
        ];
    };
    (0..data.devices.len()).flat_map(|device| of_device(context, data, device)).collect()
}

fn of_device(context: &Context, data: &Data, device: usize) -> Vec<Table> {
    let size = data.size(device, context.published.size(), context.options.resolution);
    let label = format!("{}x{}, P, {}", size.0, size.1, data.devices[device].label);
    let places = context.places(&data.scenes_of(device));
    let at = |scene: &SceneKey, structure: &Structure| data.measurement((device, size), scene, structure);
    let rate = |scene: &SceneKey, structure: &Structure| {
        at(scene, structure).map(|m| Measurement::per_second(m.frame.mean_ms))
    };
    let ratio = |cost: Cost| {
        move |scene: &SceneKey, kind: usize| {
            let of = |structure| Some(data.cost((device, size), scene, structure, cost)?.value);
            Some(of([&BVH, &CULLED][kind])? / of(&STACK)?)
        }
    };
    let mut first = rates(context, &places, &format!("Frames per second at {label}"), rate);
    notes(data, device, size, &mut first);
    let mut by_steps =
        gains(context, &places, format!("Gain of the kd-tree over the BVH in steps, {label}"), ratio(Cost::Steps));
    by_steps.notes.push("Steps are no times: they are here for devices whose times say nothing about a GPU.".into());
    vec![
        first,
        gains(
            context,
            &places,
            format!("Gain of the kd-tree over the BVH in frames per second, {label}"),
            ratio(Cost::Time),
        ),
        steps(context, &places, &label, |scene, structure| at(scene, structure)),
        by_steps,
        beyond(context, &places, &label, rate),
    ]
}

/// Frames per second, with the order of the three structures for either BVH.
fn rates(
    context: &Context,
    places: &[Place],
    title: &str,
    rate: impl Fn(&SceneKey, &Structure) -> Option<f64>,
) -> Table {
    let (alike, culled) = ("as printed", "culled");
    let mut columns: Vec<Column> = ALIKE.iter().map(|s| Column::of(alike, s.title, "1/s", Form::Time)).collect();
    columns.push(Column::of(alike, "fastest first", "", Form::Whole));
    columns.push(Column::of(culled, "BVH", "1/s", Form::Time));
    columns.push(Column::of(culled, "fastest first", "", Form::Whole));
    let row = |place: &Place| {
        let of = |structure: &Structure| place.scene.as_ref().and_then(|scene| rate(scene, structure));
        let named = |structures: [&'static Structure; 3]| structures.map(|s| (short(s), of(s)));
        let mut cells: Vec<Cell> = ALIKE.iter().map(|s| Cell::number(of(s))).collect();
        cells.push(context.order(place, Quantity::FrameRate, &named(ALIKE), true));
        cells.push(Cell::number(of(&CULLED)));
        // The document's BVH was not culled, so that its order is no published one of these
        let without = Place { model: None, ..place.clone() };
        cells.push(context.order(&without, Quantity::FrameRate, &named(WITH_CULLED), true));
        (place.clone(), Row { keys: context.keys(place), cells })
    };
    context.table(ID, title.into(), &["model", "scene"], columns, places.iter().map(row).collect())
}

/// The name of a structure in an order: the same for either BVH.
fn short(structure: &'static Structure) -> &'static str {
    match structure {
        kdtree if *kdtree == STACK => "kd",
        culled if *culled == CULLED => BVH.title,
        other => other.title,
    }
}

fn gains(context: &Context, places: &[Place], title: String, ratio: impl Fn(&SceneKey, usize) -> Option<f64>) -> Table {
    let kinds = [("as printed", true), ("culled", false)];
    context.gains(ID, title, places, &Gains { quantity: Quantity::FrameRate, key: "BVH", kinds }, ratio)
}

/// Steps per ray of every structure.
fn steps<'a>(
    context: &Context,
    places: &[Place],
    label: &str,
    at: impl Fn(&SceneKey, &Structure) -> Option<&'a Measurement>,
) -> Table {
    let mut columns: Vec<Column> = ALIKE.iter().map(|s| Column::new(s.title, "", Form::Fixed(2))).collect();
    columns.push(Column::new("fewest first", "", Form::Whole));
    columns.push(Column::new("culled", "", Form::Fixed(2)));
    columns.extend(BEYOND.iter().map(|s| Column::new(s.title, "", Form::Fixed(2))));
    let convention = context.options.convention;
    let row = |place: &Place| {
        let of = |structure: &Structure| Some(at(place.scene.as_ref()?, structure)?.steps()?.by(convention));
        let mut cells: Vec<Cell> = ALIKE.iter().map(|s| Cell::number(of(s))).collect();
        cells.push(context.order(place, Quantity::FrameRate, &ALIKE.map(|s| (short(s), of(s))), false));
        cells.extend([&CULLED].into_iter().chain(BEYOND).map(|s| Cell::number(of(s))));
        (place.clone(), Row { keys: context.keys(place), cells })
    };
    let rows = places.iter().map(row).collect();
    let mut table = context.table(ID, format!("Steps per ray, {label}"), &["model", "scene"], columns, rows);
    table.notes.push(format!("A step here: {}. The document has no counts.", convention.in_words()));
    table
}

/// Frames per second of what the document did not measure.
fn beyond(
    context: &Context,
    places: &[Place],
    label: &str,
    rate: impl Fn(&SceneKey, &Structure) -> Option<f64>,
) -> Table {
    let columns = BEYOND.iter().map(|s| Column::new(s.title, "1/s", Form::Time)).collect();
    let row = |place: &Place| {
        let of = |structure: &Structure| place.scene.as_ref().and_then(|scene| rate(scene, structure));
        let cells = BEYOND.iter().map(|s| Cell::number(of(s))).collect();
        (place.clone(), Row { keys: context.keys(place), cells })
    };
    let rows = places.iter().map(row).collect();
    let title = format!("Frames per second of structures beyond the document, {label}");
    context.table(ID, title, &["model", "scene"], columns, rows)
}

/// Notes on a device's times.
fn notes(data: &Data, device: usize, size: Size, table: &mut Table) {
    if data.devices[device].is_software() {
        table.notes.push("This device computes on the CPU: its times do not rank structures for a GPU.".into());
    }
    if data.devices[device].checked {
        table.notes.push("Kernels had wgpu's bounds checks.".into());
    }
    let mut sizes: Vec<Size> = data
        .measurements
        .iter()
        .map(|m| &m.frame)
        .filter(|f| f.device == device)
        .map(|f| (f.width, f.height))
        .collect();
    sizes.sort_unstable();
    sizes.dedup();
    sizes.retain(|other| *other != size);
    if !sizes.is_empty() {
        let words: Vec<String> = sizes.iter().map(|(width, height)| format!("{width}x{height}")).collect();
        table.notes.push(format!("Measured at other sizes as well: {}; see --resolution.", words.join(", ")));
    }
    let repeated = data.measurements.iter().filter(|m| m.frame.device == device && m.frame.repeated).count();
    if repeated > 0 {
        table.notes.push(format!(
            "{repeated} of these measurements were made more than once; the last complete one is shown."
        ));
    }
    let failed: Vec<String> =
        data.failures.iter().filter(|f| f.device == device).map(|f| format!("{} ({})", f.what, f.message)).collect();
    if !failed.is_empty() {
        let more = failed.len().saturating_sub(MAX_SPELT_OUT);
        let more = if more > 0 { format!("; and {more} more") } else { String::new() };
        let spelt = failed[..failed.len().min(MAX_SPELT_OUT)].join("; ");
        table.notes.push(format!("Measured without a usable result, so without a number: {spelt}{more}."));
    }
}
