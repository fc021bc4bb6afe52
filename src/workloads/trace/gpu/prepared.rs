//! A scene and a structure on a device: rendering, counting, tracing; timing is in [`crate::workloads::trace::gpu::timing`].

use crate::camera::View;
use crate::error::{Error, Result};
use crate::math::{Hit, T_MAX};
use crate::scene::{Light, Scene};
use crate::workloads::trace::backend::*;
use crate::workloads::trace::gpu::device::{Compiled, GpuBackend};
use crate::workloads::trace::gpu::kernels::{Entry, Kernel, stack_size};
use crate::workloads::trace::gpu::shared::{FrameUniform, TraceRay};
use crate::workloads::trace::gpu::timing::Written;
use crate::workloads::trace::gpu::upload::Uploaded;
use crate::workloads::trace::{Method, Structure, Traversal};
use bytemuck::{AnyBitPattern, NoUninit, Zeroable};
use std::collections::HashMap;

/// Bands of frames that are rendered or counted, not timed: about this many pixels.
const BAND_PIXELS: u32 = 262_144;

/// Rays per dispatch of [`Prepared::trace`].
const TRACE_RAYS: usize = 1 << 20;

pub(super) struct GpuPrepared<'a> {
    pub(super) backend: &'a GpuBackend,
    scene: &'a Scene,
    uploaded: Uploaded,
    pub(super) method: Method,
    stack_size: u32,
    lengths: Lengths,
    /// Bands per frame that keep a dispatch below the watchdog, by configuration and size.
    pub(super) bands: HashMap<(Config, Size), u32>,
    /// Of the path that was timed last.
    pub(super) written: Option<Written>,
}

/// Uniforms and lights of many frames, uploaded before any of them runs.
pub(super) struct Frames {
    uniforms: wgpu::Buffer,
    lights: wgpu::Buffer,
    stride: u32,
    /// Work-groups of each uniform's part, columns and rows: what is dispatched.
    pub(super) groups: Vec<(u32, u32)>,
}

/// A part of an image, and the pixel of the output where it would begin if it had all columns.
pub(super) type Part = (Tile, u32);

