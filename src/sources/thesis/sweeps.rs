//! Series over one quantity, for figures and claims.

use super::data::{Data, Frame};
use super::scenes::SceneKey;
use super::structures::{GRID, RESOLUTION_OPTIONS};
use super::variant::Variant;
use crate::workloads::trace::backend::Config;

/// A grid of some resolution.
#[derive(Clone, Copy, Debug)]
pub struct Point<'a> {
    /// Cells on the shortest side, as in figure 5.1.
    pub cells: u32,
    /// True for the resolution of the rule.
    pub is_rule: bool,
    /// The times.
    pub frame: &'a Frame,
}

/// The grid at every resolution that was measured of a scene, from the coarsest, at the image size that has most of
/// them (of equals the largest). Empty if fewer than two.
pub fn grid_sweep<'a>(data: &'a Data, device: usize, scene: &SceneKey, config: Config) -> Vec<Point<'a>> {
    let cells = |variant: &Variant| {
        let p = &data.built_of(scene, GRID, variant)?.properties;
        Some(p.cells_x?.min(p.cells_y?).min(p.cells_z?))
    };
    // Only the resolution may differ from the defaults
    let only_size = |v: &Variant| {
        v.is_default() || v.only_beyond(&Variant::default()).is_some_and(|(key, _)| RESOLUTION_OPTIONS.contains(&key))
    };
    let mut best: Vec<Point> = Vec::new();
    for side in data.sides(device) {
        let of_side = data.frames.iter().filter(|f| {
            (f.device, f.config, f.width, f.height) == (device, config, side, side)
                && f.structure == GRID
                && f.scene == *scene
                && only_size(&f.variant)
        });
        let point = |frame: &'a Frame| {
            Some(Point { cells: cells(&frame.variant)?, is_rule: frame.variant.is_default(), frame })
        };
        let mut points: Vec<Point> = of_side.filter_map(point).collect();
        // The same resolution by rule and by hand: one point, the rule's
        points.sort_by_key(|p| (p.cells, !p.is_rule));
        points.dedup_by_key(|p| p.cells);
        if points.len() >= best.len().max(2) {
            best = points;
        }
    }
    best
}

/// Mean frame times by image side, from the smallest, of one structure with these options.
pub fn resolution_sweep<'a>(
    data: &'a Data,
    device: usize,
    scene: &SceneKey,
    (structure, variant): (&str, &Variant),
    config: Config,
) -> Vec<&'a Frame> {
    let sides = data.sides(device).into_iter();
    sides.filter_map(|side| data.frame(device, scene, (structure, variant), config, side)).collect()
}
