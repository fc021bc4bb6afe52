//! GPUs as files: `gpus/NAME.toml`, or a user's.

use crate::error::{Error, Result};
use crate::guard;
use crate::names as texts;
use crate::workloads::trace::Selection;
use crate::workloads::trace::case::WARP_WIDTHS;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;
use toml::Spanned;

/// The GPUs that are part of the program.
const KNOWN: [(&str, &str); 4] = [
    ("8600gt", include_str!("../../../../../gpus/8600gt.toml")),
    ("gtx280", include_str!("../../../../../gpus/gtx280.toml")),
    ("rtx4090", include_str!("../../../../../gpus/rtx4090.toml")),
    ("h200", include_str!("../../../../../gpus/h200.toml")),
];

/// A GPU, as far as the model knows it.
#[derive(Clone, Debug, PartialEq)]
pub struct Gpu {
    /// What people call it.
    pub name: String,
    /// Processors that hold warps.
    pub multiprocessors: u32,
    /// Of the processors, in MHz.
    pub clock_mhz: f64,
    /// Cycles in which a multiprocessor issues one instruction of a warp.
    pub cycles_per_instruction: f64,
    /// Lanes of a warp.
    pub warp_width: u32,
    /// Most resident warps of a multiprocessor.
    pub max_warps: u32,
    /// Work-group memory of a multiprocessor.
    pub shared_bytes: u64,
    /// By which published times its orders were validated; empty for none.
    pub validated: String,
    /// Limits of resident warps other than work-group memory.
    pub resident: Vec<Resident>,
}

/// Resident warps of some kernels.
#[derive(Clone, Debug, PartialEq)]
pub struct Resident {
    /// The structure; none for all.
    structure: Option<&'static str>,
    /// Options that a kernel must have for it.
    options: Vec<(String, String)>,
    /// Warps of a multiprocessor.
    warps: u32,
}

impl Resident {
    /// Reads a key: `default`, a structure, or a structure with options, `kdtree:search=restart`.
    fn parse(key: &str, warps: u32) -> Result<Resident> {
        if key == "default" {
            return Ok(Resident { structure: None, options: Vec::new(), warps });
        }
        let selection = Selection::parse(key)?;
        let options = key.split_once(':').map_or("", |(_, options)| options).split(',');
        let names = options.filter_map(|option| option.split_once('=').map(|(name, _)| name.to_owned()));
        let options = names.map(|name| (name.clone(), selection.value(&name).to_owned())).collect();
        Ok(Resident { structure: Some(selection.name()), options, warps })
    }

    /// True if a kernel may fit both, and neither says more about it than the other.
    fn is_ambiguous_with(&self, other: &Resident) -> bool {
        let differs = |(name, value): &(String, String)| other.options.iter().any(|(n, v)| n == name && v != value);
        self.structure == other.structure
            && self.options.len() == other.options.len()
            && !self.options.iter().any(differs)
    }

    fn is_of(&self, selection: &Selection) -> bool {
        let has = |(key, value): &(String, String)| selection.value(key) == value;
        self.structure.is_none_or(|structure| structure == selection.name() && self.options.iter().all(has))
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    name: String,
    multiprocessors: Spanned<u32>,
    clock_mhz: Spanned<f64>,
    cycles_per_instruction: Spanned<f64>,
    warp_width: Spanned<u32>,
    max_warps: Spanned<u32>,
    shared_bytes: Spanned<u64>,
    #[serde(default)]
    validated: String,
    #[serde(default)]
    resident_warps: BTreeMap<String, Spanned<u32>>,
}

/// Names of the GPUs that are part of the program.
pub fn names() -> impl Iterator<Item = &'static str> {
    KNOWN.iter().map(|(name, _)| *name)
}

impl Gpu {
    /// The GPUs of the program whose orders published times have confirmed.
    pub fn validated() -> Vec<Gpu> {
        // The files are part of the program, and a test reads all of them
        let gpus = KNOWN.iter().filter_map(|(name, text)| Gpu::parse(name, text).ok());
        gpus.filter(|gpu| !gpu.validated.is_empty()).collect()
    }

    /// A GPU of the program by its name, or one of a file.
    ///
    /// # Errors
    /// [`Error::Input`]: no such GPU, or a file that is none, with its line.
    pub fn load(name: &str) -> Result<Gpu> {
        if let Some((_, text)) = KNOWN.iter().find(|(known, _)| known.eq_ignore_ascii_case(name)) {
            return Gpu::parse(name, text);
        }
        let path = &*texts::file(name);
        if path.extension().is_none() {
            let hint = format!("there are {}; or give a TOML file", names().collect::<Vec<_>>().join(", "));
            return Err(Error::argument("--gpu", format!("no GPU {name:?}"), hint));
        }
        guard::read(path);
        let text = std::fs::read_to_string(path)
            .map_err(|e| Error::file(path, None, format!("cannot read: {e}"), "give a GPU's TOML file"))?;
        Gpu::parse(name, &text)
    }

