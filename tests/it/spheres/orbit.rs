//! Views over an orbit: quarter turns are exact, opposite frames are opposite, and rays go where pixels are.

use glam::{DVec3, Vec3};
use rtbench::math::T_MAX;
use rtbench::workloads::size::Size;
use rtbench::workloads::spheres::scene::{NAMES, Scene};
use rtbench::workloads::spheres::view::View;

const SIZE: Size = Size { width: 64, height: 36 };

fn views(scene: &Scene, frames: usize) -> Vec<View> {
    (0..frames).map(|frame| View::of(scene, SIZE, 5, frame, frames)).collect()
}

/// The largest difference of two views' vectors.
fn difference(a: &View, b: &View, about: Vec3) -> f32 {
    let half_turn = |v: Vec3| Vec3::new(-v.x, v.y, -v.z);
    let origin = half_turn(a.origin - about) + about - b.origin;
    let others = [(a.corner, b.corner), (a.right, b.right), (a.down, b.down)].map(|(a, b)| half_turn(a) - b);
    others.iter().chain([&origin]).map(|v| v.abs().max_element()).fold(0.0, f32::max)
}

#[test]
fn an_orbit_ends_where_it_begins() {
    for name in NAMES {
        let scene = Scene::load(name).unwrap();
        for frames in [1, 2, 7, 16, 400] {
            let first = views(&scene, frames);
            for (frame, view) in first.iter().enumerate() {
                for turns in [1, 2, 1000] {
                    assert_eq!(*view, View::of(&scene, SIZE, 5, frame + turns * frames, frames), "{name} {frame}");
                }
            }
            assert!((1..frames).all(|frame| first[frame] != first[frame - 1]));
        }
    }
}

#[test]
fn opposite_frames_are_point_reflections_about_the_axis() {
    let mut scene = Scene::load("random20").unwrap();
    // About another axis, a coordinate of 20 is rounded to a multiple of 2e-6
    for (focus, limit) in [(DVec3::ZERO, 1e-6), (DVec3::new(0.5, -3.0, 0.25), 4e-6)] {
        scene.camera.focus_point = focus;
        for frames in [2, 6, 16, 398] {
            let views = views(&scene, frames);
            for frame in 0..frames / 2 {
                let found = difference(&views[frame], &views[frame + frames / 2], focus.as_vec3());
                assert!(found <= limit, "{frames}: {found}");
            }
            // The comparison can fail
            assert!(difference(&views[0], &views[0], focus.as_vec3()) > 1.0);
        }
    }
}

#[test]
fn quarter_turns_are_exact_and_the_sign_is_the_direction() {
    let mut scene = Scene::load("default").unwrap();
    scene.camera.position = DVec3::new(0.0, 5.0, 24.0);
    let places = |scene: &Scene| views(scene, 4).iter().map(|view| view.origin.to_array()).collect::<Vec<_>>();
    // About +y, z goes to x
    let once = [[0.0, 5.0, 24.0], [24.0, 5.0, 0.0], [0.0, 5.0, -24.0], [-24.0, 5.0, 0.0]];
    assert_eq!(places(&scene), once);
    scene.camera.orbit_velocity = -0.1;
    assert_eq!(places(&scene), [once[0], once[3], once[2], once[1]]);
    scene.camera.orbit_velocity = 0.0;
    assert_eq!(places(&scene), [once[0]; 4]);
    scene.camera.orbit_velocity = 1e-9;
    assert_eq!(places(&scene), once, "a run is one period, whatever the speed is");
}

#[test]
fn pixels_are_square_and_the_middle_looks_forward() {
    let mut scene = Scene::load("default").unwrap();
    scene.camera.fov = 90.0;
    scene.camera.forward = DVec3::new(3.0, 4.0, 0.0);
    for (width, height) in [(64, 36), (36, 64), (1, 1), (7, 5)] {
        let view = View::of(&scene, Size { width, height }, 9, 0, 4);
        let (w, h) = (width as f32, height as f32);
        assert!((view.right.length() - 2.0 / h).abs() < 1e-6 && (view.down.length() - 2.0 / h).abs() < 1e-6);
        let middle = view.corner + view.right * (0.5 * w) + view.down * (0.5 * h);
        assert!((middle - Vec3::new(0.6, 0.8, 0.0)).length() < 1e-6, "{middle}");
        // Seen along +x, +z is to the right; up is up
        assert!(view.right.z > 0.0 && view.right.y == 0.0 && view.down.y < 0.0);
        // The middle of the upper border is half of the field of view above the middle
        let above = (view.corner + view.right * (0.5 * w)).normalize();
        assert!((above.dot(middle) - std::f32::consts::FRAC_1_SQRT_2).abs() < 1e-6);
        assert_eq!((view.width, view.height, view.trips, view.spheres, view.pad), (width, height, 9, 3, 0));
    }
    let view = View::of(&scene, SIZE, 5, 0, 1);
    assert_eq!((view.half, view.one, view.two, view.far), (0.5, 1.0, 2.0, T_MAX));
    assert!((view.light.length() - 1.0).abs() < 1e-6 && view.light.y > 0.0);
    assert_eq!((view.intensity, view.epsilon), (scene.rendering.intensity, scene.rendering.epsilon));
}
