// View samples of what the camera's rays hit. One invocation per pixel. Twin: src/workloads/splat/samples.rs.

//!include splat/list.wgsl
//!include splat/surface.wgsl
//!include splat/view.wgsl

@group(0) @binding(2) var<storage, read> rays: array<TraceRay>;
@group(0) @binding(3) var<storage, read> hits: array<TraceHit>;
@group(0) @binding(4) var<storage, read_write> positions: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> normals: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> albedos: array<vec4<f32>>;

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local_index: u32) {
    let pixel = list_index(group, local_index, view.row_groups);
    if (pixel >= view.pixels) {
        return;
    }
    var position = vec4<f32>(0.0, 0.0, 0.0, 0.0);
    var normal = position;
    var albedo = position;
    let hit = hits[pixel];
    if (hit.triangle != MISS) {
        let direction = rays[pixel].direction.xyz;
        let surface = surface_at(rays[pixel].origin.xyz, direction, hit.triangle, view.epsilon);
        position = vec4<f32>(surface.point, hit.t * dot3(direction, view.forward));
        normal = vec4<f32>(surface.normal, 0.0);
        albedo = vec4<f32>(surface.albedo, 0.0);
    }
    positions[pixel] = position;
    normals[pixel] = normal;
    albedos[pixel] = albedo;
}
