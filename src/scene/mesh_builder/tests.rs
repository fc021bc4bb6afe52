//! Tests of the builder with shapes of known area and volume.

use super::*;
use std::f64::consts::PI;

fn area_and_volume(scene: &Scene) -> (f64, f64) {
    let corners = |t: &Triangle| t.vertices.map(|v| scene.vertices[v as usize].position.as_dvec3());
    scene.triangles.iter().map(corners).fold((0.0, 0.0), |(area, volume), [a, b, c]| {
        let normal = (b - a).cross(c - a);
        (area + normal.length() / 2.0, volume + a.dot(normal) / 6.0)
    })
}

/// Asserts that every corner's normal is on the side from which the triangle is counter-clockwise.
fn normals_face_out(scene: &Scene) {
    for t in &scene.triangles {
        let [a, b, c] = t.vertices.map(|v| scene.vertices[v as usize]);
        let turn = (b.position - a.position).cross(c.position - a.position);
        for vertex in [a, b, c] {
            assert!((vertex.normal.length() - 1.0).abs() < 1e-5, "{vertex:?}");
            assert!(vertex.normal.dot(turn) > 0.0, "{t:?} {vertex:?}");
        }
    }
}

fn built(build: impl FnOnce(&mut MeshBuilder)) -> Scene {
    let mut builder = MeshBuilder::default();
    build(&mut builder);
    builder.finish()
}

#[test]
fn curved_surfaces_have_their_analytic_area_and_volume() {
    let n = 128;
    let sphere = built(|b| b.sphere(DVec3::ONE, 2.0, n).unwrap());
    assert_eq!((sphere.triangles.len(), sphere.vertices.len()), (2 * 128 * 63, 128 * 63 + 2));
    let torus = built(|b| b.torus(DVec3::ONE, DVec3::X, 3.0, 1.0, n).unwrap());
    assert_eq!((torus.triangles.len(), torus.vertices.len()), (2 * 128 * 128, 128 * 128));
    let cone = built(|b| {
        b.cone((DVec3::ZERO, 2.0), (DVec3::Z * 3.0, 0.0), n).unwrap();
        b.ring(DVec3::ZERO, DVec3::NEG_Z, [0.0, 2.0], n).unwrap();
    });
    assert_eq!(cone.triangles.len(), 2 * 128);
    let slant = (4.0f64 + 9.0).sqrt();
    for (scene, area, volume) in [
        (&sphere, 16.0 * PI, 32.0 / 3.0 * PI),
        (&torus, 12.0 * PI * PI, 6.0 * PI * PI),
        (&cone, 4.0 * PI + 2.0 * PI * slant, 4.0 * PI),
    ] {
        let found = area_and_volume(scene);
        assert!((found.0 / area - 1.0).abs() < 2e-3 && (found.1 / volume - 1.0).abs() < 2e-3, "{found:?}");
        normals_face_out(scene);
    }
    let ring = built(|b| b.ring(DVec3::ONE, DVec3::Y, [1.0, 2.0], n).unwrap());
    assert!((area_and_volume(&ring).0 / (3.0 * PI) - 1.0).abs() < 2e-3);
    normals_face_out(&ring);
}

#[test]
fn surfaces_with_negative_radii_face_inwards() {
    for scene in [
        built(|b| b.sphere(DVec3::ZERO, -1.0, 16).unwrap()),
        built(|b| b.torus(DVec3::ZERO, DVec3::Y, 3.0, -1.0, 16).unwrap()),
    ] {
        assert!(area_and_volume(&scene).1 < -3.0);
        normals_face_out(&scene);
    }
}

#[test]
fn transforms_nest_and_mirrored_surfaces_face_outwards() {
    let scene = built(|b| {
        b.push(DAffine3::from_translation(DVec3::X * 10.0)).unwrap();
        b.push(DAffine3::from_scale(DVec3::new(-2.0, 1.0, 0.5))).unwrap();
        b.sphere(DVec3::ZERO, 1.0, 64).unwrap();
        assert!(b.pop() && b.pop() && !b.pop(), "the first transform cannot be popped");
    });
    normals_face_out(&scene);
    let (_, volume) = area_and_volume(&scene);
    assert!((volume / (4.0 / 3.0 * PI) - 1.0).abs() < 1e-2, "{volume}");
    // The normal of the ellipsoid (x/2)^2 + y^2 + (2z)^2 = 1 at (x, y, z) is parallel to (x/4, y, 4z).
    for v in &scene.vertices {
        let p = v.position - Vec3::X * 10.0;
        let expected = Vec3::new(p.x / 4.0, p.y, p.z * 4.0).normalize();
        assert!(v.normal.abs_diff_eq(expected, 1e-4), "{v:?} {expected}");
    }
    let mut deep = MeshBuilder::default();
    let fault = (0..2000).find_map(|_| deep.push(DAffine3::IDENTITY).err()).expect("a limit");
    assert!(fault.problem.contains("transforms are nested more than"));
}

#[test]
fn a_singular_transform_of_rank_two_gives_a_valid_normal() {
    let scene = built(|b| {
        b.push(DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0))).unwrap();
        b.polygon(&[DVec3::ZERO, DVec3::Z, DVec3::X], &[]).unwrap();
    });
    assert!(scene.vertices.iter().all(|v| v.normal == Vec3::Y), "{:?}", scene.vertices);
}

fn polygon(corners: &[[f64; 3]], holes: &[u32]) -> Scene {
    let corners: Vec<DVec3> = corners.iter().map(|&c| DVec3::from(c)).collect();
    built(|b| b.polygon_with_holes(&corners, &[], holes).unwrap())
}

