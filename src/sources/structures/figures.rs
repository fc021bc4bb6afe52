//! Scatter plots of rays per second against the time until the first ray, and against bytes, with the Pareto front.

use super::data::{Data, Entry, Group};
use super::pareto::front;
use crate::error::Result;
use crate::report::figure::{Axis, Figure, Mark, Missing, Panel, Picture, Series, spreads};
use crate::workloads::trace::backend::Config;

/// What is on the horizontal axis.
struct Against {
    id: &'static str,
    words: &'static str,
    label: &'static str,
    /// `None` where it is not known.
    of: fn(&Entry) -> Option<f64>,
}

const AGAINST: [Against; 2] = [
    Against {
        id: "build-time",
        words: "Rays per second against the time until the first ray",
        label: "build and upload [ms]",
        of: |entry| Some(entry.ready_ms()),
    },
    Against {
        id: "bytes",
        words: "Rays per second against bytes",
        label: "structure [bytes/triangle]",
        of: |entry| entry.bytes_per_triangle,
    },
];

const NEEDS: &str = "rows of at least two structures of a scene";

/// Panels in a row.
const COLUMNS: usize = 2;

/// All figures that there is data for, and the others.
///
/// # Errors
/// None in practice: drawing goes to memory.
pub fn all(data: &Data) -> Result<(Vec<Figure>, Vec<Missing>)> {
    let (mut figures, mut missing) = (Vec::new(), Vec::new());
    for against in &AGAINST {
        let before = figures.len();
        for device in 0..data.devices.len() {
            for config in Config::ALL {
                figures.extend(figure(data, against, device, config)?);
            }
        }
        if figures.len() == before {
            missing.push(Missing { id: against.id, what: against.words.to_lowercase(), needs: NEEDS });
        }
    }
    Ok((figures, missing))
}

/// The figure of a ray configuration on a device: a panel for each scene, at the size with most structures; of several
/// such sizes, the largest.
fn figure(data: &Data, against: &Against, device: usize, config: Config) -> Result<Option<Figure>> {
    let mut shown: Vec<&Group> = Vec::new();
    for group in data.groups.iter().filter(|g| (g.device, g.config) == (device, config) && g.entries.len() > 1) {
        match shown.iter_mut().find(|known| known.scene == group.scene) {
            Some(known) if (known.entries.len(), known.size) < (group.entries.len(), group.size) => *known = group,
            Some(_) => {}
            None => shown.push(group),
        }
    }
    if shown.is_empty() {
        return Ok(None);
    }
    let mut names: Vec<&str> = Vec::new();
    for entry in shown.iter().flat_map(|group| &group.entries) {
        if !names.contains(&entry.name.as_str()) {
            names.push(&entry.name);
        }
    }
    let panels = shown.iter().map(|group| panel(group, against, &names)).collect();
    let label = format!("{config:?}, {}", data.devices[device].label);
    let picture = Picture { title: format!("{}, {label}", against.words), panels, columns: COLUMNS };
    let end = if device == 0 { String::new() } else { format!("-device{}", device + 1) };
    let name = format!("{}-{}{end}", against.id, format!("{config:?}").to_lowercase());
    let caption = format!(
        "{} ({label}). The line joins the structures that no other one beats in both (the Pareto front).",
        against.words
    );
    Figure::draw(against.id, name, caption, &picture).map(Some)
}

fn panel(group: &Group, against: &Against, names: &[&str]) -> Panel {
    let known: Vec<(&Entry, f64)> =
        group.entries.iter().filter_map(|entry| Some((entry, (against.of)(entry)?))).collect();
    let points: Vec<(f64, f64)> = known.iter().map(|&(entry, x)| (x, entry.mrays_per_s)).collect();
    let (x, y) = (points.iter().map(|p| p.0), points.iter().map(|p| p.1));
    let axis = |label: &str, values: Vec<f64>| Axis::of_values(label, spreads(values.iter().copied()), values);
    let mut best: Vec<(f64, f64)> =
        points.iter().zip(front(&points)).filter(|(_, best)| *best).map(|(point, _)| *point).collect();
    best.sort_by(|a, b| a.0.total_cmp(&b.0));
    let marks = known.iter().zip(&points).map(|(&(entry, _), &at)| {
        let number = names.iter().position(|name| *name == entry.name).unwrap_or_default();
        Mark { text: (number + 1).to_string(), label: entry.name.clone(), style: number, at }
    });
    Panel {
        title: group.title(),
        x: axis(against.label, x.collect()),
        y: axis("rate [Mrays/s]", y.collect()),
        series: vec![Series { label: "Pareto front".into(), style: 6, faint: true, points: best, ringed: None }],
        groups: Vec::new(),
        bars: Vec::new(),
        bands: Vec::new(),
        marks: marks.collect(),
    }
}
