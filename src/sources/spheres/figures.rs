//! Figures: times of every version, how they scale over threads, lanes and spheres, and speed-ups next to the printed
//! ones.

use super::curves::{Curve, OverScenes, by_lanes, by_spheres, by_threads};
use super::data::{Data, Place, Terms, View};
use super::published::Published;
use super::scenes::{Role, SceneKey};
use super::setting::{Renderer, Stage};
use crate::error::Result;
use crate::report::figure::{Axis, Bar, Figure, Missing, Panel, Picture, Series, spreads};

/// What the figures need.
const NEEDS: [(&str, &str, &str); 5] = [
    ("times", "times of each version", "rows of the paper's structure on its scenes"),
    ("speed-up", "speed-ups next to the printed ones", "rows of the paper's structure and of sequential on its scenes"),
    ("threads", "speed-up over threads", "threads or simd-threads with at least two numbers of threads"),
    ("lanes", "speed-up over lanes", "simd or simd-threads with at least two numbers of lanes, and sequential"),
    ("spheres", "times over the number of spheres", "a renderer with one setting on at least three scenes"),
];

/// All figures that there is data for, and the others. Without runs: those of the printed times.
///
/// # Errors
/// None in practice: drawing goes to memory.
pub fn all(data: Option<&Data>, published: &Published) -> Result<(Vec<Figure>, Vec<Missing>)> {
    let printed = View { data: &published.data, place: published.data.places[0], terms: Terms::default() };
    let mut figures = Vec::new();
    match data {
        None => {
            figures.extend(times(&printed, "as printed", "")?);
            figures.extend(over_spheres(&printed, "as printed", "")?);
        }
        Some(data) => {
            for (index, place) in data.places.iter().enumerate() {
                figures.extend(of_place(data, *place, &printed, index)?);
            }
        }
    }
    let absent = NEEDS.iter().filter(|(id, ..)| !figures.iter().any(|figure| figure.id == *id));
    let missing = absent.map(|(id, what, needs)| Missing { id, what: (*what).into(), needs }).collect();
    figures.sort_by_key(|figure| NEEDS.iter().position(|(id, ..)| *id == figure.id));
    Ok((figures, missing))
}

fn of_place(data: &Data, place: Place, printed: &View, index: usize) -> Result<Vec<Figure>> {
    let end = if index == 0 { String::new() } else { format!("-machine{}", index + 1) };
    let label = |view: &View| {
        let devices = [Some(place.machine), place.gpu].into_iter().flatten();
        let names: Vec<&str> = devices.filter_map(|d| data.devices.get(d)).map(|d| d.label.as_str()).collect();
        format!("{}x{}, {}", view.terms.width, view.terms.height, names.join(" and "))
    };
    let main = data.main_view(place, None);
    let threads = data.view(place, None, |m| m.setting.threads.is_some() && !m.setting.half);
    let lanes = data.view(place, None, |m| m.setting.renderer.has_lanes() && !m.setting.half);
    let generated = data.view(place, None, |m| m.scene.role == Role::Generated && !m.setting.half);
    let spheres = if generated.scenes().len() > main.scenes().len() { &generated } else { &main };
    let figures = [
        times(&main, &label(&main), &end)?,
        speed_ups(&main, printed, &label(&main), &end)?,
        over_threads(&threads, &label(&threads), &end)?,
        over_lanes(&lanes, &label(&lanes), &end)?,
        over_spheres(spheres, &label(spheres), &end)?,
    ];
    Ok(figures.into_iter().flatten().collect())
}

/// The index of a renderer's colour in every figure.
fn colour(renderer: Renderer) -> usize {
    match renderer {
        Renderer::Sequential => 6,
        Renderer::Threads => 0,
        Renderer::Simd => 1,
        Renderer::SimdThreads => 2,
        Renderer::Gpu => 3,
    }
}

fn drawn(id: &'static str, name: String, caption: &str, label: &str, picture: Picture) -> Result<Option<Figure>> {
    Figure::draw(id, name, format!("{caption} ({label})."), &picture).map(Some)
}

/// Bars by group, each with its index in the group.
type Groups = Vec<Vec<Option<(Bar, usize)>>>;

/// Places bars in their groups.
fn bars(groups: &[String], bars: Groups) -> (Vec<Bar>, Vec<String>) {
    let mut placed = Vec::new();
    for (group, of_group) in bars.into_iter().enumerate() {
        let width = 0.84 / of_group.len().max(1) as f64;
        for (bar, index) in of_group.into_iter().flatten() {
            let from = group as f64 - 0.42 + width * index as f64;
            placed.push(Bar { span: (from, from + 0.92 * width), ..bar });
        }
    }
    (placed, groups.to_vec())
}

/// A panel of bars.
fn bar_panel(title: String, y: Axis, (bars, groups): (Vec<Bar>, Vec<String>)) -> Panel {
    let x = Axis {
        label: String::new(),
        log: false,
        range: (-0.5, groups.len() as f64 - 0.5),
        ticks: (0..groups.len()).map(|group| group as f64).collect(),
    };
    Panel { title, x, y, series: Vec::new(), groups, bars, bands: Vec::new(), marks: Vec::new() }
}

