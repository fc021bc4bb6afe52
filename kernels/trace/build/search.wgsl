// The place of each cluster's best partner. Twin: `partners` of src/workloads/trace/build/ploc.rs.

//!include trace/build/job.wgsl

@group(0) @binding(1) var<storage, read> clusters: array<vec4<u32>>; // see trace/build/cluster.wgsl
@group(0) @binding(2) var<storage, read_write> partners: array<u32>;

// What is denormal is zero on every device.
fn flushed(x: vec3<f32>) -> vec3<f32> {
    return select(vec3<f32>(0.0), x, abs(x) >= vec3<f32>(MIN_POSITIVE));
}

// A corner in units of about the scene's extent.
fn corner(bits: vec4<u32>) -> vec3<f32> {
    return flushed(flushed(bitcast<vec3<f32>>(bits.xyz)) * job.unit);
}

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var i = id.x; i < job.count; i += job.stride) {
        var best = i;
        if (job.forced != 0u) {
            best = select(i, i ^ 1u, (i ^ 1u) < job.count);
        } else {
            let lo = corner(clusters[2u * i]);
            let hi = corner(clusters[2u * i + 1u]);
            var least = T_MAX;
            let end = min(i + job.radius + 1u, job.count);
            for (var j = i - min(i, job.radius); j < end; j += 1u) {
                if (j != i) {
                    let e = flushed(max(hi, corner(clusters[2u * j + 1u])) - min(lo, corner(clusters[2u * j])));
                    let sides = flushed(e * e.yzx);
                    let cost = sides.x + sides.y + sides.z;
                    if (cost < least || (cost == least && (i ^ j) < (i ^ best))) {
                        least = cost;
                        best = j;
                    }
                }
            }
        }
        partners[i] = best;
    }
}
