// What a frame reads. Twins: src/workloads/spheres/view.rs, src/workloads/spheres/scene/mod.rs.
//
// All constants of sums are in the view: a driver may reorder sums with literals.

struct View {
    origin: vec3<f32>,
    epsilon: f32,
    corner: vec3<f32>,
    intensity: f32,
    right: vec3<f32>,
    half: f32,
    down: vec3<f32>,
    one: f32,
    light: vec3<f32>,
    two: f32,
    light_color: vec3<f32>,
    far: f32,
    ambient: vec3<f32>,
    spheres: u32,
    width: u32,
    height: u32,
    trips: u32,
    pad: u32,
}

// A part of a frame, which a dispatch renders.
struct Band {
    view: View,
    first_column: u32,
    first_row: u32,
    columns: u32,
    rows: u32,
}

//!slot precision

@group(0) @binding(0) var<uniform> band: Band;
