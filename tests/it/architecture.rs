//! The rules of ARCHITECTURE.md that a program can check: the staircase, which files may use wgpu and clocks, which may
//! print. Each rule is also shown to fail on a line that breaks it.

use std::fs;
use std::path::{Path, PathBuf};

/// From the top: a module may use those before it.
const STAIRCASE: [&str; 16] = [
    "names",
    "error",
    "guard",
    "threads",
    "math",
    "scene",
    "camera",
    "device",
    "record",
    "report",
    "compare",
    "harness",
    "workloads",
    "sources",
    "fetch",
    "cli",
];

/// A line of code (no comment) with its file, relative to `src`.
struct Line {
    file: String,
    text: String,
}

/// Every Rust file below `src`, relative to it, with its text.
fn files() -> Vec<(String, String)> {
    fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() { collect(&path, files) } else { files.push(path) }
        }
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    collect(&root, &mut files);
    assert!(files.len() > 40, "only {} source files found", files.len());
    let rust = files.iter().filter(|path| path.extension().is_some_and(|e| e == "rs"));
    rust.map(|path| {
        let file = path.strip_prefix(&root).unwrap().to_str().unwrap().replace('\\', "/");
        (file, fs::read_to_string(path).unwrap())
    })
    .collect()
}

fn lines() -> Vec<Line> {
    let mut lines = Vec::new();
    for (file, text) in files() {
        for text in text.lines().map(str::trim_start).filter(|text| !text.starts_with("//")) {
            lines.push(Line { file: file.clone(), text: text.to_string() });
        }
    }
    lines
}

fn module(file: &str) -> &str {
    file.split(['/', '.']).next().unwrap()
}

/// The module below that a line reaches for, if any.
fn steps_down(line: &Line) -> Option<&'static str> {
    let own = STAIRCASE.iter().position(|m| *m == module(&line.file))?;
    STAIRCASE[own + 1..].iter().copied().find(|below| {
        let path = format!("crate::{below}");
        line.text
            .match_indices(&path)
            .any(|(at, _)| !line.text[at + path.len()..].starts_with(|c: char| c.is_alphanumeric() || c == '_'))
    })
}

#[test]
fn a_module_uses_only_modules_above_it() {
    for line in lines() {
        if let Some(below) = steps_down(&line) {
            panic!("src/{} uses crate::{below}, which is below it: {}", line.file, line.text);
        }
    }
    let wrong = Line { file: "record/row.rs".into(), text: "use crate::harness::plan;".into() };
    assert_eq!(steps_down(&wrong), Some("harness"));
}

#[test]
fn every_module_has_its_step() {
    for line in lines() {
        let module = module(&line.file);
        assert!(STAIRCASE.contains(&module) || ["lib", "main"].contains(&module), "src/{} has no step", line.file);
    }
}

/// Lines that hold one of `words` and lie outside `allowed` (prefixes of files).
fn outside<'l>(lines: &'l [Line], words: &[&str], allowed: &[&str]) -> Vec<&'l Line> {
    lines
        .iter()
        .filter(|line| words.iter().any(|word| line.text.contains(word)))
        .filter(|line| !allowed.iter().any(|prefix| line.file.starts_with(prefix)))
        .collect()
}

/// Words of workloads that the device module must not know.
#[test]
fn devices_know_nothing_of_workloads() {
    let words = ["Triangle", "triangle", "Config", "scene::", "camera::", "traversal", "Ray::"];
    let lines: Vec<Line> = lines().into_iter().filter(|line| line.file.starts_with("device/")).collect();
    // Structures of drivers are made of triangles
    let found = outside(&lines, &words, &["device/vulkan/acceleration.rs"]);
    assert!(found.is_empty(), "src/{}: {}", found[0].file, found[0].text);
}

