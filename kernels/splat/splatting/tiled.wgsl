// The baseline: every tile of the image finds the photons near the box of its samples among all. One work-group per
// tile; a block of photons at a time is tested, and those near go to work-group memory. Twin:
// src/workloads/splat/splatting/tiled.rs.

//!include splat/clusters/placement.wgsl
//!include splat/splatting/terms.wgsl
//!include splat/view.wgsl

struct TiledJob {
    tile: u32,    // side in pixels
    slots: u32,   // most photons
    radius: f32,
    radius2: f32,
    peak: f32,    // the kernel's value at distance 0
    one: f32,
    pad0: u32,
    pad1: u32,
}

@group(0) @binding(1) var<uniform> job: TiledJob;
@group(0) @binding(2) var<storage, read> samples: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> normals: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> positions: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> directions: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> fluxes: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> photons: array<u32>; // the first word is their number
@group(0) @binding(8) var<storage, read_write> irradiance: array<vec4<f32>>;

const FAR: f32 = 1.0e18; // a box without samples begins and ends here

var<workgroup> near_positions: array<vec4<f32>, BLOCK>;
var<workgroup> near_directions: array<vec4<f32>, BLOCK>;
var<workgroup> near_fluxes: array<vec4<f32>, BLOCK>;
var<workgroup> near: array<atomic<u32>, BLOCK / 32>; // a bit for each photon of the block

fn along(point: vec3<f32>) -> vec3<f32> {
    return placed(Placement(view.axis_x, view.axis_y, view.axis_z, view.axes_origin, view.margin), point);
}

// The pixel of a tile's place, or the number of all pixels outside of the image.
fn pixel_at(tile: vec2<u32>, place: u32) -> u32 {
    let x = tile.x * job.tile + place % job.tile;
    let y = tile.y * job.tile + place / job.tile;
    return select(view.pixels, y * view.width + x, place < job.tile * job.tile && x < view.width && y < view.height);
}

fn sum_of_block(sample: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    let terms = Terms(job.radius2, job.peak, job.one);
    var sum = vec3<f32>(0.0, 0.0, 0.0);
    for (var word = 0u; word < BLOCK / 32u; word += 1u) {
        var left = atomicLoad(&near[word]);
        while (left != 0u) {
            let at = 32u * word + firstTrailingBit(left);
            left = left & (left - 1u);
            let position = near_positions[at].xyz;
            sum += term(terms, sample, normal, position, near_directions[at].xyz, near_fluxes[at].xyz);
        }
    }
    return sum;
}

@compute @workgroup_size(BLOCK)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local_index: u32,
) {
    let columns = (view.width + job.tile - 1u) / job.tile;
    let number = group.y * groups.x + group.x;
    let tile = vec2<u32>(number % columns, number / columns);
    let places = job.tile * job.tile;
    if (tile.y * job.tile >= view.height) {
        return;
    }
    var low = vec3<f32>(FAR, FAR, FAR);
    var high = -low;
    for (var place = local_index; place < places; place += BLOCK) {
        let pixel = pixel_at(tile, place);
        if (pixel < view.pixels) {
            let sample = samples[pixel];
            if (sample.w > 0.0) {
                let point = along(sample.xyz);
                low = min(low, point);
                high = max(high, point);
            }
        }
    }
    near_positions[local_index] = vec4<f32>(low, 0.0);
    near_directions[local_index] = vec4<f32>(high, 0.0);
    workgroupBarrier();
    for (var half = BLOCK / 2u; half > 0u; half = half >> 1u) {
        if (local_index < half) {
            near_positions[local_index] = min(near_positions[local_index], near_positions[local_index + half]);
            near_directions[local_index] = max(near_directions[local_index], near_directions[local_index + half]);
        }
        workgroupBarrier();
    }
    low = near_positions[0].xyz;
    high = near_directions[0].xyz;
    let reach = select(0.0, job.radius + view.margin, job.radius > 0.0);
    let count = min(photons[0], job.slots);
    for (var first = 0u; first < places; first += BLOCK) {
        let pixel = pixel_at(tile, first + local_index);
        var sample = vec4<f32>(0.0, 0.0, 0.0, 0.0);
        var normal = vec3<f32>(0.0, 0.0, 0.0);
        if (pixel < view.pixels) {
            sample = samples[pixel];
            normal = normals[pixel].xyz;
        }
        var sum = vec3<f32>(0.0, 0.0, 0.0);
        for (var block = 0u; block < count; block += BLOCK) {
            workgroupBarrier();
            if (local_index < BLOCK / 32u) {
                atomicStore(&near[local_index], 0u);
            }
            workgroupBarrier();
            let photon = block + local_index;
            if (photon < count) {
                let position = positions[photon];
                let point = along(position.xyz);
                let way = point - min(max(point, low), high);
                if (dot3(way, way) < reach * reach) {
                    near_positions[local_index] = position;
                    near_directions[local_index] = directions[photon];
                    near_fluxes[local_index] = fluxes[photon];
                    atomicOr(&near[local_index / 32u], 1u << (local_index & 31u));
                }
            }
            workgroupBarrier();
            if (sample.w > 0.0) {
                sum += sum_of_block(sample.xyz, normal);
            }
        }
        if (pixel < view.pixels) {
            irradiance[pixel] = vec4<f32>(sum, 0.0);
        }
    }
}
