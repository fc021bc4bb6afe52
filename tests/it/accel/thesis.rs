//! The published structures (SPEC sections 2 to 4, 7): properties and sizes, from the real models.

use super::build;
use rtbench::scene::Scene;

/// A scene of the catalogue, or `None` (said on stderr) where there are no scenes.
pub fn model(name: &str) -> Option<Scene> {
    let Some(folder) = std::env::var_os("RTBENCH_SCENES").filter(|folder| !folder.is_empty()) else {
        eprintln!("NOT RUN: set RTBENCH_SCENES to the folder that holds {name}");
        return None;
    };
    Some(rtbench::scene::load_in(name, Some(std::path::Path::new(&folder))).unwrap())
}

/// Published rows of one model. Sizes in MiB.
struct Published {
    name: &'static str,
    /// What was set by hand.
    grid_options: &'static str,
    grid: [u32; 3],
    grid_fullest: u32,
    grid_references: f64,
    grid_mib: f64,
    kd_leaves: f64,
    kd_empty: f64,
    kd_fullest: u32,
    kd_references: f64,
    kd_mib: f64,
    bvh_nodes: f64,
    bvh_mib: f64,
}

const BUNNY: Published = Published {
    name: "bunny",
    grid_options: "",
    grid: [83, 82, 64],
    grid_fullest: 24,
    grid_references: 3.69,
    grid_mib: 8.33,
    kd_leaves: 153_698.0,
    kd_empty: 29_837.0,
    kd_fullest: 11,
    kd_references: 5.45,
    kd_mib: 9.22,
    bvh_nodes: 45_814.0,
    bvh_mib: 2.84,
};

const DRAGON: Published = Published {
    name: "dragon",
    grid_options: "",
    grid: [273, 193, 122],
    grid_fullest: 121,
    grid_references: 3.06,
    grid_mib: 103.10,
    kd_leaves: 977_816.0,
    kd_empty: 225_337.0,
    kd_fullest: 23,
    kd_references: 2.27,
    kd_mib: 58.50,
    bvh_nodes: 589_110.0,
    bvh_mib: 35.83,
};

const MUSEUM: Published = Published {
    name: "museum",
    grid_options: "",
    grid: [71, 43, 106],
    grid_fullest: 111,
    grid_references: 9.50,
    grid_mib: 5.10,
    kd_leaves: 25_828.0,
    kd_empty: 5_074.0,
    kd_fullest: 32,
    kd_references: 4.88,
    kd_mib: 2.01,
    bvh_nodes: 9_196.0,
    bvh_mib: 0.90,
};

const ROBOTS: Published = Published {
    name: "robots",
    grid_options: ":x=128",
    grid: [128, 209, 268],
    grid_fullest: 1363,
    grid_references: 19.23,
    grid_mib: 79.91,
    kd_leaves: 82_110.0,
    kd_empty: 11_880.0,
    kd_fullest: 85,
    kd_references: 6.61,
    kd_mib: 12.66,
    bvh_nodes: 50_170.0,
    bvh_mib: 6.08,
};

fn mib(bytes: u64) -> f64 {
    bytes as f64 / f64::from(1 << 20)
}

/// `value` is within `percent` of `published`.
fn assert_near(what: &str, value: f64, published: f64, percent: f64) {
    let off = 100.0 * (value / published - 1.0);
    assert!(off.abs() <= percent, "{what}: {value} is {off:.2} % off the published {published}");
}

/// `references`: how far the kd-tree's may be off, in percent. `fullest`: triangles of its largest leaf.
fn check(published: &Published, references: f64, fullest: u32) {
    let Some(scene) = model(published.name) else { return };
    let grid = build(&format!("grid{}", published.grid_options), &scene, 0);
    let p = grid.properties(&scene);
    assert_eq!([p.cells_x, p.cells_y, p.cells_z].map(Option::unwrap), published.grid);
    assert_eq!(p.max_cell_triangles, Some(published.grid_fullest));
    assert_eq!(format!("{:.2}", p.references_per_triangle.unwrap()), format!("{:.2}", published.grid_references));
    assert_near("grid size", mib(grid.thesis_bytes(&scene)), published.grid_mib, 0.5);

    let tree = build("kdtree", &scene, 0);
    let p = tree.properties(&scene);
    let (leaves, empty) = (f64::from(p.leaves.unwrap()), f64::from(p.empty_leaves.unwrap()));
    assert_near("kd-tree leaves", leaves, published.kd_leaves, 2.0);
    let filled = published.kd_leaves - published.kd_empty;
    assert_near("kd-tree leaves that are not empty", leaves - empty, filled, 2.0);
    assert_near("kd-tree empty leaves", empty, published.kd_empty, 2.0);
    assert_near("kd-tree references", p.references_per_triangle.unwrap(), published.kd_references, references);
    assert_near("kd-tree size", mib(tree.thesis_bytes(&scene)), published.kd_mib, references);
    assert_eq!(p.max_leaf_triangles, Some(fullest), "published: {}", published.kd_fullest);

    let bvh = build("bvh", &scene, 0);
    let p = bvh.properties(&scene);
    assert_near("BVH nodes", p.nodes.unwrap().into(), published.bvh_nodes, 6.0);
    assert_near("BVH size", mib(bvh.thesis_bytes(&scene)), published.bvh_mib, 6.0);
    assert_eq!(p.max_leaf_triangles, Some(4));
    for structure in [grid, tree, bvh] {
        structure.validate(&scene).unwrap();
    }
}

