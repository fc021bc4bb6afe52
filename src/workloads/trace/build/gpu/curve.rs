//! The Morton curve on a device: boxes, codes, and the sort.

use super::BuildTimes;
use super::kernels::{GROUP_SIZE, Kernel, WORKER_GROUP};
use super::passes::{Job, Passes};
use crate::device::vulkan::{Buffer, ReadBuffer, Resource, Texel};
use crate::device::{Stage, VulkanDevice};
use crate::error::{Error, Result};
use crate::math::Aabb;
use crate::scene::Scene;
use crate::workloads::scan::{self, Scan};
use crate::workloads::trace::bvh::{Bvh, BvhNode};
use crate::workloads::trace::common::prims::{self, CHUNK, Prim};
use rayon::prelude::*;

const BOXES: Stage = Stage("boxes");
const CODES: Stage = Stage("codes");
const SORT: Stage = Stage("sort");

/// Bits of a Morton code.
const CODE_BITS: u32 = 30;

/// Bits of a digit that is sorted by on a software driver: few passes.
const SOFTWARE_BITS: u32 = 10;

/// Bits of a digit that is sorted by on a GPU: few counters.
pub(super) const GPU_BITS: u32 = 6;

/// Most keys of a worker that sorts: a loop of a software driver ends after 65,535 iterations.
const MOST_KEYS: u32 = 32_768;

/// How the work is shared out on a device. It changes no byte of a tree.
#[derive(Clone, Copy)]
pub(super) struct Shape {
    /// Most work-groups of a pass.
    groups: u32,
    /// Least invocations that sort.
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
    pub boxes: Buffer,
    pub keys: Buffer,
    pub order: Buffer,
}

impl<'d> Curve<'d> {
    /// Uploads triangles and adds the passes that sort them.
    pub fn new(
        passes: &mut Passes,
        device: &'d VulkanDevice,
        scene: &Scene,
        prims: &[Prim],
        times: &mut BuildTimes,
    ) -> Result<Curve<'d>> {
        let (shape, count) = (Shape::of(device), prims.len() as u32);
        let bytes = u64::from(count) * 4;
        let refs = prims::triangle_refs(scene, prims);
        let textures = device.info().software_threads() > 0
            && [bytemuck::cast_slice(&scene.vertices), bytemuck::cast_slice::<_, u8>(&refs)]
                .iter()
                .all(|contents: &&[u8]| device.fits_texture(contents.len(), Texel::Bytes16));
        let upload = |what: &str, contents: &[u8]| match textures {
            true => device.texture(what, contents, Texel::Bytes16).map(ReadBuffer::Texture),
            false => device.storage(what, contents).map(ReadBuffer::Buffer),
        };
        let (uploaded, upload) = device.time_upload(|| {
            let vertices = upload("the vertices", bytemuck::cast_slice(&scene.vertices))?;
            Ok((vertices, upload("the triangle references", bytemuck::cast_slice(&refs))?))
        })?;
        times.upload_ms = upload.as_secs_f64() * 1e3;
        let words = |what: &str| device.zeroed(what, bytes);
        let boxes = device.zeroed("the boxes of triangles", bytes * 6)?;
        let (groups, job) = shape.over(count);
        let parts = device.zeroed("the boxes of centroids", u64::from(job.stride) * 24)?;
        let cells = device.zeroed("the cells", 24)?;
        let bound = [Resource::from(&uploaded.0), Resource::from(&uploaded.1), (&boxes).into(), (&parts).into()];
        passes.add(BOXES, Kernel::Boxes { textures }, groups, job, &bound)?;
        let all = Job { count: job.stride, ..Job::default() };
        passes.add(CODES, Kernel::Cells, 1, all, &[&parts, &cells].map(Resource::from))?;
        let pairs = [(words("the keys")?, words("the order")?), (words("the keys")?, words("the order")?)];
        passes.add(CODES, Kernel::Codes, groups, job, &[&boxes, &cells, &pairs[0].0].map(Resource::from))?;

        let workers = shape.workers.min(count).max(count.div_ceil(MOST_KEYS));
        let bits = shape.bits;
        let table = device.zeroed("the counters of digits", (u64::from(workers) << bits) * 4)?;
        let groups = workers.div_ceil(WORKER_GROUP);
        let mut from = 0;
        for shift in (0..CODE_BITS).step_by(bits as usize) {
            let job = Job { count, workers, chunk: count.div_ceil(workers), shift, ..Job::default() };
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
        Ok(Curve { device, shape, count, boxes, keys, order })
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
