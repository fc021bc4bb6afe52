//! The reference's cache, whole and broken.

use super::scenes::{ON, cast_in, pool, room, room_camera};
use glam::{DVec3, Vec3};
use rtbench::workloads::size::Size;
use rtbench::workloads::splat::lit::LitScene;
use rtbench::workloads::splat::reference::cache::{key, path, path_traced, read, seal};
use rtbench::workloads::splat::reference::path_traced::{Effort, PathTraced, View, trace};
use std::fs;
use std::path::Path;

const SIZE: Size = Size { width: 16, height: 12 };
const PIXELS: [u32; 3] = [0, 100, 191];
const EFFORT: Effort = Effort { least: 8, most: 8, error: 0.0, seed: 0 };

fn view(lit: &LitScene) -> View<'_> {
    View { lit, camera: room_camera(), size: SIZE, pixels: &PIXELS, hits: 4 }
}

/// The result, its warnings, and whether it was traced; all by way of a folder.
fn ask(lit: &LitScene, folder: &Path) -> (PathTraced, Vec<String>, bool) {
    cast_in(lit, |caster| {
        // Tracing would be interrupted
        if let Ok((found, warnings)) = path_traced(pool(), folder, caster, &view(lit), EFFORT, &|| true) {
            return (found, warnings, false);
        }
        let (found, warnings) = path_traced(pool(), folder, caster, &view(lit), EFFORT, ON).unwrap();
        (found, warnings, true)
    })
}

#[test]
fn a_result_is_read_back_to_the_bit() {
    let (lit, folder) = (room(), tempfile::tempdir().unwrap());
    let folder = folder.path().join("new/folders");
    let straight = cast_in(&lit, |caster| trace(pool(), caster, &view(&lit), EFFORT, ON).unwrap());
    let bits = |v: &DVec3| v.to_array().map(f64::to_bits);
    for is_traced in [true, false, false] {
        let (found, warnings, was_traced) = ask(&lit, &folder);
        assert_eq!((found == straight, warnings.len(), was_traced), (true, 0, is_traced));
        assert!(found.irradiance.iter().map(bits).eq(straight.irradiance.iter().map(bits)));
        assert!(found.error.iter().map(bits).eq(straight.error.iter().map(bits)));
        assert_eq!(found.sum_error.to_bits(), straight.sum_error.to_bits());
    }
    let files: Vec<_> = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    assert_eq!(files, [path(&folder, &key(&view(&lit), EFFORT))]);
}

/// Files of earlier versions hold what the estimator of their number computes.
#[test]
fn another_estimator_needs_another_number() {
    let lit = room();
    let found = cast_in(&lit, |caster| trace(pool(), caster, &view(&lit), EFFORT, ON).unwrap());
    let expected = [
        [1.35790368306, 1.21285122559, 9.56944570578e-1],
        [1.03737271697, 9.12388076456e-1, 6.94676396816e-1],
        [3.85290130361e-1, 5.38158635552e-1, 2.39206397341e-1],
        [4.59996866382e-1, 4.13356628990e-1, 3.56686720559e-1],
        [2.67912629584e-1, 2.56527291876e-1, 2.21516566945e-1],
        [1.25963545432e-1, 7.27936684340e-2, 7.46996472257e-2],
        [9.26855510133e-1, 8.87799312532e-1, 6.30275788245e-1],
        [1.82343116419e-1, 1.63967772027e-1, 1.42156034518e-1],
    ]
    .map(DVec3::from);
    let all: Vec<DVec3> = [&found.irradiance[..], &found.error, &[found.mean, found.mean_error]].concat();
    let off = |(found, expected): (&DVec3, &DVec3)| ((*found - *expected) / *expected).abs().max_element();
    let worst = all.iter().zip(&expected).map(off).fold(0.0, f64::max);
    let same =
        all.len() == expected.len() && worst < 1.0e-10 && (found.sum_error / 4.84045462122e-1 - 1.0).abs() < 1.0e-10;
    assert!(
        same,
        "the path tracer changed: raise the number in the cache's MAGIC, then change it and these: {found:?}"
    );
    assert!(seal("key", b"{}").starts_with(b"rtbench path-traced 1 key "), "the numbers above belong to version 1");
    // Another stream of random numbers is no such result
    let other = Effort { seed: 1, ..EFFORT };
    let other = cast_in(&lit, |caster| trace(pool(), caster, &view(&lit), other, ON).unwrap());
    assert!(off((&other.mean, &expected[6])) > 1.0e-3);
}

