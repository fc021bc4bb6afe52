//! Photons on their way to clusters and samples: lists of photons, sums by direction, and the estimates from both.

pub mod setting;

/// The photons of each cluster.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lists {
    /// Where the list of each cluster begins; one more for the end of the last.
    pub offsets: Vec<u32>,
    /// Indices of photons, cluster by cluster.
    pub entries: Vec<u32>,
}

/// Directions of a bucket: six faces of a cube with 3 x 3 cells each.
pub const DIRECTIONS: usize = 54;

/// Radiant flux by direction.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Buckets {
    /// What a word counts as flux: flux = word / scale. 0 where words are floats.
    pub scale: f32,
    /// Three words (red, green, blue) for each of the directions of each cluster: whole numbers, or the bits of floats.
    pub words: Vec<u32>,
}
