//! What kernels only read, scene and structure: as storage buffers or as textures whose texels are their words
//! (`kernels/trace/buffers.wgsl`, `kernels/trace/textures.wgsl`).

use crate::error::{Error, Result};
use crate::workloads::trace::Traversal;
use crate::workloads::trace::gpu::device::GpuBackend;
use crate::workloads::trace::gpu::kernels::TEXTURE_WIDTH;

/// One of a kernel's inputs.
pub(super) enum Words {
    Buffer(wgpu::Buffer),
    Texture(wgpu::TextureView),
}

impl Words {
    /// What is bound.
    pub fn binding(&self) -> wgpu::BindingResource<'_> {
        match self {
            Words::Buffer(buffer) => buffer.as_entire_binding(),
            Words::Texture(view) => wgpu::BindingResource::TextureView(view),
        }
    }

    /// How it is declared.
    pub fn layout(textures: bool, format: wgpu::TextureFormat) -> wgpu::BindingType {
        if textures {
            let access = wgpu::StorageTextureAccess::ReadOnly;
            return wgpu::BindingType::StorageTexture {
                access,
                format,
                view_dimension: wgpu::TextureViewDimension::D2,
            };
        }
        wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only: true },
            has_dynamic_offset: false,
            min_binding_size: None,
        }
    }
}

/// Texels of vertices, triangle references and a BVH's nodes.
pub(super) const FOUR_WORDS: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Uint;

/// Texels of what a traversal finds its way by: nodes, or cells.
pub(super) fn node_format(traversal: Traversal) -> wgpu::TextureFormat {
    match traversal {
        Traversal::Brute | Traversal::Bvh(_) | Traversal::BvhStack => FOUR_WORDS,
        Traversal::Grid | Traversal::GridCoop | Traversal::GridPacket | Traversal::KdTree(_) => {
            wgpu::TextureFormat::Rg32Uint
        }
    }
}

fn texel_bytes(format: wgpu::TextureFormat) -> usize {
    format.block_copy_size(None).unwrap_or(16) as usize
}

impl GpuBackend {
    /// True if a texture can hold it.
    pub(super) fn fits_texture(&self, contents: &[u8], format: wgpu::TextureFormat) -> bool {
        let texels = contents.len().div_ceil(texel_bytes(format));
        texels.div_ceil(TEXTURE_WIDTH as usize) <= self.limits.max_texture_dimension_2d as usize
    }

    /// Uploads one of a kernel's inputs, as a texture if asked to.
    ///
    /// # Errors
    /// [`Error::Device`] if this device cannot hold it.
    pub(super) fn words(
        &self,
        what: &str,
        contents: &[u8],
        format: wgpu::TextureFormat,
        textures: bool,
    ) -> Result<Words> {
        if !textures {
            return Ok(Words::Buffer(self.storage(what, contents)?));
        }
        if !self.fits_texture(contents, format) {
            let rows = self.limits.max_texture_dimension_2d;
            let problem = format!(
                "{what} need more than the {rows} rows of a texture on this device (use fetch=buffers, or a smaller scene)"
            );
            return Err(Error::Device(problem));
        }
        let texel = texel_bytes(format);
        let row = TEXTURE_WIDTH as usize * texel;
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
            format,
            usage: wgpu::TextureUsages::STORAGE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        // Whole rows, then what is left of the last one
        let (rows, rest) = contents.split_at(contents.len() / row * row);
        for (part, y, size) in [
            (rows, 0, extent(TEXTURE_WIDTH as usize, rows.len() / row)),
            (rest, rows.len() / row, extent(rest.len() / texel, 1)),
        ] {
            if part.is_empty() {
                continue;
            }
            let origin = wgpu::Origin3d { x: 0, y: y as u32, z: 0 };
            let place = wgpu::TexelCopyTextureInfo { origin, ..texture.as_image_copy() };
            let layout =
                wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row as u32), rows_per_image: None };
            self.queue.write_texture(place, part, layout, size);
        }
        self.check()?;
        Ok(Words::Texture(texture.create_view(&wgpu::TextureViewDescriptor::default())))
    }
}
