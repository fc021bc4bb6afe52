//! Sizes: those that were printed with the exact ones, the same accounting for measured rows, and buffers as allocated.

use super::context::{Context, Draft, keys};
use crate::record::row::Value;
use crate::report::{Cell, Column, Form, Number, Row, Table};
use crate::sources::splat::data::{Measurement, TECHNIQUES, View};

/// Bytes of a mebibyte.
const MIB: f64 = 1_048_576.0;

/// The printed size of lists, and the capacity that it is for.
const LISTS: (&str, &str) = ("10 million assignments", "10000000");

/// The parts of the thesis's accounting, with the printed size in decimal megabytes that is the closest in meaning.
const PARTS: [(&str, &str, Option<&str>); 5] = [
    ("source-flags", "flags", Some("flags and identifiers of keys of 23 bits")),
    ("source-nodes", "nodes", None),
    ("source-clusters", "clusters", Some("clusters provided for, without buckets")),
    ("source-lists", "lists", Some(LISTS.0)),
    ("source-buckets", "buckets", Some("clusters provided for, with buckets")),
];

/// Accounting and buffers of each device, or the printed sizes.
pub fn tables(context: &Context) -> Vec<Table> {
    if context.data.is_none() {
        return vec![context.table(None, printed(context))];
    }
    let views = context.views();
    let of = |view| [context.table(Some(view), accounting(context, view)), context.table(Some(view), buffers(view))];
    views.iter().flat_map(of).collect()
}

fn printed(context: &Context) -> Draft {
    let columns = vec![
        Column::new("printed", "", Form::Whole),
        Column::new("unit", "", Form::Whole),
        Column::new("formula", "", Form::Whole),
        Column::of("exact", "", "MB", Form::Time),
        Column::of("exact", "", "MiB", Form::Time),
        Column::new("agrees as", "", Form::Whole),
    ];
    let mut draft = Draft::new("memory", "Printed sizes and exact ones", columns);
    draft.keys = vec!["what"];
    for size in &context.published.sizes {
        let words =
            |text: &str| Cell::Words { value: Some(text.to_owned()).filter(|t| !t.is_empty()), published: None };
        let bytes = size.bytes.map(|bytes| bytes as f64);
        let cells = vec![
            Cell::Number { value: size.printed, published: None },
            words(&size.unit),
            words(&size.formula),
            Cell::number(bytes.map(|bytes| bytes / 1e6)),
            Cell::number(bytes.map(|bytes| bytes / MIB)),
            words(&size.agrees_as),
        ];
        draft.rows.push(Row { keys: vec![size.quantity.clone()], cells });
    }
    draft.notes.push("Most sizes that are printed in MiB and GiB are powers of ten.".into());
    draft
}

fn accounting(context: &Context, view: &View) -> Draft {
    let mut columns: Vec<Column> = PARTS.iter().map(|(_, name, _)| Column::of(name, "", "MB", Form::Time)).collect();
    columns.push(Column::of("together", "", "MB", Form::Time));
    columns.push(Column::of("allocated", "", "MB", Form::Time));
    let mut draft = Draft::new("memory", "Memory in the thesis's accounting and as allocated", columns);
    for m in view.rows.iter().filter(|m| m.metric("source_bytes").is_some() || m.metric("buffer_bytes").is_some()) {
        let of_part = |(part, _, quantity): &(&str, &str, Option<&str>)| {
            let size = quantity.and_then(|quantity| context.published.sizes.iter().find(|s| s.quantity == quantity));
            let own = m.part(part, "bytes").map(|bytes| bytes / 1e6);
            let is_as_printed = *quantity != Some(LISTS.0) || m.axis("capacity") == LISTS.1;
            let printed = size.and_then(|size| size.printed).filter(|_| own.is_some() && is_as_printed);
            context.cell(own, printed)
        };
        let whole = ["source_bytes", "buffer_bytes"].map(|name| Cell::number(m.metric(name).map(|bytes| bytes / 1e6)));
        let cells = PARTS.iter().map(of_part).chain(whole).collect();
        draft.rows.push(Row { keys: keys(view, m), cells });
    }
    draft.notes.push(
        "Megabytes of 10^6 bytes. Accounting: 4 bytes a flag, 28 a node, 28 a cluster, 4 an entry of the lists, 648 \
         the buckets of a cluster. Allocated: all buffers of the row."
            .into(),
    );
    if context.options.published {
        draft.notes.push(
            "Printed: at 23 bits, and about 31000 to 37000 clusters; lists of 10 million entries, next to rows with \
             capacity=10000000 alone."
                .into(),
        );
    }
    draft
}

/// The buffers of the first row of each technique.
fn buffers(view: &View) -> Draft {
    let columns = vec![Column::of("allocated", "", "MiB", Form::Time), Column::new("share", "%", Form::Fixed(1))];
    let mut draft = Draft::new("memory", "Buffers of one row of each technique", columns);
    draft.keys.push("buffer");
    for technique in TECHNIQUES {
        let is = |m: &&&Measurement| m.technique() == technique && m.metric("buffer_bytes").is_some();
        let Some(m) = view.rows.iter().find(|m| is(m) && view.is_usual(m)).or_else(|| view.rows.iter().find(is)) else {
            continue;
        };
        let mut parts: Vec<(&str, f64)> = m
            .metrics
            .iter()
            .filter(|metric| metric.name == "bytes")
            .filter_map(|metric| metric.of.as_deref().zip(Value::number(&metric.value)))
            .filter(|(part, bytes)| *bytes > 0.0 && !part.starts_with("source-"))
            .collect();
        parts.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(b.0)));
        let total: f64 = parts.iter().map(|(_, bytes)| bytes).sum();
        for (part, bytes) in parts {
            let keys = keys(view, m).into_iter().chain([part.to_owned()]).collect();
            let share = Some(Number::from(100.0 * bytes / total));
            let cells = vec![Cell::number(bytes / MIB), Cell::Number { value: share, published: None }];
            draft.rows.push(Row { keys, cells });
        }
    }
    draft
}
