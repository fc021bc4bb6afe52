//! The static cost of kernels: counts by hand, what changes them and what does not, and that no kernel is left out.

use rtbench::device::vulkan::KernelCost;
use rtbench::device::{Constants, KernelFile, Source, assemble};
use rtbench::workloads::trace::gpu::kernels;
use rtbench::workloads::trace::{Selection, algorithms};
use rtbench::workloads::{self, kernel_costs};
use std::collections::BTreeSet;
use std::process::Command;

/// A kernel of one file.
fn source(text: &str) -> Source {
    let files: &'static [KernelFile] = Vec::leak(vec![("it.wgsl", &*text.to_owned().leak())]);
    assemble(files, "it.wgsl", &[], Constants::default()).unwrap()
}

fn cost(text: &str) -> KernelCost {
    source(text).cost().unwrap_or_else(|error| panic!("{error}\n{text}"))
}

const MAIN: &str = "@compute @workgroup_size(8) fn main(@builtin(global_invocation_id) id: vec3u) {\n";

/// A kernel with a buffer, a second one that nothing may use, and this body.
fn with_body(body: &str) -> KernelCost {
    cost(&format!(
        "@group(0) @binding(0) var<storage, read_write> words: array<u32>;\n\
         @group(0) @binding(1) var<storage, read_write> others: array<atomic<u32>>;\n\
         var<workgroup> shared_words: array<u32, 16>;\n\
         fn twice(x: u32) -> u32 {{ return x + x; }}\n{MAIN}{body}\n}}\n"
    ))
}

#[test]
fn small_kernels_count_as_by_hand() {
    let nothing = KernelCost::default();
    assert_eq!(with_body(""), nothing, "what nothing uses does not count");
    // id.x (twice, as it is written), the two elements' addresses; the operators
    let one = KernelCost { load: 1, store: 1, arithmetic: 1, other: 4, bindings: 1, ..nothing };
    assert_eq!(with_body("words[id.x] = words[id.x] + 1u;"), one);
    // A loop counts once: `loop` and the `if` that ends it, the condition and the increment, three reads of i, one
    // write by the increment; the initial value is a constant outside of loops
    let count = with_body("for (var i = 0u; i < 4u; i++) { words[i] = 1u; }");
    let expected = KernelCost {
        arithmetic: 2,
        store: 1,
        private_load: 3,
        private_store: 1,
        branch: 2,
        other: 1,
        private_bytes: 4,
        bindings: 1,
        ..nothing
    };
    assert_eq!(count, expected);
    // A function counts once however often it is called
    let called = KernelCost { arithmetic: 1, call: 2, store: 2, other: 2, bindings: 1, ..nothing };
    assert_eq!(with_body("words[0] = twice(3u); words[1] = twice(4u);"), called);
    // Atomics, barriers, work-group memory
    let shared = KernelCost { atomic: 3, barrier: 2, store: 1, other: 4, workgroup_bytes: 64, bindings: 1, ..nothing };
    let body = "atomicAdd(&others[0], 1u); atomicStore(&others[1], 2u); let v = atomicLoad(&others[2]);\n\
                workgroupBarrier(); shared_words[3] = v; storageBarrier();";
    assert_eq!(with_body(body), shared);
    let uniform = with_body("words[0] = workgroupUniformLoad(&shared_words[1]);");
    assert_eq!((uniform.load, uniform.barrier, uniform.store), (1, 2, 1));
    // Structured control flow
    let flow = with_body(
        "switch id.x { case 0u: { words[0] = 1u; } default: {} }\n\
         if id.x > 3u { words[1] = 2u; } else { words[2] = 2u; }",
    );
    assert_eq!((flow.branch, flow.store, flow.arithmetic), (2, 3, 1));
    // Private memory: both variables of the entry point
    let private = with_body("var a: array<u32, 8>; var b: vec4f; a[id.x] = 1u; b.x = 2.0; words[0] = a[1];");
    assert_eq!((private.private_bytes, private.private_store, private.private_load), (48, 2, 1));
}

