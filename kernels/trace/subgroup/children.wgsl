// The children of a node against the rays of a packet.

// Of each member's child.
struct Children {
    key: u32,       // its distance, the rows that want it and its number; NONE where no row does
    reference: u32,
}

// The interval of distances in a box for all directions in the packet's interval, which contains that of every ray:
// each of its products lies between those of the ends, and rounding is monotone.
fn packet_box(lo: vec3<f32>, hi: vec3<f32>) -> vec2<f32> {
    let from_lo = lo - origin_hi;
    let from_hi = hi - origin_lo;
    let a = from_lo * inverse_lo;
    let b = from_lo * inverse_hi;
    let c = from_hi * inverse_lo;
    let d = from_hi * inverse_hi;
    let near = min(min(a, b), min(c, d));
    let far = max(max(a, b), max(c, d));
    return vec2<f32>(max(max(near.x, near.y), near.z), min(min(far.x, far.y), far.z));
}

// ray_box of a ray without a direction's component of zero, on planes from which its origin is subtracted.
fn inverse_box(inverse: vec3<f32>, from_lo: vec3<f32>, from_hi: vec3<f32>) -> vec2<f32> {
    let a = from_lo * inverse;
    let b = from_hi * inverse;
    let ascending = a < b;
    let near = select(b, a, ascending);
    let far = select(a, b, ascending);
    let near_xy = select(near.y, near.x, near.x > near.y);
    let far_xy = select(far.y, far.x, far.x < far.y);
    return vec2<f32>(select(near_xy, near.z, near.z > near_xy), select(far_xy, far.z, far.z < far_xy));
}

// A bit for each of these rows whose ray of this member meets the box.
fn rows_that_meet(lo: vec3<f32>, hi: vec3<f32>, rows: u32) -> u32 {
    var met = 0u;
    if (alike) {
        let from_lo = lo - origin_hi;
        let from_hi = hi - origin_lo;
        //!repeat RAYS k
        if ((rows & (1u << {k}u)) != 0u) {
            met |= select(0u, 1u << {k}u, overlaps(inverse_box(inverses[{k}], from_lo, from_hi), nearest_t[{k}]));
        }
        //!end
    } else {
        //!repeat RAYS k
        if ((rows & (1u << {k}u)) != 0u) {
            met |= select(0u, 1u << {k}u, overlaps(ray_box(widened(ray_of({k}u)), lo, hi), nearest_t[{k}]));
        }
        //!end
    }
    return met;
}

fn test_children(node: u32, rows: u32) -> Children {
    var slot = read_slot(node * WIDTH + min(member, WIDTH - 1u));
    slot.lo = turned(slot.lo);
    slot.hi = turned(slot.hi);
    let interval = packet_box(slot.lo, slot.hi);
    let is_open = member < WIDTH && slot.reference != EMPTY && overlaps(interval, farthest);
    var open = cluster_or(select(0u, 1u << member, is_open));
    add_rows_boxes(rows, countOneBits(open));
    // Eight bits for each child: the first four, the others
    var met = vec2<u32>(0u, 0u);
    while (open != 0u) {
        let i = firstTrailingBit(open);
        open &= open - 1u;
        let own = rows_that_meet(vector_from_member(slot.lo, i), vector_from_member(slot.hi, i), rows);
        let shifted = own << ((i & 3u) * 8u);
        met |= select(vec2<u32>(shifted, 0u), vec2<u32>(0u, shifted), i >= 4u);
    }
    var wanted = cluster_or(met.x);
    if (WIDTH > 4u) {
        wanted = select(wanted, cluster_or(met.y), member >= 4u);
    }
    wanted = select(0u, (wanted >> ((member & 3u) * 8u)) & 255u, member < WIDTH);
    let distance = select(0.0, interval.x, interval.x > 0.0);
    let key = (bitcast<u32>(distance) & DISTANCE_BITS) | (wanted << 3u) | member;
    return Children(select(key, NONE, wanted == 0u), slot.reference);
}
