//! Acceleration structures of the driver, for ray queries.

use super::buffers::Buffer;
use super::device::VulkanDevice;
use crate::error::{Error, Result};
use bytemuck::NoUninit;
use std::time::{Duration, Instant};

/// An acceleration structure over the triangles of one mesh.
pub struct AccelerationStructure {
    pub(super) tlas: wgpu::Tlas,
    build_time: Duration,
}

/// Bytes of a position in the input.
const STRIDE: u64 = 12;

impl AccelerationStructure {
    /// From the submission of the build to its end, uploads excluded.
    pub fn build_time(&self) -> Duration {
        self.build_time
    }
}

impl VulkanDevice {
    /// Builds an acceleration structure over triangles, three indices each, of a device with
    /// [`crate::device::Feature::RayQuery`]. Ray queries name triangles by their place among the indices.
    ///
    /// # Errors
    /// [`Error::Refused`] for more triangles than the device allows, and the device's.
    pub fn acceleration_structure(
        &self,
        what: &str,
        positions: &[[f32; 3]],
        indices: &[[u32; 3]],
    ) -> Result<AccelerationStructure> {
        let most = self.limits.max_blas_primitive_count as usize;
        if indices.len() > most {
            let need = format!("{} triangles are more than this device's {most}", indices.len());
            return Err(Error::too_large(what, need, "use a smaller scene, or another device"));
        }
        let vertices = self.build_input(what, positions)?;
        let index_buffer = self.build_input(what, indices)?;
        let flags = wgpu::AccelerationStructureFlags::PREFER_FAST_TRACE;
        let update_mode = wgpu::AccelerationStructureUpdateMode::Build;
        let size = wgpu::BlasTriangleGeometrySizeDescriptor {
            vertex_format: wgpu::VertexFormat::Float32x3,
            vertex_count: positions.len() as u32,
            index_format: Some(wgpu::IndexFormat::Uint32),
            index_count: Some(3 * indices.len() as u32),
            flags: wgpu::AccelerationStructureGeometryFlags::OPAQUE,
        };
        let blas = self.device.create_blas(
            &wgpu::CreateBlasDescriptor { label: Some(what), flags, update_mode },
            wgpu::BlasGeometrySizeDescriptors::Triangles { descriptors: vec![size.clone()] },
        );
        let mut tlas = self.device.create_tlas(&wgpu::CreateTlasDescriptor {
            label: Some(what),
            max_instances: 1,
            flags,
            update_mode,
        });
        let geometry = wgpu::BlasTriangleGeometry {
            size: &size,
            vertex_buffer: &vertices.buffer,
            first_vertex: 0,
            vertex_stride: STRIDE,
            index_buffer: Some(&index_buffer.buffer),
            first_index: Some(0),
            transform_buffer: None,
            transform_buffer_offset: None,
        };
        let entry =
            wgpu::BlasBuildEntry { blas: &blas, geometry: wgpu::BlasGeometries::TriangleGeometries(vec![geometry]) };
        // An empty mesh has no instance: nothing is hit
        let is_empty = indices.is_empty();
        if !is_empty {
            tlas[0] = Some(wgpu::TlasInstance::new(&blas, IDENTITY, 0, 0xff));
        }
        self.check()?;
        let uploads = self.queue.submit([]);
        self.wait(uploads)?;
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.build_acceleration_structures((!is_empty).then_some(&entry), [&tlas]);
        let start = Instant::now();
        let submission = self.queue.submit([encoder.finish()]);
        self.wait(submission)?;
        Ok(AccelerationStructure { tlas, build_time: start.elapsed() })
    }

    fn build_input<T: NoUninit>(&self, what: &str, contents: &[T]) -> Result<Buffer> {
        self.filled(what, bytemuck::cast_slice(contents), wgpu::BufferUsages::BLAS_INPUT)
    }
}

/// Rows of an affine transformation that changes nothing.
const IDENTITY: [f32; 12] = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0];
