//! The image size that represents a run in a table or a figure of one size.

use crate::sources::thesis::data::{Data, Frame};
use crate::sources::thesis::scenes::SceneKey;
use crate::sources::thesis::variant::Variant;
use crate::workloads::trace::backend::Config;

/// Sides of the thesis's images, from the largest: only these have published numbers.
const PUBLISHED: [u32; 4] = [1024, 768, 512, 256];

/// The side of the square images that shows most of the wanted frames: the largest of the thesis's sides at which
/// (nearly) every scene was measured; if there is none, the largest of any such side; otherwise the side with most
/// frames. `None` without a frame.
///
/// Only frames with a structure's default options count, because only they are in tables by scene.
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
    // One of the thesis's nine scenes may be too large for the device
    let nearly_all = |side: &u32| 8 * of(*side) >= 7 * all;
    let mut sides: Vec<u32> = frames.iter().map(|f| f.width).collect();
    sides.sort_unstable_by(|a, b| b.cmp(a));
    sides.dedup();
    let thesis = PUBLISHED.into_iter().filter(|side| sides.contains(side)).find(nearly_all);
    let any = || sides.iter().copied().find(nearly_all);
    thesis.or_else(any).or_else(|| sides.iter().copied().max_by_key(|side| (of(*side), *side)))
}

/// The side of tables 5.12 to 5.14 if none is asked for: of all measured devices together, or of a published device.
pub fn usual(data: &Data, device: usize) -> u32 {
    representative(data, |f| !data.published || f.device == device).unwrap_or(PUBLISHED[0])
}
