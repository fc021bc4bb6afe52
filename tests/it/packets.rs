//! Packets of a subgroup: planted faults of the kernel that only finds hits are found by comparison, and triangles in
//! leaf order change no result.

use crate::support::{gpu, soup};
use crate::traversal::{SIZE, counted, shiny, view};
use rtbench::device::vulkan::{
    Binding, BindingKind, Dispatch, Groups, PipelineDescription, ReadBuffer, Resource, Texel,
};
use rtbench::device::{DeviceType, Frame, Pass, Stage, VulkanDevice};
use rtbench::math::MISS;
use rtbench::scene::Scene;
use rtbench::workloads::trace::backend::{Backend, Config};
use rtbench::workloads::trace::gpu::kernels::{Entry, Kernel, PacketPass};
use rtbench::workloads::trace::gpu::{FrameUniform, LeafTriangle};
use rtbench::workloads::trace::{CpuBackend, Selection};

/// The text of the hits kernel on textures, with triangles in leaf order.
fn hits_kernel(selection: &Selection) -> String {
    let entry = Entry::Packets { config: Config::P, counting: false, pass: PacketPass::Hits };
    let method = selection.method();
    let kernel = Kernel { entry, method, stack_size: 96, software_threads: 2, textures: true, leaf_order: true };
    kernel.assemble().unwrap().text
}

/// What the kernel with this text finds: triangles of the scene by pixel.
fn hits(device: &VulkanDevice, scene: &Scene, selection: &Selection, text: &str) -> Vec<u32> {
    let built = selection.build(scene, 1).unwrap();
    let (structure, refs) = (&built.structure, built.structure.triangle_refs());
    let corners: Vec<LeafTriangle> = refs
        .iter()
        .map(|r| {
            let [a, b, c] = r.vertices.map(|vertex| scene.vertices[vertex as usize].position);
            LeafTriangle { a, triangle: r.triangle, b, material: 0, c, pad: 0 }
        })
        .collect();
    let texture = |bytes: &[u8]| ReadBuffer::Texture(device.texture("input", bytes, Texel::Bytes16).unwrap());
    let inputs = [
        (1, texture(bytemuck::cast_slice(&scene.vertices))),
        (2, texture(bytemuck::cast_slice(refs))),
        (6, texture(&structure.nodes())),
        (13, texture(bytemuck::cast_slice(&corners))),
    ];
    let grid = view(0).camera.pixel_grid(SIZE.width, SIZE.height);
    let frame = FrameUniform {
        origin: grid.origin,
        width: SIZE.width,
        corner: grid.corner,
        first_row: 0,
        right: grid.right,
        rows: SIZE.height,
        down: grid.down,
        epsilon: 0.0,
        background: glam::Vec3::ZERO,
        light_count: 0,
        first_light: 0,
        first_pixel: 0,
        first_column: 0,
        columns: SIZE.width,
        height: SIZE.height,
        shadow_reach: 1.0,
        part: 0,
        ambient_reach: 1.0,
    };
    let frame = device.uniform("the frame", &[frame]).unwrap();
    let tree = device.uniform("the tree", &structure.uniform()).unwrap();
    let output = device.poisoned("the hits", SIZE.pixels() as u64 * 8).unwrap();
    let mut layout = vec![
        Binding::new(0, BindingKind::MovingUniform),
        Binding::new(7, BindingKind::Uniform),
        Binding::new(8, BindingKind::ReadWrite),
    ];
    layout.extend(inputs.iter().map(|(number, _)| Binding::new(*number, BindingKind::Texture(Texel::Bytes16))));
    let description =
        PipelineDescription { label: "hits", text, layout: &layout, checked: false, zero_workgroup_memory: false };
    let pipeline = device.pipeline(&description).unwrap();
    let mut resources = vec![
        (0, Resource::Window(&frame, size_of::<FrameUniform>() as u64)),
        (7, Resource::from(&tree)),
        (8, Resource::from(&output)),
    ];
    resources.extend(inputs.iter().map(|(number, input)| (*number, Resource::from(input))));
    let bindings = device.bind(&pipeline, &resources);
    // Four by two packets of 8 x 8 pixels
    let groups = Groups::Fixed(SIZE.width.div_ceil(32), SIZE.height.div_ceil(16), 1);
    let work = Dispatch { pipeline: &pipeline, bindings: &bindings, offset: Some(0), groups };
    device.run(&Frame::new(vec![Pass { stage: Stage("hits"), work }])).unwrap();
    let found: Vec<[u32; 2]> = device.read(&output, SIZE.pixels()).unwrap();
    let triangle = |&[found, _]: &[u32; 2]| refs.get(found as usize).map_or(MISS, |r| r.triangle);
    found.iter().map(triangle).collect()
}

