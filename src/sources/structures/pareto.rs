//! The structures that no other one beats in both of two quantities.

/// For each point, of a cost and a rate, whether it is on the Pareto front: no other point has at most its cost and at
/// least its rate, and is better in one of them.
pub fn front(points: &[(f64, f64)]) -> Vec<bool> {
    let beats = |a: &(f64, f64), b: &(f64, f64)| a.0 <= b.0 && a.1 >= b.1 && a != b;
    points.iter().map(|point| !points.iter().any(|other| beats(other, point))).collect()
}
