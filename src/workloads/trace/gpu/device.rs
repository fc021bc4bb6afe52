//! An opened device: kernels compiled once, errors caught, nothing panics.

use crate::error::{Error, Result};
use crate::scene::Scene;
use crate::workloads::trace::backend::{Backend, DeviceInfo, DeviceType, Prepared};
use crate::workloads::trace::gpu::adapters::{Selector, choose, describe, enumerate, wanted_features};
use crate::workloads::trace::gpu::kernels::{Entry, Kernel};
use crate::workloads::trace::gpu::prepared::GpuPrepared;
use crate::workloads::trace::gpu::words::{FOUR_WORDS, Words, node_format};
use crate::workloads::trace::{Method, Structure};
use std::collections::HashMap;
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// How kernels are compiled and dispatched.
#[derive(Clone, Copy, Debug)]
pub struct GpuOptions {
    /// Compile kernels with wgpu's bounds checks and loop bounds.
    pub checked: bool,
    /// Frames that would take longer in one dispatch are split into bands of rows, so that no driver's watchdog kills
    /// them. Does not apply to software rasterisers, which have none.
    pub max_dispatch: Duration,
    /// A submission that takes longer counts as a lost device.
    pub timeout: Duration,
}

impl Default for GpuOptions {
    fn default() -> Self {
        GpuOptions { checked: false, max_dispatch: Duration::from_millis(500), timeout: Duration::from_secs(300) }
    }
}

/// What the driver reported since the last look.
#[derive(Default)]
struct Trouble {
    error: Option<String>,
    lost: Option<String>,
}

/// A compiled kernel and the layout of its bindings.
pub(super) struct Compiled {
    pub pipeline: wgpu::ComputePipeline,
    pub bindings: wgpu::BindGroupLayout,
}

/// An opened Vulkan device.
pub struct GpuBackend {
    pub(super) device: wgpu::Device,
    pub(super) queue: wgpu::Queue,
    pub(super) limits: wgpu::Limits,
    pub(super) options: GpuOptions,
    info: DeviceInfo,
    compiled: Mutex<HashMap<Kernel, Arc<Compiled>>>,
    trouble: Arc<Mutex<Trouble>>,
}