#[test]
fn planted_faults_are_found() {
    let Some(gpu) = gpu() else { return };
    if gpu.info().device_type != DeviceType::SoftwareRasteriser || !gpu.info().agrees_with_twins() {
        eprintln!("not run: {} is not compared to the bit", gpu.info().name);
        return;
    }
    let scene = soup(900, 21, false);
    let cpu = CpuBackend::new(2).unwrap();
    let (expected, _) = counted(&cpu, &scene, "bvh-stack", Config::P, SIZE);
    let selection = Selection::parse("bvh-subgroup").unwrap();
    let text = hits_kernel(&selection);
    let differing = |text: &str| {
        let found = hits(gpu, &scene, &selection, text);
        found.iter().zip(&expected).filter(|(found, pixel)| **found != pixel.pixel.triangle).count()
    };
    assert_eq!(differing(&text), 0);
    let faults = [
        ("a mask that forgets a row", "& 255u, member < WIDTH);", "& 127u, member < WIDTH);"),
        ("a leaf that forgets its last triangle", "min(count - begin, 8u)", "min(max(count, 2u) - 1u - begin, 8u)"),
        ("a child that is never tested", "countOneBits(open));", "countOneBits(open));\n    open &= ~2u;"),
        ("the interval of one corner", "inverse_hi = cluster_max3(inverse_hi);", "inverse_hi = inverse_lo;"),
        ("the nearest of all hits", "farthest = cluster_max(t);", "farthest = -cluster_max(-nearest_t[0]);"),
    ];
    for (fault, right, wrong) in faults {
        let broken = text.replace(right, wrong);
        assert_ne!(broken, text, "{fault}: nothing is replaced");
        assert!(differing(&broken) > 0, "{fault} is not found");
    }
}

#[test]
fn triangles_in_leaf_order_change_no_result() {
    let scene = shiny(soup(400, 22, true));
    let Some(gpu) = gpu() else { return };
    for name in ["bvh-stack", "bvh-quantised", "bvh-subgroup"] {
        for fetch in ["buffers", "textures"] {
            let of = |layout: &str| {
                counted(gpu, &scene, &format!("{name}:fetch={fetch},triangles={layout}"), Config::PSR, SIZE)
            };
            assert!(of("indexed") == of("leaf-order"), "{name} {fetch}");
        }
    }
}

#[test]
fn triangles_in_leaf_order_are_counted() {
    let Some(gpu) = gpu() else { return };
    let scene = soup(100, 23, false);
    let selection = |text: &str| Selection::parse(text).unwrap();
    let built = selection("bvh-stack").build(&scene, 1).unwrap();
    let structure = &*built.structure;
    let bytes = |text: &str| {
        let prepared = gpu.prepare(&scene, structure, selection(text).method()).unwrap();
        let metrics = prepared.artifact_metrics();
        let copy = metrics.iter().find(|metric| metric.name == "leaf_order_bytes").and_then(|m| m.value.integer());
        (prepared.allocated().1, copy)
    };
    let (leaf_order, indexed) = (bytes("bvh-stack:triangles=leaf-order"), bytes("bvh-stack:triangles=indexed"));
    assert_eq!(leaf_order, (indexed.0, Some(48 * structure.triangle_refs().len() as u64)));
    assert_eq!(indexed.1, None);
    let refused = Selection::parse("grid:triangles=leaf-order").unwrap_err().to_string();
    assert!(refused.contains("triangles has no effect"), "{refused}");
}
