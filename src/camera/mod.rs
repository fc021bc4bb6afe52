//! Cameras, and the paths they (or the light) travel: files in `camera-paths/`, see the README there.

mod file;
mod orbit;
mod path;
mod recorded;
mod walk;

use crate::scene::Light;
use glam::Vec3;
pub use path::{CameraPath, descriptions, names};
pub use recorded::{to_csv, to_placed_csv, to_placed_toml, to_toml};

/// A pinhole camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Eye.
    pub position: Vec3,
    /// Unit vector to the image's middle.
    pub direction: Vec3,
    /// Roughly up; not parallel to `direction`.
    pub up: Vec3,
    /// Vertical field of view in degrees, between 0 and 180.
    pub field_of_view: f32,
}

/// What one frame shows: a camera and the lights at that moment.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// The camera.
    pub camera: Camera,
    /// All lights of this frame.
    pub lights: Vec<Light>,
}

/// The four vectors that ray generation needs: `direction = normalize(corner + right * (x + 0.5) + down * (y + 0.5))`
/// for pixel `(x, y)` counted from the top left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelGrid {
    /// Eye.
    pub origin: Vec3,
    /// From the eye to the image plane's top left corner.
    pub corner: Vec3,
    /// One pixel to the right.
    pub right: Vec3,
    /// One pixel down.
    pub down: Vec3,
}

impl Camera {
    /// Rays for an image of `width` x `height` square pixels.
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