    fn parse(name: &str, text: &str) -> Result<Gpu> {
        let text = text.trim_start_matches('\u{feff}');
        let wrong = |span: Option<std::ops::Range<usize>>, problem: String| {
            let line = span.map(|span| 1 + text[..span.start.min(text.len())].matches('\n').count());
            Error::file(Path::new(name), line, problem, "gpus/gtx280.toml is an example")
        };
        let file: File = toml::from_str(text).map_err(|e| wrong(e.span(), e.message().replace('\n', ", ")))?;
        let positive = |key: &str, value: &Spanned<u32>| match *value.get_ref() {
            0 => Err(wrong(Some(value.span()), format!("{key} = 0, which must be at least 1"))),
            number => Ok(number),
        };
        let number = |key: &str, value: &Spanned<f64>| match *value.get_ref() {
            number if number > 0.0 && number.is_finite() => Ok(number),
            number => Err(wrong(Some(value.span()), format!("{key} = {number}, which must be above 0"))),
        };
        let max_warps = positive("max_warps", &file.max_warps)?;
        let resident = |(key, warps): (&String, &Spanned<u32>)| match positive(key, warps)? {
            number if number <= max_warps => Resident::parse(key, number)
                .map_err(|error| wrong(Some(warps.span()), format!("{key:?} names no kernels: {}", problem(error)))),
            more => Err(wrong(Some(warps.span()), format!("{key} = {more}, which is above max_warps"))),
        };
        let entries: Vec<Resident> = file.resident_warps.iter().map(resident).collect::<Result<_>>()?;
        for (i, (entry, (key, warps))) in entries.iter().zip(&file.resident_warps).enumerate() {
            if let Some(other) = entries[..i].iter().position(|other| other.is_ambiguous_with(entry)) {
                let other = file.resident_warps.keys().nth(other).map_or("", String::as_str);
                let problem = format!("{key:?} and {other:?} fit the same kernels, and neither has more options");
                return Err(wrong(Some(warps.span()), problem));
            }
        }
        Ok(Gpu {
            multiprocessors: positive("multiprocessors", &file.multiprocessors)?,
            clock_mhz: number("clock_mhz", &file.clock_mhz)?,
            cycles_per_instruction: number("cycles_per_instruction", &file.cycles_per_instruction)?,
            warp_width: match *file.warp_width.get_ref() {
                width if WARP_WIDTHS.contains(&width) => width,
                width => {
                    let problem = format!("warp_width = {width}, and warps are counted with 8, 16, 32 or 64 lanes");
                    return Err(wrong(Some(file.warp_width.span()), problem));
                }
            },
            max_warps,
            shared_bytes: match *file.shared_bytes.get_ref() {
                0 => return Err(wrong(Some(file.shared_bytes.span()), "shared_bytes = 0".into())),
                bytes => bytes,
            },
            resident: entries,
            name: file.name,
            validated: file.validated.trim().to_owned(),
        })
    }

    /// Resident warps of a multiprocessor: as many as the work-group memory of the kernel leaves room for, in whole
    /// work-groups, and no more than the file's entry with the most options says; at least one. Registers are not
    /// modelled.
    pub fn resident_warps(&self, selection: &Selection, workgroup_bytes: u64) -> u32 {
        let entries = self.resident.iter().filter(|entry| entry.is_of(selection));
        let entry = entries.max_by_key(|entry| (entry.structure.is_some(), entry.options.len()));
        let most = entry.map_or(self.max_warps, |entry| entry.warps);
        let of_group = selection.method().group.size().div_ceil(self.warp_width).max(1);
        let groups = u64::from(self.max_warps / of_group);
        let fitting = self.shared_bytes.checked_div(workgroup_bytes).unwrap_or(groups);
        (groups.min(fitting) as u32 * of_group).min(most).max(1)
    }

    /// Milliseconds in which it can at best issue so many instructions of warps.
    pub fn issue_ms(&self, instructions: f64) -> f64 {
        let per_second = f64::from(self.multiprocessors) * self.clock_mhz * 1e6 / self.cycles_per_instruction;
        instructions / per_second * 1e3
    }
}

