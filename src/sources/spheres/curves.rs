//! Rows that differ in one number alone: of threads, or of lanes.

use super::data::{Measurement, View};
use super::scenes::SceneKey;
use super::setting::{Algorithm, Renderer, Setting};

/// Rows of a scene by a number, ascending.
#[derive(Clone, Debug)]
pub struct Curve<'a> {
    /// The scene.
    pub scene: SceneKey,
    /// What the rows have in common; its own number means nothing.
    pub setting: Setting,
    /// At least two numbers, each with its row.
    pub points: Vec<(usize, &'a Measurement)>,
}

/// Curves of rows: `number` gives a row's number and its setting without it.
fn curves<'a>(view: &View<'a>, number: impl Fn(&Measurement) -> Option<(usize, Setting)>) -> Vec<Curve<'a>> {
    let mut curves: Vec<Curve> = Vec::new();
    for row in view.rows().filter(|m| !m.setting.half) {
        let Some((number, setting)) = number(row) else { continue };
        match curves.iter_mut().find(|c| c.scene == row.scene && c.setting == setting) {
            // The same number twice: asked for, and the device's own
            Some(curve) if curve.points.iter().any(|(known, _)| *known == number) => {}
            Some(curve) => curve.points.push((number, row)),
            None => curves.push(Curve { scene: row.scene.clone(), setting, points: vec![(number, row)] }),
        }
    }
    curves.retain(|curve| curve.points.len() > 1);
    curves.iter_mut().for_each(|curve| curve.points.sort_by_key(|(number, _)| *number));
    curves.sort_by(|a, b| (&a.scene, a.setting.renderer).cmp(&(&b.scene, b.setting.renderer)));
    curves
}

/// By number of threads.
pub fn by_threads<'a>(view: &View<'a>) -> Vec<Curve<'a>> {
    curves(view, |m| Some((m.threads?, Setting { threads: None, ..m.setting.clone() })))
}

/// By number of lanes, with all threads.
pub fn by_lanes<'a>(view: &View<'a>) -> Vec<Curve<'a>> {
    let of = |m: &Measurement| {
        let is = m.setting.renderer.has_lanes() && view.has_all_threads(m);
        is.then(|| (m.setting.lanes, Setting { lanes: 0, threads: None, ..m.setting.clone() }))
    };
    curves(view, of)
}

impl<'a> Curve<'a> {
    /// The row without vectors and without a pool that has the same switches; `keep_lanes` for the one with vectors.
    pub fn base(&self, view: &View<'a>, keep_lanes: bool) -> Option<&'a Measurement> {
        let own = &self.setting;
        let keep_lanes = keep_lanes && own.renderer.has_lanes();
        let base = match keep_lanes {
            true => Setting { renderer: Renderer::Simd, ..own.clone() },
            false => Setting {
                renderer: Renderer::Sequential,
                lanes: 1,
                skip_no_hit: false,
                skip_no_discriminant: false,
                ..own.clone()
            },
        };
        view.like(&self.scene, &base)
    }

    /// The switches that all rows have, in words.
    pub fn words(&self) -> String {
        let words = self.setting.switches();
        words.strip_prefix("0 lanes, ").unwrap_or(&words).to_owned()
    }

    /// True for the fastest kind of curve: one pass, all exits of the renderer.
    pub fn is_last(&self) -> bool {
        let s = &self.setting;
        let skips = !s.renderer.has_lanes() || (s.skip_no_hit && s.skip_no_discriminant);
        s.algorithm == Algorithm::OnePass && s.exit_on_miss && skips
    }
}
