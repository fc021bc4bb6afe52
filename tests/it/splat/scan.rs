//! Prefix sums: every length against a loop, on the CPU and on a device, and totals around 2^32.

use crate::support::gpu_with;
use rtbench::device::vulkan::{Binding, BindingKind, Buffer, Dispatch, Groups, PipelineDescription};
use rtbench::device::{Feature, Features, Frame, POISON, Pass, Stage, VulkanDevice};
use rtbench::error::{Error, Refusal};
use rtbench::workloads::scan::{self, GROUP_ELEMENTS, GROUP_SIZE, Options, Scan};
use std::sync::OnceLock;

/// 512, 512^2.
const GROUP: usize = GROUP_ELEMENTS as usize;
const GROUPS: usize = GROUP * GROUP;

/// Copies all words of the first buffer to the second.
const COPY: &str = "
@group(0) @binding(0) var<storage, read> from_words: array<u32>;
@group(0) @binding(1) var<storage, read_write> to_words: array<u32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var i = id.x; i < arrayLength(&from_words); i += 65536u) {
        to_words[i] = from_words[i];
    }
}
";

/// Words after those that are scanned, which nothing may touch: with more, the longest buffer could not be bound.
const MORE: usize = 1;

/// A device for either variant: one without subgroups first.
fn devices() -> Vec<(&'static VulkanDevice, Options)> {
    static WITH_SUBGROUPS: OnceLock<Option<VulkanDevice>> = OnceLock::new();
    let with_subgroups = WITH_SUBGROUPS.get_or_init(|| gpu_with(Features::of(&[Feature::Subgroups])));
    static WITHOUT: OnceLock<Option<VulkanDevice>> = OnceLock::new();
    let plain =
        WITHOUT.get_or_init(|| gpu_with(Features::default())).as_ref().map(|device| (device, Options::default()));
    plain.into_iter().chain(with_subgroups.as_ref().map(|device| (device, Options { subgroups: true }))).collect()
}

/// The sums before each word modulo 2^32, and the sum of all.
fn expected(values: &[u32]) -> (Vec<u32>, u64) {
    let mut sum = 0_u64;
    let before = values.iter().map(|&value| {
        let before = sum as u32;
        sum += u64::from(value);
        before
    });
    (before.collect(), sum)
}

/// What is wrong with a scan, if anything.
fn problem(expected: &[u32], found: &[u32]) -> Option<String> {
    if expected.len() != found.len() {
        return Some(format!("{} words instead of {}", found.len(), expected.len()));
    }
    let at = expected.iter().zip(found).position(|(expected, found)| expected != found)?;
    Some(format!("word {at} of {}: {} instead of {}", found.len(), found[at], expected[at]))
}

/// The sum of all words, or `None` where it is refused as too large.
fn total(checked: rtbench::Result<u32>) -> Option<u32> {
    match checked {
        Ok(total) => Some(total),
        Err(Error::Refused(Refusal::TooLarge(message))) => {
            assert!(message.contains("2^32"), "{message}");
            None
        }
        Err(other) => panic!("{other}"),
    }
}

/// A scan over buffers of its own.
struct Scanned<'d> {
    device: &'d VulkanDevice,
    length: usize,
    input: Option<Buffer>,
    output: Buffer,
    scan: Scan,
}

