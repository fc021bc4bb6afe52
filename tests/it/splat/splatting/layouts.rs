//! Structs that kernels and host share, and bindings, by naga. Needs no GPU.

use rtbench::device::vulkan::BindingKind;
use rtbench::workloads::splat::gpu::Variant;
use rtbench::workloads::splat::gpu::splatting::kernels::{Action, Finder, Kernel, Walk};
use rtbench::workloads::splat::gpu::splatting::uniforms::*;
use std::mem::offset_of;

fn module(kernel: Kernel) -> naga::Module {
    naga::front::wgsl::parse_str(&kernel.assemble().unwrap().text).unwrap()
}

/// Size and members with their offsets.
fn layout(module: &naga::Module, name: &str) -> (u32, Vec<(String, u32)>) {
    let (_, found) = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name)).unwrap();
    let naga::TypeInner::Struct { members, span } = &found.inner else { panic!("{name} is no struct") };
    (*span, members.iter().map(|member| (member.name.clone().unwrap(), member.offset)).collect())
}

macro_rules! same_layout {
    ($kernel:expr, $name:ident, [$($field:ident),* $(,)?]) => {
        let rust = [$((stringify!($field).to_owned(), offset_of!($name, $field) as u32)),*];
        let name = stringify!($name);
        assert_eq!(layout(&module($kernel), name), (size_of::<$name>() as u32, rust.to_vec()), "{name}");
    };
}

#[test]
fn struct_layouts_agree() {
    let (kernel, weight) = (Default::default(), Default::default());
    let walk = Walk { finder: Finder::Keys, normals: true };
    same_layout!(Kernel::PhotonGroups, PhotonGroupsJob, [slots, row_groups, pad0, pad1]);
    same_layout!(Kernel::Needs, NeedsJob, [of_lists, pad0, pad1, pad2]);
    same_layout!(
        Kernel::Splat(walk, Action::Count),
        SplatJob,
        [level_offsets, slots, capacity, level, normal_mask, radius, radius2, peak, one, facets]
    );
    same_layout!(Kernel::Scale, ScaleJob, [slots, peak, full, faintest]);
    for kernel in [Kernel::PerSample(kernel, weight), Kernel::Queue(kernel, weight)] {
        same_layout!(kernel, GatherJob, [pixels, row_groups, slots, capacity, radius2, peak, one, pad]);
    }
    same_layout!(Kernel::Tasks, TasksJob, [pixels, row_groups, capacity, pad]);
    same_layout!(
        Kernel::ReadBuckets { fixed: true, nodes: false },
        ReadJob,
        [pixels, row_groups, capacity, shift, factor, pad0, pad1, pad2, directions]
    );
    same_layout!(Kernel::Blur, BlurJob, [width, height, row_groups, reach, is_vertical, depths, one, pad, weights]);
    same_layout!(Kernel::Tiled(kernel, weight), TiledJob, [tile, slots, radius, radius2, peak, one, pad0, pad1]);
}

/// What a kernel's text declares is what its layout says, and the photons' kernels stay within 12 buffers.
#[test]
fn bindings_agree() {
    for kernel in Kernel::all() {
        let module = module(kernel);
        let mut declared: Vec<(u32, bool, bool)> = Vec::new();
        for (_, variable) in module.global_variables.iter() {
            let Some(binding) = &variable.binding else { continue };
            let writes = match variable.space {
                naga::AddressSpace::Storage { access } => access.contains(naga::StorageAccess::STORE),
                _ => false,
            };
            declared.push((binding.binding, variable.space == naga::AddressSpace::Uniform, writes));
        }
        declared.sort_unstable();
        let of = |kind: BindingKind| match kind {
            BindingKind::Uniform | BindingKind::MovingUniform => (true, false),
            BindingKind::ReadWrite => (false, true),
            _ => (false, false),
        };
        let expected = kernel.layout().into_iter().map(|binding| {
            let (is_uniform, writes) = of(binding.kind);
            (binding.number, is_uniform, writes)
        });
        let expected: Vec<_> = expected.collect();
        assert_eq!(declared, expected, "{}", kernel.label());
        assert!(expected.iter().filter(|(_, is_uniform, _)| !is_uniform).count() <= 11, "{}", kernel.label());
    }
}
