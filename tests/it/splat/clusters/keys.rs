//! Keys against their parts, slices against their formula.

use super::support::*;
use glam::Vec3A;
use rayon::prelude::*;
use rtbench::device::CpuDevice;
use rtbench::workloads::size::Size;
use rtbench::workloads::splat::clusters::setting::{ClusterSetting, KeyOrder, Normals, Unique};
use rtbench::workloads::splat::clusters::{KeyLayout, NONE, keys};
use rtbench::workloads::splat::directions;

const ORDERS: [KeyOrder; 2] = [KeyOrder::Morton, KeyOrder::Concat];

#[test]
fn keys_round_trip() {
    let usual = ClusterSetting::default();
    let mut layouts = ORDERS.map(|key| layout(&ClusterSetting { key, ..usual }, 1920, 1080, DEPTHS)).to_vec();
    for key in ORDERS {
        for (tile, normals, width, height) in
            [(16, Normals::Off, 1920, 1080), (16, Normals::Cells, 480, 270), (4, Normals::Faces, 1, 1)]
        {
            layouts.push(layout(&ClusterSetting { tile, normals, key, ..usual }, width, height, DEPTHS));
        }
    }
    assert_eq!(layouts[0].bits, [7, 7, 9, 0]);
    assert!(layouts.iter().any(|layout| layout.bits[3] == 6) && layouts.iter().any(|layout| layout.key_bits() > 23));
    for (index, layout) in layouts.iter().enumerate() {
        // All keys of the source's, a part of the others
        let step = if index < 2 { 1 } else { 37 };
        (0..1_u32 << layout.key_bits()).into_par_iter().step_by(step).for_each(|key| {
            let [column, row, slice, normal] = layout.decode(key);
            for (part, bits) in [column, row, slice, normal].into_iter().zip(layout.bits) {
                assert!(part >> bits == 0, "{key}: {part}");
            }
            assert_eq!(layout.encode(column, row, slice, normal), key);
        });
    }
}

#[test]
fn slices_are_as_deep_as_their_tile_is_high() {
    for (tile, width, height, field_of_view) in
        [(32, 1920, 1080, 60.0_f32), (8, 480, 270, 60.0), (64, 1920, 1080, 90.0), (13, 333, 100, 40.0)]
    {
        let setting = ClusterSetting { tile, ..ClusterSetting::default() };
        let layout = KeyLayout::new(&setting, Size { width, height }, field_of_view, DEPTHS).unwrap();
        let borders: Vec<f64> = layout.borders(field_of_view).into_iter().map(f64::from).collect();
        assert_eq!(borders[0] as f32, DEPTHS.0);
        let half = (f64::from(field_of_view).to_radians() / 2.0).tan();
        for pair in borders.windows(2) {
            let high = 2.0 * half * pair[0] * f64::from(tile) / f64::from(height);
            assert!(((pair[1] - pair[0]) / high - 1.0).abs() < 1e-5, "{} from {} to {}", high, pair[0], pair[1]);
        }
        let last = borders[borders.len() - 1];
        assert!(last <= f64::from(DEPTHS.1) && last * (borders[1] / borders[0]) > f64::from(DEPTHS.1) * 0.9999);
        // A border belongs to the slice that begins there
        let borders = layout.borders(field_of_view);
        for (slice, &border) in borders.iter().enumerate() {
            assert_eq!(keys::slice_of(&borders, border), slice as u32);
            assert_eq!(keys::slice_of(&borders, border.next_down()), (slice as u32).saturating_sub(1));
        }
        assert_eq!(keys::slice_of(&borders, f32::MIN_POSITIVE), 0);
        assert_eq!(keys::slice_of(&borders, f32::MAX) as usize, borders.len() - 1);
    }
}

#[test]
fn a_key_tells_tile_slice_and_normal_of_its_pixel() {
    let cpu = CpuDevice::new(2).unwrap();
    for (tile, normals, key) in [
        (8, Normals::Off, KeyOrder::Morton),
        (13, Normals::Faces, KeyOrder::Concat),
        (32, Normals::Cells, KeyOrder::Morton),
    ] {
        let setting = ClusterSetting { tile, normals, key, ..ClusterSetting::default() };
        let layout = layout(&setting, 133, 71, DEPTHS);
        let camera = slanted();
        let samples = samples_of(Scene::Random(3), &camera, &layout);
        let found = on_cpu(&cpu, &setting, &layout, &camera, &samples);
        let borders = layout.borders(camera.field_of_view);
        let mut there = 0;
        for (pixel, &key) in found.keys.iter().enumerate() {
            let (position, normal) = (samples.positions[pixel], Vec3A::from_vec4(samples.normals[pixel]));
            if position.w == 0.0 {
                assert_eq!((key, found.identifiers[pixel], found.positions[pixel].w), (NONE, NONE, 0.0));
                continue;
            }
            there += 1;
            let [column, row, slice, index] = layout.decode(key);
            assert_eq!((column, row), (pixel as u32 % 133 / tile, pixel as u32 / 133 / tile));
            let slice = slice as usize;
            assert!(slice == 0 || borders[slice] <= position.w);
            assert!(slice + 1 == borders.len() || position.w < borders[slice + 1]);
            let expected = match normals {
                Normals::Off => 0,
                Normals::Faces => directions::face(normal),
                Normals::Cells => directions::direction_index(normal),
            };
            assert_eq!(index, expected);
            // A rigid frame keeps distances, and its third axis is the depth
            let placed = found.positions[pixel];
            let way = (position - camera.position.extend(0.0)).truncate().length();
            assert!((placed.truncate().length() / way - 1.0).abs() < 1e-5);
            assert!((placed.z / placed.w - 1.0).abs() < 1e-4, "{placed}");
        }
        assert!(there > 8000, "{there}");
    }
}

#[test]
fn too_much_to_sort_is_refused() {
    let setting =
        ClusterSetting { tile: 64, unique: Unique::Sort, normals: Normals::Cells, ..ClusterSetting::default() };
    let size = Size { width: 1, height: 64 };
    // 14 bits for slices, 6 for normals, 12 for places
    let text = KeyLayout::new(&setting, size, 0.05, (1.0, 1e6)).unwrap_err().to_string();
    assert!(text.contains("are 32, at most 31") && text.contains("--unique"), "{text}");
    assert!(KeyLayout::new(&ClusterSetting { unique: Unique::Bits, ..setting }, size, 0.05, (1.0, 1e6)).is_ok());
    assert!(KeyLayout::new(&setting, size, 0.1, (1.0, 1e6)).is_ok());
}
