//! In which order cases are timed.

/// The order of `count` cases in a pass. Every second pass reverses the one before it (ABBA), so that a steady drift of
/// the machine is the same for all, and each pair of passes begins with another case.
pub fn order(count: usize, pass: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..count).collect();
    order.rotate_left((pass / 2) % count.max(1));
    if pass % 2 == 1 {
        order.reverse();
    }
    order
}