/// Device, records and harness serve every workload and every source: none of them is named there, comments included.
#[test]
fn general_modules_name_no_workload_and_no_source() {
    let general = ["device/", "record/", "harness/", "compare/", "report/"];
    let names = |text: &str| {
        let text = text.to_lowercase();
        text.contains("thesis") || text.contains("p/ps/psr")
    };
    let mut seen = 0;
    for (file, text) in files().into_iter().filter(|(file, _)| general.iter().any(|folder| file.starts_with(folder))) {
        seen += 1;
        if let Some(line) = text.lines().find(|line| names(line)) {
            panic!("src/{file}: {line}");
        }
    }
    assert!(seen > 20, "only {seen} files");
    assert!(names("/// As the Thesis has it.") && names("the rays P/PS/PSR"));
}

/// Modules of a folder that use each other in a circle: an import of one leads back to it.
fn circles(folder: &str) -> Vec<String> {
    let prefix = format!("{folder}/");
    let mut uses: Vec<(String, String)> = Vec::new();
    for (file, text) in files().into_iter().filter(|(file, _)| file.starts_with(&prefix)) {
        let own = module(&file[prefix.len()..]).to_owned();
        for line in text.lines().map(str::trim_start).filter(|line| !line.starts_with("//")) {
            let at = line.strip_prefix("use super::").or_else(|| line.strip_prefix(&format!("use crate::{folder}::")));
            if let (Some(at), true) = (at, own != "mod") {
                uses.push((own.clone(), at.split([':', ';', ',']).next().unwrap_or_default().to_owned()));
            }
        }
    }
    let reaches = |from: &str, to: &str| {
        let (mut waiting, mut seen) = (vec![from.to_owned()], Vec::new());
        while let Some(module) = waiting.pop() {
            for (_, used) in uses.iter().filter(|(own, used)| *own == module && own != used) {
                if used == to {
                    return true;
                }
                if !seen.contains(used) {
                    seen.push(used.clone());
                    waiting.push(used.clone());
                }
            }
        }
        false
    };
    let mut modules: Vec<String> = uses.iter().map(|(own, _)| own.clone()).collect();
    modules.sort();
    modules.dedup();
    modules.into_iter().filter(|module| reaches(module, module)).collect()
}

#[test]
fn no_module_of_harness_device_or_record_is_in_a_circle() {
    for folder in ["harness", "device", "device/vulkan", "record", "compare", "report"] {
        let found = circles(folder);
        assert!(found.is_empty(), "src/{folder}: {}", found.join(", "));
    }
    // The rule sees circles where there are some
    assert!(!circles("workloads/trace").is_empty());
}

/// A file is read in one go: at most 400 lines, and half of the files at most 150.
#[test]
fn files_are_short() {
    let mut lengths: Vec<(usize, String)> =
        files().into_iter().map(|(file, text)| (text.lines().count(), file)).collect();
    lengths.sort();
    let (most, file) = lengths.last().unwrap();
    assert!(*most <= 400, "src/{file} has {most} lines");
    assert!(lengths[lengths.len() / 2].0 <= 150, "{} lines", lengths[lengths.len() / 2].0);
}

#[test]
fn what_is_restricted_occurs_only_where_allowed() {
    let lines = lines();
    let rules: [(&str, &[&str], &[&str]); 4] = [
        ("a wgpu type", &["wgpu::"], &["device/vulkan/"]),
        // Devices time their frames and selections their builds; everything else is timed by the harness
        (
            "a clock",
            &["Instant::now"],
            &[
                "harness/",
                "device/cpu.rs",
                "device/vulkan/acceleration.rs",
                "device/vulkan/run.rs",
                "workloads/trace/selection.rs",
                "cli/progress.rs",
            ],
        ),
        ("output", &["println!", "print!(", "stdout()", "stderr()"], &["cli/"]),
        (
            "unsafe code",
            &["unsafe {", "unsafe fn", "unsafe impl"],
            &["device/vulkan/device.rs", "device/vulkan/pipeline.rs", "scene/cache/pages.rs"],
        ),
    ];
    for (what, words, allowed) in rules {
        let found = outside(&lines, words, allowed);
        assert!(found.is_empty(), "{what} in src/{}: {}", found[0].file, found[0].text);
        assert!(!outside(&lines, words, &[]).is_empty(), "{what} is nowhere: the rule sees nothing");
    }
}
