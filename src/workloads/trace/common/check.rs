//! Validates any structure, completely: what every builder x every degenerate scene is tested with.
//!
//! A check trusts nothing in the structure: no link is followed before it is known to lie inside its array, and no node
//! is visited twice.

use crate::math::Aabb;
use crate::scene::Scene;
use crate::workloads::trace::TriangleRef;
use crate::workloads::trace::common::prims;
use glam::DVec3;

/// What a check finds: the first broken invariant, in words.
pub type Verdict = Result<(), String>;

/// Returns the message if the condition does not hold.
macro_rules! ensure {
    ($condition:expr, $($message:tt)+) => {
        let holds: bool = $condition;
        if !holds {
            return Err(format!($($message)+));
        }
    };
}
pub(crate) use ensure;

/// Checks the bounds and the triangle references that every structure has.
pub(crate) fn common(bounds: Aabb, triangle_refs: &[TriangleRef], expected: &Expected) -> Verdict {
    ensure!(same(bounds, expected.bounds), "bounds are {bounds:?}, the triangles' are {:?}", expected.bounds);
    for (i, triangle_ref) in triangle_refs.iter().enumerate() {
        expected.check_triangle_ref(i, triangle_ref)?;
    }
    Ok(())
}

/// What the scene demands.
pub struct Expected<'a> {
    scene: &'a Scene,
    /// Triangles that must be found, ascending.
    pub(crate) hittable: Vec<u32>,
    /// Box of every triangle; [`Aabb::EMPTY`] for those that are left out.
    pub(crate) boxes: Vec<Aabb>,
    pub(crate) bounds: Aabb,
}

impl<'a> Expected<'a> {
    pub(crate) fn new(scene: &'a Scene) -> Expected<'a> {
        let count = scene.triangles.len() as u32;
        let boxes: Vec<Aabb> =
            (0..count).map(|i| prims::prim(scene, i).map_or(Aabb::EMPTY, |prim| prim.aabb())).collect();
        let hittable = (0..count).filter(|&i| !boxes[i as usize].is_empty()).collect();
        let bounds = boxes.iter().fold(Aabb::EMPTY, |all, &b| all.union(b));
        Expected { scene, hittable, boxes, bounds }
    }

    pub(crate) fn aabb(&self, triangle: u32) -> Aabb {
        self.boxes[triangle as usize]
    }

    /// Corners of a triangle.
    pub(crate) fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.scene.corners(triangle).map(|corner| corner.as_dvec3())
    }

    fn check_triangle_ref(&self, index: usize, triangle_ref: &TriangleRef) -> Verdict {
        let Some(triangle) = self.scene.triangles.get(triangle_ref.triangle as usize) else {
            return Err(format!(
                "triangle reference {index} names triangle {}, which does not exist",
                triangle_ref.triangle
            ));
        };
        ensure!(
            triangle_ref.vertices == triangle.vertices,
            "triangle reference {index} of triangle {} has vertices {:?} instead of {:?}",
            triangle_ref.triangle,
            triangle_ref.vertices,
            triangle.vertices
        );
        ensure!(
            !self.aabb(triangle_ref.triangle).is_empty(),
            "triangle reference {index} is of a triangle that is not finite"
        );
        Ok(())
    }
}

/// Equal boxes; all empty boxes are equal.
pub(crate) fn same(a: Aabb, b: Aabb) -> bool {
    a == b || (a.is_empty() && b.is_empty())
}
