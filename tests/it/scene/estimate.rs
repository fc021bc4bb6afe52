//! Tests of the estimates of a structure's memory in `rtbench scenes info`.

use glam::Vec3;
use rtbench::math::Vertex;
use rtbench::scene::{Material, Scene, Triangle, load_in};
use rtbench::workloads::trace::Selection;
use rtbench::workloads::trace::common::estimate;
use rtbench::workloads::trace::grid;
use rtbench::workloads::trace::grid::Grid;

/// A square heightfield with this number of cells along each edge.
fn field(cells: u32, height: f32) -> Scene {
    let mut random = crate::support::random(3);
    let row = cells + 1;
    let point = |i: u32| Vec3::new((i % row) as f32, (i / row) as f32, random().abs() * height);
    let corner = |i: u32| i / cells * row + i % cells;
    let triangle = |vertices| Triangle { vertices, material: 0 };
    Scene {
        name: "field".into(),
        vertices: (0..row * row).map(point).map(|p| Vertex::new(p, Vec3::Z)).collect(),
        triangles: (0..cells * cells)
            .map(corner)
            .flat_map(|c| [triangle([c, c + 1, c + row]), triangle([c + 1, c + row + 1, c + row])])
            .collect(),
        materials: vec![Material::neutral()],
        ..Scene::default()
    }
}

/// The builder coarsens a grid if the rule would take too much memory; the estimate takes this into account.
#[test]
fn the_estimate_of_the_grid_includes_the_limits_of_the_builder() {
    for (cells, height) in [(100, 100.0), (100, 1.0), (100, 0.01), (20, 0.0)] {
        let scene = field(cells, height);
        let grid: Grid = grid::build::build(&scene, &grid::build::Config::default()).unwrap();
        let built = (size_of_val(grid.cells.as_slice()) + size_of_val(grid.triangle_refs.as_slice())) as f64;
        let estimate = estimate::estimates(&scene, &[Selection::parse("grid").unwrap()]).unwrap()[0];
        let off = estimate.structure_bytes as f64 / built;
        assert!((1.0 / estimate.factor..estimate.factor).contains(&off), "height {height}: {off} of {built}");
    }
}

/// The printed factors of uncertainty hold for real scenes.
#[test]
fn estimates_are_within_their_stated_factors() {
    let Some(folder) = super::real_scenes("estimates_are_as_close_as_they_say") else { return };
    let scenes = [("bunny", ""), ("museum", ""), ("robots", ":x=128"), ("sponza", ""), ("dragon", "")];
    for (name, options) in scenes {
        let scene = match load_in(name, Some(&folder)) {
            Ok(scene) => scene,
            Err(error) => {
                eprintln!("{name} was skipped: {error}");
                continue;
            }
        };
        let grid = format!("grid{options}");
        let selections = [&grid, "kdtree", "bvh", "bvh:build=sweep,max_leaf=3", "bvh:build=spatial,max_leaf=3"];
        let selections = selections.map(|text| Selection::parse(text).unwrap());
        let estimates = estimate::estimates(&scene, &selections).unwrap();
        let mut thesis = Vec::new();
        for (selection, estimate) in selections.iter().zip(estimates) {
            let built = selection.build(&scene, 0).unwrap().structure;
            let close = 1.0 / estimate.factor..estimate.factor;
            for (estimated, real) in [
                (estimate.structure_bytes, built.structure_bytes()),
                (estimate.thesis_bytes, built.thesis_bytes(&scene)),
            ] {
                let off = estimated as f64 / real as f64;
                assert!(close.contains(&off), "{name}, {}: {estimated} estimated, {real} built", selection.full_name());
            }
            thesis.push(estimate.thesis_bytes);
        }
        assert!(name != "dragon" || thesis[1] < thesis[0], "the dragon's kd-tree is smaller than its grid: {thesis:?}");
    }
}
