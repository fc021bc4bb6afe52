//! Spatial splits: what they gain, and that they lose nothing.

use super::sweep::{counted, sah, steps};
use super::thesis::model;
use super::{build, build_as, bytes, scenes};
use crate::meshes::{Aim, aimed};
use crate::traversal::trace;
use rtbench::math::Hit;
use rtbench::scene::{self, Scene};
use rtbench::workloads::trace::backend::{Backend, GivenRay, Size};
use rtbench::workloads::trace::bvh::Bvh;
use rtbench::workloads::trace::{CpuBackend, Selection, Structure};

const SWEEP: &str = "build=sweep,max_leaf=3";
const SPATIAL: &str = "build=spatial,max_leaf=3";

fn room() -> Scene {
    scene::load("room:triangles=80000").unwrap()
}

/// References per triangle, and the cost as a share of the sweep's.
fn gain(scene: &Scene) -> (f64, f64) {
    let spatial = build(&format!("bvh:{SPATIAL}"), scene, 0).properties(scene);
    let share = spatial.sah_cost.unwrap() / sah(&format!("bvh:{SWEEP}"), scene);
    (spatial.references_per_triangle.unwrap(), share)
}

#[test]
fn it_gains_where_triangles_are_large() {
    for (scene, most) in [(Some(room()), 0.78), (model("sponza"), 0.88)] {
        let Some(scene) = scene else { continue };
        let (references, share) = gain(&scene);
        assert!(share <= most, "{}: {share} of the sweep's cost", scene.name);
        assert!((1.05..=1.30).contains(&references), "{}: {references} references a triangle", scene.name);
    }
}

#[test]
fn it_changes_hardly_anything_where_they_are_small() {
    for scene in [scene::load("scan:triangles=32000").ok(), model("bunny")].into_iter().flatten() {
        let (references, share) = gain(&scene);
        assert!(references <= 1.01, "{}: {references} references a triangle", scene.name);
        assert!((share - 1.0).abs() <= 0.005, "{}: {share} of the sweep's cost", scene.name);
    }
}

/// No overlap is more than the root's surface.
#[test]
fn with_alpha_above_one_it_is_the_sweep() {
    let room = scene::load("room:triangles=20000").unwrap();
    for scene in scenes::ordinary().into_iter().chain(scenes::degenerate()).chain([room]) {
        let [spatial, sweep] =
            ["build=spatial,alpha=1.01,max_leaf=3", SWEEP].map(|o| bytes(&build(&format!("bvh:{o}"), &scene, 2)));
        assert!(spatial == sweep, "{}", scene.name);
    }
}

/// As in the pseudo-code of the source of 2010, where the test is the other way round.
#[test]
fn where_little_overlaps_it_gains_nothing() {
    let room = room();
    let share = sah("bvh:build=spatial,max_leaf=3,overlap=below", &room) / sah(&format!("bvh:{SWEEP}"), &room);
    assert!((0.99..=1.0001).contains(&share), "{share}");
}

#[test]
fn no_split_below_the_depth_and_none_in_small_nodes() {
    let scene = scenes::beams(400, 9);
    let references = |options: &str| build(&format!("bvh:build=spatial,{options}"), &scene, 1).triangle_refs().len();
    assert_eq!(references("alpha=0,spatial_depth=0"), 400);
    let by_depth = [1, 2, 4, 8].map(|depth| references(&format!("alpha=0,spatial_depth={depth}")));
    assert!(by_depth.is_sorted() && by_depth[0] > 400, "{by_depth:?}");
    let twelve = scenes::beams(12, 9);
    let built =
        |options: &str| build(&format!("bvh:build=spatial,alpha=0,{options}"), &twelve, 1).triangle_refs().len();
    assert_eq!(built("max_leaf=3"), 12);
    assert!(built("max_leaf=1") > 12);
}

/// Rays at edges and corners from points in and around a scene.
fn at_edges(scene: &Scene, count: usize, seed: u32) -> Vec<GivenRay> {
    let (center, diagonal) = (scene.bounds().center(), scene.bounds().diagonal());
    let part = |aim, distance, seed| aimed(scene, aim, (center, distance * diagonal), count / 4, seed);
    let mut rays = part(Aim::Vertex, 0.1, seed);
    rays.extend(part(Aim::Edge, 0.1, seed + 1));
    rays.extend(part(Aim::Edge, 0.7, seed + 2));
    rays.extend(part(Aim::Vertex, 0.7, seed + 3));
    rays
}

fn differing(a: &[Hit], b: &[Hit]) -> usize {
    let same = |(a, b): &(&Hit, &Hit)| a.triangle == b.triangle && a.t.to_bits() == b.t.to_bits();
    a.iter().zip(b).filter(|pair| !same(pair)).count()
}

