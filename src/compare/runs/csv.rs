//! A comparison as CSV: one line per exact quantity that differs, and one per row.

use super::Comparison;
use crate::record::stream::Names;

/// Writes `kind,row,quantity,old,new,ratio,low,high,p,verdict,reason`; times are in milliseconds.
pub fn write(comparison: &Comparison, names: &Names) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    // Writing to memory does not fail
    let mut line = |cells: [&str; 11]| drop(writer.write_record(cells));
    line(["kind", "row", "quantity", "old", "new", "ratio", "low", "high", "p", "verdict", "reason"]);
    for change in &comparison.changes {
        let (row, quantity) = (&comparison.rows[change.row].label, names.text(change.quantity));
        let (old, new) = (change.old.write(names), change.new.write(names));
        line(["exact", row, quantity, &old, &new, "", "", "", "", "differs", ""]);
    }
    for row in &comparison.rows {
        let number = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:.6}"));
        let of = |index: usize| number(row.times_ms.get(index).copied().flatten());
        let (old, new) = (of(0), of(row.times_ms.len().saturating_sub(1)));
        let part = |pick: fn(&super::Ratio) -> f64| number(row.ratio.as_ref().map(pick));
        let [ratio, low, high, p] =
            [part(|r| r.estimate.value), part(|r| r.estimate.low), part(|r| r.estimate.high), part(|r| r.p)];
        let (word, reason) = (row.verdict.word(), row.verdict.reason());
        line(["time", &row.label, "frame_ms_mean", &old, &new, &ratio, &low, &high, &p, word, reason]);
    }
    String::from_utf8(writer.into_inner().unwrap_or_default()).unwrap_or_default()
}
