// The flux of a photon is added to the bucket of the direction that it came from, in each cluster that it touches.
// Twin: src/workloads/splat/splatting/buckets.rs.

//!include splat/directions.wgsl
//!include splat/random.wgsl
//!slot add

@group(0) @binding(ACTION) var<storage, read> fluxes: array<vec4<f32>>;

var<private> flux: vec3<f32>;
var<private> place: u32;  // of the first channel among the words of a cluster
var<private> scale: f32;

fn begin(photon: Photon) {
    flux = fluxes[photon.index].xyz;
    place = 3u * direction_index(-photon.direction);
    scale = bitcast<f32>(state[1]);
}

fn visit(cluster: u32, photon: Photon, low: vec3<f32>, high: vec3<f32>) {
    if (cluster >= job.capacity) {
        return;
    }
    var part = flux;
    if (CENTRE) {
        let way = photon.point - (low + high) * 0.5;
        let square = dot3(way, way);
        if (!(square < job.radius2)) {
            return;
        }
        var share = job.peak;
        if (!CONSTANT_KERNEL) {
            share = job.peak * (job.one - square / job.radius2);
        }
        part = flushed(flux * share);
    }
    let first = cluster * BUCKET_WORDS + place;
    add(first, part.x);
    add(first + 1u, part.y);
    add(first + 2u, part.z);
}
