//! Clusters of view samples and the hierarchy above them.
//!
//! A sample's tile and depth make its key; samples with equal keys are a cluster. Clusters have identifiers from 0, a
//! box each, and stand below five levels of nodes.

pub mod layout;
pub mod placement;
pub mod setting;

pub use layout::KeyLayout;
pub use placement::Placement;

use glam::{Vec3, Vec4};

/// The key and the identifier of a pixel without a sample.
pub const NONE: u32 = u32::MAX;

/// An axis-aligned box, with its surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest coordinates.
    pub min: Vec3,
    /// Largest coordinates.
    pub max: Vec3,
}

impl Bounds {
    /// Contains nothing; its union with a box is that box.
    pub const EMPTY: Bounds = Bounds { min: Vec3::splat(f32::INFINITY), max: Vec3::splat(f32::NEG_INFINITY) };
}

/// The nodes above the clusters: all levels, from the root down, each with every node that there can be.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Nodes {
    /// Bit c is set if child c exists.
    pub masks: Vec<u32>,
    /// The union of the children's boxes; [`Bounds::EMPTY`] where there is none.
    pub boxes: Vec<Bounds>,
}

/// The clusters of a view.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Clusters {
    /// Position of each pixel's sample along the axes of the boxes; `w` is the depth, 0 without a sample.
    pub positions: Vec<Vec4>,
    /// Key of each pixel's sample, or [`NONE`].
    pub keys: Vec<u32>,
    /// Cluster of each pixel's sample, or [`NONE`].
    pub identifiers: Vec<u32>,
    /// Key of each cluster.
    pub cluster_keys: Vec<u32>,
    /// Box of each cluster.
    pub boxes: Vec<Bounds>,
    /// Absent with [`setting::HierarchyBy::None`].
    pub nodes: Option<Nodes>,
}
