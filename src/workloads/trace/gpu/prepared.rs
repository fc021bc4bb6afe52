//! A scene and a structure on a device with one traversal: images, counting, given rays. Timing is in [`super::path`].

use super::kernels::{Entry, Kernel, stack_size};
use super::path::LastFrame;
use super::shared::{FrameUniform, TraceRay};
use super::upload::Uploaded;
use crate::camera::View;
use crate::device::vulkan::{Bindings, Buffer, Dispatch, Groups, Pipeline, PipelineDescription, Resource};
use crate::device::{Frame, Pass, Stage, VulkanDevice};
use crate::error::{Error, Result};
use crate::math::{Hit, T_MAX};
use crate::scene::{Light, Scene};
use crate::workloads::trace::backend::*;
use crate::workloads::trace::cpu::cannot_walk;
use crate::workloads::trace::{Method, Structure};
use bytemuck::Zeroable;
use std::collections::HashMap;
use std::sync::Arc;

/// Rays per dispatch of [`Prepared::trace`].
const TRACE_RAYS: usize = 1 << 20;

/// The one stage of a frame: rays are generated, traced and shaded by one kernel.
const RENDER: Stage = Stage("render");

pub(super) struct GpuPrepared<'a> {
    pub(super) device: &'a VulkanDevice,
    scene: &'a Scene,
    uploaded: Uploaded,
    pub(super) method: Method,
    stack_size: u32,
    lengths: Lengths,
    /// Bands per frame that keep a dispatch below the watchdog, by configuration and size.
    pub(super) bands: HashMap<(Config, Size), u32>,
    /// The last frame of the path that was timed last.
    pub(super) last_frame: Option<LastFrame>,
}

/// Uniforms and lights of many frames, uploaded before any of them runs.
pub(super) struct FrameInputs {
    uniforms: Buffer,
    lights: Buffer,
    /// Bytes between the uniforms of two parts.
    stride: u32,
    /// Work-groups of each part, columns and rows.
    groups: Vec<(u32, u32)>,
    parts_per_frame: usize,
}

/// A part of an image, and the index of the output pixel where it would begin if it had all columns.
pub(super) type Part = (Tile, u32);

