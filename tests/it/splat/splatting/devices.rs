//! Lists, buckets and irradiance of a device against the twins.

use super::assignments::settings;
use super::given::*;
use crate::support::gpu;
use rtbench::device::{Feature, POISON, VulkanDevice};
use rtbench::error::Result;
use rtbench::record::row::Check;
use rtbench::workloads::splat::clusters::setting::*;
use rtbench::workloads::splat::setting::{Estimate, EstimateKernel, Form, Weight};
use rtbench::workloads::splat::splatting::setting::*;
use rtbench::workloads::splat::splatting::verify;
use rtbench::workloads::splat::verify::{Exactness, same};

const LISTS: Gather = Gather::PerSample { order: Order::Any, tasks: Tasks::Sample };
const SORTED: Gather = Gather::PerSample { order: Order::Sorted, tasks: Tasks::Sample };
const QUEUE: Gather = Gather::PerSample { order: Order::Any, tasks: Tasks::Queue };

fn exactness(gpu: &VulkanDevice) -> Exactness {
    if gpu.info().agrees_with_twins() { Exactness::Bits } else { Exactness::Close }
}

fn of_buckets(setting: BucketSetting) -> Gather {
    Gather::Buckets(setting)
}

/// All checks of a technique.
fn checks(
    given: &Given,
    grouped: &Grouped,
    gather: Gather,
    (found, twin): (&Made, &Made),
    exact: Exactness,
) -> Vec<Check> {
    let mut checks = match gather {
        Gather::PerSample { order, .. } => verify::lists(&found.lists, &twin.lists, order, exact),
        Gather::Buckets(setting) => verify::buckets(&found.buckets, &twin.buckets, setting.atomics, exact),
        _ => Vec::new(),
    };
    // Floats that were added in another order are read the same
    let expected = match gather {
        Gather::Buckets(setting) if !gather.is_repeatable() => read(given, grouped, &found.buckets, &setting),
        _ => twin.irradiance.clone(),
    };
    let repeatable = gather.is_repeatable() || matches!(gather, Gather::Buckets(_));
    checks.push(verify::irradiance(&found.irradiance, &expected, repeatable, exact, given.size.width));
    checks
}

fn check(gpu: &VulkanDevice, given: &Given, grouped: &Grouped, gather: Gather) -> Result<Ran> {
    let tile = 16;
    let device = OnDevice::new(gpu, given, grouped, (gather, tile), ROOM)?;
    let first = device.run();
    let twin = by_twins(given, grouped, gather, tile);
    for check in checks(given, grouped, gather, (&first.made, &twin), exactness(gpu)) {
        assert!(check.ok, "{gather:?} {:?}: {}", grouped.setting, check.message);
    }
    assert!(!first.needs.exceed(&first.sizes), "{:?}", first.needs);
    if let Gather::PerSample { .. } = gather {
        assert_eq!(first.needs.entries, *first.made.lists.offsets.last().unwrap());
    }
    // Neither what the frame before left behind nor poison changes anything
    let again = device.run();
    device.poison();
    let poisoned = device.run();
    for later in [again, poisoned] {
        if gather.is_repeatable() {
            assert!(later.made == first.made, "{gather:?}");
        }
        for check in checks(given, grouped, gather, (&later.made, &twin), exactness(gpu)) {
            assert!(check.ok, "{gather:?} again: {}", check.message);
        }
    }
    Ok(first)
}

#[test]
fn lists_of_every_setting() {
    let Some(gpu) = gpu() else { return };
    let given = boxed(0.1);
    for setting in settings() {
        let grouped = given.grouped(setting);
        for gather in [LISTS, SORTED, QUEUE] {
            check(gpu, &given, &grouped, gather).unwrap();
        }
    }
}

