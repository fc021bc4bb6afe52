// The axes that boxes are aligned to. Twin: src/workloads/splat/clusters/placement.rs.

//!include lib/geom.wgsl

struct Placement {
    axis_x: vec3<f32>, // unit vectors
    axis_y: vec3<f32>,
    axis_z: vec3<f32>,
    origin: vec3<f32>,
    margin: f32,       // what a distance along the axes may be too large by
}

// From the four vectors of a buffer that splat/clusters/keys.wgsl wrote.
fn placement_of(x: vec4<f32>, y: vec4<f32>, z: vec4<f32>, origin: vec4<f32>) -> Placement {
    return Placement(x.xyz, y.xyz, z.xyz, origin.xyz, origin.w);
}

// A point along the axes.
fn placed(placement: Placement, point: vec3<f32>) -> vec3<f32> {
    let way = point - placement.origin;
    return vec3<f32>(dot3(way, placement.axis_x), dot3(way, placement.axis_y), dot3(way, placement.axis_z));
}
