//! The buffers of clusters.

use crate::device::VulkanDevice;
use crate::device::vulkan::Buffer;
use crate::error::Result;
use crate::workloads::splat::clusters::KeyLayout;
use crate::workloads::splat::clusters::setting::ClusterSetting;
use crate::workloads::splat::clusters::setting::{HierarchyBy, Unique};
use crate::workloads::splat::gpu::buffers::{PIXELS, buffers};

/// Bytes of a box: six words, the smallest and the largest coordinates as words that are ordered as the floats are.
pub const BOX_BYTES: u64 = 24;

/// How many elements the buffers have.
#[derive(Clone, Debug, PartialEq)]
pub struct ClusterSizes {
    /// Pixels.
    pub pixels: u32,
    /// Tiles.
    pub tiles: u32,
    /// Bits of a key.
    pub key_bits: u32,
    /// Nodes of all levels, 0 without a hierarchy.
    pub nodes: u32,
    /// Words of masks: those of all levels, where keys are bits or there is a hierarchy.
    pub masks: u32,
    /// How the set of keys is found.
    pub unique: Unique,
}

impl ClusterSizes {
    /// The sizes for an image.
    pub fn new(setting: &ClusterSetting, layout: &KeyLayout, pixels: u32) -> ClusterSizes {
        let has_nodes = setting.hierarchy == HierarchyBy::Masks;
        ClusterSizes {
            pixels,
            tiles: layout.columns * layout.rows,
            key_bits: layout.key_bits(),
            nodes: if has_nodes { layout.nodes() } else { 0 },
            masks: if has_nodes || setting.unique == Unique::Bits { layout.nodes() } else { 0 },
            unique: setting.unique,
        }
    }

    /// Clusters at most: one for each pixel, and one for each key.
    pub fn clusters(&self) -> u32 {
        self.pixels.min(1 << self.key_bits)
    }

    /// Words that tell a key's identifier: one for each key, or for each word of bits.
    fn places(&self) -> u64 {
        match self.unique {
            Unique::Flags | Unique::Sort => 1 << self.key_bits,
            Unique::Bits => 1 << (self.key_bits - 5),
        }
    }
}

const KEYS: &str = "give a larger --tile, or --unique bits";

buffers! {
    /// The buffers of clusters.
    ClusterBuffers of ClusterSizes;
    /// Holds the axes of the boxes: x, y, z, then their origin with the margin as `w`.
    placement, "axes of boxes": |_: &ClusterSizes| 64, PIXELS;
    /// Holds positions of samples along these axes, `w` is the depth.
    positions, "positions of samples along the axes": |sizes: &ClusterSizes| u64::from(sizes.pixels) * 16, PIXELS;
    /// Holds the key of each pixel.
    keys, "keys": |sizes: &ClusterSizes| u64::from(sizes.pixels) * 4, PIXELS;
    /// Holds the cluster of each pixel.
    identifiers, "identifiers": |sizes: &ClusterSizes| u64::from(sizes.pixels) * 4, PIXELS;
    /// Tells identifiers by key: for each key with a cluster its identifier, or with bits for each word of bits the
    /// clusters before it.
    places, "identifiers by key": |sizes: &ClusterSizes| sizes.places() * 4, KEYS;
    /// Holds, where tiles are sorted, the number of clusters of each tile, then how many there are before it.
    tiles, "clusters of tiles": |sizes: &ClusterSizes| if sizes.unique == Unique::Sort { u64::from(sizes.tiles) * 4 } else { 0 }, PIXELS;
    /// Holds the key of each cluster.
    cluster_keys, "keys of clusters": |sizes: &ClusterSizes| u64::from(sizes.clusters()) * 4, PIXELS;
    /// Holds the box of each cluster.
    boxes, "boxes of clusters": |sizes: &ClusterSizes| u64::from(sizes.clusters()) * BOX_BYTES, PIXELS;
    /// Holds the children of nodes, level by level from the root. The last level is the bits of keys.
    masks, "masks of nodes": |sizes: &ClusterSizes| u64::from(sizes.masks) * 4, KEYS;
    /// Holds the boxes of nodes.
    node_boxes, "boxes of nodes": |sizes: &ClusterSizes| u64::from(sizes.nodes) * BOX_BYTES, KEYS;
}