impl<'d> Scanned<'d> {
    fn new(device: &'d VulkanDevice, options: Options, in_place: bool, values: &[u32]) -> Scanned<'d> {
        let length = values.len();
        let output = device.poisoned("the sums", (length + MORE) as u64 * 4).unwrap();
        let input = (!in_place).then(|| device.storage("the values", values).unwrap());
        let scan = match &input {
            Some(input) => Scan::new(device, options, input, &output, length as u32),
            None => Scan::in_place(device, options, &output, length as u32),
        };
        Scanned { device, length, input, output, scan: scan.unwrap() }
    }

    /// Scans these values, of the same number as before; where they have a buffer of their own, those.
    fn run(&self, values: &[u32]) -> (Vec<u32>, Option<u32>) {
        let &Scanned { device, length, .. } = self;
        device.poison(&self.output);
        if self.input.is_none() && length > 0 {
            let layout = [Binding::new(0, BindingKind::Read), Binding::new(1, BindingKind::ReadWrite)];
            let description = PipelineDescription {
                label: "copy",
                text: COPY,
                layout: &layout,
                checked: false,
                zero_workgroup_memory: false,
            };
            let pipeline = device.pipeline(&description).unwrap();
            // Shorter buffers do not exist: the words after the values stay poisoned
            let mut all = values.to_vec();
            all.resize((length + MORE).max(24), POISON);
            let from = device.storage("the values", &all[..length + MORE]).unwrap();
            let bindings = device.bind(&pipeline, &[(0, (&from).into()), (1, (&self.output).into())]);
            let work =
                Dispatch { pipeline: &pipeline, bindings: &bindings, offset: None, groups: Groups::Fixed(1024, 1, 1) };
            device.run(&Frame::new(vec![Pass { stage: Stage("copy"), work }])).unwrap();
        }
        device.run(&Frame::new(self.scan.passes(Stage("scan")))).unwrap();
        let mut found: Vec<u32> = device.read(&self.output, length + MORE).unwrap();
        let more = found.split_off(length);
        assert_eq!(more, [POISON; MORE], "{length} words");
        (found, total(self.scan.check(device)))
    }
}

fn values(length: usize, seed: u32) -> Vec<u32> {
    // The sum of all stays below 2^32
    let limit = (u64::from(u32::MAX) / length.max(1) as u64).min(u64::from(u32::MAX)) as u32;
    let mut state = seed;
    let mut next = || {
        state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
        ((u64::from(state ^ (state >> 13)) * u64::from(limit)) >> 32) as u32
    };
    (0..length).map(|_| next()).collect()
}

/// Compares twin, device and both forms with a loop; the scan of a frame that runs twice is the same.
fn compare(values: &[u32], both_forms: bool) {
    let (before, sum) = expected(values);
    let sum = u32::try_from(sum).ok();
    match scan::exclusive(values) {
        Ok((found, total)) => assert_eq!((problem(&before, &found), Some(total)), (None, sum)),
        refused => assert_eq!(total(refused.map(|(_, total)| total)), sum, "{} words", values.len()),
    }
    for (device, options) in devices() {
        for in_place in [false, true].into_iter().take(if both_forms { 2 } else { 1 }) {
            let scanned = Scanned::new(device, options, in_place, values);
            for _ in 0..2 {
                let (found, total) = scanned.run(values);
                assert_eq!(problem(&before, &found), None, "{options:?}, in place: {in_place}");
                assert_eq!(total, sum, "{options:?}, in place: {in_place}, {} words", values.len());
            }
        }
    }
}

#[test]
fn every_length_agrees_with_a_loop() {
    let lengths = [0, 1, 2, 8, 9, 63, 64, 65, GROUP - 1, GROUP, GROUP + 1, 5 * GROUP + 77];
    for length in lengths.into_iter().chain(GROUPS - 1..=GROUPS + 1) {
        compare(&values(length, length as u32), true);
    }
}

#[test]
fn long_scans_agree_with_a_loop() {
    compare(&values(1 << 23, 5), true);
}

/// More groups than a row of a dispatch has, and a buffer of almost 128 MiB.
#[test]
fn the_longest_scan_agrees_with_a_loop() {
    compare(&values((1 << 25) - 1, 7), false);
}

#[test]
fn a_wrong_word_is_noticed() {
    let before = expected(&values(1000, 3)).0;
    assert_eq!(problem(&before, &before), None);
    for at in [0, 511, 512, 999] {
        let mut wrong = before.clone();
        wrong[at] ^= 1;
        assert!(problem(&before, &wrong).unwrap().starts_with(&format!("word {at} of 1000")));
    }
    assert!(problem(&before, &before[1..]).is_some());
}

/// Words of zero but for these.
fn sparse(length: usize, words: &[(usize, u32)]) -> Vec<u32> {
    let mut values = vec![0; length];
    words.iter().for_each(|&(at, word)| values[at] = word);
    values
}

#[test]
fn a_total_of_a_full_word_passes_and_one_more_is_refused() {
    const HALF: u32 = 1 << 31;
    // Each sums up to 2^32 - 1, and to 2^32 with one more at any place
    let at_the_limit = [
        vec![u32::MAX],
        // The words of one invocation, of neighbours, of the first and the last
        sparse(512, &[(0, HALF), (1, HALF - 1)]),
        sparse(512, &[(200, HALF), (300, HALF - 1)]),
        sparse(512, &[(0, HALF), (511, HALF - 1)]),
        // In the middle of a group of the lowest level: of one invocation, of two
        sparse(1000, &[(100, HALF), (164, HALF - 1)]),
        sparse(1000, &[(600, HALF), (901, HALF - 1)]),
        // In the second and in the third level only: all groups are far below
        {
            let mut values = vec![1 << 22; 1024];
            values[700] -= 1;
            values
        },
        {
            let mut values = vec![1 << 13; 2 * GROUPS];
            values[GROUPS + 5] -= 1;
            values
        },
    ];
    for values in at_the_limit {
        let sum = |values: &[u32]| values.iter().map(|&value| u64::from(value)).sum::<u64>();
        assert_eq!(sum(&values), u64::from(u32::MAX));
        compare(&values, true);
        let mut more = values.clone();
        let at = more.iter().rposition(|&value| value != u32::MAX).unwrap_or_default();
        if let Some(more) = more.get_mut(at).filter(|value| **value != u32::MAX) {
            *more += 1;
        } else {
            more.push(1);
        }
        assert_eq!(sum(&more), 1 << 32);
        compare(&more, true);
    }
    // Twice round, to the same word
    compare(&sparse(700, &[(3, HALF), (4, HALF), (600, HALF), (699, HALF)]), true);
    compare(&[u32::MAX; 600], true);
}

#[test]
fn a_refused_total_does_not_last() {
    let good = values(5000, 1);
    let mut bad = good.clone();
    bad[2000] = u32::MAX;
    for (device, options) in devices() {
        let scanned = Scanned::new(device, options, true, &good);
        for (values, passes) in [(&good, true), (&bad, false), (&bad, false), (&good, true)] {
            let (found, total) = scanned.run(values);
            assert_eq!(problem(&expected(values).0, &found), None);
            assert_eq!(total.is_some(), passes, "{options:?}");
        }
        assert_eq!(scanned.scan.allocated(), 10 * 4 + 12, "the sums of ten groups, total and note");
        assert_eq!(scanned.scan.kernels().len(), 3, "a reduction, the top, the level below");
    }
}

#[test]
fn what_the_device_has_not_is_refused() {
    let Some(device) = gpu_with(Features::default()) else { return };
    let values = device.storage("the values", &[1_u32, 2, 3]).unwrap();
    let refused = |options, length| Scan::in_place(&device, options, &values, length).err().map(|e| e.to_string());
    assert_eq!(refused(Options::default(), 3), None);
    assert!(refused(Options { subgroups: true }, 3).unwrap().contains("subgroups"));
    assert!(refused(Options::default(), 4).unwrap().contains("4 words"));
    let most = device.max_binding() / 4;
    if let Ok(more) = u32::try_from(most + 1) {
        assert!(refused(Options::default(), more).unwrap().starts_with("too large"));
    }
}

#[test]
fn kernels_are_valid_and_their_names_are_different() {
    let kernels = scan::kernels().unwrap();
    assert_eq!(kernels.len(), 2 * (1 + 4));
    let names: std::collections::BTreeSet<&String> = kernels.iter().map(|(name, _)| name).collect();
    let hashes: std::collections::BTreeSet<String> = kernels.iter().map(|(_, source)| source.hash()).collect();
    assert_eq!((names.len(), hashes.len()), (10, 10));
    for (name, source) in &kernels {
        let cost = source.cost().unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(cost.subgroup > 0, name.ends_with("subgroups"), "{name}");
        assert!(cost.barrier > 0 && cost.workgroup_bytes >= u64::from(GROUP_SIZE) * 4, "{name}");
    }
}
