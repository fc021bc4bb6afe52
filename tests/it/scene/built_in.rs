//! Tests of built-in scenes: they are valid and deterministic, and have the requested size and the described
//! properties.

use rtbench::scene::{self, Scene, list};
use std::collections::HashMap;

fn load(spec: &str) -> Scene {
    scene::load(spec).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn all_are_listed_with_range_and_default() {
    let names: Vec<&str> = list().iter().map(|info| info.name).collect();
    assert_eq!(names, ["scan", "terrain", "sphereflake", "stadium", "hall", "room", "sphere", "box", "plane"]);
    for info in list() {
        assert!(!info.character.is_empty());
        for p in info.parameters {
            assert!(p.min <= p.default && p.default <= p.max, "{}: {p:?}", info.name);
        }
    }
}

#[test]
fn all_are_valid_and_deterministic() {
    for info in list() {
        let scene = load(info.name);
        scene.check().unwrap();
        assert_eq!(scene.name, info.name);
        assert_eq!(scene.degenerate_triangles, 0, "{}", info.name);
        assert!(!scene.lights.is_empty(), "{}", info.name);
        assert!(scene.vertices.iter().all(|v| v.normal.is_normalized()), "{}", info.name);
        assert_eq!(scene.content_hash(), load(info.name).content_hash(), "{}", info.name);
    }
}

#[test]
fn the_number_of_triangles_is_as_requested() {
    let mut off = Vec::new();
    for info in list() {
        let p = info.parameters[0];
        assert_eq!(p.name, "triangles");
        for wanted in [p.min, p.min * 3, p.default, 300_000] {
            let scene = load(&format!("{}:triangles={wanted}", info.name));
            let ratio = scene.triangles.len() as f64 / wanted as f64;
            if !(0.85..=1.1).contains(&ratio) {
                off.push(format!("{}: {} of {wanted}", scene.name, scene.triangles.len()));
            }
            let name = if wanted == p.default { info.name.into() } else { format!("{}:triangles={wanted}", info.name) };
            assert_eq!(scene.name, name);
        }
    }
    assert!(off.is_empty(), "{off:?}");
}

/// Vertex normals are on the side from which the triangle is counter-clockwise; otherwise the surface faces inwards.
#[test]
fn normals_agree_with_the_winding() {
    for info in list() {
        let scene = load(info.name);
        let opposed = scene.triangles.iter().filter(|t| {
            let [a, b, c] = t.vertices.map(|v| scene.vertices[v as usize]);
            let face = (b.position - a.position).cross(c.position - a.position);
            face.dot(a.normal + b.normal + c.normal) <= 0.0
        });
        let share = opposed.count() as f64 / scene.triangles.len() as f64;
        assert!(share < 1e-3, "{}: {share}", info.name);
    }
}

/// No two triangles have the same corners, which would make the nearest hit ambiguous.
#[test]
fn no_triangle_is_duplicated() {
    for info in list() {
        let scene = load(info.name);
        let mut seen = HashMap::new();
        for (i, t) in scene.triangles.iter().enumerate() {
            let mut corners = t.vertices.map(|v| scene.vertices[v as usize].position.to_array().map(f32::to_bits));
            corners.sort();
            if let Some(other) = seen.insert(corners, i) {
                panic!("{}: triangles {other} and {i} coincide", info.name);
            }
        }
    }
}

#[test]
fn the_scan_is_closed_and_uniform() {
    for spec in ["scan:triangles=5000", "scan", "scan:triangles=250000"] {
        let scene = load(spec);
        let mut edges = HashMap::new();
        for t in &scene.triangles {
            let [a, b, c] = t.vertices;
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *edges.entry((from, to)).or_insert(0) += 1;
            }
        }
        // Every directed edge and its opposite occur equally often: there are no holes and no flipped faces. (A surface
        // net may touch itself at an edge.)
        for (&(from, to), &count) in &edges {
            assert_eq!(edges.get(&(to, from)), Some(&count), "{spec}");
        }
        let mut areas: Vec<f32> = (0..scene.triangles.len() as u32)
            .map(|i| {
                let [a, b, c] = scene.corners(i);
                (b - a).cross(c - a).length()
            })
            .collect();
        areas.sort_by(f32::total_cmp);
        let at = |share: f32| areas[(areas.len() as f32 * share) as usize];
        assert!(at(0.95) / at(0.05) < 12.0, "{spec}: {} {}", at(0.05), at(0.95));
    }
}

