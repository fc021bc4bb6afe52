//! `--structure`: what it accepts, and what it says to the rest.

use super::{SELECTIONS, scenes};
use rtbench::Error;
use rtbench::workloads::trace::method::Group;
use rtbench::workloads::trace::{Parameters, Selection, algorithms, bih, bvh, grid, kdtree};

fn selection(text: &str) -> Selection {
    Selection::parse(text).unwrap()
}

#[test]
fn names_and_traversals() {
    let names: Vec<&str> = algorithms().iter().map(|v| v.name).collect();
    let order = ["grid", "kdtree", "bvh", "bvh-stack", "ploc-stack", "bih", "grid-coop", "grid-packet", "brute"];
    let known: Vec<&str> = names.iter().copied().filter(|name| order.contains(name)).collect();
    assert_eq!(known, order);
    let aliases = algorithms().iter().map(|a| a.alias).filter(|alias| !alias.is_empty());
    let all: Vec<&str> = names.iter().copied().chain(aliases).collect();
    assert!(all.iter().all(|name| all.iter().filter(|other| other == &name).count() == 1), "{all:?}");
    let method = |text| selection(text).method();
    assert_eq!(method("bvh").traversal, &bvh::packet::SHARED_STACK);
    assert!(!method("bvh").parameters.flag("ORIGINAL_VOTE"));
    assert!(method("bvh:vote=original").parameters.flag("ORIGINAL_VOTE"));
    assert_eq!(method("bvh-stack").traversal, &bvh::stack::STACK);
    assert_eq!(method("ploc-stack").traversal, &bvh::stack::STACK);
    assert_eq!(method("kdtree").traversal, &kdtree::search::SEARCH);
    assert_eq!(method("kdtree:search=stack").traversal, &kdtree::stack::STACK);
    assert_eq!(method("kdtree:search=ropes").traversal, &kdtree::ropes::ROPES);
    let search = |text| {
        let parameters = method(text).parameters;
        (parameters.word("SHORT_STACK"), parameters.flag("PUSHDOWN"), parameters.flag("PRIVATE_STACK"))
    };
    assert_eq!(search("kdtree"), (4, true, false));
    assert_eq!(search("kdtree:search=restart"), (0, false, false));
    assert_eq!(search("kdtree:search=pushdown"), (0, true, false));
    assert_eq!(search("kdtree:stack=32"), (32, true, false));
    assert_eq!(search("kdtree:memory=private"), (4, true, true));
    assert_eq!(method("bvh:packet=8x4").group, Group { width: 8, height: 4 });
    assert_eq!(method("bih").traversal, &bih::stack::STACK);
    let flags = |text| ["CULL", "WIDENED"].map(|name| method(text).parameters.flag(name));
    assert_eq!(flags("bvh-stack"), [true, false]);
    assert_eq!(flags("bvh-stack:build=sweep,cull=off"), [false, false]);
    assert_eq!(flags("bvh-stack:build=spatial"), [true, true]);
    assert_eq!([flags("ploc-stack"), flags("ploc-stack:preset=slow")], [[true, false], [true, true]]);
    assert_eq!([flags("bvh-stack:build=ploc"), flags("bvh8:build=ploc,preset=slow")], [[true, false], [true, true]]);
    let kernel = |text| method(text).traversal.kernel;
    assert_eq!(kernel("bvh4"), "trace/wide/stack.wgsl");
    assert_eq!(kernel("bvh8:order=octant"), "trace/wide/octants.wgsl");
    assert_eq!(kernel("bvh8:stack=short"), "trace/wide/short_stack.wgsl");
    assert_eq!(["bvh4", "bvh8"].map(|text| method(text).parameters.word("WIDTH")), [4, 8]);
    assert_eq!(method("bvh-stack").parameters, bvh::stack::defaults());
    assert_eq!(method("grid"), method("bvh-stack").by(&grid::dda::DDA, Parameters::NONE));
    assert_eq!(method("grid").group, Group::SQUARE);
}

