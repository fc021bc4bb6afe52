//! Pictures of which a formula says what is to be seen.

use super::support::{self, Scene, frame, sphere, view};
use glam::{DVec3, Vec3};
use rtbench::workloads::spheres::options::{Algorithm, HitRecord, Lanes, Options, Renderer};
use rtbench::workloads::spheres::scene::PackedSphere;
use rtbench::workloads::spheres::view::View;

const TOLERANCE: f64 = 1e-5;

/// Scalar and SIMD, one pass and two.
fn pictures(spheres: &[PackedSphere], view: &View) -> Vec<(Vec<[f32; 4]>, Vec<u32>)> {
    let mut pictures = Vec::new();
    for renderer in [Renderer::Sequential, Renderer::Simd(Lanes::Eight, None)] {
        for algorithm in [Algorithm::TwoPass, Algorithm::OnePass] {
            let (skip_no_hit, skip_no_discriminant, hit) = (false, false, HitRecord::Index);
            let options = Options { algorithm, exit_on_miss: true, skip_no_hit, skip_no_discriminant, hit };
            let frame = frame(renderer, options, None, spheres, view);
            pictures.push((frame.timed, frame.hits));
        }
    }
    pictures
}

/// Spheres in front of a camera at (0, 0, `distance`) that looks along -z.
fn facing(spheres: Vec<PackedSphere>, distance: f64, light: DVec3) -> Scene {
    Scene { spheres, position: DVec3::new(0.0, 0.0, distance), fov: 60.0, light, ..support::empty() }
}

fn near(pixel: [f32; 4], expected: DVec3, what: &str) {
    let pixel = DVec3::new(pixel[0].into(), pixel[1].into(), pixel[2].into());
    assert!((pixel - expected).abs().max_element() <= TOLERANCE, "{what}: {pixel}, not {expected}");
}

/// The Phong terms of a hit, from the angles alone.
fn phong(view: &View, color: Vec3, to_light: f64, mirrored: f64) -> DVec3 {
    let (light, lit) = (view.light_color.as_dvec3(), if to_light > 0.0 { 1.0 } else { 0.0 });
    color.as_dvec3() * (view.ambient.as_dvec3() + light * to_light * lit) + light * lit * mirrored.max(0.0).powi(32)
}

#[test]
fn one_sphere_is_a_cone_of_hits_with_its_colour_from_the_law_of_sines() {
    let color = Vec3::new(0.8, 0.5, 0.2);
    let (radius, distance) = (2.0, 6.0);
    let scene = facing(vec![sphere([0.0; 3], 2.0, color.into())], distance, DVec3::new(-0.4, -0.3, -1.0));
    let view = view(&scene, 41, 31, 3);
    let light = view.light.as_dvec3();
    let pixel = 2.0 * 30f64.to_radians().tan() / 31.0;
    let mut edge = 0;
    for (image, hits) in pictures(&scene.spheres, &view) {
        for y in 0..31 {
            for x in 0..41 {
                let at = y * 41 + x;
                let direction = DVec3::new((x as f64 - 20.0) * pixel, (15.0 - y as f64) * pixel, -1.0).normalize();
                let sine = direction.truncate().length();
                if (sine - radius / distance).abs() < 1e-5 {
                    edge += 1;
                    continue;
                }
                let inside = sine < radius / distance;
                assert_eq!(hits[at] == 1, inside, "pixel {x}, {y}");
                if !inside {
                    assert_eq!(image[at], [0.0, 0.0, 0.0, 1.0]);
                    continue;
                }
                let depth = -distance * direction.z - (radius * radius - (distance * sine).powi(2)).sqrt();
                let normal = (DVec3::new(0.0, 0.0, distance) + direction * depth) / radius;
                let mirrored = (2.0 * normal.dot(light) * normal - light).dot(-direction);
                near(image[at], phong(&view, color, normal.dot(light), mirrored), "colour");
            }
        }
        // At the centre the normal is the axis
        near(image[15 * 41 + 20], phong(&view, color, light.z, light.z), "centre");
    }
    assert!(edge < 8, "{edge} pixels were left out");
}

/// Which of two surfaces on the axis is seen says where they are.
#[test]
fn the_depth_at_the_centre_is_distance_less_radius() {
    for (shift, front) in [(1e-4, [0.0, 1.0, 0.0]), (-1e-4, [1.0, 0.0, 0.0])] {
        // Surfaces at z = 2 and at 2 + shift; the second sphere's centre lies further back
        let spheres =
            vec![sphere([0.0; 3], 2.0, [1.0, 0.0, 0.0]), sphere([0.0, 0.0, shift - 1.0], 3.0, [0.0, 1.0, 0.0])];
        let scene = facing(spheres, 6.0, DVec3::new(0.0, -1.0, 0.5));
        let view = view(&scene, 1, 1, 1);
        for (image, _) in pictures(&scene.spheres, &view) {
            near(image[0], phong(&view, front.into(), -1.0, 0.0), "surface in front");
        }
    }
}

