//! The radiometry of the catalogue's entries, against their files, and mutated tables.

use super::support::{Random, mutated};
use crate::support::file_below;
use glam::Vec3;
use rtbench::camera::{CameraPath, names};
use rtbench::math::{Ray, T_MAX};
use rtbench::scene::catalogue::{entries, find, radiometry};
use rtbench::scene::radiometry::Radiometry;
use rtbench::scene::{Scene, load_in};
use rtbench::workloads::splat::lit::LitScene;
use rtbench::workloads::trace::intersect::watertight::intersect;
use std::collections::BTreeSet;
use std::panic::catch_unwind;

/// A scene of the catalogue, if its file is here.
fn real(name: &str) -> Option<Scene> {
    let path = &find(name).unwrap().file[0].path;
    let file = file_below("RTBENCH_SCENES", path.to_str().unwrap())?;
    let folder = file.ancestors().nth(path.components().count()).unwrap();
    Some(load_in(name, Some(folder)).unwrap())
}

#[test]
fn entries_have_sound_radiometry() {
    let mut with = Vec::new();
    for entry in entries() {
        let Some(radiometry) = &entry.radiometry else { continue };
        with.push(entry.name.as_str());
        assert_eq!(radiometry.fault(), None, "{}", entry.name);
        if let Some(path) = &radiometry.camera_path {
            assert!(names().contains(&path.as_str()), "{path}");
        }
        let materials: BTreeSet<&String> = radiometry.albedo.iter().map(|albedo| &albedo.material).collect();
        assert_eq!(materials.len(), radiometry.albedo.len(), "{}: a material occurs twice", entry.name);
    }
    assert_eq!(with, ["sponza", "sibenik"]);
    let fault = |text: &str| toml::from_str::<Radiometry>(text).unwrap().fault();
    assert_eq!(fault("light = [{ position = [0, 0, 0], flux = 5 }]"), None);
    for wrong in [
        "light = [{ position = [0, nan, 0] }]",
        "light = [{ position = [0, 1e19, 0] }]",
        "light = [{ position = [0, 0, 0], flux = -1 }]",
        "light = [{ position = [0, 0, 0], flux = [1, inf, 1] }]",
        "extent = { min = [0, 0, 0], max = [1, 0, 1] }",
        "extent = { min = [0, 0, 0], max = [1, inf, 1] }",
        "extent = { min = [0, 0, 0], max = [1, 1e-30, 1] }",
        "albedo = [{ material = \"a\", colour = [0, 1.1, 0] }]",
        "albedo = [{ material = \"a\", colour = [0, -0.1, 0] }]",
    ] {
        assert!(fault(wrong).is_some(), "{wrong}");
    }
}

#[test]
fn radiometry_is_that_of_the_name_unless_options_move_the_scene() {
    for spec in ["sponza", "sponza:fov=50", "sponza:origin=1,2,3", "sponza:lamp=a"] {
        assert!(radiometry(spec).is_some_and(|found| found.albedo.len() == 20), "{spec}");
    }
    for spec in ["sponza:scale=2", "sponza:fov=50,up=z", "bunny", "box", "./sponza.obj", "nothing", ""] {
        assert!(radiometry(spec).is_none(), "{spec}");
    }
}

#[test]
fn mutated_tables_are_read_or_refused() {
    let text = "camera_path = \"sponza-nave\"\nlight = [{ position = [0.0, 7.8, 0.0], flux = [1, 2, 3] }]\n\
                extent = { min = [-294.0, 0.0, -199.0], max = [650.0, 717.0, 199.0] }\n\
                albedo = [{ material = \"sp_00_pod\", colour = [0.5, 0.25, 0.125] }]\n";
    assert!(toml::from_str::<Radiometry>(text).is_ok());
    for key in ["light", "position", "flux", "extent", "min", "albedo", "material", "colour", "camera_path"] {
        let unknown = text.replacen(key, &format!("{key}s"), 1);
        assert!(toml::from_str::<Radiometry>(&unknown).is_err(), "{unknown}");
    }
    let mut random = Random(5);
    let (mut read, mut refused) = (0, 0);
    for _ in 0..6000 {
        let mutant = mutated(text, &mut random);
        let found = catch_unwind(|| toml::from_str::<Radiometry>(&mutant)).unwrap_or_else(|_| panic!("{mutant:?}"));
        let Ok(found) = found else {
            refused += 1;
            continue;
        };
        read += 1;
        // What has no fault is a scene's light, whatever it says; what has one is no panic either
        let lit = LitScene::new(rtbench::scene::load("plane:triangles=200").unwrap(), Some(&found), &[]);
        if found.fault().is_none() {
            lit.unwrap_or_else(|error| panic!("{error}\n{mutant}"));
        }
    }
    assert!(read > 500 && refused > 500, "{read} {refused}");
}