#[test]
fn branches_that_a_constant_decides_do_not_count() {
    let with = |flag: bool| {
        cost(&format!(
            "const FLAG = {flag};\n@group(0) @binding(0) var<storage, read_write> words: array<u32>;\n\
             fn slow(x: u32) -> u32 {{ var all: array<u32, 64>; all[x] = x * x; return all[0]; }}\n\
             {MAIN} if FLAG {{ words[0] = slow(id.x); }} else {{ words[1] = 1u; }}\n}}\n"
        ))
    };
    let (on, off) = (with(true), with(false));
    assert_eq!((on.branch, off.branch), (0, 0));
    assert_eq!((on.call, on.private_bytes, on.store), (1, 256, 1));
    assert_eq!((off.call, off.private_bytes, off.store), (0, 0, 1));
}

/// Each kernel of the program with a text changed, if it has that text.
fn changed(from: &str, to: &str) -> Vec<(String, KernelCost, KernelCost)> {
    let mut changed = Vec::new();
    for (label, mut source) in workloads::kernels().unwrap() {
        let before = source.cost().unwrap();
        if source.text.contains(from) {
            source.text = source.text.replacen(from, to, 1);
            changed.push((label, before, source.cost().unwrap()));
        }
    }
    assert!(changed.len() >= 8, "only {} kernels have {from:?}", changed.len());
    changed
}

#[test]
fn one_more_read_of_a_buffer_is_one_more_load() {
    let read = "fn read_triangle_ref(i: u32) -> vec4<u32> {";
    let twice = format!("{read}\n    let again = triangle_refs[i];");
    let reads = |(label, ..): &(String, KernelCost, KernelCost)| label != "sweep query trace any hit";
    for (label, before, after) in changed(read, &twice).into_iter().filter(reads) {
        // The other one is the address of the element
        let expected = KernelCost { load: before.load + 1, other: before.other + 1, ..before };
        assert_eq!(after, expected, "{label}");
    }
}

#[test]
fn comments_and_layout_change_no_count() {
    for (label, before, after) in changed("fn main(", "// one load, *two* stores\n/* if x { */ fn   main(") {
        assert_eq!(before, after, "{label}");
    }
}

#[test]
fn no_registered_algorithm_and_no_kernel_file_is_left_out() {
    let kernels = workloads::kernels().unwrap();
    let files: BTreeSet<&str> =
        kernels.values().flat_map(|source| source.lines.iter().map(|(file, _)| *file)).collect();
    for algorithm in algorithms() {
        let kernel = Selection::parse(algorithm.name).unwrap().method().traversal.kernel;
        assert!(files.contains(kernel), "{kernel} of {} is in no kernel of the list", algorithm.name);
    }
    // Files that only options or other devices choose
    let optional = [
        "trace/bvh/if_if.wgsl",
        "trace/bvh/speculative.wgsl",
        "trace/bvh/stackless/trail.wgsl",
        "trace/persistent.wgsl",
        "trace/triangles_leaf_order.wgsl",
        "trace/subgroup/moller_trumbore.wgsl",
        "trace/intersect/moller_trumbore.wgsl",
        "trace/kdtree/rope_nodes.wgsl",
        "trace/kdtree/ropes.wgsl",
        "trace/kdtree/short_stack_private.wgsl",
        "trace/kdtree/short_stack_workgroup.wgsl",
        "trace/staged/append.wgsl",
        "trace/staged/bounce.wgsl",
        "trace/staged/end.wgsl",
        "trace/staged/list.wgsl",
        "trace/staged/primary.wgsl",
        "trace/staged/update_counted.wgsl",
        "trace/staged/update_timed.wgsl",
        "trace/kdtree/stack.wgsl",
        "trace/textures.wgsl",
        "trace/wide/octants.wgsl",
        "trace/wide/short_stack.wgsl",
    ];
    for (file, _) in kernels::FILES {
        assert!(
            files.contains(file) || optional.contains(file),
            "kernels/{file} is in no kernel of `rtbench kernels`: list it in Workload::kernels"
        );
    }
    // Each with every ray configuration, counted and timed, and given rays
    for entry in ["P", "P counting", "PS", "PS counting", "PSR", "PSR counting", "trace", "trace any hit"] {
        assert!(kernels.contains_key(&format!("sweep bvh-stack {entry}")), "{entry}");
    }
}

