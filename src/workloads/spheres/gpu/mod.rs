//! The sphere tracer on a Vulkan device: one invocation of a kernel per pixel.

mod bands;
mod half_spheres;
pub mod kernels;

pub use bands::{BandUniform, MAX_TESTS};
pub use half_spheres::HalfSphere;
pub use kernels::kernels;

use super::options::{Options, Precision};
use super::scene::PackedSphere;
use super::view::View;
use crate::device::vulkan::{Buffer, Dispatch, Groups, Pipeline, PipelineDescription, Resource};
use crate::device::{Feature, Frame, FrameTime, Interrupted, KernelInfo, Pass, Stage, Submissions, VulkanDevice};
use crate::error::{Error, Result};
use crate::workloads::size::Size;
use bands::{Tile, tiles};
use kernels::{Kernel, MAX_UNIFORM_SPHERES};
use std::sync::Arc;

/// Stages of a frame.
pub const STAGES: [Stage; 1] = [Stage("render")];

/// Most dispatches whose uniforms are on the device at a time.
const MAX_DISPATCHES: usize = 16_384;

/// Bytes of a pixel.
const PIXEL_BYTES: u64 = size_of::<[f32; 4]>() as u64;

/// A scene on a device, with the timed kernel for one set of switches and the buffer of the image.
pub struct GpuRenderer<'d> {
    device: &'d VulkanDevice,
    kernel: Kernel,
    pipeline: Arc<Pipeline>,
    info: KernelInfo,
    pixels: usize,
    tiles: Vec<Tile>,
    spheres: Buffer,
    output: Buffer,
    allocated: u64,
}

/// What a counting kernel makes of a frame, an element for each pixel.
pub struct Counted {
    /// Linear RGB and 1, rows from the top.
    pub image: Vec<[f32; 4]>,
    /// Rays of the pixel's path that hit before the first miss.
    pub hits: Vec<u32>,
    /// Searches of the pixel's path.
    pub searches: Vec<u32>,
}

