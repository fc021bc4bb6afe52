//! Surfaces that are built without a search have exactly the vertices that a search would give.

use super::*;
use crate::scene::Scene;
use glam::{DAffine3, DMat3};
use std::collections::HashSet;

/// A shape, and whether its vertices were built without a search.
fn built(frame: DAffine3, build: &dyn Fn(&mut MeshBuilder)) -> (Scene, bool) {
    let mut builder = MeshBuilder::default();
    builder.set_transform(frame);
    build(&mut builder);
    let quick = !builder.unlisted.is_empty();
    (builder.finish(), quick)
}

const SHAPES: [&dyn Fn(&mut MeshBuilder); 7] = [
    &|b| b.sphere(DVec3::new(1.0, -2.0, 0.5), 1.5, 24).unwrap(),
    &|b| b.sphere(DVec3::ZERO, -1e-3, 5).unwrap(),
    &|b| b.cone((DVec3::ZERO, 2.0), (DVec3::new(1.0, 3.0, 0.0), 0.0), 24).unwrap(),
    &|b| b.cone((DVec3::X, -1.0), (DVec3::Z, -1.0), 3).unwrap(),
    &|b| b.ring(DVec3::ONE, DVec3::new(1.0, 2.0, 3.0), [0.0, 2.0], 20).unwrap(),
    &|b| b.torus(DVec3::ONE, DVec3::X, 3.0, 1.0, 12).unwrap(),
    // Its inner circle is a point with many normals.
    &|b| b.torus(DVec3::ONE, DVec3::Y, 1.0, -1.0, 8).unwrap(),
];

#[test]
fn no_vertex_is_duplicated_and_few_surfaces_are_searched() {
    let turned = DMat3::from_axis_angle(DVec3::new(1.0, 1.0, 0.0).normalize(), 1.0);
    let frames = [
        DAffine3::IDENTITY,
        DAffine3::from_mat3_translation(turned, DVec3::splat(7.0)),
        DAffine3::from_mat3_translation(turned * DMat3::from_diagonal(DVec3::new(-2.0, 1.0, 0.5)), DVec3::X),
        // Vertices can coincide if the surface is flattened to a plane, a line or a point, or is far away.
        DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0)),
        DAffine3::from_scale(DVec3::new(0.0, 2.0, 0.0)),
        DAffine3::from_scale(DVec3::ZERO),
        DAffine3::from_translation(DVec3::splat(1e9)),
    ];
    for (number, frame) in frames.into_iter().enumerate() {
        for (shape, build) in SHAPES.iter().enumerate() {
            let (scene, quick) = built(frame, build);
            assert_eq!(quick, number < 3, "shape {shape} in frame {number}");
            let different: HashSet<[u32; 8]> = scene.vertices.iter().map(|&v| bytemuck::cast(v)).collect();
            assert_eq!(different.len(), scene.vertices.len(), "shape {shape} in frame {number}");
        }
    }
}

#[test]
fn surfaces_near_the_limits_are_searched() {
    let mut builder = MeshBuilder::default();
    builder.charge(size_of::<Vertex>() << 20).unwrap();
    let fault = builder.sphere(DVec3::ZERO, 1.0, 24).unwrap_err();
    assert!(fault.problem.contains("more than 64 MiB"), "{}", fault.problem);
    assert!(builder.unlisted.is_empty(), "the surface was searched, not refused before its first vertex");
}

#[test]
fn polygons_share_vertices_with_a_surface_of_the_same_shape() {
    let center = DVec3::new(3.0, 1.0, 2.0);
    let (scene, _) = built(DAffine3::IDENTITY, &|b| {
        b.ring(center, DVec3::Y, [0.0, 1.0], 4).unwrap();
        b.polygon(&[center, center + DVec3::Z * 5.0, center + DVec3::X * 5.0], &[]).unwrap();
        b.new_shape();
        b.polygon(&[center, center + DVec3::Z * 5.0, center + DVec3::X * 5.0], &[]).unwrap();
    });
    assert_eq!(scene.vertices.len(), 4 + 1 + 2 + 3, "{:?}", scene.vertices);
}

#[test]
fn cached_normals_equal_those_of_a_single_sphere() {
    let flat = DAffine3::from_scale(DVec3::new(1.0, 0.5, -2.0));
    let spheres = [(DAffine3::IDENTITY, 1.0, 8), (DAffine3::IDENTITY, 2.0, 8), (DAffine3::IDENTITY, -2.0, 8)];
    let others = [(flat, -2.0, 8), (flat, 1.0, 8), (flat, 1.0, 9), (DAffine3::IDENTITY, 1.0, 8)];
    let mut together = MeshBuilder::default();
    let mut normals: Vec<Vec3> = Vec::new();
    for (frame, radius, segments) in spheres.into_iter().chain(others) {
        let add = |builder: &mut MeshBuilder| {
            builder.set_transform(frame);
            builder.sphere(DVec3::ONE, radius, segments).unwrap();
        };
        add(&mut together);
        let mut alone = MeshBuilder::default();
        add(&mut alone);
        normals.extend(alone.finish().vertices.iter().map(|v| v.normal));
    }
    // Another surface replaces the cached normals.
    assert!(together.torus(DVec3::ZERO, DVec3::X, 2.0, 1.0, 8).is_ok() && together.circles.sphere.is_none());
    assert!(together.finish().vertices.iter().map(|v| v.normal).take(normals.len()).eq(normals.iter().copied()));
}
