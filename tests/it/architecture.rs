//! The rules of ARCHITECTURE.md that a program can check: the staircase, where wgpu and clocks may stand, where there is
//! output. Each rule is also shown to fail on a line that breaks it.

use std::fs;
use std::path::{Path, PathBuf};

/// From the top: a module may use those before it.
const STAIRCASE: [&str; 11] =
    ["error", "threads", "math", "scene", "camera", "workloads", "record", "thesis", "harness", "fetch", "cli"];

/// A line of code (no comment) with its file, relative to `src`.
struct Line {
    file: String,
    text: String,
}

fn lines() -> Vec<Line> {
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
    let mut lines = Vec::new();
    for path in files.iter().filter(|path| path.extension().is_some_and(|e| e == "rs")) {
        let file = path.strip_prefix(&root).unwrap().to_str().unwrap().replace('\\', "/");
        for text in fs::read_to_string(path).unwrap().lines() {
            let text = text.trim_start();
            if !text.starts_with("//") {
                lines.push(Line { file: file.clone(), text: text.to_string() });
            }
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
            panic!("src/{} uses crate::{below}, which stands below it: {}", line.file, line.text);
        }
    }
    let wrong = Line { file: "scene/ply.rs".into(), text: "use crate::harness::plan;".into() };
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

#[test]
fn things_stand_where_they_belong() {
    let lines = lines();
    let rules: [(&str, &[&str], &[&str]); 4] = [
        ("a wgpu type", &["wgpu::"], &["workloads/trace/gpu/"]),
        // Devices time their frames and selections their builds; the rest is the harness's
        (
            "a clock",
            &["Instant::now"],
            &[
                "harness/",
                "workloads/trace/cpu.rs",
                "workloads/trace/gpu/timing.rs",
                "workloads/trace/selection.rs",
                "cli/progress.rs",
            ],
        ),
        ("output", &["println!", "print!(", "stdout()", "stderr()"], &["cli/"]),
        (
            "unsafe code",
            &["unsafe {", "unsafe fn", "unsafe impl"],
            &["workloads/trace/gpu/device.rs", "scene/cache/pages.rs"],
        ),
    ];
    for (what, words, allowed) in rules {
        let found = outside(&lines, words, allowed);
        assert!(found.is_empty(), "{what} in src/{}: {}", found[0].file, found[0].text);
        assert!(!outside(&lines, words, &[]).is_empty(), "{what} is nowhere: the rule sees nothing");
    }
}
