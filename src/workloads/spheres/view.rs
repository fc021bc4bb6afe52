//! What a frame's renderers read in addition to the spheres: computed once on the host, in double precision, and
//! rounded once.

use crate::math::T_MAX;
use crate::workloads::size::Size;
use crate::workloads::spheres::scene::Scene;
use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};
use std::f64::consts::FRAC_PI_2;

/// Largest half side of the image on its plane, which is at distance 1 wherever that allows it: products of the
/// corner's components are single-precision numbers still.
const MAX_HALF_SIDE: f64 = 1e9;

/// `View` of `kernels/spheres/scene.wgsl`: 128 bytes. The constants are in it because the shader may have none in its
/// sums: Mesa reorders sums with literals.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct View {
    /// The camera's place.
    pub origin: Vec3,
    /// Least distance of a hit.
    pub epsilon: f32,
    /// From the camera to the image's upper left corner.
    pub corner: Vec3,
    /// Share of the light that a reflection keeps, before the surface's colour.
    pub intensity: f32,
    /// From one pixel to the next one in its row.
    pub right: Vec3,
    /// 0.5: the centre of a pixel.
    pub half: f32,
    /// From one row to the next one below.
    pub down: Vec3,
    /// 1.
    pub one: f32,
    /// Towards the light, of length 1.
    pub light: Vec3,
    /// 2.
    pub two: f32,
    /// The light's colour.
    pub light_color: Vec3,
    /// [`crate::math::T_MAX`]: beyond every hit.
    pub far: f32,
    /// The ambient light's colour.
    pub ambient: Vec3,
    /// Number of spheres.
    pub spheres: u32,
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Most rays along a path.
    pub trips: u32,
    /// Unused: 0.
    pub pad: u32,
}

impl View {
    /// Frame `frame` of `frames` over one period of the scene's orbit, as an image of `size` square pixels with at most
    /// `trips` rays along a path. Frames `frame` and `frame + frames` are the same bits.
    pub fn of(scene: &Scene, size: Size, trips: u32, frame: usize, frames: usize) -> View {
        let camera = &scene.camera;
        let (sine, cosine) = turn(frame, frames, camera.orbit_velocity);
        let turned = |v: DVec3| DVec3::new(v.x * cosine + v.z * sine, v.y, v.z * cosine - v.x * sine);
        let origin = camera.focus_point + turned(camera.position - camera.focus_point);
        let forward = unit(turned(unit(camera.forward)));
        // The cross product with +y, whose length is that of the horizontal part
        let right = DVec3::new(-forward.z, 0.0, forward.x) / libm::hypot(forward.x, forward.z);
        let up = right.cross(forward);
        let (width, height) = (f64::from(size.width), f64::from(size.height));
        let half_height = libm::tan(camera.fov.to_radians() * 0.5);
        let half_width = half_height * width / height;
        let shrink = 1.0 / (half_height.max(half_width) / MAX_HALF_SIDE).max(1.0);
        let (right, up) = (right * half_width, up * half_height);
        View {
            origin: origin.as_vec3(),
            epsilon: scene.rendering.epsilon,
            corner: ((forward - right + up) * shrink).as_vec3(),
            intensity: scene.rendering.intensity,
            right: (right * (2.0 / width) * shrink).as_vec3(),
            half: 0.5,
            down: (up * (-2.0 / height) * shrink).as_vec3(),
            one: 1.0,
            light: (-unit(scene.light.direction)).as_vec3(),
            two: 2.0,
            light_color: scene.light.color,
            far: T_MAX,
            ambient: scene.light.ambient,
            spheres: scene.spheres.len() as u32,
            width: size.width,
            height: size.height,
            trips,
            pad: 0,
        }
    }
}

/// Sine and cosine of the turn about +y at a frame. The quarter is found in whole numbers, so that quarter turns are
/// exact, and opposite frames are opposite.
fn turn(frame: usize, frames: usize, velocity: f64) -> (f64, f64) {
    if velocity == 0.0 || frames == 0 {
        return (0.0, 1.0);
    }
    let quarters = 4 * (frame % frames) as u128;
    let frames = frames as u128;
    let angle = FRAC_PI_2 * ((quarters % frames) as f64 / frames as f64);
    let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
    let (sine, cosine) = match quarters / frames {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    };
    (if velocity < 0.0 { -sine } else { sine }, cosine)
}

/// A vector of length 1, for a vector that is not zero; components may be as small as double precision has them.
fn unit(v: DVec3) -> DVec3 {
    let v = v / v.abs().max_element();
    v / v.dot(v).sqrt()
}
