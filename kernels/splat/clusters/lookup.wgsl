// From keys to clusters; the including kernel declares `places` and `mask_at`. With BITS `places` has an entry for each
// word of bits: the number of keys in the words before it. `first_word` is the first of these words in the masks.
// Without BITS it has an entry for each key. Twin: src/workloads/splat/clusters/lookup.rs.

const NONE = 0xffffffffu; // the key and the identifier of a pixel without a sample

// The cluster of a key that exists.
fn identifier_of(key: u32, first_word: u32) -> u32 {
    if (BITS) {
        let word = key >> 5u;
        return places[word] + countOneBits(mask_at(first_word + word) & ((1u << (key & 31u)) - 1u));
    }
    return places[key];
}
