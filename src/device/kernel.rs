//! Assembles the text of a kernel from files. WGSL has no include and an `override` may not size an array; both are
//! done here, in text. A line map turns naga's lines back into files and lines.
//!
//! A line `//!include FILE` takes a file once; a line `//!slot NAME` takes the file that the caller chose for this
//! name. Lines between `//!repeat COUNT NAME` and `//!end` are taken as often as the constant COUNT says, with 0, 1,
//! 2 .. in place of `{NAME}`: drivers keep arrays in registers only where all indices are constants. The constants go
//! before everything else but lines that begin with `enable`, which WGSL wants first.

use super::tokens::tokens;
use std::fmt::Write;

/// A file below `kernels/`: its name and its text.
pub type KernelFile = (&'static str, &'static str);

/// Constants that a kernel takes from Rust, so that both sides have the same.
#[derive(Clone, Debug, Default)]
pub struct Constants {
    text: String,
    machine: Vec<&'static str>,
}

impl Constants {
    /// Adds a constant of type `f32`.
    pub fn float(&mut self, name: &str, value: f32) {
        self.line(format_args!("const {name}: f32 = {value:?}f;"));
    }

    /// Adds a constant of type `u32`.
    pub fn unsigned(&mut self, name: &str, value: u32) {
        self.line(format_args!("const {name}: u32 = {value}u;"));
    }

    /// Adds a constant of type `bool`.
    pub fn flag(&mut self, name: &str, value: bool) {
        self.line(format_args!("const {name}: bool = {value};"));
    }

    /// Adds a constant of type `u32` that only describes the machine: it is no part of the kernel's identity.
    pub fn machine(&mut self, name: &'static str, value: u32) {
        self.unsigned(name, value);
        self.machine.push(name);
    }

    fn line(&mut self, line: std::fmt::Arguments) {
        writeln!(self.text, "{line}").expect("a String takes all text");
    }
}

/// An assembled kernel.
#[derive(Clone, Debug)]
pub struct Source {
    /// WGSL.
    pub text: String,
    /// For each line of `text`: the file and the line (counted from 1) that it came from.
    pub lines: Vec<(&'static str, usize)>,
    /// Names of constants that only describe the machine.
    machine: Vec<&'static str>,
}

impl Source {
    /// The file and line of line `line` (counted from 1) of the text, as `kernels/FILE:LINE`.
    pub fn locate(&self, line: usize) -> String {
        match self.lines.get(line.wrapping_sub(1)) {
            Some((file, line)) => format!("kernels/{file}:{line}"),
            None => format!("line {line} of the assembled kernel"),
        }
    }

    /// First 16 digits of BLAKE3 of the text's tokens, without constants that only describe the machine: the identity
    /// of a measured kernel, the same on every machine. Comments and white space do not change it.
    pub fn hash(&self) -> String {
        let of_machine = |line: &str| {
            let name = line.strip_prefix("const ").and_then(|rest| rest.split(':').next());
            name.is_some_and(|name| self.machine.contains(&name))
        };
        let lines = self.text.split_inclusive('\n').filter(|line| !of_machine(line));
        let tokens = tokens(&lines.collect::<String>());
        blake3::hash(tokens.as_bytes()).to_hex()[..16].to_string()
    }
}

/// Puts a kernel together: the constants, then the file `entry` with everything that it includes.
///
/// # Errors
/// A message with file and line for an include that does not exist (a mistake in `kernels/`).
pub fn assemble(
    files: &'static [KernelFile],
    entry: &str,
    slots: &[(&str, &str)],
    constants: Constants,
) -> Result<Source, String> {
    let Constants { text, machine } = constants;
    let source = Source { text: String::new(), lines: Vec::new(), machine };
    let mut assembly = Assembly { files, slots, included: Vec::new(), source };
    for line in text.lines() {
        assembly.push(line, "(prelude)", 1);
    }
    assembly.include(entry, "(prelude)", 1)?;
    Ok(assembly.source)
}

/// Lines that are repeated.
struct Repeated {
    count: u32,
    /// What the number takes the place of.
    placeholder: String,
    lines: Vec<(&'static str, usize)>,
}

struct Assembly<'a> {
    files: &'static [KernelFile],
    slots: &'a [(&'a str, &'a str)],
    included: Vec<&'static str>,
    source: Source,
}

impl Assembly<'_> {
    fn push(&mut self, line: &str, file: &'static str, number: usize) {
        if line.starts_with("enable ") {
            self.source.text.insert_str(0, &format!("{line}\n"));
            self.source.lines.insert(0, (file, number));
            return;
        }
        self.source.text.push_str(line);
        self.source.text.push('\n');
        self.source.lines.push((file, number));
    }

