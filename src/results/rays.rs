//! Rays from a CSV file and hits to one: how rtbench is held against another engine.

use super::files;
use crate::backend::GivenRay;
use crate::error::{Error, Result};
use crate::math::{Hit, MISS};
use glam::Vec3;
use std::path::Path;

/// The columns that a file of rays must have, in any order; others are ignored.
pub const COLUMNS: [&str; 6] = ["origin_x", "origin_y", "origin_z", "direction_x", "direction_y", "direction_z"];

/// Reads rays.
///
/// # Errors
/// [`Error::Input`] with file and line for a missing column, a missing or unusable number, or a direction without
/// length.
pub fn read(path: &Path) -> Result<Vec<GivenRay>> {
    let mut reader = csv::ReaderBuilder::new()
        .flexible(true)
        .trim(csv::Trim::All)
        .from_path(path)
        .map_err(|e| csv_error(path, &e))?;
    let header = reader.headers().map_err(|e| csv_error(path, &e))?.clone();
    let mut places = [0; 6];
    for (place, name) in places.iter_mut().zip(COLUMNS) {
        // A file that began its life in a spreadsheet may have a byte order mark.
        let found = header.iter().position(|h| h.trim_start_matches('\u{feff}') == name);
        *place = found.ok_or_else(|| {
            let mend = format!("the first line must name the columns {}", COLUMNS.join(","));
            Error::file(path, Some(1), format!("no column {name}"), mend)
        })?;
    }
    let mut rays = Vec::new();
    let mut record = csv::StringRecord::new();
    while reader.read_record(&mut record).map_err(|e| csv_error(path, &e))? {
        let line = record.position().map(|p| p.line() as usize);
        let mut values = [0.0f32; 6];
        for ((value, &place), name) in values.iter_mut().zip(&places).zip(COLUMNS) {
            let text = record.get(place).unwrap_or("");
            let parsed: Option<f32> = text.parse().ok().filter(|v: &f32| v.is_finite());
            *value = parsed.ok_or_else(|| {
                let problem = format!("{name} is {text:?}, not a finite number");
                Error::file(path, line, problem, "mend or delete the line")
            })?;
        }
        let [ox, oy, oz, dx, dy, dz] = values;
        let ray = GivenRay { origin: Vec3::new(ox, oy, oz), direction: Vec3::new(dx, dy, dz) };
        if ray.direction == Vec3::ZERO {
            return Err(Error::file(path, line, "the direction has no length", "mend or delete the line"));
        }
        rays.push(ray);
    }
    if rays.is_empty() {
        return Err(Error::file(path, None, "no rays", "give at least one line below the header"));
    }
    Ok(rays)
}

/// Writes `t,triangle` per ray; `t` is empty and the triangle -1 for a miss.
///
/// # Errors
/// [`Error::Output`].
pub fn write(path: &Path, hits: &[Hit]) -> Result<()> {
    files::replace(path, to_csv(hits).as_bytes())
}

/// The content of a file of hits. Distances are the shortest decimals that read back as the same `f32`.
pub fn to_csv(hits: &[Hit]) -> String {
    let mut text = String::from("t,triangle\n");
    for hit in hits {
        if hit.triangle == MISS {
            text.push_str(",-1\n");
        } else {
            text.push_str(&format!("{},{}\n", hit.t, hit.triangle));
        }
    }
    text
}

/// A reader's error in our words.
fn csv_error(path: &Path, error: &csv::Error) -> Error {
    let line = error.position().map(|p| p.line() as usize);
    let problem = match error.kind() {
        csv::ErrorKind::Io(source) => format!("cannot read: {source}"),
        csv::ErrorKind::Utf8 { .. } => "not a text file".into(),
        other => format!("not a CSV file: {other:?}"),
    };
    Error::file(path, line, problem, "give a CSV file of rays")
}
