//! The layout of a cache file.

use crate::math::Vertex;
use crate::scene::{Light, MAX_ELEMENTS, Material, Pose, Triangle};
use bytemuck::{Pod, Zeroable};
use glam::Vec3;

/// Version of the layout; raised whenever the layout changes.
pub const FORMAT: u32 = 5;

/// The first bytes of a cache.
pub const MAGIC: [u8; 8] = *b"RTBSCENE";

/// A hash of the readers' source code, computed by `build/main.rs`.
const READERS: &str = env!("RTBENCH_READERS");

/// The largest size of the JSON part in bytes.
const MAX_TEXT: u64 = 1 << 24;

/// The header of a cache, at offset 0 of the file.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub struct Header {
    /// Always [`MAGIC`].
    pub magic: [u8; 8],
    /// Always [`FORMAT`].
    pub format: u32,
    /// Vertical field of view of the camera in degrees; undefined if there are no poses.
    pub field_of_view: f32,
    /// The hash of the readers' source code, hexadecimal.
    pub readers: [u8; 16],
    /// XXH3 of this header (with zeros in this field) and of the XXH3 hashes of all pieces of all parts.
    pub checksum: [u8; 16],
    /// XXH3 of the scene alone: equal for equal scenes, independent of their source files and of the time.
    pub content: [u8; 16],
    // Numbers of elements; of bytes for the text.
    pub vertices: u64,
    pub triangles: u64,
    pub materials: u64,
    pub lights: u64,
    pub poses: u64,
    pub text: u64,
    pub background: [f32; 3],
    /// Exponent and offset of the scene's placement.
    pub exponent: i32,
    pub offset: [f64; 3],
    /// Number of triangles without area.
    pub degenerate: u64,
}

/// A pose in the file: time, position, direction and up, in double precision.
pub type RawPose = [f64; 10];

impl Header {
    /// For each part, the number of its elements and the size of an element in bytes.
    pub fn parts(&self) -> [(u64, usize); 6] {
        [
            (self.vertices, size_of::<Vertex>()),
            (self.triangles, size_of::<Triangle>()),
            (self.materials, size_of::<Material>()),
            (self.lights, size_of::<Light>()),
            (self.poses, size_of::<RawPose>()),
            (self.text, 1),
        ]
    }

    /// Size of the whole file in bytes; `None` if a number exceeds the limits of a scene.
    pub fn total(&self) -> Option<u64> {
        let parts = self.parts();
        let fits = parts.iter().all(|&(count, _)| count <= MAX_ELEMENTS as u64) && self.text <= MAX_TEXT;
        let bytes = |&(count, size): &(u64, usize)| count * size as u64;
        fits.then(|| size_of::<Header>() as u64 + parts.iter().map(bytes).sum::<u64>())
    }
}

/// The value of [`Header::readers`] in caches that this program writes and accepts.
pub fn readers() -> [u8; 16] {
    let mut text = [0; 16];
    let hash = READERS.as_bytes();
    text[..hash.len().min(16)].copy_from_slice(&hash[..hash.len().min(16)]);
    text
}

/// Converts a pose to its form in the file.
pub fn raw_pose(pose: &Pose) -> RawPose {
    let [p, d, u] = [pose.position, pose.direction, pose.up].map(Vec3::as_dvec3);
    [pose.time, p.x, p.y, p.z, d.x, d.y, d.z, u.x, u.y, u.z]
}

/// Converts a pose from its form in the file.
pub fn pose(raw: &RawPose) -> Pose {
    let vector = |i: usize| Vec3::new(raw[i] as f32, raw[i + 1] as f32, raw[i + 2] as f32);
    Pose { time: raw[0], position: vector(1), direction: vector(4), up: vector(7) }
}
