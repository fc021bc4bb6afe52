//! Kernels of photon splatting through naga, and the layout of structs that they share with the host. Needs no GPU.

use naga::valid::{Capabilities, ValidationFlags, Validator};
use rtbench::math::Hit;
use rtbench::workloads::splat::gpu::{self, Kernel, Variant};
use rtbench::workloads::splat::setting::Falloff;
use rtbench::workloads::trace::backend::TraceRay;
use std::mem::offset_of;

fn module(kernel: Kernel) -> naga::Module {
    naga::front::wgsl::parse_str(&kernel.assemble().unwrap().text).unwrap()
}

#[test]
fn every_kernel_is_valid_and_has_its_own_text() {
    let all = gpu::kernels().unwrap();
    assert!(all.len() > 100, "{}", all.len());
    for (name, source) in &all {
        let module = naga::front::wgsl::parse_str(&source.text)
            .unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(&source.text)));
        Validator::new(ValidationFlags::all(), Capabilities::SHADER_FLOAT32_ATOMIC).validate(&module).unwrap();
        for word in [" dot(", " normalize(", " cross(", " length(", "sin(", "cos(", "pow(", "fma("] {
            assert!(!source.text.contains(word), "{name}: the bits of{word} are the driver's choice");
        }
        assert_eq!(all.iter().filter(|(_, other)| other.hash() == source.hash()).count(), 1, "{name}");
        assert_eq!(all.iter().filter(|(other, _)| other == name).count(), 1, "{name}");
    }
}

/// Size and members with their offsets.
fn layout(module: &naga::Module, name: &str) -> (u32, Vec<(String, u32)>) {
    let (_, found) = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name)).unwrap();
    let naga::TypeInner::Struct { members, span } = &found.inner else { panic!("{name} is no struct") };
    (*span, members.iter().map(|member| (member.name.clone().unwrap(), member.offset)).collect())
}

macro_rules! same_layout {
    ($kernel:expr, $wgsl:literal, $rust:ty, [$($field:ident),* $(,)?]) => {
        let rust = [$((stringify!($field).to_owned(), offset_of!($rust, $field) as u32)),*];
        assert_eq!(layout(&module($kernel), $wgsl), (size_of::<$rust>() as u32, rust.to_vec()), $wgsl);
    };
}

#[test]
fn struct_layouts_agree() {
    use gpu::{BounceJob, DirectJob, EmitJob, EstimateJob, Facet, List, ShadowJob, Source, View};
    let estimate = Kernel::Estimate(Default::default(), Default::default());
    same_layout!(Kernel::Mix, "List", List, [count, row_groups, inverse_pi, pad]);
    same_layout!(Kernel::Emit, "EmitJob", EmitJob, [seed, first_path, paths, row_groups, lights, is_first, pad0, pad1]);
    same_layout!(Kernel::Emit, "Source", Source, [position, first_path, path_flux, paths]);
    same_layout!(
        Kernel::Bounce,
        "BounceJob",
        BounceJob,
        [seed, first_path, paths, row_groups, number, per_path, epsilon, divisor]
    );
    same_layout!(Kernel::Bounce, "Facet", Facet, [red, green, blue]);
    same_layout!(
        Kernel::Samples,
        "View",
        View,
        [
            origin,
            width,
            corner,
            pixels,
            right,
            row_groups,
            down,
            epsilon,
            forward,
            first_border,
            axis_x,
            height,
            axis_y,
            pad0,
            axis_z,
            pad1,
            axes_origin,
            margin
        ]
    );
    same_layout!(Kernel::Shadow, "ShadowJob", ShadowJob, [light, reach, pixels, row_groups, pad0, pad1]);
    for falloff in [Falloff::Square, Falloff::Source] {
        same_layout!(
            Kernel::Direct(falloff),
            "DirectJob",
            DirectJob,
            [light, pixels, intensity, row_groups, influence2, inverse_pi, one, is_first]
        );
    }
    same_layout!(
        estimate,
        "EstimateJob",
        EstimateJob,
        [first_pixel, end_pixel, row_groups, slots, radius2, peak, one, pad]
    );
    let (ray, hit) = (layout(&module(Kernel::Bounce), "TraceRay"), layout(&module(Kernel::Bounce), "TraceHit"));
    assert_eq!(ray.0 as usize, size_of::<TraceRay>());
    assert_eq!(ray.1[1].1 as usize, offset_of!(TraceRay, direction));
    assert_eq!(hit.0 as usize, size_of::<Hit>());
}
