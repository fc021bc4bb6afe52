//! No structure: all triangles in one run.

use super::{Brute, prims};
use crate::error::Result;
use crate::scene::Scene;

/// Lists all triangles that can be hit, in scene order.
pub fn build(scene: &Scene) -> Result<Brute> {
    let (prims, bounds) = prims::prims(scene)?;
    Ok(Brute { bounds, records: prims::records(scene, &prims) })
}
