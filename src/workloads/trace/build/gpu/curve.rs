//! The Morton curve on a device: codes, and the sort.

use super::BuildTimes;
use super::kernels::{GROUP_SIZE, Kernel, WORKER_GROUP};
use super::passes::{Job, Passes};
use crate::device::vulkan::{Buffer, Resource};
use crate::device::{Stage, VulkanDevice};
use crate::error::{Error, Result};
use crate::math::Aabb;
use crate::scene::Scene;
use crate::workloads::scan::{self, Scan};
use crate::workloads::trace::build::codes::Cells;
use crate::workloads::trace::bvh::{Bvh, BvhNode};
use crate::workloads::trace::common::prims::{self, CHUNK, Prim};
use glam::Vec3;
use rayon::prelude::*;

const CODES: Stage = Stage("codes");
const SORT: Stage = Stage("sort");

/// Bits of a Morton code.
const CODE_BITS: u32 = 30;

/// Bits of a digit that is sorted by on a software driver: few passes.
const SOFTWARE_BITS: u32 = 10;

/// Bits of a digit that is sorted by on a GPU: few counters.
pub(super) const GPU_BITS: u32 = 6;

/// Most elements of a chunk: a loop of a software driver ends after 65,535 iterations.
const LONGEST_CHUNK: u32 = 32_768;

/// How the work is shared out on a device. It changes no byte of a tree.
#[derive(Clone, Copy)]
pub(super) struct Shape {
    /// Most work-groups of a pass.
    groups: u32,
    /// Least invocations that take chunks.
    workers: u32,
    /// Bits of a digit.
    bits: u32,
}

impl Shape {
    pub fn of(device: &VulkanDevice) -> Shape {
        match device.info().software_threads() {
            0 => Shape { groups: 1024, workers: 16_384, bits: GPU_BITS },
            threads => Shape { groups: 16 * threads, workers: 64 * threads, bits: SOFTWARE_BITS },
        }
    }

    pub fn groups(&self, count: u32) -> u32 {
        count.div_ceil(GROUP_SIZE).min(self.groups)
    }

    /// Work-groups of a pass whose workers take chunks of `count` elements, and its job.
    pub fn in_chunks(&self, count: u32) -> (u32, Job) {
        let workers = self.workers.min(count).max(count.div_ceil(LONGEST_CHUNK));
        (workers.div_ceil(WORKER_GROUP), Job { count, workers, chunk: count.div_ceil(workers), ..Job::default() })
    }

    /// Work-groups of a pass over `count` elements, and its job.
    pub fn over(&self, count: u32) -> (u32, Job) {
        let groups = self.groups(count);
        (groups, Job { count, stride: groups * GROUP_SIZE, ..Job::default() })
    }
}

/// A scene on a device, its triangles along the Morton curve.
pub(super) struct Curve<'d> {
    pub device: &'d VulkanDevice,
    pub shape: Shape,
    pub count: u32,
    /// Three vertices a triangle.
    pub indices: Buffer,
    /// Three floats a vertex.
    pub positions: Buffer,
    pub keys: Buffer,
    pub order: Buffer,
}

impl<'d> Curve<'d> {
    /// Uploads triangles and adds the passes that sort them.
    pub fn new(
        passes: &mut Passes,
        device: &'d VulkanDevice,
        scene: &Scene,
        (prims, bounds): (&[Prim], &Aabb),
        times: &mut BuildTimes,
    ) -> Result<Curve<'d>> {
        let (shape, count) = (Shape::of(device), prims.len() as u32);
        let bytes = u64::from(count) * 4;
        let ((indices, positions), upload) = device.time_upload(|| {
            let vertices = |prim: &Prim| scene.triangles[prim.triangle() as usize].vertices;
            let indices: Vec<[u32; 3]> = prims.par_iter().with_min_len(CHUNK).map(vertices).collect();
            let positions: Vec<Vec3> = scene.vertices.iter().map(|vertex| vertex.position).collect();
            Ok((device.storage("the triangles", &indices)?, device.storage("the positions", &positions)?))
        })?;
        times.upload_ms = upload.as_secs_f64() * 1e3;
        let words = |what: &str| device.zeroed(what, bytes);
        let pairs = [(words("the keys")?, words("the order")?), (words("the keys")?, words("the order")?)];
        let Cells { lo, scale } = Cells::of(bounds);
        let (groups, job) = shape.over(count);
        let job = Job { lo, scale, ..job };
        passes.add(CODES, Kernel::Codes, groups, job, &[&indices, &positions, &pairs[0].0].map(Resource::from))?;

        let (groups, chunks) = shape.in_chunks(count);
        let workers = chunks.workers;
        let bits = shape.bits;
        let table = device.zeroed("the counters of digits", (u64::from(workers) << bits) * 4)?;
        let mut from = 0;
        for shift in (0..CODE_BITS).step_by(bits as usize) {
            let job = Job { shift, ..chunks };
            let ((keys, order), (sorted_keys, sorted)) = (&pairs[from], &pairs[1 - from]);
            passes.add(SORT, Kernel::Count { bits }, groups, job, &[keys, &table].map(Resource::from))?;
            passes.scan(SORT, Scan::in_place(device, scan::Options::default(), &table, workers << bits)?);
            let is_first = shift == 0;
            let bound = [keys, &table, sorted_keys, sorted, order].map(Resource::from);
            let bound = if is_first { &bound[..4] } else { &bound };
            passes.add(SORT, Kernel::Scatter { bits, is_first }, groups, job, bound)?;
            from = 1 - from;
        }
        let (keys, order) = pairs[from].clone();
        Ok(Curve { device, shape, count, indices, positions, keys, order })
    }

    /// The tree with the triangle references of its leaves, whose triangles `sorted` has in order.
    pub fn tree(
        &self,
        scene: &Scene,
        prims: &[Prim],
        bounds: Aabb,
        sorted: &Buffer,
        mut nodes: Vec<BvhNode>,
        depth: u32,
    ) -> Result<Bvh> {
        nodes[1] = BvhNode::NONE;
        let order: Vec<u32> = self.device.read(sorted, self.count as usize)?;
        let prim = |&i: &u32| prims.get(i as usize).copied();
        let sorted: Option<Vec<Prim>> = order.par_iter().with_min_len(CHUNK).map(prim).collect();
        let missing = || Error::Device("a device sorted triangles that do not exist".into());
        let triangle_refs = prims::triangle_refs(scene, &sorted.ok_or_else(missing)?);
        Ok(Bvh { bounds, nodes, triangle_refs, depth, spatial: None })
    }
}