#[test]
fn every_estimate_over_lists_and_tiles() {
    let Some(gpu) = gpu() else { return };
    let room = room(0.2);
    for (kernel, weight, form) in [
        (EstimateKernel::Epanechnikov, Weight::Side, Form::Source),
        (EstimateKernel::Epanechnikov, Weight::Cosine, Form::Normalised),
        (EstimateKernel::Constant, Weight::Side, Form::Normalised),
        (EstimateKernel::Constant, Weight::Cosine, Form::Normalised),
    ] {
        let given = room.with(Estimate { kernel, weight, form, ..room.estimate });
        let grouped = given.grouped(ClusterSetting::default());
        for gather in [SORTED, QUEUE, Gather::Tiled] {
            check(gpu, &given, &grouped, gather).unwrap();
        }
    }
    // The baseline has the bits of the reference, whatever its tiles
    let given = boxed(0.1);
    let grouped = given.grouped(ClusterSetting::default());
    for tile in [4, 15, 64] {
        let ran = OnDevice::new(gpu, &given, &grouped, (Gather::Tiled, tile), ROOM).unwrap().run();
        let reference = &given.stages.irradiance;
        let check = match exactness(gpu) {
            Exactness::Bits => same("irradiance", "the reference's", &ran.made.irradiance, reference, given.size.width),
            exact => verify::irradiance(&ran.made.irradiance, reference, true, exact, given.size.width),
        };
        assert!(check.ok, "{tile}: {}", check.message);
    }
}

