// What a pixel's path is made of: primary rays, and one segment with its surface and its light. The entry files
// trace/render.wgsl and trace/staged/*.wgsl, and trace/secondary/*.wgsl, put segments together. Twin:
// src/workloads/trace/path.rs.
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
    part: u32,            // number of this band among all of its upload
    ambient_reach: f32,   // how far from a surface an ambient ray reaches
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

// The path of a pixel.
struct Path {
    ray: Ray,            // its next segment
    alive: bool,         // there is a next segment
    colour: vec3<f32>,   // gathered so far
    weight: f32,         // product of the reflectivities on the way
    first_triangle: u32, // what the primary ray hits, or MISS
    first_t: f32,
}

// The pixel's place in its band.
fn place_in_band(group: vec3<u32>) -> vec2<u32> {
    let place = place_in_group(lane);
    let group_rows = (frame.rows + GROUP_HEIGHT - 1u) / GROUP_HEIGHT;
    return vec2<u32>(group.x * GROUP_WIDTH, row_of_groups(group.y, group_rows) * GROUP_HEIGHT) + place;
}

fn is_in_band(place: vec2<u32>) -> bool {
    return place.x < frame.columns && place.y < frame.rows;
}

// Where the pixel's output is.
fn pixel_index(place: vec2<u32>) -> u32 {
    return frame.first_pixel + place.y * frame.width + frame.first_column + place.x;
}

fn start_path(place: vec2<u32>) -> Path {
    let ray = primary_ray(sample_position(frame.first_column + place.x, frame.first_row + place.y));
    return Path(ray, is_in_band(place), vec3<f32>(0.0, 0.0, 0.0), 1.0, MISS, T_MAX);
}

// The surface at a segment's nearest hit. A path whose ray misses shows the background and is done.
fn surface_of(kind: u32, path: ptr<function, Path>, triangle_ref: u32) -> Surface {
    var surface: Surface;
    if ((*path).alive) {
        if (triangle_ref == MISS) {
            (*path).colour += frame.background * (*path).weight;
            (*path).alive = false;
        } else {
            surface = surface_at((*path).ray, triangle_ref, frame.epsilon);
            if (kind == PRIMARY) {
                (*path).first_triangle = surface.triangle;
                (*path).first_t = surface.t;
            }
        }
    }
    return surface;
}

// Traces the segment of rays of this kind, adds its light, and makes the mirrored ray the next one. Whole work-groups
// call it together. False if nothing of the work-group was hit.
fn follow(kind: u32, path: ptr<function, Path>) -> bool {
    if ((*path).alive) {
        begin_ray(kind);
    }
    return follow_hit(kind, path, nearest_hit((*path).ray, (*path).alive));
}

// The same for a segment whose nearest hit is known.
fn follow_hit(kind: u32, path: ptr<function, Path>, triangle_ref: u32) -> bool {
    let ray = (*path).ray;
    let surface = surface_of(kind, path, triangle_ref);
    var ambient: vec4<f32>; // colour and reflectivity
    if ((*path).alive) {
        ambient = read_ambient(surface.material);
        (*path).colour += ambient.xyz * (*path).weight;
    }
    if (!group_any((*path).alive)) {
        return false;
    }

    // Add the light of every lamp that is seen from there
    for (var i = 0u; i < frame.light_count; i += 1u) {
        let light = read_light(frame.first_light + i);
        var lit = (*path).alive;
        if (SHADOWS) {
            // Between light and point, of which one is at distance 0 and the other at distance 1
            if ((*path).alive) {
                begin_ray(SHADOW);
            }
            let position = light.position.xyz;
            let start = select(shadow_start(position, surface.point), surface.point, TO_LIGHT);
            let end = select(surface.point, position, TO_LIGHT);
            let shadow = make_ray(start, end - start);
            lit = !any_hit(shadow, 1.0, (*path).alive) && (*path).alive;
        }
        if (lit) {
            (*path).colour += phong(surface, light, ray.direction) * (*path).weight;
        }
    }

    // Go on in the mirror
    if (BOUNCES > 0u && (*path).alive) {
        (*path).alive = ambient.w > 0.0;
        (*path).weight = (*path).weight * ambient.w;
        (*path).ray = reflected_ray(surface, ray.direction);
    }
    return true;
}
