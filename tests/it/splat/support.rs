//! What tests of photon splatting share.

/// SplitMix64: the same numbers on every machine.
pub struct Random(pub u64);

impl Random {
    /// A number from 0 to below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % n as u64) as usize
    }
}

/// What is put into a text: pieces that mean something in flags and tables, and some that mean nothing.
const PIECES: &[&str] = &[
    "",
    "-",
    "+",
    ".",
    ",",
    ":",
    "=",
    "/",
    "e",
    "1e39",
    "-0",
    "inf",
    "nan",
    "1e400",
    "x",
    "flux",
    "point",
    "[",
    "]",
    "{",
    "}",
    "\"",
    " ",
    "\n",
    "0",
    "7",
    "9999999999999999999",
    "\u{e9}",
    "\u{2212}",
    "\u{1f600}",
    "\u{0}",
];

/// A text with one to three pieces removed, doubled or put in.
pub fn mutated(text: &str, random: &mut Random) -> String {
    let mut characters: Vec<String> = text.chars().map(String::from).collect();
    for _ in 0..=random.below(3) {
        let at = random.below(characters.len() + 1);
        match random.below(4) {
            0 if at < characters.len() => drop(characters.remove(at)),
            1 if at < characters.len() => characters.insert(at, characters[at].clone()),
            2 if at < characters.len() => characters[at] = PIECES[random.below(PIECES.len())].to_owned(),
            _ => characters.insert(at, PIECES[random.below(PIECES.len())].to_owned()),
        }
    }
    characters.concat()
}
