// A pixel from its primary ray to its colour, for entries in one pass. Twin: src/workloads/trace/render.rs.

//!include trace/path.wgsl

// shade_primary(place, &path, triangle_ref): what follows from the nearest hit of a primary ray
//!slot secondary

// Whole work-groups call it together; places outside the band take part in barriers.
fn render_pixel(place: vec2<u32>) {
    var path = start_path(place);
    if (path.alive) {
        begin_ray(PRIMARY);
    }
    shade_primary(place, &path, nearest_hit(path.ray, path.alive));
    if (is_in_band(place)) {
        store(pixel_index(place), path.first_triangle, path.first_t, rgba8(path.colour));
    }
}
