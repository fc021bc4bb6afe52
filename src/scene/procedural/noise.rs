//! Gradient noise from an integer hash. It uses additions and multiplications only, and gives the same bits on every
//! machine.

use glam::{Vec2, Vec3};

/// Hashes a word (the finaliser of MurmurHash3).
pub fn scramble(mut x: u32) -> u32 {
    x = (x ^ (x >> 16)).wrapping_mul(0x85EB_CA6B);
    x = (x ^ (x >> 13)).wrapping_mul(0xC2B2_AE35);
    x ^ (x >> 16)
}

/// Spreads small seeds over all bits.
fn salt(seed: u32) -> u32 {
    seed.wrapping_mul(0x9E37_79B9)
}

/// A pseudorandom number in 0..1, a function of `index` and `seed`.
pub fn random(index: u32, seed: u32) -> f32 {
    (scramble(scramble(index ^ salt(seed))) >> 8) as f32 / (1u32 << 24) as f32
}

/// The quintic fade curve (Perlin 2002): its first and second derivatives are zero at 0 and 1.
fn fade(t: f32) -> f32 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

fn mix(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}

/// The largest integer not above `x`. It truncates with `as`, which is much faster than `floor` without SSE 4.1.
fn below(x: f32) -> i32 {
    let truncated = x as i32;
    truncated - i32::from(x < truncated as f32)
}

/// Gradient noise in three dimensions, about -1 to 1.
pub fn noise3(p: Vec3, seed: u32) -> f32 {
    let (x, y, z) = (below(p.x), below(p.y), below(p.z));
    let f = p - Vec3::new(x as f32, y as f32, z as f32);
    // The hash of a corner is computed axis by axis, so that corners share the intermediate hashes.
    let hash_x = [0, 1].map(|d| scramble(x.wrapping_add(d) as u32 ^ salt(seed)));
    let corner = |dx: usize, dy: i32, dz: i32, hash_xy: u32| {
        let h = scramble(hash_xy ^ (z.wrapping_add(dz) as u32).wrapping_mul(0xC2B2_AE3D));
        let component = |bits: u32| (bits & 0x3FF) as f32 * (1.0 / 511.5) - 1.0;
        let gradient = Vec3::new(component(h), component(h >> 10), component(h >> 20));
        gradient.dot(f - Vec3::new(dx as f32, dy as f32, dz as f32))
    };
    let (u, v, w) = (fade(f.x), fade(f.y), fade(f.z));
    let row = |dy: i32| {
        let hash_xy = hash_x.map(|h| scramble(h ^ (y.wrapping_add(dy) as u32).wrapping_mul(0x85EB_CA77)));
        let edge = |dz| mix(corner(0, dy, dz, hash_xy[0]), corner(1, dy, dz, hash_xy[1]), u);
        mix(edge(0), edge(1), w)
    };
    mix(row(0), row(1), v) * 1.2
}

/// Gradient noise in two dimensions, about -1 to 1.
pub fn noise2(p: Vec2, seed: u32) -> f32 {
    let (x, y) = (below(p.x), below(p.y));
    let f = p - Vec2::new(x as f32, y as f32);
    let hash_x = [0, 1].map(|d| scramble(x.wrapping_add(d) as u32 ^ salt(seed)));
    let corner = |dx: usize, dy: i32| {
        let h = scramble(hash_x[dx] ^ (y.wrapping_add(dy) as u32).wrapping_mul(0x85EB_CA77));
        let component = |bits: u32| (bits & 0x7FFF) as f32 * (1.0 / 16383.5) - 1.0;
        Vec2::new(component(h), component(h >> 16)).dot(f - Vec2::new(dx as f32, dy as f32))
    };
    let (u, v) = (fade(f.x), fade(f.y));
    mix(mix(corner(0, 0), corner(1, 0), u), mix(corner(0, 1), corner(1, 1), u), v) * 1.3
}

/// Musgrave's ridged multifractal, 0 to about 1: noise with sharp crests at its zeros. Each octave is weighted by the
/// previous one, so that valleys are smooth.
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

/// The fractal sum of octaves of a noise, about -1 to 1. `octave` computes an octave from its scale and number.
pub fn fractal(octaves: u32, octave: impl Fn(f32, u32) -> f32) -> f32 {
    let (mut sum, mut amplitude, mut scale) = (0.0, 0.5, 1.0);
    for number in 0..octaves {
        sum += octave(scale, number) * amplitude;
        amplitude *= 0.5;
        scale *= 2.03;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_continuous_bounded_and_deterministic() {
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
