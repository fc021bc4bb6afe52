//! Colours of figures, on paper and on a dark page.
//!
//! Every role has its own colour, so that a style sheet inside the SVG can exchange it on a dark page; paper and
//! viewers without style sheets have the light colours on a white ground. The series have the colours of Okabe and Ito,
//! "Color Universal Design" (2008), which people with colour vision deficiencies distinguish; each series also has a
//! marker of its own shape.

use plotters::style::RGBColor;

/// The background.
pub const GROUND: RGBColor = RGBColor(255, 255, 255);
/// Letters and whiskers.
pub const TEXT: RGBColor = RGBColor(26, 26, 28);
/// Axes and rings.
pub const AXIS: RGBColor = RGBColor(90, 90, 94);
/// Grid lines behind the series.
pub const MESH: RGBColor = RGBColor(224, 224, 228);

/// The series, on a light ground.
const SERIES: [RGBColor; 8] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(166, 118, 29),
    RGBColor(86, 150, 200),
    RGBColor(100, 100, 104),
    RGBColor(110, 120, 0),
];

/// The same roles on a dark ground: letters and lines lighter, so that contrast stays.
const DARK: [(RGBColor, RGBColor); 12] = [
    (GROUND, RGBColor(20, 23, 28)),
    (TEXT, RGBColor(232, 232, 236)),
    (AXIS, RGBColor(160, 160, 166)),
    (MESH, RGBColor(52, 56, 63)),
    (SERIES[0], RGBColor(90, 176, 240)),
    (SERIES[1], RGBColor(255, 140, 66)),
    (SERIES[2], RGBColor(52, 200, 156)),
    (SERIES[3], RGBColor(230, 158, 198)),
    (SERIES[4], RGBColor(226, 178, 84)),
    (SERIES[5], RGBColor(158, 208, 255)),
    (SERIES[6], RGBColor(178, 178, 184)),
    (SERIES[7], RGBColor(204, 214, 96)),
];

/// The colour of a series.
pub fn series(index: usize) -> RGBColor {
    SERIES[index % SERIES.len()]
}

/// The number of colours and of shapes; series beyond it begin again.
pub const STYLES: usize = SERIES.len();

/// The outline of a series' marker around its point, in pixels.
pub fn marker(index: usize) -> Vec<(i32, i32)> {
    match index % SERIES.len() {
        0 => vec![(-4, -4), (4, -4), (4, 4), (-4, 4)],
        1 => vec![(0, -6), (5, 4), (-5, 4)],
        2 => vec![(-2, -5), (2, -5), (5, -2), (5, 2), (2, 5), (-2, 5), (-5, 2), (-5, -2)],
        3 => vec![(0, -6), (6, 0), (0, 6), (-6, 0)],
        4 => vec![(0, 6), (5, -4), (-5, -4)],
        5 => vec![
            (-6, -2),
            (-2, -2),
            (-2, -6),
            (2, -6),
            (2, -2),
            (6, -2),
            (6, 2),
            (2, 2),
            (2, 6),
            (-2, 6),
            (-2, 2),
            (-6, 2),
        ],
        6 => vec![(-7, -2), (7, -2), (7, 2), (-7, 2)],
        _ => vec![(-2, -7), (2, -7), (2, 7), (-2, 7)],
    }
}

fn hex(colour: RGBColor) -> String {
    format!("#{:02X}{:02X}{:02X}", colour.0, colour.1, colour.2)
}

/// The style sheet that exchanges colours on a dark screen. The SVG has colours as attributes, which any rule
/// overrides.
pub fn style_sheet() -> String {
    let rule = |(light, dark): &(RGBColor, RGBColor)| {
        let (light, dark) = (hex(*light), hex(*dark));
        format!("[fill=\"{light}\"]{{fill:{dark}}}[stroke=\"{light}\"]{{stroke:{dark}}}")
    };
    let rules: String = DARK.iter().map(rule).collect();
    format!("@media screen and (prefers-color-scheme:dark){{{rules}}}")
}
