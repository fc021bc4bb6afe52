// One frame, or a band of its rows: ray generation, traversal, shading and secondary rays in one dispatch.
// One invocation per pixel, 8x8 neighbouring pixels per work-group. Twin: src/cpu/render.rs.
//
// Specialised by SHADOWS and BOUNCES (ray configurations P, PS, PSR), by the traversal, and by counting or not.

//!include lib/geom.wgsl
//!include lib/scene.wgsl
//!slot counting
//!slot store

var<private> lane: u32; // index in the work-group

//!slot traversal
//!include lib/shade.wgsl

struct Frame {
    origin: vec3<f32>,
    width: u32,
    corner: vec3<f32>,    // from the eye to the image plane's top left corner
    first_row: u32,
    right: vec3<f32>,     // one pixel to the right
    rows: u32,            // rows of this band
    down: vec3<f32>,      // one pixel down
    epsilon: f32,         // how far secondary rays start off the surface
    background: vec3<f32>,
    light_count: u32,
    first_light: u32,     // of this frame, in `lights`
    first_pixel: u32,     // where this band begins in the output
    pad0: u32,
    pad1: u32,
}

@group(0) @binding(0) var<uniform> frame: Frame;

const PRIMARY: u32 = 0u;
const SHADOW: u32 = 1u;
const REFLECTED: u32 = 2u;

fn primary_ray(column: u32, row: u32) -> Ray {
    let x = f32(column) + 0.5;
    let y = f32(row) + 0.5;
    return ray_along(frame.origin, unit(frame.corner + frame.right * x + frame.down * y));
}

// Consecutive invocations lie in squares (Morton order), so that those that share an instruction stream, be it 8, 16 or
// 32 of them, have neighbouring rays in both directions.
fn place_in_group(i: u32) -> vec2<u32> {
    return vec2<u32>((i & 1u) | ((i >> 1u) & 2u) | ((i >> 2u) & 4u), ((i >> 1u) & 1u) | ((i >> 2u) & 2u) | ((i >> 3u) & 4u));
}

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) local_index: u32,
) {
    lane = local_index;
    let place = place_in_group(local_index);
    let column = group.x * 8u + place.x;
    let band_row = group.y * 8u + place.y;
    let inside = column < frame.width && band_row < frame.rows;

    var ray = primary_ray(column, frame.first_row + band_row);
    var alive = inside;
    var colour = vec3<f32>(0.0, 0.0, 0.0);
    var weight = 1.0; // product of the reflectivities on the way
    var first_triangle = MISS;
    var first_t = T_MAX;

    for (var bounce = 0u; bounce <= BOUNCES; bounce += 1u) {
        if (!group_any(alive)) {
            break;
        }

        // Find the nearest hit
        if (alive) {
            count_ray(select(REFLECTED, PRIMARY, bounce == 0u));
        }
        let record = nearest_hit(ray, alive);

        // Make it a surface; whatever is missed shows the background and is done
        var surface: Surface;
        if (alive) {
            if (record == MISS) {
                colour += frame.background * weight;
                alive = false;
            } else {
                surface = surface_at(ray, record, frame.epsilon);
                if (bounce == 0u) {
                    first_triangle = surface.triangle;
                    first_t = surface.t;
                }
                colour += materials[surface.material].ambient * weight;
            }
        }
        if (!group_any(alive)) {
            break;
        }

        // Add the light of every lamp that is seen from there
        for (var i = 0u; i < frame.light_count; i += 1u) {
            let light = lights[frame.first_light + i];
            var lit = alive;
            if (SHADOWS) {
                // From the light towards the point, which lies at distance 1
                if (alive) {
                    count_ray(SHADOW);
                }
                let shadow = ray_along(light.position.xyz, surface.point - light.position.xyz);
                lit = !any_hit(shadow, 1.0, alive) && alive;
            }
            if (lit) {
                colour += phong(surface, light, ray.direction) * weight;
            }
        }

        // Go on in the mirror
        if (BOUNCES > 0u && alive) {
            let reflectivity = materials[surface.material].reflectivity;
            alive = reflectivity > 0.0;
            weight = weight * reflectivity;
            ray = reflected_ray(surface, ray.direction);
        }
    }

    if (inside) {
        store(frame.first_pixel + band_row * frame.width + column, first_triangle, first_t, rgba8(colour));
    }
}
