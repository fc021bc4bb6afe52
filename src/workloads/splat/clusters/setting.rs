//! How samples are put into clusters.

/// Order of the bits of a key.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum KeyOrder {
    /// Interleaved, the depth's bit before the column's before the row's: near keys are near in space.
    #[default]
    Morton,
    /// Depth, column, row, one after another.
    Concat,
}

/// Whether samples of one tile and slice are told apart by their normals.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Normals {
    /// They are not.
    #[default]
    Off,
    /// By the face of a cube that the normal points through: 3 bits.
    Faces,
    /// By the face and its cell of 3 x 3: 6 bits.
    Cells,
}

impl Normals {
    /// Bits of a key.
    pub fn bits(self) -> u32 {
        match self {
            Normals::Off => 0,
            Normals::Faces => 3,
            Normals::Cells => 6,
        }
    }
}

/// How the set of keys is found. All ways find the same set.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Unique {
    /// A flag for each possible key, and their prefix sum: the source's.
    #[default]
    Flags,
    /// The keys of each tile are sorted, and their changes counted. Clusters are numbered tile by tile.
    Sort,
    /// A bit for each possible key, and the prefix sum of the words' numbers of bits.
    Bits,
}

/// How boxes of clusters are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum BoundsBy {
    /// Six atomic operations a sample.
    #[default]
    Direct,
    /// In the work-group memory of each tile first: the source's, which does not say how.
    TwoStep,
}

/// What photons find clusters by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum HierarchyBy {
    /// Five levels of nodes with up to 32 children.
    #[default]
    Masks,
    /// Every photon is tested against every cluster.
    None,
}

/// The frame of reference that boxes are aligned to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Space {
    /// The camera's axes: boxes are tighter.
    #[default]
    View,
    /// The scene's axes.
    World,
}

/// Everything that decides the clusters of a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ClusterSetting {
    /// Side of a tile in pixels, [`MIN_TILE`] to [`MAX_TILE`].
    pub tile: u32,
    /// Of keys.
    pub key: KeyOrder,
    /// In keys.
    pub normals: Normals,
    /// Of keys.
    pub unique: Unique,
    /// Of clusters.
    pub bounds: BoundsBy,
    /// Above clusters.
    pub hierarchy: HierarchyBy,
    /// Of boxes.
    pub space: Space,
}

/// Smallest side of a tile.
pub const MIN_TILE: u32 = 4;

/// Largest side of a tile.
pub const MAX_TILE: u32 = 64;

impl Default for ClusterSetting {
    fn default() -> ClusterSetting {
        ClusterSetting {
            tile: 32,
            key: KeyOrder::default(),
            normals: Normals::default(),
            unique: Unique::default(),
            bounds: BoundsBy::default(),
            hierarchy: HierarchyBy::default(),
            space: Space::default(),
        }
    }
}
