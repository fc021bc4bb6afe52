//! Every kernel variant goes through naga, and every struct that kernels and host share has the same layout on both
//! sides. Needs no GPU.

use naga::valid::{Capabilities, ValidationFlags, Validator};
use rtbench::device::Source;
use rtbench::math::Vertex;
use rtbench::scene::{Light, Material};
use rtbench::workloads::trace::backend::TraceRay;
use rtbench::workloads::trace::backend::{Config, CountedPixel, Counters, Pixel};
use rtbench::workloads::trace::bih::{BihNode, BihUniform};
use rtbench::workloads::trace::brute::BruteUniform;
use rtbench::workloads::trace::cwbvh::{CwNode, CwbvhUniform};
use rtbench::workloads::trace::gpu::kernels::{self, Entry, Kernel, StagedPass};
use rtbench::workloads::trace::gpu::{CastJob, FrameUniform, WaitingPath};
use rtbench::workloads::trace::grid::GridUniform;
use rtbench::workloads::trace::grid::octants::Octant;
use rtbench::workloads::trace::kdtree::{KdTreeUniform, RopeLeaf};
use rtbench::workloads::trace::wide::{Slot, WideUniform};
use rtbench::workloads::trace::{Method, Selection, algorithms};
use std::mem::offset_of;

fn method(structure: &str) -> Method {
    Selection::parse(structure).unwrap().method()
}

fn assemble(kernel: &Kernel) -> Source {
    kernel.assemble().unwrap_or_else(|problem| panic!("{}: {problem}", kernel.label()))
}

/// Parses and validates; the error names file and line below `kernels/`.
fn check(source: &Source) -> Result<naga::Module, String> {
    let at = |location: Option<naga::SourceLocation>| {
        location.map_or("?".to_string(), |location| source.locate(location.line_number as usize))
    };
    let module = naga::front::wgsl::parse_str(&source.text)
        .map_err(|e| format!("{}: {}", at(e.location(&source.text)), e.message()))?;
    Validator::new(ValidationFlags::all(), Capabilities::RAY_QUERY | Capabilities::SUBGROUP)
        .validate(&module)
        .map_err(|e| format!("{}: {:?}", at(e.location(&source.text)), e.into_inner()))?;
    Ok(module)
}

/// Kernels of a method.
fn variants(method: &Method) -> usize {
    let staged = if method.is_staged(2) { 4 } else { 0 };
    let packets = if method.traversal.packets.is_some() { 2 } else { 0 };
    (12 + staged + packets) * 4 * if method.traversal.leaf_order { 2 } else { 1 }
}

#[test]
fn every_variant_is_valid() {
    let kernels = kernels::all();
    assert_eq!(
        kernels.len(),
        kernels::methods().iter().map(variants).sum::<usize>(),
        "ten render and two trace entries, three passes instead of one where they are staged, timed and counting, two \
         kinds of driver, buffers and textures, both layouts of triangles where a traversal takes both"
    );
    for algorithm in algorithms() {
        let method = method(algorithm.name);
        assert!(kernels.iter().any(|kernel| kernel.method == method), "{} is not checked", algorithm.name);
    }
    let special = [
        "kdtree:memory=private",
        "kdtree:search=pushdown",
        "kdtree:search=restart",
        "kdtree:search=stack",
        "kdtree:search=ropes",
        "kdtree:stack=1",
        "kdtree:stack=32",
        "bvh:vote=original",
        "bvh:packet=4x4",
        "grid-coop:packet=8x4",
        "grid-packet:packet=8x4",
        "bvh-stack:shadows=to-light",
        "bvh-stack:intersect=moller-trumbore",
        "bvh-stack:pattern=four",
        "bvh-stack:group=64x1",
        "bvh-stack:group=16x16",
        "bvh-stack:cull=off",
        "bvh-stack:build=spatial",
        "bvh-stack:build=spatial,cull=off",
        "bvh:build=spatial",
        "bvh-stack:reflections=staged",
        "bvh-subgroup:rays=1",
        "bvh-subgroup:width=2",
        "bvh-quantised:cull=off",
        "bvh-quantised:build=spatial",
        "bvh4:order=octant",
        "bvh8:order=octant",
        "bvh8:build=spatial,order=octant",
        "bvh4:stack=short",
        "bvh8:stack=short,entries=16",
        "cwbvh:build=spatial",
    ];
    for text in special {
        assert!(kernels.iter().any(|kernel| kernel.method == method(text)), "{text} is not checked");
    }
    for kernel in kernels {
        if let Err(problem) = check(&assemble(&kernel)) {
            panic!("{}: {problem}", kernel.label());
        }
    }
}

