//! Optional abilities of devices, by our own names.

/// An optional ability of a device.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Feature {
    /// Timestamps at the begin and the end of passes.
    Timestamps,
    /// Operations across the invocations of a subgroup.
    Subgroups,
    /// Ray queries against acceleration structures of the driver.
    RayQuery,
    /// Atomic additions of floats in storage buffers.
    FloatAtomics,
    /// Arithmetic in half precision, and such numbers in buffers.
    Half,
}

impl Feature {
    /// Every feature.
    pub const ALL: [Feature; 5] =
        [Feature::Timestamps, Feature::Subgroups, Feature::RayQuery, Feature::FloatAtomics, Feature::Half];

    fn bit(self) -> u8 {
        1 << self as u8
    }
}

/// A set of features.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Features(u8);

impl Features {
    /// The set of these features.
    pub const fn of(features: &[Feature]) -> Features {
        let (mut bits, mut index) = (0, 0);
        while index < features.len() {
            bits |= 1 << features[index] as u8;
            index += 1;
        }
        Features(bits)
    }

    /// True if the feature is in the set.
    pub fn has(self, feature: Feature) -> bool {
        self.0 & feature.bit() != 0
    }

    /// The features in both sets.
    pub fn intersection(self, other: Features) -> Features {
        Features(self.0 & other.0)
    }

    /// The features in either set.
    #[must_use]
    pub fn union(self, other: Features) -> Features {
        Features(self.0 | other.0)
    }

    /// The features of this set that `other` lacks: what an algorithm with these needs misses on a device.
    pub fn missing_in(self, other: Features) -> Features {
        Features(self.0 & !other.0)
    }

    /// True for the set without any feature.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// The features, in the order of [`Feature::ALL`].
    pub fn iter(self) -> impl Iterator<Item = Feature> {
        Feature::ALL.into_iter().filter(move |&feature| self.has(feature))
    }
}

impl FromIterator<Feature> for Features {
    fn from_iter<I: IntoIterator<Item = Feature>>(features: I) -> Features {
        Features(features.into_iter().fold(0, |bits, feature| bits | feature.bit()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_set_has_what_it_was_made_of() {
        let needs = Features::of(&[Feature::Subgroups, Feature::RayQuery]);
        let device: Features = [Feature::RayQuery, Feature::Timestamps].into_iter().collect();
        assert!(needs.has(Feature::Subgroups) && !needs.has(Feature::Timestamps));
        assert_eq!(needs.missing_in(device).iter().collect::<Vec<_>>(), [Feature::Subgroups]);
        assert_eq!(needs.intersection(device), Features::of(&[Feature::RayQuery]));
        assert_eq!(needs.union(device).iter().count(), 3);
        assert!(Features::default().missing_in(device).is_empty());
    }
}