#[test]
fn buckets_of_every_setting() {
    let Some(gpu) = gpu() else { return };
    let given = boxed(0.1);
    for setting in settings() {
        let grouped = given.grouped(setting);
        check(gpu, &given, &grouped, of_buckets(BucketSetting::DEFAULT)).unwrap();
    }
    let grouped = given.grouped(ClusterSetting { tile: 8, ..ClusterSetting::default() });
    for atomics in [Atomics::Fixed, Atomics::Exchange, Atomics::Float] {
        for share in [Share::All, Share::Centre] {
            for kernel in [EstimateKernel::Epanechnikov, EstimateKernel::Constant] {
                for form in [Form::Normalised, Form::Source] {
                    let given = given.with(Estimate { kernel, form, ..given.estimate });
                    let gather = of_buckets(BucketSetting { atomics, share, ..BucketSetting::DEFAULT });
                    match check(gpu, &given, &grouped, gather) {
                        Ok(_) => {}
                        Err(error) => {
                            assert!(atomics == Atomics::Float && !gpu.features().has(Feature::FloatAtomics), "{error}");
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn buckets_of_nodes_and_blur() {
    let Some(gpu) = gpu() else { return };
    let given = boxed(0.1);
    for unique in [Unique::Flags, Unique::Bits] {
        let grouped = given.grouped(ClusterSetting { tile: 4, unique, ..ClusterSetting::default() });
        for level in 1..=3 {
            for share in [Share::All, Share::Centre] {
                let gather = of_buckets(BucketSetting { level, share, ..BucketSetting::DEFAULT });
                check(gpu, &given, &grouped, gather).unwrap();
            }
        }
        for blur in [1, 3, MAX_BLUR] {
            check(gpu, &given, &grouped, of_buckets(BucketSetting { blur, ..BucketSetting::DEFAULT })).unwrap();
        }
    }
    let none = given.grouped(ClusterSetting { hierarchy: HierarchyBy::None, ..ClusterSetting::default() });
    let gather = of_buckets(BucketSetting { level: 3, ..BucketSetting::DEFAULT });
    let error = OnDevice::new(gpu, &given, &none, (gather, 0), ROOM).err().unwrap().to_string();
    assert!(error.contains("level=3") && error.contains("hierarchy"), "{error}");
}

/// No photon, no sample, one photon.
#[test]
fn nothing_is_no_special_case() {
    let Some(gpu) = gpu() else { return };
    for photons in [0, 1, 64, 65] {
        let mut given = boxed(0.3);
        given.stages.photons.positions.truncate(photons);
        given.stages.photons.directions.truncate(photons);
        given.stages.photons.fluxes.truncate(photons);
        let grouped = given.grouped(ClusterSetting::default());
        for gather in [LISTS, SORTED, QUEUE, Gather::Tiled, of_buckets(BucketSetting::DEFAULT)] {
            let ran = check(gpu, &given, &grouped, gather).unwrap();
            let lit = ran.made.irradiance.iter().any(|irradiance| irradiance.y > 0.0);
            assert!(if photons == 0 { !lit } else { lit || photons == 1 }, "{gather:?}");
        }
    }
    let mut given = boxed(0.3);
    let all = &mut given.stages.samples;
    for array in [&mut all.positions, &mut all.normals, &mut all.albedos] {
        array.fill(glam::Vec4::ZERO);
    }
    let full = boxed(0.3).grouped(ClusterSetting::default());
    let clusters = rtbench::workloads::splat::clusters::build(
        pool(),
        &full.setting,
        &full.layout,
        &full.placement,
        given.camera.field_of_view,
        &given.stages.samples,
    );
    let grouped = Grouped { clusters, ..full };
    assert!(grouped.clusters.is_empty());
    for gather in [LISTS, SORTED, QUEUE, Gather::Tiled, of_buckets(BucketSetting::DEFAULT)] {
        let ran = OnDevice::new(gpu, &given, &grouped, (gather, 16), ROOM).unwrap().run();
        assert!(ran.made.irradiance.iter().all(|irradiance| *irradiance == glam::Vec4::ZERO), "{gather:?}");
        assert_eq!((ran.needs.entries, ran.needs.clusters), (0, 0));
    }
}

/// Too little room is reported, nothing beyond it is touched, and what needs less is found again.
#[test]
fn too_little_room_is_reported() {
    let Some(gpu) = gpu() else { return };
    let given = boxed(0.15);
    let grouped = given.grouped(ClusterSetting { tile: 8, ..ClusterSetting::default() });
    let twin = by_twins(&given, &grouped, LISTS, 0);
    let total = twin.lists.entries.len() as u32;
    let roomy = OnDevice::new(gpu, &given, &grouped, (SORTED, 0), Room { entries: total, spare: 100, ..ROOM }).unwrap();
    let ran = roomy.run();
    assert!(!ran.needs.exceed(&ran.sizes) && ran.needs.entries == total, "{:?}", ran.needs);
    assert!(ran.spare.iter().all(|&word| word == POISON));
    for gather in [LISTS, SORTED, QUEUE] {
        for entries in [1, 100, total / 2, total - 1] {
            let device =
                OnDevice::new(gpu, &given, &grouped, (gather, 0), Room { entries, spare: 4096, ..ROOM }).unwrap();
            let ran = device.run();
            assert!(ran.needs.exceed(&ran.sizes) && ran.needs.entries == total && !ran.needs.wrapped);
            assert!(ran.spare.len() == 4096 && ran.spare.iter().all(|&word| word == POISON), "{gather:?} {entries}");
            assert_eq!(ran.made.lists.entries.len(), entries as usize);
            assert!(ran.made.lists.entries.iter().all(|&photon| (photon as usize) < given.stages.photons.len()));
            device.reset();
            assert_eq!(device.run().needs.entries, total);
        }
    }
    // Clusters without buckets have no light, the others all of theirs
    let gather = of_buckets(BucketSetting::DEFAULT);
    let whole = by_twins(&given, &grouped, gather, 0);
    let (count, few) = (grouped.clusters.len() as u32, 20);
    let ran = OnDevice::new(gpu, &given, &grouped, (gather, 0), Room { clusters: few, ..ROOM }).unwrap().run();
    assert!(ran.needs.exceed(&ran.sizes) && ran.needs.clusters == count, "{:?}", ran.needs);
    assert_eq!(ran.made.buckets.words.len(), few as usize * 162);
    if exactness(gpu) == Exactness::Bits {
        assert_eq!(ran.made.buckets.words, whole.buckets.words[..few as usize * 162]);
        for (pixel, &cluster) in grouped.clusters.identifiers.iter().enumerate() {
            let expected = if cluster < few { whole.irradiance[pixel] } else { glam::Vec4::ZERO };
            assert_eq!(ran.made.irradiance[pixel], expected);
        }
    }
}
