//! How fast scenes are read: `cargo bench --bench load`; RTBENCH_SCENES names the folder with the real scenes.
//!
//! For every format the largest file below that folder: megabytes per second on one core. Files that it includes are
//! read, but not counted. Where that file is small, most of the time goes into opening it and into curved surfaces; so
//! a large mesh is written in that format and read as well. Triangles per second tell what a file is bound by: a line
//! that says `s`, a sphere, becomes hundreds of them, so that of many spheres (as in Haines's SPD, `balls`) few
//! megabytes are read in the time in which most triangles are made. Then the bar of the cache: the same scene from its
//! source and from its `.rtb`, in turns, and the median of the ratios; for files of a megabyte or more, since others
//! load at once.

mod common;

use common::median;
use rtbench::record::statistics::sign_test_interval;
use rtbench::scene::cache::{self, Sources};
use rtbench::scene::{FORMATS, Options, load};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::time::Instant;

fn main() {
    let scratch = std::env::temp_dir().join(format!("rtbench-load-{}", std::process::id()));
    std::fs::create_dir_all(&scratch).expect("a folder for caches");
    if !common::measuring() {
        println!("only a test that this runs: use cargo bench --bench load");
        let scan = scratch.join("scan.rtb");
        let scene = common::scan(1000);
        cache::write(&scene, &Sources::default(), &scan).expect("written");
        interleaved("scan", &[("cache", &scan)], 3);
    } else {
        let files = files();
        println!("{:<12} {:>9} {:>22} {:>11}  file", "format", "MB", "MB/s (95 % of rounds)", "Mtriangle/s");
        for (extension, path) in &files {
            throughput(extension, path);
        }
        for (extension, path) in made(&scratch) {
            throughput(extension, &path);
        }
        let large = |path: &Path| path.metadata().is_ok_and(|m| m.len() >= 1_000_000);
        for (extension, path) in files.iter().filter(|(_, path)| large(path)) {
            let cached = scratch.join(format!("{extension}.rtb"));
            let what = path.to_str().expect("a printable path");
            let (scene, sources) = cache::load(what, None).expect("loads");
            cache::write(&scene, &sources, &cached).expect("written");
            interleaved(what, &[("source", path), ("cache", &cached)], 11);
        }
    }
    std::fs::remove_dir_all(&scratch).expect("removed");
}

/// The largest file of each format that its reader takes: fixtures may be broken.
fn files() -> BTreeMap<String, PathBuf> {
    let Some(folder) = common::scenes_folder() else {
        eprintln!("nothing to measure: RTBENCH_SCENES is not set");
        return BTreeMap::new();
    };
    let mut found: Vec<(u64, PathBuf)> = Vec::new();
    let mut folders = vec![folder];
    while let Some(folder) = folders.pop() {
        for path in std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()) {
            match path.metadata() {
                Ok(metadata) if metadata.is_dir() => folders.push(path),
                Ok(metadata) => found.push((metadata.len(), path)),
                Err(error) => eprintln!("{} is left out: {error}", path.display()),
            }
        }
    }
    found.sort_by(|a, b| b.cmp(a));
    let mut largest = BTreeMap::new();
    for (_, path) in found {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        let reader = FORMATS.iter().find(|(name, ..)| *name == extension).map(|(_, reader, _)| reader);
        if reader.is_some_and(|reader| !largest.contains_key(&extension) && reader(&path, &Options::default()).is_ok())
        {
            largest.insert(extension, path);
        }
    }
    largest
}

