//! A comparison as JSON.

use super::exact::Quantity;
use super::{Comparison, MARGIN_PCT, UNPAIRED_ALPHA};
use crate::record::stream::Names;
use serde_json::{Value, json};

/// The name of this form; it changes when a reader of old files would misread new ones.
pub const SCHEMA: &str = "rtbench-compare/1";

/// Writes a comparison.
pub fn write(comparison: &Comparison, names: &Names) -> Value {
    let quantity = |value: Quantity| match value {
        Quantity::Count(count) => json!(count),
        Quantity::Hash(name) => json!(names.text(name)),
        Quantity::Absent => Value::Null,
    };
    let side = |side: &super::Side| {
        let runs = side.runs.iter().map(|&run| {
            let run = &comparison.runs[run];
            let devices: Vec<Value> =
                run.devices.iter().map(|device| json!({"device": device.device, "driver": device.driver})).collect();
            let provenance = &run.run.provenance;
            json!({"id": provenance.id, "folder": run.run.folder.display().to_string(), "devices": devices,
                "revision": provenance.program.git_revision, "started": provenance.started})
        });
        json!({"name": side.name, "runs": runs.collect::<Vec<_>>()})
    };
    let changes = comparison.changes.iter().map(|change| {
        json!({"row": comparison.rows[change.row].label, "quantity": names.text(change.quantity),
            "old": quantity(change.old), "new": quantity(change.new)})
    });
    let rows = comparison.rows.iter().map(|row| {
        let ratio = row.ratio.map(|ratio| {
            json!({"value": ratio.estimate.value, "low": ratio.estimate.low, "high": ratio.estimate.high,
                "has_interval": ratio.has_interval, "mann_whitney_p": ratio.p})
        });
        json!({"row": row.label, "times_ms": row.times_ms, "ratio": ratio, "verdict": row.verdict.word(),
            "reason": row.verdict.reason()})
    });
    let means = comparison
        .means
        .iter()
        .map(|mean| json!({"axis": mean.axis, "value": mean.value, "rows": mean.rows, "ratio": mean.ratio}));
    json!({
        "schema": SCHEMA,
        "sides": comparison.sides.iter().map(side).collect::<Vec<_>>(),
        "measured": "apart",
        "interval_level": 1.0 - UNPAIRED_ALPHA,
        "default_margin_pct": MARGIN_PCT,
        "exact": {"compared": comparison.exact_compared, "differing": changes.collect::<Vec<_>>()},
        "means": means.collect::<Vec<_>>(),
        "rows": rows.collect::<Vec<_>>(),
        "notes": comparison.notes,
    })
}