impl<'a> GpuPrepared<'a> {
    pub fn new(
        backend: &'a GpuBackend,
        scene: &'a Scene,
        structure: &'a Structure,
        method: Method,
    ) -> Result<GpuPrepared<'a>> {
        let depth = match (structure, method.traversal) {
            (Structure::Brute(_), Traversal::Brute)
            | (Structure::Grid(_), Traversal::Grid | Traversal::GridCoop | Traversal::GridPacket)
            | (Structure::KdTree(_), Traversal::KdTree(_)) => 0,
            (Structure::Bvh(bvh), Traversal::Bvh(_) | Traversal::BvhStack) => bvh.depth,
            _ => return Err(Error::Device(format!("{:?} cannot walk this structure", method.traversal))),
        };
        Ok(GpuPrepared {
            backend,
            scene,
            uploaded: backend.upload(scene, structure, method)?,
            method,
            stack_size: stack_size(depth),
            lengths: Lengths::new(scene.bounds()),
            bands: HashMap::new(),
            written: None,
        })
    }

    pub(super) fn kernel_of(&self, entry: Entry) -> Kernel {
        let software_threads = self.backend.software_threads();
        let textures = self.uploaded.textures;
        Kernel { entry, method: self.method, stack_size: self.stack_size, software_threads, textures }
    }

    /// Uploads the uniforms of all parts of all views.
    pub(super) fn frames(&self, views: &[View], size: Size, parts: &[Part]) -> Result<Frames> {
        let stride = (size_of::<FrameUniform>() as u32)
            .next_multiple_of(self.backend.limits.min_uniform_buffer_offset_alignment);
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
        let most = self.backend.limits.max_compute_workgroups_per_dimension;
        if let Some((x, y)) = groups.iter().find(|(x, y)| *x.max(y) > most) {
            let problem = format!("an image of {x} x {y} work-groups is beyond this device's {most} per dimension");
            return Err(Error::Device(problem));
        }
        let uniforms = self.backend.filled("the frames", &uniforms, wgpu::BufferUsages::UNIFORM)?;
        Ok(Frames { uniforms, lights: self.backend.storage("the lights", &lights)?, stride, groups })
    }

    pub(super) fn render_bindings(
        &self,
        compiled: &Compiled,
        frames: &Frames,
        output: &wgpu::Buffer,
    ) -> wgpu::BindGroup {
        let uniform = wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer: &frames.uniforms,
            offset: 0,
            size: wgpu::BufferSize::new(size_of::<FrameUniform>() as u64),
        });
        let others =
            [(3, &self.uploaded.materials), (4, &self.uploaded.triangle_materials), (5, &frames.lights), (8, output)];
        self.bind(compiled, uniform, &others)
    }

    /// Binds scene and structure, `first` as number 0, and whatever else a kernel has.
    fn bind(
        &self,
        compiled: &Compiled,
        first: wgpu::BindingResource,
        others: &[(u32, &wgpu::Buffer)],
    ) -> wgpu::BindGroup {
        let scene = &self.uploaded;
        let inputs = [(1, &scene.vertices), (2, &scene.triangle_refs), (6, &scene.nodes)];
        let mut entries: Vec<_> = [(0, first), (7, scene.structure.as_entire_binding())]
            .into_iter()
            .chain(inputs.map(|(binding, words)| (binding, words.binding())))
            .chain(others.iter().map(|(binding, buffer)| (*binding, buffer.as_entire_binding())))
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        entries.sort_by_key(|entry| entry.binding);
        let layout = &compiled.bindings;
        self.backend.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
    }

    /// Submits one part.
    pub(super) fn submit(
        &self,
        compiled: &Compiled,
        bindings: &wgpu::BindGroup,
        frames: &Frames,
        index: usize,
        timer: Option<wgpu::ComputePassTimestampWrites>,
    ) -> wgpu::SubmissionIndex {
        let mut encoder = self.backend.device.create_command_encoder(&Default::default());
        {
            let mut pass =
                encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: None, timestamp_writes: timer });
            pass.set_pipeline(&compiled.pipeline);
            pass.set_bind_group(0, bindings, &[index as u32 * frames.stride]);
            let (x, y) = frames.groups[index];
            pass.dispatch_workgroups(x, y, 1);
        }
        self.backend.queue.submit([encoder.finish()])
    }

    /// Copies a buffer's first `count` elements back.
    pub(super) fn read<T: AnyBitPattern + NoUninit>(&self, buffer: &wgpu::Buffer, count: usize) -> Result<Vec<T>> {
        let size = (count * size_of::<T>()) as u64;
        let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
        let staging = self.backend.buffer("the read-back", size, usage)?;
        let mut encoder = self.backend.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(buffer, 0, &staging, 0, size);
        let submission = self.backend.queue.submit([encoder.finish()]);
        staging.map_async(wgpu::MapMode::Read, 0..size, |_| ());
        self.backend.wait(submission)?;
        let view =
            staging.get_mapped_range(0..size).map_err(|e| Error::DeviceLost(format!("cannot read back: {e}")))?;
        Ok(bytemuck::pod_collect_to_vec(&view))
    }

    /// A buffer for output, filled with [`POISON`]: what a kernel does not write is then seen.
    pub(super) fn poisoned(&self, what: &str, size: u64) -> Result<wgpu::Buffer> {
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
        let buffer = self.backend.buffer(what, size, usage)?;
        let poison = vec![POISON; (size as usize).div_ceil(4)];
        self.backend.queue.write_buffer(&buffer, 0, bytemuck::cast_slice(&poison));
        Ok(buffer)
    }

    /// Splits an image into about `across` x `down` parts of whole work-groups, each with its own place in the output.
    pub(super) fn parts(&self, size: Size, across: u32, down: u32) -> Vec<Part> {
        tiles(size, across, down, self.method.group).into_iter().map(|tile| (tile, tile.row * size.width)).collect()
    }
}

impl GpuPrepared<'_> {
    /// Traces as many rays as a dispatch takes.
    fn trace_chunk(&self, compiled: &Compiled, rays: &[GivenRay]) -> Result<Vec<Hit>> {
        let given: Vec<TraceRay> = rays
            .iter()
            .map(|ray| TraceRay { origin: ray.origin, direction: ray.direction, ..TraceRay::zeroed() })
            .collect();
        let given = self.backend.storage("the given rays", &given)?;
        let job = [rays.len() as u32, 0, 0, 0];
        let job = self.backend.filled("the job", bytemuck::cast_slice(&job), wgpu::BufferUsages::UNIFORM)?;
        let output = self.poisoned("the hits", (rays.len() * 8) as u64)?;
        let bindings = self.bind(compiled, job.as_entire_binding(), &[(3, &given), (8, &output)]);
        let mut encoder = self.backend.device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(&compiled.pipeline);
            pass.set_bind_group(0, &bindings, &[]);
            pass.dispatch_workgroups((rays.len() as u32).div_ceil(self.method.group.size()), 1, 1);
        }
        self.backend.queue.submit([encoder.finish()]);
        let found: Vec<[u32; 2]> = self.read(&output, rays.len())?;
        Ok(found.iter().map(|&[t, triangle]| Hit { t: f32::from_bits(t), triangle }).collect())
    }
}

