// The pixels of a tile, one tile for each work-group.

struct TileJob {
    tile: u32,       // side in pixels, at most SIDE
    columns: u32,    // of tiles
    tiles: u32,
    row_groups: u32, // work-groups in a row of the dispatch
    width: u32,      // of the image
    height: u32,
    within: u32,     // the bits that differ between the keys of a tile
    clusters: u32,   // most of them
}

const NONE = 0xffffffffu; // the key and the identifier of a pixel without a sample
const TILE_SAMPLES = SIDE * SIDE;

@group(0) @binding(0) var<uniform> job: TileJob;

fn tile_of(group: vec3<u32>) -> u32 {
    return group.y * job.row_groups + group.x;
}

// The pixel at a place of a tile, rows from the top; NONE outside of the image and of the tile.
fn pixel_at(tile: u32, place: u32) -> u32 {
    let row = place / job.tile;
    let x = (tile % job.columns) * job.tile + place % job.tile;
    let y = (tile / job.columns) * job.tile + row;
    if (row >= job.tile || x >= job.width || y >= job.height) {
        return NONE;
    }
    return y * job.width + x;
}
