//! What `rtbench scenes info` says of a structure's memory before it is built.

use glam::Vec3;
use rtbench::accel::grid::Grid;
use rtbench::accel::{estimate, grid_build};
use rtbench::math::Vertex;
use rtbench::scene::{Material, Scene, Triangle};

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
        let grid: Grid = grid_build::build(&scene, &grid_build::Config::default()).unwrap();
        let built = (size_of_val(grid.cells.as_slice()) + size_of_val(grid.records.as_slice())) as f64;
        let estimated = estimate::estimates(&scene)[0].structure_bytes as f64;
        assert!((0.5..2.0).contains(&(estimated / built)), "height {height}: {estimated} estimated, {built} built");
    }
}
