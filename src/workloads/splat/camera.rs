//! Rays from the camera. Twin of `kernels/splat/camera.wgsl`.

use crate::camera::Camera;
use crate::workloads::size::Size;
use crate::workloads::trace::given::TraceRay;
use crate::workloads::trace::shade::normalize3;
use glam::Vec3A;
use rayon::prelude::*;

/// The ray through the centre of each pixel, with unit direction; rows from the top.
pub fn rays(camera: &Camera, size: Size) -> Vec<TraceRay> {
    let grid = camera.pixel_grid(size.width, size.height);
    let [corner, right, down] = [grid.corner, grid.right, grid.down].map(Vec3A::from);
    let ray = |pixel: usize| {
        let (x, y) = (pixel as u32 % size.width, pixel as u32 / size.width);
        let direction = normalize3(corner + right * (x as f32 + 0.5) + down * (y as f32 + 0.5));
        TraceRay::new(grid.origin, direction.into())
    };
    (0..size.pixels()).into_par_iter().map(ray).collect()
}
