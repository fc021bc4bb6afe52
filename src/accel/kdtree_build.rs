//! kd-tree builder (SPEC section 3).

use super::kdtree::{KdNode, KdTree};
use super::prims;
use super::sah::CostModel;
use crate::error::Result;
use crate::scene::Scene;

/// No tree is deeper than this, whatever is set.
pub const MAX_DEPTH: u32 = 60;

/// What can be set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Config {
    /// Bins per axis in the upper levels.
    pub bins: usize,
    /// Nodes with fewer triangles are split by the exact sweep.
    pub exact_below: usize,
    /// `K_t` and `K_i`.
    pub cost: CostModel,
    /// Greatest depth; `None` is `8 + 1.3 log2(triangles)`.
    pub max_depth: Option<u32>,
}

impl Default for Config {
    /// What explains the published trees best.
    fn default() -> Self {
        Config { bins: 32, exact_below: 512, cost: CostModel::default(), max_depth: None }
    }
}

/// Builds a kd-tree over all triangles that can be hit.
pub fn build(scene: &Scene, _config: &Config) -> Result<KdTree> {
    let prims = prims::prims(scene)?;
    let bounds = prims::bounds(&prims);
    let records = prims::records(scene, &prims);
    Ok(KdTree { bounds, nodes: vec![KdNode::leaf(0, records.len() as u32)], records, depth: 0 })
}
