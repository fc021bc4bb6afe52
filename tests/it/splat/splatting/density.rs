//! Buckets against what they count by geometry: all photons that touch a box, not those that are near a sample.

use super::super::support::Random;
use super::given::{ON, pool};
use glam::{Vec3, Vec4};
use rtbench::workloads::size::Size;
use rtbench::workloads::splat::clusters::setting::ClusterSetting;
use rtbench::workloads::splat::clusters::{Bounds, Clusters, KeyLayout, Placement};
use rtbench::workloads::splat::photons::Photons;
use rtbench::workloads::splat::random::{cosine_direction, unit_vector};
use rtbench::workloads::splat::samples::Samples;
use rtbench::workloads::splat::setting::{Estimate, EstimateKernel, Form, Weight};
use rtbench::workloads::splat::splatting::setting::{BucketSetting, Share};
use rtbench::workloads::splat::splatting::walk::Walk;
use rtbench::workloads::splat::splatting::{buckets, lists};
use std::f64::consts::PI;

const RADIUS: f32 = 0.1;

fn estimate(kernel: EstimateKernel, form: Form) -> Estimate {
    Estimate { kernel, weight: Weight::Side, form, radius: RADIUS }
}

/// A cluster for each box, whose sample is at its centre.
fn clusters(boxes: &[(Vec3, Vec3)], normals: &[Vec3]) -> (Clusters, Samples) {
    let numbers: Vec<u32> = (0..boxes.len() as u32).collect();
    let positions: Vec<Vec4> = boxes.iter().map(|(min, max)| ((*min + *max) * 0.5).extend(1.0)).collect();
    let samples = Samples {
        positions: positions.clone(),
        normals: normals.iter().map(|normal| normal.extend(0.0)).collect(),
        albedos: vec![Vec4::ONE; boxes.len()],
    };
    let clusters = Clusters {
        positions,
        keys: numbers.clone(),
        identifiers: numbers.clone(),
        cluster_keys: numbers,
        boxes: boxes.iter().map(|&(min, max)| Bounds { min, max }).collect(),
        nodes: None,
    };
    (clusters, samples)
}

/// Irradiance of each sample by buckets.
fn irradiance(
    (clusters, samples): &(Clusters, Samples),
    photons: &Photons,
    setting: BucketSetting,
    estimate: Estimate,
) -> Vec<Vec4> {
    let size = Size { width: 64, height: 64 };
    let layout = KeyLayout::new(&ClusterSetting::default(), size, 60.0, (0.01, 100.0)).unwrap();
    let placement = Placement { origin: Vec3::ZERO, axes: [Vec3::X, Vec3::Y, Vec3::Z], margin: 0.0 };
    let walk = Walk::new(clusters, &layout, &placement, estimate.radius, 5).unwrap();
    let lists = lists::lists(pool(), &walk, photons).unwrap();
    let found = buckets::fill(pool(), &walk, &lists, photons, &setting, &estimate);
    buckets::irradiance(pool(), samples, clusters, &found, (&setting, &estimate), ON).unwrap()
}

/// Photons on the plane y = 0 around the origin, one in each cell of a lattice, that come from above.
fn rain(half: f32, cells: usize) -> Photons {
    let mut random = Random(7);
    let mut place = |cell: usize| (cell as f32 + random.below(1 << 20) as f32 / (1 << 20) as f32) / cells as f32;
    let at = |index: usize| {
        let (x, z) = (place(index % cells), place(index / cells));
        Vec4::new((x * 2.0 - 1.0) * half, 0.0, (z * 2.0 - 1.0) * half, 2.0)
    };
    let count = cells * cells;
    let area = 4.0 * half * half;
    Photons {
        positions: (0..count).map(at).collect(),
        directions: vec![-Vec4::Y; count],
        // One unit of flux per area
        fluxes: vec![Vec4::new(1.0, 2.0, 0.5, 0.0) * (area / count as f32); count],
    }
}

