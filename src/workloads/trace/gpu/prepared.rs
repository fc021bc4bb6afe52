//! A scene and a structure on a device with one traversal: images, counting, given rays. Timing is in [`super::path`].

use super::kernels::{DRIVER_TREE, Entry, Kernel, stack_size};
use super::path::LastFrame;
use super::rendering::{Part, entries_of, stages};
use super::upload::Uploaded;
use crate::camera::View;
use crate::device::VulkanDevice;
use crate::device::vulkan::{Bindings, Buffer, Pipeline, PipelineDescription, Resource};
use crate::error::{Error, Result};
use crate::math::{Hit, T_MAX};
use crate::record::row::Metric;
use crate::scene::Scene;
use crate::workloads::trace::backend::*;
use crate::workloads::trace::cpu::cannot_walk;
use crate::workloads::trace::{Method, Structure};
use std::collections::HashMap;
use std::sync::Arc;
use std::time::Duration;

/// Rays per dispatch of [`Prepared::cast`].
const TRACE_RAYS: usize = 1 << 20;

/// Invocations of a subgroup that trace a packet together.
const CLUSTER: u64 = 8;

pub(super) struct GpuPrepared<'a> {
    pub(super) device: &'a VulkanDevice,
    pub(super) scene: &'a Scene,
    pub(super) uploaded: Uploaded,
    pub(super) method: Method,
    stack_size: u32,
    pub(super) lengths: Lengths,
    /// Bands per frame that keep a dispatch below the watchdog, by configuration and size.
    pub(super) bands: HashMap<(Config, Size), u32>,
    /// The last frame of the path that was timed last.
    pub(super) last_frame: Option<LastFrame>,
}

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
        let smallest = device.info().limits.get("subgroup_min_size").copied().unwrap_or(0);
        if traversal.packets.is_some() && smallest < CLUSTER {
            return Err(Error::unsupported(format!(
                "{} needs subgroups of at least {CLUSTER} invocations, this device may take {smallest}",
                traversal.kernel
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
        let Uploaded { textures, .. } = self.uploaded;
        let leaf_order = self.uploaded.corners.is_some();
        Kernel { entry, method: self.method, stack_size: self.stack_size, software_threads, textures, leaf_order }
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

    /// Binds scene and structure, `first` as number 0, and the kernel's other buffers.
    pub(super) fn bind(&self, pipeline: &Pipeline, first: Resource, others: &[(u32, Resource)]) -> Bindings {
        let scene = &self.uploaded;
        let mut resources = vec![
            (0, first),
            (1, Resource::from(&scene.vertices)),
            (2, Resource::from(&scene.triangle_refs)),
            (6, Resource::from(&scene.nodes)),
            (7, Resource::from(&scene.structure)),
        ];
        resources.extend(scene.corners.as_ref().map(|corners| (13, Resource::from(corners))));
        let driver_tree = scene.driver_tree.as_ref();
        resources.extend(driver_tree.map(|tree| (DRIVER_TREE, Resource::AccelerationStructure(tree))));
        resources.extend(others);
        self.device.bind(pipeline, &resources)
    }

    /// The identity of a kernel.
    pub(super) fn kernel_info(&self, entry: Entry) -> Result<KernelInfo> {
        let kernel = self.kernel_of(entry);
        let hash = kernel.assemble().map_err(Error::Device)?.hash();
        let fetch = match (kernel.textures, kernel.leaf_order) {
            (false, false) => "buffers",
            (false, true) => "buffers+leaf-order",
            (true, false) => "textures",
            (true, true) => "textures+leaf-order",
        };
        let checked = self.device.options().checked || self.method.checked;
        Ok(KernelInfo { hash, fetch: fetch.to_owned(), checked })
    }

    /// A buffer for the timed kernel's image.
    pub(super) fn image_buffer(&self, size: Size) -> Result<Buffer> {
        self.device.poisoned("the image", (size.pixels() * size_of::<Pixel>()) as u64)
    }
}

impl Prepared for GpuPrepared<'_> {
    fn image(&mut self, config: Config, view: &View, size: Size) -> Result<Vec<Pixel>> {
        let pipelines = self.pipelines(config, false)?;
        let output = self.image_buffer(size)?;
        let tiles = self.method.tiles;
        let bands = self.parts(size, tiles, tiles.max((size.pixels() as u32).div_ceil(BAND_PIXELS)));
        let rendering = self.rendering(&pipelines, (std::slice::from_ref(view), size), &bands, &output)?;
        for frame in rendering.frames() {
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
        let pipelines = self.pipelines(config, true)?;
        let bands = self.parts(size, 1, (size.pixels() as u32).div_ceil(BAND_PIXELS));
        let largest = bands.iter().map(|(tile, _)| tile.rows as usize * size.width as usize).max().unwrap_or(0);
        let bytes = (largest * size_of::<CountedPixel>()) as u64;
        let output = self.device.poisoned("the counters", bytes)?;
        // Every band begins at the output's start and must not find the one before
        let poison = if bands.len() > 1 { Some(self.device.poisoned("the poison", bytes)?) } else { None };
        let parts: Vec<Part> = bands.iter().map(|&(tile, _)| (tile, 0)).collect();
        let rendering = self.rendering(&pipelines, (std::slice::from_ref(view), size), &parts, &output)?;
        for (frame, &(Tile { row, rows, .. }, _)) in rendering.parts().zip(&bands) {
            if let Some(poison) = poison.as_ref().filter(|_| row > 0) {
                self.device.copy(poison, &output);
            }
            self.device.run(&frame)?;
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

    fn cast(&mut self, rays: &[TraceRay], any_before: Option<f32>) -> Result<Vec<Hit>> {
        let mut hits = Vec::with_capacity(rays.len());
        for rays in rays.chunks(TRACE_RAYS) {
            hits.extend(self.cast_chunk(rays, any_before)?);
        }
        debug_assert!(hits.iter().all(|hit| hit.t <= T_MAX));
        Ok(hits)
    }

    fn kernels(&self, config: Config) -> Result<Vec<KernelInfo>> {
        entries_of(self.method, config, false).into_iter().map(|entry| self.kernel_info(entry)).collect()
    }

    fn stages(&self, config: Config) -> Vec<&'static str> {
        match self.device.info().timestamp_period_ns {
            Some(_) => stages(self.method, config).iter().map(|stage| stage.0).collect(),
            None => Vec::new(),
        }
    }

    fn artifact_metrics(&self) -> Vec<Metric> {
        let ms = |time: Duration| time.as_secs_f64() * 1e3;
        let driver_tree = self.uploaded.driver_tree.as_ref();
        let of_driver = driver_tree.map(|tree| Metric::new("driver_build_ms", ms(tree.build_time())));
        let leaf_order = Some(self.uploaded.leaf_order_bytes).filter(|&bytes| bytes > 0);
        let leaf_order = leaf_order.map(|bytes| Metric::new("leaf_order_bytes", bytes));
        let upload = Metric::new("upload_ms", ms(self.uploaded.structure_time));
        of_driver.into_iter().chain(leaf_order).chain([upload]).collect()
    }

    fn allocated(&self) -> (u64, u64) {
        let lights = std::mem::size_of_val(self.scene.lights.as_slice()) as u64;
        (self.uploaded.geometry_bytes + lights, self.uploaded.structure_bytes)
    }
}
