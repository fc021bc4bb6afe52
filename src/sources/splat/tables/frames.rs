//! Frame time and assignments along the animation, next to the ends of the axes of figures 5.5 to 5.8.

use super::context::{Context, Draft, keys, printed_keys};
use crate::report::{Cell, Column, Form, Number, Row, Table};
use crate::sources::splat::data::{Measurement, View};
use crate::sources::splat::published::{Chart, DEVICES};
use crate::sources::splat::scenes::Role;

/// A table for each device.
pub fn tables(context: &Context) -> Vec<Table> {
    context.tables(|view| measured(context, view), || printed(context))
}

fn draft() -> Draft {
    let of =
        |group: &str, unit: &str, form: Form| ["min", "mean", "max"].map(|name| Column::of(group, name, unit, form));
    let columns = of("time", "ms", Form::Time).into_iter().chain(of("assignments", "", Form::Whole)).collect();
    let mut draft = Draft::new("frames", "Frames along the animation", columns);
    draft.notes.push("Printed are ends of axes (figures 5.5 to 5.8): upper bounds of the largest values.".into());
    draft
}

/// The printed bounds of one row.
fn bounds(chart: Option<&Chart>) -> [Option<Number>; 6] {
    let (time, assignments) = (chart.map(|chart| chart.time_max_ms), chart.and_then(|chart| chart.assignments_max));
    [None, None, time, None, None, assignments]
}

fn printed(context: &Context) -> Draft {
    let mut draft = draft();
    draft.keys.push("device");
    for role in Role::THESIS {
        for (device, name) in DEVICES.iter().enumerate() {
            for technique in ["per-sample", "buckets"] {
                let bounds = bounds(context.published.chart(role, technique, device));
                let cells = bounds.map(|value| Cell::Number { value, published: None }).into();
                let mut keys = printed_keys(context.published, role, technique);
                keys.push((*name).to_owned());
                draft.rows.push(Row { keys, cells });
            }
        }
    }
    draft
}

/// Smallest, mean and largest of values; none of no values.
fn spread(values: &[f64]) -> [Option<f64>; 3] {
    if values.is_empty() {
        return [None; 3];
    }
    let (low, high) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
    [low, values.iter().sum::<f64>() / values.len() as f64, high].map(Some)
}

fn measured(context: &Context, view: &View) -> Draft {
    let mut draft = draft();
    let device = context.published_device();
    let rows: Vec<&Measurement> = view.usual_rows().collect();
    for m in &rows {
        let mut assignments = spread(&m.by_frame("assignments"));
        if assignments[1].is_none() {
            assignments = [None, m.metric("assignments_mean"), m.metric("assignments_max")];
        }
        let own = spread(&m.frames_ms).into_iter().chain(assignments);
        let bounds = bounds(context.published.chart(m.scene.role, m.technique(), device));
        let cells = own.zip(bounds).map(|(own, bound)| context.cell(own, bound)).collect();
        draft.rows.push(Row { keys: keys(view, m), cells });
    }
    for role in context.absent(&rows) {
        for technique in ["per-sample", "buckets"] {
            let bounds = bounds(context.published.chart(role, technique, device));
            let cells = bounds.map(|bound| context.cell(None, bound)).into();
            let name = if role == Role::Sponza { "sponza" } else { "sibenik" };
            draft.rows.push(Row { keys: [name, technique, "", "", "", ""].map(str::to_owned).into(), cells });
        }
    }
    if context.options.published {
        draft.notes.push(format!("Printed axes are those of the {}.", DEVICES[device]));
    }
    draft
}