impl<'d> GpuRenderer<'d> {
    /// Like [`GpuRenderer::in_precision`], in single precision.
    ///
    /// # Errors
    /// The same.
    pub fn new(
        device: &'d VulkanDevice,
        spheres: &[PackedSphere],
        options: Options,
        size: Size,
        trips: u32,
    ) -> Result<GpuRenderer<'d>> {
        GpuRenderer::in_precision(Precision::F32, device, spheres, options, size, trips)
    }

    /// Uploads spheres and compiles the timed kernel for views of this size with at most `trips` rays along a path.
    /// Spheres are in a uniform buffer if the device's limit allows it.
    ///
    /// # Errors
    /// [`Error::Refused`] for an image or a scene that the device cannot bind and for half precision that it has not,
    /// and the device's errors.
    pub fn in_precision(
        precision: Precision,
        device: &'d VulkanDevice,
        spheres: &[PackedSphere],
        options: Options,
        size: Size,
        trips: u32,
    ) -> Result<GpuRenderer<'d>> {
        if precision == Precision::F16 && !device.features().has(Feature::Half) {
            return Err(Error::unsupported("half precision, which this device has not"));
        }
        let sphere_bytes = match precision {
            Precision::F32 => size_of::<PackedSphere>(),
            Precision::F16 => size_of::<HalfSphere>(),
        };
        let room = (device.max_uniform_binding() / sphere_bytes as u64).min(MAX_UNIFORM_SPHERES.into());
        let uniform_spheres = (spheres.len() as u64 <= room).then_some(room as u32);
        let uploaded = uniform_spheres.map_or(spheres.len(), |room| room as usize);
        let sphere_bytes = sphere_bytes as u64 * uploaded as u64;
        let image_bytes = PIXEL_BYTES * size.pixels() as u64;
        device.check_size("the spheres", sphere_bytes, "use a smaller scene")?;
        device.check_size("the image", image_bytes, "use a smaller one")?;
        let Options { algorithm, exit_on_miss, .. } = options;
        let kernel = Kernel { algorithm, exit_on_miss, trips, uniform_spheres, precision, counting: false };
        let (pipeline, info) = compile(device, &kernel)?;
        let mut all = spheres.to_vec();
        all.resize(uploaded, PackedSphere::default());
        let halves: Vec<HalfSphere> = match precision {
            Precision::F32 => Vec::new(),
            Precision::F16 => all.iter().map(HalfSphere::from).collect(),
        };
        let contents: &[u8] =
            if halves.is_empty() { bytemuck::cast_slice(&all) } else { bytemuck::cast_slice(&halves) };
        let buffer = match uniform_spheres {
            None => device.storage("the spheres", contents)?,
            Some(_) => device.uniform("the spheres", contents)?,
        };
        Ok(GpuRenderer {
            device,
            kernel,
            pipeline,
            info,
            pixels: size.pixels(),
            tiles: tiles(size, u64::from(trips) * spheres.len() as u64, device.max_groups()),
            spheres: buffer,
            output: device.poisoned("the image", image_bytes)?,
            allocated: sphere_bytes + image_bytes,
        })
    }

    /// The timed kernel.
    pub fn kernel(&self) -> KernelInfo {
        self.info.clone()
    }

    /// Bytes of spheres and image on the device.
    pub fn allocated(&self) -> u64 {
        self.allocated
    }

    /// Renders views one after another and times each. The views have this renderer's size, trips and spheres. The
    /// image is poisoned before.
    ///
    /// # Errors
    /// [`Error::Interrupted`] between dispatches, or the device's.
    pub fn time(&self, views: &[View], interrupted: Interrupted) -> Result<Vec<FrameTime>> {
        self.device.poison(&self.output);
        let outputs = [(2, &self.output)];
        let mut times = Vec::with_capacity(views.len());
        for views in views.chunks((MAX_DISPATCHES / self.tiles.len()).max(1)) {
            times.extend(
                self.run(&self.pipeline, views, &outputs, |frames| self.device.run_frames(frames, interrupted))?,
            );
        }
        Ok(times)
    }

    /// The image of the last frame that [`GpuRenderer::time`] or [`GpuRenderer::render`] rendered: linear RGB and 1,
    /// rows from the top.
    ///
    /// # Errors
    /// The device's.
    pub fn last(&self) -> Result<Vec<[f32; 4]>> {
        self.device.read(&self.output, self.pixels)
    }

    /// Renders a view by the timed kernel.
    ///
    /// # Errors
    /// The device's.
    pub fn render(&self, view: &View) -> Result<Vec<[f32; 4]>> {
        self.device.poison(&self.output);
        self.once(&self.pipeline, view, &[(2, &self.output)])?;
        self.last()
    }

    /// Renders a view by the counting variant of the kernel.
    ///
    /// # Errors
    /// The device's.
    pub fn count(&self, view: &View) -> Result<Counted> {
        let (pipeline, _) = compile(self.device, &Kernel { counting: true, ..self.kernel })?;
        let image = self.device.poisoned("the counted image", PIXEL_BYTES * self.pixels as u64)?;
        let work = self.device.poisoned("the counts", size_of::<[u32; 2]>() as u64 * self.pixels as u64)?;
        self.once(&pipeline, view, &[(2, &image), (3, &work)])?;
        let work: Vec<[u32; 2]> = self.device.read(&work, self.pixels)?;
        let (hits, searches) = work.into_iter().map(|[hits, searches]| (hits, searches)).unzip();
        Ok(Counted { image: self.device.read(&image, self.pixels)?, hits, searches })
    }

    fn once(&self, pipeline: &Pipeline, view: &View, outputs: &[(u32, &Buffer)]) -> Result<()> {
        self.run(pipeline, std::slice::from_ref(view), outputs, |frames| {
            frames.iter().try_for_each(|frame| self.device.run(frame).map(drop))
        })
    }

    /// Uploads the uniforms of all views and hands their frames over.
    fn run<T>(
        &self,
        pipeline: &Pipeline,
        views: &[View],
        outputs: &[(u32, &Buffer)],
        work: impl FnOnce(&[Frame<Dispatch>]) -> Result<T>,
    ) -> Result<T> {
        let stride = self.device.uniform_stride(size_of::<BandUniform>());
        let mut uniforms = vec![0_u8; views.len() * self.tiles.len() * stride as usize];
        let bands = views.iter().flat_map(|view| self.tiles.iter().map(|tile| tile.of(view)));
        for (place, band) in uniforms.chunks_exact_mut(stride as usize).zip(bands) {
            place[..size_of::<BandUniform>()].copy_from_slice(bytemuck::bytes_of(&band));
        }
        let uniforms = self.device.uniform("the views", &uniforms)?;
        let mut resources = vec![
            (0, Resource::Window(&uniforms, size_of::<BandUniform>() as u64)),
            (1, Resource::Buffer(&self.spheres)),
        ];
        resources.extend(outputs.iter().map(|&(number, buffer)| (number, Resource::Buffer(buffer))));
        let bindings = self.device.bind(pipeline, &resources);
        self.device.check()?;
        let mut offsets = (0..).map(|dispatch: u32| dispatch * stride);
        let mut frame = || {
            let passes = self.tiles.iter().zip(&mut offsets).map(|(tile, offset)| {
                let (x, y) = tile.groups();
                let groups = Groups::Fixed(x, y, 1);
                let work = Dispatch { pipeline, bindings: &bindings, offset: Some(offset), groups };
                Pass { stage: STAGES[0], work }
            });
            Frame { passes: passes.collect(), submissions: Submissions::PerPass }
        };
        let frames: Vec<Frame<Dispatch>> = views.iter().map(|_| frame()).collect();
        work(&frames)
    }
}

/// Compiles a kernel; the device keeps what is compiled.
fn compile(device: &VulkanDevice, kernel: &Kernel) -> Result<(Arc<Pipeline>, KernelInfo)> {
    let source = kernel.assemble()?;
    let pipeline = device.pipeline(&PipelineDescription {
        label: &kernel.label(),
        text: &source.text,
        layout: &kernel.layout(),
        checked: false,
        zero_workgroup_memory: false,
    })?;
    let info = KernelInfo { hash: source.hash(), fetch: "buffers".to_owned(), checked: device.options().checked };
    Ok((pipeline, info))
}
