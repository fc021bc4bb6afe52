//! Keys: how many bits tile and slice have, and where each of them is.

use super::setting::{ClusterSetting, KeyOrder, Unique};
use crate::error::{Error, Result};
use crate::workloads::size::Size;

/// Levels of nodes above the clusters; each takes five bits of a key, and the first what is left.
pub const LEVELS: u32 = 5;

/// Most bits of a key: five levels of 32 children.
pub const MAX_KEY_BITS: u32 = 25;

/// Fewest bits of a key: the source's 7 + 7 + 9.
pub const MIN_KEY_BITS: u32 = 23;

/// Bits of a word that tiles are sorted by, one less than it has: all ones are no sample.
const MAX_SORTED_BITS: u32 = 31;

/// Bits of the source's key for column, row and slice.
const USUAL: [u32; 3] = [7, 7, 9];

/// The keys of an image.
#[derive(Clone, Debug, PartialEq)]
pub struct KeyLayout {
    /// The image.
    pub size: Size,
    /// Side of a tile, in pixels.
    pub tile: u32,
    /// Tiles in a row; the last may be incomplete.
    pub columns: u32,
    /// Rows of tiles; the last may be incomplete.
    pub rows: u32,
    /// Slices of depth.
    pub slices: u32,
    /// Bits of column, row, slice and normal.
    pub bits: [u32; 4],
    order: KeyOrder,
    near: f32,
    /// Height of the image in tiles, not rounded.
    tiles_high: f64,
}

/// The ratio of the borders of a slice.
fn ratio(field_of_view: f32, tiles_high: f64) -> f64 {
    1.0 + 2.0 * (f64::from(field_of_view).to_radians() * 0.5).tan() / tiles_high
}

/// Bits of numbers below `count`.
fn bits_for(count: u32) -> u32 {
    count.max(1).next_power_of_two().trailing_zeros()
}

impl KeyLayout {
    /// The keys of an image of this size. `field_of_view` is the smallest of all frames, vertical, in degrees; depths
    /// are `near` to `far`.
    ///
    /// # Errors
    /// [`Error::Refused`] for keys of more than [`MAX_KEY_BITS`] bits, and for tiles to be sorted whose slices, normals
    /// and pixels are too many for one word.
    pub fn new(setting: &ClusterSetting, size: Size, field_of_view: f32, (near, far): (f32, f32)) -> Result<KeyLayout> {
        let tile = setting.tile;
        let (columns, rows) = (size.width.div_ceil(tile), size.height.div_ceil(tile));
        let tiles_high = f64::from(size.height) / f64::from(tile);
        let slices =
            ((f64::from(far) / f64::from(near)).ln() / ratio(field_of_view, tiles_high).ln()).floor() as u32 + 1;
        let normal = setting.normals.bits();
        let need = [columns, rows, slices].map(bits_for);
        let fits = normal == 0 && need.iter().zip(&USUAL).all(|(need, usual)| need <= usual);
        let [x, y, mut z] = if fits { USUAL } else { need };
        z += MIN_KEY_BITS.saturating_sub(x + y + z + normal);
        let bits = x + y + z + normal;
        if bits > MAX_KEY_BITS {
            let flags = 1_u64.checked_shl(bits + 2).unwrap_or(u64::MAX) >> 20;
            let problem = format!(
                "{x} bits for {columns} columns, {y} for {rows} rows, {z} for {slices} slices and {normal} for normals \
                 are {bits}, at most {MAX_KEY_BITS} are possible; their flags would take {flags} MiB",
            );
            return Err(Error::too_large("the key of a cluster", problem, "give a larger --tile or fewer --normals"));
        }
        let sorted = need[2] + normal + 2 * bits_for(tile);
        if setting.unique == Unique::Sort && sorted > MAX_SORTED_BITS {
            let problem = format!(
                "{} bits for {slices} slices, {normal} for normals and {} for the pixels of a tile are {sorted}, at most \
                 {MAX_SORTED_BITS} are possible",
                need[2],
                2 * bits_for(tile),
            );
            return Err(Error::too_large("a word to be sorted", problem, "use another --unique"));
        }
        let bits = [x, y, z, normal];
        Ok(KeyLayout { size, tile, columns, rows, slices, bits, order: setting.key, near, tiles_high })
    }

    /// The bits that differ between the keys of a tile: those of slices that exist, and of normals.
    pub fn within_tile(&self) -> u32 {
        self.encode(0, 0, (1 << bits_for(self.slices)) - 1, (1 << self.bits[3]) - 1)
    }

    /// Bits of a key, [`MIN_KEY_BITS`] to [`MAX_KEY_BITS`].
    pub fn key_bits(&self) -> u32 {
        self.bits.iter().sum()
    }

    /// Where each slice begins: depths for a camera with this vertical field of view in degrees. What is nearer is in
    /// the first slice, what is farther than all in the last.
    pub fn borders(&self, field_of_view: f32) -> Vec<f32> {
        let ratio = ratio(field_of_view, self.tiles_high);
        let border = |slice: u32| (f64::from(self.near) * ratio.powi(slice as i32)).min(f64::from(f32::MAX)) as f32;
        (0..self.slices).map(border).collect()
    }

