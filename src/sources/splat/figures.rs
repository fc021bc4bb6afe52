//! Figures: groups of stages next to the printed ones, stacked times of stages and assignments along the animation,
//! photons per cluster, and errors against time.

use super::data::{Data, Measurement, View};
use super::published::Published;
use super::scenes::{Role, SceneKey};
use super::stages::{BANDS, Group, band};
use crate::error::Result;
use crate::names::distinct_slug;
use crate::report::figure::{Axis, Band, Bar, Figure, Missing, Panel, Picture, STYLES, Series, spreads};

/// What the figures need.
const NEEDS: [(&str, &str, &str); 5] = [
    ("5.2", "figure 5.2, groups of stages", "per-sample or buckets on a device with times of stages"),
    ("5.1", "figure 5.1, stages along the animation", "at least two frames on a device with times of stages"),
    ("frames", "frame times and assignments along the animation", "per-sample or buckets with at least two frames"),
    ("histogram", "photons per cluster", "per-sample or buckets with counted clusters"),
    ("quality", "errors against time", "rows that are compared with a path-traced reference"),
];

/// The techniques with clusters, each with its colour.
const TECHNIQUES: [(&str, usize); 2] = [("per-sample", 0), ("buckets", 1)];

/// Bins of photons per cluster, as metrics name them.
pub const BINS: [&str; 9] = ["0", "1-9", "10-31", "32-99", "100-315", "316-999", "1000-3161", "3162-9999", "10000-"];

/// All figures that there is data for, and the others. Without runs: what was printed.
///
/// # Errors
/// None in practice: drawing goes to memory.
pub fn all(data: Option<&Data>, published: &Published) -> Result<(Vec<Figure>, Vec<Missing>)> {
    let mut figures = Vec::new();
    match data {
        None => {
            let panels = vec![shares_panel("Sponza (Crytek)", &[], Role::Sponza, published)];
            let picture = Picture { title: "Shares of a frame by groups, as printed".into(), panels, columns: 1 };
            let caption = "Shares of a mean frame by groups of stages (figure 5.2, as printed).";
            figures.push(Figure::draw("5.2", "figure-5.2".into(), caption.into(), &picture)?);
        }
        Some(data) => {
            for (index, view) in data.views().iter().enumerate() {
                let end = if index == 0 { String::new() } else { format!("-device{}", index + 1) };
                figures.extend(of_view(view, published, &end)?);
            }
        }
    }
    let absent = NEEDS.iter().filter(|(id, ..)| !figures.iter().any(|figure: &Figure| figure.id == *id));
    let missing = absent.map(|(id, what, needs)| Missing { id, what: (*what).into(), needs }).collect();
    figures.sort_by_key(|figure| NEEDS.iter().position(|(id, ..)| *id == figure.id));
    Ok((figures, missing))
}

fn of_view(view: &View, published: &Published, end: &str) -> Result<Vec<Figure>> {
    let mut scenes: Vec<&SceneKey> = view.rows.iter().map(|m| &m.scene).collect();
    scenes.dedup();
    let mut figures = Vec::new();
    figures.extend(groups(view, &scenes, published, end)?);
    for scene in &scenes {
        figures.extend(stacked(view, scene, end)?);
        figures.extend(frames(view, scene, end)?);
    }
    figures.extend(histogram(view, &scenes, end)?);
    figures.extend(quality(view, &scenes, end)?);
    Ok(figures)
}

/// The radius of a row, as a number.
fn radius(m: &Measurement) -> f64 {
    m.axis("radius").trim_end_matches('u').parse().unwrap_or(0.0)
}

