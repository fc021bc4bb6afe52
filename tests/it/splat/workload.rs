//! Photon splatting on the harness: what is typed, what is planned, and what becomes of what cannot be or is wrong.

use super::rows::*;
use crate::support::own_gpu;
use glam::Vec4;
use rtbench::device::Device;
use rtbench::harness::workload::{Library, Workload};
use rtbench::harness::{Plan, Request};
use rtbench::record::row::Status;
use rtbench::workloads::splat::{Fault, SPLAT, SplatCase, Stages};

#[test]
fn every_case_is_read_as_it_is_written() {
    // Plans read no more than the first lines of a scene's file
    let folder = tempfile::tempdir().unwrap();
    for scene in ["sponza", "sibenik"] {
        std::fs::create_dir(folder.path().join(scene)).unwrap();
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        std::fs::write(folder.path().join(scene).join(format!("{scene}.obj")), text).unwrap();
    }
    let library = Library { scenes_folder: Some(folder.path().to_owned()), ..Library::default() };
    for preset in ["quick", "splat", "splat-lite", "splat-reference"] {
        let request = Request { preset: Some(preset.into()), library: library.clone(), ..Request::default() };
        let plan = Plan::new(&SPLAT, &request).unwrap();
        assert!(!plan.cases.is_empty());
        for case in &plan.cases {
            let again = SplatCase::parse(case).unwrap().to_case(case.axis("scene"));
            assert_eq!(again.axes, case.axes);
            let budget = SPLAT.info().budget.unwrap();
            assert!(case.work <= budget, "{preset}: {} is above the budget: {:?}", case.work, case.axes);
        }
    }
}

#[test]
fn what_cannot_be_is_refused_with_its_flag() {
    for (axis, value, problem) in [
        ("technique", "bucket", "there is no technique 'bucket'"),
        ("technique", "buckets:level=6", "one of 1 to 5"),
        ("technique", "tiled:order=any", "tiled has no option 'order'"),
        ("technique", "reference:kernel=box", "one of epanechnikov, constant"),
        ("radius", "0", "is not above 0"),
        ("radius", "-3u", "is not above 0"),
        ("radius", "99", "too large a share"),
        ("hits", "1", "give 2 to 16"),
        ("hits", "17", "give 2 to 16"),
        ("paths", "0", "give 1 to 16777216"),
        ("paths", "1e3", "give 1 to 16777216"),
        ("seed", "-1", "give 0 to 4294967295"),
        ("falloff", "cubic", "one of square, source"),
        ("energy", "all", "one of flux, shared"),
        ("light", "sun", "--light"),
        ("light", "point:x=1,y=2", "--light"),
        ("light", "point:x=0,y=1e30,z=0", "no coordinate up to 1e18"),
        ("light", "point:x=1,y=2,z=3+", "--light"),
        ("light", "point:x=1,y=2,z=3,flux=-1", "--light"),
        ("structure", "octree", "there is no structure 'octree'"),
        ("camera_path", "nowhere", "no built-in camera path"),
        ("resolution", "0", "has no pixels"),
        ("scene", "nowhere", "no file and no scene"),
    ] {
        let error = Plan::new(&SPLAT, &request(&[(axis, value)])).map(drop).unwrap_err();
        assert_eq!(error.exit_code(), 2, "{axis}={value}");
        assert!(error.to_string().contains(problem), "{axis}={value}: {error}");
    }
}

#[test]
fn a_right_row_has_times_counts_and_hashes_on_every_device() {
    let mut hashes = Vec::new();
    for device in devices() {
        let out = tempfile::tempdir().unwrap();
        let is_vulkan = matches!(device, Device::Vulkan(_));
        let journal = measured(device, Faults::default(), &request(&[]), out.path());
        let row = the_row(&journal);
        assert_eq!(row.status, Status::Ok, "{}", row.message);
        let count = |of: Option<&str>, name: &str| row.metric(of, name).and_then(|value| value.integer()).unwrap();
        // The box is closed: every path has all hits
        for hit in 1..=4 {
            assert_eq!(count(Some(&format!("hit-{hit}")), "arrived"), 300);
        }
        assert_eq!(count(None, "photons"), 900);
        assert_eq!(count(None, "distance_tests"), 900 * count(None, "samples"));
        assert_eq!(row.samples.as_ref().unwrap().stages.is_empty(), !is_vulkan);
        if is_vulkan {
            let stages = ["hit-1", "hit-2", "hit-3", "hit-4", "compaction", "samples", "direct", "estimate", "mix"];
            assert_eq!(row.samples.as_ref().unwrap().stages, stages);
            assert!(count(None, "buffer_bytes") > 900 * 48);
        }
        hashes.push(row.outputs.clone());
        for end in ["", "-direct", "-indirect", "-photons"] {
            assert!(out.path().join(format!("pictures/box{end}.png")).is_file());
        }
    }
    assert!(hashes.windows(2).all(|pair| pair[0] == pair[1]), "{hashes:?}");
}

