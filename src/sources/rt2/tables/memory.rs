//! Figure 4.6: memory by the model and as allocated, and the counts that the model is made of.

use super::context::{Context, Place};
use crate::report::{Cell, Column, Form, Row, Table};
use crate::sources::rt2::data::{Built, Data};
use crate::sources::rt2::models::SceneKey;
use crate::sources::rt2::published::Quantity;
use crate::sources::rt2::structures::{BIH, KDTREES, SPATIALS, SWEPT, Trees, WITH_ROPES};
use crate::workloads::trace::record::Memory;

const ID: &str = "4.6";

/// The three structures with their names in orders.
const THREE: [(&str, Trees); 3] = [("kd", KDTREES), ("BVH", SWEPT), ("ropes", WITH_ROPES)];

/// The bounding interval hierarchy.
const BIHS: Trees = &[&BIH];

/// Bytes of a BVH node in the model.
const NODE_BYTES: f64 = 48.0;

/// Memory with its orders, and the counts behind it; without runs, the printed order.
pub fn tables(context: &Context) -> Vec<Table> {
    let Some(data) = context.data else {
        return vec![sizes(context, &context.places(&[]), |_, _| None)];
    };
    let places = context.places(&data.scenes_built());
    let built = |scene: &SceneKey, trees: Trees| data.built(None, scene, trees);
    vec![
        sizes(context, &places, |scene, trees| built(scene, trees)?.memory),
        counts(context, &places, data),
        beyond(context, &places, data),
    ]
}

fn mib(bytes: u64) -> f64 {
    bytes as f64 / f64::from(1 << 20)
}

fn sizes(context: &Context, places: &[Place], memory: impl Fn(&SceneKey, Trees) -> Option<Memory>) -> Table {
    type Size = (&'static str, fn(&Memory) -> u64);
    let sizes: [Size; 2] = [("model", |memory| memory.rt2_bytes), ("actual", |memory| memory.structure_bytes)];
    let mut columns = Vec::new();
    for (group, _) in sizes {
        columns.extend(THREE.iter().map(|(name, _)| Column::of(group, name, "MiB", Form::Fixed(2))));
        columns.push(Column::of(group, "smallest first", "", Form::Whole));
    }
    let row = |place: &Place| {
        let mut cells = Vec::new();
        for (group, bytes) in sizes {
            let of = |trees: Trees| Some(mib(bytes(&memory(place.scene.as_ref()?, trees)?)));
            cells.extend(THREE.iter().map(|(_, trees)| Cell::number(of(trees))));
            // Only the model says what the document could have counted
            let of_model = if group == "model" { place.clone() } else { Place { model: None, ..place.clone() } };
            cells.push(context.order(
                &of_model,
                Quantity::Memory,
                &THREE.map(|(name, trees)| (name, of(trees))),
                false,
            ));
        }
        (place.clone(), Row { keys: context.keys(place), cells })
    };
    let rows = places.iter().map(row).collect();
    let title = if context.data.is_none() { "Memory, smallest first" } else { "Memory of structures" };
    let mut table = context.table(ID, title.into(), &["model", "scene"], columns, rows);
    if context.data.is_some() {
        table.notes.push(
            "Model: 8 bytes for a kd-tree node, 4 for a reference, 48 for the box and the six links of a leaf with \
             ropes, 48 for a BVH node. Actual: as allocated here. Geometry is in neither size."
                .into(),
        );
    }
    table
}

/// Leaves, references and nodes per triangle, which the model's bytes are made of.
fn counts(context: &Context, places: &[Place], data: &Data) -> Table {
    type Count = (&'static str, &'static str, &'static str, Form, fn(&Data, &SceneKey) -> Option<f64>);
    fn per_triangle(scene: &SceneKey, number: f64) -> f64 {
        number / scene.triangles.max(1) as f64
    }
    fn bytes(data: &Data, scene: &SceneKey, trees: Trees) -> Option<f64> {
        Some(data.built(None, scene, trees)?.memory?.rt2_bytes as f64)
    }
    let columns: [Count; 6] = [
        ("kd-tree", "leaves", "/triangle", Form::Fixed(3), |data, scene| {
            Some(per_triangle(scene, f64::from(data.built(None, scene, KDTREES)?.properties.leaves?)))
        }),
        ("kd-tree", "references", "/triangle", Form::Fixed(3), |data, scene| {
            data.built(None, scene, KDTREES)?.properties.references_per_triangle
        }),
        ("BVH", "nodes", "/triangle", Form::Fixed(3), |data, scene| {
            Some(per_triangle(scene, bytes(data, scene, SWEPT)? / NODE_BYTES))
        }),
        ("model", "kd-tree", "B/triangle", Form::Fixed(1), |data, scene| {
            Some(per_triangle(scene, bytes(data, scene, KDTREES)?))
        }),
        ("model", "BVH", "B/triangle", Form::Fixed(1), |data, scene| {
            Some(per_triangle(scene, bytes(data, scene, SWEPT)?))
        }),
        ("model", "ropes", "B/triangle", Form::Fixed(1), |data, scene| {
            Some(per_triangle(scene, bytes(data, scene, WITH_ROPES)?))
        }),
    ];
    let headings = columns.iter().map(|(group, name, unit, form, _)| Column::of(group, name, unit, *form)).collect();
    let row = |place: &Place| {
        let cell = |(.., of): &Count| Cell::number(place.scene.as_ref().and_then(|scene| of(data, scene)));
        (place.clone(), Row { keys: context.keys(place), cells: columns.iter().map(cell).collect() })
    };
    let rows = places.iter().map(row).collect();
    context.table(ID, "What the sizes are made of".into(), &["model", "scene"], headings, rows)
}

/// Expected costs, and the structures that the document did not measure.
fn beyond(context: &Context, places: &[Place], data: &Data) -> Table {
    type Property = (&'static str, &'static str, Trees, fn(&Built) -> Option<f64>);
    let columns: [Property; 7] = [
        ("expected cost", "kd-tree", KDTREES, |b| b.properties.sah_cost),
        ("expected cost", "BVH", SWEPT, |b| b.properties.sah_cost),
        ("expected cost", "spatial", SPATIALS, |b| b.properties.sah_cost),
        ("spatial", "splits", SPATIALS, |b| b.properties.spatial_splits.map(f64::from)),
        ("spatial", "references", SPATIALS, |b| b.properties.references_per_triangle),
        ("model, MiB", "spatial", SPATIALS, |b| b.memory.map(|m| mib(m.rt2_bytes))),
        ("model, MiB", "BIH", BIHS, |b| b.memory.map(|m| mib(m.rt2_bytes))),
    ];
    let form = |name| if name == "splits" { Form::Whole } else { Form::Fixed(2) };
    let headings = columns.iter().map(|(group, name, ..)| Column::of(group, name, "", form(*name))).collect();
    let row = |place: &Place| {
        let cell = |(_, _, trees, of): &Property| {
            Cell::number(place.scene.as_ref().and_then(|scene| of(data.built(None, scene, trees)?)))
        };
        (place.clone(), Row { keys: context.keys(place), cells: columns.iter().map(cell).collect() })
    };
    let rows = places.iter().map(row).collect();
    let title = "Expected costs, and structures beyond the document";
    let mut table = context.table(ID, title.into(), &["model", "scene"], headings, rows);
    table
        .notes
        .push("Expected cost: the surface area heuristic with a cost of 1 for a node and 1 for a triangle.".into());
    table
}