/// 300,000 rays in sponza and the room.
#[test]
fn no_hit_is_lost_at_edges_and_corners() {
    let cpu = CpuBackend::new(0).unwrap();
    for scene in [Some(room()), model("sponza")].into_iter().flatten() {
        let rays = at_edges(&scene, 150_000, 5);
        let [spatial, sweep] = [SPATIAL, SWEEP].map(|o| trace(&cpu, &scene, &format!("bvh-stack:{o}"), &rays, false));
        assert_eq!(differing(&spatial, &sweep), 0, "{}", scene.name);
        let hit = sweep.iter().filter(|hit| hit.triangle != rtbench::math::MISS).count();
        assert!(hit > rays.len() / 2, "{}: only {hit} rays hit anything", scene.name);
        let some: Vec<usize> = (0..rays.len()).step_by(rays.len() / 1_000).collect();
        let chosen: Vec<GivenRay> = some.iter().map(|&i| rays[i]).collect();
        let expected: Vec<Hit> = some.iter().map(|&i| spatial[i]).collect();
        assert_eq!(differing(&trace(&cpu, &scene, "brute", &chosen, false), &expected), 0, "{}", scene.name);
    }
}

/// The comparison above can fail: boxes without their margin, and a little less, lose hits.
#[test]
fn boxes_that_are_too_small_lose_hits() {
    let room = room();
    let rays = at_edges(&room, 40_000, 9);
    let cpu = CpuBackend::new(0).unwrap();
    let selection = Selection::parse(&format!("bvh-stack:{SPATIAL}")).unwrap();
    let good: Bvh = build_as(&format!("bvh:{SPATIAL}"), &room);
    let found = |bvh: &Bvh| cpu.prepare(&room, bvh, selection.method()).unwrap().trace(&rays, false).unwrap();
    let expected = found(&good);
    let mut small = good.clone();
    let by = 1e-5 * room.bounds().extent().max_element();
    for node in &mut small.nodes[2..] {
        for axis in 0..3 {
            let (min, max) = (node.min[axis], node.max[axis]);
            (node.min[axis], node.max[axis]) = if max - min > 4.0 * by { (min + by, max - by) } else { (min, max) };
        }
    }
    assert!(differing(&found(&small), &expected) > 10);
    assert!(small.validate(&room).is_err());
}

/// A clipped box is not what the triangle test is tight with from afar, where coordinates are rounded to more than the
/// margin.
#[test]
fn no_hit_is_lost_from_afar() {
    let cpu = CpuBackend::new(0).unwrap();
    let scene = scenes::beams(3_000, 9);
    assert!(build("bvh:build=spatial,alpha=0,max_leaf=2", &scene, 1).triangle_refs().len() > 5_000);
    for distance in [1e2, 1e4, 1e6] {
        let mut rays = aimed(&scene, Aim::Edge, (scene.bounds().center(), distance), 20_000, 3);
        rays.extend(aimed(&scene, Aim::Vertex, (scene.bounds().center(), distance), 20_000, 4));
        let expected = trace(&cpu, &scene, "bvh-stack", &rays, false);
        for structure in
            ["bvh-stack:build=spatial,alpha=0,max_leaf=2", "bvh:build=spatial,alpha=0", "ploc-stack:preset=slow"]
        {
            let found = trace(&cpu, &scene, structure, &rays, false);
            assert_eq!(differing(&expected, &found), 0, "{structure} from {distance}");
        }
    }
}

#[test]
fn inside_a_room_it_takes_at_most_three_quarters_of_the_steps() {
    let room = room();
    let size = Size { width: 96, height: 54 };
    let [spatial, sweep] = [SPATIAL, SWEEP].map(|o| counted(&format!("bvh-stack:{o}"), &room, size, 6));
    assert!(spatial.iter().zip(&sweep).all(|(a, b)| (a.pixel, a.t) == (b.pixel, b.t)));
    let share = steps(&spatial) / steps(&sweep);
    assert!(share <= 0.75, "{share}");
}

/// The paper's property: both sides of the plane are apart until whole references are put on one side.
#[test]
fn sides_of_a_spatial_split_have_no_volume_in_common() {
    let scene = scene::load("room:triangles=20000").unwrap();
    let properties = |selection: &str| build(selection, &scene, 2).properties(&scene);
    let spatial = properties("bvh:build=spatial,max_leaf=3");
    assert!(spatial.spatial_splits.unwrap() > 100, "{:?}", spatial.spatial_splits);
    assert_eq!(spatial.spatial_overlap, Some(0.0));
    // None is tried where alpha is beyond the whole surface
    assert_eq!(properties("bvh:build=spatial,max_leaf=3,alpha=2").spatial_splits, Some(0));
    assert_eq!(properties("bvh:build=sweep,max_leaf=3").spatial_splits, None);
}
