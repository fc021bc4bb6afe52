//! What each option does: a row with it by the row that differs in it alone and has the usual value.

use super::context::{Context, Draft};
use crate::report::{Cell, Column, Form, Row, Table};
use crate::sources::splat::axes::{differing, is_option, value};
use crate::sources::splat::data::{Measurement, View};
use crate::sources::splat::stages::Group;

/// A table for each device.
pub fn tables(context: &Context) -> Vec<Table> {
    context.tables(measured, draft)
}

fn draft() -> Draft {
    let ratio = |group: &str, name: &str| Column::of(group, name, "", Form::Fixed(2));
    let columns = vec![
        ratio("time", "frame"),
        ratio("time", "C"),
        ratio("time", "D"),
        ratio("time", "E"),
        Column::new("assign.", "", Form::Fixed(3)),
        Column::of("box", "tests", "", Form::Fixed(3)),
        Column::of("photon", "eval.", "", Form::Fixed(3)),
        Column::new("RMSE", "", Form::Fixed(3)),
    ];
    let mut draft = Draft::new("options", "Effect of each option", columns);
    draft.keys = vec!["scene", "technique", "option", "at"];
    draft.notes.push("Ratios: the row with the second value by the row with the first; 1: no effect.".into());
    draft
}

/// Pairs of rows that differ in one option, of which the first has the usual value.
pub fn pairs<'a>(view: &View<'a>) -> Vec<(String, &'a Measurement, &'a Measurement)> {
    let mut pairs = Vec::new();
    for variant in view.rows.iter().copied() {
        for base in view.rows.iter().copied().filter(|base| base.technique() == variant.technique()) {
            let [axis] = differing(&base.axes, &variant.axes)[..] else { continue };
            let usual = value(&view.usual, axis);
            if is_option(axis) && base.axis(axis) == usual && base.is_like(variant, &[axis]) {
                pairs.push((axis.to_owned(), base, variant));
            }
        }
    }
    pairs
}

fn measured(view: &View) -> Draft {
    let mut draft = draft();
    let mut pairs = pairs(view);
    pairs.sort_by(|a, b| (&a.2.scene, a.2.technique(), &a.0).cmp(&(&b.2.scene, b.2.technique(), &b.0)));
    for (axis, base, variant) in pairs {
        let by = |of: &dyn Fn(&Measurement) -> Option<f64>| {
            let ratio = of(variant).zip(of(base)).map(|(variant, base)| variant / base);
            Cell::number(ratio.filter(|ratio| ratio.is_finite()))
        };
        let cells = vec![
            by(&|m| Some(m.mean_ms)),
            by(&|m| m.group_ms(Group::C)),
            by(&|m| m.group_ms(Group::D)),
            by(&|m| m.group_ms(Group::E)),
            by(&|m| m.metric("assignments_mean")),
            by(&|m| m.metric("box_tests_mean")),
            by(&|m| m.metric("photon_evaluations_mean")),
            by(&|m| m.metric("rmse")),
        ];
        let words = |m: &Measurement| match m.axis(&axis) {
            "" => "none".to_owned(),
            value => value.to_owned(),
        };
        // What else is not usual belongs to the name of the technique
        let technique = view.words(base);
        let option = format!("{axis}: {} -> {}", words(base), words(variant));
        let keys = vec![variant.scene.to_string(), technique, option, short(base)];
        draft.rows.push(Row { keys, cells });
    }
    let usual: Vec<String> = view.usual.iter().map(|(axis, value)| format!("{axis}={value}")).collect();
    if !usual.is_empty() {
        draft.notes.push(format!("Usual here: {}.", usual.join(", ")));
    }
    draft
}

/// Size, tile, radius and paths in few letters: `480x270/8 0.1 5667`.
fn short(m: &Measurement) -> String {
    let tile = if m.axis("tile").is_empty() { String::new() } else { format!("/{}", m.axis("tile")) };
    format!("{}{tile} {} {}", m.axis("resolution"), m.axis("radius"), m.axis("paths"))
}