#[test]
fn from_within_a_sphere_there_is_a_series_of_its_two_poles() {
    let color = Vec3::new(0.9, 0.6, 0.3);
    let scene = facing(vec![sphere([0.0; 3], 3.0, color.into())], 0.0, DVec3::new(0.3, -0.5, 1.0));
    let scene = Scene { target: DVec3::new(0.0, 0.0, -1.0), ..scene };
    for trips in 1..=8 {
        let view = view(&scene, 9, 7, trips);
        for (image, hits) in pictures(&scene.spheres, &view) {
            assert!(hits.iter().all(|&hits| hits == trips));
            for (at, pixel) in image.into_iter().enumerate() {
                let (x, y) = (at % 9, at / 9);
                let d = view.corner + view.right * (x as f32 + 0.5) + view.down * (y as f32 + 0.5);
                // The outward normal is the direction, so that no mirror image is ever seen
                let to_light = d.as_dvec3().normalize().dot(view.light.as_dvec3());
                let mut expected = DVec3::ZERO;
                for trip in 0..trips as i32 {
                    let factor = (color.as_dvec3() * f64::from(view.intensity)).powf(f64::from(trip));
                    let side = if trip % 2 == 0 { to_light } else { -to_light };
                    expected += factor * phong(&view, color, side, -1.0);
                }
                near(pixel, expected, "from within");
            }
        }
    }
}

#[test]
fn light_from_behind_leaves_ambient_light_exactly() {
    let color = Vec3::new(0.8, 0.5, 0.2);
    let scene = facing(vec![sphere([0.0; 3], 2.0, color.into())], 6.0, DVec3::Z);
    let view = view(&scene, 41, 31, 3);
    let expected = color * view.ambient;
    for (image, hits) in pictures(&scene.spheres, &view) {
        assert!(hits.contains(&1));
        for (pixel, hits) in image.iter().zip(&hits) {
            let expected = if *hits == 1 { expected } else { Vec3::ZERO };
            assert_eq!(pixel[..3], expected.to_array());
        }
    }
}

/// Two mirrors face each other on the axis, the camera between them looks at the first: each pair of reflections scales
/// what follows by the same factor, so that the sum has a closed form.
#[test]
fn two_mirrors_on_an_axis_are_a_geometric_series() {
    let (first, second) = (Vec3::new(0.9, 0.7, 0.5), Vec3::new(0.4, 0.8, 0.95));
    let spheres = vec![sphere([0.0, 0.0, -5.0], 2.0, first.into()), sphere([0.0, 0.0, 4.0], 2.5, second.into())];
    let scene = facing(spheres, 0.0, DVec3::new(-0.6, -0.2, -0.77));
    let scene = Scene { target: DVec3::new(0.0, 0.0, -1.0), ..scene };
    for trips in 1..=8 {
        let view = view(&scene, 1, 1, trips);
        // Normals are +z at the first mirror and -z at the second; on the axis the mirror image is at the same angle
        let cosine = f64::from(view.light.z);
        let (a, b) = (phong(&view, first, cosine, cosine), phong(&view, second, -cosine, -cosine));
        let intensity = f64::from(view.intensity);
        let (first, second) = (first.as_dvec3() * intensity, second.as_dvec3() * intensity);
        let (pair, pairs) = (first * second, f64::from(trips / 2));
        let mut expected = (a + first * b) * (DVec3::ONE - pair.powf(pairs)) / (DVec3::ONE - pair);
        if trips % 2 == 1 {
            expected += pair.powf(pairs) * a;
        }
        for (image, hits) in pictures(&scene.spheres, &view) {
            assert_eq!(hits, [trips]);
            near(image[0], expected, &format!("{trips} trips"));
        }
    }
}

#[test]
fn sixty_four_bounces_among_overlapping_spheres_stay_finite() {
    let mut scene = support::random(60, 4);
    scene.spheres.iter_mut().for_each(|sphere| sphere.radius2 *= 6.0);
    scene.position = DVec3::new(0.5, 0.5, 0.5);
    scene.target = DVec3::new(3.0, 0.0, -8.0);
    let view = view(&scene, 64, 36, 64);
    for (image, hits) in pictures(&scene.spheres, &view) {
        assert!(hits.iter().filter(|&&hits| hits == 64).count() > 100, "few paths use all trips");
        // Each of a path's hits adds less than 2, scaled by at most 1/2 each time
        assert!(image.iter().flatten().all(|&c| (0.0..4.0).contains(&c)));
    }
}
