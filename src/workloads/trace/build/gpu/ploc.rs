//! Parallel locally-ordered clustering on a device. How many clusters remain is read back after each pass.

use super::BuildTimes;
use super::curve::Curve;
use super::kernels::Kernel;
use super::passes::{Job, Passes};
use crate::device::vulkan::{Buffer, Resource};
use crate::device::{Interrupted, Stage, VulkanDevice};
use crate::error::Result;
use crate::scene::Scene;
use crate::workloads::scan::{self, Scan};
use crate::workloads::trace::build::Input;
use crate::workloads::trace::build::ploc::{Config, is_forced};
use crate::workloads::trace::bvh::{Bvh, BvhNode};
use crate::workloads::trace::common::sah::unit;

const CLUSTERS: Stage = Stage("clusters");
const SEARCH: Stage = Stage("search");
const MERGE: Stage = Stage("merge");
const NODES: Stage = Stage("nodes");

/// Builds the tree of [`crate::workloads::trace::build::ploc::build`] on a device.
///
/// # Errors
/// [`crate::Error::Refused`] for more triangles than a BVH or the device can hold, [`crate::Error::Interrupted`], and
/// the device's.
pub fn build(
    device: &VulkanDevice,
    scene: &Scene,
    config: &Config,
    interrupted: Interrupted,
) -> Result<(Bvh, BuildTimes)> {
    let (prims, bounds) = match Input::of(scene, config.max_leaf)? {
        Input::Leaf(bvh) => return Ok((bvh, BuildTimes::default())),
        Input::Prims(prims, bounds) => (prims, bounds),
    };
    let mut times = BuildTimes::default();
    let mut passes = Passes::new(device);
    let curve = Curve::new(&mut passes, device, scene, (&prims, &bounds), &mut times)?;
    let growing = Growing::new(&curve, config, unit(&bounds))?;
    let (groups, job) = curve.shape.over(curve.count);
    let bound = [&curve.indices, &curve.positions, &curve.order, &growing.clusters[0]].map(Resource::from);
    passes.add(CLUSTERS, Kernel::Clusters, groups, job, &bound)?;
    times.add(passes.run(interrupted)?);
    // The first inner node of each pass
    let mut firsts = vec![0];
    let (mut clusters, mut forced) = (curve.count, false);
    while clusters > 1 {
        let first = firsts[firsts.len() - 1];
        let passes = growing.pass(firsts.len() - 1, first, clusters, forced)?;
        times.add(passes.run(interrupted)?);
        // A device that merges nothing would go on for ever
        let merges = passes.total()?.clamp(1, clusters - 1);
        firsts.push(first + merges);
        forced = is_forced(merges, clusters, firsts.len() - 1);
        clusters -= merges;
    }
    let (nodes, sorted, depth) = growing.nodes(&firsts, &mut times, interrupted)?;
    curve.tree(scene, &prims, bounds, &sorted, nodes, depth).map(|bvh| (bvh, times))
}

/// A tree that grows from its leaves.
struct Growing<'a> {
    curve: &'a Curve<'a>,
    config: &'a Config,
    unit: f32,
    /// Before a pass and after it, in turns.
    clusters: [Buffer; 2],
    partners: Buffer,
    places: Buffer,
    merging: Buffer,
    inner: Buffer,
    /// Of each inner node.
    triangles: Buffer,
}

impl<'a> Growing<'a> {
    fn new(curve: &'a Curve<'a>, config: &'a Config, unit: f32) -> Result<Growing<'a>> {
        let words = u64::from(curve.count) * 4;
        let rows = |what: &str| curve.device.zeroed(what, words * 8);
        let list = |what: &str| curve.device.zeroed(what, words);
        Ok(Growing {
            curve,
            config,
            unit,
            clusters: [rows("the clusters")?, rows("the merged clusters")?],
            partners: list("the partners")?,
            places: list("the places of clusters")?,
            merging: list("the clusters that merge")?,
            inner: rows("the inner nodes")?,
            triangles: list("the triangles of nodes")?,
        })
    }

    /// The passes of one merge of clusters, whose last prefix sum is over those that merge.
    fn pass(&self, number: usize, first: u32, count: u32, forced: bool) -> Result<Passes<'a>> {
        let Curve { device, shape, .. } = *self.curve;
        let (groups, job) = shape.over(count);
        let radius = self.config.radius;
        let forced = u32::from(forced);
        let job = Job { first, radius, forced, leaves: self.curve.count, unit: self.unit, ..job };
        let [clusters, merged] = [number, number + 1].map(|number| &self.clusters[number % 2]);
        let Growing { partners, places, merging, inner, triangles, .. } = self;
        let mut passes = Passes::new(device);
        passes.add(SEARCH, Kernel::Search, groups, job, &[clusters, partners].map(Resource::from))?;
        passes.add(MERGE, Kernel::Choose, groups, job, &[partners, places, merging].map(Resource::from))?;
        for words in [places, merging] {
            passes.scan(MERGE, Scan::in_place(device, scan::Options::default(), words, count)?);
        }
        let bound = [partners, places, merging, clusters, merged, inner, triangles].map(Resource::from);
        passes.add(MERGE, Kernel::Merge, groups, job, &bound)?;
        Ok(passes)
    }

    /// Numbers the inner nodes that are kept, and goes down the tree: its nodes, the triangles in the order of leaves,
    /// and its depth. `firsts` has the first inner node of each pass, and their number.
    fn nodes(
        &self,
        firsts: &[u32],
        times: &mut BuildTimes,
        interrupted: Interrupted,
    ) -> Result<(Vec<BvhNode>, Buffer, u32)> {
        let Curve { device, shape, count, .. } = *self.curve;
        let max_leaf = self.config.max_leaf;
        let ranks = &self.merging;
        let (groups, job) = shape.over(count - 1);
        let job = Job { max_leaf, ..job };
        let mut passes = Passes::new(device);
        passes.add(NODES, Kernel::Number, groups, job, &[&self.triangles, ranks].map(Resource::from))?;
        passes.scan(NODES, Scan::in_place(device, scan::Options::default(), ranks, count - 1)?);
        times.add(passes.run(interrupted)?);
        let kept = passes.total()?;
        let nodes = device.zeroed("the nodes", (2 + 2 * u64::from(kept)) * size_of::<BvhNode>() as u64)?;
        let places = device.zeroed("the places of nodes", u64::from(count) * 8)?;
        let sorted = device.zeroed("the order of leaves", u64::from(count) * 4)?;
        let deepest = device.zeroed("the depth", 4)?;
        let mut passes = Passes::new(device);
        let Curve { indices, positions, order, .. } = self.curve;
        let bound =
            [indices, positions, order, &self.inner, &self.triangles, ranks, &places, &sorted, &nodes, &deepest];
        for made in firsts.windows(2).rev() {
            let (groups, job) = shape.over(made[1] - made[0]);
            let job = Job { first: made[0], leaves: count, max_leaf, ..job };
            passes.add(NODES, Kernel::Descend, groups, job, &bound.map(Resource::from))?;
        }
        times.add(passes.run(interrupted)?);
        let depth: Vec<u32> = device.read(&deepest, 1)?;
        Ok((device.read(&nodes, 2 + 2 * kept as usize)?, sorted, depth[0]))
    }
}