#[test]
fn a_flat_cluster_counts_the_area_around_it_too() {
    for s in [0.1_f32, 0.3, 1.0, 2.0] {
        let side = s * RADIUS;
        let flat = Vec3::new(side, 0.0, side) * 0.5;
        let photons = rain(side * 0.5 + RADIUS * 1.1, 400);
        let one = clusters(&[(-flat, flat)], &[Vec3::Y]);
        let all =
            irradiance(&one, &photons, BucketSetting::DEFAULT, estimate(EstimateKernel::default(), Form::Normalised));
        let s = f64::from(s);
        let expected = 1.0 + 4.0 * s / PI + s * s / PI;
        // Straight down into the sample's normal: the factor is 2 exactly
        let found = f64::from(all[0].x) / 2.0;
        println!("side {s} r: {found:.4}, by area {expected:.4}");
        assert!((found / expected - 1.0).abs() < 0.02, "{s}: {found} {expected}");
        assert!((all[0].y / all[0].x - 2.0).abs() < 1e-3 && (all[0].z / all[0].x - 0.5).abs() < 1e-3);
        // The source's form leaves the area out
        let source =
            irradiance(&one, &photons, BucketSetting::DEFAULT, estimate(EstimateKernel::default(), Form::Source));
        let ratio = source[0].x / all[0].x / (std::f32::consts::PI * RADIUS * RADIUS);
        assert!((ratio - 1.0).abs() < 1e-5, "{ratio}");
        // With the kernel of the distance to the centre there is no such factor
        for kernel in [EstimateKernel::Epanechnikov, EstimateKernel::Constant] {
            let setting = BucketSetting { share: Share::Centre, ..BucketSetting::DEFAULT };
            let found = irradiance(&one, &photons, setting, estimate(kernel, Form::Normalised))[0].x / 2.0;
            println!("    by its centre, {kernel:?}: {found:.4}");
            assert!((found - 1.0).abs() < 0.02, "{s} {kernel:?}: {found}");
        }
    }
}

/// Light from all around, as each point of an integrating sphere gets it: 1.31 times the irradiance, for the factor of
/// two cosines has the mean 4/3, and 54 directions change it.
#[test]
fn uniform_light_counts_too_much() {
    let tiny = Vec3::splat(1e-6);
    let normals: Vec<Vec3> = (0..60).map(|n| unit_vector(3, n, 0).into()).collect();
    // A cluster for each normal, far from the others, with photons around it
    let places: Vec<Vec3> = (0..60).map(|n| Vec3::new(n as f32, 0.0, 0.0)).collect();
    let boxes: Vec<(Vec3, Vec3)> = places.iter().map(|&place| (place - tiny, place + tiny)).collect();
    let all = clusters(&boxes, &normals);
    let count = 20_000;
    let mut photons = Photons::default();
    for (number, (&place, &normal)) in places.iter().zip(&normals).enumerate() {
        let side = normal.any_orthonormal_vector();
        let other = normal.cross(side);
        for photon in 0..count {
            // Uniform over a disc that is larger than the radius, by a spiral
            let part = (photon as f32 + 0.5) / count as f32;
            let (sine, cosine) = (photon as f32 * 2.399_963_2).sin_cos();
            let far = 1.2 * RADIUS * part.sqrt();
            let from = cosine_direction(normal.into(), unit_vector(number as u32, photon, 1));
            photons.positions.push((place + (side * cosine + other * sine) * far).extend(2.0));
            photons.directions.push((-from).extend(0.0));
            photons.fluxes.push(Vec4::new(1.0, 1.0, 1.0, 0.0));
        }
    }
    let density = f64::from(count) / (PI * (1.2 * f64::from(RADIUS)).powi(2));
    let estimate = estimate(EstimateKernel::default(), Form::Normalised);
    let ratio = |share: Share| {
        let found = irradiance(&all, &photons, BucketSetting { share, ..BucketSetting::DEFAULT }, estimate);
        let ratios: Vec<f64> = found.iter().map(|found| f64::from(found.x) / density).collect();
        assert!(ratios.iter().all(|ratio| (ratio - 1.306).abs() < 0.04), "{ratios:?}");
        ratios.iter().sum::<f64>() / ratios.len() as f64
    };
    for share in [Share::All, Share::Centre] {
        let ratio = ratio(share);
        println!("{share:?}: {ratio:.4}");
        assert!((ratio - 1.31).abs() < 0.03, "{ratio}");
    }
}
