//! Which model, structure and run a row belongs to, and which source shows it.

use super::synthetic::{Builder, SIZE, everything, scene};
use rtbench::sources::rows::Variant;
use rtbench::sources::rt2::models::{Model, SceneKey};
use rtbench::sources::rt2::structures::{ALL, BVH, CULLED, ROPES, STACK, UNPUSHED, is_own};
use rtbench::sources::runs::RecordedRun;
use rtbench::sources::{rt2, select, thesis};
use rtbench::workloads::trace::rays::Config;
use std::collections::BTreeSet;
use std::path::Path;

#[test]
fn a_scene_is_a_counterpart_by_name_and_options() {
    let model = |name: &str, triangles| SceneKey::of(name, triangles).model();
    for (name, triangles, expected) in [
        ("scan:triangles=31600", 32_168, Some(Model::Alien)),
        ("scan:triangles=104000", 107_516, Some(Model::Dino)),
        ("scan:triangles=104000,spikes=1000", 108_000, Some(Model::Dino)),
        ("scan:triangles=104000,spikes=24", 108_000, None),
        ("scan:triangles=31600,spikes=1000", 33_000, None),
        ("scan:spikes=1000", 71_000, None),
        ("scan:triangles=837000", 847_216, Some(Model::Dragon)),
        ("dragon", 871_414, Some(Model::Dragon)),
        ("dragon_vrip.ply", 871_414, Some(Model::Dragon)),
        // Others: another size, another tessellation, another pose, another scene.
        ("scan:triangles=32000", 33_588, None),
        ("scan", 70_000, None),
        ("dragon", 100_000, None),
        ("dragon:scale=2", 871_414, None),
        ("room:triangles=31600", 31_000, None),
        ("scan:triangles=104000,spikes=0", 107_516, Some(Model::Dino)),
    ] {
        assert_eq!(model(name, triangles), expected, "{name}");
    }
    let spiky = SceneKey::of("scan:triangles=104000,spikes=24", 108_000);
    assert!(spiky.is_pointed() && !SceneKey::of("scan:triangles=104000,spikes=0", 1).is_pointed());
    assert_eq!((spiky.to_string().as_str(), spiky.short().as_str()), ("scan:spikes=24 (108000)", "spiky scan 108 k"));
    assert_eq!(SceneKey::of("scan:triangles=31600", 32_168).to_string(), "scan (32168)");
    // A path that is not the scene's own makes another row of the same structures.
    let along = |name: &str, path: &str| SceneKey::of(name, 9).along(path, false).to_string();
    assert_eq!((along("room", "room"), along("room", "orbit")), ("room (9)".into(), "room along orbit (9)".into()));
    assert_eq!((along("scan", "orbit"), along("scan", "inside")), ("scan (9)".into(), "scan along inside (9)".into()));
}

#[test]
fn a_structure_is_known_by_the_set_of_its_options() {
    let is = |structure: &rt2::structures::Structure, name: &str, text: &str| structure.is(name, &Variant::parse(text));
    assert!(
        is(&BVH, "bvh-stack", "build=sweep,max_leaf=3,cull=off")
            && is(&BVH, "bvh-stack", "cull=off,max_leaf=3,build=sweep")
    );
    assert!(
        is(&CULLED, "bvh-stack", "build=sweep,max_leaf=3")
            && !is(&CULLED, "bvh-stack", "build=sweep,max_leaf=3,cull=off")
    );
    assert!(!is(&BVH, "bvh-stack", "build=sweep,max_leaf=3") && !is(&BVH, "bvh", "build=sweep,max_leaf=3,cull=off"));
    assert!(
        !is(&ROPES, "kdtree", "build=sort,push=off,search=ropes")
            && is(&UNPUSHED, "kdtree", "build=sort,push=off,search=ropes")
    );
    assert!(!is(&STACK, "kdtree", "build=sort,search=stack,kt=2") && !is(&STACK, "kdtree", "default"));
    // No two are the same.
    for (index, structure) in ALL.iter().enumerate() {
        assert!(!ALL[..index].iter().any(|other| other.selection() == structure.selection()), "{structure:?}");
        let selection = structure.selection();
        let (name, options) = selection.split_once(':').unwrap_or((&selection, ""));
        assert!(is_own(name, &Variant::parse(options)), "{selection}");
    }
    for (name, options) in
        [("kdtree", "default"), ("kdtree", "search=restart"), ("bvh-stack", "build=binned"), ("grid", "x=1")]
    {
        assert!(!is_own(name, &Variant::parse(options)), "{name}:{options}");
    }
}

fn fitting(runs: &[RecordedRun]) -> Vec<&'static str> {
    select(&[], runs).unwrap().iter().map(|source| source.name).collect()
}

#[test]
fn a_run_is_shown_by_the_source_whose_structures_it_has() {
    assert_eq!(fitting(&[everything()]), [rt2::SOURCE.name]);
    let mut b = Builder::new();
    b.row(scene("alien"), "kdtree", Config::P, (64, 64), 1.0);
    b.row(scene("alien"), "bvh-stack", Config::P, (64, 64), 1.0);
    assert_eq!(fitting(std::slice::from_ref(&b.run)), [thesis::SOURCE.name]);
    assert_eq!(fitting(&[b.run.clone(), everything()]), ["thesis", "rt2"]);
    b.shot("alien", &ROPES, 1.0);
    assert_eq!(fitting(&[b.run]), ["thesis", "rt2"]);
    // A structure alone is enough.
    let mut b = Builder::new();
    b.tree("alien", &ROPES, 1.0, 10, 1);
    assert_eq!(fitting(&[b.run]), ["rt2"]);
    // Without runs every source shows what was published.
    assert_eq!(fitting(&[]), ["thesis", "rt2", "spheres", "splat"]);
}

#[test]
fn notes_say_what_is_left_out() {
    let notes = |fill: &dyn Fn(&mut Builder)| {
        let mut b = Builder::new();
        b.shot("alien", &ROPES, 1.0);
        fill(&mut b);
        (rt2::SOURCE.read)(&[b.run]).notes().to_vec()
    };
    assert!(notes(&|_| ()).is_empty());
    let others = notes(&|b| {
        b.row(scene("alien"), &ROPES.selection(), Config::PS, SIZE, 1.0);
    });
    assert!(others.len() == 1 && others[0].contains("shows 1 row with rays other than primary ones"), "{others:?}");
    let unlike = notes(&|b| b.shot("alien", &STACK, 1.0).frames = 9);
    assert!(unlike.iter().any(|note| note.contains("9 frames") && note.contains("left out")), "{unlike:?}");
}

/// Structures that a preset's file names, in any of its parts.
fn structures_of(preset: &str) -> BTreeSet<String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("presets/sweep/{preset}.toml"));
    let table: toml::Table = toml::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let parts = table["part"].as_array().unwrap().iter().filter_map(|part| part.get("structure"));
    let lists = parts.chain([&table["structure"]]).map(|list| list.as_array().unwrap());
    lists.flatten().map(|name| name.as_str().unwrap().to_owned()).collect()
}

#[test]
fn the_presets_measure_every_structure_and_no_other() {
    let known: BTreeSet<String> = ALL.iter().map(|structure| structure.selection()).collect();
    for preset in ["rt2", "rt2-lite"] {
        assert_eq!(structures_of(preset), known, "{preset}");
    }
}
