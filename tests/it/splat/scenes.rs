//! The built-in scenes that have exact answers: what they are made of, and that no light leaves the closed ones.

use glam::{Vec3, Vec3A};
use rtbench::camera::CameraPath;
use rtbench::scene::{self, Scene};
use rtbench::workloads::splat::lit::LitScene;
use std::collections::HashMap;

fn load(spec: &str) -> Scene {
    scene::load(spec).unwrap_or_else(|error| panic!("{error}"))
}

/// The first edge, by its ends' positions, that is not between two triangles of opposite directions.
fn open_edge(scene: &Scene) -> Option<[Vec3; 2]> {
    let mut edges: HashMap<[[u32; 3]; 2], i32> = HashMap::new();
    let bits = |point: Vec3A| point.to_array().map(|x| (x + 0.0).to_bits());
    for triangle in 0..scene.triangles.len() as u32 {
        let [a, b, c] = scene.corners(triangle);
        for [from, to] in [[a, b], [b, c], [c, a]] {
            *edges.entry([bits(from), bits(to)]).or_default() += 1;
        }
    }
    let wrong = |(&[from, to], &count): (&[[u32; 3]; 2], &i32)| count != 1 || edges.get(&[to, from]) != Some(&1);
    let (edge, _) = edges.iter().find(|&(edge, count)| wrong((edge, count)))?;
    Some(edge.map(|point| Vec3::from(point.map(f32::from_bits))))
}

#[test]
fn box_and_sphere_are_closed_at_every_size() {
    for spec in ["box", "box:triangles=400", "box:triangles=3001,albedo=50", "sphere", "sphere:triangles=500"] {
        let scene = load(spec);
        assert_eq!(open_edge(&scene), None, "{spec}");
        let mut hole = scene.clone();
        hole.triangles.remove(scene.triangles.len() / 2);
        assert!(open_edge(&hole).is_some(), "{spec}");
    }
    assert!(open_edge(&load("plane")).is_some());
}

#[test]
fn the_sphere_is_round_and_of_one_albedo() {
    let scene = load("sphere");
    assert!(scene.triangles.len() >= 80_000, "{}", scene.triangles.len());
    // Neighbours share their vertices: V = T / 2 + 2
    assert_eq!(scene.vertices.len(), scene.triangles.len() / 2 + 2);
    for vertex in &scene.vertices {
        assert!((vertex.position.length() - 1.0).abs() < 1e-6);
        assert!(vertex.normal.dot(vertex.position) < -0.999_999, "normals are smooth and face inwards");
    }
    let areas: Vec<f32> = (0..scene.triangles.len() as u32)
        .map(|triangle| {
            let [a, b, c] = scene.corners(triangle);
            (b - a).cross(c - a).length() / 2.0
        })
        .collect();
    let area: f64 = areas.iter().map(|&area| f64::from(area)).sum();
    assert!((area / (4.0 * std::f64::consts::PI) - 1.0).abs() < 2e-4, "{area}");
    let [low, high] = [f32::min, f32::max].map(|pick| areas.iter().copied().reduce(pick).unwrap());
    assert!(high / low < 2.5, "{low} {high}");
    assert_eq!(scene.materials.len(), 1);
    assert_eq!(scene.materials[0].diffuse, Vec3::splat(0.5));
    assert_eq!(load("sphere:albedo=100").materials[0].diffuse, Vec3::ONE);
    assert!(load("sphere:albedo=0").materials[0].diffuse == Vec3::ZERO);
    let light = scene.lights[0].position;
    assert!(light.length() > 0.3 && light.length() < 0.8, "{light}");
    assert!(scene::load("sphere:albedo=101").unwrap_err().to_string().contains("out of range"));
}

#[test]
fn the_box_has_coloured_walls_and_may_have_one_albedo() {
    let scene = load("box");
    let bounds = scene.bounds();
    // The mean diffuse colour of the triangles in the plane of a wall
    let wall = |axis: usize, at: f32| {
        let inside = |&triangle: &u32| scene.corners(triangle).iter().all(|corner| corner[axis] == at);
        let found: Vec<u32> = (0..scene.triangles.len() as u32).filter(inside).collect();
        let material = |&triangle: &u32| scene.triangles[triangle as usize].material;
        assert!(found.iter().all(|triangle| material(triangle) == material(&found[0])));
        scene.materials[material(&found[0]) as usize].diffuse
    };
    let (left, right) = (wall(0, bounds.min.x), wall(0, bounds.max.x));
    assert!(left.x > 3.0 * left.y && left.x > 3.0 * left.z, "{left}");
    assert!(right.y > 3.0 * right.x && right.y > 3.0 * right.z, "{right}");
    for grey in [wall(1, bounds.min.y), wall(1, bounds.max.y), wall(2, bounds.min.z), wall(2, bounds.max.z)] {
        assert_eq!(grey, Vec3::splat(grey.x));
    }
    let light = scene.lights[0].position;
    assert!(light.cmpgt(bounds.min).all() && light.cmplt(bounds.max).all());
    assert!(light.distance(bounds.center()) > 0.2 * bounds.extent().y);
    assert!(load("box:albedo=40").materials.iter().all(|material| material.diffuse == Vec3::splat(0.4)));
}

#[test]
fn the_plane_is_flat_and_has_its_light_above_the_middle() {
    let scene = load("plane");
    assert!(scene.vertices.iter().all(|vertex| vertex.position.y == 0.0 && vertex.normal == Vec3::Y));
    let (bounds, light) = (scene.bounds(), scene.lights[0].position);
    assert_eq!((light.x, light.z), (bounds.center().x, bounds.center().z));
    assert!(light.y > 0.0);
    let lit = LitScene::new(scene, None, &[]).unwrap();
    assert_eq!((lit.lights.len(), lit.warnings.len()), (1, 0));
}

#[test]
fn their_cameras_are_inside_or_above() {
    for (name, inside) in [("sphere", true), ("box", true), ("plane", false)] {
        let scene = load(name);
        let path = CameraPath::for_scene(&scene, false);
        assert_eq!(path.name, name);
        let bounds = scene.bounds();
        for view in path.views(&scene, None).unwrap() {
            let at = view.camera.position;
            if name == "sphere" {
                assert!(at.length() < 0.95, "{at}");
            } else if inside {
                assert!(at.cmpgt(bounds.min).all() && at.cmplt(bounds.max).all(), "{at}");
            } else {
                assert!(at.y > 1.0 && view.camera.direction.y < -0.3, "{at}");
            }
        }
    }
}
