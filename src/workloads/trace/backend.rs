//! What a device must be able to do. Two implement it: [`crate::workloads::trace`] and [`crate::workloads::trace::gpu`].

use crate::camera::View;
use crate::error::{Error, Result};
use crate::math::{Aabb, Hit, MISS, T_MAX};
use crate::scene::Scene;
use crate::scene::placement::{exponent_of, power_of_two};
use crate::workloads::trace::method::Group;
pub use crate::workloads::trace::rays::{Config, MAX_BOUNCES};
use crate::workloads::trace::{Method, Structure};
use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// What one ray type of one pixel cost. Six words, as the counting kernels write them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Counters {
    /// Rays of this type.
    pub rays: u32,
    /// Inner nodes visited; the grid counts its cells here.
    pub inner: u32,
    /// Leaves visited (not counted by the grid).
    pub leaves: u32,
    /// Ray/triangle tests.
    pub tests: u32,
    /// Entries taken from a stack.
    pub pops: u32,
    /// Restarts at (or below) the root.
    pub restarts: u32,
}

impl Counters {
    /// Traversal steps: nodes visited, or cells for a grid (SPEC section 6).
    pub fn steps(&self) -> u32 {
        self.inner + self.leaves
    }
}

/// Counters of one pixel by ray type: primary, shadow, reflected.
pub type PixelCounters = [Counters; 3];

/// Names of the ray types, in the order of [`PixelCounters`].
pub const RAY_TYPES: [&str; 3] = ["primary", "shadow", "reflected"];

/// What a timed kernel leaves behind for a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Pixel {
    /// Nearest triangle of the primary ray, [`crate::math::MISS`] if none.
    pub triangle: u32,
    /// Shaded colour, 8 bits per channel, red in the low byte, alpha 255.
    pub rgba: u32,
}

/// What output buffers are filled with before a kernel runs: no triangle, no colour (alpha 0).
pub const POISON: u32 = 0xDEAD_BEEF;

/// What a counting kernel leaves behind for a pixel (22 words).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct CountedPixel {
    /// The same as the timed kernel's.
    pub pixel: Pixel,
    /// Distance of the primary ray's hit (bits of an f32); bits of [`crate::math::T_MAX`] for a miss.
    pub t: u32,
    /// Zero.
    pub pad: u32,
    /// By ray type.
    pub counters: PixelCounters,
}

/// How far off a surface secondary rays start, in scene units: far above the rounding of coordinates of the scene's
/// size (about 1e-7 of it), far below anything that is seen. In a scene more than about 21 diagonals from
/// the origin, coordinates are rounded more coarsely, and their size decides: [`ROUNDINGS`].
pub fn surface_epsilon(bounds: Aabb) -> f32 {
    let reach = bounds.min.abs().max(bounds.max.abs()).max_element();
    (bounds.diagonal() * 1.0e-5).max(reach * ROUNDINGS)
}

/// How far from a point a shadow ray from a light starts at most, in scene units: four diagonals. Nothing lies beyond, and
/// rays that start at a distant light could not tell the point from its neighbours.
pub fn shadow_reach(bounds: Aabb) -> f32 {
    bounds.diagonal() * 4.0
}

/// The smallest surface epsilon as a share of the largest coordinate: eight times its rounding (2^-24).
/// Measured with a scene of curved surfaces and shadows, 400 to 4,000 diagonals away: acne ends at two roundings, and
/// from sixteen on light comes through the seams of shadows.
const ROUNDINGS: f32 = 8.0 / (1 << 24) as f32;

/// Lengths that secondary rays depend on, in scene units.
#[derive(Clone, Copy, Debug)]
pub struct Lengths {
    /// How far off a surface they start, see [`surface_epsilon`].
    pub epsilon: f32,
    /// How far from a point shadow rays from a light start at most, see [`shadow_reach`].
    pub reach: f32,
}

impl Lengths {
    /// Those of a scene with these bounds.
    pub fn new(bounds: Aabb) -> Lengths {
        Lengths { epsilon: surface_epsilon(bounds), reach: shadow_reach(bounds) }
    }
}