#[test]
fn a_broken_kernel_is_located() {
    let kernel = Kernel {
        entry: Entry::Render { config: Config::P, counting: false },
        method: method("bvh"),
        stack_size: 32,
        software_threads: 2,
        textures: false,
        leaf_order: false,
    };
    let mut source = assemble(&kernel);
    let (_, geom) = kernels::FILES.iter().find(|(name, _)| *name == "lib/geom.wgsl").unwrap();
    let line = geom.lines().position(|l| l.contains("return a.x * b.x")).unwrap() + 1;
    source.text = source.text.replace("return a.x * b.x", "return a * b.x");
    let problem = check(&source).unwrap_err();
    assert!(
        problem.starts_with(&format!("kernels/lib/geom.wgsl:{line}")) || problem.contains("geom.wgsl"),
        "{problem}"
    );
}

/// Size, stride-relevant alignment and member offsets of a WGSL struct.
fn layout(module: &naga::Module, name: &str) -> (u32, Vec<(String, u32)>) {
    let ty = module
        .types
        .iter()
        .find(|(_, ty)| ty.name.as_deref() == Some(name))
        .unwrap_or_else(|| panic!("no struct {name} in the kernel"))
        .1;
    let naga::TypeInner::Struct { members, span } = &ty.inner else { panic!("{name} is no struct") };
    (*span, members.iter().map(|m| (m.name.clone().unwrap(), m.offset)).collect())
}

macro_rules! same_layout {
    ($module:expr, $wgsl:literal, $rust:ty, [$($field:ident),* $(,)?]) => {
        let (span, members) = layout($module, $wgsl);
        assert_eq!(span as usize, size_of::<$rust>(), "size of {}", $wgsl);
        let rust = [$((stringify!($field), offset_of!($rust, $field))),*];
        for (name, offset) in rust {
            let member = members.iter().find(|(member, _)| member == name);
            let member = member.unwrap_or_else(|| panic!("{} has no member {name}", $wgsl));
            assert_eq!(member.1 as usize, offset, "offset of {}.{name}", $wgsl);
        }
    };
}

