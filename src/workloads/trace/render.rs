//! One frame, work-group by work-group. Twin of `kernels/trace/render.wgsl`.

use crate::workloads::trace::backend::CountedPixel;
use crate::workloads::trace::count::Count;
use crate::workloads::trace::path::{Frame, PRIMARY, REFLECTED};
use crate::workloads::trace::traverse::{Traverser, bits};

/// Renders the group whose top left pixel is `(column, row)` and hands each pixel inside the image to `store` with its
/// column and row.
pub fn render_group<C: Count>(
    frame: &Frame,
    traversal: &dyn Traverser,
    (column, row): (u32, u32),
    mut store: impl FnMut(u32, u32, CountedPixel),
) {
    let inside = frame.inside((column, row));
    let mut paths = frame.start_paths::<C>((column, row), inside);
    for bounce in 0..=frame.config.bounces() {
        let kind = if bounce == 0 { PRIMARY } else { REFLECTED };
        if paths.alive == 0 || !frame.follow(traversal, kind, &mut paths) {
            break;
        }
    }
    for lane in bits(inside) {
        let (x, y) = frame.places[lane];
        store(column + x, row + y, paths.pixel(lane));
    }
}
