//! What the benches share: scenes, other people's builders, thread pools.

#![allow(dead_code, missing_docs)]

use bvh::aabb::Bounded;
use bvh::bounding_hierarchy::BHShape;
use glam::Vec3;
use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2;
use obvhs::triangle::Triangle;
use parry3d::partitioning::BvhBuildStrategy;
use rtbench::math::Vertex;
use rtbench::record::statistics::{self, Estimate};
use rtbench::scene::{Material, Scene, load};
use rtbench::workloads::trace::common::prims;

/// True under `cargo bench`; false where cargo only tests that the benches run.
pub fn measuring() -> bool {
    std::env::args().any(|arg| arg == "--bench")
}

/// The folder with the real scenes; an empty variable is as good as none.
pub fn scenes_folder() -> Option<std::path::PathBuf> {
    std::env::var_os("RTBENCH_SCENES").filter(|folder| !folder.is_empty()).map(std::path::PathBuf::from)
}

/// The real models, if the environment says where they are: `(name, scene)`.
pub fn models() -> Vec<(&'static str, Scene)> {
    let Some(folder) = scenes_folder() else {
        eprintln!("bunny and dragon are left out: RTBENCH_SCENES is not set");
        return Vec::new();
    };
    [("bunny", "bunny/bun_zipper.ply"), ("dragon", "dragon/dragon_vrip.ply")]
        .into_iter()
        .map(|(name, file)| {
            let path = folder.join(file);
            let what = path.to_str().expect("a folder with a printable name");
            (name, load(what).unwrap_or_else(|e| panic!("{e}")))
        })
        .collect()
}

/// A built-in scene of about this many triangles.
pub fn scan(triangles: usize) -> Scene {
    load(&format!("scan:triangles={triangles}")).unwrap_or_else(|e| panic!("{e}"))
}

/// A scene of separate triangles.
pub fn soup(triangles: impl IntoIterator<Item = [Vec3; 3]>) -> Scene {
    let mut scene = Scene { materials: vec![Material::matt(Vec3::ONE)], ..Scene::default() };
    for corners in triangles {
        let first = scene.vertices.len() as u32;
        scene.vertices.extend(corners.map(|corner| Vertex::new(corner, Vec3::Z)));
        scene.triangles.push(rtbench::scene::Triangle { vertices: [first, first + 1, first + 2], material: 0 });
    }
    scene
}

/// A pool of so many threads; 0: as many as there are.
pub fn pool(threads: usize) -> rayon::ThreadPool {
    rtbench::threads::pool(threads).expect("threads")
}

/// Input of the other builders, made once and outside of all measurements (unlike ours, which begins at the scene).
pub struct Input {
    pub triangles: Vec<Triangle>,
    pub parry: Vec<parry3d::bounding_volume::Aabb>,
    pub shapes: Vec<Shape>,
}

impl Input {
    pub fn new(scene: &Scene) -> Input {
        let indices = 0..scene.triangles.len() as u32;
        let boxes: Vec<_> = indices.clone().filter_map(|i| prims::prim(scene, i)).map(|p| p.aabb()).collect();
        let triangle = |i| {
            let [v0, v1, v2] = scene.corners(i);
            Triangle { v0, v1, v2 }
        };
        let vector = parry3d::math::Vector::from_array;
        Input {
            triangles: indices.map(triangle).collect(),
            parry: boxes
                .iter()
                .map(|b| parry3d::bounding_volume::Aabb::new(vector(b.min.to_array()), vector(b.max.to_array())))
                .collect(),
            shapes: boxes
                .iter()
                .map(|b| Shape {
                    aabb: bvh::aabb::Aabb::with_bounds(b.min.to_array().into(), b.max.to_array().into()),
                    node: 0,
                })
                .collect(),
        }
    }
}

/// parry3d's binned builder (one thread).
pub fn parry(input: &Input) -> parry3d::partitioning::Bvh {
    parry3d::partitioning::Bvh::from_leaves(BvhBuildStrategy::Binned, &input.parry)
}

/// obvhs, on the current pool.
pub fn obvhs(input: &Input, params: BvhBuildParams) -> Bvh2 {
    obvhs::bvh2::builder::build_bvh2_from_tris(&input.triangles, params, &mut Default::default())
}

/// A box as the `bvh` crate wants it.
#[derive(Clone)]
pub struct Shape {
    aabb: bvh::aabb::Aabb<f32, 3>,
    node: usize,
}

impl Bounded<f32, 3> for Shape {
    fn aabb(&self) -> bvh::aabb::Aabb<f32, 3> {
        self.aabb
    }
}

impl BHShape<f32, 3> for Shape {
    fn set_bh_node_index(&mut self, node: usize) {
        self.node = node;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}

/// Measures every contestant once a round, in alternating order. Returns the values by contestant and round.
pub fn interleaved(contestants: &mut [&mut dyn FnMut() -> f64], rounds: usize) -> Vec<Vec<f64>> {
    let mut times = vec![Vec::new(); contestants.len()];
    for round in 0..rounds {
        for i in statistics::interleaved_order(contestants.len(), round) {
            times[i].push((contestants[i])());
        }
    }
    times
}

/// The median of one contestant's values, of which there is at least one.
pub fn median(values: &[f64]) -> f64 {
    statistics::median(values).expect("a value")
}

/// The median of the rounds' ratios with its interval; there is at least one round.
pub fn ratio(above: &[f64], below: &[f64]) -> Estimate {
    statistics::paired_ratio(above, below).expect("a round")
}