/// The nearest hit along a ray, in the length of its direction.
fn distance(scene: &Scene, ray: &Ray) -> f32 {
    let hits = (0..scene.triangles.len() as u32).filter_map(|triangle| {
        let hit = intersect(ray, scene.corners(triangle), T_MAX)?;
        Some(hit.t)
    });
    hits.fold(T_MAX, f32::min)
}

/// The light is inside and in the middle: surfaces in all directions, none near, floor and roof as far away as said.
fn check_light(scene: Scene, name: &str, triangles: usize, albedos: usize) -> LitScene {
    let radiometry = radiometry(name).unwrap();
    assert_eq!(scene.triangles.len(), triangles);
    assert_eq!(radiometry.albedo.len(), albedos);
    let lit = LitScene::new(scene, Some(radiometry), &[]).unwrap();
    assert_eq!(lit.warnings, [""; 0], "every name is a material's");
    let light = lit.lights[0].position;
    let size = lit.extent.extent();
    let middle = (light - lit.extent.center()) / size;
    assert!(middle.x.abs() < 0.02 && middle.z.abs() < 0.02, "{middle}");
    for direction in [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z] {
        let ray = Ray::new(light.into(), direction.into());
        let distance = distance(&lit.scene, &ray);
        println!("{name}: {direction}: {distance}");
        // Sponza's court is open above
        assert!(
            distance > 0.02 * lit.diagonal() && (distance < T_MAX || direction == Vec3::Y),
            "{direction}: {distance}"
        );
    }
    lit
}

#[test]
fn sponza_has_its_light_in_the_court_and_a_colour_for_each_material() {
    let Some(scene) = real("sponza") else { return };
    let names: BTreeSet<String> = scene.material_names.iter().cloned().collect();
    let listed: BTreeSet<String> =
        radiometry("sponza").unwrap().albedo.iter().map(|albedo| albedo.material.clone()).collect();
    assert_eq!(names, listed);
    let lit = check_light(scene, "sponza", 66_450, 20);
    assert_eq!(lit.extent, lit.scene.bounds());
    // Colour bleeds where some materials are of one colour
    let coloured = lit.scene.materials.iter().filter(|m| m.diffuse.max_element() > 2.0 * m.diffuse.min_element());
    assert!(coloured.count() >= 5);
}

#[test]
fn sibenik_is_measured_by_the_church_without_the_ground_around_it() {
    let Some(scene) = real("sibenik") else { return };
    assert_eq!(scene.camera_path.as_deref(), Some("sibenik"));
    let lit = check_light(scene, "sibenik", 76_529, 0);
    assert!((lit.diagonal() - 1251.0).abs() < 1.0, "{}", lit.diagonal());
    assert!(lit.scene.bounds().diagonal() > 2.0 * lit.diagonal());
}

/// No ray from a frame's position to the next is blocked, and every frame sees a surface inside the extent.
#[test]
fn their_paths_are_inside_and_hit_nothing() {
    for (name, path) in [("sponza", "sponza-nave"), ("sibenik", "sibenik")] {
        let Some(scene) = real(name) else { continue };
        let lit = LitScene::new(scene, radiometry(name), &[]).unwrap();
        let path = CameraPath::load(path).unwrap();
        assert_eq!((path.field_of_view, path.frames), (60.0, 400));
        let views = path.views(&lit.scene, Some(100)).unwrap();
        for pair in views.windows(2) {
            let [from, to] = [pair[0].camera.position, pair[1].camera.position];
            let way = Ray::new(from.into(), (to - from).into());
            assert!(distance(&lit.scene, &way) > 1.0, "{name}: from {from} to {to}");
            assert!(from.cmpgt(lit.extent.min).all() && from.cmplt(lit.extent.max).all(), "{name}: {from}");
            let sight = Ray::new(from.into(), pair[0].camera.direction.into());
            assert!(distance(&lit.scene, &sight) < lit.diagonal(), "{name}: from {from}");
        }
    }
}
