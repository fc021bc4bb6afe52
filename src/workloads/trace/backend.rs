//! The interface of a device to ray tracing, and the types of its answers. [`crate::device::CpuDevice`] and
//! [`crate::device::VulkanDevice`] implement it.

use crate::camera::View;
pub use crate::device::{DeviceInfo, DeviceType, FrameTime, Interrupted, KernelInfo, POISON};
use crate::error::{Error, Result};
use crate::math::{Aabb, Hit, MISS, T_MAX};
use crate::record::row::Metric;
use crate::scene::Scene;
use crate::scene::placement::{exponent_of, power_of_two};
pub use crate::workloads::size::Size;
pub use crate::workloads::trace::count::{ByRayType, Counters, RAY_TYPES};
pub use crate::workloads::trace::given::TraceRay;
use crate::workloads::trace::method::Group;
pub use crate::workloads::trace::rays::{AMBIENT_RAYS, Config, MAX_BOUNCES};
use crate::workloads::trace::simt::Sums;
use crate::workloads::trace::{Method, Structure};
use bytemuck::{Pod, Zeroable};
use glam::Vec3;

/// Counters of one pixel.
pub type PixelCounters = ByRayType<Counters>;

/// The output of a timed kernel for a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Pixel {
    /// Nearest triangle of the primary ray, [`crate::math::MISS`] if none.
    pub triangle: u32,
    /// Shaded colour, 8 bits per channel, red in the low byte, alpha 255.
    pub rgba: u32,
}

/// The output of a counting kernel for a pixel (54 words).
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

/// The distance from a surface at which secondary rays start, in scene units: far above the rounding of coordinates of
/// the scene's size (about 1e-7 of it), far below anything visible. In a scene more than about 21 diagonals from
/// the origin, coordinates are rounded more coarsely, and their size decides: [`ROUNDINGS`].
pub fn surface_epsilon(bounds: Aabb) -> f32 {
    let reach = bounds.min.abs().max(bounds.max.abs()).max_element();
    (bounds.diagonal() * 1.0e-5).max(reach * ROUNDINGS)
}

/// The greatest distance from a point at which a shadow ray from a light starts, in scene units: four diagonals.
/// Nothing is farther away, and rays that start at a distant light could not tell the point from its neighbours.
pub fn shadow_reach(bounds: Aabb) -> f32 {
    bounds.diagonal() * 4.0
}

/// How far from a surface an ambient ray reaches, in scene units: a tenth of the diagonal.
pub fn ambient_reach(bounds: Aabb) -> f32 {
    bounds.diagonal() * 0.1
}

/// The smallest surface epsilon as a share of the largest coordinate: eight times its rounding (2^-24).
/// Measured with a scene of curved surfaces and shadows, 400 to 4,000 diagonals away: acne ends at two roundings, and
/// from sixteen on light comes through the seams of shadows.
const ROUNDINGS: f32 = 8.0 / (1 << 24) as f32;

/// Lengths that secondary rays depend on, in scene units.
#[derive(Clone, Copy, Debug)]
pub struct Lengths {
    /// The distance from a surface at which they start, see [`surface_epsilon`].
    pub epsilon: f32,
    /// The greatest distance from a point at which shadow rays from a light start, see [`shadow_reach`].
    pub reach: f32,
    /// How far ambient rays reach, see [`ambient_reach`].
    pub ambient: f32,
}

impl Lengths {
    /// The lengths for a scene with these bounds.
    pub fn new(bounds: Aabb) -> Lengths {
        Lengths { epsilon: surface_epsilon(bounds), reach: shadow_reach(bounds), ambient: ambient_reach(bounds) }
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

/// Frames that are rendered or counted, not timed, are split into bands of about this many pixels.
pub(crate) const BAND_PIXELS: u32 = 262_144;

/// The warps of a frame whose work is counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Warps {
    /// Lanes of a warp.
    pub width: u32,
    /// Those of one in so many stripes of [`STRIPE`] work-groups, in each row of work-groups from another one on; 1 for
    /// all.
    pub every: u32,
}

/// Work-groups of a stripe.
pub const STRIPE: u32 = 8;

impl Warps {
    /// All warps of a frame.
    pub fn all(width: u32) -> Warps {
        Warps { width, every: 1 }
    }
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

/// The result of timing a path.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Timed {
    /// The image of its last frame, rows from the top; empty if no path was timed.
    pub pixels: Vec<Pixel>,
    /// Dispatches per frame: one, unless the image was split into tiles or for a watchdog. 0 on the CPU, which
    /// dispatches nothing.
    pub dispatches: u32,
}

/// A ray given by a user, in the coordinates of the scene in memory ([`crate::scene::Placement`]).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GivenRay {
    /// Start.
    pub origin: Vec3,
    /// Direction, any length but zero; distances are in units of it.
    pub direction: Vec3,
}

