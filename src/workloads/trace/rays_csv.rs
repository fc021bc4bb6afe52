//! Rays from a CSV file and hits to one: how rtbench is held against another engine.

use crate::error::{Error, Result};
use crate::guard;
use crate::math::{Hit, MISS};
use crate::record::files;
use crate::scene::Placement;
use crate::scene::placement::{MAX_COORDINATE, exponent_of, power_of_two};
use crate::workloads::trace::backend::GivenRay;
use glam::DVec3;
use std::path::Path;

/// The columns that a file of rays must have, in any order; others are ignored.
pub const COLUMNS: [&str; 6] = ["origin_x", "origin_y", "origin_z", "direction_x", "direction_y", "direction_z"];

/// A ray as written in a file, in the coordinates of the scene's file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExactRay {
    /// Start, up to 1e18.
    pub origin: DVec3,
    /// Direction, of any length but zero.
    pub direction: DVec3,
}

impl ExactRay {
    /// The ray in memory.
    pub fn place(&self, placement: &Placement) -> PlacedRay {
        let scaled = -exponent_of(self.direction.abs().max_element());
        // In two steps: a direction may be shorter than the inverse of any double
        let factors = [scaled / 2, scaled - scaled / 2].map(power_of_two);
        let direction = (self.direction * factors[0] * factors[1]).as_vec3();
        let ray = GivenRay { origin: placement.place(self.origin), direction };
        PlacedRay { ray, exponent: scaled - placement.exponent }
    }
}

/// A ray as a scene in memory sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedRay {
    /// With a direction of a length near 1.
    pub ray: GivenRay,
    /// A distance along `ray` times two to the power of this is one along the ray of the file.
    pub exponent: i32,
}

/// Reads rays and rounds them to single precision, for scenes that lie in memory as in their files.
///
/// # Errors
/// Those of [`read_exact`].
pub fn read(path: &Path) -> Result<Vec<GivenRay>> {
    let given = |ray: ExactRay| GivenRay { origin: ray.origin.as_vec3(), direction: ray.direction.as_vec3() };
    Ok(read_exact(path)?.into_iter().map(given).collect())
}

/// Reads rays.
///
/// # Errors
/// [`Error::Input`] with file and line for a missing column, a missing or unusable number, or a direction without
/// length.
pub fn read_exact(path: &Path) -> Result<Vec<ExactRay>> {
    guard::read(path);
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
            let hint = format!("the first line must name the columns {}", COLUMNS.join(","));
            Error::file(path, Some(1), format!("no column {name}"), hint)
        })?;
    }
    let mut rays = Vec::new();
    let mut record = csv::StringRecord::new();
    while reader.read_record(&mut record).map_err(|e| csv_error(path, &e))? {
        let line = record.position().map(|p| p.line() as usize);
        let mut values = [0.0f64; 6];
        for (i, (value, &place)) in values.iter_mut().zip(&places).enumerate() {
            let (text, name) = (record.get(place).unwrap_or(""), COLUMNS[i]);
            // Three origins, three directions
            let (most, kind) = if i < 3 { (MAX_COORDINATE, "1e18") } else { (f64::from(f32::MAX), "single precision") };
            let fault = |what: String| {
                Error::file(path, line, format!("{name} is {text:?}, {what}"), "correct or delete the line")
            };
            let parsed: Option<f64> = text.parse().ok().filter(|v: &f64| v.is_finite());
            *value = parsed.ok_or_else(|| fault("not a finite number".into()))?;
            if value.abs() > most {
                return Err(fault(format!("beyond {kind}")));
            }
        }
        let [ox, oy, oz, dx, dy, dz] = values;
        let [origin, direction] = [DVec3::new(ox, oy, oz), DVec3::new(dx, dy, dz)];
        if direction == DVec3::ZERO {
            return Err(Error::file(path, line, "the direction has no length", "correct or delete the line"));
        }
        rays.push(ExactRay { origin, direction });
    }
    if rays.is_empty() {
        return Err(Error::file(path, None, "no rays", "give at least one line below the header"));
    }
    Ok(rays)
}

/// Writes `t,triangle` per placed ray; `t` is empty and the triangle -1 for a miss.
///
/// # Errors
/// [`Error::Output`], and [`Error::Input`] where a distance is not finite in units of a ray's direction.
pub fn write(path: &Path, rays: &[PlacedRay], hits: &[Hit]) -> Result<()> {
    let exponents = rays.iter().map(|ray| ray.exponent);
    let is_endless = |(hit, exponent): (&Hit, i32)| hit.triangle != MISS && !scaled(hit.t, exponent).is_finite();
    if let Some(index) = hits.iter().zip(exponents.clone()).position(is_endless) {
        let problem = "the distance of its hit is beyond double precision in units of its direction";
        return Err(Error::argument(format!("ray {}", index + 1), problem, "give it a longer direction"));
    }
    files::replace(path, csv(hits.iter().zip(exponents)).as_bytes())
}

/// The content of a file of hits. Distances are the shortest decimals that read back as the same `f32`.
pub fn to_csv(hits: &[Hit]) -> String {
    csv(hits.iter().map(|hit| (hit, 0)))
}

/// Hits, each with the exponent of the power of two that its distance is to be taken times.
fn csv<'a>(hits: impl Iterator<Item = (&'a Hit, i32)>) -> String {
    let mut text = String::from("t,triangle\n");
    for (hit, exponent) in hits {
        if hit.triangle == MISS {
            text.push_str(",-1\n");
        } else {
            text.push_str(&format!("{},{}\n", distance(hit.t, exponent), hit.triangle));
        }
    }
    text
}

fn scaled(t: f32, exponent: i32) -> f64 {
    let [half, rest] = [exponent / 2, exponent - exponent / 2].map(power_of_two);
    f64::from(t) * half * rest
}

/// A distance times a power of two, as a float if it is one, otherwise as a double.
fn distance(t: f32, exponent: i32) -> String {
    let exact = scaled(t, exponent);
    let single = exact as f32;
    if f64::from(single) == exact { single.to_string() } else { format!("{exact:e}") }
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
