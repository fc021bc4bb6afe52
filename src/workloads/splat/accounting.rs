//! Memory of clusters as the source counts it: what a node, a cluster, an entry has to hold, not what is allocated.

use super::cluster_counts::FrameCounts;
use super::directions::DIRECTIONS;
use super::gathering::Gathering;
use super::splatting::setting::Gather;
use crate::record::row::Metric;

/// Bytes of a node or a cluster: a mask and six floats.
const NODE_BYTES: u64 = 28;

/// Bytes of a cluster's buckets: three floats for each direction.
pub const BUCKETS_BYTES: u64 = DIRECTIONS as u64 * 12;

/// Bytes by the source's accounting, as parts and their sum; nothing without clusters.
pub fn metrics(gathering: &Gathering, frames: &[FrameCounts]) -> Vec<Metric> {
    let Some(layout) = &gathering.layout else { return Vec::new() };
    let clusters = frames.iter().map(|frame| frame.clusters).max().unwrap_or(0);
    let last = match gathering.gather {
        Gather::Buckets(_) => ("source-buckets", BUCKETS_BYTES * clusters),
        _ => ("source-lists", 4 * u64::from(gathering.capacity)),
    };
    let parts = [
        ("source-flags", 4_u64 << layout.key_bits()),
        ("source-nodes", NODE_BYTES * u64::from(layout.nodes())),
        ("source-clusters", NODE_BYTES * clusters),
        last,
    ];
    let sum: u64 = parts.iter().map(|(_, bytes)| bytes).sum();
    let of = parts.iter().map(|(name, bytes)| Metric::of(name, "bytes", *bytes));
    of.chain([Metric::new("key_bits", layout.key_bits()), Metric::new("source_bytes", sum)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workloads::size::Size;
    use crate::workloads::splat::clusters::KeyLayout;
    use crate::workloads::splat::splatting::setting::BucketSetting;
    use crate::workloads::splat::technique::Technique;

    #[test]
    fn printed_sizes_come_out() {
        let mut gathering = Gathering::from(Technique::default().estimate(1.0));
        let size = Size { width: 1920, height: 1080 };
        gathering.layout = Some(KeyLayout::new(&gathering.clusters, size, 60.0, (1.0, 1e4)).unwrap());
        gathering.gather = Gather::Buckets(BucketSetting::DEFAULT);
        let frames = [FrameCounts { clusters: 10_000, ..FrameCounts::default() }];
        let bytes = |name: &str| {
            let metrics = metrics(&gathering, &frames);
            metrics.iter().find(|metric| metric.of.as_deref() == Some(name)).map(|metric| metric.value.clone())
        };
        // 34 MB, 7.58 MB, and 6.48 MB for 10,000 clusters
        assert_eq!(bytes("source-flags"), Some(Metric::new("", 33_554_432_u64).value));
        assert_eq!(bytes("source-nodes"), Some(Metric::new("", 7_576_828_u64).value));
        assert_eq!(bytes("source-buckets"), Some(Metric::new("", 6_480_000_u64).value));
        assert_eq!(BUCKETS_BYTES, 648);
    }
}
