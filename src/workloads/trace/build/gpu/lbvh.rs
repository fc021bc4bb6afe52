//! The linear BVH on a device.

use super::BuildTimes;
use super::curve::Curve;
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
const NODES: Stage = Stage("nodes");
const REFIT: Stage = Stage("refit");

/// Levels of inner nodes, from the bottom up, that get their boxes in a pass of their own. Of a usual tree hardly any
/// node is above them.
pub(super) const LEVELS: u32 = 14;

/// Places behind the lengths of the levels' lists: the levels of inner nodes of the whole tree, the number of leaves.
pub(super) const DEPTH: u32 = LEVELS + 1;
pub(super) const LEAVES: u32 = LEVELS + 2;

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
    let curve = Curve::new(&mut passes, device, scene, (&prims, &bounds), &mut times)?;
    let inner = curve.count - 1;
    let kept_nodes = device.zeroed("the nodes of the tree", u64::from(inner) * 4)?;
    let (groups, job) = curve.shape.in_chunks(inner);
    let job = Job { max_leaf, leaves: curve.count, ..job };
    let numbers = device.zeroed("the numbers of nodes", u64::from(job.workers) * 4)?;
    passes.add(TREE, Kernel::Flags, groups, job, &[&curve.keys, &numbers].map(Resource::from))?;
    passes.scan(TREE, Scan::in_place(device, scan::Options::default(), &numbers, job.workers)?);
    passes.add(TREE, Kernel::List, groups, job, &[&curve.keys, &numbers, &kept_nodes].map(Resource::from))?;
    times.add(passes.run(interrupted)?);
    let kept = passes.total()?;

    // How many nodes there are decides how much memory they take
    let list = |what: &str| device.zeroed(what, u64::from(kept) * 4);
    let nodes = device.zeroed("the nodes", (2 + 2 * u64::from(kept)) * size_of::<BvhNode>() as u64)?;
    let slots = device.zeroed("the places of nodes", u64::from(inner) * 4)?;
    let (waiting, heights) = (list("the children without boxes")?, list("the heights of nodes")?);
    let lists = [list("a list of nodes")?, list("a list of nodes")?];
    let lengths = device.zeroed("the lengths of lists", u64::from(LEAVES + 1) * 4)?;
    let leaves = device.zeroed("the leaves", (u64::from(kept) + 1) * 4)?;
    let mut passes = Passes::new(device);
    let (groups, job) = curve.shape.over(kept);
    let job = Job { max_leaf, leaves: curve.count, ..job };
    let Curve { indices, positions, keys, order, .. } = &curve;
    let bound = [keys, &leaves, &nodes, &slots, &waiting, &lengths, &lists[0], &kept_nodes];
    passes.add(NODES, Kernel::Nodes, groups, job, &bound.map(Resource::from))?;
    let (groups_of_leaves, job_of_leaves) = curve.shape.over(kept + 1);
    let job_of_leaves = Job { max_leaf, ..job_of_leaves };
    let bound = [indices, positions, order, &leaves, &nodes].map(Resource::from);
    passes.add(NODES, Kernel::Leaves, groups_of_leaves, job_of_leaves, &bound)?;
    for level in 0..=LEVELS {
        let [list, next] = [level, level + 1].map(|level| &lists[level as usize % 2]);
        let bound = [list, &heights, &nodes, &slots, &waiting, &lengths, next, &kept_nodes].map(Resource::from);
        let (kernel, groups) = if level < LEVELS { (Kernel::Refit, groups) } else { (Kernel::Top, 1) };
        passes.add(REFIT, kernel, groups, Job { level, ..job }, &bound)?;
    }
    times.add(passes.run(interrupted)?);
    let nodes: Vec<BvhNode> = device.read(&nodes, 2 + 2 * kept as usize)?;
    let lengths: Vec<u32> = device.read(&lengths, DEPTH as usize + 1)?;
    let depth = lengths[DEPTH as usize];
    curve.tree(scene, &prims, bounds, &curve.order, nodes, depth).map(|bvh| (bvh, times))
}
