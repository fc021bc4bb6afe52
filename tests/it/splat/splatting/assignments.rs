//! Lists against plain loops over all clusters and photons; irradiance over lists against the reference estimate.

use super::given::*;
use glam::Vec3;
use rtbench::workloads::splat::clusters::setting::*;
use rtbench::workloads::splat::setting::{Estimate, EstimateKernel, Form, Weight};
use rtbench::workloads::splat::splatting::counts::walked;
use rtbench::workloads::splat::splatting::lists;
use rtbench::workloads::splat::splatting::setting::{Gather, Order, Tasks};
use rtbench::workloads::splat::splatting::verify;
use rtbench::workloads::splat::verify::{Exactness, same};

const LISTS: Gather = Gather::PerSample { order: Order::Any, tasks: Tasks::Sample };

fn of(tile: u32) -> ClusterSetting {
    ClusterSetting { tile, ..ClusterSetting::default() }
}

/// Settings that change what a walk meets.
pub fn settings() -> Vec<ClusterSetting> {
    let small = of(8);
    vec![
        of(32),
        small,
        ClusterSetting { key: KeyOrder::Concat, ..small },
        ClusterSetting { unique: Unique::Sort, ..small },
        ClusterSetting { unique: Unique::Bits, space: Space::World, ..small },
        ClusterSetting { hierarchy: HierarchyBy::None, ..small },
        ClusterSetting { normals: Normals::Faces, ..of(16) },
        ClusterSetting { normals: Normals::Cells, unique: Unique::Sort, ..of(16) },
        ClusterSetting { normals: Normals::Cells, hierarchy: HierarchyBy::None, ..of(16) },
        ClusterSetting { normals: Normals::Faces, unique: Unique::Bits, ..of(4) },
    ]
}

/// Every cluster with every photon, coordinate by coordinate.
fn by_loops(given: &Given, grouped: &Grouped) -> Vec<Vec<u32>> {
    let radius = given.estimate.radius;
    let reach = if radius > 0.0 { radius + grouped.placement.margin } else { 0.0 };
    let along = |position: Vec3| {
        let way = (position - grouped.placement.origin).to_array();
        grouped.placement.axes.map(|axis| way[0] * axis.x + way[1] * axis.y + way[2] * axis.z)
    };
    let points: Vec<[f32; 3]> =
        given.stages.photons.positions.iter().map(|position| along(position.truncate())).collect();
    let near = |point: &[f32; 3], low: Vec3, high: Vec3| {
        let mut square = 0.0_f32;
        for axis in 0..3 {
            let outside = if point[axis] < low[axis] {
                point[axis] - low[axis]
            } else if point[axis] > high[axis] {
                point[axis] - high[axis]
            } else {
                0.0
            };
            square += outside * outside;
        }
        square < reach * reach
    };
    let list = |bounds: &rtbench::workloads::splat::clusters::Bounds| {
        (0..points.len() as u32).filter(|&photon| near(&points[photon as usize], bounds.min, bounds.max)).collect()
    };
    grouped.clusters.boxes.iter().map(list).collect()
}

fn found(given: &Given, grouped: &Grouped) -> Vec<Vec<u32>> {
    let walk = grouped.walk(given.estimate.radius, 5);
    let lists = lists::lists(pool(), &walk, &given.stages.photons).unwrap();
    let walked = walked(pool(), &walk, &given.stages.photons);
    assert_eq!(walked.assignments(), lists.entries.len() as u64);
    let all: Vec<Vec<u32>> = (0..lists.len()).map(|cluster| lists.of(cluster).to_vec()).collect();
    assert!(all.iter().zip(&walked.per_cluster).all(|(list, &count)| list.len() == count as usize));
    assert!(walked.cone_rejections == 0 || grouped.layout.bits[3] > 0);
    let all_tests = (grouped.clusters.len() * given.stages.photons.len()) as u64;
    match grouped.setting.hierarchy {
        HierarchyBy::None => assert_eq!(walked.box_tests, all_tests),
        HierarchyBy::Masks => assert!(walked.box_tests > 0),
    }
    all
}

#[test]
fn lists_are_those_of_plain_loops() {
    for given in [boxed(0.05), boxed(0.2), room(0.1)] {
        for setting in settings() {
            let grouped = given.grouped(setting);
            let (plain, found) = (by_loops(&given, &grouped), found(&given, &grouped));
            let total: usize = plain.iter().map(Vec::len).sum();
            assert!(total > 300, "{total}");
            if setting.normals == Normals::Off {
                assert!(plain == found, "{setting:?}");
                continue;
            }
            // Photons that every normal of a cluster faces away from are left out, and only those
            let (mut left_out, mut facing) = (0, vec![Vec::new(); plain.len()]);
            for (normal, &cluster) in given.stages.samples.normals.iter().zip(&grouped.clusters.identifiers) {
                if cluster != u32::MAX {
                    facing[cluster as usize].push(normal.truncate());
                }
            }
            for (cluster, list) in plain.iter().enumerate() {
                for photon in list.iter().filter(|photon| !found[cluster].contains(photon)) {
                    left_out += 1;
                    let direction = given.stages.photons.directions[*photon as usize].truncate();
                    assert!(facing[cluster].iter().all(|normal| -normal.dot(direction) <= 0.0), "{setting:?}");
                }
            }
            println!("{:?}: {left_out} of {total} face away", setting.normals);
            assert!(left_out > 0, "{setting:?}");
            let kept: usize = found.iter().map(Vec::len).sum();
            assert_eq!(kept + left_out, total);
        }
    }
}

