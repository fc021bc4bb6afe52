//! Counts of all frames of a path: clusters of each view, and the photons that touch them.

use super::Stages;
use super::accounting;
use super::case::SplatCase;
use super::cluster_counts::{self, FrameCounts};
use super::clusters::layout::{KeyLayout, LEVELS};
use super::clusters::{Clusters, NONE};
use super::gathered::{Scenery, of_walk};
use super::gathering::BUCKET_CLUSTERS;
use super::run::SplatRun;
use super::splatting::counts;
use super::splatting::setting::Gather;
use super::splatting::walk::target_of;
use crate::error::{Error, Result};
use crate::record::row::Metric;

/// Metrics of all frames of a case's path; `first` is the first frame, whose photons are those of all. Walks are
/// counted by the twin over the clusters that the device made.
///
/// # Errors
/// [`crate::Error::Device`] for a frame whose lists or buckets are above their capacity; the device's.
pub fn metrics(run: &mut SplatRun, case: &SplatCase, first: Stages) -> Result<Vec<Metric>> {
    let input = run.input();
    let (lit, cameras) = (input.lit(case)?, &input.path(case)?.cameras);
    let gathering = input.gathering(case, case.size)?;
    let Some(layout) = &gathering.layout else { return Ok(Vec::new()) };
    let level = match gathering.gather {
        Gather::Buckets(setting) => setting.level,
        _ => LEVELS,
    };
    let mut frames = Vec::with_capacity(cameras.len());
    for camera in cameras {
        input.context.check_interrupt()?;
        let clusters = run.clusters(case, camera)?;
        check(&clusters, layout)?;
        let (samples, photons) = (&first.samples, &first.photons);
        let view = Scenery { lit: &lit.scene, camera, size: case.size, samples, photons };
        let walked = of_walk(&gathering, &view, &clusters, level, |walk| {
            Ok(counts::walked(input.cpu.pool(), walk, &first.photons))
        })?;
        match gathering.gather {
            // Nodes of a level have room for all
            Gather::Buckets(_) if level < LEVELS => {}
            Gather::Buckets(_) => {
                gathering.check_bucket_clusters(clusters.cluster_keys.len() as u64, BUCKET_CLUSTERS.into())?;
            }
            _ => gathering.check_entries(walked.assignments())?,
        }
        frames.push(FrameCounts::new(&clusters, layout, &walked, |identifier| target_of(&clusters, level, identifier)));
    }
    let mut metrics = cluster_counts::metrics(&frames, &gathering);
    metrics.extend(accounting::metrics(&gathering, &frames));
    Ok(metrics)
}

/// Refuses clusters of a frame that is not verified and whose numbers are none of clusters.
fn check(clusters: &Clusters, layout: &KeyLayout) -> Result<()> {
    let count = clusters.cluster_keys.len();
    let is_possible = |key: &u32| key >> layout.key_bits() == 0;
    let is_one = |identifier: &u32| *identifier == NONE || (*identifier as usize) < count;
    if clusters.cluster_keys.iter().all(is_possible) && clusters.identifiers.iter().all(is_one) {
        return Ok(());
    }
    Err(Error::Device("a frame has clusters whose keys or identifiers cannot be".into()))
}