#[test]
fn what_decides_a_result_is_in_its_key() {
    let lit = room();
    let view = view(&lit);
    let mut moved = lit.clone();
    moved.lights[0].position.x += 1.0e-6;
    let mut brighter = lit.clone();
    brighter.lights[0].flux.z *= 1.000_001;
    let mut coloured = lit.clone();
    let mut scene = (*coloured.scene).clone();
    scene.materials[1].diffuse.y = 0.61;
    coloured.scene = scene.into();
    let mut wider = lit.clone();
    wider.extent.max *= 100.0;
    let camera = room_camera();
    let turned = rtbench::camera::Camera { up: Vec3::X, ..camera };
    let narrow = rtbench::camera::Camera { field_of_view: 59.0, ..camera };
    let views = [
        view,
        View { lit: &moved, ..view },
        View { lit: &brighter, ..view },
        View { lit: &coloured, ..view },
        View { lit: &wider, ..view },
        View { camera: turned, ..view },
        View { camera: narrow, ..view },
        View { size: Size { width: 12, height: 16 }, ..view },
        View { pixels: &[0, 100], ..view },
        View { hits: 5, ..view },
    ];
    let mut keys: Vec<String> = views.iter().map(|view| key(view, EFFORT)).collect();
    keys.push(key(&view, Effort { least: 4, ..EFFORT }));
    keys.push(key(&view, Effort { most: 16, ..EFFORT }));
    keys.push(key(&view, Effort { error: 0.1, ..EFFORT }));
    keys.push(key(&view, Effort { seed: 1, ..EFFORT }));
    assert_eq!(key(&view, EFFORT), keys[0]);
    keys.sort();
    keys.dedup();
    assert_eq!(keys.len(), 14);
}

#[test]
fn every_broken_file_is_noticed() {
    let (lit, folder) = (room(), tempfile::tempdir().unwrap());
    ask(&lit, folder.path());
    let key = key(&view(&lit), EFFORT);
    let file = path(folder.path(), &key);
    let whole = fs::read(&file).unwrap();
    assert!(read(&whole, &key, &PIXELS).is_ok());
    for end in 0..whole.len() {
        assert!(read(&whole[..end], &key, &PIXELS).is_err(), "cut off at {end}");
    }
    for at in 0..whole.len() {
        for flip in [1, 0x80, 0xff] {
            let mut broken = whole.clone();
            broken[at] ^= flip;
            assert!(read(&broken, &key, &PIXELS).is_err(), "byte {at}, {flip:#x}");
        }
    }
    assert!(read(&[&whole[..], b" "].concat(), &key, &PIXELS).is_err());
    assert!(read(&whole, &key.replace('a', "b"), &PIXELS).is_err());
    // Broken on disk: a warning, the same result, and the file is whole again
    for broken in [&b""[..], &whole[..whole.len() / 2], b"foreign\n{}", &[0xff; 300], &vec![b'x'; 1 << 20]] {
        fs::write(&file, broken).unwrap();
        let (found, warnings, was_traced) = ask(&lit, folder.path());
        assert!(was_traced && found == read(&whole, &key, &PIXELS).unwrap());
        assert!(warnings.len() == 1 && warnings[0].contains("is traced again"), "{warnings:?}");
        assert!(!warnings[0].contains('\n'));
        assert_eq!(fs::read(&file).unwrap(), whole);
    }
}

/// With a right checksum, as nothing but a forger writes it.
#[test]
fn a_sealed_file_is_checked_too() {
    let lit = room();
    let key = key(&view(&lit), EFFORT);
    let good = cast_in(&lit, |caster| trace(pool(), caster, &view(&lit), EFFORT, ON).unwrap());
    let json = serde_json::to_string(&good).unwrap();
    assert_eq!(read(&seal(&key, json.as_bytes()), &key, &PIXELS).unwrap(), good);
    let mut wrong: Vec<PathTraced> = vec![good.clone(); 6];
    wrong[0].pixels[1] += 1;
    wrong[1].irradiance.pop();
    wrong[2].error.push(DVec3::ZERO);
    wrong[3].paths = 1;
    wrong[4].mean.y = -1.0;
    wrong[5].sum_error = f64::NAN;
    let mut texts: Vec<String> = wrong.iter().map(|wrong| serde_json::to_string(wrong).unwrap()).collect();
    texts.extend(["", "{}", "null", "[1e999]"].map(String::from));
    texts.push(json.replacen("\"mean\":[", "\"mean\":[1e999", 1));
    texts.push(json.replacen('{', "{\"more\":1,", 1));
    texts.push("[".repeat(100_000));
    for text in texts {
        let found = read(&seal(&key, text.as_bytes()), &key, &PIXELS);
        assert!(found.is_err(), "{text}");
        assert!(!found.unwrap_err().contains('\n'));
    }
}

#[test]
fn a_folder_that_cannot_be_used_is_a_warning() {
    let (lit, folder) = (room(), tempfile::tempdir().unwrap());
    // A file in place of the folder
    let taken = folder.path().join("taken");
    fs::write(&taken, "").unwrap();
    let (_, warnings, was_traced) = ask(&lit, &taken);
    assert!(was_traced && warnings.len() == 1 && warnings[0].contains("is not kept"), "{warnings:?}");
    // A folder in place of the file
    let file = path(folder.path(), &key(&view(&lit), EFFORT));
    fs::create_dir(&file).unwrap();
    let (_, warnings, was_traced) = ask(&lit, folder.path());
    assert!(was_traced && warnings.len() == 2, "{warnings:?}");
}
