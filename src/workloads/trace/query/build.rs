//! Sorts triangles for a driver's builder.

use crate::error::Result;
use crate::scene::Scene;
use crate::workloads::trace::bvh;
use crate::workloads::trace::query::SortedTriangles;

/// All triangles that can be hit, in the order of the leaves of a BVH. Lavapipe 25.0 cuts the list into equal parts as
/// it is: with the order of a file a ray took 80 times as long.
///
/// # Errors
/// Those of [`bvh::build::build`].
pub fn build(scene: &Scene) -> Result<SortedTriangles> {
    let bvh = bvh::build::build(scene, &bvh::build::Config::default())?;
    Ok(SortedTriangles { bounds: bvh.bounds, triangle_refs: bvh.triangle_refs })
}
