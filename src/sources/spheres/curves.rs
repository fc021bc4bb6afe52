//! Rows that differ in one number alone: of threads, of lanes, or of spheres.

use super::data::{Measurement, View};
use super::scenes::SceneKey;
use super::setting::{Algorithm, Hit, Renderer, Setting};

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

/// A renderer's rows of one setting over scenes, ascending by the number of spheres, each number once.
#[derive(Clone, Debug)]
pub struct OverScenes<'a> {
    /// The setting.
    pub setting: Setting,
    /// The rows.
    pub points: Vec<(SceneKey, &'a Measurement)>,
}

/// By number of spheres: of each renderer the setting that was measured on most scenes, of equals the fastest.
pub fn by_spheres<'a>(view: &View<'a>) -> Vec<OverScenes<'a>> {
    let mut found: Vec<OverScenes> = Vec::new();
    for row in view.rows().filter(|m| !m.setting.half && view.has_all_threads(m)) {
        let point = (row.scene.clone(), row);
        match found.iter_mut().find(|of| of.setting == row.setting) {
            Some(of) => of.points.push(point),
            None => found.push(OverScenes { setting: row.setting.clone(), points: vec![point] }),
        }
    }
    for of in &mut found {
        of.points.sort_by_key(|(scene, _)| scene.spheres);
        of.points.dedup_by_key(|(scene, _)| scene.spheres);
    }
    let best = |renderer: Renderer| {
        let of_renderer = found.iter().filter(|of| of.setting.renderer == renderer);
        of_renderer.max_by(|a, b| {
            let total = |of: &OverScenes| of.points.iter().map(|(_, m)| m.mean_ms).sum::<f64>();
            a.points.len().cmp(&b.points.len()).then(total(b).total_cmp(&total(a)))
        })
    };
    Renderer::ALL.into_iter().filter_map(best).cloned().collect()
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

    /// What tells curves of one renderer apart, in few words.
    pub fn label(&self) -> String {
        let s = &self.setting;
        let level = if s.level.is_empty() { "best level" } else { &s.level };
        let hit = if s.hit == Some(Hit::InLoop) { "in the loop" } else { "index" };
        let words = if s.renderer.has_lanes() { format!("{level}, {hit}") } else { hit.to_owned() };
        format!("{}, {words}", s.renderer.title())
    }

    /// True for the fastest kind of curve: one pass, all exits of the renderer.
    pub fn is_last(&self) -> bool {
        let s = &self.setting;
        let skips = !s.renderer.has_lanes() || (s.skip_no_hit && s.skip_no_discriminant);
        s.algorithm == Algorithm::OnePass && s.exit_on_miss && skips
    }
}