/// The rows of a scene that figures show: both techniques with the usual options along the most frames, of these at the
/// largest radius, where it is the published load.
fn main_rows<'a>(view: &View<'a>, scene: &SceneKey) -> Vec<(&'a Measurement, usize)> {
    let is = |m: &&Measurement| m.scene == *scene && TECHNIQUES.iter().any(|(name, _)| *name == m.technique());
    let rows: Vec<&Measurement> = view.usual_rows().filter(is).collect();
    let frames = |m: &Measurement| m.axis("frames").parse::<usize>().unwrap_or(0);
    let better = |a: &&Measurement, b: &&Measurement| frames(a).cmp(&frames(b)).then(radius(a).total_cmp(&radius(b)));
    let Some(best) = rows.iter().copied().max_by(better) else { return Vec::new() };
    let is_like =
        |m: &Measurement| ["radius", "frames", "paths", "tile"].iter().all(|axis| m.axis(axis) == best.axis(axis));
    let of = |(technique, style): (&str, usize)| {
        rows.iter().find(|m| m.technique() == technique && is_like(m)).map(|m| (*m, style))
    };
    TECHNIQUES.into_iter().filter_map(of).collect()
}

fn bar(label: String, style: usize, (group, index, of): (usize, usize, usize), height: f64) -> Bar {
    let width = 0.84 / of.max(1) as f64;
    let from = group as f64 - 0.42 + width * index as f64;
    Bar { label, style, span: (from, from + 0.92 * width), mean: height, whiskers: (height, height) }
}

fn bar_panel(title: String, y: &str, groups: Vec<String>, bars: Vec<Bar>) -> Panel {
    let x = Axis {
        label: String::new(),
        log: false,
        range: (-0.5, groups.len() as f64 - 0.5),
        ticks: (0..groups.len()).map(|group| group as f64).collect(),
    };
    let y = Axis::of_values(y, false, bars.iter().map(|bar| bar.mean));
    Panel { title, x, y, series: Vec::new(), groups, bars, bands: Vec::new(), marks: Vec::new() }
}

/// Shares of groups: of rows, and the printed ones of a scene of the thesis.
fn shares_panel(title: &str, rows: &[(&Measurement, usize)], role: Role, published: &Published) -> Panel {
    let mut sets: Vec<(String, usize, Vec<f64>)> = Vec::new();
    for (m, style) in rows {
        let Some(total) = m.total_ms().filter(|total| *total > 0.0) else { continue };
        let shares = Group::ALL.map(|group| 100.0 * m.group_ms(group).unwrap_or(0.0) / total);
        sets.push((m.technique().to_owned(), *style, shares.into()));
    }
    for (technique, style) in TECHNIQUES {
        let Some(total) = published.total_ms(role, technique) else { continue };
        let of = |group| published.group_ms(role, technique, group).map_or(0.0, |ms| 100.0 * ms.value / total.value);
        // Printed values have the colours after the measured ones
        sets.push((format!("{technique}, printed"), style + TECHNIQUES.len(), Group::ALL.map(of).into()));
    }
    let mut bars = Vec::new();
    for group in 0..Group::ALL.len() {
        for (index, (label, style, shares)) in sets.iter().enumerate() {
            bars.push(bar(label.clone(), *style, (group, index, sets.len()), shares[group]));
        }
    }
    let groups = Group::ALL.map(|group| format!("{} {}", group.letter(), group.title())).into();
    bar_panel(title.to_owned(), "share of the stages' time [%]", groups, bars)
}

fn groups(view: &View, scenes: &[&SceneKey], published: &Published, end: &str) -> Result<Option<Figure>> {
    let panel = |scene: &&SceneKey| {
        let rows: Vec<_> = main_rows(view, scene).into_iter().filter(|(m, _)| m.total_ms().is_some()).collect();
        let (first, _) = rows.first()?;
        Some(shares_panel(&format!("{scene}, {}", view.conditions(first)), &rows, scene.role, published))
    };
    let panels: Vec<Panel> = scenes.iter().filter_map(panel).collect();
    if panels.is_empty() {
        return Ok(None);
    }
    let title = format!("Shares of a frame by groups of stages, {}", view.label());
    let caption = format!(
        "Shares of a mean frame by groups of stages, next to the printed ones of Crytek's Sponza (figure 5.2), on {}.",
        view.label()
    );
    let picture = Picture { title, panels, columns: 1 };
    Figure::draw("5.2", format!("figure-5.2{end}"), caption, &picture).map(Some)
}

/// Positions of frames with values: 1 and on.
fn numbered(values: impl IntoIterator<Item = f64>) -> Vec<(f64, f64)> {
    values.into_iter().enumerate().map(|(index, value)| ((index + 1) as f64, value)).collect()
}

