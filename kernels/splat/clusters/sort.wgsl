// The keys of a tile, sorted by rank: the number of keys below each, and of equal ones before it. Their changes number
// the clusters of the tile. One work-group per tile. Twin: `sort` of src/workloads/splat/clusters/unique.rs.

//!include splat/clusters/tile.wgsl

@group(0) @binding(1) var<storage, read> keys: array<u32>;
@group(0) @binding(2) var<storage, read_write> tiles: array<u32>;       // clusters of each
@group(0) @binding(3) var<storage, read_write> identifiers: array<u32>; // from 0 in each tile

const PLACE_BITS = 2u * SIDE_BITS;
const OWN = (TILE_SAMPLES + GROUP_SIZE - 1u) / GROUP_SIZE; // sorted words of an invocation

// Of each pixel of the tile: the bits of its key that differ within the tile, shifted above its place. Used again for
// the number of changes of each invocation.
var<workgroup> words: array<u32, SORT_WORDS>;
var<workgroup> sorted: array<u32, TILE_SAMPLES>;

// The bits of a key that differ within a tile, side by side; their order stays.
fn within_tile(key: u32) -> u32 {
    var part = 0u;
    var place = 0u;
    for (var rest = job.within; rest != 0u; rest = rest & (rest - 1u)) {
        part = part | (((key >> firstTrailingBit(rest)) & 1u) << place);
        place += 1u;
    }
    return part;
}

// True for the first of equal keys.
fn is_change(i: u32) -> bool {
    if (i >= TILE_SAMPLES || sorted[i] == NONE) {
        return false;
    }
    if (i == 0u) {
        return true;
    }
    return ((sorted[i] ^ sorted[i - 1u]) >> PLACE_BITS) != 0u;
}

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let tile = tile_of(group);
    if (tile >= job.tiles) {
        return;
    }
    for (var i = lane; i < TILE_SAMPLES; i += GROUP_SIZE) {
        var word = NONE;
        let pixel = pixel_at(tile, i);
        if (pixel != NONE) {
            let key = keys[pixel];
            if (key == NONE) {
                identifiers[pixel] = NONE;
            } else {
                word = (within_tile(key) << PLACE_BITS) | i;
            }
        }
        words[i] = word;
        sorted[i] = NONE;
    }
    workgroupBarrier();
    let count = job.tile * job.tile;
    for (var i = lane; i < count; i += GROUP_SIZE) {
        let word = words[i];
        if (word != NONE) {
            // The place is a part of the word: no two are equal
            var rank = 0u;
            for (var j = 0u; j < count; j += 1u) {
                rank += select(0u, 1u, words[j] < word);
            }
            sorted[rank] = word;
        }
    }
    workgroupBarrier();
    var changes = 0u;
    for (var i = lane * OWN; i < (lane + 1u) * OWN; i += 1u) {
        changes += select(0u, 1u, is_change(i));
    }
    words[lane] = changes;
    workgroupBarrier();
    var number = 0u;
    for (var i = 0u; i < lane; i += 1u) {
        number += words[i];
    }
    if (lane == GROUP_SIZE - 1u) {
        tiles[tile] = number + changes;
    }
    for (var i = lane * OWN; i < min((lane + 1u) * OWN, TILE_SAMPLES); i += 1u) {
        number += select(0u, 1u, is_change(i));
        if (sorted[i] != NONE) {
            identifiers[pixel_at(tile, sorted[i] & ((1u << PLACE_BITS) - 1u))] = number - 1u;
        }
    }
}
