//! The kd-tree's ropes against its full stack, ray by ray: the same leaves and tests, and fewer inner nodes; which rays
//! are given up; memory.

use crate::meshes::lattice;
use crate::support::{data, random};
use crate::traversal::{assert_same, trace};
use glam::Vec3;
use rtbench::camera::CameraPath;
use rtbench::math::{Hit, MISS, Ray, T_MAX};
use rtbench::scene::{self, Scene};
use rtbench::workloads::trace::CpuBackend;
use rtbench::workloads::trace::backend::{Backend, Counters, GivenRay};
use rtbench::workloads::trace::common::memory::rt2;
use rtbench::workloads::trace::counting::Counted;
use rtbench::workloads::trace::intersect::TriangleTest;
use rtbench::workloads::trace::kdtree::ropes::KdRopes;
use rtbench::workloads::trace::kdtree::stack::KdStack;
use rtbench::workloads::trace::kdtree::{KdTree, NO_ROPE, RopeTree};
use rtbench::workloads::trace::traverse::{TraverseIndependent, Triangles};
use rtbench::workloads::trace::{Selection, Structure};

fn build<S: Structure + Clone>(selection: &str, scene: &Scene) -> S {
    let built = Selection::parse(selection).unwrap().build(scene, 0).unwrap();
    built.structure.downcast_ref::<S>().expect("a structure of this type").clone()
}

fn triangles<'a>(scene: &'a Scene, tree: &'a KdTree) -> Triangles<'a> {
    Triangles { vertices: &scene.vertices, triangle_refs: &tree.triangle_refs, test: TriangleTest::Watertight }
}

/// What a ray finds, and what it costs.
fn cost(traversal: &impl TraverseIndependent, ray: &GivenRay, any: bool) -> (u32, Counters) {
    let (ray, mut counters) = (Ray::new(ray.origin.into(), ray.direction.into()), Counters::default());
    let found = match any {
        true => traversal.traverse::<true, Counters>(&ray, T_MAX, &mut counters),
        false => traversal.traverse::<false, Counters>(&ray, T_MAX, &mut counters),
    };
    (found, counters)
}

/// A full stack and ropes on the same rays, summed.
#[derive(Clone, Copy, Debug, Default)]
struct Compared {
    fallbacks: usize,
    stack_inner: u64,
    ropes_inner: u64,
    /// Rays with another hit.
    other_hits: usize,
    /// Rays that were not given up and visited other leaves or made other tests.
    other_leaves: usize,
    /// Rays that were not given up and visited another number of inner nodes.
    other_inner: usize,
    /// Rays that were not given up and did not follow a rope from each leaf but the last one.
    other_ropes: usize,
}

fn compare(scene: &Scene, ropes: &RopeTree, rays: &[GivenRay], any: bool) -> Compared {
    let triangles = triangles(scene, &ropes.tree);
    let (stack, walk) = (KdStack::new(triangles, &ropes.tree), KdRopes::new(triangles, ropes));
    let mut sum = Compared::default();
    for ray in rays {
        let ((hit, by_stack), (found, by_ropes)) = (cost(&stack, ray, any), cost(&walk, ray, any));
        assert!(by_ropes.fallbacks <= 1 && by_ropes.pops == 0);
        // Of any hits, a ray that is given up may find another one
        sum.other_hits += usize::from(if any { (hit == MISS) != (found == MISS) } else { hit != found });
        sum.stack_inner += u64::from(by_stack.inner);
        sum.ropes_inner += u64::from(by_ropes.inner);
        if by_ropes.fallbacks > 0 {
            sum.fallbacks += 1;
            continue;
        }
        let leaves = (by_ropes.leaves, by_ropes.tests) != (by_stack.leaves, by_stack.tests);
        sum.other_leaves += usize::from(leaves);
        sum.other_inner += usize::from(by_ropes.inner != by_stack.inner);
        sum.other_ropes += usize::from(by_ropes.ropes + 1 != by_ropes.leaves.max(1));
    }
    sum
}

