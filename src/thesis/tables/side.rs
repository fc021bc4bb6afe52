//! Which image size stands for all, where a table or a figure has room for one.

use crate::thesis::data::{Data, Frame};
use crate::thesis::scenes::SceneKey;
use crate::thesis::variant::Variant;
use crate::workloads::trace::backend::Config;

/// Sides of the thesis's images, from the largest: only these have published numbers to stand beside.
const PUBLISHED: [u32; 4] = [1024, 768, 512, 256];

/// The side of the square images that shows most of the wanted frames: the largest of the thesis's that (nearly) every
/// scene was measured at; if there is none, the largest of any; else the one with most. None without a frame.
///
/// Only frames with a structure's default options count, because only they stand in tables by scene.
pub fn representative(data: &Data, wanted: impl Fn(&Frame) -> bool) -> Option<u32> {
    let default = |f: &&Frame| {
        f.width == f.height && f.variant == Variant::of_thesis(f.scene.thesis(), &f.structure) && wanted(f)
    };
    let frames: Vec<&Frame> = data.frames.iter().filter(default).collect();
    let number = |at: &dyn Fn(&Frame) -> bool| {
        let mut measured: Vec<(usize, &SceneKey, Config)> =
            frames.iter().filter(|f| at(f)).map(|f| (f.device, &f.scene, f.config)).collect();
        measured.sort_unstable_by(|a, b| (a.0, a.1, a.2 as u8).cmp(&(b.0, b.1, b.2 as u8)));
        measured.dedup();
        measured.len()
    };
    let all = number(&|_| true);
    let of = |side: u32| number(&|f| f.width == side);
    // One scene of the thesis's nine may be too large for the device
    let nearly_all = |side: &u32| 8 * of(*side) >= 7 * all;
    let mut sides: Vec<u32> = frames.iter().map(|f| f.width).collect();
    sides.sort_unstable_by(|a, b| b.cmp(a));
    sides.dedup();
    let thesis = PUBLISHED.into_iter().filter(|side| sides.contains(side)).find(nearly_all);
    let any = || sides.iter().copied().find(nearly_all);
    thesis.or_else(any).or_else(|| sides.iter().copied().max_by_key(|side| (of(*side), *side)))
}

/// The side of tables 5.12 to 5.14 where none is asked for: of all devices together, or of one of the thesis's cards.
pub fn usual(data: &Data, card: usize) -> u32 {
    representative(data, |f| !data.published || f.device == card).unwrap_or(PUBLISHED[0])
}
