//! The plan of a run: the parts of a preset with what the command line overrides, as a list of cases. It is checked as
//! a whole before anything runs, and needs no device.

use super::preset::Preset;
use super::shard;
use super::workload::{Case, Library, Part, Workload};
use crate::error::{Error, Result};
use crate::record::row::Settings;
use crate::record::run::{PlanRecord, Shard};
use std::collections::hash_map::Entry;
use std::collections::{BTreeMap, HashMap};

/// Most frames and passes: samples are kept.
const MAX_REPEATS: usize = 100_000;

/// What was asked for, as typed; what is absent comes from the preset.
#[derive(Clone, Debug, Default)]
pub struct Request {
    /// Name or file; the workload's first preset where absent.
    pub preset: Option<String>,
    /// Values by axis; comma lists where the axis has them.
    pub values: BTreeMap<String, Vec<String>>,
    /// Frames that each case is thinned to.
    pub frames: Option<usize>,
    /// Timed passes.
    pub passes: Option<usize>,
    /// Untimed frames before each pass.
    pub warmup: Option<usize>,
    /// Threads that build.
    pub threads: Option<usize>,
    /// Most work of a case.
    pub budget: Option<u64>,
    /// Where inputs are found.
    pub library: Library,
    /// The part that is measured; all where absent.
    pub shard: Option<Shard>,
}

/// A checked plan.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The preset that it began with.
    pub preset: String,
    /// What is measured, each once, in this order: the shard's cases where there is one.
    pub cases: Vec<Case>,
    /// All cases, of every shard.
    pub whole: Vec<Case>,
    /// The part that is measured; all where absent.
    pub shard: Option<Shard>,
    /// BLAKE3 of workload, all cases and settings: equal for the shards of one plan.
    pub hash: String,
    /// How.
    pub settings: Settings,
    /// Most work of a case; a case of more becomes a row `skipped`. Absent for no limit.
    pub budget: Option<u64>,
    /// Where inputs are found.
    pub library: Library,
    /// What the preset names and this machine does not have.
    pub absent: Vec<String>,
    /// For the user.
    pub notes: Vec<String>,
}

impl Plan {
    /// Checks a request. Headers and camera files are read, nothing else.
    ///
    /// # Errors
    /// [`Error::Input`] for the first thing that cannot be.
    pub fn new(workload: &dyn Workload, request: &Request) -> Result<Plan> {
        let info = workload.info();
        let first_preset = info.presets.first().map_or("", |(name, _)| *name);
        let preset = Preset::load(info, request.preset.as_deref().unwrap_or(first_preset))?;
        let mut absent = Vec::new();
        let parts = chosen(workload, &preset, request, &mut absent);
        if let (Some(shard), Some(first)) = (request.shard, absent.first()) {
            let problem = format!("shard {shard} needs every machine to have all inputs: {first}");
            return Err(Error::argument(
                "--shard",
                problem,
                "bring it to this machine, or leave it out on all machines",
            ));
        }
        if parts.is_empty() {
            let subject = info.axes.first().map_or("", |axis| axis.name);
            let problem = format!("nothing of preset {} is here: {}", preset.name, absent.join("; "));
            return Err(Error::argument("--preset", problem, format!("or name a {subject} with --{subject}")));
        }
        let settings = Settings {
            passes: request.passes.unwrap_or(preset.passes),
            warmup_frames: request.warmup.unwrap_or(preset.warmup),
            builds: preset.builds,
            threads: request.threads.filter(|&threads| threads > 0).unwrap_or(preset.threads),
        };
        in_range("--passes", settings.passes, 1)?;
        in_range("--warmup", settings.warmup_frames, 0)?;
        in_range("builds", settings.builds, 1)?;
        let mut whole: Vec<Case> = Vec::new();
        let mut known: HashMap<(Vec<(String, String)>, usize), usize> = HashMap::new();
        let mut shorter = 0;
        for part in parts {
            part.frames.map_or(Ok(()), |frames| in_range("--frames", frames, 1))?;
            for case in workload.plan(&part, &request.library)? {
                // Of cases that differ in nothing but their frames, the first part's
                match known.entry((without_frames(&case), case.device)) {
                    Entry::Vacant(entry) => {
                        entry.insert(whole.len());
                        whole.push(case);
                    }
                    Entry::Occupied(entry) => shorter += usize::from(whole[*entry.get()].axes != case.axes),
                }
            }
        }
        if whole.is_empty() {
            return Err(Error::argument("--preset", "the plan has no case", "give a value for each axis"));
        }
        let mut notes = Vec::new();
        if shorter > 0 {
            notes.push(format!("{shorter} cases differ from an earlier part's in their frames only and are left out"));
        }
        let cases = match request.shard {
            Some(shard) => shard::select(&whole, shard)?,
            None => whole.clone(),
        };
        let budget = request.budget.or(info.budget);
        let (shard, library, hash) = (request.shard, request.library.clone(), hash(info.name, &whole, settings));
        Ok(Plan { preset: preset.name, cases, whole, shard, hash, notes, settings, budget, library, absent })
    }

    /// The inputs, each once, with their cases.
    pub fn inputs(&self) -> Vec<(&str, Vec<Case>)> {
        let mut inputs: Vec<(&str, Vec<Case>)> = Vec::new();
        let mut index: HashMap<&str, usize> = HashMap::new();
        for case in &self.cases {
            let at = *index.entry(&case.input).or_insert_with(|| {
                inputs.push((&case.input, Vec::new()));
                inputs.len() - 1
            });
            inputs[at].1.push(case.clone());
        }
        inputs
    }