/// Primary rays of some frames of a camera path.
fn camera_rays(scene: &Scene, path: &str, side: u32, frames: usize) -> Vec<GivenRay> {
    let path = CameraPath::load(path).unwrap();
    let mut rays = Vec::new();
    for view in path.views(scene, Some(frames)).unwrap() {
        let grid = view.camera.pixel_grid(side, side);
        for (y, x) in (0..side).flat_map(|y| (0..side).map(move |x| (y, x))) {
            let direction = grid.corner + grid.right * (x as f32 + 0.5) + grid.down * (y as f32 + 0.5);
            rays.push(GivenRay { origin: grid.origin, direction: direction.normalize() });
        }
    }
    rays
}

/// Rays from everywhere around and in a scene.
fn random_rays(scene: &Scene, count: usize, seed: u32) -> Vec<GivenRay> {
    let (bounds, mut random) = (scene.bounds(), random(seed));
    let mut point = |scale: f32| bounds.center() + bounds.extent() * Vec3::new(random(), random(), random()) * scale;
    (0..count)
        .map(|index| {
            let (origin, target) = (point(if index % 2 == 0 { 0.5 } else { 2.0 }), point(0.5));
            GivenRay { origin, direction: target - origin }
        })
        .filter(|ray| ray.direction != Vec3::ZERO)
        .collect()
}

fn assert_alike(name: &str, compared: &Compared) {
    let Compared { other_hits, other_leaves, other_ropes, .. } = *compared;
    assert_eq!((other_hits, other_leaves, other_ropes), (0, 0, 0), "{name}: {compared:?}");
}

/// Ropes of a scene along a camera path: what the source promises of them, and what others measured.
fn promises(scene: &Scene, path: &str, side: u32) {
    let name = &scene.name;
    let pushed: RopeTree = build("kdtree:build=sort,search=ropes", scene);
    let rays = camera_rays(scene, path, side, 4);
    let with_push = compare(scene, &pushed, &rays, false);
    eprintln!("{name}: {with_push:?}");
    assert_alike(name, &with_push);
    assert!(with_push.fallbacks * 10_000 <= rays.len(), "{name}: {with_push:?}");
    assert!(with_push.ropes_inner as f64 <= 0.87 * with_push.stack_inner as f64, "{name}: {with_push:?}");
    let ends = pushed.leaves().iter().flat_map(|leaf| leaf.low.into_iter().chain(leaf.high));
    let (at_leaves, all) = ends.filter(|&rope| rope != NO_ROPE).fold((0, 0), |(leaves, all), rope| {
        (leaves + usize::from(pushed.tree.nodes[rope as usize].is_leaf()), all + 1)
    });
    eprintln!("{name}: {at_leaves} of {all} ropes end at leaves");
    assert!(2 * at_leaves >= all, "{name}: {at_leaves} of {all} ropes end at leaves");
    let as_tied = RopeTree::new(pushed.tree.clone(), false);
    let without_push = compare(scene, &as_tied, &rays, false);
    assert_alike(name, &without_push);
    assert_eq!(without_push.other_inner, 0, "{name}: {without_push:?}");
    assert_alike(name, &compare(scene, &pushed, &rays[..rays.len() / 4], true));
}

#[test]
fn ropes_visit_the_leaves_of_a_full_stack_along_camera_paths() {
    promises(&scene::load("scan:triangles=20000").unwrap(), "orbit", 64);
    promises(&scene::load("room:triangles=20000").unwrap(), "room", 64);
}

#[test]
fn ropes_visit_the_leaves_of_a_full_stack_around_real_models() {
    let Some(folder) = std::env::var_os("RTBENCH_SCENES").filter(|folder| !folder.is_empty()) else {
        eprintln!("NOT RUN: set RTBENCH_SCENES to the folder that holds bunny, dragon and sponza");
        return;
    };
    for (name, path) in [("bunny", "orbit"), ("sponza", "sponza"), ("dragon", "orbit")] {
        let scene = scene::load_in(name, Some(std::path::Path::new(&folder))).unwrap();
        promises(&scene, path, 128);
    }
}

