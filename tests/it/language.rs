//! Checks the form of comments and documents: no line is longer than 120 columns, except rows of tables and lines with
//! an address. rustfmt limits code to the same width but does not wrap comments.

use std::fs;
use std::path::{Path, PathBuf};

/// The largest width of a line, in characters.
const WIDTH: usize = 120;

/// Files and folders that are checked.
const CHECKED: [&str; 24] = [
    "ARCHITECTURE.md",
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    "Cargo.toml",
    "METHODOLOGY.md",
    "README.md",
    "benches",
    "build",
    "camera-paths",
    "docs",
    "fuzz/README.md",
    "fuzz/fuzz_targets",
    "fuzz/src",
    "kernels",
    "presets",
    "results/README.md",
    "results/rt2-2010",
    "results/spheres-paper",
    "results/splat-thesis",
    "results/thesis-2009",
    "scenes/README.md",
    "scenes/catalog.toml",
    "src",
    "tests",
];

fn collect(path: &Path, files: &mut Vec<PathBuf>) {
    if !path.is_dir() {
        files.push(path.to_owned());
        return;
    }
    for entry in fs::read_dir(path).unwrap() {
        collect(&entry.unwrap().path(), files);
    }
}

/// The text of a line if it is a comment or a line of a document; the extension of the file decides which lines are.
fn prose<'l>(line: &'l str, extension: &str) -> Option<&'l str> {
    let trimmed = line.trim_start();
    match extension {
        "rs" | "wgsl" => Some(trimmed.strip_prefix("//")?.trim_start_matches(['/', '!']).trim_start()),
        "toml" => Some(trimmed.strip_prefix('#')?.trim_start()),
        "md" => Some(trimmed),
        _ => None,
    }
}

/// True for a comment or a line of a document that is too long. Rows of tables and lines with an address may be longer.
fn is_too_long(line: &str, extension: &str) -> bool {
    let exempt = |text: &str| text.starts_with('|') || text.contains("://");
    line.chars().count() > WIDTH && prose(line, extension).is_some_and(|text| !exempt(text))
}

/// True for the marker before what the program puts into a document.
fn begins_generated(line: &str) -> bool {
    line.starts_with("<!-- rtbench:") && line.ends_with("-->")
}

#[test]
fn comments_and_documents_are_at_most_120_columns_wide() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = Vec::new();
    for path in CHECKED {
        assert!(root.join(path).exists(), "{path} does not exist");
        collect(&root.join(path), &mut files);
    }
    let mut found = Vec::new();
    let mut checked = 0;
    for path in files {
        let Some(extension) = path.extension().and_then(|extension| extension.to_str()) else { continue };
        let Ok(text) = fs::read_to_string(&path) else { continue };
        let mut is_generated = false;
        for (number, line) in text.lines().enumerate() {
            // Tables and claims that the program puts into a document have a paragraph per line
            is_generated = begins_generated(line) || (is_generated && !line.starts_with("<!-- /rtbench:"));
            if is_generated && extension == "md" {
                continue;
            }
            checked += usize::from(prose(line, extension).is_some());
            if is_too_long(line, extension) {
                let (file, width) = (path.strip_prefix(root).unwrap().display(), line.chars().count());
                found.push(format!("{file}:{}: {width} columns", number + 1));
            }
        }
    }
    assert!(found.is_empty(), "wrap these lines at {WIDTH} columns:\n{}", found.join("\n"));
    assert!(checked > 2000, "only {checked} lines of comments and documents were found");
}

#[test]
fn a_long_line_is_detected() {
    assert!(begins_generated("<!-- rtbench:5.4 -->") && !begins_generated("<!-- /rtbench:5.4 -->"));
    assert!(!begins_generated("between <!-- rtbench:5.4 --> and its end"));
    let words = "word ".repeat(25);
    for (line, extension) in [
        (format!("    /// {words}"), "rs"),
        (format!("//! {words}"), "rs"),
        (format!("// {words}"), "wgsl"),
        (format!("# {words}"), "toml"),
        (format!("- {words}"), "md"),
        (format!("//! {} | {words}", "é".repeat(10)), "rs"),
    ] {
        assert!(is_too_long(&line, extension), "{line}");
    }
    for (line, extension) in [
        (format!("/// {}", "é".repeat(116)), "rs"),
        (format!("//! | {words} |"), "rs"),
        (format!("| {words} |"), "md"),
        (format!("# {words}https://example.org"), "toml"),
        (format!("let text = \"{words}\";"), "rs"),
        (format!("text = \"{words}\""), "toml"),
    ] {
        assert!(!is_too_long(&line, extension), "{line}");
    }
}