/// Times of each version and renderer, a panel for each scene.
fn times(view: &View, label: &str, end: &str) -> Result<Option<Figure>> {
    let of_paper: Vec<SceneKey> = view.scenes().into_iter().filter(SceneKey::is_of_paper).collect();
    let at = |scene: &SceneKey, renderer: Renderer, stage: Stage| view.stage(scene, renderer, stage);
    let all: Vec<f64> = of_paper
        .iter()
        .flat_map(|scene| Stage::ALL.into_iter().flat_map(move |s| Renderer::ALL.map(|r| (scene, r, s))))
        .filter_map(|(scene, renderer, stage)| at(scene, renderer, stage))
        .flat_map(|m| [m.mean_ms, m.min_ms, m.max_ms])
        .collect();
    if all.is_empty() {
        return Ok(None);
    }
    let log = spreads(all.iter().copied());
    let panel = |scene: &SceneKey| {
        let groups = Stage::ALL.map(|stage| stage.title().to_owned());
        let of_stage = |stage: Stage| {
            let bar = |(index, renderer): (usize, Renderer)| {
                let m = at(scene, renderer, stage)?;
                let whiskers = (m.min_ms, m.max_ms);
                let label = renderer.title().to_owned();
                Some((Bar { label, style: colour(renderer), span: (0.0, 0.0), mean: m.mean_ms, whiskers }, index))
            };
            Renderer::ALL.into_iter().enumerate().map(bar).collect()
        };
        let y = Axis::of_values("time per frame [ms]", log, all.iter().copied());
        bar_panel(format!("{scene}, {} spheres", scene.spheres), y, bars(&groups, Stage::ALL.map(of_stage).into()))
    };
    let panels: Vec<Panel> = of_paper.iter().map(panel).collect();
    let picture = Picture { title: format!("Times of each version, {label}"), panels, columns: 1 };
    let caption = "Mean time per frame of each version in the paper's structure; whiskers: fastest and slowest frame";
    drawn("times", format!("times{end}"), caption, label, picture)
}

/// Speed-ups over sequential of the same version, with the printed ones, a panel for each scene.
fn speed_ups(view: &View, printed: &View, label: &str, end: &str) -> Result<Option<Figure>> {
    let speed_up = |view: &View, role: Role, renderer: Renderer, stage: Stage| {
        let scene = view.scene(role)?;
        let sequential = view.stage(&scene, Renderer::Sequential, stage)?;
        Some(sequential.mean_ms / view.stage(&scene, renderer, stage)?.mean_ms)
    };
    let shown: [(Renderer, Stage); 6] = [
        (Renderer::Threads, Stage::TwoPass),
        (Renderer::Simd, Stage::TwoPass),
        (Renderer::SimdThreads, Stage::TwoPass),
        (Renderer::Threads, Stage::Exits),
        (Renderer::Simd, Stage::Exits),
        (Renderer::SimdThreads, Stage::Exits),
    ];
    let mut all: Vec<f64> = Vec::new();
    let mut of_role: Vec<(Role, Groups)> = Vec::new();
    for role in Role::PAPER {
        let sides = [(view, "measured", 0), (printed, "printed", 6)];
        let of = |(renderer, stage): (Renderer, Stage)| {
            let bar = |(index, (view, label, style)): (usize, (&View, &str, usize))| {
                let mean = speed_up(view, role, renderer, stage)?;
                Some((Bar { label: label.into(), style, span: (0.0, 0.0), mean, whiskers: (mean, mean) }, index))
            };
            sides.into_iter().enumerate().map(bar).collect::<Vec<_>>()
        };
        let groups: Groups = shown.into_iter().map(of).collect();
        if groups.iter().any(|group| group[0].is_some()) {
            all.extend(groups.iter().flatten().flatten().map(|(bar, _)| bar.mean));
            of_role.push((role, groups));
        }
    }
    if of_role.is_empty() {
        return Ok(None);
    }
    let names: Vec<String> =
        shown.map(|(r, s)| format!("{}, {}", r.title(), if s == Stage::TwoPass { "first" } else { "last" })).into();
    let panels = of_role.into_iter().map(|(role, groups)| {
        let y = Axis::of_values("speed-up", false, all.iter().copied());
        bar_panel(format!("{}, {} spheres", role.name(), role.spheres()), y, bars(&names, groups))
    });
    let panels = panels.collect();
    let picture = Picture { title: format!("Speed-up over sequential, {label}"), panels, columns: 1 };
    let caption = "Speed-up over sequential of the same version, the first and the last one, next to what was printed; \
                   printed values are of 8 cores";
    drawn("speed-up", format!("speed-up{end}"), caption, label, picture)
}

/// A panel of lines, from points by number.
fn line_panel(title: &str, (x_label, y_label): (&str, &str), series: Vec<Series>) -> Panel {
    let points = || series.iter().flat_map(|s| &s.points);
    let x = Axis::of_sizes(x_label, points().map(|p| p.0));
    let log = spreads(points().map(|p| p.1));
    let y = Axis::of_values(y_label, log, points().map(|p| p.1));
    Panel {
        title: title.to_owned(),
        x,
        y,
        series,
        groups: Vec::new(),
        bars: Vec::new(),
        bands: Vec::new(),
        marks: Vec::new(),
    }
}

