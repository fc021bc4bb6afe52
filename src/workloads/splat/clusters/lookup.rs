//! From keys to clusters. Twin of `identifier_of` of `kernels/splat/clusters/lookup.wgsl`.

/// Identifiers by key.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lookup {
    /// One bit for each key, up to the largest that exists.
    bits: Vec<u32>,
    /// Keys before each word of bits.
    before: Vec<u32>,
    /// By the key's place among all, in ascending order.
    identifiers: Vec<u32>,
}

impl Lookup {
    /// Identifiers are the places of their keys in this list.
    pub fn new(cluster_keys: &[u32]) -> Lookup {
        let words = cluster_keys.iter().max().map_or(0, |&key| key as usize / 32 + 1);
        let mut bits = vec![0_u32; words];
        for &key in cluster_keys {
            bits[key as usize / 32] |= 1 << (key % 32);
        }
        let (before, count) = before(bits.iter().map(|word| word.count_ones()));
        let mut lookup = Lookup { bits, before, identifiers: vec![0; count as usize] };
        for (identifier, &key) in (0..).zip(cluster_keys) {
            if let Some(place) = lookup.place(key) {
                lookup.identifiers[place] = identifier;
            }
        }
        lookup
    }

    /// The cluster of a key; `None` where no sample has it.
    pub fn identifier_of(&self, key: u32) -> Option<u32> {
        self.place(key).map(|place| self.identifiers[place])
    }

    fn place(&self, key: u32) -> Option<usize> {
        let (word, bit) = (key as usize / 32, 1 << (key % 32));
        let bits = *self.bits.get(word)?;
        (bits & bit != 0).then(|| self.before[word] as usize + (bits & (bit - 1)).count_ones() as usize)
    }
}

/// The sum of the numbers before each, and of all.
pub(super) fn before(numbers: impl Iterator<Item = u32>) -> (Vec<u32>, u32) {
    let mut sum = 0;
    let mut add = |number| {
        sum += number;
        sum - number
    };
    let sums = numbers.map(&mut add).collect();
    (sums, sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identifiers_are_places_in_the_list() {
        let keys = [70, 3, 0, 64, 31, 32];
        let lookup = Lookup::new(&keys);
        for key in 0..200 {
            let place = keys.iter().position(|&other| other == key).map(|place| place as u32);
            assert_eq!(lookup.identifier_of(key), place, "{key}");
        }
        assert_eq!(lookup.identifier_of(u32::MAX), None);
        assert_eq!(Lookup::new(&[]).identifier_of(0), None);
    }
}