    /// The bits of a key that a column, a row and a slice set, as tables: columns first, then rows, then slices.
    pub fn spread(&self) -> Vec<u32> {
        let columns = (0..self.columns).map(|column| self.encode(column, 0, 0, 0));
        let rows = (0..self.rows).map(|row| self.encode(0, row, 0, 0));
        let slices = (0..self.slices).map(|slice| self.encode(0, 0, slice, 0));
        columns.chain(rows).chain(slices).collect()
    }

    /// For each bit of a key, from the highest: whose bit it is (0 column, 1 row, 2 slice), and which one. Bits of
    /// normals, the lowest, are left out.
    fn places(&self) -> Vec<(usize, u32)> {
        let [x, y, z, _] = self.bits;
        let all = |of: usize, bits: u32| (0..bits).rev().map(move |bit| (of, bit));
        match self.order {
            KeyOrder::Concat => all(2, z).chain(all(0, x)).chain(all(1, y)).collect(),
            KeyOrder::Morton => {
                let of_bit = |bit: u32| [(2, z), (0, x), (1, y)].into_iter().filter(move |(_, bits)| bit < *bits);
                (0..x.max(y).max(z)).rev().flat_map(|bit| of_bit(bit).map(move |(of, _)| (of, bit))).collect()
            }
        }
    }

    /// The key of a column, a row, a slice and a normal's index.
    pub fn encode(&self, column: u32, row: u32, slice: u32, normal: u32) -> u32 {
        let parts = [column, row, slice];
        let position = self.places().iter().fold(0, |key, &(of, bit)| key << 1 | (parts[of] >> bit & 1));
        position << self.bits[3] | normal
    }

    /// Column, row, slice and normal's index of a key.
    pub fn decode(&self, key: u32) -> [u32; 4] {
        let mut parts = [0; 4];
        parts[3] = key & ((1 << self.bits[3]) - 1);
        for (from_top, &(of, bit)) in self.places().iter().enumerate() {
            parts[of] |= (key >> (self.key_bits() - 1 - from_top as u32) & 1) << bit;
        }
        parts
    }

    /// Nodes of a level, 0 to 4.
    pub fn level_nodes(&self, level: u32) -> u32 {
        if level == 0 { 1 } else { 1 << (self.key_bits() + 5 * level - MAX_KEY_BITS) }
    }

    /// Nodes of the levels above a level, 0 to 5: where its nodes begin.
    pub fn level_offset(&self, level: u32) -> u32 {
        (0..level).map(|above| self.level_nodes(above)).sum()
    }

    /// Nodes of all levels: 270,601 for keys of 23 bits.
    pub fn nodes(&self) -> u32 {
        self.level_offset(LEVELS)
    }

    /// The node of a level above a key, counted from the root.
    pub fn node_of(&self, key: u32, level: u32) -> u32 {
        self.level_offset(level) + (key >> (MAX_KEY_BITS - 5 * level))
    }

    /// Which child of its node of a level a key is below.
    pub fn child_of(key: u32, level: u32) -> u32 {
        key >> (MAX_KEY_BITS - 5 - 5 * level) & 31
    }
}

#[cfg(test)]
mod tests {
    use super::super::setting::Normals;
    use super::*;

    fn layout(setting: ClusterSetting, width: u32, height: u32, field_of_view: f32) -> Result<KeyLayout> {
        KeyLayout::new(&setting, Size { width, height }, field_of_view, (1.0, 1e4))
    }

    #[test]
    fn the_usual_key_is_the_sources() {
        let layout = layout(ClusterSetting::default(), 1920, 1080, 60.0).unwrap();
        assert_eq!((layout.columns, layout.rows, layout.slices), (60, 34, 274));
        assert_eq!((layout.bits, layout.key_bits(), layout.nodes()), ([7, 7, 9, 0], 23, 270_601));
        let offsets: Vec<u32> = (0..5).map(|level| layout.level_offset(level)).collect();
        assert_eq!(offsets, [0, 1, 9, 265, 8457]);
        // From the top: z8 z7, then z, x, y of bits 6 to 0
        assert_eq!(layout.encode(0, 0, 0x180, 0), 0b11 << 21);
        assert_eq!(layout.encode(0, 0, 0x40, 0), 1 << 20);
        assert_eq!(layout.encode(0x40, 0, 0, 0), 1 << 19);
        assert_eq!(layout.encode(0, 0x40, 0, 0), 1 << 18);
        assert_eq!(layout.encode(1, 1, 1, 0), 0b111);
    }

    #[test]
    fn widths_follow_from_the_image() {
        let of = |tile| ClusterSetting { tile, ..ClusterSetting::default() };
        assert_eq!(layout(of(16), 1920, 1080, 60.0).unwrap().bits, [7, 7, 10, 0]);
        assert_eq!(layout(of(8), 480, 270, 60.0).unwrap().slices, 274);
        let error = layout(of(8), 1920, 1080, 60.0).unwrap_err().to_string();
        assert!(error.contains("are 27") && error.contains("512 MiB"), "{error}");
        let cells = ClusterSetting { tile: 16, normals: Normals::Cells, ..ClusterSetting::default() };
        assert_eq!(layout(cells, 480, 270, 60.0).unwrap().key_bits(), 24);
    }
}
