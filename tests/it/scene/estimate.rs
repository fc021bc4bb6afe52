//! What `rtbench scenes info` says of a structure's memory before it is built.

use glam::Vec3;
use rtbench::math::Vertex;
use rtbench::scene::{Material, Scene, Triangle, load_in};
use rtbench::workloads::trace::Selection;
use rtbench::workloads::trace::common::estimate;
use rtbench::workloads::trace::grid;
use rtbench::workloads::trace::grid::Grid;

/// A square of so many cells along each edge, as high as it says.
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

/// The builder makes a grid coarser where the rule would take all memory, and the estimate knows that.
#[test]
fn the_grid_is_estimated_with_the_builders_limits() {
    for (cells, height) in [(100, 100.0), (100, 1.0), (100, 0.01), (20, 0.0)] {
        let scene = field(cells, height);
        let config = grid::build::Config::default();
        let grid: Grid = grid::build::build(&scene, &config).unwrap();
        let built = (size_of_val(grid.cells.as_slice()) + size_of_val(grid.triangle_refs.as_slice())) as f64;
        let estimate = estimate::estimates(&scene, &config).unwrap()[0];
        let off = estimate.structure_bytes as f64 / built;
        assert!((1.0 / estimate.factor..estimate.factor).contains(&off), "height {height}: {off} of {built}");
    }
}

/// What is printed beside the estimates is true of real scenes.
#[test]
fn estimates_are_as_close_as_they_say() {
    let Some(folder) = super::real_scenes("estimates_are_as_close_as_they_say") else { return };
    let scenes = [("bunny", ""), ("museum", ""), ("robots", ":x=128"), ("sponza", ""), ("dragon", "")];
    for (name, options) in scenes {
        let scene = match load_in(name, Some(&folder)) {
            Ok(scene) => scene,
            Err(error) => {
                eprintln!("{name} was left out: {error}");
                continue;
            }
        };
        let grid = Selection::parse(&format!("grid{options}")).unwrap();
        let estimates = estimate::estimates(&scene, &grid.grid_config().unwrap()).unwrap();
        let mut thesis = Vec::new();
        for estimate in estimates {
            let options = if estimate.structure == "grid" { options } else { "" };
            let selection = Selection::parse(&format!("{}{options}", estimate.structure)).unwrap();
            let built = selection.build(&scene, 0).unwrap().structure;
            let close = 1.0 / estimate.factor..estimate.factor;
            for (estimated, real) in [
                (estimate.structure_bytes, built.structure_bytes()),
                (estimate.thesis_bytes, built.thesis_bytes(&scene)),
            ] {
                let off = estimated as f64 / real as f64;
                assert!(close.contains(&off), "{name}, {}: {estimated} estimated, {real} built", estimate.structure);
            }
            thesis.push(estimate.thesis_bytes);
        }
        assert!(name != "dragon" || thesis[1] < thesis[0], "the dragon's kd-tree is smaller than its grid: {thesis:?}");
    }
}
