//! Clusters of view samples and the hierarchy above them.
//!
//! A sample's tile and depth make its key; samples with equal keys are a cluster. Clusters have identifiers from 0, a
//! box each, and are below five levels of nodes.

pub mod bounds;
pub mod hierarchy;
pub mod keys;
pub mod layout;
mod lookup;
pub mod placement;
pub mod setting;
pub mod unique;
pub mod verify;

pub use layout::KeyLayout;
pub use lookup::Lookup;
pub use placement::Placement;

use super::samples::Samples;
use glam::{Vec3, Vec4};
use layout::LEVELS;
use rayon::ThreadPool;
use setting::{ClusterSetting, HierarchyBy};

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

/// Puts the samples of a view into clusters. `field_of_view` is the camera's, in degrees; the threads are those of
/// `pool`.
pub fn build(
    pool: &ThreadPool,
    setting: &ClusterSetting,
    layout: &KeyLayout,
    placement: &Placement,
    field_of_view: f32,
    samples: &Samples,
) -> Clusters {
    let borders = layout.borders(field_of_view);
    let (positions, keys) = pool.install(|| keys::of(setting.normals, layout, placement, &borders, samples));
    let unique::Numbered { identifiers, cluster_keys } = pool.install(|| unique::number(setting.unique, layout, &keys));
    let boxes = bounds::boxes(cluster_keys.len(), &positions, &identifiers);
    let nodes = match setting.hierarchy {
        HierarchyBy::Masks => Some(hierarchy::nodes(layout, &cluster_keys, &boxes)),
        HierarchyBy::None => None,
    };
    Clusters { positions, keys, identifiers, cluster_keys, boxes, nodes }
}

impl Clusters {
    /// The number of clusters.
    pub fn len(&self) -> usize {
        self.cluster_keys.len()
    }

    /// True for a view of nothing.
    pub fn is_empty(&self) -> bool {
        self.cluster_keys.is_empty()
    }

    /// Clusters by key.
    pub fn lookup(&self) -> Lookup {
        Lookup::new(&self.cluster_keys)
    }

    /// The number of samples of each cluster.
    pub fn samples(&self) -> Vec<u32> {
        let mut samples = vec![0; self.len()];
        for &identifier in &self.identifiers {
            if let Some(count) = samples.get_mut(identifier as usize) {
                *count += 1;
            }
        }
        samples
    }
}

impl Nodes {
    /// The number of nodes with children, level by level from the root.
    pub fn of_levels(&self, layout: &KeyLayout) -> [u32; LEVELS as usize] {
        std::array::from_fn(|level| {
            let (first, nodes) = (layout.level_offset(level as u32), layout.level_nodes(level as u32));
            let masks = self.masks.iter().skip(first as usize).take(nodes as usize);
            masks.filter(|mask| **mask != 0).count() as u32
        })
    }
}
