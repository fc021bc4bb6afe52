//! Half precision: how far its picture is from that of single precision, and its speed where the device has it.

use super::context::{Context, Draft, Side};
use crate::report::{Cell, Column, Form, Row, Table};
use crate::sources::spheres::claims::{UNUSABLE_DB, half_pictures, psnr, single_of};
use crate::sources::spheres::data::Terms;
use crate::sources::spheres::setting::Setting;

/// The table.
pub fn table(context: &Context, side: &Side) -> Table {
    let columns = vec![
        Column::of("picture", "RMSE", "", Form::Time),
        Column::of("picture", "PSNR", "dB", Form::Fixed(1)),
        Column::of("picture", "largest", "", Form::Fixed(3)),
        Column::of("f16", "time", "ms", Form::Time),
        Column::of("f32", "time", "ms", Form::Time),
        Column::of("", "gain", "", Form::Fixed(2)),
        Column::new("speed", "", Form::Whole),
    ];
    let mut rows = Vec::new();
    let halves = if side.is_published { Vec::new() } else { half_pictures(side.view.data, side.view.place) };
    for half in &halves {
        let times = side.view.data.measurements.iter().find(|m| {
            (m.machine, m.device, m.terms) == (half.machine, half.device, half.terms)
                && m.scene == half.scene
                && m.setting == half.setting
        });
        let single = single_of(side.view.data, half);
        let gain = times.zip(single).map(|(half, single)| single.mean_ms / half.mean_ms);
        let words = if times.is_some() { "measured" } else { "not measured" };
        let cells = vec![
            Cell::number(half.rmse),
            Cell::number(psnr(half.rmse)),
            Cell::number(half.largest),
            Cell::number(times.map(|m| m.mean_ms)),
            Cell::number(single.filter(|_| times.is_some()).map(|m| m.mean_ms)),
            Cell::number(gain),
            Cell::Words { value: Some(words.to_owned()), published: None },
        ];
        let Terms { width, height, trips, .. } = half.terms;
        // All rows of this table are of half precision
        let switches = Setting { half: false, ..half.setting.clone() }.switches();
        let size = format!("{width}x{height}, {trips} trips");
        let keys = [half.scene.to_string(), half.setting.renderer.title().into(), switches, size];
        rows.push((half.scene.clone(), Row { keys: keys.into(), cells }));
    }
    rows.sort_by(|a, b| a.0.cmp(&b.0));
    let mut notes = vec![format!(
        "RMSE and largest difference of linear RGB, clamped to 0 to 1, against the picture of single precision; below \
         {UNUSABLE_DB} dB a picture counts as unusable here. Emulated arithmetic has no speed worth a number."
    )];
    if side.is_published {
        notes.push("The paper says twice the speed and an unusable picture, and prints no numbers.".into());
    }
    let place = side.view.place;
    let failed = side.view.data.failures.iter().filter(|f| f.setting.half && place.has(f.machine, f.device));
    let mut failed: Vec<String> = failed.map(|f| format!("{}: {}", f.setting.renderer.title(), f.message)).collect();
    failed.sort_unstable();
    failed.dedup();
    notes.extend(failed.into_iter().map(|words| format!("{words}.")));
    let title = "Half precision".to_owned();
    let keys = &["scene", "renderer", "switches", "measured at"];
    let mut table = context.table(side, Draft { id: "half", title, keys, columns, rows, notes });
    if !side.is_published {
        // Rows name their own terms
        table.title = format!("Half precision, {}", side.devices());
    }
    table
}
