// A blur of irradiance along rows or columns whose weights fall with the difference of depths and normals. One
// invocation per pixel. Twin: src/workloads/splat/splatting/blur.rs.

//!include lib/geom.wgsl
//!include splat/list.wgsl
//!include splat/random.wgsl

struct BlurJob {
    width: u32,
    height: u32,
    row_groups: u32,
    reach: u32,      // in pixels: twice the standard deviation
    is_vertical: u32,
    depths: f32,     // difference of depths, as a share of the depth, without weight
    one: f32,
    pad: u32,
    weights: array<vec4<f32>, 9>, // by distance
}

@group(0) @binding(0) var<uniform> job: BlurJob;
@group(0) @binding(1) var<storage, read> samples: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> normals: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> sharp: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> blurred: array<vec4<f32>>;

fn blur(pixel: u32) -> vec3<f32> {
    let depth = samples[pixel].w;
    if (depth <= 0.0) {
        return vec3<f32>(0.0, 0.0, 0.0);
    }
    let normal = normals[pixel].xyz;
    let is_vertical = job.is_vertical == 1u;
    let place = select(pixel % job.width, pixel / job.width, is_vertical);
    let end = select(job.width, job.height, is_vertical);
    let step = select(1u, job.width, is_vertical);
    let first = max(place, job.reach) - job.reach;
    let last = min(place + job.reach, end - 1u);
    var sum = vec3<f32>(0.0, 0.0, 0.0);
    var total = 0.0;
    for (var other = first; other <= last; other += 1u) {
        let at = pixel + other * step - place * step;
        let far = samples[at].w;
        let near = job.one - abs(depth - far) / (job.depths * depth);
        let alike = dot3(normal, normals[at].xyz);
        if (far > 0.0 && near > 0.0 && alike > 0.0) {
            let square = alike * alike;
            let fourth = square * square;
            let distance = max(other, place) - min(other, place);
            let weight = job.weights[distance >> 2u][distance & 3u] * near * (fourth * fourth);
            sum += flushed(sharp[at].xyz * weight);
            total += weight;
        }
    }
    if (total > 0.0) {
        return flushed(sum / total);
    }
    return vec3<f32>(0.0, 0.0, 0.0);
}

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local_index: u32) {
    let pixel = list_index(group, local_index, job.row_groups);
    if (pixel < job.width * job.height) {
        blurred[pixel] = vec4<f32>(blur(pixel), 0.0);
    }
}
