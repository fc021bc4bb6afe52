//! Bits that keys need, by the printed formula, and the bits that measured rows had flags for.

use super::context::{Context, Draft};
use crate::report::{Cell, Column, Form, Number, Row, Table};
use crate::sources::splat::data::View;
use crate::sources::splat::published::KeyBits;

/// Slices of depth, not rounded: ln(far / near) / ln(1 + 2 tan(angle / 2) / rows of tiles).
pub fn slices(height_px: f64, tile_px: f64, field_of_view_deg: f64, far_over_near: f64) -> f64 {
    let half = (field_of_view_deg.to_radians() / 2.0).tan();
    far_over_near.ln() / (1.0 + 2.0 * half / (height_px / tile_px)).ln()
}

/// Bits of numbers from 0 to below `count`, which is rounded up.
fn bits(count: f64) -> f64 {
    count.ceil().max(1.0).log2().ceil()
}

/// The computed bits, and those of measured rows.
pub fn tables(context: &Context) -> Vec<Table> {
    let Some(_) = context.data else { return vec![context.table(None, computed(context))] };
    let views = context.views();
    let of = |view| [context.table(Some(view), computed(context)), context.table(Some(view), measured(context, view))];
    // Equal for all devices
    views.iter().enumerate().flat_map(|(index, view)| of(view).into_iter().skip(usize::from(index > 0))).collect()
}

/// What the formula gives for a row of the list.
fn of_row(row: &KeyBits) -> [f64; 4] {
    let columns = (f64::from(row.height_px) * 16.0 / 9.0 / f64::from(row.tile_px)).ceil();
    let slices = slices(f64::from(row.height_px), f64::from(row.tile_px), row.field_of_view_deg, row.far_over_near);
    [slices, bits(slices), columns, bits(columns)]
}

/// True if a computed row is the listed one to its last decimal.
fn agrees(row: &KeyBits) -> bool {
    let [slices, depth_bits, columns, x_bits] = of_row(row);
    let written = row.slices.write(Form::Fixed(1)) == Form::Fixed(1).write(slices);
    written
        && depth_bits == f64::from(row.depth_bits)
        && columns == f64::from(row.columns)
        && x_bits == f64::from(row.x_bits)
}

fn computed(context: &Context) -> Draft {
    let columns = vec![
        Column::new("slices", "", Form::Fixed(1)),
        Column::of("bits", "z", "", Form::Whole),
        Column::new("columns", "", Form::Whole),
        Column::of("bits", "x", "", Form::Whole),
    ];
    let mut draft = Draft::new("keys", "Bits of keys by the printed formula", columns);
    draft.keys = vec!["rows of the image", "tile", "field of view", "far/near"];
    for row in &context.published.key_bits {
        let listed =
            [row.slices, f64::from(row.depth_bits).into(), f64::from(row.columns).into(), f64::from(row.x_bits).into()];
        let cells = of_row(row).into_iter().zip(listed).map(|(own, listed)| context.cell(Some(own), Some(listed)));
        let keys = vec![
            row.height_px.to_string(),
            row.tile_px.to_string(),
            row.field_of_view_deg.to_string(),
            row.far_over_near.to_string(),
        ];
        draft.rows.push(Row { keys, cells: cells.collect() });
    }
    let (agreeing, all) = (context.published.key_bits.iter().filter(|row| agrees(row)).count(), draft.rows.len());
    draft.notes.push(format!(
        "Computed here; {agreeing} of {all} rows agree with results/splat-thesis/key_bits.csv to its last digit. \
         Images of 16 to 9. Figure 3.6, which shows the same, cannot be read."
    ));
    let fits = |tile: u32| {
        let mut rows = context.published.key_bits.iter().filter(|row| (row.height_px, row.tile_px) == (2160, tile));
        rows.find(|row| (row.field_of_view_deg, row.far_over_near) == (90.0, 1e4)).map(|row| of_row(row)[1])
    };
    if let (Some(at_32), Some(at_16)) = (fits(32), fits(16)) {
        draft.notes.push(format!(
            "Printed: 9 bits of depth are enough at 90 degrees and far/near 10^4, tiles of 32 or 16. At 2160 rows they \
             need {at_32} and {at_16}."
        ));
    }
    draft
}

/// Size of the image, tile and normals, with bits and bytes of flags, and the scenes that have them.
type Width = ([String; 3], (f64, f64), Vec<String>);

fn measured(context: &Context, view: &View) -> Draft {
    let columns = vec![Column::new("bits", "", Form::Whole), Column::of("flags", "", "MiB", Form::Time)];
    let mut draft = Draft::new("keys", "Keys of measured rows", columns);
    draft.keys = vec!["size", "tile", "normals", "scenes"];
    let mut groups: Vec<Width> = Vec::new();
    for m in &view.rows {
        let Some(bytes) = m.part("source-flags", "bytes") else { continue };
        let bits = m.metric("key_bits").unwrap_or_else(|| (bytes / 4.0).log2());
        let key = ["resolution", "tile", "normals"].map(|axis| m.axis(axis).to_owned());
        let name = m.scene.to_string();
        match groups.iter_mut().find(|(known, size, _)| (known, *size) == (&key, (bits, bytes))) {
            Some((.., scenes)) if scenes.contains(&name) => {}
            Some((.., scenes)) => scenes.push(name),
            None => groups.push((key, (bits, bytes), vec![name])),
        }
    }
    for (key, (bits, bytes), scenes) in groups {
        let printed = Some(Number { value: 23.0, places: Some(0) });
        let cells = vec![context.cell(Some(bits), printed), Cell::number(bytes / 1_048_576.0)];
        draft.rows.push(Row { keys: key.into_iter().chain([scenes.join(", ")]).collect(), cells });
    }
    draft.notes.push(
        "Bits as recorded, else by the size of the flags: 4 bytes for each possible key, in the thesis's accounting."
            .into(),
    );
    draft
}
