//! Lights: what `--light` says, which lights a scene has, and its albedos.

use super::frames::{SETTING, camera_of, estimate, light_at, on_cpu};
use super::support::{Random, mutated};
use glam::{DVec3, Vec3, Vec4};
use rtbench::camera::Camera;
use rtbench::device::CpuDevice;
use rtbench::math::Aabb;
use rtbench::scene::radiometry::Radiometry;
use rtbench::scene::{self, Light, Material, Placement, Scene};
use rtbench::workloads::size::Size;
use rtbench::workloads::splat::lights::{LightChoice, default_flux};
use rtbench::workloads::splat::lit::{LitScene, PointLight};
use std::panic::catch_unwind;

fn plane() -> Scene {
    scene::load("plane").unwrap()
}

fn radiometry(text: &str) -> Radiometry {
    toml::from_str(text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn problem(text: &str) -> String {
    let error = LightChoice::parse(text).unwrap_err().to_string();
    assert!(error.starts_with("--light: ") && error.contains("point:x=") && !error.contains('\n'), "{error}");
    error
}

#[test]
fn a_light_is_a_point_and_a_flux() {
    let parse = |text: &str| LightChoice::parse(text).unwrap();
    let plain = parse("point:x=1,y=-2.5,z=3e2");
    assert_eq!((plain.position, plain.flux), (DVec3::new(1.0, -2.5, 300.0), None));
    let grey = parse("point:z=3, flux=12.5 ,x=1,y=2");
    assert_eq!((grey.position, grey.flux), (DVec3::new(1.0, 2.0, 3.0), Some(Vec3::splat(12.5))));
    assert_eq!(parse("point:x=1,y=2,z=3,flux=1/0/0.5").flux, Some(Vec3::new(1.0, 0.0, 0.5)));
}

#[test]
fn what_is_no_light_is_named() {
    for (text, words) in [
        ("", "no point light"),
        ("sun:x=1", "no point light"),
        ("point", "no point light"),
        ("point:", "key=value"),
        ("point:x=1,y=2", "lacks a coordinate"),
        ("point:x=1,y=2,z=3,z=4", "z is given twice"),
        ("point:x=1,y=2,z=3,flux=1,flux=1", "flux is given twice"),
        ("point:x=1,y=2,z=3,w=4", "no \"w\""),
        ("point:x=1,y=2,z", "key=value"),
        ("point:x=nan,y=2,z=3", "no coordinate"),
        ("point:x=inf,y=2,z=3", "no coordinate"),
        ("point:x=1,y=1e19,z=3", "no coordinate"),
        ("point:x=1,y=2,z=", "no coordinate"),
        ("point:x=1,y=2,z=3,flux=-1", "one or three numbers"),
        ("point:x=1,y=2,z=3,flux=1/2", "one or three numbers"),
        ("point:x=1,y=2,z=3,flux=nan", "one or three numbers"),
        ("point:x=1,y=2,z=3,flux=1e30", "one or three numbers"),
        ("point:x=1,y=2,z=3,flux=0", "no flux"),
        ("point:x=1,y=2,z=3,flux=0/0/0", "no flux"),
    ] {
        assert!(problem(text).contains(words), "{text}: {}", problem(text));
    }
}

#[test]
fn mutated_lights_are_read_or_refused_with_one_line() {
    let mut random = Random(3);
    let (mut read, mut refused) = (0, 0);
    for original in ["point:x=1,y=-2.5,z=3e2,flux=10/20/5.5", "point:x=0.25,y=7,z=-1", "point:x=1,y=2,z=3,flux=7"] {
        for _ in 0..4000 {
            let text = mutated(original, &mut random);
            match catch_unwind(|| LightChoice::parse(&text)).unwrap_or_else(|_| panic!("panicked: {text:?}")) {
                Ok(light) => {
                    read += 1;
                    assert!(light.position.is_finite(), "{text:?}");
                    let flux = light.flux.unwrap_or(Vec3::ONE);
                    assert!(flux.is_finite() && flux.min_element() >= 0.0 && flux != Vec3::ZERO, "{text:?}");
                }
                Err(error) => {
                    refused += 1;
                    let error = error.to_string();
                    assert!(error.starts_with("--light: ") && !error.contains('\n'), "{text:?}: {error}");
                }
            }
        }
    }
    assert!(read > 500 && refused > 500, "{read} {refused}");
}

#[test]
fn chosen_lights_come_before_listed_ones_and_those_before_the_scene_s() {
    let (diagonal, own) = (plane().bounds().diagonal(), plane().lights[0].position);
    let default = default_flux(diagonal);
    // A white surface, a quarter of the diagonal away, has the radiance 1 / pi x flux / (4 pi) / distance^2
    let radiance = default / (4.0 * std::f32::consts::PI.powi(2)) / (diagonal / 4.0).powi(2);
    assert!((radiance - 1.0).abs() < 1e-5, "{radiance}");

    let listed = radiometry("light = [{ position = [1, 2, 3] }, { position = [0.5, 1, 0], flux = [1, 0, 2] }]");
    let chosen = [LightChoice::parse("point:x=0,y=4,z=0,flux=3").unwrap()];
    let lights = |radiometry: Option<&Radiometry>, chosen: &[LightChoice]| {
        LitScene::new(plane(), radiometry, chosen).unwrap().lights
    };
    let light = |position: [f32; 3], flux: Vec3| PointLight { position: position.into(), flux };
    assert_eq!(lights(None, &[]), [light(own.into(), Vec3::splat(default))]);
    let both = [light([1.0, 2.0, 3.0], Vec3::splat(default)), light([0.5, 1.0, 0.0], Vec3::new(1.0, 0.0, 2.0))];
    assert_eq!(lights(Some(&listed), &[]), both);
    assert_eq!(lights(Some(&listed), &chosen), [light([0.0, 4.0, 0.0], Vec3::splat(3.0))]);
    assert_eq!(lights(Some(&radiometry("")), &[]), lights(None, &[]));

    let mut coloured = plane();
    coloured.lights = vec![Light::new(Vec3::Y, Vec3::new(0.5, -1.0, 2.0)), Light::new(Vec3::ZERO, Vec3::ZERO)];
    let lit = LitScene::new(coloured, None, &[]).unwrap();
    assert_eq!(lit.lights, [light([0.0, 1.0, 0.0], Vec3::new(0.5, 0.0, 2.0) * default)]);
    assert!(lit.warnings.len() == 1 && lit.warnings[0].contains("1 of 2 lights"), "{:?}", lit.warnings);
}

#[test]
fn a_scene_without_light_gets_one_in_the_middle_of_its_extent_and_a_warning() {
    let dark = || Scene { lights: Vec::new(), ..plane() };
    let lit = LitScene::new(dark(), None, &[]).unwrap();
    assert_eq!(lit.lights, [PointLight { position: Vec3::ZERO, flux: Vec3::splat(default_flux(lit.diagonal())) }]);
    assert!(lit.warnings.len() == 1 && lit.warnings[0].contains("no light"), "{:?}", lit.warnings);
    let within = radiometry("extent = { min = [0, 0, 0], max = [1, 2, 2] }");
    let lit = LitScene::new(dark(), Some(&within), &[]).unwrap();
    assert_eq!(lit.lights[0].position, Vec3::new(0.5, 1.0, 1.0));
    assert_eq!(lit.extent, Aabb { min: Vec3::ZERO, max: Vec3::new(1.0, 2.0, 2.0) });
    assert_eq!((lit.diagonal(), lit.near(), lit.far(), lit.influence()), (3.0, 3.0 / 2000.0, 15.0, 3.0));
    assert_eq!(lit.epsilon(), 3.0e-5);
    assert!(lit.reach() > 4.0 * 5.6, "the reach follows the scene's bounds");
}

#[test]
fn positions_are_in_the_file_s_coordinates() {
    let placement = Placement { offset: DVec3::new(5e6, 0.0, -4e6), exponent: 2 };
    let moved = || Scene { placement, ..plane() };
    let chosen = [LightChoice::parse("point:x=5000001,y=2,z=-4000000.5").unwrap()];
    let lit = LitScene::new(moved(), None, &chosen).unwrap();
    assert_eq!(lit.lights[0].position, Vec3::new(4.0, 8.0, -2.0));
    let listed = radiometry(
        "light = [{ position = [5000000, 1, -4000000] }]
         extent = { min = [4999999.0, 0, -4000001], max = [5000001, 1, -3999999] }",
    );
    let lit = LitScene::new(moved(), Some(&listed), &[]).unwrap();
    assert_eq!(lit.lights[0].position, Vec3::new(0.0, 4.0, 0.0));
    assert_eq!(lit.extent, Aabb { min: Vec3::new(-4.0, 0.0, -4.0), max: Vec3::new(4.0, 4.0, 4.0) });
    // Flux over squared lengths is the file's
    let given = [LightChoice::parse("point:x=5000000,y=1,z=-4000000,flux=3/0/1").unwrap()];
    let lit = LitScene::new(moved(), None, &given).unwrap();
    assert_eq!(lit.lights[0].flux, Vec3::new(48.0, 0.0, 16.0));
    assert_eq!(lit.file_flux(&lit.lights[0]), DVec3::new(3.0, 0.0, 1.0));
    // Farther away than squares of floats reach
    let tiny = Scene { placement: Placement { offset: DVec3::ZERO, exponent: 60 }, ..plane() };
    let far = [LightChoice::parse("point:x=1e18,y=0,z=0").unwrap()];
    let error = LitScene::new(tiny.clone(), None, &far).unwrap_err().to_string();
    assert!(error.starts_with("--light: ") && error.contains("too far"), "{error}");
    // More flux than floats reach, and less
    let huge = Scene { placement: Placement { offset: DVec3::ZERO, exponent: -60 }, ..plane() };
    for (scene, flux) in [(tiny, "1e18"), (huge, "1e-9")] {
        let bright = [LightChoice::parse(&format!("point:x=0,y=0,z=0,flux={flux}")).unwrap()];
        let error = LitScene::new(scene, None, &bright).unwrap_err().to_string();
        assert!(error.starts_with("--light: ") && error.contains("flux") && error.contains("range"), "{error}");
    }
}

/// Light does not depend on the unit in which a scene is in memory.
#[test]
fn a_scaled_scene_is_as_bright() {
    let scene = scene::load("room:triangles=20000").unwrap();
    let camera = camera_of(&scene);
    let place = light_at(&scene, [0.4, 0.7, 0.5], Vec3::ONE).position;
    let scaled = |exponent: i32| {
        let mut scaled = scene.clone();
        let factor = (exponent as f32).exp2();
        scaled.vertices.iter_mut().for_each(|vertex| vertex.position *= factor);
        scaled.placement.exponent += exponent;
        (scaled, Camera { position: camera.position * factor, ..camera })
    };
    let device = CpuDevice::new(2).unwrap();
    let size = Size { width: 40, height: 30 };
    let chosen = |flux: &str| {
        let DVec3 { x, y, z } = scene.placement.file(place);
        [LightChoice::parse(&format!("point:x={x},y={y},z={z}{flux}")).unwrap()]
    };
    let frame = |exponent: i32, chosen: &[LightChoice], factor: f32| {
        let (scene, camera) = scaled(exponent);
        let mut lit = LitScene::new(scene, None, chosen).unwrap();
        lit.lights[0].flux *= factor;
        on_cpu(&device, &lit, "bvh", (SETTING, estimate(&lit, 0.1), size), &camera)
    };
    let off = |a: &[Vec4], b: &[Vec4]| {
        let mean = a.iter().map(|v| v.element_sum()).sum::<f32>() / a.len() as f32;
        assert!(mean > 0.0);
        a.iter().zip(b).map(|(a, b)| (*a - *b).abs().max_element() / mean).fold(0.0, f32::max)
    };
    for flux in ["", ",flux=100/50/20"] {
        let chosen = chosen(flux);
        let plain = frame(0, &chosen, 1.0);
        for exponent in [3, -2] {
            let other = frame(exponent, &chosen, 1.0);
            let worst = off(&plain.direct, &other.direct).max(off(&plain.irradiance, &other.irradiance));
            assert!(worst < 1.0e-4, "2^{exponent}{flux}: {worst}");
        }
        // As if the flux were the file's
        let wrong = frame(3, &chosen, 1.0 / 64.0);
        assert!(off(&plain.direct, &wrong.direct) > 0.1 && off(&plain.irradiance, &wrong.irradiance) > 0.1);
    }
}

#[test]
fn an_extent_without_size_is_refused() {
    let mut point = plane();
    point.vertices.iter_mut().for_each(|vertex| vertex.position = Vec3::ONE);
    let error = LitScene::new(point, None, &[]).unwrap_err().to_string();
    assert!(error.starts_with("--scene: ") && error.contains("extent"), "{error}");
}

#[test]
fn albedos_are_the_catalogue_s_by_name_and_at_most_one() {
    let mut scene = plane();
    scene.materials = [0.2, 1.5, 0.4, 3.0].map(|grey| Material::matt(Vec3::splat(grey))).into();
    scene.material_names = ["floor", "wall", "floor", ""].map(str::to_owned).into();
    let albedos = radiometry(
        "albedo = [{ material = \"floor\", colour = [0.1, 0.2, 0.3] }, { material = \"roof\", colour = [1, 1, 1] }]",
    );
    let lit = LitScene::new(scene.clone(), Some(&albedos), &[]).unwrap();
    let diffuse: Vec<Vec3> = lit.scene.materials.iter().map(|material| material.diffuse).collect();
    let floor = Vec3::new(0.1, 0.2, 0.3);
    assert_eq!(diffuse, [floor, Vec3::ONE, floor, Vec3::ONE]);
    let warned = |words: &str| lit.warnings.iter().any(|warning| warning.contains(words));
    assert!(lit.warnings.len() == 2 && warned("roof") && warned("2 materials"), "{:?}", lit.warnings);
    assert!(!warned("floor"), "{:?}", lit.warnings);
    // A scene without names, as from a cache
    scene.material_names.clear();
    let lit = LitScene::new(scene, Some(&albedos), &[]).unwrap();
    assert!(lit.warnings.iter().any(|warning| warning.contains("floor, roof")), "{:?}", lit.warnings);
}