/// An axis of frames, without a margin.
fn frame_axis(frames: usize) -> Axis {
    let step = [1, 2, 5, 10, 20, 50, 100].into_iter().find(|step| frames / step <= 10).unwrap_or(frames.max(1));
    let ticks = (1..=frames).filter(|frame| step == 1 || frame % step == 0).map(|frame| frame as f64).collect();
    Axis { label: "frame".to_owned(), log: false, range: (1.0, frames as f64), ticks }
}

/// Times of stages along the animation, a panel for each technique.
fn stacked(view: &View, scene: &SceneKey, end: &str) -> Result<Option<Figure>> {
    let panel = |(m, _): &(&Measurement, usize)| {
        if m.stage_ms.len() < 2 {
            return None;
        }
        let band_of = |(index, label): (usize, &&str)| {
            let of_frame = |frame: &Vec<f64>| -> f64 {
                let stages = m.stages.iter().zip(frame).filter(|(stage, _)| band(stage) == index);
                stages.map(|(_, ms)| *ms).sum()
            };
            let points = numbered(m.stage_ms.iter().map(of_frame));
            let is_there = points.iter().any(|(_, height)| *height > 0.0);
            is_there.then(|| Band { label: (*label).to_owned(), style: index % STYLES, points })
        };
        let bands: Vec<Band> = BANDS.iter().enumerate().filter_map(band_of).collect();
        let totals = m.stage_ms.iter().map(|frame| frame.iter().sum::<f64>());
        Some(Panel {
            title: format!("{}, {}", m.technique(), view.conditions(m)),
            x: frame_axis(m.stage_ms.len()),
            y: Axis::of_values("time [ms]", false, totals),
            series: Vec::new(),
            groups: Vec::new(),
            bars: Vec::new(),
            bands,
            marks: Vec::new(),
        })
    };
    let panels: Vec<Panel> = main_rows(view, scene).iter().filter_map(panel).collect();
    if panels.is_empty() {
        return Ok(None);
    }
    let title = format!("Stages along the animation, {scene}, {}", view.label());
    let caption =
        format!("Times of stages along the animation in {scene}, stacked (as figure 5.1), on {}.", view.label());
    let name = format!("figure-5.1-{}{end}", distinct_slug(&scene.name));
    Figure::draw("5.1", name, caption, &Picture { title, panels, columns: 1 }).map(Some)
}

/// A panel of lines over frames.
fn frame_panel(y: &str, series: Vec<Series>) -> Panel {
    let points = || series.iter().flat_map(|series| &series.points);
    let frames = series.iter().map(|series| series.points.len()).max().unwrap_or(1);
    let log = spreads(points().map(|point| point.1));
    let y = Axis::of_values(y, log, points().map(|point| point.1));
    let (groups, bars, bands) = (Vec::new(), Vec::new(), Vec::new());
    Panel { title: String::new(), x: frame_axis(frames), y, series, groups, bars, bands, marks: Vec::new() }
}

/// Frame times and assignments along the animation.
fn frames(view: &View, scene: &SceneKey, end: &str) -> Result<Option<Figure>> {
    let rows = main_rows(view, scene);
    let Some((first, _)) = rows.first().filter(|(m, _)| m.frames_ms.len() > 1) else { return Ok(None) };
    let line = |(m, style): &(&Measurement, usize), label: &str, values: Vec<f64>| Series {
        label: format!("{}{label}", m.technique()),
        style: *style,
        faint: false,
        points: numbered(values),
        ringed: None,
    };
    let times = rows.iter().map(|row| line(row, "", row.0.frames_ms.clone())).collect();
    let mut panels = vec![frame_panel("frame time [ms]", times)];
    let assignments: Vec<f64> = first.by_frame("assignments").iter().map(|count| count / 1e6).collect();
    if assignments.len() > 1 {
        let both = Series { label: "assignments".into(), ..line(&(*first, 2), "", assignments) };
        panels.push(frame_panel("assignments [millions]", vec![both]));
    }
    let title = format!("Frames along the animation, {scene}, {}", view.label());
    let caption = format!(
        "Frame times and assignments along the animation in {scene} (as figures 5.5 to 5.8; {}), on {}.",
        view.conditions(first),
        view.label()
    );
    let name = format!("frames-{}{end}", distinct_slug(&scene.name));
    Figure::draw("frames", name, caption, &Picture { title, panels, columns: 1 }).map(Some)
}

