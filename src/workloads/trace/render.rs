//! One frame, work-group by work-group. Twin of `kernels/trace/render.wgsl`.

use crate::workloads::trace::backend::CountedPixel;
use crate::workloads::trace::count::Tally;
use crate::workloads::trace::path::{Frame, PRIMARY};
use crate::workloads::trace::secondary::shade_primary;
use crate::workloads::trace::traverse::{Traverser, bits};

/// Renders the group whose top left pixel is `corner`, column and row, and hands each pixel inside the image to `store`
/// with its column and row.
pub fn render_group<C: Tally>(
    frame: &Frame,
    traversal: &dyn Traverser,
    corner: (u32, u32),
    store: impl FnMut(u32, u32, CountedPixel),
) {
    let mut paths = frame.start_paths::<C>(corner, frame.inside(corner));
    bits(paths.alive).for_each(|lane| paths.counters[PRIMARY][lane].ray());
    let triangle_refs = traversal.primary_hits(&paths.rays, paths.alive, &mut paths.counters[PRIMARY]);
    shade_primary(frame, traversal, corner, &mut paths, &triangle_refs);
    frame.store(&paths, corner, store);
}