fn first(array: &mut [Vec4]) -> &mut Vec4 {
    array.iter_mut().find(|v| v.truncate() != glam::Vec3::ZERO).unwrap()
}

/// Its name, and the change.
type Planted = (&'static str, fn(&mut Stages));

#[test]
fn what_is_wrong_is_a_row_before_anything_is_timed() {
    let faults: [Planted; 9] = [
        ("a moved photon", |stages| first(&mut stages.traced.slots.positions).x += 1e-3),
        ("another flux", |stages| first(&mut stages.traced.slots.fluxes).y *= 1.001),
        ("a missing arrival", |stages| stages.traced.arrived[2] -= 1),
        ("a photon lost by compaction", |stages| _ = stages.photons.positions.pop()),
        ("swapped photons", |stages| stages.photons.fluxes.rotate_left(1)),
        ("another depth", |stages| first(&mut stages.samples.positions).w *= 1.01),
        ("swapped channels", |stages| {
            let light = first(&mut stages.direct);
            *light = Vec4::new(light.y, light.z + 1.0, light.x, light.w);
        }),
        ("an estimate once too often", |stages| stages.irradiance.iter_mut().for_each(|v| *v *= 2.0)),
        ("a pixel of nothing", |stages| *stages.picture.last_mut().unwrap() = Vec4::splat(f32::NAN)),
    ];
    for (what, stages) in faults {
        let out = tempfile::tempdir().unwrap();
        let faults = Faults(Some(Fault { stages, timed: |_| () }));
        let journal = measured(on_cpu(), faults, &request(&[]), out.path());
        let row = the_row(&journal);
        assert_eq!(row.status, Status::Wrong, "{what}: {}", row.message);
        assert!(row.samples.is_none(), "{what}");
    }
}

#[test]
fn what_was_timed_is_compared_as_well() {
    let out = tempfile::tempdir().unwrap();
    let timed: fn(&mut Vec<Vec4>) = |picture| picture[7].x += 1.0;
    let faults = Faults(Some(Fault { stages: |_| (), timed }));
    let journal = measured(on_cpu(), faults, &request(&[]), out.path());
    let row = the_row(&journal);
    assert_eq!(row.status, Status::Wrong);
    assert!(row.message.contains("after the last pass"), "{}", row.message);
}

#[test]
fn what_a_case_cannot_do_is_a_row() {
    for (values, status, problem) in [
        (&[("paths", "16777216"), ("hits", "16")][..], Status::Skipped, "slots"),
        (&[("light", "point:x=0,y=1,z=0+point:x=0,y=2,z=0"), ("paths", "1")][..], Status::Failed, "lights"),
        (&[("radius", "1e-30u")][..], Status::Failed, "the square of which is no float"),
    ] {
        let out = tempfile::tempdir().unwrap();
        let journal = measured(on_cpu(), Faults::default(), &request(values), out.path());
        let row = the_row(&journal);
        assert_eq!(row.status, status, "{values:?}: {}", row.message);
        assert!(row.message.contains(problem), "{values:?}: {}", row.message);
    }
}

#[test]
fn each_row_names_its_own_kernels() {
    let Some(gpu) = own_gpu(false) else { return };
    let out = tempfile::tempdir().unwrap();
    let techniques = "reference,reference:kernel=constant,reference:weight=cosine";
    let journal = measured(Device::Vulkan(gpu), Faults::default(), &request(&[("technique", techniques)]), out.path());
    let kernels: Vec<_> = journal.rows.iter().map(|row| &row.kernels).collect();
    assert_eq!(kernels.len(), 3);
    assert!(kernels[0] != kernels[1] && kernels[1] != kernels[2] && kernels[0] != kernels[2], "{kernels:?}");
}

#[test]
fn a_large_radius_is_summed_right() {
    let out = tempfile::tempdir().unwrap();
    let values = [("scene", "sphere"), ("technique", "reference:kernel=constant"), ("radius", "1"), ("paths", "4000")];
    let journal = measured(on_cpu(), Faults::default(), &request(&values), out.path());
    let row = the_row(&journal);
    assert_eq!(row.status, Status::Ok, "{}", row.message);
}
