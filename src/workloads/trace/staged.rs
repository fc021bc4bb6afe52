//! One frame in passes: all primary rays, then a pass for each reflection over a list of the paths that go on. Twin of
//! `kernels/trace/staged/primary.wgsl` and `bounce.wgsl`.

use crate::math::Ray;
use crate::workloads::trace::backend::{ByRayType, CountedPixel};
use crate::workloads::trace::count::Tally;
use crate::workloads::trace::path::{Frame, PRIMARY, Paths, REFLECTED};
use crate::workloads::trace::traverse::{GROUP, Lanes, Traverser, bits};
use glam::Vec3A;

/// A path that goes on in a mirror: its pixel, its next ray, and what it has gathered.
#[derive(Clone, Copy)]
pub struct Waiting<C> {
    /// Column and row.
    pub place: (u32, u32),
    ray: Ray,
    colour: Vec3A,
    weight: f32,
    first: (u32, f32),
    counters: ByRayType<C>,
}

impl<C: Tally> Waiting<C> {
    fn of(paths: &Paths<C>, lane: usize, place: (u32, u32)) -> Waiting<C> {
        Waiting {
            place,
            ray: paths.rays[lane],
            colour: paths.colour[lane],
            weight: paths.weight[lane],
            first: paths.first[lane],
            counters: std::array::from_fn(|kind| paths.counters[kind][lane]),
        }
    }
}

/// The first pass for the group whose top left pixel is `(column, row)`: hands each pixel inside the image to `store`
/// with its column and row, and appends the paths that go on to the list.
pub fn primary_group<C: Tally>(
    frame: &Frame,
    traversal: &dyn Traverser,
    (column, row): (u32, u32),
    list: &mut Vec<Waiting<C>>,
    mut store: impl FnMut(u32, u32, CountedPixel),
) {
    let inside = frame.inside((column, row));
    let mut paths = frame.start_paths::<C>((column, row), inside);
    frame.follow(traversal, PRIMARY, &mut paths);
    for lane in bits(inside) {
        let (x, y) = frame.places[lane];
        let place = (column + x, row + y);
        store(place.0, place.1, paths.pixel(lane));
        if frame.config.bounces() > 0 && paths.alive >> lane & 1 == 1 {
            list.push(Waiting::of(&paths, lane, place));
        }
    }
}

/// A further pass for up to 64 paths of a list: their pixels as they are now, and the paths that go on.
pub fn bounce_group<C: Tally>(
    frame: &Frame,
    traversal: &dyn Traverser,
    waiting: &[Waiting<C>],
) -> (Vec<CountedPixel>, Vec<Waiting<C>>) {
    fn lanes<C: Copy, T>(waiting: &[Waiting<C>], of: impl Fn(&Waiting<C>) -> T) -> Lanes<T> {
        std::array::from_fn(|lane| of(&waiting[lane.min(waiting.len() - 1)]))
    }
    let mut paths = Paths {
        rays: lanes(waiting, |path| path.ray),
        alive: if waiting.len() >= GROUP { u64::MAX } else { (1 << waiting.len()) - 1 },
        colour: lanes(waiting, |path| path.colour),
        weight: lanes(waiting, |path| path.weight),
        first: lanes(waiting, |path| path.first),
        counters: std::array::from_fn(|kind| lanes(waiting, |path| path.counters[kind])),
    };
    frame.follow(traversal, REFLECTED, &mut paths);
    let pixels = (0..waiting.len()).map(|lane| paths.pixel(lane)).collect();
    let next = bits(paths.alive).map(|lane| Waiting::of(&paths, lane, waiting[lane].place)).collect();
    (pixels, next)
}
