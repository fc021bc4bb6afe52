//! The BVH builder that looks at all borders between triangles, and traversal without culling.

use super::thesis::model;
use super::{build, build_as, bytes, scenes};
use crate::traversal::trace;
use glam::Vec3;
use rtbench::camera::CameraPath;
use rtbench::math::Aabb;
use rtbench::scene::{self, Scene};
use rtbench::workloads::trace::backend::{Backend, Config, CountedPixel, GivenRay, Size};
use rtbench::workloads::trace::bvh::Bvh;
use rtbench::workloads::trace::{CpuBackend, Selection};

pub fn sah(selection: &str, scene: &Scene) -> f64 {
    build(selection, scene, 0).properties(scene).sah_cost.unwrap()
}

/// Three built-in scenes, and those of the catalogue that there are.
fn six() -> Vec<Scene> {
    let built_in = ["scan:triangles=32000", "room:triangles=80000", "sphereflake:triangles=107000"];
    let catalogue = ["bunny", "sponza", "dragon"].into_iter().filter_map(model);
    built_in.into_iter().map(|name| scene::load(name).unwrap()).chain(catalogue).collect()
}

#[test]
fn sorting_once_or_in_every_node_gives_the_same_tree() {
    let room = scene::load("room:triangles=20000").unwrap();
    let large = scenes::random("more than one task", 70_000, 1.0, 0.02, 5);
    let scenes = scenes::degenerate().into_iter().chain(scenes::ordinary()).chain([room, large]);
    for scene in scenes {
        for options in ["max_leaf=3", "max_leaf=1,axes=longest", "max_leaf=8,kt=1,max_depth=18"] {
            let [once, every_node] = ["", ",sorting=every-node"]
                .map(|sorting| bytes(&build(&format!("bvh:build=sweep,{options}{sorting}"), &scene, 2)));
            assert!(once == every_node, "{options} over {}", scene.name);
        }
    }
}

/// The root is split at the border of least cost, found here one by one in double precision.
#[test]
fn no_border_is_cheaper() {
    let half_area = |b: Aabb| {
        let e = b.extent().as_dvec3();
        e.x * e.y + e.y * e.z + e.z * e.x
    };
    for seed in 0..20 {
        let scene = scenes::random("few", 90, 1.0, 0.3, 100 + seed);
        let corners = |i: u32| scene.corners(i).map(Vec3::from);
        let boxes: Vec<Aabb> = (0..90).map(|i| Aabb::from_points(corners(i))).collect();
        let cost = |order: &[Aabb], at: usize| {
            let around = |part: &[Aabb]| half_area(part.iter().fold(Aabb::EMPTY, |all, &b| all.union(b)));
            around(&order[..at]) * at as f64 + around(&order[at..]) * (order.len() - at) as f64
        };
        let mut cheapest = [f64::INFINITY; 3];
        for (axis, cheapest) in cheapest.iter_mut().enumerate() {
            let mut order = boxes.clone();
            order.sort_by(|a, b| (a.min[axis] + a.max[axis]).total_cmp(&(b.min[axis] + b.max[axis])));
            *cheapest = (1..90).map(|at| cost(&order, at)).fold(f64::INFINITY, f64::min);
        }
        let root_cost = |options: &str| {
            let bvh: Bvh = build_as(&format!("bvh:build=sweep,max_leaf=1{options}"), &scene);
            let children = bvh.nodes[0].first as usize;
            let count = |node: usize| triangles_below(&bvh, node) as f64;
            let [left, right] = [children, children + 1];
            half_area(bvh.nodes[left].aabb()) * count(left) + half_area(bvh.nodes[right].aabb()) * count(right)
        };
        let all = cheapest.into_iter().fold(f64::INFINITY, f64::min);
        assert!((root_cost("") / all - 1.0).abs() < 1e-5, "{} instead of {all}", root_cost(""));
        let extent = scene.bounds().extent().to_array();
        let longest = (0..3).max_by(|&a, &b| extent[a].total_cmp(&extent[b])).unwrap();
        let found = root_cost(",axes=longest");
        assert!((found / cheapest[longest] - 1.0).abs() < 1e-5, "{found} instead of {}", cheapest[longest]);
    }
}

fn triangles_below(bvh: &Bvh, node: usize) -> usize {
    let (first, count) = (bvh.nodes[node].first as usize, bvh.nodes[node].count as usize);
    if count > 0 { count } else { triangles_below(bvh, first) + triangles_below(bvh, first + 1) }
}

#[test]
fn all_borders_are_at_least_as_good_as_sixteen_bins() {
    for scene in six() {
        let (sweep, binned) = (sah("bvh:build=sweep,max_leaf=3", &scene), sah("bvh:max_leaf=3", &scene));
        assert!(sweep <= binned, "{}: {sweep}, binned {binned}", scene.name);
    }
}