/// Photons per cluster of the first frame.
fn histogram(view: &View, scenes: &[&SceneKey], end: &str) -> Result<Option<Figure>> {
    let mut sets: Vec<(String, Vec<f64>)> = Vec::new();
    for scene in scenes {
        let of = |m: &Measurement| BINS.map(|bin| m.part(&format!("photons-{bin}"), "clusters"));
        let rows = main_rows(view, scene);
        let found = rows.iter().map(|(m, _)| (*m, of(m))).find(|(_, counts)| counts.iter().any(Option::is_some));
        if let Some((m, counts)) = found {
            let label = format!("{scene}, radius {}", m.axis("radius"));
            sets.push((label, counts.map(|count| count.unwrap_or(0.0)).into()));
        }
    }
    if sets.is_empty() {
        return Ok(None);
    }
    let mut bars = Vec::new();
    for bin in 0..BINS.len() {
        for (index, (label, counts)) in sets.iter().enumerate() {
            bars.push(bar(label.clone(), index % STYLES, (bin, index, sets.len()), counts[bin]));
        }
    }
    let panels = vec![bar_panel(String::new(), "clusters", BINS.map(str::to_owned).into(), bars)];
    let title = format!("Photons per cluster, first frame, {}", view.label());
    let caption = format!("Clusters by their number of photons in the first frame, on {}.", view.label());
    Figure::draw("histogram", format!("histogram{end}"), caption, &Picture { title, panels, columns: 1 }).map(Some)
}

/// Errors against time: a line for each technique from the smallest radius to the largest, of rows with the tile and
/// the number of paths of the rows that other figures show.
fn quality(view: &View, scenes: &[&SceneKey], end: &str) -> Result<Option<Figure>> {
    let panel = |scene: &&SceneKey| {
        let mut series: Vec<Series> = Vec::new();
        let of_others = main_rows(view, scene).first().map(|(m, _)| *m);
        let is_like = |m: &Measurement| {
            let is = |axis: &&str| m.axis(axis).is_empty() || of_others.is_none_or(|o| o.axis(axis) == m.axis(axis));
            ["paths", "tile"].iter().all(is)
        };
        let mut rows: Vec<&Measurement> = view.usual_rows().filter(|m| m.scene == **scene && is_like(m)).collect();
        rows.sort_by(|a, b| radius(a).total_cmp(&radius(b)));
        for m in rows {
            let Some(rmse) = m.metric("rmse") else { continue };
            let label = m.technique().to_owned();
            match series.iter_mut().find(|series| series.label == label) {
                Some(series) => series.points.push((m.mean_ms, rmse)),
                None => {
                    let style = super::data::TECHNIQUES.iter().position(|name| *name == label).unwrap_or(4);
                    let points = vec![(m.mean_ms, rmse)];
                    series.push(Series { label, style, faint: false, points, ringed: None });
                }
            }
        }
        let points = || series.iter().flat_map(|series| &series.points);
        let log = spreads(points().map(|point| point.1));
        (!series.is_empty()).then(|| Panel {
            title: scene.to_string(),
            x: Axis::of_sizes("time per frame [ms]", points().map(|point| point.0)),
            y: Axis::of_values("RMSE of irradiance", log, points().map(|point| point.1)),
            series: series.clone(),
            groups: Vec::new(),
            bars: Vec::new(),
            bands: Vec::new(),
            marks: Vec::new(),
        })
    };
    let panels: Vec<Panel> = scenes.iter().filter_map(panel).collect();
    if panels.is_empty() {
        return Ok(None);
    }
    let columns = if panels.len() == 1 { 1 } else { 2 };
    let title = format!("Errors against time, {}", view.label());
    let caption = format!(
        "Root mean squared error of indirect irradiance against the time of a frame, from the smallest radius to the \
         largest, rows with the usual options, on {}.",
        view.label()
    );
    Figure::draw("quality", format!("quality{end}"), caption, &Picture { title, panels, columns }).map(Some)
}
