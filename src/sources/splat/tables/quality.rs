//! How far pictures are from path-traced references, as printed and after the best single scale.

use super::context::{Context, Draft, keys};
use crate::report::{Cell, Column, Form, Row, Table};
use crate::sources::splat::data::View;

/// A table for each device.
pub fn tables(context: &Context) -> Vec<Table> {
    let printed = || {
        let mut draft = draft();
        draft.notes.push("The thesis compares pictures by eye.".into());
        draft
    };
    context.tables(measured, printed)
}

fn draft() -> Draft {
    let columns = vec![
        Column::new("time", "ms", Form::Time),
        Column::of("irradiance", "mean", "", Form::Time),
        Column::of("path-traced", "mean", "", Form::Time),
        Column::of("path-traced", "error", "%", Form::Time),
        Column::new("ratio", "", Form::Fixed(3)),
        Column::new("RMSE", "", Form::Time),
        Column::new("scale", "", Form::Fixed(3)),
        Column::of("RMSE", "scaled", "", Form::Time),
    ];
    let mut draft = Draft::new("quality", "Distance from path-traced irradiance", columns);
    draft.notes.push(
        "RMSE of indirect irradiance per pixel and channel. Ratio: mean irradiance by the path-traced one. Scale: the \
         one factor that brings the picture nearest; RMSE scaled: after it. Error: standard error of the path-traced \
         mean."
            .into(),
    );
    draft
}

fn measured(view: &View) -> Draft {
    let mut draft = draft();
    for m in view.rows.iter().filter(|m| m.metric("rmse").is_some()) {
        let metrics = [
            "irradiance_mean",
            "path_traced_mean",
            "path_traced_error_pct",
            "ratio_to_path_traced",
            "rmse",
            "best_scale",
            "rmse_scaled",
        ];
        let cells = std::iter::once(Cell::number(m.mean_ms)).chain(metrics.map(|name| Cell::number(m.metric(name))));
        draft.rows.push(Row { keys: keys(view, m), cells: cells.collect() });
    }
    draft
}
