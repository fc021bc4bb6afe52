// One frame, or a band of its rows: ray generation, traversal, shading and secondary rays in one dispatch.
// One invocation per pixel, GROUP_WIDTH x GROUP_HEIGHT neighbouring pixels (8x8 as a rule) per work-group. Twin:
// src/workloads/trace/render.rs.
//
// Specialised by SHADOWS and BOUNCES (ray configurations P, PS, PSR), by the traversal, by counting or not, and by what
// src/workloads/trace/method.rs lists.

//!include lib/geom.wgsl
//!include trace/scene.wgsl
//!slot counting
//!slot store

var<private> lane: u32; // index in the work-group

//!slot traversal
//!include trace/shade.wgsl

struct Frame {
    origin: vec3<f32>,
    width: u32,           // of the image
    corner: vec3<f32>,    // from the eye to the image plane's top left corner
    first_row: u32,
    right: vec3<f32>,     // one pixel to the right
    rows: u32,            // rows of this band
    down: vec3<f32>,      // one pixel down
    epsilon: f32,         // how far secondary rays start off the surface
    background: vec3<f32>,
    light_count: u32,
    first_light: u32,     // of this frame, in `lights`
    first_pixel: u32,     // where this band begins in the output, if it had all columns
    first_column: u32,
    columns: u32,         // columns of this band
    height: u32,          // of the image
    shadow_reach: f32,    // how far from a point shadow rays from a light start at most
    pad0: u32,
    pad1: u32,
}

@group(0) @binding(0) var<uniform> frame: Frame;

const PRIMARY: u32 = 0u;
const SHADOW: u32 = 1u;
const REFLECTED: u32 = 2u;

// Through a point of the image, in pixels from its top left corner.
fn primary_ray(point: vec2<f32>) -> Ray {
    return make_ray(frame.origin, normalize3(frame.corner + frame.right * point.x + frame.down * point.y));
}

// Consecutive invocations lie in squares (Morton order) as far as the group's shape allows, so that those that share an
// instruction stream, be it 8, 16 or 32 of them, have neighbouring rays in both directions.
fn place_in_group(i: u32) -> vec2<u32> {
    var place = vec2<u32>(0u, 0u);
    var rest = i;
    for (var bit = 1u; bit < max(GROUP_WIDTH, GROUP_HEIGHT); bit = bit << 1u) {
        if (bit < GROUP_WIDTH) {
            place.x |= (rest & 1u) * bit;
            rest = rest >> 1u;
        }
        if (bit < GROUP_HEIGHT) {
            place.y |= (rest & 1u) * bit;
            rest = rest >> 1u;
        }
    }
    return place;
}

// The row of work-groups for the y-th one. A driver without a GPU gives each of its threads one contiguous share of the
// groups and waits for the slowest: dealt out in turn, rows make these shares alike.
fn row_of_groups(y: u32, rows: u32) -> u32 {
    if (!SOFTWARE) {
        return y;
    }
    // Without dividing by what is no constant, which takes such a driver hundreds of cycles
    let share = rows / THREADS;
    let longer = rows % THREADS; // so many shares have a row more
    var place = y;
    var thread = 0u;
    loop {
        let own = share + select(0u, 1u, thread < longer);
        if (place < own) {
            break;
        }
        place -= own;
        thread += 1u;
    }
    return place * THREADS + thread;
}

// The position in the image that the ray of a pixel goes through: the middle of the pixel, or with FOUR_RAYS one of
// four points for the whole work-group. These lie at a quarter and three quarters of the image's sides, so that the
// rays are the same at every resolution.
fn sample_position(column: u32, row: u32) -> vec2<f32> {
    if (FOUR_RAYS) {
        let x = f32(frame.width) * (0.25 + 0.5 * f32(column / GROUP_WIDTH & 1u));
        let y = f32(frame.height) * (0.25 + 0.5 * f32(row / GROUP_HEIGHT & 1u));
        return vec2<f32>(x, y);
    }
    return vec2<f32>(f32(column) + 0.5, f32(row) + 0.5);
}

// The light, or the point towards it at the greatest distance at which a shadow ray starts: nothing lies beyond, and
// rays that start at a distant light could not tell the point from its neighbours.
fn shadow_start(light: vec3<f32>, point: vec3<f32>) -> vec3<f32> {
    let way = light - point;
    let distance = sqrt(dot3(way, way));
    return select(light, point + way * (frame.shadow_reach / distance), distance > frame.shadow_reach);
}

@compute @workgroup_size(GROUP_SIZE)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) local_index: u32,
) {
    lane = local_index;
    let place = place_in_group(local_index);
    let group_rows = (frame.rows + GROUP_HEIGHT - 1u) / GROUP_HEIGHT;
    let band_column = group.x * GROUP_WIDTH + place.x;
    let band_row = row_of_groups(group.y, group_rows) * GROUP_HEIGHT + place.y;
    let inside = band_column < frame.columns && band_row < frame.rows;
    let column = frame.first_column + band_column;

    var ray = primary_ray(sample_position(column, frame.first_row + band_row));
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
            begin_ray(select(REFLECTED, PRIMARY, bounce == 0u));
        }
        let triangle_ref = nearest_hit(ray, alive);

        // Make it a surface; a ray that misses shows the background and is done
        var surface: Surface;
        if (alive) {
            if (triangle_ref == MISS) {
                colour += frame.background * weight;
                alive = false;
            } else {
                surface = surface_at(ray, triangle_ref, frame.epsilon);
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
                // Between light and point, of which one is at distance 0 and the other at distance 1
                if (alive) {
                    begin_ray(SHADOW);
                }
                let position = light.position.xyz;
                let start = select(shadow_start(position, surface.point), surface.point, TO_LIGHT);
                let end = select(surface.point, position, TO_LIGHT);
                let shadow = make_ray(start, end - start);
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
