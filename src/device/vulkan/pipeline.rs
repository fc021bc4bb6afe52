//! Compiled kernels and what is bound to them.

use super::acceleration::AccelerationStructure;
use super::binding::{Binding, BindingKind, Pipeline};
use super::buffers::Buffer;
use super::device::VulkanDevice;
use super::read_buffer::ReadBuffer;
use crate::device::lock;
use crate::error::{Error, Result};
use std::sync::Arc;

/// What a kernel is compiled from.
#[derive(Clone, Copy, Debug)]
pub struct PipelineDescription<'a> {
    /// A name for the driver's messages.
    pub label: &'a str,
    /// WGSL with the entry point `main`. Without checks it must index only within its buffers, its loops must end, and
    /// it must divide integers by no zero.
    pub text: &'a str,
    /// Everything that `main` uses; more may be declared here.
    pub layout: &'a [Binding],
    /// Compile with wgpu's bounds checks and loop bounds, even if the device does not ask for them.
    pub checked: bool,
    /// Work-group memory begins as zero. Clearing it would be measured with every group where nothing relies on it.
    pub zero_workgroup_memory: bool,
}

/// Resources bound to a kernel.
pub struct Bindings(pub(super) wgpu::BindGroup);

/// What is bound.
#[derive(Clone, Copy)]
pub enum Resource<'a> {
    /// A whole buffer.
    Buffer(&'a Buffer),
    /// The first bytes of a buffer, which each dispatch moves by its offset.
    Window(&'a Buffer, u64),
    /// Input in a buffer or a texture.
    Read(&'a ReadBuffer),
    /// The driver's structure.
    AccelerationStructure(&'a AccelerationStructure),
}

impl<'a> From<&'a Buffer> for Resource<'a> {
    fn from(buffer: &'a Buffer) -> Self {
        Resource::Buffer(buffer)
    }
}

impl<'a> From<&'a ReadBuffer> for Resource<'a> {
    fn from(buffer: &'a ReadBuffer) -> Self {
        Resource::Read(buffer)
    }
}

impl VulkanDevice {
    /// The compiled form of a kernel; it is compiled the first time only.
    ///
    /// # Errors
    /// [`Error::Device`] with the driver's message, [`Error::Refused`] for more storage buffers than the device has.
    pub fn pipeline(&self, description: &PipelineDescription) -> Result<Arc<Pipeline>> {
        let &PipelineDescription { label, text, layout, checked, zero_workgroup_memory } = description;
        let is_storage = |binding: &&Binding| matches!(binding.kind, BindingKind::Read | BindingKind::ReadWrite);
        let (need, limit) =
            (layout.iter().filter(is_storage).count(), self.limits.max_storage_buffers_per_shader_stage);
        if need > limit as usize {
            return Err(Error::unsupported(format!("a kernel with {need} storage buffers, this device has {limit}")));
        }
        let checked = checked || self.options().checked;
        let identity = blake3::hash(format!("{checked} {zero_workgroup_memory} {layout:?}\n{text}").as_bytes());
        if let Some(done) = lock(&self.pipelines).get(&identity) {
            return Ok(done.clone());
        }
        let source = wgpu::ShaderSource::Wgsl(text.into());
        let descriptor = wgpu::ShaderModuleDescriptor { label: Some(label), source };
        let checks = match checked {
            true => wgpu::ShaderRuntimeChecks::checked(),
            false => wgpu::ShaderRuntimeChecks::unchecked(),
        };
        // SAFETY: kernels are compiled into the program, not given by a user. They index only buffers whose contents
        // this crate has built and validated, their loops end (every structure is finite, and each step makes
        // progress), and they divide integers by constants alone. `--checked` runs the same kernels with the checks on.
        #[allow(unsafe_code)]
        let module = unsafe { self.device.create_shader_module_trusted(descriptor, checks) };
        let entries: Vec<_> = layout.iter().map(|binding| binding.entry()).collect();
        let layout =
            self.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries });
        let pipeline_layout = self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let pipeline = self.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(label),
            layout: Some(&pipeline_layout),
            module: &module,
            entry_point: Some("main"),
            compilation_options: wgpu::PipelineCompilationOptions {
                zero_initialize_workgroup_memory: zero_workgroup_memory,
                ..Default::default()
            },
            cache: None,
        });
        self.check()?;
        let pipeline = Arc::new(Pipeline { pipeline, layout });
        lock(&self.pipelines).insert(identity, pipeline.clone());
        Ok(pipeline)
    }

    /// Binds resources to a kernel, one for each binding of its layout. What does not fit is reported by the next
    /// [`VulkanDevice::check`].
    pub fn bind(&self, pipeline: &Pipeline, resources: &[(u32, Resource)]) -> Bindings {
        let entries: Vec<_> = resources
            .iter()
            .map(|&(binding, resource)| {
                let resource = match resource {
                    Resource::Buffer(buffer) => buffer.buffer.as_entire_binding(),
                    Resource::Window(buffer, bytes) => wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                        buffer: &buffer.buffer,
                        offset: 0,
                        size: wgpu::BufferSize::new(bytes),
                    }),
                    Resource::Read(buffer) => buffer.binding(),
                    Resource::AccelerationStructure(structure) => structure.tlas.as_binding(),
                };
                wgpu::BindGroupEntry { binding, resource }
            })
            .collect();
        let layout = &pipeline.layout;
        Bindings(self.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries }))
    }
}