impl<'a> GpuPrepared<'a> {
    pub fn new(
        device: &'a VulkanDevice,
        scene: &'a Scene,
        structure: &'a dyn Structure,
        method: Method,
    ) -> Result<GpuPrepared<'a>> {
        let traversal = method.traversal;
        if structure.kind() != traversal.structure {
            return Err(cannot_walk(traversal, structure));
        }
        let missing = traversal.needs.missing_in(device.features());
        if !missing.is_empty() {
            let missing: Vec<String> = missing.iter().map(|feature| format!("{feature:?}")).collect();
            return Err(Error::unsupported(format!(
                "{} needs what this device lacks: {}",
                traversal.kernel,
                missing.join(", ")
            )));
        }
        Ok(GpuPrepared {
            device,
            scene,
            uploaded: Uploaded::new(device, scene, structure, method)?,
            method,
            stack_size: stack_size(structure.stack_depth()),
            lengths: Lengths::new(scene.bounds()),
            bands: HashMap::new(),
            last_frame: None,
        })
    }

    fn kernel_of(&self, entry: Entry) -> Kernel {
        let software_threads = self.device.info().software_threads();
        let textures = self.uploaded.textures;
        Kernel { entry, method: self.method, stack_size: self.stack_size, software_threads, textures }
    }

    pub(super) fn compiled(&self, entry: Entry) -> Result<Arc<Pipeline>> {
        let kernel = self.kernel_of(entry);
        self.device.pipeline(&PipelineDescription {
            label: &kernel.label(),
            text: &kernel.assemble().map_err(Error::Device)?.text,
            layout: &kernel.layout(),
            checked: self.method.checked,
            // Packets share tallies that must begin as zero; short stacks need no clearing
            zero_workgroup_memory: self.method.traversal.cooperative,
        })
    }

    /// Uploads the uniforms of all parts of all views.
    pub(super) fn frame_inputs(&self, views: &[View], size: Size, parts: &[Part]) -> Result<FrameInputs> {
        let stride = self.device.uniform_stride(size_of::<FrameUniform>());
        let mut uniforms = Vec::with_capacity(views.len() * parts.len() * stride as usize);
        let mut lights: Vec<Light> = Vec::new();
        let mut groups = Vec::with_capacity(views.len() * parts.len());
        for view in views {
            let grid = view.camera.pixel_grid(size.width, size.height);
            for &(tile, first_pixel) in parts {
                let uniform = FrameUniform {
                    origin: grid.origin,
                    width: size.width,
                    corner: grid.corner,
                    first_row: tile.row,
                    right: grid.right,
                    rows: tile.rows,
                    down: grid.down,
                    epsilon: self.lengths.epsilon,
                    background: self.scene.background,
                    light_count: view.lights.len() as u32,
                    first_light: lights.len() as u32,
                    first_pixel,
                    first_column: tile.column,
                    columns: tile.columns,
                    height: size.height,
                    shadow_reach: self.lengths.reach,
                    pad: [0; 2],
                };
                uniforms.extend_from_slice(bytemuck::bytes_of(&uniform));
                uniforms.resize(uniforms.len().next_multiple_of(stride as usize), 0);
                groups.push((
                    tile.columns.div_ceil(self.method.group.width),
                    tile.rows.div_ceil(self.method.group.height),
                ));
            }
            lights.extend_from_slice(&view.lights);
        }
        let most = self.device.max_groups();
        if let Some((x, y)) = groups.iter().find(|(x, y)| *x.max(y) > most) {
            let problem = format!("{x} x {y} work-groups are more than this device's {most} per dimension");
            return Err(Error::too_large("the image", problem, "use a smaller one"));
        }
        Ok(FrameInputs {
            uniforms: self.device.uniform("the frames", &uniforms)?,
            lights: self.device.storage("the lights", &lights)?,
            stride,
            groups,
            parts_per_frame: parts.len(),
        })
    }

    pub(super) fn render_bindings(&self, pipeline: &Pipeline, inputs: &FrameInputs, output: &Buffer) -> Bindings {
        let uniform = Resource::Window(&inputs.uniforms, size_of::<FrameUniform>() as u64);
        let others =
            [(3, &self.uploaded.materials), (4, &self.uploaded.triangle_materials), (5, &inputs.lights), (8, output)];
        self.bind(pipeline, uniform, &others)
    }

    /// Binds scene and structure, `first` as number 0, and the kernel's other buffers.
    fn bind(&self, pipeline: &Pipeline, first: Resource, others: &[(u32, &Buffer)]) -> Bindings {
        let scene = &self.uploaded;
        let mut resources = vec![
            (0, first),
            (1, Resource::from(&scene.vertices)),
            (2, Resource::from(&scene.triangle_refs)),
            (6, Resource::from(&scene.nodes)),
            (7, Resource::from(&scene.structure)),
        ];
        resources.extend(others.iter().map(|&(number, buffer)| (number, Resource::from(buffer))));
        self.device.bind(pipeline, &resources)
    }

    /// A buffer for the timed kernel's image.
    pub(super) fn image_buffer(&self, size: Size) -> Result<Buffer> {
        self.device.poisoned("the image", (size.pixels() * size_of::<Pixel>()) as u64)
    }

    /// Splits an image into about `across` x `down` parts of whole work-groups, each with its own place in the output.
    pub(super) fn parts(&self, size: Size, across: u32, down: u32) -> Vec<Part> {
        tiles(size, across, down, self.method.group).into_iter().map(|tile| (tile, tile.row * size.width)).collect()
    }

    /// Traces as many rays as a dispatch takes.
    fn trace_chunk(&self, pipeline: &Pipeline, rays: &[GivenRay]) -> Result<Vec<Hit>> {
        let input: Vec<TraceRay> = rays
            .iter()
            .map(|ray| TraceRay { origin: ray.origin, direction: ray.direction, ..TraceRay::zeroed() })
            .collect();
        let input = self.device.storage("the given rays", &input)?;
        let job = self.device.uniform("the job", &[rays.len() as u32, 0, 0, 0])?;
        let output = self.device.poisoned("the hits", (rays.len() * 8) as u64)?;
        let bindings = self.bind(pipeline, Resource::from(&job), &[(3, &input), (8, &output)]);
        let groups = Groups::Fixed((rays.len() as u32).div_ceil(self.method.group.size()), 1, 1);
        let work = Dispatch { pipeline, bindings: &bindings, offset: None, groups };
        self.device.run(&Frame::new(vec![Pass { stage: Stage("trace"), work }]))?;
        let found: Vec<[u32; 2]> = self.device.read(&output, rays.len())?;
        Ok(found.iter().map(|&[t, triangle]| Hit { t: f32::from_bits(t), triangle }).collect())
    }
}