/// Width and height of an image in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Size {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Size {
    /// Number of pixels.
    pub fn pixels(self) -> usize {
        self.width as usize * self.height as usize
    }
}

/// A part of an image, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tile {
    /// First column.
    pub column: u32,
    /// Columns.
    pub columns: u32,
    /// First row.
    pub row: u32,
    /// Rows.
    pub rows: u32,
}

/// Splits an image into about `across` x `down` tiles of whole work-groups, row by row.
pub fn tiles(size: Size, across: u32, down: u32, group: Group) -> Vec<Tile> {
    let columns = size.width.div_ceil(across.max(1)).next_multiple_of(group.width);
    let rows = size.height.div_ceil(down.max(1)).next_multiple_of(group.height);
    let mut tiles = Vec::new();
    for row in (0..size.height).step_by(rows as usize) {
        for column in (0..size.width).step_by(columns as usize) {
            let (columns, rows) = (columns.min(size.width - column), rows.min(size.height - row));
            tiles.push(Tile { column, columns, row, rows });
        }
    }
    tiles
}

/// How long one frame took.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FrameTime {
    /// By the device's own timestamps, in nanoseconds; `None` where it has none.
    pub device_ns: Option<u64>,
    /// By the host's clock, from the previous frame's completion (or the start) to this one's, in nanoseconds.
    pub wall_ns: u64,
}

/// What a timed path left behind.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Timed {
    /// Of its last frame, rows from the top; empty where no path was timed.
    pub pixels: Vec<Pixel>,
    /// Dispatches per frame: one, unless the image was split into tiles, or a watchdog was in the way. 0 where nothing is
    /// dispatched.
    pub dispatches: u32,
}

/// What kind of device it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DeviceType {
    /// The CPU twins of this crate.
    CpuTwin,
    /// A Vulkan driver that computes on the CPU (lavapipe): its times do not rank structures for a GPU.
    SoftwareRasteriser,
    /// A GPU that shares the CPU's memory.
    IntegratedGpu,
    /// A GPU of its own.
    DiscreteGpu,
    /// A GPU behind a hypervisor.
    VirtualGpu,
    /// Anything else.
    Other,
}

/// A device, as it stands in a run's provenance.
#[derive(Clone, Debug, Serialize, Deserialize, PartialEq)]
pub struct DeviceInfo {
    /// Adapter name, or the processor's name for the twins.
    pub name: String,
    /// Kind.
    pub device_type: DeviceType,
    /// `vulkan`, or `cpu` for the twins.
    pub backend: String,
    /// Driver name and version; empty for the twins.
    pub driver: String,
    /// Nanoseconds per timestamp tick; `None` without timestamps.
    pub timestamp_period_ns: Option<f32>,
    /// True if kernels are compiled with wgpu's bounds checks and loop bounds.
    pub checked: bool,
    /// Optional features that are in use, by name.
    pub features: Vec<String>,
    /// Limits that decide what fits, by name.
    pub limits: std::collections::BTreeMap<String, u64>,
    /// Threads that compute: of the twins, or of a software rasteriser.
    pub threads: Option<usize>,
}

impl DeviceInfo {
    /// True where device and twins agree to the bit: the twins themselves, and lavapipe (SPEC section 12).
    pub fn is_exact(&self) -> bool {
        matches!(self.device_type, DeviceType::CpuTwin | DeviceType::SoftwareRasteriser)
    }
}

/// A ray given by a user, in the coordinates of the scene as it lies in memory ([`crate::scene::Placement`]).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GivenRay {
    /// Start.
    pub origin: Vec3,
    /// Direction, any length but zero; distances are in units of it.
    pub direction: Vec3,
}

impl GivenRay {
    /// The ray with its direction scaled by a power of two, so that its largest component is 1 to 2 and no product of
    /// it leaves the range of floats; and the exponent of that power. What has no length stays as it is.
    pub fn unit(&self) -> (GivenRay, i32) {
        let largest = f64::from(self.direction.abs().max_element());
        if !(largest > 0.0 && largest.is_finite()) {
            return (*self, 0);
        }
        let exponent = -exponent_of(largest);
        let direction = (self.direction.as_dvec3() * power_of_two(exponent)).as_vec3();
        (GivenRay { direction, ..*self }, exponent)
    }
}

