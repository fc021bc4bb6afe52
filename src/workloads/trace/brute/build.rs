//! No structure: all triangles in one run.

use crate::error::Result;
use crate::scene::Scene;
use crate::workloads::trace::brute::Brute;
use crate::workloads::trace::common::prims;

/// Lists all triangles that can be hit, in scene order.
pub fn build(scene: &Scene) -> Result<Brute> {
    let (prims, bounds) = prims::prims(scene)?;
    Ok(Brute { bounds, triangle_refs: prims::triangle_refs(scene, &prims) })
}
