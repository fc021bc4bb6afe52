//! What was counted, as metrics of a row.

use super::count::Counts;
use crate::record::row::Metric;
use crate::record::statistics::round;

/// The counts of a renderer without vectors, from the live hits and the searches of each pixel. `ends` if a path ends
/// at its first miss: then those of fewer searches than `trips` ended before their last one.
pub fn of_pixels(hits: &[u32], searches: &[u32], trips: u32, ends: bool) -> Counts {
    let mut counts = Counts::new(trips as usize);
    hits.iter().for_each(|&hits| counts.add_path(hits as usize));
    for &searches in searches {
        counts.searches += u64::from(searches);
        counts.exits_on_miss += u64::from(ends && searches < trips);
    }
    counts
}

/// The metrics: sums over all frames of a pass.
pub fn metrics(counts: &Counts, spheres: usize) -> Vec<Metric> {
    let (rays, hits) = (counts.rays.iter().sum::<u64>(), counts.hits.iter().sum::<u64>());
    let tests = |searches: u64| searches.saturating_mul(spheres as u64);
    let mut metrics = vec![
        Metric::new("rays", rays),
        Metric::new("hits", hits),
        Metric::new("tests", tests(rays)),
        Metric::new("wasted_tests", tests(counts.searches.saturating_sub(rays))),
        Metric::new("exits_on_miss", counts.exits_on_miss),
    ];
    if counts.vectors > 0 {
        // Each search of a vector is one of every lane
        let occupancy = rays as f64 / counts.searches.max(1) as f64;
        metrics.extend([
            Metric::new("vectors", counts.vectors),
            Metric::new("occupancy", round(occupancy, 6)),
            Metric::new("skips_no_hit", counts.skips_no_hit),
            Metric::new("skips_no_discriminant", counts.skips_no_discriminant),
        ]);
    }
    for (trip, (rays, hits)) in counts.rays.iter().zip(&counts.hits).enumerate() {
        let bounce = format!("bounce-{}", trip + 1);
        metrics.extend([Metric::of(&bounce, "rays", *rays), Metric::of(&bounce, "hits", *hits)]);
    }
    metrics
}
