// From keys to clusters; the including kernel declares `places` and `mask_at`. BITS: places are of words of bits, which
// begin at a word of the masks. Twin: src/workloads/splat/clusters/lookup.rs.

const NONE = 0xffffffffu; // the key and the identifier of a pixel without a sample

// The cluster of a key that exists.
fn identifier_of(key: u32, first_word: u32) -> u32 {
    if (BITS) {
        let word = key >> 5u;
        return places[word] + countOneBits(mask_at(first_word + word) & ((1u << (key & 31u)) - 1u));
    }
    return places[key];
}