/// Cost and nodes a triangle that another implementation of the full sweep has on these scenes, within 1 %.
#[test]
fn cost_and_nodes_are_those_of_the_specification() {
    let expected = [
        ("scan:triangles=32000", 27.85, 0.933),
        ("room", 50.68, 0.922),
        ("sphereflake:triangles=107000", 13.82, 0.883),
        ("bunny", 31.35, 0.919),
        ("sponza", 66.90, 0.940),
        ("dragon", 48.78, 0.866),
    ];
    for scene in six() {
        let (_, cost, nodes) = *expected.iter().find(|row| row.0 == scene.name).expect("one of the six scenes");
        let found = build("bvh:build=sweep,max_leaf=3", &scene, 0).properties(&scene);
        // Without the root's dummy sibling
        let found_nodes = f64::from(found.nodes.unwrap() - 1) / scene.triangles.len() as f64;
        let found_cost = found.sah_cost.unwrap();
        assert!((found_cost / cost - 1.0).abs() < 0.01, "{}: {found_cost} instead of {cost}", scene.name);
        assert!((found_nodes / nodes - 1.0).abs() < 0.01, "{}: {found_nodes} instead of {nodes}", scene.name);
    }
}

/// The limit of the source of 2010 is accepted; what a stack must hold is the depth of the tree.
#[test]
fn the_greatest_depth_is_an_option() {
    let scene = scenes::powers_of_ten();
    for build_options in ["binned,bins=2", "sweep", "spatial,alpha=0"] {
        let selection = |limit: u32| format!("bvh:build={build_options},max_leaf=1,max_depth={limit}");
        let depths = [9, 12, 60, 440].map(|limit| {
            let bvh = build(&selection(limit), &scene, 2);
            bvh.validate(&scene).unwrap();
            let depth = bvh.properties(&scene).depth.unwrap();
            assert!(depth <= limit, "{build_options}: {depth} levels, not {limit}");
            assert_eq!(bvh.stack_depth(), depth);
            depth
        });
        assert!(depths.is_sorted() && depths[1] < depths[2], "the scene is no challenge: {depths:?}");
        let refusal = Selection::parse(&selection(8)).unwrap().build(&scene, 1).unwrap_err();
        assert!(refusal.to_string().contains("480 triangles may take 9 levels, more than 8"), "{refusal}");
    }
}

/// Counted pixels of some frames of the camera path that fits.
pub fn counted(selection: &str, scene: &Scene, size: Size, frames: usize) -> Vec<CountedPixel> {
    let selection = Selection::parse(selection).unwrap();
    let built = selection.build(scene, 0).unwrap();
    let cpu = CpuBackend::new(0).unwrap();
    let mut prepared = cpu.prepare(scene, &*built.structure, selection.method()).unwrap();
    let mut pixels = Vec::new();
    for view in CameraPath::for_scene(scene, false).views(scene, Some(frames)).unwrap() {
        prepared.counted(Config::P, &view, size, &mut |_, band| pixels.extend_from_slice(band)).unwrap();
    }
    pixels
}

/// Steps of primary rays.
pub fn steps(pixels: &[CountedPixel]) -> f64 {
    pixels.iter().map(|pixel| f64::from(pixel.counters[0].steps())).sum()
}

/// Every node that the infinite ray meets is visited: about twice as many around objects, with the same hits.
#[test]
fn without_culling_there_are_about_twice_as_many_steps() {
    let size = Size { width: 160, height: 88 };
    let scan = scene::load("scan:triangles=31600").unwrap();
    for scene in [Some(scan), model("bunny"), model("dragon")].into_iter().flatten() {
        let [culled, unculled] =
            ["", ",cull=off"].map(|cull| counted(&format!("bvh-stack:build=sweep,max_leaf=3{cull}"), &scene, size, 4));
        for (a, b) in culled.iter().zip(&unculled) {
            assert_eq!((a.pixel, a.t), (b.pixel, b.t), "{}", scene.name);
            assert!(a.counters[0].steps() <= b.counters[0].steps(), "{}", scene.name);
        }
        let ratio = steps(&unculled) / steps(&culled);
        assert!((1.9..=2.6).contains(&ratio), "{}: {ratio}", scene.name);
    }
}

/// Cards one behind the other: with culling a ray ends at the first one, without it is stopped by nothing but its
/// limit.
#[test]
fn without_culling_a_ray_visits_what_lies_behind_its_hit() {
    let card = |z: i32| {
        let z = z as f32;
        [[-1.0, -1.0], [1.0, -1.0], [0.0, 2.0]].map(|[x, y]| Vec3::new(x, y, z))
    };
    let scene = scenes::soup("cards", (0..64).map(card));
    let ray = [GivenRay { origin: Vec3::new(0.0, 0.0, -1.0), direction: Vec3::Z }];
    let cpu = CpuBackend::new(1).unwrap();
    for structure in ["bvh-stack", "ploc-stack"] {
        let leaves = |options: &str| {
            let text = format!("{structure}{options}");
            assert_eq!(trace(&cpu, &scene, &text, &ray, false)[0].triangle, 0);
            // A picture of one pixel that looks along the ray
            let selection = Selection::parse(&text).unwrap();
            let built = selection.build(&scene, 1).unwrap();
            let mut prepared = cpu.prepare(&scene, &*built.structure, selection.method()).unwrap();
            let view = crate::support::view_along(&ray[0]);
            let mut leaves = 0;
            let size = Size { width: 1, height: 1 };
            prepared.counted(Config::P, &view, size, &mut |_, band| leaves = band[0].counters[0].leaves).unwrap();
            (leaves, built.structure.properties(&scene).leaves.unwrap())
        };
        assert_eq!(leaves("").0, 1, "{structure}");
        let (visited, all) = leaves(":cull=off");
        assert_eq!(visited, all, "{structure}");
    }
}
