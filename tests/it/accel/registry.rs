//! `--structure`: what it accepts, and what it says to the rest.

use super::{SELECTIONS, scenes};
use rtbench::Error;
use rtbench::workloads::trace::method::{Group, KdSearch, Vote};
use rtbench::workloads::trace::{Selection, Traversal, variants};

fn selection(text: &str) -> Selection {
    Selection::parse(text).unwrap()
}

#[test]
fn names_and_traversals() {
    let names: Vec<&str> = variants().iter().map(|v| v.name).collect();
    assert_eq!(names, ["grid", "kdtree", "bvh", "bvh-stack", "ploc-stack", "grid-coop", "grid-packet", "brute"]);
    let traversal = |text| selection(text).method().traversal;
    assert_eq!(traversal("bvh"), Traversal::Bvh(Vote::Corrected));
    assert_eq!(traversal("bvh:vote=original"), Traversal::Bvh(Vote::Original));
    assert_eq!(traversal("bvh-stack"), Traversal::BvhStack);
    assert_eq!(traversal("ploc-stack"), Traversal::BvhStack);
    assert_eq!(traversal("kdtree"), Traversal::KdTree(KdSearch::THESIS));
    let search = |stack, pushdown| Traversal::KdTree(KdSearch { stack, pushdown, private: false });
    assert_eq!(traversal("kdtree:search=restart"), search(0, false));
    assert_eq!(traversal("kdtree:search=pushdown"), search(0, true));
    assert_eq!(traversal("kdtree:stack=32"), search(32, true));
    assert_eq!(selection("bvh:packet=8x4").method().group, Group { width: 8, height: 4 });
    assert_eq!(selection("grid").method(), Traversal::Grid.into());
}

#[test]
fn every_default_in_the_table_is_accepted_and_canonical() {
    for variant in variants() {
        assert!(!variant.summary.is_empty());
        for option in variant.options() {
            let given = selection(&format!("{}:{}={}", variant.name, option.key, option.default));
            assert_eq!(given, selection(variant.name), "{}: {}", variant.name, option.key);
        }
    }
}

#[test]
fn variants_are_canonical() {
    assert_eq!(selection("bvh").variant(), "default");
    assert_eq!(selection("bvh:").variant(), "default");
    assert_eq!(selection("bvh:bins=16").variant(), "default");
    assert_eq!(selection("bvh:max_leaf=08,bins=8").variant(), "bins=8,max_leaf=8");
    assert_eq!(selection("grid:factor=4.0").variant(), "default");
    assert_eq!(selection("grid:factor=2.50,x=auto,z=7").variant(), "z=7,factor=2.5");
    for text in SELECTIONS {
        let one = selection(text);
        let again = format!("{}:{}", one.name(), one.variant()).replace(":default", "");
        assert_eq!(one, selection(&again));
    }
}

#[test]
fn equal_trees_are_shared() {
    assert_eq!(selection("bvh:bins=8").build_key(), selection("bvh-stack:bins=8").build_key());
    assert_eq!(selection("kdtree").build_key(), selection("kdtree:search=restart,tiles=3").build_key());
    assert_eq!(selection("grid:x=9").build_key(), selection("grid-coop:x=9").build_key());
    let mut keys: Vec<String> = SELECTIONS.map(|s| selection(s).build_key()).to_vec();
    keys.sort();
    keys.dedup();
    assert_eq!(keys.len(), SELECTIONS.len(), "different structures have different keys");
}

#[test]
fn what_it_does_not_know_it_names_with_what_there_is() {
    let cases = [
        ("octree", "no structure 'octree'", "grid, kdtree, bvh, bvh-stack, ploc-stack, grid-coop, grid-packet, brute"),
        ("", "no structure ''", "grid"),
        ("bvh:depth=3", "no option 'depth'", "bins, max_leaf"),
        ("brute:x=1", "no option 'x'", "group, shadows, tiles"),
        ("kdtree:stack=33", "'33'", "from 1 to 32"),
        ("bvh:packet=16x16", "'16x16'", "8x8, 8x4"),
        ("grid:shadows=no", "'no'", "from-light, to-light"),
        ("bvh:bins=0", "'0' is no value for bins", "from 2 to 32"),
        ("bvh:bins", "'' is no value for bins", "from 2 to 32"),
        ("bvh:max_leaf=16", "'16'", "from 1 to 15"),
        ("bvh:bins=99999999999999999999", "is no value", "from 2 to 32"),
        ("grid:x=-1", "'-1'", "'auto' or a whole number from 1"),
        ("grid:factor=NaN", "'NaN'", "a number from"),
        ("kdtree:ki=0", "'0'", "a number from"),
        ("kdtree:max_depth=61", "'61'", "0 to 60"),
        ("ploc-stack:preset=best", "'best'", "fastest, very-fast, fast, medium, slow, very-slow"),
    ];
    for (text, problem, hint) in cases {
        let error = Selection::parse(text).expect_err(text);
        assert!(matches!(error, Error::Input(_)) && error.exit_code() == 2);
        let line = error.to_string();
        assert!(!line.contains('\n'), "{line}");
        for words in [problem, hint, "--structure"] {
            assert!(line.contains(words), "'{line}' does not say '{words}'");
        }
    }
}

#[test]
fn a_build_says_how_many_threads_it_had() {
    let scene = scenes::random("small", 100, 1.0, 0.1, 1);
    assert_eq!(selection("bvh").build(&scene, 3).unwrap().build_threads, 3);
    assert_eq!(selection("grid").build(&scene, 3).unwrap().build_threads, 1, "the grid's builder is serial");
    assert!(selection("bvh").build(&scene, 0).unwrap().build_threads >= 1);
    assert!(selection("bvh").build(&scene, 1_000_000_000).unwrap_err().to_string().contains("threads"));
}

#[test]
fn a_grid_that_takes_too_much_is_refused() {
    let scene = scenes::random("small", 100, 1.0, 0.1, 1);
    let cells = selection("grid:x=100000").build(&scene, 1).unwrap_err().to_string();
    assert!(cells.contains("cells, more than") && cells.contains("set fewer"), "{cells}");
    let heap = scenes::soup("heap", [[glam::Vec3::ZERO, glam::Vec3::ONE, glam::Vec3::X]; 3000]);
    let triangle_refs = selection("grid:x=100").build(&heap, 1).unwrap_err().to_string();
    assert!(triangle_refs.contains("triangle references, more than"), "{triangle_refs}");
    // The rule's own grid gives way instead.
    let built = selection("grid").build(&heap, 1).unwrap().structure;
    assert!(built.triangle_refs().len() <= 256 * 3000);
}

#[test]
fn a_grid_set_by_hand_is_as_set() {
    let scene = scenes::random("small", 100, 1.0, 0.1, 1);
    let cells = |text: &str| {
        let p = selection(text).build(&scene, 1).unwrap().structure.properties(&scene);
        [p.cells_x, p.cells_y, p.cells_z].map(Option::unwrap)
    };
    assert_eq!(cells("grid:x=9,y=8,z=7"), [9, 8, 7]);
    let [x, y, z] = cells("grid:y=20");
    assert!(y == 20 && (18..=22).contains(&x) && (18..=22).contains(&z), "{x} {y} {z}");
    assert!(cells("grid:factor=8") > cells("grid"));
}