/// Panels by scene: a line for each renderer's last version, and the ideal one.
fn curves(found: &[Curve], gain: impl Fn(&Curve, f64) -> Option<f64>, axis: (&str, &str)) -> Vec<Panel> {
    // The last version; where it was not measured, all that there is
    let last: Vec<&Curve> = found.iter().filter(|curve| curve.is_last()).collect();
    let shown = if last.is_empty() { found.iter().collect() } else { last };
    let mut scenes: Vec<&SceneKey> = shown.iter().map(|curve| &curve.scene).collect();
    scenes.dedup();
    // Short labels where no scene has two curves of a renderer; the same ones in all panels
    let same = |a: &Curve, b: &Curve| a.scene == b.scene && a.setting.renderer == b.setting.renderer;
    let alone = shown.iter().all(|curve| shown.iter().filter(|other| same(curve, other)).count() == 1);
    let mut labels: Vec<String> = shown.iter().map(|curve| curve.label()).collect();
    labels.sort_unstable();
    labels.dedup();
    let panel = |scene: &SceneKey| {
        let of_scene: Vec<&&Curve> = shown.iter().filter(|curve| curve.scene == *scene).collect();
        let mut series = Vec::new();
        for curve in &of_scene {
            let point =
                |(number, m): &(usize, &super::data::Measurement)| Some((*number as f64, gain(curve, m.mean_ms)?));
            let points: Vec<(f64, f64)> = curve.points.iter().filter_map(point).collect();
            let renderer = curve.setting.renderer;
            let label = if alone { renderer.title().to_owned() } else { curve.label() };
            // The grey of the ideal line is the style after the first six
            let place = labels.iter().position(|known| *known == label).unwrap_or_default() % 6;
            let style = if alone { colour(renderer) } else { place };
            if points.len() > 1 {
                series.push(Series { label, style, faint: false, points, ringed: None });
            }
        }
        let mut numbers: Vec<f64> = series.iter().flat_map(|s| s.points.iter().map(|p| p.0)).collect();
        numbers.sort_by(f64::total_cmp);
        numbers.dedup();
        let ideal = numbers.into_iter().map(|number| (number, number)).collect();
        if !series.is_empty() {
            series.push(Series { label: "ideal".into(), style: 6, faint: true, points: ideal, ringed: None });
        }
        line_panel(&scene.to_string(), axis, series)
    };
    scenes.into_iter().map(panel).filter(|panel| !panel.series.is_empty()).collect()
}

fn over_threads(view: &View, label: &str, end: &str) -> Result<Option<Figure>> {
    let gain = |curve: &Curve, ms: f64| {
        let one = curve.points.iter().find(|(n, _)| *n == 1).map(|(_, m)| *m).or_else(|| curve.base(view, true))?;
        Some(one.mean_ms / ms)
    };
    let panels = curves(&by_threads(view), gain, ("threads", "speed-up over one thread"));
    scaled("threads", "Speed-up over threads", panels, label, end)
}

fn over_lanes(view: &View, label: &str, end: &str) -> Result<Option<Figure>> {
    let gain = |curve: &Curve, ms: f64| Some(curve.base(view, false)?.mean_ms / ms);
    let alone: Vec<Curve> = by_lanes(view).into_iter().filter(|c| c.setting.renderer == Renderer::Simd).collect();
    let panels = curves(&alone, gain, ("lanes", "speed-up over sequential"));
    scaled("lanes", "Speed-up over lanes, without threads", panels, label, end)
}

fn scaled(id: &'static str, what: &str, panels: Vec<Panel>, label: &str, end: &str) -> Result<Option<Figure>> {
    if panels.is_empty() {
        return Ok(None);
    }
    let columns = if panels.len() == 1 { 1 } else { 2 };
    drawn(id, format!("{id}{end}"), what, label, Picture { title: format!("{what}, {label}"), panels, columns })
}

/// Times over the number of spheres.
fn over_spheres(view: &View, label: &str, end: &str) -> Result<Option<Figure>> {
    let line = |of: &OverScenes| {
        let points: Vec<(f64, f64)> = of.points.iter().map(|(scene, m)| (scene.spheres as f64, m.mean_ms)).collect();
        let renderer = of.setting.renderer;
        let label = match renderer.has_lanes() {
            true => format!("{}, {} lanes", renderer.title(), of.setting.lanes),
            false => renderer.title().to_owned(),
        };
        (points.len() > 2).then_some(Series { label, style: colour(renderer), faint: false, points, ringed: None })
    };
    let series: Vec<Series> = by_spheres(view).iter().filter_map(line).collect();
    if series.is_empty() {
        return Ok(None);
    }
    let what = "Times over the number of spheres";
    let panels = vec![line_panel("", ("spheres", "time per frame [ms]"), series)];
    let picture = Picture { title: format!("{what}, {label}"), panels, columns: 1 };
    drawn("spheres", format!("spheres{end}"), what, label, picture)
}