impl GpuBackend {
    /// Opens the selected adapter with all its limits.
    ///
    /// # Errors
    /// [`Error::Input`] if there is no such adapter, [`Error::Device`] if it cannot be opened.
    pub fn open(selector: &Selector, options: GpuOptions) -> Result<GpuBackend> {
        let adapters = enumerate();
        let infos: Vec<_> = adapters.iter().map(describe).collect();
        let index = choose(&infos, selector)?;
        let adapter = &adapters[index];
        let features = wanted_features(adapter);
        let limits = adapter.limits();
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("rtbench"),
            required_features: features,
            required_limits: limits.clone(),
            memory_hints: wgpu::MemoryHints::Performance,
            ..Default::default()
        }))
        .map_err(|e| Error::Device(format!("cannot open {}: {e}", infos[index].name)))?;

        let trouble = Arc::new(Mutex::new(Trouble::default()));
        let seen = trouble.clone();
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            lock(&seen).error.get_or_insert(one_line(&error.to_string()));
        }));
        let seen = trouble.clone();
        device.set_device_lost_callback(move |reason, message| {
            lock(&seen).lost.get_or_insert(one_line(&format!("{reason:?} {message}")));
        });

        let mut info = infos[index].clone();
        info.checked = options.checked;
        if features.contains(wgpu::Features::TIMESTAMP_QUERY) {
            info.timestamp_period_ns = Some(queue.get_timestamp_period());
        }
        Ok(GpuBackend { device, queue, limits, options, info, compiled: Default::default(), trouble })
    }

    /// Ends the device as a crashing driver would: everything after it reports a lost device. For tests.
    pub fn destroy(&self) {
        self.device.destroy();
        lock(&self.trouble).lost.get_or_insert("destroyed".into());
    }

    /// Threads of a driver that computes on the CPU; 0 for a GPU.
    pub(super) fn software_threads(&self) -> u32 {
        match self.info.device_type {
            DeviceType::SoftwareRasteriser => self.info.threads.unwrap_or(1) as u32,
            _ => 0,
        }
    }

    /// Turns what the driver has reported meanwhile into an error.
    pub(super) fn check(&self) -> Result<()> {
        let mut trouble = lock(&self.trouble);
        if let Some(lost) = &trouble.lost {
            return Err(Error::DeviceLost(lost.clone()));
        }
        match trouble.error.take() {
            Some(error) => Err(Error::Device(error)),
            None => Ok(()),
        }
    }

    /// Waits for a submission.
    pub(super) fn wait(&self, submission: wgpu::SubmissionIndex) -> Result<()> {
        let wait = wgpu::PollType::Wait { submission_index: Some(submission), timeout: Some(self.options.timeout) };
        if let Err(error) = self.device.poll(wait) {
            self.check()?;
            let seconds = self.options.timeout.as_secs();
            let problem = format!("a kernel did not finish within {seconds} s: {error}");
            lock(&self.trouble).lost.get_or_insert(problem.clone());
            // The last handle to a device waits, for however long, until the device is idle: let it never be dropped
            std::mem::forget((self.device.clone(), self.queue.clone()));
            return Err(Error::DeviceLost(problem));
        }
        self.check()
    }

    /// The compiled form of a kernel; compiles it the first time.
    pub(super) fn compiled(&self, kernel: Kernel) -> Result<Arc<Compiled>> {
        if let Some(done) = lock(&self.compiled).get(&kernel) {
            return Ok(done.clone());
        }
        let source = kernel.assemble().map_err(Error::Device)?;
        let descriptor = wgpu::ShaderModuleDescriptor {
            label: Some(&kernel.label()),
            source: wgpu::ShaderSource::Wgsl(source.text.as_str().into()),
        };
        let checks = match self.options.checked || kernel.method.checked {
            true => wgpu::ShaderRuntimeChecks::checked(),
            false => wgpu::ShaderRuntimeChecks::unchecked(),
        };
        // SAFETY: the kernels are ours, not a user's. They index only buffers whose contents this crate has built and
        // validated, their loops end (every structure is finite, and each step moves on along the ray), and they
        // divide integers by constants alone. `--checked` runs the same kernels with the checks on.
        #[allow(unsafe_code)]
        let module = unsafe { self.device.create_shader_module_trusted(descriptor, checks) };
        let bindings = self.bindings(kernel);
        let layout = self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[Some(&bindings)],
            immediate_size: 0,
        });
        let pipeline = self.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(&kernel.label()),
            layout: Some(&layout),
            module: &module,
            entry_point: Some("main"),
            compilation_options: wgpu::PipelineCompilationOptions {
                // Only the tallies of packets rely on work-group memory that begins as zero; clearing the short stack
                // would be measured with every group.
                zero_initialize_workgroup_memory: kernel.method.traversal.is_cooperative(),
                ..Default::default()
            },
            cache: None,
        });
        self.check()?;
        let compiled = Arc::new(Compiled { pipeline, bindings });
        lock(&self.compiled).insert(kernel, compiled.clone());
        Ok(compiled)
    }

    /// Bindings of an entry file; those that a traversal does not use are bound all the same.
    fn bindings(&self, kernel: Kernel) -> wgpu::BindGroupLayout {
        let entry = |binding, ty, dynamic| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer { ty, has_dynamic_offset: dynamic, min_binding_size: None },
            count: None,
        };
        let words = |binding, format| wgpu::BindGroupLayoutEntry {
            ty: Words::layout(kernel.textures, format),
            ..entry(binding, wgpu::BufferBindingType::Uniform, false)
        };
        let read = wgpu::BufferBindingType::Storage { read_only: true };
        let write = wgpu::BufferBindingType::Storage { read_only: false };
        let uniform = wgpu::BufferBindingType::Uniform;
        let mut entries = vec![
            entry(0, uniform, matches!(kernel.entry, Entry::Render { .. })),
            words(1, FOUR_WORDS),
            words(2, FOUR_WORDS),
            entry(3, read, false),
            words(6, node_format(kernel.method.traversal)),
            entry(7, uniform, false),
            entry(8, write, false),
        ];
        if matches!(kernel.entry, Entry::Render { .. }) {
            entries.extend([entry(4, read, false), entry(5, read, false)]);
        }
        self.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries })
    }
}

impl Backend for GpuBackend {
    fn info(&self) -> &DeviceInfo {
        &self.info
    }

    fn prepare<'a>(
        &'a self,
        scene: &'a Scene,
        structure: &'a Structure,
        method: Method,
    ) -> Result<Box<dyn Prepared + 'a>> {
        Ok(Box::new(GpuPrepared::new(self, scene, structure, method)?))
    }
}

/// A poisoned lock only means that some thread panicked while it held plain data.
fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

/// wgpu's errors are paragraphs; a row's message is a line.
fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
