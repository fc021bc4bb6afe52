//! The layout of structs that kernels of clusters share with the host. Needs no GPU.

use rtbench::workloads::splat::gpu::Variant;
use rtbench::workloads::splat::gpu::clusters::{
    ClusterKernel, CountJob, FillJob, KeyJob, NodeJob, TileJob, UniqueJob, kernels,
};
use std::mem::offset_of;

/// Size and members with their offsets.
fn layout(kernel: ClusterKernel, name: &str) -> (u32, Vec<(String, u32)>) {
    let module = naga::front::wgsl::parse_str(&kernel.assemble().unwrap().text).unwrap();
    let (_, found) = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name)).unwrap();
    let naga::TypeInner::Struct { members, span } = &found.inner else { panic!("{name} is no struct") };
    (*span, members.iter().map(|member| (member.name.clone().unwrap(), member.offset)).collect())
}

macro_rules! same_layout {
    ($kernel:expr, $job:ident, [$($field:ident),* $(,)?]) => {
        let rust = [$((stringify!($field).to_owned(), offset_of!($job, $field) as u32)),*];
        assert_eq!(layout($kernel, stringify!($job)), (size_of::<$job>() as u32, rust.to_vec()));
    };
}

#[test]
fn struct_layouts_agree() {
    same_layout!(ClusterKernel::Keys(Default::default()), KeyJob, [tile, columns, rows, slices]);
    same_layout!(ClusterKernel::Fill, FillJob, [first, count, value, row_groups]);
    same_layout!(ClusterKernel::Flag, UniqueJob, [count, row_groups, first_word, clusters]);
    same_layout!(ClusterKernel::Sort(4), TileJob, [tile, columns, tiles, row_groups, width, height, within, clusters]);
    same_layout!(ClusterKernel::Count, CountJob, [clusters, row_groups, pad0, pad1]);
    same_layout!(
        ClusterKernel::Nodes(false, false),
        NodeJob,
        [nodes, row_groups, first, first_child, first_parent, clusters, is_root, pad]
    );
}

#[test]
fn every_variant_has_its_own_name() {
    let mut names: Vec<String> = kernels().unwrap().into_iter().map(|(name, _)| name).collect();
    assert_eq!(names.len(), ClusterKernel::all().len());
    names.sort();
    names.dedup();
    assert_eq!(names.len(), ClusterKernel::all().len());
}
