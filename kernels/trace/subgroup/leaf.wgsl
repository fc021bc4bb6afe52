// The triangles of a leaf against the rays of a packet: each member reads one triangle, and all test one after another.

// hit_turned(k, a, b, c): the distance of the hit of ray k, alike the others, or NO_HIT
//!slot packet_test

fn test_leaf(first: u32, count: u32, rows: u32) {
    add_rows_tests(rows, count);
    for (var begin = 0u; begin < count; begin += 8u) {
        let triangles = min(count - begin, 8u);
        let corners = read_corners(first + begin + min(member, triangles - 1u));
        let origin = select(vec3<f32>(0.0, 0.0, 0.0), frame.origin, alike);
        let a = turned(corners.a - origin);
        let b = turned(corners.b - origin);
        let c = turned(corners.c - origin);
        for (var i = 0u; i < triangles; i += 1u) {
            test_rows(
                vector_from_member(a, i), vector_from_member(b, i), vector_from_member(c, i), first + begin + i, rows,
            );
        }
    }
    find_farthest();
}

// One triangle: its corners, without the origin and turned where rays are alike.
fn test_rows(a: vec3<f32>, b: vec3<f32>, c: vec3<f32>, triangle_ref: u32, rows: u32) {
    //!repeat RAYS k
    if ((rows & (1u << {k}u)) != 0u) {
        var t = NO_HIT;
        if (alike) {
            t = hit_turned(inverses[{k}], a, b, c);
        } else {
            t = intersect(ray_of({k}u), a, b, c).t;
        }
        // As test_triangle does
        if (t <= nearest_t[{k}]) {
            if (t < nearest_t[{k}] || has_lower_index(read_triangle_index(triangle_ref), nearest_ref[{k}])) {
                nearest_t[{k}] = t;
                nearest_ref[{k}] = triangle_ref;
            }
        }
    }
    //!end
}
