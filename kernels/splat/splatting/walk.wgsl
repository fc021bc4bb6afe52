// What photons need on their way to the boxes that they touch. Twin: src/workloads/splat/splatting/walk.rs.

//!include lib/geom.wgsl
//!include splat/clusters/ordered.wgsl
//!include splat/clusters/placement.wgsl

struct SplatJob {
    level_offsets: vec4<u32>, // where the nodes of levels 1 to 4 begin
    slots: u32,               // most photons
    capacity: u32,            // entries of lists, or clusters with buckets
    level: u32,               // where the walk ends: 5 for clusters, 1 to 4 for nodes
    normal_mask: u32,         // the bits of a key that tell its normal
    radius: f32,
    radius2: f32,
    peak: f32,                // the kernel's value at distance 0
    one: f32,
    facets: array<vec4<f32>, 54>, // of each normal: the axis of its cell, and the product from which on it faces away
}

struct Photon {
    point: vec3<f32>, // along the axes of the boxes
    index: u32,
    direction: vec3<f32>,
    reach2: f32,
}

@group(0) @binding(0) var<uniform> job: SplatJob;
@group(0) @binding(1) var<storage, read> positions: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> directions: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> state: array<u32>; // number of photons, the bits of the scale of buckets
@group(0) @binding(4) var<storage, read> axes: array<vec4<f32>>; // x, y, z, origin and margin
@group(0) @binding(5) var<storage, read> boxes: array<u32>;

fn photon_of(index: u32) -> Photon {
    let placement = placement_of(axes[0], axes[1], axes[2], axes[3]);
    let reach = select(0.0, job.radius + placement.margin, job.radius > 0.0);
    return Photon(placed(placement, positions[index].xyz), index, directions[index].xyz, reach * reach);
}

fn touches(photon: Photon, low: vec3<f32>, high: vec3<f32>) -> bool {
    let way = photon.point - min(max(photon.point, low), high);
    return dot3(way, way) < photon.reach2;
}

// True if no normal of a key's cell faces the photon.
fn faces_away(key: u32, photon: Photon) -> bool {
    if (!NORMALS) {
        return false;
    }
    let facet = job.facets[min(key & job.normal_mask, 53u)];
    return dot3(facet.xyz, photon.direction) >= facet.w;
}

fn cluster_low(cluster: u32) -> vec3<f32> {
    let first = 6u * cluster;
    return vec3<f32>(unordered(boxes[first]), unordered(boxes[first + 1u]), unordered(boxes[first + 2u]));
}

fn cluster_high(cluster: u32) -> vec3<f32> {
    let first = 6u * cluster + 3u;
    return vec3<f32>(unordered(boxes[first]), unordered(boxes[first + 1u]), unordered(boxes[first + 2u]));
}
