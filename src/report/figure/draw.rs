//! Panels as SVG, by plotters.

use super::axis::Axis;
use super::theme::{self, AXIS, GROUND, MESH, TEXT};
use plotters::chart::{ChartBuilder, ChartContext};
use plotters::coord::Shift;
use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};
use plotters::drawing::DrawingAreaErrorKind;
use plotters::prelude::{
    Cartesian2d, DrawingArea, EmptyElement, IntoDrawingArea, PathElement, Polygon, Rectangle, SVGBackend, Text,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, IntoFont, ShapeStyle, TextStyle};

/// A figure: panels in rows under one title and one legend.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// The title above all panels.
    pub title: String,
    /// The panels, row by row from the left.
    pub panels: Vec<Panel>,
    /// The number of panels in a row.
    pub columns: usize,
}

/// A coordinate system with lines, bars or stacked bands.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// The title above the panel; may be empty.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// The lines.
    pub series: Vec<Series>,
    /// The names below groups of bars, from position 0; empty without bars.
    pub groups: Vec<String>,
    /// The bars.
    pub bars: Vec<Bar>,
    /// Bands that are stacked from zero, the lowest first.
    pub bands: Vec<Band>,
    /// Points with a word next to each.
    pub marks: Vec<Mark>,
}

/// A point of a scatter plot.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// The word next to it, which the legend has in front of the label.
    pub text: String,
    /// The label in the legend.
    pub label: String,
    /// The index of colour and marker.
    pub style: usize,
    /// The values.
    pub at: (f64, f64),
}

/// A line with markers.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// The label in the legend.
    pub label: String,
    /// The index of colour and marker.
    pub style: usize,
    /// True for a thin line with hollow markers: a second quantity of the same colour.
    pub faint: bool,
    /// The values, from the left.
    pub points: Vec<(f64, f64)>,
    /// A value to draw a ring around.
    pub ringed: Option<(f64, f64)>,
}

/// An area of a stack: it begins where the ones before it end.
#[derive(Clone, Debug, PartialEq)]
pub struct Band {
    /// The label in the legend.
    pub label: String,
    /// The index of the colour.
    pub style: usize,
    /// Position and height, from the left; the positions are those of all bands of the panel.
    pub points: Vec<(f64, f64)>,
}

/// A bar with whiskers.
#[derive(Clone, Debug, PartialEq)]
pub struct Bar {
    /// The label in the legend.
    pub label: String,
    /// The index of the colour.
    pub style: usize,
    /// Left and right end, in groups.
    pub span: (f64, f64),
    /// The height.
    pub mean: f64,
    /// Lower and upper end of the whiskers.
    pub whiskers: (f64, f64),
}

const WIDTH: i32 = 880;
const PANEL_HEIGHT: i32 = 280;
const WIDE_PANEL_HEIGHT: i32 = 400;
/// Size of letters as plotters counts it; a viewer shows about four fifths of it.
const LETTER: i32 = 16;
/// Width of an average letter, with a reserve for wider fonts of a viewer.
const LETTER_WIDTH: f64 = 7.2;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Outcome = Result<(), DrawingAreaErrorKind<std::io::Error>>;
type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<Scale, Scale>>;

/// A range with given ticks: those of plotters are made for powers of ten.
struct Scale {
    range: (f64, f64),
    ticks: Vec<f64>,
}

impl Ranged for Scale {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let share = (value - self.range.0) / (self.range.1 - self.range.0);
        limit.0 + (share * f64::from(limit.1 - limit.0)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        // No lines between ticks
        if hint.weight().allow_light_points() { Vec::new() } else { self.ticks.clone() }
    }

    fn range(&self) -> std::ops::Range<f64> {
        self.range.0..self.range.1
    }
}

fn letters(size: i32) -> TextStyle<'static> {
    TextStyle::from(("sans-serif", size).into_font()).color(&TEXT)
}

/// Draws a picture as an SVG document.
///
/// # Errors
/// None in practice: the writer is memory.
pub fn svg(picture: &Picture) -> Result<String, DrawingAreaErrorKind<std::io::Error>> {
    let legend = legend_rows(picture);
    let top = 34 + 22 * legend.len() as i32;
    let columns = picture.columns.max(1).min(picture.panels.len().max(1));
    let rows = picture.panels.len().div_ceil(columns);
    let height = if columns == 1 { WIDE_PANEL_HEIGHT } else { PANEL_HEIGHT };
    let mut text = String::new();
    {
        let size = (WIDTH as u32, (top + height * rows as i32) as u32);
        let root = SVGBackend::with_string(&mut text, size).into_drawing_area();
        root.fill(&GROUND)?;
        let middle = letters(LETTER + 3).pos(Pos::new(HPos::Center, VPos::Top));
        root.draw(&Text::new(picture.title.clone(), (WIDTH / 2, 10), middle))?;
        for (row, entries) in legend.iter().enumerate() {
            draw_legend(&root, entries, 42 + 22 * row as i32)?;
        }
        let (_, below) = root.split_vertically(top);
        for (area, panel) in below.split_evenly((rows, columns)).iter().zip(&picture.panels) {
            draw_panel(area, panel)?;
        }
        root.present()?;
    }
    Ok(finished(&text, &picture.title))
}