/// What is wrong, without the place and the hint of another input.
pub(super) fn problem(error: Error) -> String {
    match error {
        Error::Input(input) => input.problem,
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = "name = \"x\"\nmultiprocessors = 2\nclock_mhz = 1000\ncycles_per_instruction = 4\nwarp_width = 32\n\
                        max_warps = 24\nshared_bytes = 16384\n";

    #[test]
    fn known_gpus_are_valid() {
        for (name, text) in KNOWN {
            let gpu = Gpu::parse(name, text).unwrap();
            assert!(gpu.warp_width == 32 && !gpu.name.is_empty(), "{name}");
            assert_eq!(gpu.validated.is_empty(), gpu.resident.is_empty(), "{name}");
        }
        assert_eq!(Gpu::load("GTX280").unwrap().name, "GeForce GTX 280");
    }

    #[test]
    fn wrong_files_are_one_error_with_a_line() {
        let wrong = |text: &str| Gpu::parse("x.toml", text).unwrap_err().to_string();
        for (from, to, words) in [
            ("max_warps", "most_warps", "x.toml:6: "),
            ("warp_width = 32", "warp_width = 33", "x.toml:5: warp_width = 33"),
            ("clock_mhz = 1000", "clock_mhz = 0", "x.toml:3: clock_mhz = 0"),
            ("clock_mhz = 1000", "clock_mhz = -1.5", "x.toml:3: clock_mhz = -1.5"),
            ("multiprocessors = 2", "multiprocessors = 0", "x.toml:2: multiprocessors = 0"),
            ("shared_bytes = 16384", "shared_bytes = \"all\"", "x.toml:7: "),
            ("shared_bytes = 16384\n", "shared_bytes = 1\n[resident_warps]\ngrid = 0\n", "x.toml:9: grid = 0"),
            (
                "shared_bytes = 16384\n",
                "shared_bytes = 1\n[resident_warps]\nkd-tree = 8\n",
                "x.toml:9: \"kd-tree\" names no kernels",
            ),
            (
                "shared_bytes = 16384\n",
                "shared_bytes = 1\n[resident_warps]\n\"kdtree:depth=2\" = 8\n",
                "kdtree has no option 'depth'",
            ),
            (
                "shared_bytes = 16384\n",
                "shared_bytes = 1\n[resident_warps]\ngrid = 25\n",
                "x.toml:9: grid = 25, which is above",
            ),
        ] {
            let message = wrong(&GOOD.replace(from, to));
            assert!(message.contains(words), "{message}");
        }
        assert!(wrong("name = ").contains("x.toml:1"));
        assert!(Gpu::load("gtx999").unwrap_err().to_string().contains("gtx280"));
    }

    #[test]
    fn the_entry_with_the_most_options_counts() {
        // In another order than by their options, and with a value that is not as the program writes it
        let entries = "[resident_warps]\ndefault = 16\n\"bih\" = 2\n\"kdtree:memory=workgroup,search=short-stack\" = 8\n\
                       \"kdtree:search=short-stack\" = 3\nkdtree = 4\n\"kdtree:ki=02.50,kt=3,search=restart\" = 5\n";
        let gpu = Gpu::parse("x", &[GOOD, entries].concat()).unwrap();
        let warps = |text| gpu.resident_warps(&Selection::parse(text).unwrap(), 100);
        let selections = [
            ("bvh", 16),
            ("bih", 2),
            ("kdtree", 8),
            ("kdtree:kt=2", 8),
            ("kdtree:search=restart", 4),
            ("kdtree:memory=private", 3),
            ("kdtree:search=ropes", 4),
            ("kdtree:search=restart,kt=3,ki=2.5", 5),
        ];
        selections.iter().for_each(|&(text, expected)| assert_eq!(warps(text), expected, "{text}"));
        let two = "[resident_warps]\n\"kdtree:memory=workgroup\" = 4\n\"kdtree:search=short-stack\" = 8\n";
        let twice = "[resident_warps]\n\"kdtree:ki=2\" = 4\n\"kdtree:ki=2.0\" = 8\n";
        let alias = "[resident_warps]\nbvh = 4\n\"bvh-packet\" = 8\n";
        for entries in [two, twice, alias] {
            let message = Gpu::parse("x.toml", &[GOOD, entries].concat()).unwrap_err().to_string();
            assert!(message.contains("x.toml:10: ") && message.contains("fit the same kernels"), "{message}");
        }
        // Memory limits, too
        let bvh = Selection::parse("bvh").unwrap();
        assert_eq!(gpu.resident_warps(&bvh, 8192), 4);
    }

    #[test]
    fn work_group_memory_limits_resident_warps() {
        let gpu = Gpu::parse("x", GOOD).unwrap();
        let bvh = Selection::parse("bvh").unwrap();
        let warps = |bytes| gpu.resident_warps(&bvh, bytes);
        assert_eq!([warps(0), warps(100), warps(4096), warps(16_384), warps(20_000)], [24, 24, 8, 2, 1]);
        // 10^9 cycles a second in two multiprocessors, a quarter of an instruction each
        assert!((gpu.issue_ms(5e8) - 1000.0).abs() < 1e-9);
    }
}
