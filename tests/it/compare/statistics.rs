//! Paired ratios and the interval of the sign test, against the binomial distribution and by simulation; ranks of
//! unpaired values against published tables and by simulation.

use crate::support::random;
use rtbench::record::statistics::{
    Estimate, geometric_mean, interleaved_order, mann_whitney, median, paired_ratio, paired_ratio_at,
    sign_test_interval, sign_test_p, sign_test_rank, sign_test_rank_at, sorted, unpaired_ratio,
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

#[test]
fn means_of_ratios_are_geometric() {
    // One twice as fast and one half as fast cancel out, in either order of the sides
    assert_eq!(paired_ratio(&[4.0, 1.0], &[2.0, 2.0]).unwrap().value, 1.0);
    assert!((geometric_mean(&[2.0, 0.5, 1.0]).unwrap() - 1.0).abs() < 1e-15);
    assert!((geometric_mean(&[1.0, 10.0, 100.0]).unwrap() - 10.0).abs() < 1e-12);
    assert_eq!(geometric_mean(&[]), None);
}

#[test]
fn signs_have_binomial_probabilities() {
    let ratios = |above: usize, below: usize| [vec![1.1; above], vec![0.9; below], vec![1.0; 3]].concat();
    for (above, below) in [(0, 0), (1, 0), (5, 0), (8, 2), (9, 1), (10, 10)] {
        let n = (above + below) as u32;
        let expected = (2.0 * binomial(n, above.min(below) as u32)).min(1.0);
        let p = sign_test_p(&ratios(above, below));
        assert!((p - expected).abs() < 1e-12, "{above} {below}: {p} instead of {expected}");
        assert_eq!(p, sign_test_p(&ratios(below, above)));
    }
}

#[test]
fn many_cells_need_wider_intervals() {
    // Ten rounds have an interval for up to 25 cells: 2 * 2^-10 = 0.05 / 25.6
    assert_eq!([1.0, 10.0, 25.0, 26.0].map(|cells| sign_test_rank_at(10, 0.05 / cells)), [2, 1, 1, 0]);
    let above: Vec<f64> = (1..=10).map(f64::from).collect();
    let of = |alpha| paired_ratio_at(&above, &[1.0; 10], alpha).unwrap();
    assert_eq!(of(0.05), (Estimate { value: 30f64.sqrt(), low: 2.0, high: 9.0 }, true));
    assert_eq!(of(0.05 / 25.0), (Estimate { value: 30f64.sqrt(), low: 1.0, high: 10.0 }, true));
    assert!(!of(0.05 / 26.0).1);
}

/// Two-sided tail of the normal distribution beyond z = 3.2866.
const NORMAL_P: f64 = 0.00101410;

#[test]
fn ranks_have_the_probabilities_of_mann_and_whitney() {
    // Without ties, all of one side below the other: 2 / C(m + n, m)
    assert!((mann_whitney(&[1.0, 2.0, 3.0], &[4.0, 5.0, 6.0]) - 0.1).abs() < 1e-12);
    assert!((mann_whitney(&[4.0, 5.0, 6.0, 7.0], &[0.0, 1.0, 2.0, 3.0]) - 2.0 / 70.0).abs() < 1e-12);
    // U = 3 of 3 x 4: 2 * (1 + 1 + 2 + 3) / 35, from the table of 1947
    assert!((mann_whitney(&[1.0, 2.0, 6.0], &[3.0, 4.0, 5.0, 7.0]) - 14.0 / 35.0).abs() < 1e-12);
    // Equal values say nothing
    assert_eq!(mann_whitney(&[5.0; 3], &[5.0; 3]), 1.0);
    assert_eq!(mann_whitney(&[5.0; 30], &[5.0; 30]), 1.0);
    assert_eq!(mann_whitney(&[], &[1.0]), 1.0);
    // Too many to be counted: U = 78 of 20 x 20, by the normal distribution with continuity,
    // z = 121.5 / sqrt(400 * 41 / 12)
    let side = |from: f64| -> Vec<f64> { (0..20).map(|i| from + f64::from(i)).collect() };
    let p = mann_whitney(&side(0.0), &side(7.5));
    // The tail's formula is off by 7.5e-8 at most, and p is two tails
    assert!((p - NORMAL_P).abs() < 1.5e-7, "{p}");
}

#[test]
fn quotients_of_values_measured_apart_have_an_interval() {
    let ratio = unpaired_ratio(&[2.0, 2.2, 2.4], &[1.0, 1.0, 1.0], 0.1).unwrap();
    assert_eq!(ratio.ratio, Estimate { value: 2.2, low: 2.0, high: 2.4 });
    assert!(ratio.has_interval && (ratio.p - 0.1).abs() < 1e-12);
    // Two runs on each side have none at this level
    assert!(!unpaired_ratio(&[1.0, 2.0], &[1.0, 2.0], 0.1).unwrap().has_interval);
    assert_eq!(unpaired_ratio(&[], &[1.0], 0.1), None);
}

#[test]
fn the_interval_of_values_measured_apart_holds_the_ratio_as_often_as_it_says() {
    let mut random = random(1947);
    for (m, n, alpha) in [(3, 3, 0.1), (5, 4, 0.05), (8, 8, 0.05), (20, 20, 0.05)] {
        let mut noisy = || 1.0 + 0.05 * f64::from(random());
        let trials = 3000;
        let (mut held, mut significant) = (0, 0);
        for _ in 0..trials {
            let below: Vec<f64> = (0..n).map(|_| noisy()).collect();
            let above: Vec<f64> = (0..m).map(|_| 1.5 * noisy()).collect();
            let found = unpaired_ratio(&above, &below, alpha).unwrap();
            assert!(found.has_interval);
            held += usize::from((found.ratio.low..=found.ratio.high).contains(&1.5));
            let same: Vec<f64> = above.iter().map(|value| value / 1.5).collect();
            significant += usize::from(mann_whitney(&same, &below) <= alpha);
        }
        // Four standard deviations of 3000 trials are 1.6 % at 95 % and 2.2 % at 90 %
        let margin = 4.0 * (alpha * (1.0 - alpha) / f64::from(trials)).sqrt();
        let share = held as f64 / f64::from(trials);
        assert!(share >= 1.0 - alpha - margin, "{m} {n}: {share}");
        assert!(significant as f64 / f64::from(trials) <= alpha + margin, "{m} {n}: {significant}");
    }
}