impl FrameInputs {
    /// The frames that were uploaded: a pass for each of their parts.
    pub fn frames<'f>(&self, pipeline: &'f Pipeline, bindings: &'f Bindings) -> Vec<Frame<Dispatch<'f>>> {
        let passes: Vec<_> = (0u32..)
            .zip(&self.groups)
            .map(|(index, &(x, y))| {
                let (offset, groups) = (Some(index * self.stride), Groups::Fixed(x, y, 1));
                Pass { stage: RENDER, work: Dispatch { pipeline, bindings, offset, groups } }
            })
            .collect();
        passes.chunks(self.parts_per_frame).map(|passes| Frame::new(passes.to_vec())).collect()
    }
}

impl Prepared for GpuPrepared<'_> {
    fn image(&mut self, config: Config, view: &View, size: Size) -> Result<Vec<Pixel>> {
        let pipeline = self.compiled(Entry::Render { config, counting: false })?;
        let output = self.image_buffer(size)?;
        let tiles = self.method.tiles;
        let bands = self.parts(size, tiles, tiles.max((size.pixels() as u32).div_ceil(BAND_PIXELS)));
        let inputs = self.frame_inputs(std::slice::from_ref(view), size, &bands)?;
        let bindings = self.render_bindings(&pipeline, &inputs, &output);
        for frame in inputs.frames(&pipeline, &bindings) {
            self.device.run(&frame)?;
        }
        self.device.read(&output, size.pixels())
    }

    fn counted(
        &mut self,
        config: Config,
        view: &View,
        size: Size,
        band: &mut dyn FnMut(u32, &[CountedPixel]),
    ) -> Result<()> {
        let pipeline = self.compiled(Entry::Render { config, counting: true })?;
        let bands = self.parts(size, 1, (size.pixels() as u32).div_ceil(BAND_PIXELS));
        let largest = bands.iter().map(|(tile, _)| tile.rows as usize * size.width as usize).max().unwrap_or(0);
        let bytes = (largest * size_of::<CountedPixel>()) as u64;
        let output = self.device.poisoned("the counters", bytes)?;
        // Every band begins at the output's start and must not find the one before
        let poison = if bands.len() > 1 { Some(self.device.poisoned("the poison", bytes)?) } else { None };
        let parts: Vec<Part> = bands.iter().map(|&(tile, _)| (tile, 0)).collect();
        let inputs = self.frame_inputs(std::slice::from_ref(view), size, &parts)?;
        let bindings = self.render_bindings(&pipeline, &inputs, &output);
        let passes = inputs.frames(&pipeline, &bindings).into_iter().flat_map(|frame| frame.passes);
        for (pass, &(Tile { row, rows, .. }, _)) in passes.zip(&bands) {
            if let Some(poison) = poison.as_ref().filter(|_| row > 0) {
                self.device.copy(poison, &output);
            }
            self.device.run(&Frame::new(vec![pass]))?;
            let pixels: Vec<CountedPixel> = self.device.read(&output, (rows * size.width) as usize)?;
            band(row, &pixels);
        }
        Ok(())
    }

    fn time_path(
        &mut self,
        config: Config,
        views: &[View],
        size: Size,
        interrupted: Interrupted,
    ) -> Result<Vec<FrameTime>> {
        self.time(config, views, size, interrupted)
    }

    fn timed(&mut self) -> Result<Timed> {
        match &self.last_frame {
            Some(frame) => frame.read(self.device),
            None => Ok(Timed::default()),
        }
    }

    fn trace(&mut self, rays: &[GivenRay], any_hit: bool) -> Result<Vec<Hit>> {
        let pipeline = self.compiled(Entry::Trace { any_hit })?;
        let mut hits = Vec::with_capacity(rays.len());
        for rays in rays.chunks(TRACE_RAYS) {
            let found = trace_units(rays, hits.len(), |rays| self.trace_chunk(&pipeline, rays))?;
            hits.extend(found);
        }
        debug_assert!(hits.iter().all(|hit| hit.t <= T_MAX));
        Ok(hits)
    }

    fn kernel(&self, config: Config) -> Result<Option<KernelInfo>> {
        let kernel = self.kernel_of(Entry::Render { config, counting: false });
        let hash = kernel.assemble().map_err(Error::Device)?.hash();
        let fetch = if kernel.textures { "textures" } else { "buffers" };
        let checked = self.device.options().checked || self.method.checked;
        Ok(Some(KernelInfo { hash, fetch: fetch.to_owned(), checked }))
    }

    fn allocated(&self) -> (u64, u64) {
        let lights = std::mem::size_of_val(self.scene.lights.as_slice()) as u64;
        (self.uploaded.geometry_bytes + lights, self.uploaded.structure_bytes)
    }
}
