//! Clusters of a device as those of the CPU, to be checked.

use super::{ClusterBuffers, ClusterCount};
use crate::device::VulkanDevice;
use crate::error::Result;
use crate::workloads::splat::clusters::setting::{ClusterSetting, HierarchyBy};
use crate::workloads::splat::clusters::{Bounds, Clusters, KeyLayout, Nodes};

/// Reads back the clusters of the last frame; an image has so many pixels. Nodes without children have
/// [`Bounds::EMPTY`].
///
/// # Errors
/// The device's.
pub fn read(
    device: &VulkanDevice,
    buffers: &ClusterBuffers,
    count: &ClusterCount,
    layout: &KeyLayout,
    setting: &ClusterSetting,
    pixels: usize,
) -> Result<Clusters> {
    let state: Vec<u32> = device.read(&count.state, 1)?;
    let most = buffers.cluster_keys.bytes() / 4;
    let clusters = state.first().map_or(0, |&clusters| u64::from(clusters).min(most)) as usize;
    let nodes = match setting.hierarchy {
        HierarchyBy::None => None,
        HierarchyBy::Masks => {
            let masks: Vec<u32> = device.read(&buffers.masks, layout.nodes() as usize)?;
            let words: Vec<[u32; 6]> = device.read(&buffers.node_boxes, layout.nodes() as usize)?;
            let of = |(&mask, words)| if mask == 0 { Bounds::EMPTY } else { Bounds::of_words(words) };
            let boxes = masks.iter().zip(words).map(of).collect();
            Some(Nodes { masks, boxes })
        }
    };
    // Nothing cannot be read
    let mut boxes: Vec<[u32; 6]> = device.read(&buffers.boxes, clusters.max(1))?;
    let mut cluster_keys: Vec<u32> = device.read(&buffers.cluster_keys, clusters.max(1))?;
    boxes.truncate(clusters);
    cluster_keys.truncate(clusters);
    Ok(Clusters {
        positions: device.read(&buffers.positions, pixels)?,
        keys: device.read(&buffers.keys, pixels)?,
        identifiers: device.read(&buffers.identifiers, pixels)?,
        cluster_keys,
        boxes: boxes.into_iter().map(Bounds::of_words).collect(),
        nodes,
    })
}