/// Adds what plotters cannot write: a title for screen readers, and the colours of a dark page.
fn finished(svg: &str, title: &str) -> String {
    let escaped = title.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    let head = svg.find('>').map_or(svg.len(), |end| end + 1);
    let (tag, rest) = svg.split_at(head);
    let tag = tag.replacen("<svg", "<svg role=\"img\"", 1);
    format!("{tag}\n<title>{escaped}</title>\n<style>{}</style>{rest}", theme::style_sheet())
}

/// An entry of the legend: label, style, faint or not, and what is drawn before it.
type Entry = (String, usize, bool, Sample);

/// What is drawn before a legend's label.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Sample {
    Line,
    Bar,
    Marker,
}

/// The entries of all panels, each once, broken into rows.
fn legend_rows(picture: &Picture) -> Vec<Vec<Entry>> {
    let mut entries: Vec<Entry> = Vec::new();
    for panel in &picture.panels {
        let lines = panel.series.iter().map(|s| (s.label.clone(), s.style, s.faint, Sample::Line));
        let bars = panel.bars.iter().map(|b| (b.label.clone(), b.style, false, Sample::Bar));
        let bands = panel.bands.iter().map(|b| (b.label.clone(), b.style, false, Sample::Bar));
        let marks = panel.marks.iter().map(|m| (format!("{} {}", m.text, m.label), m.style, false, Sample::Marker));
        for entry in lines.chain(bars).chain(bands).chain(marks) {
            if !entries.contains(&entry) {
                entries.push(entry);
            }
        }
    }
    let mut rows: Vec<Vec<Entry>> = Vec::new();
    let mut used = f64::INFINITY;
    for entry in entries {
        if used + entry_width(&entry) > f64::from(WIDTH) - 40.0 {
            rows.push(Vec::new());
            used = 0.0;
        }
        used += entry_width(&entry);
        if let Some(row) = rows.last_mut() {
            row.push(entry);
        }
    }
    rows
}

fn entry_width((label, ..): &Entry) -> f64 {
    44.0 + LETTER_WIDTH * label.chars().count() as f64
}

fn draw_legend(root: &Area, entries: &[Entry], y: i32) -> Outcome {
    let total: f64 = entries.iter().map(entry_width).sum();
    let mut x = (f64::from(WIDTH) - total) / 2.0;
    for entry in entries {
        let (label, style, faint, sample) = entry;
        let at = x as i32;
        if *sample == Sample::Bar {
            root.draw(&Rectangle::new([(at, y - 5), (at + 22, y + 6)], theme::series(*style).filled()))?;
        } else {
            if *sample == Sample::Line {
                root.draw(&PathElement::new(vec![(at, y), (at + 24, y)], line_style(*style, *faint)))?;
            }
            let outline = theme::marker(*style).into_iter().map(|(dx, dy)| (at + 12 + dx, y + dy)).collect::<Vec<_>>();
            draw_outline(root, outline, *style, *faint)?;
        }
        let text = letters(LETTER).pos(Pos::new(HPos::Left, VPos::Center));
        root.draw(&Text::new(label.clone(), (at + 30, y + 1), text))?;
        x += entry_width(entry);
    }
    Ok(())
}

fn line_style(style: usize, faint: bool) -> ShapeStyle {
    theme::series(style).stroke_width(if faint { 1 } else { 2 })
}

fn draw_outline(root: &Area, mut outline: Vec<(i32, i32)>, style: usize, faint: bool) -> Outcome {
    if faint {
        outline.extend(outline.first().copied());
        return root.draw(&PathElement::new(outline, theme::series(style).stroke_width(1)));
    }
    root.draw(&Polygon::new(outline, theme::series(style).filled()))
}