#[test]
fn bunny() {
    check(&BUNNY, 2.0, 12);
}

#[test]
fn dragon() {
    check(&DRAGON, 2.0, 24);
}

#[test]
fn museum() {
    check(&MUSEUM, 2.0, 33);
}

#[test]
fn robots() {
    check(&ROBOTS, 3.5, 75);
}

/// A kd-tree's leaves, empty leaves, largest leaf and depth.
fn kd_numbers(options: &str, scene: &Scene) -> [u32; 4] {
    let p = build(&format!("kdtree:{options}"), scene, 0).properties(scene);
    [p.leaves, p.empty_leaves, p.max_leaf_triangles, p.depth].map(Option::unwrap)
}

/// The rules of earlier versions, and those between them and today's: options that recorded runs may name.
#[test]
fn the_rows_of_other_kd_tree_rules() {
    const FORMER: &str = "spread=cell,exact_below=256,small_leaf=0,max_depth=auto";
    let rows = [
        ("bunny", [157_045, 34_657, 13, 29], [153_780, 29_798, 13, 29]),
        ("museum", [26_426, 6_114, 36, 26], [26_011, 5_291, 32, 28]),
        ("robots", [79_146, 13_182, 87, 29], [83_064, 12_438, 93, 36]),
    ];
    for (name, former, spread_over_cells) in rows {
        let Some(scene) = model(name) else { return };
        assert_eq!(kd_numbers(FORMER, &scene), former, "{name}");
        assert_eq!(kd_numbers("spread=cell", &scene), spread_over_cells, "{name}");
    }
}

/// Splits that would cut off very little: without the limit, the robots' tree has more leaves.
#[test]
fn the_rows_without_a_thinnest_slice() {
    for (name, numbers) in [("museum", [25_806, 5_096, 33, 28]), ("robots", [82_531, 12_106, 75, 36])] {
        let Some(scene) = model(name) else { return };
        assert_eq!(kd_numbers("thin=0", &scene), numbers, "{name}");
    }
}

/// The memory model itself, from the published counts alone: no model is needed.
#[test]
fn the_memory_model_gives_the_published_sizes() {
    use rtbench::math::{Aabb, Vertex};
    use rtbench::workloads::trace::bvh::{Bvh, BvhNode};
    use rtbench::workloads::trace::grid::{Cell, Grid};
    use rtbench::workloads::trace::kdtree::{KdNode, KdTree};
    use rtbench::workloads::trace::{Structure, TriangleRef};

    let bounds = Aabb::EMPTY;
    for (published, triangles, vertices) in [(BUNNY, 69_451.0, 35_947), (DRAGON, 871_414.0, 437_645)] {
        let scene = Scene { vertices: vec![Vertex::default(); vertices], ..Scene::default() };
        let triangle_refs = |per_triangle: f64| {
            vec![TriangleRef { vertices: [0; 3], triangle: 0 }; (per_triangle * triangles) as usize]
        };
        let size = |structure: &dyn Structure| mib(structure.thesis_bytes(&scene));
        let cells = vec![Cell::default(); published.grid.iter().product::<u32>() as usize];
        let resolution = published.grid;
        let grid =
            Grid { bounds, resolution, cell_size: 1.0, cells, triangle_refs: triangle_refs(published.grid_references) };
        assert!((size(&grid) - published.grid_mib).abs() < 0.03);
        let nodes = vec![KdNode::leaf(0, 0); 2 * published.kd_leaves as usize - 1];
        let tree = KdTree { bounds, nodes, triangle_refs: triangle_refs(published.kd_references), depth: 0 };
        assert!((size(&tree) - published.kd_mib).abs() < 0.08);
        let nodes = vec![BvhNode::NONE; published.bvh_nodes as usize];
        let bvh = Bvh { bounds, nodes, triangle_refs: Vec::new(), depth: 0, spatial: None };
        assert!((size(&bvh) - published.bvh_mib).abs() < 0.011);
    }
}
