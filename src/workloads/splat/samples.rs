//! View samples: what the camera sees, one for each pixel. Twin of `kernels/splat/samples.wgsl`.

use super::camera;
use super::lit::LitScene;
use super::surface::{Surface, surface_at};
use crate::camera::Camera;
use crate::error::Result;
use crate::math::Hit;
use crate::workloads::size::Size;
use crate::workloads::trace::backend::{Prepared, TraceRay};
use glam::{Vec3A, Vec4};
use rayon::prelude::*;

/// The samples of an image, rows from the top. All arrays have an element for each pixel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Samples {
    /// Position, lifted off the surface by the epsilon; `w` is the depth along the view, above 0, and 0 where the
    /// camera's ray hits nothing. Such a pixel has zeros in all arrays.
    pub positions: Vec<Vec4>,
    /// Unit normal of the triangle, facing the camera; `w` is 0.
    pub normals: Vec<Vec4>,
    /// Albedo per channel, 0 to 1; `w` is 0.
    pub albedos: Vec<Vec4>,
}

/// The camera's rays and what they hit, an element for each pixel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Seen {
    /// See [`super::camera::rays`].
    pub rays: Vec<TraceRay>,
    /// Nearest hits.
    pub hits: Vec<Hit>,
}

/// Casts the camera's rays.
///
/// # Errors
/// The device's.
pub fn see(caster: &mut dyn Prepared, camera: &Camera, size: Size) -> Result<Seen> {
    let rays = camera::rays(camera, size);
    let hits = caster.cast(&rays, None)?;
    Ok(Seen { rays, hits })
}

/// Samples of what is seen.
pub fn of(lit: &LitScene, camera: &Camera, seen: &Seen) -> Samples {
    let (epsilon, forward) = (lit.epsilon(), Vec3A::from(camera.direction));
    let sample = |(ray, &hit): (&TraceRay, &Hit)| match surface_at(&lit.scene, ray, hit, epsilon) {
        Some(Surface { point, normal, albedo }) => {
            let depth = hit.t * Vec3A::from(ray.direction).dot(forward);
            [point.extend(depth), normal.extend(0.0), albedo.extend(0.0)]
        }
        None => [Vec4::ZERO; 3],
    };
    let all: Vec<[Vec4; 3]> = seen.rays.par_iter().zip(&seen.hits).map(sample).collect();
    let [positions, normals, albedos] = [0, 1, 2].map(|array| all.iter().map(|sample| sample[array]).collect());
    Samples { positions, normals, albedos }
}

/// Casts the camera's rays and makes samples of what they hit.
///
/// # Errors
/// The device's.
pub fn collect(caster: &mut dyn Prepared, lit: &LitScene, camera: &Camera, size: Size) -> Result<Samples> {
    let seen = see(caster, camera, size)?;
    Ok(of(lit, camera, &seen))
}