    /// The cases for so many devices: those of a device that is not there go to the first one, which refuses them.
    #[must_use]
    pub fn on_devices(mut self, devices: usize) -> Plan {
        for case in &mut self.cases {
            case.device = if case.device < devices { case.device } else { 0 };
        }
        self
    }

    /// Work of all cases.
    pub fn work(&self) -> u64 {
        self.cases.iter().fold(0, |sum, case| sum.saturating_add(case.work))
    }

    /// Values that occur on each axis in the whole plan, in their order.
    pub fn axes(&self) -> BTreeMap<String, Vec<String>> {
        let mut axes: BTreeMap<String, Vec<String>> = BTreeMap::new();
        for (axis, value) in self.whole.iter().flat_map(|case| &case.axes) {
            let values = axes.entry(axis.clone()).or_default();
            if !values.contains(value) {
                values.push(value.clone());
            }
        }
        axes
    }

    /// For the provenance.
    pub fn record(&self) -> PlanRecord {
        PlanRecord {
            preset: self.preset.clone(),
            axes: self.axes(),
            rows: self.cases.len(),
            settings: self.settings,
            absent: self.absent.clone(),
            work: self.work(),
            total: self.whole.len(),
            hash: self.hash.clone(),
            shard: self.shard,
        }
    }
}

fn in_range(flag: &str, value: usize, least: usize) -> Result<()> {
    if (least..=MAX_REPEATS).contains(&value) {
        return Ok(());
    }
    let hint = format!("give {least} to {MAX_REPEATS}");
    Err(Error::argument(flag, format!("{value} is out of range"), hint))
}

/// The axes of a case but its number of frames.
fn without_frames(case: &Case) -> Vec<(String, String)> {
    case.axes.iter().filter(|(axis, _)| *axis != "frames").map(|(k, v)| (k.clone(), v.clone())).collect()
}

/// BLAKE3 of a whole plan.
fn hash(workload: &str, cases: &[Case], settings: Settings) -> String {
    let cases: Vec<_> = cases.iter().map(|case| (&case.axes, case.device, case.work)).collect();
    let text = serde_json::to_string(&(workload, settings, cases)).unwrap_or_default();
    blake3::hash(text.as_bytes()).to_hex().to_string()
}

/// The parts of a preset that were asked for, with what the request overrides. What this machine does not have is put
/// into `absent`, with where to get it, and left out; nothing takes its place.
fn chosen(workload: &dyn Workload, preset: &Preset, request: &Request, absent: &mut Vec<String>) -> Vec<Part> {
    let axes = workload.info().axes;
    let (subject, compared) = (axes.first().map_or("", |a| a.name), axes.get(1).map_or("", |a| a.name));
    let mut parts: Vec<Part> = Vec::new();
    let all = |part: &Part| merged(&preset.common, part, request);
    match request.values.get(subject).filter(|subjects| !subjects.is_empty()) {
        Some(subjects) => {
            for name in subjects {
                // A subject that the preset names keeps its parts. If what is compared is given, it is compared as the
                // first of them says: the others are there for what they compare themselves.
                let named = |part: &&Part| {
                    let own = part.values.get(subject).or(preset.common.values.get(subject));
                    own.is_some_and(|names| names.contains(name))
                };
                let most = if request.values.contains_key(compared) { 1 } else { usize::MAX };
                let before = parts.len();
                parts.extend(preset.parts.iter().filter(named).take(most).map(all));
                if parts.len() == before {
                    parts.push(all(&Part::default()));
                }
                for part in &mut parts[before..] {
                    part.values.insert(subject.to_owned(), vec![name.clone()]);
                }
            }
        }
        None => {
            for mut part in preset.parts.iter().map(all) {
                let Some(names) = part.values.get_mut(subject) else {
                    parts.push(part);
                    continue;
                };
                names.retain(|name| {
                    let missing = workload.absent(name, &request.library);
                    let is_here = missing.is_none();
                    absent.extend(missing);
                    is_here
                });
                if !names.is_empty() {
                    parts.push(part);
                }
            }
            let mut seen = Vec::new();
            absent.retain(|text| !seen.contains(text) && (seen.push(text.clone()), true).1);
        }
    }
    parts
}

/// A part with what holds for all parts, and with what the request overrides.
fn merged(common: &Part, part: &Part, request: &Request) -> Part {
    let mut values = common.values.clone();
    values.extend(part.values.clone());
    let given = || request.values.iter().filter(|(_, values)| !values.is_empty());
    values.extend(given().map(|(axis, values)| (axis.clone(), values.clone())));
    let frames = request.frames.or(part.frames).or(common.frames);
    Part { values, frames, given: given().map(|(axis, _)| axis.clone()).collect() }
}

/// Parses a list given as several arguments, comma lists, or both; each value once, in the given order. A comma inside
/// a value's options (`grid:x=64,y=64`) is recognised by what follows it: `key=value` without a name.
///
/// # Errors
/// Those of `parse`.
pub fn parse_list<T: PartialEq>(texts: &[String], parse: impl Fn(&str) -> Result<T>) -> Result<Vec<T>> {
    let mut values = Vec::new();
    for item in split_list(texts) {
        let value = parse(&item)?;
        if !values.contains(&value) {
            values.push(value);
        }
    }
    Ok(values)
}

/// The items of such a list.
pub fn split_list(texts: &[String]) -> Vec<String> {
    let mut items: Vec<String> = Vec::new();
    for text in texts {
        let first = items.len();
        for part in text.split(',') {
            match items.get_mut(first..).and_then(|of_this| of_this.last_mut()) {
                Some(last) if part.contains('=') && !part.contains(':') => {
                    last.push(',');
                    last.push_str(part);
                }
                _ => items.push(part.trim().to_owned()),
            }
        }
    }
    items
}