    /// Adds a file unless it is there already; the files that a line asks for take the place of this line.
    fn include(&mut self, name: &str, from: &str, line: usize) -> Result<(), String> {
        let Some(&(name, text)) = self.files.iter().find(|(file, _)| *file == name) else {
            return Err(format!("kernels/{from}:{line}: no such kernel file: {name}"));
        };
        if self.included.contains(&name) {
            return Ok(());
        }
        self.included.push(name);
        let mut repeated: Option<Repeated> = None;
        for (index, text) in text.lines().enumerate() {
            let instruction = text.trim_start();
            if let Some(asked) = instruction.strip_prefix("//!repeat ") {
                repeated =
                    Some(self.repeated(asked).ok_or_else(|| {
                        format!("kernels/{name}:{}: no count and name to repeat by: {asked}", index + 1)
                    })?);
            } else if instruction == "//!end" {
                let Some(Repeated { count, placeholder, lines }) = repeated.take() else {
                    return Err(format!("kernels/{name}:{}: nothing is repeated here", index + 1));
                };
                for number in 0..count {
                    for (line, place) in &lines {
                        self.push(&line.replace(&placeholder, &number.to_string()), name, *place);
                    }
                }
            } else if let Some(repeated) = &mut repeated {
                repeated.lines.push((text, index + 1));
            } else if let Some(included) = text.strip_prefix("//!include ") {
                self.include(included.trim(), name, index + 1)?;
            } else if let Some(slot) = text.strip_prefix("//!slot ") {
                let slot = slot.trim();
                let Some((_, file)) = self.slots.iter().find(|(known, _)| *known == slot) else {
                    return Err(format!("kernels/{name}:{}: no such slot: {slot}", index + 1));
                };
                self.include(file, name, index + 1)?;
            } else {
                self.push(text, name, index + 1);
            }
        }
        match repeated {
            Some(_) => Err(format!("kernels/{name}: the last //!repeat has no //!end")),
            None => Ok(()),
        }
    }

    /// The count is the value of a constant of type `u32`.
    fn repeated(&self, asked: &str) -> Option<Repeated> {
        let (constant, name) = asked.trim().split_once(' ')?;
        let value =
            |line: &str| line.strip_prefix(&format!("const {constant}: u32 = "))?.strip_suffix("u;")?.parse().ok();
        let count = self.source.text.lines().find_map(value)?;
        Some(Repeated { count, placeholder: format!("{{{name}}}"), lines: Vec::new() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILES: &[KernelFile] = &[
        ("main.wgsl", "//!include lib.wgsl\n//!slot memory\n//!include lib.wgsl\nfn main() {}\n"),
        ("lib.wgsl", "fn lib() {}\n"),
        ("buffers.wgsl", "//!include lib.wgsl\nfn read() {}\n"),
        ("broken.wgsl", "\n//!include nowhere.wgsl\n"),
    ];

    fn with_threads(threads: u32) -> Source {
        let mut constants = Constants::default();
        constants.float("A", 0.5);
        constants.machine("THREADS", threads);
        assemble(FILES, "main.wgsl", &[("memory", "buffers.wgsl")], constants).unwrap()
    }

    #[test]
    fn each_file_is_taken_once_and_lines_are_found_again() {
        let source = with_threads(2);
        let text = "const A: f32 = 0.5f;\nconst THREADS: u32 = 2u;\nfn lib() {}\nfn read() {}\nfn main() {}\n";
        assert_eq!(source.text, text);
        assert_eq!(source.locate(4), "kernels/buffers.wgsl:2");
        assert_eq!(source.locate(9), "line 9 of the assembled kernel");
    }

    #[test]
    fn repeated_lines_are_located() {
        let file = |text: &'static str| -> &'static [KernelFile] { vec![("main.wgsl", text)].leak() };
        let assemble = |text| {
            let mut constants = Constants::default();
            constants.unsigned("ROWS", 2);
            assemble(file(text), "main.wgsl", &[], constants)
        };
        let source = assemble("fn f() {\n    //!repeat ROWS k\n    a[{k}] = {k}u;\n    //!end\n}\n").unwrap();
        let text = "const ROWS: u32 = 2u;\nfn f() {\n    a[0] = 0u;\n    a[1] = 1u;\n}\n";
        assert_eq!(source.text, text);
        assert_eq!(
            [3, 4, 5].map(|line| source.locate(line)),
            ["kernels/main.wgsl:3", "kernels/main.wgsl:3", "kernels/main.wgsl:5"]
        );
        for (text, problem) in [
            ("//!repeat LANES k\n//!end\n", "kernels/main.wgsl:1: no count and name to repeat by: LANES k"),
            ("//!repeat ROWS k\n", "kernels/main.wgsl: the last //!repeat has no //!end"),
            ("\n//!end\n", "kernels/main.wgsl:2: nothing is repeated here"),
        ] {
            assert_eq!(assemble(text).unwrap_err(), problem);
        }
    }

    #[test]
    fn extensions_come_first() {
        const FILES: &[KernelFile] =
            &[("main.wgsl", "//!include half.wgsl\nfn main() {}\n"), ("half.wgsl", "\nenable f16;\n")];
        let mut constants = Constants::default();
        constants.flag("A", true);
        let source = assemble(FILES, "main.wgsl", &[], constants).unwrap();
        assert_eq!(source.text, "enable f16;\nconst A: bool = true;\n\nfn main() {}\n");
        assert_eq!(
            [1, 2, 4].map(|line| source.locate(line)),
            ["kernels/half.wgsl:2", "kernels/(prelude):1", "kernels/main.wgsl:2"]
        );
    }

    #[test]
    fn the_machine_is_no_part_of_the_identity() {
        assert_eq!(with_threads(2).hash(), with_threads(4).hash());
        let mut other = with_threads(2);
        other.text = other.text.replace("0.5", "0.25");
        assert_ne!(other.hash(), with_threads(2).hash());
    }

    #[test]
    fn what_is_missing_is_located() {
        let assemble = |entry, slots: &[(&str, &str)]| assemble(FILES, entry, slots, Constants::default());
        let problem = assemble("broken.wgsl", &[]).unwrap_err();
        assert_eq!(problem, "kernels/broken.wgsl:2: no such kernel file: nowhere.wgsl");
        assert_eq!(assemble("main.wgsl", &[]).unwrap_err(), "kernels/main.wgsl:2: no such slot: memory");
    }
}
