//! Chi-square, means with standard errors, slopes.

use glam::DVec3;

/// Sum of (observed - expected)^2 / expected; `shares` sum up to one.
pub fn chi_square(observed: &[u32], shares: &[f64]) -> f64 {
    let all = f64::from(observed.iter().sum::<u32>());
    let part = |(&observed, share): (&u32, &f64)| (f64::from(observed) - all * share).powi(2) / (all * share);
    observed.iter().zip(shares).map(part).sum()
}

/// Mean and its standard error.
pub fn mean(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (mean, (squares / (n - 1.0) / n).sqrt())
}

/// Mean over pixels, of the sum of channels.
pub fn mean_sum(irradiance: &[DVec3]) -> f64 {
    irradiance.iter().map(|e| e.element_sum()).sum::<f64>() / irradiance.len() as f64
}

/// The slope of a line through points, by least squares.
pub fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let (x, y) = (points.iter().map(|p| p.0).sum::<f64>() / n, points.iter().map(|p| p.1).sum::<f64>() / n);
    let covariance: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    covariance / points.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>()
}

#[test]
fn statistics_by_hand() {
    assert_eq!(chi_square(&[10, 30], &[0.5, 0.5]), 10.0);
    assert_eq!(mean(&[1.0, 3.0]), (2.0, 1.0));
    assert_eq!(slope(&[(0.0, 1.0), (1.0, 0.0), (2.0, -1.0)]), -1.0);
    assert_eq!(mean_sum(&[DVec3::ONE, DVec3::ZERO]), 1.5);
}