/// Structures of every builder, and rays from everywhere.
#[test]
fn ropes_visit_the_leaves_of_a_full_stack_from_anywhere() {
    for (index, scene) in ["terrain:triangles=3000", "sphereflake:triangles=3000", "hall"].into_iter().enumerate() {
        let scene = scene::load(scene).unwrap();
        let rays = random_rays(&scene, 5_000, 5 + index as u32);
        for build_options in ["", "build=min-max,", "build=sort,", "build=sort,thin=0,", "small_leaf=40,"] {
            for push in ["", "push=off,"] {
                let selection = format!("kdtree:{build_options}{push}search=ropes");
                let ropes: RopeTree = build(&selection, &scene);
                for any in [false, true] {
                    let compared = compare(&scene, &ropes, &rays, any);
                    assert_alike(&selection, &compared);
                    assert!(push.is_empty() || compared.other_inner == 0, "{selection}: {compared:?}");
                    assert!(compared.fallbacks < rays.len() / 100, "{selection}: {compared:?}");
                }
            }
        }
    }
}

/// Rays through corners and edges of cells, which are given up, and some that are not.
#[test]
fn rays_through_edges_of_cells_are_given_up_and_right() {
    let mesh = scene::load(data("rays/lattice.obj").to_str().unwrap()).unwrap();
    let rays = rtbench::workloads::trace::rays_csv::read(&data("rays/lattice_rays.csv")).unwrap();
    for selection in
        ["kdtree:search=ropes", "kdtree:build=sort,search=ropes", "kdtree:build=sort,push=off,search=ropes"]
    {
        let compared = compare(&mesh, &build(selection, &mesh), &rays, false);
        assert_alike(selection, &compared);
        assert!((1..rays.len()).contains(&compared.fallbacks), "{selection}: {compared:?}");
    }
    let cpu = CpuBackend::new(2).unwrap();
    let truth = trace(&cpu, &mesh, "brute", &rays, false);
    for selection in ["kdtree:build=sort,search=stack", "kdtree:build=sort,search=ropes", "kdtree:build=min-max"] {
        assert_same(cpu.info(), selection, &rays, &truth, &trace(&cpu, &mesh, selection, &rays, false));
    }
    let other = lattice(300, 12, 5);
    let rays = random_rays(&other, 20_000, 3);
    let rounded: Vec<GivenRay> = rays
        .iter()
        .map(|ray| GivenRay { origin: ray.origin.round(), direction: ray.direction.round() })
        .filter(|ray| ray.direction != Vec3::ZERO)
        .collect();
    let ropes: RopeTree = build("kdtree:build=sort,search=ropes", &other);
    let compared = compare(&other, &ropes, &rounded, false);
    assert_alike("rounded rays", &compared);
    assert!(compared.fallbacks > rounded.len() / 50, "{compared:?}");
}

/// The comparison above can fail: ropes that lead elsewhere are seen, and so are rays that should have been given up.
#[test]
fn wrong_ropes_are_noticed() {
    let scene = scene::load("scan:triangles=3000").unwrap();
    let rays = camera_rays(&scene, "orbit", 64, 1);
    let good: RopeTree = build("kdtree:build=sort,search=ropes", &scene);
    assert_alike("as built", &compare(&scene, &good, &rays, false));
    let mut cut = good.clone();
    cut.leaves_mut().iter_mut().for_each(|leaf| leaf.high = [NO_ROPE; 3]);
    let compared = compare(&scene, &cut, &rays, false);
    assert!(compared.other_leaves > 0 && compared.other_hits > 0, "{compared:?}");
    let mut moved = good.clone();
    moved.leaves_mut().iter_mut().for_each(|leaf| leaf.max[0] += 1e-3 * scene.bounds().extent().x);
    assert!(compare(&scene, &moved, &rays, false).other_leaves > 0);
    let as_tied = RopeTree::new(good.tree.clone(), false);
    assert!(
        compare(&scene, &good, &rays, false).other_inner > 0
            && compare(&scene, &as_tied, &rays, false).other_inner == 0
    );
}

