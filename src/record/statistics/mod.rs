//! The statistics of a configuration, from its raw samples.
//!
//! A path's frames are *fixed conditions*, not repetitions: their spread is the workload's. The repetitions are the
//! passes. So a frame's time is the **median over its passes**; the table gives minimum, mean, maximum and the 95th
//! percentile (nearest rank) of these over the **frames**; and the noise is what remains between passes: the **median
//! over frames of MAD / frame time**, MAD being the median absolute deviation of a frame's passes from its median,
//! unscaled. It is in percent, and unknown after a single pass. Nothing is ever discarded.
//!
//! Two contestants are compared by *paired ratios* where each round measured both ([`paired_ratio`]), and by ranks
//! where they were measured apart ([`unpaired_ratio`]).

mod paired;
mod unpaired;

pub use paired::{
    Estimate, geometric_mean, interleaved_order, paired_ratio, paired_ratio_at, sign_test_interval, sign_test_p,
    sign_test_rank, sign_test_rank_at,
};
pub use unpaired::{Unpaired, mann_whitney, unpaired_ratio};

/// The median; the mean of the middle two where their number is even. `None` of nothing.
pub fn median(values: &[f64]) -> Option<f64> {
    if values.is_empty() {
        return None;
    }
    let sorted = sorted(values);
    let middle = sorted.len() / 2;
    Some(if sorted.len() % 2 == 1 { sorted[middle] } else { (sorted[middle - 1] + sorted[middle]) / 2.0 })
}

/// The values in ascending order.
pub fn sorted(values: &[f64]) -> Vec<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted
}

/// Median absolute deviation from the median, unscaled.
pub fn median_absolute_deviation(values: &[f64]) -> Option<f64> {
    let centre = median(values)?;
    median(&values.iter().map(|v| (v - centre).abs()).collect::<Vec<_>>())
}

/// The smallest value that at least `percent` of all values do not exceed (nearest rank).
pub fn percentile(values: &[f64], percent: f64) -> Option<f64> {
    let sorted = sorted(values);
    let rank = (percent / 100.0 * sorted.len() as f64).ceil() as usize;
    sorted.get(rank.clamp(1, sorted.len().max(1)) - 1).copied()
}

/// What a table says about the frames of one configuration. Times in milliseconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameStatistics {
    /// Fastest frame.
    pub min_ms: f64,
    /// Slowest frame.
    pub max_ms: f64,
    /// Mean over frames.
    pub mean_ms: f64,
    /// 95th percentile over frames.
    pub p95_ms: f64,
    /// All frames of the path together.
    pub total_ms: f64,
    /// Spread over passes in percent of the frame time; `None` after a single pass.
    pub noise_pct: Option<f64>,
}

/// Statistics of samples `[pass][frame]` in nanoseconds; `None` if there are none or the passes differ in length.
pub fn frames(samples: &[Vec<u64>]) -> Option<FrameStatistics> {
    let frames = samples.first()?.len();
    if frames == 0 || samples.iter().any(|pass| pass.len() != frames) {
        return None;
    }
    let mut times = Vec::with_capacity(frames);
    let mut spreads = Vec::with_capacity(frames);
    for frame in 0..frames {
        let passes: Vec<f64> = samples.iter().map(|pass| pass[frame] as f64 / 1e6).collect();
        let time = median(&passes)?;
        times.push(time);
        if time > 0.0 {
            spreads.push(100.0 * median_absolute_deviation(&passes)? / time);
        }
    }
    let total_ms: f64 = times.iter().sum();
    Some(FrameStatistics {
        min_ms: times.iter().copied().fold(f64::INFINITY, f64::min),
        max_ms: times.iter().copied().fold(0.0, f64::max),
        mean_ms: total_ms / frames as f64,
        p95_ms: percentile(&times, 95.0)?,
        total_ms,
        noise_pct: if samples.len() > 1 { median(&spreads) } else { None },
    })
}

/// Rounds to `places` decimals.
pub fn round(value: f64, places: i32) -> f64 {
    let scale = 10f64.powi(places);
    (value * scale).round() / scale
}
