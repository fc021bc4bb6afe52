//! Mutations of files: of lines, words and numbers in texts, of bytes and 32-bit words in binary files.

/// Extreme and invalid numbers.
const NUMBERS: [&str; 14] = [
    "0",
    "-1",
    "1e38",
    "1e400",
    "-1e38",
    "nan",
    "inf",
    "2147483648",
    "4294967296",
    "1000000000",
    "18446744073709551616",
    "1e-320",
    "1.",
    ".",
];

/// A pseudorandom generator with the same sequence on every machine.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    /// A number below `n`; 0 if `n` is 0.
    pub fn below(&mut self, n: usize) -> usize {
        (self.next() % n.max(1) as u64) as usize
    }
}

/// The ranges of words or lines.
fn pieces(bytes: &[u8], ends: fn(u8) -> bool) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    let mut start = None;
    for (i, &byte) in bytes.iter().chain(b"\n").enumerate() {
        match (ends(byte), start) {
            (false, None) => start = Some(i),
            (true, Some(from)) => {
                found.push((from, i));
                start = None;
            }
            _ => {}
        }
    }
    found
}

/// Mutates a text at one to four positions.
pub fn text(original: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = original.to_vec();
    for _ in 0..1 + random.below(4) {
        if bytes.is_empty() {
            return bytes;
        }
        // Lines, words, or digits at any position
        let ends: fn(u8) -> bool = match random.below(3) {
            0 => |b| b == b'\n',
            1 => |b| b <= b' ',
            _ => |b| !(b.is_ascii_digit() || b == b'.' || b == b'-'),
        };
        let pieces = pieces(&bytes, ends);
        let (from, to) = pieces.get(random.below(pieces.len())).copied().unwrap_or((0, bytes.len()));
        match random.below(8) {
            0 => {
                let at = random.below(bytes.len());
                bytes[at] ^= 1 << random.below(8);
            }
            1 => bytes.truncate(random.below(bytes.len())),
            2 => drop(bytes.drain(from..to)),
            3 => {
                let copy = [&bytes[from..to], b"\n"].concat();
                bytes.splice(from..from, copy);
            }
            4 => {
                let at = random.below(bytes.len());
                bytes[at] = random.next() as u8;
            }
            5 => {
                let other = pieces.get(random.below(pieces.len())).map(|&(from, to)| bytes[from..to].to_vec());
                bytes.splice(from..to, other.unwrap_or_default());
            }
            _ => drop(bytes.splice(from..to, NUMBERS[random.below(NUMBERS.len())].bytes())),
        }
    }
    bytes
}

/// Extreme values of lengths, indices and floats.
const WORDS: [u32; 12] = [
    0,
    1,
    2,
    0xff,
    0x7fff_ffff,
    0x8000_0000,
    0xffff_ffff,
    0x0800_0001,
    0x7f80_0000, // infinity
    0x7fc0_0000, // NaN
    0x7f7f_ffff, // the largest float
    0x0001_0000,
];

/// Mutates a binary file at one to four positions, half of them among its first bytes, which hold lengths.
pub fn bytes(original: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = original.to_vec();
    for _ in 0..1 + random.below(4) {
        let reach = if random.below(2) == 0 { bytes.len().min(256) } else { bytes.len() };
        let at = random.below(reach);
        let end = (at + 1 + random.below(64)).min(bytes.len());
        match random.below(10) {
            _ if bytes.is_empty() => return bytes,
            0 => bytes[at] ^= 1 << random.below(8),
            1 => bytes[at] = random.next() as u8,
            2 => bytes.truncate(at),
            3 => drop(bytes.drain(at..end)),
            4 => {
                let copy = bytes[at..end].to_vec();
                bytes.splice(at..at, copy);
            }
            // Digits are replaced by digits, so that lengths of texts do not change.
            5 => {
                let digit = (at..bytes.len()).find(|&i| bytes[i].is_ascii_digit()).unwrap_or(at);
                bytes[digit] = b'0' + random.below(10) as u8;
            }
            _ => {
                let value = WORDS[random.below(WORDS.len())].to_le_bytes();
                let at = at / 4 * 4;
                for (byte, new) in bytes[at..].iter_mut().zip(value) {
                    *byte = new;
                }
            }
        }
    }
    bytes
}