/// By the source's model, ropes take 48 bytes a leaf; what is allocated is another number.
#[test]
fn ropes_take_48_bytes_a_leaf_in_the_model() {
    for name in ["scan:triangles=5000", "sphereflake:triangles=5000", "hall"] {
        let scene = scene::load(name).unwrap();
        let standard: KdTree = build("kdtree:build=sort,search=stack", &scene);
        let leaves = standard.nodes.iter().filter(|node| node.is_leaf()).count() as u64;
        for push in ["", "push=off,"] {
            let ropes: RopeTree = build(&format!("kdtree:build=sort,{push}search=ropes"), &scene);
            assert_eq!(ropes.tree.nodes, standard.nodes, "{name}");
            assert_eq!(ropes.rt2_bytes() - standard.rt2_bytes(), 48 * leaves, "{name}");
            assert_eq!(standard.rt2_bytes(), rt2::kdtree_bytes(leaves, standard.triangle_refs.len() as u64));
            // Two nodes a row of 16 bytes, four rows a leaf, 16 bytes a triangle reference
            let rows = (2 * leaves - 1).div_ceil(2) + 4 * leaves;
            assert_eq!(ropes.structure_bytes(), 16 * (rows + standard.triangle_refs.len() as u64), "{name}");
            assert_eq!(ropes.nodes().len() as u64, 16 * rows);
        }
    }
}

/// Frames of all ray types: what a stack finds, ropes find.
#[test]
fn shadows_and_reflections_are_those_of_a_full_stack() {
    use rtbench::workloads::trace::backend::{Config, Size};
    let scene = scene::load("hall").unwrap();
    let view = CameraPath::load("hall").unwrap().views(&scene, Some(1)).unwrap().remove(0);
    let size = Size { width: 64, height: 64 };
    let cpu = CpuBackend::new(2).unwrap();
    let [stack, ropes] = ["kdtree:search=stack", "kdtree:search=ropes"].map(|text| {
        let selection = Selection::parse(text).unwrap();
        let built = selection.build(&scene, 2).unwrap();
        let mut prepared = cpu.prepare(&scene, &*built.structure, selection.method()).unwrap();
        let mut pixels = Vec::new();
        prepared.counted(Config::PSR, &view, size, &mut |_, band| pixels.extend_from_slice(band)).unwrap();
        pixels
    });
    for (a, b) in stack.iter().zip(&ropes) {
        assert_eq!((a.pixel, a.t), (b.pixel, b.t));
        for (a, b) in a.counters.iter().zip(&b.counters).filter(|(_, b)| b.fallbacks == 0) {
            assert_eq!((a.rays, a.leaves, a.tests), (b.rays, b.leaves, b.tests));
        }
    }
    let followed: u32 = ropes.iter().map(|pixel| pixel.counters.iter().map(|c| c.ropes).sum::<u32>()).sum();
    assert!(followed > 0 && Hit::NONE.triangle == MISS);
}

/// A row whose rays go without ropes says so.
#[test]
fn many_rays_without_ropes_are_a_warning() {
    let mut counted = Counted::default();
    counted.sums[0].rays = 1000;
    counted.sums[1].rays = 1000;
    counted.sums[0].fallbacks = 20;
    assert_eq!(counted.warnings(1), [""; 0]);
    counted.sums[1].fallbacks = 1;
    let warnings = counted.warnings(1);
    assert!(warnings.len() == 1 && warnings[0].contains("without ropes"), "{warnings:?}");
}
