//! Thousands of mutated names of renderers and of random scenes: each is read, or refused with one line.

use rtbench::workloads::spheres::options::Renderer;
use rtbench::workloads::spheres::scene::Scene;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Variants of each kind of name.
const VARIANTS: usize = 4000;

/// What is put into a name: characters that mean something in it, and some that mean nothing.
const ALPHABET: &[char] = &[
    'a',
    'd',
    'e',
    'g',
    'l',
    'm',
    'n',
    'p',
    'r',
    's',
    't',
    'x',
    'S',
    '0',
    '1',
    '2',
    '4',
    '8',
    '9',
    '-',
    '+',
    '.',
    ',',
    ':',
    '=',
    ' ',
    '\t',
    '/',
    '\'',
    '"',
    '%',
    '{',
    '}',
    '\u{e9}',
    '\u{2212}',
    '\u{ff11}',
    '\u{1f600}',
    '\u{0}',
];

/// SplitMix64: the same variants on every machine.
struct Random(u64);

impl Random {
    /// A number from 0 to below `n`.
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % n as u64) as usize
    }

    /// A name with one to four characters inserted, deleted or replaced.
    fn variant(&mut self, name: &str) -> String {
        let mut characters: Vec<char> = name.chars().collect();
        for _ in 0..=self.below(4) {
            let new = ALPHABET[self.below(ALPHABET.len())];
            let at = self.below(characters.len() + 1);
            match self.below(3) {
                0 => characters.insert(at, new),
                _ if at == characters.len() => {}
                1 => characters[at] = new,
                _ => drop(characters.remove(at)),
            }
        }
        characters.into_iter().collect()
    }
}

/// What is wrong with how a name was taken; nothing where it was read, or refused as it should be.
fn fault<T>(name: &str, read: impl FnOnce(&str) -> rtbench::error::Result<T>) -> (bool, Option<String>) {
    match catch_unwind(AssertUnwindSafe(|| read(name))) {
        Err(_) => (false, Some(format!("{name:?}: a panic"))),
        Ok(Ok(_)) => (true, None),
        Ok(Err(error)) => {
            let (text, code) = (error.to_string(), error.exit_code());
            let is_right = code == 2 && !text.is_empty() && text.lines().count() == 1;
            (false, (!is_right).then(|| format!("{name:?}: exit code {code}, {text:?}")))
        }
    }
}

/// Reads variants of names; both kinds of outcomes must be among them, or nothing is tested.
fn mutated<T>(names: &[&str], read: impl Fn(&str) -> rtbench::error::Result<T>) {
    let mut random = Random(18);
    let mut accepted = 0;
    for variant in 0..VARIANTS {
        let name = random.variant(names[variant % names.len()]);
        let (was_read, fault) = fault(&name, &read);
        assert_eq!(fault, None);
        accepted += usize::from(was_read);
    }
    assert!(accepted > VARIANTS / 100 && accepted < VARIANTS / 2, "{accepted} of {VARIANTS} were read");
}

#[test]
fn mutated_names_of_renderers_are_read_or_refused_with_one_line() {
    let names = [
        "all",
        "sequential",
        "gpu",
        "threads:threads=3",
        "simd:lanes=16,level=avx512",
        "simd:lanes=4,level=sse2",
        "simd-threads:lanes=8,level=neon,threads=12",
    ];
    mutated(&names, Renderer::parse_all);
    // What is read is read again as it is written
    mutated(&names[1..], |name| {
        let renderer = Renderer::parse(name)?;
        assert_eq!(Renderer::parse(&renderer.to_string())?, renderer);
        Ok(())
    });
}

#[test]
fn mutated_names_of_random_scenes_are_read_or_refused_with_one_line() {
    let names = ["random:spheres=3,seed=7", "random:seed=18446744073709551615,spheres=12", "random:spheres=5"];
    mutated(&names, |name| {
        let scene = Scene::load(name)?;
        assert!((1..=100_000).contains(&scene.spheres.len()), "{name}");
        Ok(())
    });
}

#[test]
fn panics_and_errors_of_several_lines_are_noticed() {
    let refused = |problem: &str| Err::<(), _>(rtbench::Error::argument("--renderer", problem, "a hint"));
    assert_eq!(fault("x", |_| refused("wrong")), (false, None));
    // What a user typed is shown with its line breaks escaped, what a device says is not
    assert_eq!(fault("x", |_| refused("two\nlines")), (false, None));
    let two_lines = || rtbench::Error::Device("two\nlines".into());
    assert!(fault("x", |_| Err::<(), _>(two_lines())).1.unwrap().contains("exit code 2"));
    assert!(fault("x", |_| Err::<(), _>(rtbench::Error::Interrupted)).1.unwrap().contains("exit code 130"));
    assert!(fault::<()>("x", |_| panic!("planted")).1.unwrap().contains("a panic"));
    assert_eq!(fault("x", |_| Ok(())), (true, None));
}