impl GivenRay {
    /// The ray with its direction scaled by a power of two, so that its largest component is 1 to 2 and no product of
    /// it leaves the range of floats; and the exponent of that power. A direction without length stays as it is.
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

/// Traces given rays with directions of any length: `trace` gets them with a length near 1, in the same order, and its
/// distances are scaled back.
///
/// # Errors
/// Those of `trace`; [`crate::Error::Input`] for a distance that is no float because the direction is too short.
fn trace_units(rays: &[GivenRay], trace: impl FnOnce(&[TraceRay]) -> Result<Vec<Hit>>) -> Result<Vec<Hit>> {
    let unit = |ray: &GivenRay| {
        let (GivenRay { origin, direction }, exponent) = ray.unit();
        (TraceRay::new(origin, direction), exponent)
    };
    let (units, exponents): (Vec<TraceRay>, Vec<i32>) = rays.iter().map(unit).unzip();
    let mut hits = trace(&units)?;
    for (i, (hit, &exponent)) in hits.iter_mut().zip(&exponents).enumerate() {
        if hit.triangle == MISS || exponent == 0 {
            continue;
        }
        let t = f64::from(hit.t) * power_of_two(exponent);
        if t > f64::from(T_MAX) {
            let problem = format!("its hit is {t:e} times the direction's length away, which is no float");
            return Err(Error::argument(format!("ray {i}"), problem, "give a longer direction"));
        }
        hit.t = t as f32;
    }
    Ok(hits)
}

/// A device that can trace rays.
pub trait Backend {
    /// The description for a run's provenance.
    fn info(&self) -> &DeviceInfo;

    /// Uploads scene and structure, to be traced by `method`.
    ///
    /// # Errors
    /// [`crate::Error::Device`] if it does not fit the device's limits.
    fn prepare<'a>(
        &'a self,
        scene: &'a Scene,
        structure: &'a dyn Structure,
        method: Method,
    ) -> Result<Box<dyn Prepared + 'a>>;
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

    /// What warps issue for one frame, by ray type: on the CPU.
    ///
    /// # Errors
    /// [`Error::Refused`] where that is not modelled.
    fn in_warps(&mut self, _config: Config, _view: &View, _size: Size, _warps: Warps) -> Result<ByRayType<Sums>> {
        Err(Error::unsupported("warps are counted by twins on the CPU"))
    }

    /// For each pixel of a frame, the percentage of the lanes of its work-group's warps that take part in what these
    /// issue: on the CPU.
    ///
    /// # Errors
    /// As [`Prepared::in_warps`].
    fn utilisation(&mut self, _config: Config, _view: &View, _size: Size, _width: u32) -> Result<Vec<u32>> {
        Err(Error::unsupported("warps are counted by twins on the CPU"))
    }

    /// One pass over a path by the timed kernel: the time of each frame. Nothing is read back in between.
    fn time_path(
        &mut self,
        config: Config,
        views: &[View],
        size: Size,
        interrupted: Interrupted,
    ) -> Result<Vec<FrameTime>>;

    /// The output of the last frame of the last [`Prepared::time_path`], in a buffer that was filled with [`POISON`]
    /// before the path. It shows that what was timed was also right.
    fn timed(&mut self) -> Result<Timed>;

    /// Casts rays as they are: finds the nearest hit, or with a limit whether anything is hit before that distance, in
    /// units of the direction's length (`triangle` and `t` are then 0). A ray without direction hits nothing.
    fn cast(&mut self, rays: &[TraceRay], any_before: Option<f32>) -> Result<Vec<Hit>>;

    /// Traces given rays with directions of any length, in the coordinates of the scene in memory: finds the nearest
    /// hit, or with `any_hit` whether anything is hit (`triangle` and `t` are then 0).
    fn trace(&mut self, rays: &[GivenRay], any_hit: bool) -> Result<Vec<Hit>> {
        let any_before = any_hit.then_some(T_MAX);
        trace_units(rays, |rays| self.cast(rays, any_before))
    }

    /// The identities of the timed kernels, one for each pass of a frame; none for the twins.
    fn kernels(&self, _config: Config) -> Result<Vec<KernelInfo>> {
        Ok(Vec::new())
    }

    /// The stages of a timed frame, where each has a time of its own.
    fn stages(&self, _config: Config) -> Vec<&'static str> {
        Vec::new()
    }

    /// What is known of the structure only once it is on the device.
    fn artifact_metrics(&self) -> Vec<Metric> {
        Vec::new()
    }

    /// Bytes allocated on the device for geometry (vertices, materials, lights) and for the structure (nodes and
    /// triangle references), in this order.
    fn allocated(&self) -> (u64, u64);
}