#[test]
fn scenes_have_the_described_properties() {
    let hall = load("hall");
    assert!(hall.lights.len() >= 3 && hall.mirror_share() > 0.15, "{}", hall.mirror_share());
    assert_eq!(load("scan").mirror_share(), 0.0);
    assert_eq!(load("scan").lights.len(), 1);

    // Half of the stadium's triangles lie within a metre of the centre; the scene is hundreds of metres wide.
    let stadium = load("stadium");
    let near = (0..stadium.triangles.len() as u32).filter(|&i| stadium.corners(i)[0].length() < 2.0).count();
    assert!(near * 2 > stadium.triangles.len(), "{near} of {}", stadium.triangles.len());
    assert!(stadium.bounds().extent().x > 200.0);

    // At least an eighth of the room's triangles are twenty times longer than wide.
    let room = load("room");
    let thin = (0..room.triangles.len() as u32).filter(|&i| {
        let [a, b, c] = room.corners(i);
        let longest = (b - a).length().max((c - b).length()).max((a - c).length());
        longest * longest > 20.0 * (b - a).cross(c - a).length()
    });
    let thin = thin.count() as f64 / room.triangles.len() as f64;
    assert!(thin > 0.02, "{thin}");

    // The lights of enclosed scenes are inside.
    for scene in [&hall, &room, &load("sphere"), &load("box")] {
        let bounds = scene.bounds();
        for light in &scene.lights {
            assert!(light.position.cmpgt(bounds.min).all() && light.position.cmplt(bounds.max).all());
        }
    }
}

#[test]
fn spikes_are_part_of_the_requested_triangles() {
    let (plain, spiky) = (load("scan:triangles=20000"), load("scan:triangles=20000,spikes=100"));
    assert_eq!(spiky.name, "scan:triangles=20000,spikes=100");
    spiky.check().unwrap();
    let ratio = spiky.triangles.len() as f64 / 20_000.0;
    assert!((0.9..=1.1).contains(&ratio), "{ratio}");
    assert_eq!(load("scan:triangles=20000,spikes=0").content_hash(), plain.content_hash());
    assert!(spiky.content_hash() != plain.content_hash());
    assert_eq!(spiky.content_hash(), load("scan:triangles=20000,spikes=100").content_hash());
    assert_eq!(spiky.degenerate_triangles, 0);
    assert!(spiky.vertices.iter().all(|v| v.normal.is_normalized()));
    // They stand out, by at least half of the shortest on some side
    let (inner, outer) = (plain.bounds(), spiky.bounds());
    assert!((outer.extent() - inner.extent()).max_element() > 0.1, "{inner:?} {outer:?}");
}

#[test]
fn more_spikes_than_triangles_allow_are_refused() {
    let error = scene::load("scan:triangles=1000,spikes=14").unwrap_err();
    assert_eq!(error.exit_code(), 2);
    assert!(error.to_string().contains("at most 13 spikes"), "{error}");
    load("scan:triangles=1000,spikes=13");
    assert!(scene::load("scan:spikes=100001").unwrap_err().to_string().contains("out of range"));
    assert!(scene::load("room:spikes=3").unwrap_err().to_string().contains("no parameter"));
}

/// By the memory model of 2010 a kd-tree takes more than a BVH exactly if 16 L + 4 R > 48 N, with
/// leaves, references and nodes of a BVH a triangle: not on the smooth shape, but on the one with points.
#[test]
fn a_kd_tree_takes_more_than_a_bvh_on_the_spiky_shape_alone() {
    use rtbench::workloads::trace::Selection;
    let properties = |structure: &str, scene: &Scene| {
        Selection::parse(structure).unwrap().build(scene, 0).unwrap().structure.properties(scene)
    };
    let sizes = |name: &str| {
        let scene = load(name);
        let triangles = scene.triangles.len() as f64;
        let kd = properties("kdtree:exact_below=536870912,small_leaf=0,max_depth=60", &scene);
        let bvh = properties("bvh:build=sweep,max_leaf=3", &scene);
        let leaves = f64::from(kd.leaves.unwrap()) / triangles;
        let nodes = f64::from(bvh.nodes.unwrap() - 1) / triangles;
        (leaves, 16.0 * leaves + 4.0 * kd.references_per_triangle.unwrap(), 48.0 * nodes)
    };
    let (smooth, spiky) = (sizes("scan:triangles=104000"), sizes("scan:triangles=104000,spikes=1000"));
    assert!(smooth.1 < smooth.2 && spiky.1 > spiky.2, "{smooth:?} {spiky:?}");
    assert!(spiky.0 > smooth.0, "more leaves a triangle: {smooth:?} {spiky:?}");
}