fn draw_panel(area: &Area, panel: &Panel) -> Outcome {
    let small = letters(LETTER - 1);
    if !panel.title.is_empty() {
        let (width, _) = area.dim_in_pixel();
        let middle = letters(LETTER).pos(Pos::new(HPos::Center, VPos::Top));
        area.draw(&Text::new(panel.title.clone(), (width as i32 / 2 + 24, 4), middle))?;
    }
    let scale = |axis: &Axis| Scale { range: axis.range, ticks: axis.ticks.clone() };
    let mut chart: Chart = ChartBuilder::on(area)
        .margin(6)
        .margin_top(if panel.title.is_empty() { 8 } else { 24 })
        .margin_right(16)
        .x_label_area_size(46)
        .y_label_area_size(66)
        .build_cartesian_2d(scale(&panel.x), scale(&panel.y))?;
    let x_label = |position: &f64| match panel.groups.get(position.round() as usize) {
        Some(group) if !panel.groups.is_empty() => group.clone(),
        _ => panel.x.write(*position),
    };
    let y_label = |position: &f64| panel.y.write(*position);
    let mut mesh = chart.configure_mesh();
    if !panel.groups.is_empty() {
        mesh.disable_x_mesh();
    }
    mesh.bold_line_style(MESH)
        .light_line_style(MESH)
        .axis_style(AXIS)
        .label_style(small.clone())
        .axis_desc_style(small)
        .x_label_formatter(&x_label)
        .y_label_formatter(&y_label)
        .x_desc(panel.x.label.clone())
        .y_desc(panel.y.label.clone())
        .draw()?;
    draw_bands(&mut chart, panel)?;
    for bar in &panel.bars {
        draw_bar(&mut chart, panel, bar)?;
    }
    for series in &panel.series {
        draw_series(&mut chart, panel, series)?;
    }
    for mark in &panel.marks {
        draw_mark(&mut chart, panel, mark)?;
    }
    Ok(())
}

/// Draws the bands on top of each other.
fn draw_bands(chart: &mut Chart, panel: &Panel) -> Outcome {
    let place = |(x, y): (f64, f64)| (panel.x.position(x), panel.y.position(y).min(panel.y.range.1));
    let mut below: Vec<f64> = Vec::new();
    for band in &panel.bands {
        below.resize(band.points.len(), 0.0);
        let above: Vec<f64> = band.points.iter().zip(&below).map(|((_, height), below)| below + height).collect();
        let edge = |heights: &[f64]| -> Vec<(f64, f64)> {
            band.points.iter().zip(heights).map(|((x, _), height)| place((*x, *height))).collect()
        };
        let outline: Vec<(f64, f64)> = edge(&above).into_iter().chain(edge(&below).into_iter().rev()).collect();
        chart.draw_series([Polygon::new(outline, theme::series(band.style).filled())])?;
        below = above;
    }
    Ok(())
}

fn draw_bar(chart: &mut Chart, panel: &Panel, bar: &Bar) -> Outcome {
    let y = |value: f64| panel.y.position(value).clamp(panel.y.range.0, panel.y.range.1);
    let ((from, to), floor) = (bar.span, panel.y.range.0);
    let body = Rectangle::new([(from, floor), (to, y(bar.mean))], theme::series(bar.style).filled());
    chart.draw_series([body])?;
    let (middle, cap) = ((from + to) / 2.0, (to - from) / 4.0);
    let (low, high) = (y(bar.whiskers.0), y(bar.whiskers.1));
    let line = |from, to| PathElement::new(vec![from, to], TEXT.stroke_width(1));
    chart.draw_series([
        line((middle, low), (middle, high)),
        line((middle - cap, low), (middle + cap, low)),
        line((middle - cap, high), (middle + cap, high)),
    ])?;
    Ok(())
}

fn draw_series(chart: &mut Chart, panel: &Panel, series: &Series) -> Outcome {
    let position = |(x, y): (f64, f64)| (panel.x.position(x), panel.y.position(y));
    let points: Vec<(f64, f64)> = series.points.iter().map(|p| position(*p)).collect();
    chart.draw_series([PathElement::new(points.clone(), line_style(series.style, series.faint))])?;
    let outline = theme::marker(series.style);
    if series.faint {
        let mut closed = outline.clone();
        closed.extend(outline.first().copied());
        let style = theme::series(series.style).stroke_width(1);
        chart.draw_series(points.iter().map(|p| EmptyElement::at(*p) + PathElement::new(closed.clone(), style)))?;
    } else {
        let style = theme::series(series.style).filled();
        chart.draw_series(points.iter().map(|p| EmptyElement::at(*p) + Polygon::new(outline.clone(), style)))?;
    }
    if let Some(point) = series.ringed {
        let ring = plotters::prelude::Circle::new(position(point), 10, AXIS.stroke_width(2));
        chart.draw_series([ring])?;
    }
    Ok(())
}

fn draw_mark(chart: &mut Chart, panel: &Panel, mark: &Mark) -> Outcome {
    let at = (panel.x.position(mark.at.0), panel.y.position(mark.at.1));
    let marker = Polygon::new(theme::marker(mark.style), theme::series(mark.style).filled());
    let text = letters(LETTER - 3).pos(Pos::new(HPos::Left, VPos::Center));
    chart.draw_series([EmptyElement::at(at) + marker + Text::new(mark.text.clone(), (8, -4), text)])?;
    Ok(())
}