#[test]
fn struct_layouts_agree() {
    let render = |structure: &str, counting| {
        let kernel = Kernel {
            entry: Entry::Render { config: Config::PSR, counting },
            method: method(structure),
            stack_size: 32,
            software_threads: 0,
            textures: false,
            leaf_order: false,
        };
        check(&assemble(&kernel)).unwrap()
    };
    let module = &render("grid", true);
    same_layout!(
        module,
        "Frame",
        FrameUniform,
        [
            origin,
            width,
            corner,
            first_row,
            right,
            rows,
            down,
            epsilon,
            background,
            light_count,
            first_light,
            first_pixel,
            first_column,
            columns,
            height,
            shadow_reach,
            part,
            ambient_reach
        ]
    );
    same_layout!(module, "Grid", GridUniform, [bounds_min, cell_size, bounds_max, resolution, octants]);
    same_layout!(module, "Octant", Octant, [step, end]);
    same_layout!(module, "Vertex", Vertex, [position, normal]);
    same_layout!(module, "Material", Material, [ambient, reflectivity, diffuse, exponent, specular]);
    same_layout!(module, "Light", Light, [position, colour]);
    same_layout!(
        module,
        "Counters",
        Counters,
        [rays, inner, leaves, tests, pops, restarts, ropes, fallbacks, skips, boxes]
    );
    let (span, members) = layout(module, "CountedPixel");
    assert_eq!(span as usize, size_of::<CountedPixel>());
    assert_eq!(members.iter().find(|m| m.0 == "t").unwrap().1 as usize, offset_of!(CountedPixel, t));
    assert_eq!(members.iter().find(|m| m.0 == "counters").unwrap().1 as usize, offset_of!(CountedPixel, counters));
    let staged = Kernel {
        entry: Entry::Staged { config: Config::PSR, counting: false, pass: StagedPass::Bounce },
        method: method("bvh-stack:reflections=staged"),
        stack_size: 32,
        software_threads: 0,
        textures: false,
        leaf_order: false,
    };
    let module = &check(&assemble(&staged)).unwrap();
    same_layout!(module, "Waiting", WaitingPath, [origin, pixel, direction, weight, colour]);
    let module = &render("bvh-stack", false);
    same_layout!(module, "Pixel", Pixel, [triangle, rgba]);
    let (span, members) = layout(module, "Node");
    assert_eq!(span as usize, size_of::<rtbench::workloads::trace::bvh::BvhNode>());
    let offsets: Vec<_> = members.iter().map(|m| m.1 as usize).collect();
    use rtbench::workloads::trace::bvh::BvhNode;
    assert_eq!(
        offsets,
        [offset_of!(BvhNode, min), offset_of!(BvhNode, first), offset_of!(BvhNode, max), offset_of!(BvhNode, count)]
    );
    let kernel = Kernel {
        entry: Entry::Trace { any_hit: false },
        method: method("kdtree"),
        stack_size: 8,
        software_threads: 0,
        textures: false,
        leaf_order: false,
    };
    let module = &check(&assemble(&kernel)).unwrap();
    same_layout!(module, "GivenRay", TraceRay, [origin, direction]);
    same_layout!(module, "Job", CastJob, [rays, row_groups, limit, pad]);
    same_layout!(module, "KdTree", KdTreeUniform, [bounds_min, bounds_max]);
    same_layout!(&render("bih", false), "Bih", BihUniform, [bounds_min, bounds_max]);
    same_layout!(&render("bvh8", false), "Wide", WideUniform, [bounds_min, root, bounds_max, axes, lo, step]);
    same_layout!(&render("cwbvh", false), "Cwbvh", CwbvhUniform, [bounds_min, root, bounds_max]);
    // Rows of 16 bytes, of which kernels read whole ones
    let rows =
        [offset_of!(RopeLeaf, min), offset_of!(RopeLeaf, max), offset_of!(RopeLeaf, low), offset_of!(RopeLeaf, high)];
    assert_eq!((rows, size_of::<RopeLeaf>()), ([0, 16, 32, 48], 64));
    assert_eq!([offset_of!(RopeLeaf, first), offset_of!(RopeLeaf, count)], [12, 28]);
    same_layout!(&render("brute", false), "Brute", BruteUniform, [triangle_refs]);
}

/// Kernels read two nodes of 12 bytes as three words of 8 bytes.
#[test]
fn nodes_of_a_bih_are_packed() {
    assert_eq!(size_of::<BihNode>(), 12);
    assert_eq!([offset_of!(BihNode, link), offset_of!(BihNode, words)], [0, 4]);
}

/// Kernels read a child as one texel, and a node of a CWBVH as five.
#[test]
fn nodes_of_wide_trees_are_packed() {
    assert_eq!([offset_of!(Slot, min), offset_of!(Slot, max), offset_of!(Slot, reference)], [0, 6, 12]);
    assert_eq!([size_of::<Slot>(), size_of::<CwNode>()], [16, 80]);
    let links = [offset_of!(CwNode, exponents), offset_of!(CwNode, inner), offset_of!(CwNode, first_child)];
    assert_eq!(links, [12, 15, 16]);
    assert_eq!([offset_of!(CwNode, first_ref), offset_of!(CwNode, meta), offset_of!(CwNode, planes)], [20, 24, 32]);
}

/// Builders' passes share one uniform.
#[test]
fn jobs_of_builders_agree() {
    let kernels = rtbench::workloads::trace::build::gpu::kernels().unwrap();
    for (label, source) in &kernels {
        let module = &check(source).unwrap_or_else(|problem| panic!("{label}: {problem}"));
        same_layout!(
            module,
            "Job",
            rtbench::workloads::trace::build::gpu::Job,
            [count, stride, workers, chunk, shift, level, max_leaf, first, radius, forced, leaves, unit, lo, scale]
        );
    }
    assert!(kernels.len() > 10);
}
