// A direction over the hemisphere around a unit normal, distributed as the cosine: the normal plus a vector that is
// uniform over the sphere, with unit length. Twin: src/workloads/random.rs.

fn cosine_direction(normal: vec3<f32>, vector: vec3<f32>) -> vec3<f32> {
    let sum = normal + vector;
    let square = dot3(sum, sum);
    if (square < 1.0e-12) {
        return normal;
    }
    return sum / sqrt(square);
}
