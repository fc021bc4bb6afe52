//! Rays that lie in a buffer are cast by a pass of another workload's frame.

use super::kernels::Entry;
use super::prepared::GpuPrepared;
use super::shared::CastJob;
use crate::device::vulkan::{Bindings, Buffer, Dispatch, Groups, Pipeline, Resource};
use crate::device::{Frame, KernelInfo, Pass, Stage, VulkanDevice};
use crate::error::Result;
use crate::math::{Hit, T_MAX};
use crate::scene::Scene;
use crate::workloads::trace::backend::TraceRay;
use crate::workloads::trace::{Method, Structure};
use std::sync::Arc;

/// A scene and a structure on a device, for workloads that have rays of their own.
pub struct RayCaster<'a>(GpuPrepared<'a>);

/// A pass that casts the rays of one buffer into hits in another one.
pub struct Cast {
    pipeline: Arc<Pipeline>,
    bindings: Bindings,
    groups: (u32, u32),
}

/// Bytes of a hit: distance, and triangle of the scene.
pub const HIT_BYTES: u64 = 8;

impl<'a> RayCaster<'a> {
    /// Uploads scene and structure.
    ///
    /// # Errors
    /// [`crate::Error::Refused`] where the device cannot hold or walk it, and the device's.
    pub fn new(
        device: &'a VulkanDevice,
        scene: &'a Scene,
        structure: &'a dyn Structure,
        method: Method,
    ) -> Result<RayCaster<'a>> {
        GpuPrepared::new(device, scene, structure, method).map(RayCaster)
    }

    /// Makes a pass over `count` rays ([`TraceRay`]) that writes as many hits of [`HIT_BYTES`]: the nearest ones, or
    /// with a limit whether anything is hit before that distance. A ray that hits nothing has the triangle
    /// [`crate::math::MISS`].
    ///
    /// # Errors
    /// The device's.
    pub fn cast(&self, rays: &Buffer, hits: &Buffer, count: u32, any_before: Option<f32>) -> Result<Cast> {
        self.0.cast_of(rays, hits, count, any_before)
    }

    /// The kernel of such a pass.
    ///
    /// # Errors
    /// [`crate::Error::Device`] for a kernel that cannot be assembled.
    pub fn kernel(&self, any_hit: bool) -> Result<KernelInfo> {
        self.0.kernel_info(Entry::Trace { any_hit })
    }

    /// Bytes of vertices and materials, and of the structure.
    pub fn allocated(&self) -> (u64, u64) {
        (self.0.uploaded.geometry_bytes, self.0.uploaded.structure_bytes)
    }
}

impl Cast {
    /// The work of the pass.
    pub fn dispatch(&self) -> Dispatch<'_> {
        let (x, y) = self.groups;
        Dispatch { pipeline: &self.pipeline, bindings: &self.bindings, offset: None, groups: Groups::Fixed(x, y, 1) }
    }
}

impl GpuPrepared<'_> {
    fn cast_of(&self, rays: &Buffer, hits: &Buffer, count: u32, any_before: Option<f32>) -> Result<Cast> {
        let pipeline = self.compiled(Entry::Trace { any_hit: any_before.is_some() })?;
        let groups = self.device.groups_for(count.into(), self.method.group.size())?;
        let limit = any_before.unwrap_or(T_MAX);
        let job = CastJob { rays: count, row_groups: groups.0, limit, pad: 0 };
        let job = self.device.uniform("the job", &[job])?;
        let bindings = self.bind(&pipeline, Resource::from(&job), &[(3, rays.into()), (8, hits.into())]);
        Ok(Cast { pipeline, bindings, groups })
    }

    /// Casts as many rays as a dispatch takes.
    pub(super) fn cast_chunk(&self, rays: &[TraceRay], any_before: Option<f32>) -> Result<Vec<Hit>> {
        let input = self.device.storage("the given rays", rays)?;
        let output = self.device.poisoned("the hits", rays.len() as u64 * HIT_BYTES)?;
        let cast = self.cast_of(&input, &output, rays.len() as u32, any_before)?;
        self.device.run(&Frame::new(vec![Pass { stage: Stage("trace"), work: cast.dispatch() }]))?;
        let found: Vec<[u32; 2]> = self.device.read(&output, rays.len())?;
        Ok(found.iter().map(|&[t, triangle]| Hit { t: f32::from_bits(t), triangle }).collect())
    }
}
