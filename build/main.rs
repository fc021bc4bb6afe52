//! Tells the program where it comes from: git revision, whether it was changed since, compiler, profile, target. None
//! of that may fail: a tarball without git builds as well, and says `unknown`. Also lists the files of `kernels/`.

mod tokens;

use std::path::{Path, PathBuf};
use std::process::Command;

/// What the program is made of: only a change here makes it dirty.
const SOURCES: [&str; 8] =
    ["src", "kernels", "camera-paths", "presets", "scenes/catalog.toml", "Cargo.toml", "Cargo.lock", "build"];

fn main() {
    let revision = revision();
    let dirty = revision.as_ref().and_then(|_| {
        let mut arguments = vec!["status", "--porcelain", "--"];
        arguments.extend(SOURCES.iter().filter(|path| Path::new(path).exists()));
        git(&arguments).map(|changes| !changes.is_empty())
    });
    let set = |name: &str, value: &str| println!("cargo::rustc-env=RTBENCH_{name}={value}");
    set("GIT_REVISION", revision.as_deref().unwrap_or("unknown"));
    set("GIT_DIRTY", dirty.map_or("unknown", |d| if d { "true" } else { "false" }));
    let compiler = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".into());
    set("RUSTC", output(&compiler, &["--version"]).as_deref().unwrap_or("unknown"));
    set("PROFILE", &std::env::var("PROFILE").unwrap_or_else(|_| "unknown".into()));
    set("READERS", &readers());
    set("TARGET", &std::env::var("TARGET").unwrap_or_else(|_| "unknown".into()));

    let files = Path::new(&std::env::var("OUT_DIR").unwrap_or_default()).join("kernel_files.rs");
    if let Err(error) = std::fs::write(&files, kernel_files()) {
        println!("cargo::error=cannot write {}: {error}", files.display());
    }

    for path in SOURCES.iter().filter(|path| Path::new(path).exists()) {
        println!("cargo::rerun-if-changed={path}");
    }
    // The log of HEAD grows with every commit and checkout. (The index would do too, but `git status` alone touches
    // it.)
    if let Some(log) = git(&["rev-parse", "--git-path", "logs/HEAD"]).filter(|log| Path::new(log).exists()) {
        println!("cargo::rerun-if-changed={log}");
    }
}

/// A hash (FNV-1a, 64 bits, hexadecimal) of everything that decides which scene a file gives: by it a cache is known to
/// be stale. Of Rust sources it takes the tokens, so that comments and layout do not matter, and of the dependencies
/// those that readers use. `DefaultHasher` would do, but may change with the compiler.
fn readers() -> String {
    let mut files = files_below("src/scene");
    files.push(PathBuf::from("src/math.rs"));
    files.sort();
    let read = |path: &Path| std::fs::read_to_string(path).unwrap_or_default();
    let mut text: String = files.iter().map(|file| tokens::of(&read(file))).collect();
    text += &read(Path::new("scenes/catalog.toml"));
    let lock = read(Path::new("Cargo.lock"));
    text.extend(lock.split("[[package]]").filter(|package| is_of_readers(package)));
    let hash =
        text.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |hash, b| (hash ^ u64::from(b)).wrapping_mul(0x100_0000_01b3));
    format!("{hash:016x}")
}

/// Rust source of a constant `FILES` with the name and the text of every kernel file.
fn kernel_files() -> String {
    let mut text = String::from("/// Every file of `kernels/`: its name below that folder, and its text.\n");
    text += "pub const FILES: &[(&str, &str)] = &[\n";
    for path in files_below("kernels").iter().filter(|path| path.extension().is_some_and(|e| e == "wgsl")) {
        let path = path.to_string_lossy().replace('\\', "/");
        let name = path.trim_start_matches("kernels/");
        let text_of = format!("include_str!(concat!(env!(\"CARGO_MANIFEST_DIR\"), {:?}))", format!("/{path}"));
        text += &format!("    ({name:?}, {text_of}),\n");
    }
    text + "];\n"
}

/// All files in a folder and the folders below it, in alphabetical order.
fn files_below(folder: &str) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let mut folders = vec![PathBuf::from(folder)];
    while let Some(folder) = folders.pop() {
        for path in std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()) {
            if path.is_dir() { folders.push(path) } else { files.push(path) }
        }
    }
    files.sort();
    files
}

/// Dependencies that decide what a reader makes of a file.
const READER_PACKAGES: [&str; 5] = ["glam", "earcut", "serde_json", "base64", "percent-encoding"];

/// True for a package of `Cargo.lock` that is one of them.
fn is_of_readers(package: &str) -> bool {
    READER_PACKAGES.iter().any(|name| package.contains(&format!("\nname = \"{name}\"\n")))
}

/// The revision, if this folder is the top of a repository: a tarball unpacked inside another project's repository
/// must not take on that project's revision.
fn revision() -> Option<String> {
    let top = std::fs::canonicalize(git(&["rev-parse", "--show-toplevel"])?).ok()?;
    let here = std::fs::canonicalize(".").ok()?;
    if top == here { git(&["rev-parse", "HEAD"]) } else { None }
}

fn git(arguments: &[&str]) -> Option<String> {
    output("git", arguments)
}

/// Standard output, trimmed; `None` if the program is missing or fails.
fn output(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok().filter(|o| o.status.success())?;
    Some(String::from_utf8(output.stdout).ok()?.trim().to_owned())
}
