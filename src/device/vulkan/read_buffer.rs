//! Input that kernels only read: a storage buffer, or a texture whose texels are its words, row by row. Software
//! drivers read a texel of four words by one vector load, a storage buffer word by word.

use super::binding::{BindingKind, Texel};
use super::buffers::Buffer;
use super::device::VulkanDevice;
use crate::error::{Error, Result};

/// Texels in a row of a texture. Every device allows this many.
pub const TEXTURE_WIDTH: u32 = 4096;

/// Input of a kernel.
pub enum ReadBuffer {
    /// In a storage buffer.
    Buffer(Buffer),
    /// In a texture.
    Texture(Texture),
}

/// A texture that holds words.
pub struct Texture(wgpu::TextureView);

impl ReadBuffer {
    /// The declaration of such an input.
    pub fn kind(textures: bool, texel: Texel) -> BindingKind {
        if textures { BindingKind::Texture(texel) } else { BindingKind::Read }
    }

    pub(super) fn binding(&self) -> wgpu::BindingResource<'_> {
        match self {
            ReadBuffer::Buffer(buffer) => buffer.buffer.as_entire_binding(),
            ReadBuffer::Texture(Texture(view)) => wgpu::BindingResource::TextureView(view),
        }
    }
}

impl VulkanDevice {
    /// True if a texture can hold as many bytes.
    pub fn fits_texture(&self, bytes: usize, texel: Texel) -> bool {
        let texels = bytes.div_ceil(texel.bytes());
        texels.div_ceil(TEXTURE_WIDTH as usize) <= self.limits.max_texture_dimension_2d as usize
    }

    /// Refuses what no texture can hold; `hint` says what helps.
    ///
    /// # Errors
    /// [`Error::Refused`].
    pub fn check_texture(&self, what: &str, bytes: usize, texel: Texel, hint: &str) -> Result<()> {
        if self.fits_texture(bytes, texel) {
            return Ok(());
        }
        let rows = self.limits.max_texture_dimension_2d;
        Err(Error::too_large(what, format!("a texture on this device has {rows} rows, and more are needed"), hint))
    }

    /// Uploads words into a texture. Their number is a multiple of a texel's.
    ///
    /// # Errors
    /// [`Error::Device`] if this device cannot hold them.
    pub fn texture(&self, what: &str, contents: &[u8], texel: Texel) -> Result<Texture> {
        self.check_texture(what, contents.len(), texel, "use a smaller input, or a buffer")?;
        let row = TEXTURE_WIDTH as usize * texel.bytes();
        let extent = |width: usize, height: usize| wgpu::Extent3d {
            width: width as u32,
            height: height as u32,
            depth_or_array_layers: 1,
        };
        let texture = self.device.create_texture(&wgpu::TextureDescriptor {
            label: Some(what),
            size: extent(TEXTURE_WIDTH as usize, contents.len().div_ceil(row).max(1)),
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: texel.format(),
            usage: wgpu::TextureUsages::STORAGE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        // Whole rows, then what is left of the last one
        let (rows, rest) = contents.split_at(contents.len() / row * row);
        for (part, y, size) in [
            (rows, 0, extent(TEXTURE_WIDTH as usize, rows.len() / row)),
            (rest, rows.len() / row, extent(rest.len() / texel.bytes(), 1)),
        ] {
            if part.is_empty() {
                continue;
            }
            let origin = wgpu::Origin3d { x: 0, y: y as u32, z: 0 };
            let target = wgpu::TexelCopyTextureInfo { origin, ..texture.as_image_copy() };
            let layout =
                wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row as u32), rows_per_image: None };
            self.queue.write_texture(target, part, layout, size);
        }
        self.check()?;
        Ok(Texture(texture.create_view(&wgpu::TextureViewDescriptor::default())))
    }
}