#[test]
fn costs_are_the_same_each_time_and_tell_kernels_apart() {
    let costs = kernel_costs().unwrap();
    assert_eq!(costs, kernel_costs().unwrap());
    let of = |kernel: &str, quantity: &str| costs[&format!("sweep {kernel}")][quantity];
    // Shadow rays add arithmetic, counting adds stores, packets have barriers, stacks have private memory
    assert!(of("grid P", "arithmetic") < of("grid PS", "arithmetic"));
    // Bounces are a loop, whose instructions count once
    assert!(costs["sweep grid PS"] != costs["sweep grid PSR"]);
    assert!(of("grid P", "arithmetic") < of("grid P counting", "arithmetic"));
    assert!(of("bvh P", "barrier") > 0 && of("bvh P", "atomic") > 0 && of("bvh P", "workgroup_bytes") > 0);
    assert_eq!(of("bvh-stack P", "barrier"), 0);
    assert!(of("bvh-stack P", "private_bytes") >= 32 * 4);
}

#[test]
fn what_is_not_valid_is_located() {
    let message = |text: &str| source(text).cost().unwrap_err().to_string();
    let problem = message(&format!("{MAIN}\n  let x = nothing;\n}}"));
    assert!(problem.starts_with("kernels/it.wgsl:3:") && problem.contains("nothing"), "{problem}");
    // Parsed, but not valid
    let problem = message(&format!("{MAIN}}}\nfn f() -> u32 {{\n if true {{ return 1u; }} }}\n"));
    assert!(problem.contains("kernels/it.wgsl:") && problem.contains("return"), "{problem}");
    assert!(message("fn f() {}").contains("main"));
}

#[test]
fn the_command_prints_every_format_and_refuses_unknown_names() {
    let run = |arguments: &[&str]| Command::new(env!("CARGO_BIN_EXE_rtbench")).args(arguments).output().unwrap();
    let csv = run(&["kernels", "--format", "csv"]);
    assert_eq!(csv.status.code(), Some(0));
    let text = String::from_utf8(csv.stdout).unwrap();
    assert_eq!(text, String::from_utf8(run(&["kernels", "--format", "csv"]).stdout).unwrap());
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let headers = reader.headers().unwrap().clone();
    let costs = kernel_costs().unwrap();
    let mut count = 0;
    for record in reader.records() {
        let record = record.unwrap();
        for (column, value) in headers.iter().zip(&record).skip(1).filter(|(column, _)| *column != "kernel_hash") {
            assert_eq!(costs[&record[0]][column].to_string(), value, "{}: {column}", &record[0]);
        }
        count += 1;
    }
    assert_eq!(count, costs.len());
    let json = run(&["kernels", "--format", "json", "KDTREE", "bvh-stack p counting"]);
    let json: serde_json::Value = serde_json::from_slice(&json.stdout).unwrap();
    let names: Vec<&str> = json.as_array().unwrap().iter().map(|k| k["kernel"].as_str().unwrap()).collect();
    assert_eq!(names.len(), 13, "{names:?}");
    assert_eq!(json[0]["load"], costs[names[0]]["load"]);
    let markdown = String::from_utf8(run(&["kernels", "grid P", "--format", "markdown"]).stdout).unwrap();
    assert!(markdown.lines().all(|line| line.starts_with('|') && line.ends_with('|')), "{markdown}");
    let wrong = run(&["kernels", "no-such"]);
    let message = String::from_utf8(wrong.stderr).unwrap();
    assert_eq!(wrong.status.code(), Some(2));
    assert!(message.contains("no-such") && message.lines().count() == 1, "{message}");
}
