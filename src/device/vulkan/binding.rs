//! What a kernel declares, and what it is when it is compiled.

/// Texels of textures that are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Texel {
    /// Two words, `rg32uint`.
    Bytes8,
    /// Four words, `rgba32uint`.
    Bytes16,
}

impl Texel {
    pub(super) fn bytes(self) -> usize {
        match self {
            Texel::Bytes8 => 8,
            Texel::Bytes16 => 16,
        }
    }

    pub(super) fn format(self) -> wgpu::TextureFormat {
        match self {
            Texel::Bytes8 => wgpu::TextureFormat::Rg32Uint,
            Texel::Bytes16 => wgpu::TextureFormat::Rgba32Uint,
        }
    }
}

/// What a kernel declares at a binding of group 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BindingKind {
    /// `var<uniform>`.
    Uniform,
    /// `var<uniform>`, a window of a larger buffer that each dispatch moves ([`super::Dispatch::offset`]). A kernel has
    /// at most one.
    MovingUniform,
    /// `var<storage, read>`.
    Read,
    /// `var<storage, read_write>`.
    ReadWrite,
    /// A storage texture that is read, see [`super::ReadBuffer`].
    Texture(Texel),
    /// `acceleration_structure`.
    AccelerationStructure,
}

/// A binding of a kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Binding {
    /// The number in `@binding(N)`.
    pub number: u32,
    /// What is declared there.
    pub kind: BindingKind,
}

impl Binding {
    /// A binding of this number and kind.
    pub const fn new(number: u32, kind: BindingKind) -> Binding {
        Binding { number, kind }
    }

    pub(super) fn entry(self) -> wgpu::BindGroupLayoutEntry {
        let buffer =
            |ty, has_dynamic_offset| wgpu::BindingType::Buffer { ty, has_dynamic_offset, min_binding_size: None };
        let ty = match self.kind {
            BindingKind::Uniform => buffer(wgpu::BufferBindingType::Uniform, false),
            BindingKind::MovingUniform => buffer(wgpu::BufferBindingType::Uniform, true),
            BindingKind::Read => buffer(wgpu::BufferBindingType::Storage { read_only: true }, false),
            BindingKind::ReadWrite => buffer(wgpu::BufferBindingType::Storage { read_only: false }, false),
            BindingKind::Texture(texel) => wgpu::BindingType::StorageTexture {
                access: wgpu::StorageTextureAccess::ReadOnly,
                format: texel.format(),
                view_dimension: wgpu::TextureViewDimension::D2,
            },
            BindingKind::AccelerationStructure => wgpu::BindingType::AccelerationStructure { vertex_return: false },
        };
        wgpu::BindGroupLayoutEntry { binding: self.number, visibility: wgpu::ShaderStages::COMPUTE, ty, count: None }
    }
}

/// A compiled kernel.
pub struct Pipeline {
    pub(super) pipeline: wgpu::ComputePipeline,
    pub(super) layout: wgpu::BindGroupLayout,
}