#[test]
fn every_default_in_the_table_is_accepted_and_canonical() {
    for variant in algorithms() {
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
    assert_eq!(selection("bvh-stack:cull=off,max_leaf=3,build=sweep").variant(), "build=sweep,max_leaf=3,cull=off");
    let every_node = selection("bvh-stack:sorting=every-node,build=sweep,max_leaf=3,alpha=1e-5");
    assert_eq!(every_node.variant(), "build=sweep,max_leaf=3,sorting=every-node");
    assert_eq!(selection("grid:factor=4.0").variant(), "default");
    assert_eq!(selection("grid:factor=2.50,x=auto").variant(), "factor=2.5");
    assert_eq!(selection("grid:z=07,y=9,factor=4").variant(), "y=9,z=7");
    for text in SELECTIONS {
        let one = selection(text);
        let again = format!("{}:{}", one.name(), one.variant()).replace(":default", "");
        assert_eq!(one, selection(&again));
    }
}

/// Names that presets and tables of the source `rt2` have.
#[test]
fn variants_of_kd_trees_name_build_options_first() {
    for variant in [
        "build=sort,search=stack",
        "build=sort,search=ropes",
        "build=sort,push=off,search=ropes",
        "build=min-max,search=stack",
        "build=sort,sorting=every-node,search=stack",
    ] {
        let reversed = variant.rsplit(',').collect::<Vec<_>>().join(",");
        assert_eq!(selection(&format!("kdtree:{reversed}")).variant(), variant);
    }
}

/// The four axes apart; the variant lists all in the table's order.
#[test]
fn options_are_four_axes() {
    let s = selection("kdtree:fetch=buffers,kt=2,tiles=3,shadows=to-light,stack=8,bins=16,group=4x4");
    assert_eq!(s.build_options(), "bins=16,kt=2");
    assert_eq!(s.traversal_options(), "stack=8");
    assert_eq!(s.ray_options(), "shadows=to-light");
    assert_eq!(s.device_options(), "group=4x4,tiles=3,fetch=buffers");
    assert_eq!(s.variant(), "bins=16,kt=2,stack=8,group=4x4,shadows=to-light,tiles=3,fetch=buffers");
    assert_eq!(selection("bvh:packet=4x4").traversal_options(), "packet=4x4");
    let plain = selection("brute");
    let axes = [plain.build_options(), plain.traversal_options(), plain.ray_options(), plain.device_options()];
    assert!(axes.iter().all(String::is_empty));
}

#[test]
fn all_is_every_algorithm_but_brute_force() {
    let names = |text| Selection::parse_all(text).unwrap().iter().map(|s| s.name()).collect::<Vec<_>>();
    let expected: Vec<&str> = algorithms().iter().map(|a| a.name).filter(|name| *name != "brute").collect();
    assert_eq!(names("all"), expected);
    assert_eq!(expected.len() + 1, algorithms().len());
    assert_eq!(names("kdtree:stack=8"), ["kdtree"]);
    assert!(Selection::parse_all("all:tiles=2").is_err());
}

#[test]
fn an_option_without_effect_is_refused() {
    for (text, why) in [
        ("kdtree:search=restart,stack=8", "stack has no effect: search="),
        ("kdtree:memory=private,search=pushdown", "memory has no effect: search="),
        ("kdtree:search=stack,stack=8", "stack has no effect: search="),
        ("kdtree:search=ropes,memory=private", "memory has no effect: search="),
        ("kdtree:push=off", "push has no effect: search=short-stack"),
        ("kdtree:push=off,search=stack", "push has no effect: search=stack"),
        ("kdtree:sorting=every-node", "sorting has no effect: build=hybrid"),
        ("kdtree:build=min-max,sorting=every-node", "sorting has no effect: build=min-max"),
        ("kdtree:build=sort,bins=8", "bins has no effect: build=sort"),
        ("kdtree:build=sort,spread=cell", "spread has no effect: build=sort"),
        ("kdtree:build=sort,exact_below=8", "exact_below has no effect: build=sort"),
        ("kdtree:build=min-max,exact_below=8", "exact_below has no effect: build=min-max"),
        ("kdtree:build=sort,small_leaf=8", "small_leaf has no effect: build=sort"),
        ("kdtree:build=min-max,max_depth=8", "max_depth has no effect: build=min-max"),
        ("grid:factor=2.5,z=7", "factor has no effect: z"),
        ("bvh:kt=inf,ki=3", "ki has no effect: costs"),
        ("bvh:build=sweep,bins=8", "bins has no effect: build=sweep"),
        ("bvh:bins=8,build=spatial", "those of spatial splits are spatial_bins"),
        ("bvh:sorting=every-node", "sorting has no effect: build=binned"),
        ("bvh-stack:build=spatial,sorting=every-node", "sorting has no effect: build=spatial"),
        ("bvh:axes=longest", "axes has no effect: build=binned"),
        ("bvh:build=sweep,alpha=0.5", "alpha has no effect: build=sweep"),
        ("bvh:spatial_bins=8", "spatial_bins has no effect: build=binned"),
        ("bvh:spatial_depth=8", "spatial_depth has no effect: build=binned"),
        ("bvh:build=sweep,overlap=below", "overlap has no effect: build=sweep"),
        ("bvh:build=ploc,max_leaf=2", "max_leaf has no effect: build=ploc"),
        ("bvh-stack:build=ploc,max_depth=20", "max_depth has no effect: build=ploc"),
        ("bvh8:build=ploc,kt=1", "kt has no effect: build=ploc"),
        ("bvh:build=ploc,axes=longest", "axes has no effect: build=ploc"),
        ("bvh:preset=slow", "preset has no effect: build=binned"),
        ("bvh4:entries=3", "entries has no effect: stack=full"),
        ("bvh8:order=octant,stack=short", "stack has no effect: order=octant"),
        ("bvh8:order=octant,cull=off", "cull has no effect: order=octant"),
        ("bvh8:stack=short,cull=off", "cull has no effect: stack=short"),
        ("cwbvh:build=binned,preset=slow", "preset has no effect: build=binned"),
        ("cwbvh:max_leaf=2", "max_leaf has no effect: build=ploc"),
    ] {
        let error = Selection::parse(text).expect_err(text);
        assert!(matches!(error, Error::Input(_)) && error.exit_code() == 2);
        let line = error.to_string();
        assert!(line.contains(why) && line.contains("leave"), "{line}");
    }
    assert_eq!(
        selection("kdtree:search=restart,stack=4"),
        selection("kdtree:search=restart"),
        "a default asks nothing"
    );
}

#[test]
fn equal_trees_are_shared() {
    assert_eq!(selection("bvh:bins=8").build_key(), selection("bvh-stack:bins=8").build_key());
    assert_eq!(selection("kdtree").build_key(), selection("kdtree:search=restart,tiles=3").build_key());
    assert_eq!(selection("kdtree").build_key(), selection("kdtree:search=stack").build_key());
    assert_ne!(selection("kdtree").build_key(), selection("kdtree:search=ropes").build_key());
    assert_eq!(selection("grid:x=9").build_key(), selection("grid-coop:x=9").build_key());
    assert_eq!(selection("bvh8").build_key(), selection("bvh8:stack=short").build_key());
    assert_ne!(selection("bvh8").build_key(), selection("bvh8:order=octant").build_key());
    let mut keys: Vec<String> = SELECTIONS.map(|s| selection(s).build_key()).to_vec();
    keys.sort();
    keys.dedup();
    assert_eq!(keys.len(), SELECTIONS.len(), "different structures have different keys");
}

#[test]
fn what_it_does_not_know_it_names_with_what_there_is() {
    let cases = [
        (
            "octree",
            "no structure 'octree'",
            "grid, kdtree, bvh, bvh-stack, ploc-stack, bvh-quantised, bvh4, bvh8, cwbvh, bvh-subgroup, bvh-stackless, bih, \
             grid-coop, grid-packet, query, brute",
        ),
        ("", "no structure ''", "grid"),
        ("bvh:depth=3", "no option 'depth'", "bins, max_leaf"),
        ("brute:x=1", "no option 'x'", "group, shadows, tiles"),
        ("kdtree:stack=33", "'33'", "from 1 to 32"),
        ("bvh:packet=16x16", "'16x16'", "8x8, 8x4"),
        ("grid:shadows=no", "'no'", "from-light, to-light"),
        ("bvh:bins=0", "'0' is no value for bins", "from 2 to 32"),
        ("bvh:bins", "'' is no value for bins", "from 2 to 32"),
        ("bvh:max_leaf=16", "'16'", "from 1 to 15"),
        ("bvh:build=sah", "'sah' is no value for build", "binned, sweep, spatial"),
        ("bvh:max_depth=441", "'441'", "from 1 to 440"),
        ("bvh-stack:cull=no", "'no'", "on, off"),
        ("bvh:cull=off", "no option 'cull'", "vote"),
        ("bih:max_leaf=0", "'0'", "from 1 to 15"),
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