#[test]
fn radii_at_both_ends() {
    let none = boxed(0.0);
    for setting in settings() {
        let grouped = none.grouped(setting);
        assert!(found(&none, &grouped).iter().all(Vec::is_empty), "{setting:?}");
    }
    let all = boxed(1.01);
    for setting in settings().into_iter().filter(|setting| setting.normals == Normals::Off) {
        let grouped = all.grouped(setting);
        let photons = all.stages.photons.len();
        assert!(found(&all, &grouped).iter().all(|list| list.len() == photons), "{setting:?}");
    }
}

#[test]
fn the_hierarchy_saves_tests() {
    let given = boxed(0.05);
    let tests = |setting| {
        let grouped = given.grouped(setting);
        walked(pool(), &grouped.walk(given.estimate.radius, 5), &given.stages.photons).box_tests
    };
    let [masks, none] =
        [HierarchyBy::Masks, HierarchyBy::None].map(|by| tests(ClusterSetting { hierarchy: by, ..of(4) }));
    println!("{masks} tests by nodes, {none} without");
    assert!(masks * 2 < none, "{masks} {none}");
}

/// No photon that counts is missing from a sample's list, and no other photon of the list adds anything.
#[test]
fn irradiance_is_the_references() {
    for given in [boxed(0.15), room(0.15)] {
        for (kernel, weight, form) in [
            (EstimateKernel::Epanechnikov, Weight::Side, Form::Normalised),
            (EstimateKernel::Constant, Weight::Cosine, Form::Normalised),
            (EstimateKernel::Epanechnikov, Weight::Cosine, Form::Source),
        ] {
            let given = given.with(Estimate { kernel, weight, form, ..given.estimate });
            let (samples, photons) = (&given.stages.samples, &given.stages.photons);
            let reference =
                rtbench::workloads::splat::estimate::irradiance(pool(), samples, photons, &given.estimate, ON);
            let reference = reference.unwrap();
            assert!(reference.iter().filter(|irradiance| irradiance.y > 0.0).count() > 300);
            for setting in settings() {
                let grouped = given.grouped(setting);
                let made = by_twins(&given, &grouped, LISTS, 0);
                let check = verify::irradiance(&made.irradiance, &reference, false, Exactness::Bits, given.size.width);
                assert!(check.ok, "{setting:?}: {}", check.message);
                // A list without one of its photons is noticed
                let mut faulty = made.lists.clone();
                let list = (0..faulty.len()).max_by_key(|&cluster| faulty.of(cluster).len()).unwrap();
                let first = faulty.offsets[list] as usize;
                let end = faulty.offsets[list + 1] as usize;
                let mut strangers = (first..end).filter(|&entry| {
                    let photon = faulty.entries[entry] as usize;
                    let near = |pixel: usize| {
                        let way = samples.positions[pixel].truncate() - photons.positions[photon].truncate();
                        grouped.clusters.identifiers[pixel] == list as u32
                            && way.length() < given.estimate.radius * 0.9
                            && -samples.normals[pixel].truncate().dot(photons.directions[photon].truncate()) > 0.1
                    };
                    (0..samples.positions.len()).any(near)
                });
                let Some(entry) = strangers.next_back() else { panic!("{setting:?}: no photon counts") };
                faulty.entries[entry] = faulty.entries[if entry > first { first } else { first + 1 }];
                let of = (samples, &grouped.clusters.identifiers[..]);
                let irradiance = rtbench::workloads::splat::splatting::per_sample::irradiance(
                    pool(),
                    of,
                    &faulty,
                    photons,
                    &given.estimate,
                    ON,
                );
                let check =
                    verify::irradiance(&irradiance.unwrap(), &reference, false, Exactness::Bits, given.size.width);
                assert!(!check.ok, "{setting:?}: {}", check.message);
            }
            let grouped = given.grouped(of(32));
            for tile in [4, 16, 33, 64] {
                let made = by_twins(&given, &grouped, Gather::Tiled, tile);
                let check = same("irradiance", "the reference's", &made.irradiance, &reference, given.size.width);
                assert!(check.ok, "tiles of {tile}: {}", check.message);
            }
        }
    }
}
