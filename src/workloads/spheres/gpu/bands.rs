//! Frames split into parts: no dispatch exceeds the device's number of work-groups, nor a number of tests that every
//! device finishes before a watchdog looks.

use super::kernels::GROUP_SIDE;
use crate::workloads::size::Size;
use crate::workloads::spheres::view::View;
use bytemuck::{Pod, Zeroable};

/// Most ray/sphere tests of a dispatch. A device that does 10^11 tests per second takes a tenth of a second for them;
/// lavapipe, which has no watchdog, takes about fifteen seconds (6 * 10^8 per second on two threads).
pub const MAX_TESTS: u64 = 1 << 33;

/// `Band` of `kernels/spheres/scene.wgsl`: a part of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct BandUniform {
    /// The frame.
    pub view: View,
    /// First pixel of the part's rows.
    pub first_column: u32,
    /// First row of the part.
    pub first_row: u32,
    /// Pixels per row of the part.
    pub columns: u32,
    /// Rows of the part.
    pub rows: u32,
}

/// A part of an image, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Tile {
    pub column: u32,
    pub row: u32,
    pub columns: u32,
    pub rows: u32,
}

impl Tile {
    /// This part of a frame.
    pub fn of(&self, view: &View) -> BandUniform {
        let &Tile { column, row, columns, rows } = self;
        BandUniform { view: *view, first_column: column, first_row: row, columns, rows }
    }

    /// Work-groups along both axes.
    pub fn groups(&self) -> (u32, u32) {
        (self.columns.div_ceil(GROUP_SIDE), self.rows.div_ceil(GROUP_SIDE))
    }
}

/// The parts of an image whose pixels take up to `tests` ray/sphere tests each, on a device with at most `max_groups`
/// work-groups in each dimension. All rows where that is possible; a part has whole work-groups.
pub(super) fn tiles(size: Size, tests: u64, max_groups: u32) -> Vec<Tile> {
    let pixels = MAX_TESTS / tests.max(1);
    let most = max_groups.saturating_mul(GROUP_SIDE);
    // So many along one axis if there are `across` along the other
    let side = |across: u32| {
        let whole = u32::try_from(pixels / u64::from(across)).unwrap_or(u32::MAX) / GROUP_SIDE * GROUP_SIDE;
        whole.clamp(GROUP_SIDE, most)
    };
    let columns = size.width.min(side(GROUP_SIDE));
    let rows = size.height.min(side(columns));
    let mut tiles = Vec::new();
    for row in (0..size.height).step_by(rows as usize) {
        for column in (0..size.width).step_by(columns as usize) {
            let (columns, rows) = (columns.min(size.width - column), rows.min(size.height - row));
            tiles.push(Tile { column, row, columns, rows });
        }
    }
    tiles
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_cover_the_image_once_and_keep_the_limits() {
        for (width, height) in [(1, 1), (509, 3), (1920, 1080), (67_108_864, 1), (1, 67_108_864)] {
            for tests in [1, 500, 64 * 100_000] {
                let tiles = tiles(Size { width, height }, tests, 65_535);
                let covered: u64 = tiles.iter().map(|t| u64::from(t.columns) * u64::from(t.rows)).sum();
                assert_eq!(covered, u64::from(width) * u64::from(height));
                for tile in &tiles {
                    let (x, y) = tile.groups();
                    assert!(x <= 65_535 && y <= 65_535 && tile.columns > 0 && tile.rows > 0, "{tile:?}");
                    assert!(u64::from(tile.columns) * u64::from(tile.rows) * tests <= MAX_TESTS, "{tile:?} {tests}");
                    assert!(tile.column % GROUP_SIDE == 0 && tile.row % GROUP_SIDE == 0);
                }
            }
        }
        assert_eq!(tiles(Size { width: 640, height: 360 }, 500, 65_535).len(), 1);
    }
}