/// The same mesh in the formats whose real files are small, and many spheres.
fn made(folder: &Path) -> Vec<(&'static str, PathBuf)> {
    let scene = common::scan(100_000);
    let point = |v: u32| scene.vertices[v as usize].position;
    let line = |v: u32| format!("{} {} {}\n", point(v).x, point(v).y, point(v).z);
    let polygons: String = scene.triangles.iter().map(|t| format!("p 3\n{}", t.vertices.map(line).concat())).collect();
    let points: String = (0..scene.vertices.len() as u32).map(line).collect();
    let indices: String = scene
        .triangles
        .iter()
        .map(|t| format!("{}, {}, {}, -1,\n", t.vertices[0], t.vertices[1], t.vertices[2]))
        .collect();
    let nodes = format!(
        "Separator {{ Coordinate3 {{ point [ {} ] }} IndexedFaceSet {{ coordIndex [ {indices} ] }} }}\n",
        points.replace('\n', ",\n")
    );
    let view = "v\nfrom 0 0 -5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 0.1\nresolution 64 64\n";
    let material = "f 1 0 0 0.5 0.5 10 0 1\n";
    let files = [
        ("scan", "nff", format!("{view}{material}{polygons}")),
        ("balls", "nff", format!("{view}{material}{}", balls(3))),
        ("scan", "iv", format!("#Inventor V2.1 ascii\n{nodes}")),
        ("scan", "wrl", format!("#VRML V1.0 ascii\n{nodes}")),
    ];
    let write = |(name, extension, text): (&str, &'static str, String)| {
        let path = folder.join(format!("{name}.{extension}"));
        std::fs::write(&path, text).expect("written");
        (extension, path)
    };
    files.map(write).into()
}

/// A sphere with nine around it, and so on, as in `balls` of Haines's SPD: 820 for a depth of three. (There they are
/// turned so that they touch; a reader does not care. The 7381 of the next depth would be more triangles than a file of
/// this size may become.)
fn balls(depth: u32) -> String {
    fn add(text: &mut String, [x, y, z]: [f64; 3], radius: f64, depth: u32) {
        writeln!(text, "s {x:.6} {y:.6} {z:.6} {radius:.6}").expect("a string takes all");
        for i in (0..9).filter(|_| depth > 0) {
            let (sine, cosine) = (std::f64::consts::TAU * f64::from(i % 6) / 6.0).sin_cos();
            let (out, up) = if i < 6 { (1.3, 0.2) } else { (0.8, 1.0) };
            let center = [x + radius * out * cosine, y + radius * out * sine, z + radius * up];
            add(text, center, radius / 3.0, depth - 1);
        }
    }
    let mut text = String::new();
    add(&mut text, [0.0; 3], 0.5, depth);
    text
}

/// The reader alone, on one thread.
fn throughput(extension: &str, path: &Path) {
    let (_, reader, _) = FORMATS.iter().find(|(name, ..)| *name == extension).expect("a known format");
    let megabytes = path.metadata().expect("is here").len() as f64 / 1e6;
    let options = Options::default();
    let triangles = reader(path, &options).expect("reads").triangles.len() as f64 / 1e6;
    let rate = |_| {
        let start = Instant::now();
        black_box(reader(path, &options).expect("reads"));
        megabytes / start.elapsed().as_secs_f64()
    };
    // A small file is read some megabytes long: the first times are not those of the reader
    let rounds = (5.0 / megabytes).clamp(15.0, 1000.0) as usize;
    let rates: Vec<f64> = common::pool(1).install(|| (0..rounds).map(rate).collect());
    let (low, high) = sign_test_interval(&rates).expect("a round");
    let (rate, file) = (median(&rates), path.display());
    let interval = format!("{rate:.1} ({low:.1} to {high:.1})");
    println!("{extension:<12} {megabytes:>9.4} {interval:>22} {:>11.1}  {file}", triangles / megabytes * rate);
}

/// Loads each in turns and compares with the first.
fn interleaved(name: &str, contestants: &[(&str, &Path)], rounds: usize) {
    let timed = |path: &Path| {
        let what = path.to_str().expect("a printable path").to_owned();
        move || {
            let start = Instant::now();
            black_box(load(&what).expect("loads"));
            start.elapsed().as_secs_f64() * 1e3
        }
    };
    let mut loads: Vec<_> = contestants.iter().map(|(_, path)| timed(path)).collect();
    let mut loads: Vec<&mut dyn FnMut() -> f64> = loads.iter_mut().map(|load| load as _).collect();
    let times = common::interleaved(&mut loads, rounds);
    println!("{name}");
    for ((contestant, _), own) in contestants.iter().zip(&times) {
        let (own, ratio) = (median(own), common::ratio(&times[0], own));
        let interval = format!("({:.1} to {:.1})", ratio.low, ratio.high);
        println!("    {contestant:<8} {own:>8.2} ms  {:.1} times as fast {interval}", ratio.value);
    }
}
