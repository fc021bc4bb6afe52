//! Cameras, and the paths of cameras and lights. `camera-paths/README.md` describes the files.

mod file;
mod keyframes;
mod orbit;
mod path;
mod recorded;

use crate::scene::Light;
use glam::Vec3;
pub(crate) use path::descriptions;
pub use path::{CameraPath, names};
pub use recorded::{to_csv, to_toml};
pub(crate) use recorded::{to_placed_csv, to_placed_toml};

/// A pinhole camera, in the scene's coordinates in memory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The centre of projection.
    pub position: Vec3,
    /// Unit vector to the centre of the image.
    pub direction: Vec3,
    /// The up vector; need not be perpendicular to `direction`, but must not be parallel to it.
    pub up: Vec3,
    /// Vertical field of view in degrees, between 0 and 180.
    pub field_of_view: f32,
}

/// The camera and the lights of one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// The camera of this frame.
    pub camera: Camera,
    /// All lights of this frame; they replace the scene's.
    pub lights: Vec<Light>,
}

/// The four vectors that ray generation needs: `direction = normalize(corner + right * (x + 0.5) + down * (y + 0.5))`
/// for pixel `(x, y)` counted from the top left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelGrid {
    /// The origin of all primary rays.
    pub origin: Vec3,
    /// The vector from the origin to the top left corner of the image plane.
    pub corner: Vec3,
    /// The vector from a pixel to its right neighbour on the image plane.
    pub right: Vec3,
    /// The vector from a pixel to the one below it on the image plane.
    pub down: Vec3,
}

impl Camera {
    /// The pixel grid of an image of `width` x `height` square pixels.
    pub fn pixel_grid(&self, width: u32, height: u32) -> PixelGrid {
        let right = self.direction.cross(self.up).normalize();
        let up = right.cross(self.direction).normalize();
        let half_height = (self.field_of_view.to_radians() * 0.5).tan();
        let half_width = half_height * width as f32 / height as f32;
        PixelGrid {
            origin: self.position,
            corner: self.direction - right * half_width + up * half_height,
            right: right * (2.0 * half_width / width as f32),
            down: up * (-2.0 * half_height / height as f32),
        }
    }
}
