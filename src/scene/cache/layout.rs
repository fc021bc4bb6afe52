//! How a cache lies in its file.

use crate::math::Vertex;
use crate::scene::{Light, MAX_ELEMENTS, Material, Pose, Triangle};
use bytemuck::{Pod, Zeroable};
use glam::Vec3;

/// Version of the layout.
pub const FORMAT: u32 = 5;

/// What a cache begins with.
pub const MAGIC: [u8; 8] = *b"RTBSCENE";

/// A hash of the readers' source, from `build/main.rs`.
const READERS: &str = env!("RTBENCH_READERS");

/// Most bytes of texts: names and warnings.
const MAX_TEXT: u64 = 1 << 24;

/// What a cache begins with.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub struct Header {
    /// [`MAGIC`].
    pub magic: [u8; 8],
    /// [`FORMAT`].
    pub format: u32,
    /// Vertical, degrees; of no meaning without poses.
    pub field_of_view: f32,
    /// The hash of the readers' source, as text.
    pub readers: [u8; 16],
    /// XXH3 of this header, with zeros here, and of the XXH3 of every piece of every part.
    pub checksum: [u8; 16],
    /// XXH3 of what is the scene's: equal for equal scenes, whatever and whenever they were made from.
    pub content: [u8; 16],
    // Numbers of elements; of the text, of bytes.
    pub vertices: u64,
    pub triangles: u64,
    pub materials: u64,
    pub lights: u64,
    pub poses: u64,
    pub text: u64,
    pub background: [f32; 3],
    /// The scene's placement.
    pub exponent: i32,
    pub offset: [f64; 3],
    /// Triangles without area.
    pub degenerate: u64,
}

/// A pose, with everything in double precision.
pub type RawPose = [f64; 10];

impl Header {
    /// Number of elements and bytes of one, part by part.
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

    /// Bytes of the whole file; `None` if a number is beyond what a scene may have.
    pub fn total(&self) -> Option<u64> {
        let parts = self.parts();
        let fits = parts.iter().all(|&(count, _)| count <= MAX_ELEMENTS as u64) && self.text <= MAX_TEXT;
        let bytes = |&(count, size): &(u64, usize)| count * size as u64;
        fits.then(|| size_of::<Header>() as u64 + parts.iter().map(bytes).sum::<u64>())
    }
}

/// What [`Header::readers`] must be.
pub fn readers() -> [u8; 16] {
    let mut text = [0; 16];
    let hash = READERS.as_bytes();
    text[..hash.len().min(16)].copy_from_slice(&hash[..hash.len().min(16)]);
    text
}

/// A pose as it is stored.
pub fn raw_pose(pose: &Pose) -> RawPose {
    let [p, d, u] = [pose.position, pose.direction, pose.up].map(Vec3::as_dvec3);
    [pose.time, p.x, p.y, p.z, d.x, d.y, d.z, u.x, u.y, u.z]
}

/// A pose as it was stored.
pub fn pose(raw: &RawPose) -> Pose {
    let vector = |i: usize| Vec3::new(raw[i] as f32, raw[i + 1] as f32, raw[i + 2] as f32);
    Pose { time: raw[0], position: vector(1), direction: vector(4), up: vector(7) }
}