#[test]
fn concave_holed_and_bent_polygons_keep_their_area() {
    // An L of area 3, in three planes, in both orientations
    let l = [[0., 0., 0.], [2., 0., 0.], [2., 1., 0.], [1., 1., 0.], [1., 2., 0.], [0., 2., 0.]];
    for turn in [|c: [f64; 3]| c, |[x, y, z]: [f64; 3]| [z, x, y], |[x, y, z]: [f64; 3]| [y, z, x]] {
        for reversed in [false, true] {
            let mut corners = l.map(turn);
            if reversed {
                corners.reverse();
            }
            let scene = polygon(&corners, &[]);
            assert_eq!(scene.triangles.len(), 4);
            assert!((area_and_volume(&scene).0 - 3.0).abs() < 1e-9);
            normals_face_out(&scene);
        }
    }
    let mut holed = vec![[0., 0., 5.], [4., 0., 5.], [4., 4., 5.], [0., 4., 5.]];
    holed.extend([[1., 1., 5.], [1., 2., 5.], [2., 2., 5.], [2., 1., 5.]]);
    let scene = polygon(&holed, &[4]);
    assert_eq!(scene.triangles.len(), 8);
    assert!((area_and_volume(&scene).0 - 15.0).abs() < 1e-9);
    normals_face_out(&scene);
    let bent = polygon(&[[0., 0., 0.], [1., 0., 0.01], [1., 1., 0.], [0.5, 0.1, 0.], [0., 1., 0.]], &[]);
    assert_eq!(bent.triangles.len(), 3);
    normals_face_out(&bent);
}

#[test]
fn convex_polygons_are_fans_and_degenerate_ones_are_counted() {
    let round = |i: usize| (i as f64 / 12.0 * 2.0 * PI).sin_cos();
    let circle: Vec<[f64; 3]> = (0..12).map(|i| [round(i).1, round(i).0, 1.0]).collect();
    let scene = polygon(&circle, &[]);
    let fan: Vec<[u32; 3]> = (1..11).map(|i| [0, i, i + 1]).collect();
    assert_eq!(scene.triangles.iter().map(|t| t.vertices).collect::<Vec<_>>(), fan);
    for corners in [vec![[1.; 3]; 5], vec![[0., 0., 0.], [1., 1., 1.], [2., 2., 2.], [3., 3., 3.]]] {
        assert_eq!(polygon(&corners, &[]).triangles.len(), corners.len() - 2, "degenerate polygons are counted");
    }
    for corners in [&[][..], &[[0.; 3]], &[[0.; 3], [1.; 3]]] {
        let scene = polygon(corners, &[]);
        assert!(scene.triangles.is_empty());
        assert_eq!(scene.warnings, ["polygon with fewer than three corners ignored"]);
    }
}

#[test]
fn corners_with_equal_normals_share_vertices_within_a_shape() {
    let (o, x, y, z) = (DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z);
    let scene = built(|b| {
        b.polygon(&[o, x, y], &[]).unwrap();
        b.polygon(&[x, x + y, y], &[]).unwrap(); // the same plane
        b.polygon(&[o, z, x], &[]).unwrap(); // a sharp edge
        b.polygon(&[o, x, y], &[z * 7.0, z, DVec3::ZERO]).unwrap(); // equal normals in another form
        b.new_shape();
        b.polygon(&[o, x, y], &[]).unwrap();
    });
    assert_eq!((scene.vertices.len(), scene.triangles.len()), (4 + 3 + 3, 5));
    assert_eq!(scene.warnings, ["normal that is zero or not finite: replaced by the polygon's"]);
}

#[test]
fn consecutive_coplanar_flat_polygons_share_vertices() {
    let (o, x, y, z) = (DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z);
    let scene = built(|b| {
        b.flat_polygon(&[o, x, x + y, y]).unwrap();
        b.flat_polygon(&[x, x * 2.0, x + y]).unwrap();
        b.flat_polygon(&[o, z, x]).unwrap();
        b.flat_polygon(&[o, x, y]).unwrap(); // the first plane again
        b.new_shape();
        b.flat_polygon(&[o, x, y]).unwrap();
        b.flat_polygon(&[x, y]).unwrap();
    });
    assert_eq!((scene.vertices.len(), scene.triangles.len()), (5 + 3 + 3 + 3, 6));
    assert_eq!(scene.warnings, ["polygon with fewer than three corners ignored"]);
    normals_face_out(&scene);
}

#[test]
fn equal_materials_are_stored_once_and_values_are_clamped() {
    let red = Material::matt(Vec3::X);
    let scene = built(|b| {
        for material in [red, Material::matt(Vec3::Y), red, Material { reflectivity: 7.0, exponent: f32::NAN, ..red }] {
            b.set_material(material);
            b.polygon(&[DVec3::ZERO, DVec3::X, DVec3::Y], &[]).unwrap();
        }
    });
    assert_eq!(scene.triangles.iter().map(|t| t.material).collect::<Vec<_>>(), [0, 1, 0, 2]);
    assert_eq!((scene.materials[2].reflectivity, scene.materials[2].exponent), (1.0, 0.0));
    assert_eq!(scene.warnings.len(), 1);
}

#[test]
fn memory_and_coordinates_are_limited() {
    let mut builder = MeshBuilder::default();
    builder.read(1000);
    let fault = (0..100_000).find_map(|_| builder.sphere(DVec3::ZERO, 1.0, 64).err()).expect("a limit");
    assert!(fault.problem.contains("more than 64 MiB"), "{}", fault.problem);
    assert!(builder.triangles() * size_of::<Triangle>() < 64 << 20);
    let mut builder = MeshBuilder::default();
    let fault = builder.vertex(DVec3::splat(1e200), DVec3::ZERO).unwrap_err();
    assert!(fault.problem.contains("not finite"), "{}", fault.problem);
}
