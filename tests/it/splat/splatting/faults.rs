//! What is planted into lists, buckets and images, and found.

use super::given::*;
use glam::Vec4;
use rtbench::device::POISON;
use rtbench::record::row::Check;
use rtbench::workloads::splat::clusters::setting::ClusterSetting;
use rtbench::workloads::splat::setting::{Estimate, Weight};
use rtbench::workloads::splat::splatting::setting::*;
use rtbench::workloads::splat::splatting::verify;
use rtbench::workloads::splat::splatting::{Buckets, Lists};
use rtbench::workloads::splat::verify::Exactness;

const SORTED: Gather = Gather::PerSample { order: Order::Sorted, tasks: Tasks::Sample };

fn passes(checks: &[Check]) -> bool {
    checks.iter().all(|check| check.ok)
}

/// A view with many photons in every list.
fn full() -> (Given, Grouped) {
    let given = boxed(0.2);
    let grouped = given.grouped(ClusterSetting { tile: 16, ..ClusterSetting::default() });
    (given, grouped)
}

/// Its name, and the change.
type Planted<T> = (&'static str, fn(&mut T));

#[test]
fn faults_in_lists_are_found() {
    let (given, grouped) = full();
    let right = by_twins(&given, &grouped, SORTED, 0).lists;
    let check = |found: &Lists, order| verify::lists(found, &right, order, Exactness::Bits);
    assert!(passes(&check(&right, Order::Sorted)) && passes(&check(&right, Order::Any)));
    let mut other = right.clone();
    other.entries.swap(0, 1);
    assert!(passes(&check(&other, Order::Any)), "the order of a list is free");
    assert!(!passes(&check(&other, Order::Sorted)));

    let faults: [Planted<Lists>; 7] = [
        ("lost", |lists| {
            lists.entries.remove(5);
            lists.offsets.iter_mut().skip(1).for_each(|offset| *offset -= 1);
        }),
        ("lost, and another one doubled", |lists| lists.entries[5] = lists.entries[6]),
        ("doubled", |lists| {
            lists.entries.insert(5, lists.entries[5]);
            lists.offsets.iter_mut().skip(1).for_each(|offset| *offset += 1);
        }),
        ("an offset", |lists| lists.offsets[2] += 1),
        ("the last offset", |lists| *lists.offsets.last_mut().unwrap() -= 1),
        ("poison", |lists| lists.entries[7] = POISON),
        ("a cluster less", |lists| lists.offsets.truncate(3)),
    ];
    for (name, fault) in faults {
        for order in [Order::Any, Order::Sorted] {
            let mut faulty = right.clone();
            fault(&mut faulty);
            assert!(!passes(&check(&faulty, order)), "{name} {order:?}");
        }
    }
}

#[test]
fn a_photon_that_moved_is_found() {
    let given = boxed(0.2);
    let grouped = given.grouped(ClusterSetting { tile: 4, ..ClusterSetting::default() });
    let right = by_twins(&given, &grouped, SORTED, 0);
    let (samples, photons) = (&given.stages.samples.positions, &given.stages.photons.positions);
    let step = given.estimate.radius / 100.0;
    let (mut of_lists, mut of_images) = (0, 0);
    for pixel in (0..8).map(|n| n * samples.len() / 8 + 30) {
        // The photon nearest to a sample counts there
        let far = |photon: &usize| (photons[*photon] - samples[pixel]).truncate().length_squared();
        let photon = (0..photons.len()).min_by(|a, b| far(a).total_cmp(&far(b))).unwrap();
        for axis in 0..3 {
            let mut moved = given.with(given.estimate);
            moved.stages.photons.positions[photon][axis] += step;
            let other = by_twins(&moved, &grouped, SORTED, 0);
            let lists = verify::lists(&other.lists, &right.lists, Order::Any, Exactness::Bits);
            of_lists += u32::from(!passes(&lists));
            let image = verify::irradiance(&other.irradiance, &right.irradiance, false, Exactness::Bits, 67);
            of_images += u32::from(!image.ok);
        }
    }
    // Not every step enters or leaves a box
    println!("of 24 steps, {of_lists} change lists and {of_images} the image");
    assert!(of_lists >= 3 && of_images >= 16, "{of_lists} {of_images}");
}

#[test]
fn faults_in_buckets_are_found() {
    let (given, grouped) = full();
    let faults: [Planted<Buckets>; 6] = [
        ("a bucket off by one", |buckets| {
            let at = buckets.words.iter().position(|&word| word > 0).unwrap();
            let first = at - at % 3;
            (0..3).for_each(|channel| buckets.words.swap(first + channel, first + 3 + channel));
        }),
        ("channels swapped", |buckets| {
            buckets.words.chunks_exact_mut(3).for_each(|words| words.swap(0, 2));
        }),
        ("a word less", |buckets| buckets.words.truncate(161)),
        ("poison", |buckets| buckets.words[17] = POISON),
        ("nothing", |buckets| buckets.words.fill(0)),
        ("all poison", |buckets| buckets.words.fill(POISON)),
    ];
    for atomics in [Atomics::Fixed, Atomics::Exchange] {
        let gather = Gather::Buckets(BucketSetting { atomics, ..BucketSetting::DEFAULT });
        let right = by_twins(&given, &grouped, gather, 0).buckets;
        let check = |found: &Buckets| verify::buckets(found, &right, atomics, Exactness::Bits);
        assert!(passes(&check(&right)));
        for (name, fault) in faults {
            let mut faulty = right.clone();
            fault(&mut faulty);
            assert!(!passes(&check(&faulty)), "{name} {atomics:?}");
            let close = verify::buckets(&faulty, &right, atomics, Exactness::Close);
            assert!(!passes(&close) || ["poison", "a bucket off by one"].contains(&name), "{name} {atomics:?}: close");
        }
    }
    let gather = Gather::Buckets(BucketSetting::DEFAULT);
    let right = by_twins(&given, &grouped, gather, 0).buckets;
    let mut faulty = right.clone();
    *faulty.words.iter_mut().max().unwrap() += 1;
    assert!(!passes(&verify::buckets(&faulty, &right, Atomics::Fixed, Exactness::Bits)));
    let mut faulty = right.clone();
    faulty.scale *= 1.01;
    assert!(!passes(&verify::buckets(&faulty, &right, Atomics::Fixed, Exactness::Close)));
    assert!(right.words.iter().max() > Some(&1000), "{:?}", right.words.iter().max());
}

#[test]
fn faults_in_images_are_found() {
    let (given, grouped) = full();
    let right = by_twins(&given, &grouped, SORTED, 0).irradiance;
    let lit = right.iter().position(|irradiance| irradiance.y > 0.0).unwrap();
    let check = |found: &[Vec4], repeatable| verify::irradiance(found, &right, repeatable, Exactness::Bits, 67).ok;
    let mean = right.iter().map(|irradiance| irradiance.y).sum::<f32>() / right.len() as f32;
    assert!(check(&right, true) && check(&right, false));
    let mut next = right.clone();
    next[lit].y = f32::from_bits(next[lit].y.to_bits() + 1);
    assert!(!check(&next, true) && check(&next, false));
    for value in [right[lit].y + mean * 1e-4, f32::NAN, f32::from_bits(POISON), f32::INFINITY, -1.0] {
        let mut faulty = right.clone();
        faulty[lit].y = value;
        assert!(!check(&faulty, true) && !check(&faulty, false), "{value}");
    }
    assert!(!check(&right[1..], false));
    // The other weight of directions
    let other = given.with(Estimate { weight: Weight::Cosine, ..given.estimate });
    let other = by_twins(&other, &grouped, SORTED, 0).irradiance;
    assert!(!check(&other, false));
    assert!(!verify::irradiance(&other, &right, true, Exactness::Close, 67).ok);
}
