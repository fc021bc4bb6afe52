//! Ratios of two contestants that were measured apart: nothing pairs their values, so that only ranks are compared. The
//! test is that of Mann and Whitney (1947), exact for few values, ties included; the estimate is that of Hodges and
//! Lehmann (1963): the median of all quotients of a value of one side by one of the other.

use super::{Estimate, sorted};

/// Up to so many values on both sides together, the distribution of the rank sum is counted; beyond, it is taken as
/// normal.
const COUNTED: usize = 24;

/// A ratio of two sides that were measured apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unpaired {
    /// The median of all quotients, and their interval.
    pub ratio: Estimate,
    /// Two-sided probability of ranks that differ so much, if both sides have the same distribution.
    pub p: f64,
    /// False where no interval of the asked level exists with so few values: it is the range of all quotients.
    pub has_interval: bool,
}

/// The ratio of `above` by `below`, with an interval whose error probability is at most `alpha`. `None` if a side is
/// empty.
pub fn unpaired_ratio(above: &[f64], below: &[f64], alpha: f64) -> Option<Unpaired> {
    let quotients: Vec<f64> = above.iter().flat_map(|above| below.iter().map(move |below| above / below)).collect();
    let sorted = sorted(&quotients);
    let middle = sorted.len() / 2;
    let value = match sorted.len() {
        0 => return None,
        odd if odd % 2 == 1 => sorted[middle],
        _ => (sorted[middle - 1] * sorted[middle]).sqrt(),
    };
    let rank = interval_rank(above.len(), below.len(), alpha);
    let outside = rank.saturating_sub(1);
    let ratio = Estimate { value, low: sorted[outside], high: sorted[sorted.len() - 1 - outside] };
    Some(Unpaired { ratio, p: mann_whitney(above, below), has_interval: rank > 0 })
}

/// The rank, from 1, of the interval's lower end among all quotients: the largest `k` for which the statistic U is
/// below `k` with a probability of at most `alpha / 2`; 0 if there is none.
fn interval_rank(m: usize, n: usize, alpha: f64) -> usize {
    if m + n > COUNTED {
        let (m, n) = (m as f64, n as f64);
        let spread = (m * n * (m + n + 1.0) / 12.0).sqrt();
        return (m * n / 2.0 - normal_quantile(alpha / 2.0) * spread).floor().max(0.0) as usize;
    }
    let ranks: Vec<usize> = (1..=m + n).map(|rank| 2 * rank).collect();
    let counts = rank_sums(&ranks, m);
    let total: f64 = counts.iter().sum();
    let least = m * (m + 1);
    let (mut rank, mut tail) = (0, 0.0);
    while rank < m * n {
        tail += counts.get(least + 2 * rank).copied().unwrap_or(0.0) / total;
        if tail > alpha / 2.0 {
            break;
        }
        rank += 1;
    }
    rank
}

/// The two-sided probability that the ranks of two samples of one distribution differ as much as these do; 1 if a side
/// is empty.
pub fn mann_whitney(a: &[f64], b: &[f64]) -> f64 {
    if a.is_empty() || b.is_empty() {
        return 1.0;
    }
    let (ranks, ties) = doubled_ranks(a, b);
    let (m, n) = (a.len(), b.len());
    let sum: usize = ranks[..m].iter().sum();
    // Twice the expected sum, so that it is whole
    let expected = m * (m + n + 1);
    let distance = sum.abs_diff(expected);
    if m + n <= COUNTED {
        let counts = rank_sums(&ranks, m);
        let total: f64 = counts.iter().sum();
        let as_far = counts.iter().enumerate().filter(|(sum, _)| sum.abs_diff(expected) >= distance);
        return (as_far.map(|(_, count)| count).sum::<f64>() / total).min(1.0);
    }
    let (m, n) = (m as f64, n as f64);
    let all = m + n;
    let variance = m * n / 12.0 * (all + 1.0 - ties / (all * (all - 1.0)));
    if variance <= 0.0 {
        return 1.0;
    }
    // Continuity: the sum moves in steps of one
    let z = (distance as f64 / 2.0 - 0.5).max(0.0) / variance.sqrt();
    2.0 * normal_tail(z)
}

/// Twice the rank of each value of `a`, then of `b`, in both together; equal values have the mean of their ranks. And
/// the sum of `t^3 - t` over groups of `t` equal values.
fn doubled_ranks(a: &[f64], b: &[f64]) -> (Vec<usize>, f64) {
    let all: Vec<f64> = a.iter().chain(b).copied().collect();
    let mut order: Vec<usize> = (0..all.len()).collect();
    order.sort_by(|&i, &j| all[i].total_cmp(&all[j]));
    let mut ranks = vec![0; all.len()];
    let (mut from, mut ties) = (0, 0.0);
    while from < order.len() {
        let equal = order[from..].iter().take_while(|&&i| all[i] == all[order[from]]).count();
        for &index in &order[from..from + equal] {
            ranks[index] = 2 * from + equal + 1;
        }
        ties += (equal as f64).powi(3) - equal as f64;
        from += equal;
    }
    (ranks, ties)
}

/// How many choices of `m` of these ranks have each sum.
fn rank_sums(ranks: &[usize], m: usize) -> Vec<f64> {
    let most: usize = ranks.iter().sum();
    let mut counts = vec![vec![0.0; most + 1]; m + 1];
    counts[0][0] = 1.0;
    for &rank in ranks {
        for chosen in (1..=m).rev() {
            for sum in (rank..=most).rev() {
                let with = counts[chosen - 1][sum - rank];
                counts[chosen][sum] += with;
            }
        }
    }
    counts.pop().unwrap_or_default()
}

/// The probability that a standard normal variable is above `z`.
fn normal_tail(z: f64) -> f64 {
    0.5 * libm::erfc(z * std::f64::consts::FRAC_1_SQRT_2)
}

/// The value that a standard normal variable exceeds with probability `p`, for `p` up to one half, by bisection.
fn normal_quantile(p: f64) -> f64 {
    let (mut low, mut high) = (0.0, 40.0);
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if normal_tail(middle) > p { low = middle } else { high = middle }
    }
    low
}
