//! View samples: what the camera sees, one for each pixel.

use glam::Vec4;

/// The samples of an image, rows from the top. All arrays have an element for each pixel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Samples {
    /// Position, lifted off the surface by the epsilon; `w` is the depth along the view, above 0, and 0 where the camera's
    /// ray hits nothing. Such a pixel has zeros in all arrays.
    pub positions: Vec<Vec4>,
    /// Unit normal of the triangle, facing the camera; `w` is 0.
    pub normals: Vec<Vec4>,
    /// Albedo per channel, 0 to 1; `w` is 0.
    pub albedos: Vec<Vec4>,
}
