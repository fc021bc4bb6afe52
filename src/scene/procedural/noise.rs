//! Gradient noise from an integer hash: additions and multiplications only, the same bits on every machine.

use glam::{Vec2, Vec3};

/// Scrambles the bits of a word (the finaliser of MurmurHash3).
pub fn scramble(mut x: u32) -> u32 {
    x = (x ^ (x >> 16)).wrapping_mul(0x85EB_CA6B);
    x = (x ^ (x >> 13)).wrapping_mul(0xC2B2_AE35);
    x ^ (x >> 16)
}

/// A hash of a lattice point.
fn lattice(x: i32, y: i32, z: i32, seed: u32) -> u32 {
    let h = scramble(x as u32 ^ seed.wrapping_mul(0x9E37_79B9));
    let h = scramble(h ^ (y as u32).wrapping_mul(0x85EB_CA77));
    scramble(h ^ (z as u32).wrapping_mul(0xC2B2_AE3D))
}

/// A number in 0..1 that depends on `index` and `seed` only.
pub fn random(index: u32, seed: u32) -> f32 {
    (lattice(index as i32, 0, 0, seed) >> 8) as f32 / (1u32 << 24) as f32
}

/// Quintic fade (Perlin 2002): first and second derivative vanish at 0 and 1.
fn fade(t: f32) -> f32 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

fn mix(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}

/// Gradient noise in space, about -1 to 1.
pub fn noise3(p: Vec3, seed: u32) -> f32 {
    let floor = p.floor();
    let f = p - floor;
    let (x, y, z) = (floor.x as i32, floor.y as i32, floor.z as i32);
    let corner = |dx: i32, dy: i32, dz: i32| {
        let h = lattice(x.wrapping_add(dx), y.wrapping_add(dy), z.wrapping_add(dz), seed);
        let gradient = Vec3::new(
            (h & 0x3FF) as f32 / 511.5 - 1.0,
            (h >> 10 & 0x3FF) as f32 / 511.5 - 1.0,
            (h >> 20 & 0x3FF) as f32 / 511.5 - 1.0,
        );
        gradient.dot(f - Vec3::new(dx as f32, dy as f32, dz as f32))
    };
    let (u, v, w) = (fade(f.x), fade(f.y), fade(f.z));
    let edge = |dy, dz| mix(corner(0, dy, dz), corner(1, dy, dz), u);
    let face = |dz| mix(edge(0, dz), edge(1, dz), v);
    mix(face(0), face(1), w) * 1.2
}

/// Gradient noise in the plane, about -1 to 1.
pub fn noise2(p: Vec2, seed: u32) -> f32 {
    noise3(Vec3::new(p.x, 0.37, p.y), seed)
}

/// Ridged noise, 0 to about 1: sharp crests where the noise passes zero, each octave weighted by the one before, so that
/// valleys stay smooth (Musgrave's ridged multifractal).
pub fn ridged(p: Vec2, octaves: u32, seed: u32) -> f32 {
    let (mut sum, mut amplitude, mut weight, mut scale) = (0.0, 0.5, 1.0f32, 1.0);
    for octave in 0..octaves {
        let crest = 1.0 - noise2(p * scale, seed + octave).abs();
        let crest = crest * crest * weight;
        sum += crest * amplitude;
        weight = (crest * 1.6).clamp(0.0, 1.0);
        amplitude *= 0.5;
        scale *= 2.03;
    }
    sum
}

/// Fractal sum of octaves, about -1 to 1.
pub fn fractal(p: Vec3, octaves: u32, seed: u32) -> f32 {
    let (mut sum, mut amplitude, mut scale) = (0.0, 0.5, 1.0);
    for octave in 0..octaves {
        sum += noise3(p * scale, seed + octave) * amplitude;
        amplitude *= 0.5;
        scale *= 2.03;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_continuous_bounded_and_fixed() {
        let mut largest = 0.0f32;
        for i in 0..20_000u32 {
            let p = Vec3::new(random(i, 1), random(i, 2), random(i, 3)) * 40.0 - 20.0;
            let value = noise3(p, 7);
            largest = largest.max(value.abs());
            assert!((value - noise3(p + Vec3::splat(1e-4), 7)).abs() < 2e-3);
        }
        assert!((0.6..1.6).contains(&largest), "{largest}");
        assert_eq!(noise3(Vec3::new(0.3, -4.7, 12.1), 5).to_bits(), noise3(Vec3::new(0.3, -4.7, 12.1), 5).to_bits());
        assert_eq!(scramble(1), 0x514E_28B7);
    }
}
