//! The linear BVH on a device.

use super::BuildTimes;
use super::curve::{CODE_BITS, Curve};
use super::kernels::Kernel;
use super::passes::{Job, Passes};
use crate::device::vulkan::Resource;
use crate::device::{Interrupted, Stage, VulkanDevice};
use crate::error::Result;
use crate::scene::Scene;
use crate::workloads::scan::{self, Scan};
use crate::workloads::trace::build::Input;
use crate::workloads::trace::bvh::{Bvh, BvhNode};

const TREE: Stage = Stage("tree");
const REFIT: Stage = Stage("refit");

/// Builds the tree of [`crate::workloads::trace::build::lbvh::build`] on a device.
///
/// # Errors
/// [`crate::Error::Refused`] for more triangles than a BVH or the device can hold, [`crate::Error::Interrupted`], and
/// the device's.
pub fn build(
    device: &VulkanDevice,
    scene: &Scene,
    max_leaf: u32,
    interrupted: Interrupted,
) -> Result<(Bvh, BuildTimes)> {
    let (prims, bounds) = match Input::of(scene, max_leaf)? {
        Input::Leaf(bvh) => return Ok((bvh, BuildTimes::default())),
        Input::Prims(prims, bounds) => (prims, bounds),
    };
    let mut times = BuildTimes::default();
    let mut passes = Passes::new(device);
    let curve = Curve::new(&mut passes, device, scene, &prims, &mut times)?;
    let bytes = u64::from(curve.count) * 4;
    let ranges = device.zeroed("the ranges of nodes", bytes * 2)?;
    let ranks = device.zeroed("the nodes of the tree", bytes)?;
    let (groups, job) = curve.shape.over(curve.count);
    let job = Job { max_leaf, ..job };
    passes.add(TREE, Kernel::Range, groups, job, &[&curve.keys, &ranges, &ranks].map(Resource::from))?;
    passes.scan(TREE, Scan::in_place(device, scan::Options::default(), &ranks, curve.count)?);
    times.add(passes.run(interrupted)?);
    let kept = passes.total()?;

    // How many nodes there are decides how much memory they take
    let words = u64::from(kept) * 4;
    let nodes = device.zeroed("the nodes", (2 + 2 * u64::from(kept)) * size_of::<BvhNode>() as u64)?;
    let slots = device.zeroed("the places of nodes", words)?;
    let waiting = device.zeroed("the children without boxes", words)?;
    let lists = [device.zeroed("a list of nodes", words)?, device.zeroed("a list of nodes", words)?];
    // Codes differ in one of their bits, equal codes in one of their places' bits
    let levels = CODE_BITS + (u32::BITS - curve.count.leading_zeros());
    let lengths = device.zeroed("the lengths of lists", u64::from(levels + 1) * 4)?;
    let mut passes = Passes::new(device);
    let bound = [&curve.boxes, &curve.order, &nodes, &slots, &waiting, &lengths, &ranges, &ranks, &lists[0]];
    passes.add(REFIT, Kernel::Leaves, groups, job, &bound.map(Resource::from))?;
    let (groups, job) = curve.shape.over(kept);
    for level in 0..levels {
        let [list, next] = [level, level + 1].map(|level| &lists[level as usize % 2]);
        let bound = [list, &nodes, &slots, &waiting, &lengths, next].map(Resource::from);
        passes.add(REFIT, Kernel::Refit, groups, Job { level, ..job }, &bound)?;
    }
    times.add(passes.run(interrupted)?);
    let nodes: Vec<BvhNode> = device.read(&nodes, 2 + 2 * kept as usize)?;
    let lengths: Vec<u32> = device.read(&lengths, levels as usize)?;
    let depth = lengths.iter().take_while(|&&length| length > 0).count() as u32;
    curve.tree(scene, &prims, bounds, &curve.order, nodes, depth).map(|bvh| (bvh, times))
}
