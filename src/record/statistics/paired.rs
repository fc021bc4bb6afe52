//! Ratios of two contestants that every round measured, both within moments: a machine that changes its clock between
//! rounds disturbs both sides of a ratio alike. Each round measures them in an order that alternates
//! ([`interleaved_order`]) and gives one log ratio. The result is the **median** with the **interval of an exact sign
//! test**, which assumes nothing about the distribution of the ratios.

use super::sorted;

/// The order in which a round measures its contestants: from the first to the last, and in every other round back
/// (ABBA).
pub fn interleaved_order(contestants: usize, round: usize) -> Vec<usize> {
    let forward = 0..contestants;
    if round.is_multiple_of(2) { forward.collect() } else { forward.rev().collect() }
}

/// An estimate with the interval that holds the true value with a probability of at least 95 %, or of the level that
/// was asked for, if there are enough values for such an interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The estimate.
    pub value: f64,
    /// The lower end of the interval.
    pub low: f64,
    /// The upper end of the interval.
    pub high: f64,
}

/// The median of the rounds' log ratios, as a ratio, with its interval of 95 %. `None` without a round; of lists of
/// unlike length, the rounds that both have count.
pub fn paired_ratio(above: &[f64], below: &[f64]) -> Option<Estimate> {
    let (estimate, _) = paired_ratio_at(above, below, 0.05)?;
    Some(estimate)
}

/// The same with an interval whose error probability is at most `alpha`, and false where there are too few rounds for
/// one: then the interval is the range of all ratios.
pub fn paired_ratio_at(above: &[f64], below: &[f64], alpha: f64) -> Option<(Estimate, bool)> {
    let ratios: Vec<f64> = above.iter().zip(below).map(|(above, below)| above / below).collect();
    let sorted = sorted(&ratios);
    let rank = sign_test_rank_at(sorted.len(), alpha);
    let outside = rank.saturating_sub(1);
    let (low, high) = (*sorted.get(outside)?, sorted[sorted.len() - 1 - outside]);
    let middle = sorted.len() / 2;
    // The mean of the middle two logarithms is the logarithm of their geometric mean
    let value = match sorted.len() % 2 {
        1 => sorted[middle],
        _ => (sorted[middle - 1] * sorted[middle]).sqrt(),
    };
    Some((Estimate { value, low, high }, rank > 0))
}

/// The values between which the median of their distribution lies with a probability of at least 95 %, by an exact sign
/// test; with five values or fewer there is no such interval, and all values are between the two. `None` of nothing.
pub fn sign_test_interval(values: &[f64]) -> Option<(f64, f64)> {
    let sorted = sorted(values);
    let outside = sign_test_rank(sorted.len()).saturating_sub(1);
    Some((*sorted.get(outside)?, sorted[sorted.len() - 1 - outside]))
}

/// The rank, from 1, of the lower end of the interval of 95 % among `n` values; 0 if there is none.
pub fn sign_test_rank(n: usize) -> usize {
    sign_test_rank_at(n, 0.05)
}

/// The rank, from 1, of the interval's lower end among `n` values: the largest `k` for which the probability that fewer
/// than `k` of them are below the median is at most `alpha / 2`. 0 if there is none.
pub fn sign_test_rank_at(n: usize, alpha: f64) -> usize {
    // Binomial probabilities as logarithms: half to the power of a large number is no float above zero
    let mut log_term = -(n as f64) * std::f64::consts::LN_2;
    let (mut rank, mut tail) = (0, log_term.exp());
    while tail <= alpha / 2.0 && rank < n {
        rank += 1;
        log_term += ((n - rank + 1) as f64 / rank as f64).ln();
        tail += log_term.exp();
    }
    rank
}

/// The two-sided probability of so uneven signs if ratios above and below 1 are equally likely. Ratios of exactly 1
/// say nothing and are left out; 1 where nothing is left.
pub fn sign_test_p(ratios: &[f64]) -> f64 {
    let (above, below) = ratios.iter().fold((0usize, 0usize), |(above, below), &ratio| {
        (above + usize::from(ratio > 1.0), below + usize::from(ratio < 1.0))
    });
    let n = above + below;
    let mut log_term = -(n as f64) * std::f64::consts::LN_2;
    let mut tail = log_term.exp();
    for rank in 1..=above.min(below) {
        log_term += ((n - rank + 1) as f64 / rank as f64).ln();
        tail += log_term.exp();
    }
    (2.0 * tail).min(1.0)
}

/// The geometric mean of positive values; `None` of nothing.
pub fn geometric_mean(values: &[f64]) -> Option<f64> {
    if values.is_empty() {
        return None;
    }
    Some((values.iter().map(|value| value.ln()).sum::<f64>() / values.len() as f64).exp())
}
