//! Boxes of clusters. Twin of `kernels/splat/clusters/direct.wgsl` and of `kernels/splat/clusters/two_step.wgsl`, which
//! give the same.

use super::Bounds;
use glam::{Vec3, Vec4};

/// A word that is ordered as the floats are; below 0, -0 comes right before it. Twin of `ordered` of
/// `kernels/splat/clusters/ordered.wgsl`.
pub fn ordered(value: f32) -> u32 {
    let bits = value.to_bits();
    if bits >> 31 == 1 { !bits } else { bits | 1 << 31 }
}

/// The float of a word of [`ordered`].
pub fn unordered(word: u32) -> f32 {
    f32::from_bits(if word >> 31 == 1 { word & !(1 << 31) } else { !word })
}

impl Bounds {
    /// Contains nothing, as words.
    const NOTHING: [u32; 6] = [u32::MAX, u32::MAX, u32::MAX, 0, 0, 0];

    /// Smallest and largest coordinates as words that are ordered as the floats are.
    pub fn words(&self) -> [u32; 6] {
        let ([a, b, c], [d, e, f]) = (self.min.to_array(), self.max.to_array());
        [a, b, c, d, e, f].map(ordered)
    }

    /// The box of such words.
    pub fn of_words(words: [u32; 6]) -> Bounds {
        let [a, b, c, d, e, f] = words.map(unordered);
        Bounds { min: Vec3::new(a, b, c), max: Vec3::new(d, e, f) }
    }

    /// The smallest box around two; -0 is smaller than 0.
    #[must_use]
    pub fn union(&self, other: &Bounds) -> Bounds {
        let (mut words, other) = (self.words(), other.words());
        widen(&mut words, other);
        Bounds::of_words(words)
    }
}

fn widen(words: &mut [u32; 6], other: [u32; 6]) {
    for (index, (word, other)) in words.iter_mut().zip(other).enumerate() {
        *word = if index < 3 { (*word).min(other) } else { (*word).max(other) };
    }
}

/// The box of each of so many clusters; [`Bounds::EMPTY`] for one without samples.
pub fn boxes(clusters: usize, positions: &[Vec4], identifiers: &[u32]) -> Vec<Bounds> {
    let mut all = vec![Bounds::NOTHING; clusters];
    for (position, &identifier) in positions.iter().zip(identifiers) {
        if let Some(words) = all.get_mut(identifier as usize) {
            let point = position.truncate();
            widen(words, Bounds { min: point, max: point }.words());
        }
    }
    let of = |words| if words == Bounds::NOTHING { Bounds::EMPTY } else { Bounds::of_words(words) };
    all.into_iter().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_ordered_as_floats_are() {
        let rising = [f32::NEG_INFINITY, -3e38, -1.5, -1e-40, -0.0, 0.0, 1e-40, 1.0, 1.5, 3e38, f32::INFINITY];
        for pair in rising.windows(2) {
            assert!(ordered(pair[0]) < ordered(pair[1]), "{pair:?}");
        }
        for value in rising {
            assert_eq!(unordered(ordered(value)).to_bits(), value.to_bits());
        }
        assert_eq!(Bounds::EMPTY.union(&Bounds::EMPTY), Bounds::EMPTY);
    }
}