impl Prepared for GpuPrepared<'_> {
    fn image(&mut self, config: Config, view: &View, size: Size) -> Result<Vec<Pixel>> {
        let compiled = self.backend.compiled(self.kernel_of(Entry::Render { config, counting: false }))?;
        let output = self.poisoned("the image", (size.pixels() * size_of::<Pixel>()) as u64)?;
        let tiles = self.method.tiles;
        let bands = self.parts(size, tiles, tiles.max((size.pixels() as u32).div_ceil(BAND_PIXELS)));
        let frames = self.frames(std::slice::from_ref(view), size, &bands)?;
        let bindings = self.render_bindings(&compiled, &frames, &output);
        for index in 0..bands.len() {
            let submission = self.submit(&compiled, &bindings, &frames, index, None);
            self.backend.wait(submission)?;
        }
        self.read(&output, size.pixels())
    }

    fn counted(
        &mut self,
        config: Config,
        view: &View,
        size: Size,
        band: &mut dyn FnMut(u32, &[CountedPixel]),
    ) -> Result<()> {
        let compiled = self.backend.compiled(self.kernel_of(Entry::Render { config, counting: true }))?;
        let mut bands = self.parts(size, 1, (size.pixels() as u32).div_ceil(BAND_PIXELS));
        // Each begins at the output's start
        bands.iter_mut().for_each(|(_, first_pixel)| *first_pixel = 0);
        let largest = bands.iter().map(|(tile, _)| tile.rows as usize * size.width as usize).max().unwrap_or(0);
        let bytes = (largest * size_of::<CountedPixel>()) as u64;
        let output = self.poisoned("the counters", bytes)?;
        // For the bands after the first, or they would find the one before
        let poison = if bands.len() > 1 { Some(self.poisoned("the poison", bytes)?) } else { None };
        let frames = self.frames(std::slice::from_ref(view), size, &bands)?;
        let bindings = self.render_bindings(&compiled, &frames, &output);
        for (index, &(Tile { row, rows, .. }, _)) in bands.iter().enumerate() {
            if let Some(poison) = poison.as_ref().filter(|_| index > 0) {
                let mut encoder = self.backend.device.create_command_encoder(&Default::default());
                encoder.copy_buffer_to_buffer(poison, 0, &output, 0, bytes);
                self.backend.queue.submit([encoder.finish()]);
            }
            self.submit(&compiled, &bindings, &frames, index, None);
            let pixels: Vec<CountedPixel> = self.read(&output, (rows * size.width) as usize)?;
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
        self.last_timed()
    }

    fn trace(&mut self, rays: &[GivenRay], any_hit: bool) -> Result<Vec<Hit>> {
        let compiled = self.backend.compiled(self.kernel_of(Entry::Trace { any_hit }))?;
        let mut hits = Vec::with_capacity(rays.len());
        for rays in rays.chunks(TRACE_RAYS) {
            let found = trace_units(rays, hits.len(), |rays| self.trace_chunk(&compiled, rays))?;
            hits.extend(found);
        }
        debug_assert!(hits.iter().all(|hit| hit.t <= T_MAX));
        Ok(hits)
    }

    fn kernel(&self, config: Config) -> Result<Option<KernelInfo>> {
        let kernel = self.kernel_of(Entry::Render { config, counting: false });
        let hash = kernel.assemble().map_err(Error::Device)?.hash();
        let fetch = if kernel.textures { "textures" } else { "buffers" };
        let checked = self.backend.options.checked || self.method.checked;
        Ok(Some(KernelInfo { hash, fetch: fetch.to_owned(), checked }))
    }

    fn allocated(&self) -> (u64, u64) {
        let lights = std::mem::size_of_val(self.scene.lights.as_slice()) as u64;
        (self.uploaded.geometry_bytes + lights, self.uploaded.structure_bytes)
    }
}
