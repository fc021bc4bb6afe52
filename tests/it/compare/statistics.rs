//! Paired ratios and the interval of the sign test, against the binomial distribution and by simulation.

use crate::support::random;
use rtbench::record::statistics::{
    Estimate, interleaved_order, median, paired_ratio, sign_test_interval, sign_test_rank, sorted,
};

/// The probability that at most `k` of `n` fair coins show heads, by counting.
fn binomial(n: u32, k: u32) -> f64 {
    let choose = |k: u32| (0..k).fold(1u64, |product, i| product * u64::from(n - i) / u64::from(i + 1));
    (0..=k).map(choose).sum::<u64>() as f64 / 2f64.powi(n as i32)
}

/// Ranks of the lower end for 1 to 20 values, as tables of the sign test print them (5 %, two-sided).
const RANKS: [usize; 20] = [0, 0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 5, 5, 5, 6];

#[test]
fn the_interval_follows_from_the_binomial_distribution() {
    for (n, rank) in (1..).zip(RANKS) {
        assert_eq!(sign_test_rank(n as usize), rank, "{n}");
        // Each end lies outside with at most 2.5 %, and the next rank would be too much.
        assert!(rank == 0 || binomial(n, rank as u32 - 1) <= 0.025, "{n}");
        assert!(binomial(n, rank as u32) > 0.025, "{n}");
        let values: Vec<f64> = (1..=n).rev().map(f64::from).collect();
        let low = rank.max(1) as f64;
        assert_eq!(sign_test_interval(&values), Some((low, f64::from(n) + 1.0 - low)), "{n}");
    }
    assert_eq!(sign_test_rank(0), 0);
    assert_eq!(sign_test_interval(&[]), None);
    // By the normal approximation, the rank is about n / 2 - 0.98 sqrt(n).
    for n in [100, 1000, 10_000, 100_000] {
        let about = n as f64 / 2.0 - 0.98 * (n as f64).sqrt();
        assert!((sign_test_rank(n) as f64 - about).abs() < 2.0, "{n}: {}", sign_test_rank(n));
    }
}

#[test]
fn the_interval_holds_the_median_as_often_as_it_says() {
    let mut random = random(95);
    for n in [6, 9, 15, 40] {
        // Ratios of two times that are disturbed upwards only; the median of their distribution is 1.5.
        let mut disturbed = || 1.0 + random().powi(2);
        let trials = 4000;
        let held = (0..trials)
            .filter(|_| {
                let below: Vec<f64> = (0..n).map(|_| f64::from(disturbed())).collect();
                let above: Vec<f64> = (0..n).map(|_| 1.5 * f64::from(disturbed())).collect();
                let Estimate { value, low, high } = paired_ratio(&above, &below).unwrap();
                assert!(low <= value && value <= high);
                (low..=high).contains(&1.5)
            })
            .count();
        let expected = 1.0 - 2.0 * binomial(n, sign_test_rank(n as usize) as u32 - 1);
        let share = held as f64 / f64::from(trials);
        // Four standard deviations of 4000 trials at 95 % are 1.4 %
        assert!(expected >= 0.95 && (share - expected).abs() < 0.014, "{n}: {share} instead of {expected}");
    }
}

#[test]
fn ratios_are_paired_by_round() {
    // A clock that halves its rate in the third round disturbs both sides of one ratio alike.
    let ratio = paired_ratio(&[2.0, 2.0, 4.0, 2.0], &[1.0, 1.0, 2.0, 1.0]).unwrap();
    assert_eq!(ratio, Estimate { value: 2.0, low: 2.0, high: 2.0 });
    assert_eq!(paired_ratio(&[3.0, 1.0], &[1.0]).unwrap().value, 3.0);
    assert_eq!(paired_ratio(&[], &[]), None);
    assert_eq!(median(&[3.0, 1.0, 2.0, 10.0]), Some(2.5));
    assert_eq!(sorted(&[2.0, -1.0, 0.5]), [-1.0, 0.5, 2.0]);
}

#[test]
fn every_other_round_is_measured_backwards() {
    assert_eq!([0, 1, 2, 3].map(|round| interleaved_order(2, round)), [[0, 1], [1, 0], [0, 1], [1, 0]]);
    assert_eq!(interleaved_order(3, 1), [2, 1, 0]);
    assert!(interleaved_order(0, 1).is_empty());
}
