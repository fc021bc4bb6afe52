// The test of Möller and Trumbore takes rays as they are.

const ALIKE_FORM: bool = false;

fn hit_turned(inverse: vec3<f32>, v0: vec3<f32>, v1: vec3<f32>, v2: vec3<f32>) -> f32 {
    return NO_HIT;
}