/// Traces given rays with directions of any length: `trace` is given ones of a length near 1, in the same order, and
/// the distances that it finds are scaled back. `first` is the number of the first ray, for errors.
///
/// # Errors
/// Those of `trace`; [`crate::Error::Input`] for a distance that is no float, since the direction is so short.
pub(crate) fn trace_units(
    rays: &[GivenRay],
    first: usize,
    trace: impl FnOnce(&[GivenRay]) -> Result<Vec<Hit>>,
) -> Result<Vec<Hit>> {
    let (units, exponents): (Vec<GivenRay>, Vec<i32>) = rays.iter().map(GivenRay::unit).unzip();
    let mut hits = trace(&units)?;
    for (i, (hit, &exponent)) in hits.iter_mut().zip(&exponents).enumerate() {
        if hit.triangle == MISS || exponent == 0 {
            continue;
        }
        let t = f64::from(hit.t) * power_of_two(exponent);
        if t > f64::from(T_MAX) {
            let problem = format!("its hit is {t:e} times the direction's length away, which is no float");
            return Err(Error::argument(format!("ray {}", first + i), problem, "give a longer direction"));
        }
        hit.t = t as f32;
    }
    Ok(hits)
}

/// Asked between frames; true ends the work with [`crate::Error::Interrupted`].
pub type Interrupted<'a> = &'a dyn Fn() -> bool;

/// An opened device.
pub trait Backend {
    /// What it is.
    fn info(&self) -> &DeviceInfo;

    /// Uploads scene and structure and makes ready to send rays through it by `method`.
    ///
    /// # Errors
    /// [`crate::Error::Device`] if it does not fit the device's limits.
    fn prepare<'a>(
        &'a self,
        scene: &'a Scene,
        structure: &'a Structure,
        method: Method,
    ) -> Result<Box<dyn Prepared + 'a>>;
}

/// The identity of a compiled kernel.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct KernelInfo {
    /// First 16 digits of BLAKE3 of its text, without what only describes the machine (a software driver's threads): equal
    /// for kernels that are equal.
    pub hash: String,
    /// Where it reads scene and structure from: `buffers` or `textures`.
    pub fetch: String,
    /// True if it is compiled with wgpu's bounds checks and loop bounds.
    #[serde(default)]
    pub checked: bool,
}

/// A scene and a structure on a device, with one traversal.
pub trait Prepared {
    /// One frame by the timed kernel, into buffers filled with [`POISON`]; rows from the top.
    fn image(&mut self, config: Config, view: &View, size: Size) -> Result<Vec<Pixel>>;

    /// One frame by the counting kernel, into buffers filled with [`POISON`]. Rows from the top, handed over in bands
    /// so that a large image needs no large buffer: `(first row, pixels of whole rows)`.
    fn counted(
        &mut self,
        config: Config,
        view: &View,
        size: Size,
        band: &mut dyn FnMut(u32, &[CountedPixel]),
    ) -> Result<()>;

    /// One pass over a path by the timed kernel: the time of each frame. Nothing is read back in between.
    fn time_path(
        &mut self,
        config: Config,
        views: &[View],
        size: Size,
        interrupted: Interrupted,
    ) -> Result<Vec<FrameTime>>;

    /// What the last frame of the last [`Prepared::time_path`] wrote, into a buffer that was filled with [`POISON`] before
    /// the path: what was timed can so be checked.
    fn timed(&mut self) -> Result<Timed>;

    /// Traces given rays, in the coordinates of the scene as it lies in memory: the nearest hit, or with `any_hit`
    /// whether anything is hit at all (`triangle` is 0 then, and `t` is 0).
    fn trace(&mut self, rays: &[GivenRay], any_hit: bool) -> Result<Vec<Hit>>;

    /// What the timed kernel is; `None` where nothing is compiled for a device.
    fn kernel(&self, _config: Config) -> Result<Option<KernelInfo>> {
        Ok(None)
    }

    /// Bytes allocated on the device for geometry (vertices, materials, lights) and for the structure (nodes and
    /// records), in this order.
    fn allocated(&self) -> (u64, u64);
}
