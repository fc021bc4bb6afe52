//! Parses the corners of faces: `position`, `position/texture`, `position//normal` or `position/texture/normal`.

use super::Fault;
use super::face::{Corner, Faces};
use super::lines::{Lines, printable};
use crate::scene::text::odd;

/// The fewest bytes of a statement that defines a vertex, with its line end.
const LEAST_VERTEX: usize = 8;

impl Faces {
    /// Parses a corner with plain indices, of a vertex and a normal that precede it in the file. `None` does not mean
    /// that there is no corner.
    #[inline]
    pub(super) fn plain_corner(&self, word: &[u8]) -> Option<Corner> {
        let (position, rest) = index(word)?;
        let position = resolve(position, self.positions.len())?;
        let Some(rest) = rest.strip_prefix(b"/") else {
            return rest.is_empty().then_some(Corner { position, normal: None });
        };
        // The index of the texture coordinate is ignored.
        let rest = if rest.starts_with(b"/") || rest.is_empty() { rest } else { index(rest)?.1 };
        match rest.strip_prefix(b"/") {
            None if rest.is_empty() => Some(Corner { position, normal: None }),
            Some(b"") => Some(Corner { position, normal: None }),
            Some(rest) => match index(rest)? {
                (normal, b"") => Some(Corner { position, normal: Some(resolve(normal, self.normals.len())?) }),
                _ => None,
            },
            None => None,
        }
    }

    /// Adds the corners of a word that [`Faces::plain_corner`] does not parse: of vertices or normals that follow in
    /// the file, with texture coordinates or normals that do not exist, or in unusual notations.
    ///
    /// # Errors
    /// There is no such vertex.
    #[cold]
    pub(super) fn odd_corners<'a>(&mut self, word: &'a [u8], lines: &mut Lines<'a>) -> Result<(), Fault> {
        let line = lines.line();
        let word = lines.before_comment(word);
        let mut unusual = word.contains(&b',');
        for piece in word.split(|&b| b == b',').filter(|piece| !piece.is_empty()) {
            let broken = || {
                let problem = format!("`{}` is not a corner of a face", printable(word));
                Fault::new(line, problem, "write v, v/vt, v//vn or v/vt/vn")
            };
            let mut parts = piece.split(|&b| b == b'/');
            let (position, texture, normal) = (parts.next().unwrap_or_default(), parts.next(), parts.next());
            if parts.next().is_some() {
                self.problems.surplus.get_or_insert(line);
            }
            let given = odd_index(position, &mut unusual).ok_or_else(broken)?;
            let position = self.odd_position(given, lines.left(), line)?;
            if texture.is_some_and(|texture| !texture.is_empty() && odd_index(texture, &mut unusual).is_none()) {
                self.problems.add_texture(line);
            }
            let normal = normal.filter(|normal| !normal.is_empty());
            let normal = normal.and_then(|normal| self.odd_normal(odd_index(normal, &mut unusual), line));
            self.add_corner(Corner { position, normal }, line)?;
        }
        if unusual {
            lines.unusual.get_or_insert(line);
        }
        Ok(())
    }

    /// The index of a position from 0, which may follow in the remaining bytes, `left`.
    fn odd_position(&mut self, given: i64, left: usize, line: usize) -> Result<u32, Fault> {
        let count = self.positions.len();
        if let Some(index) = resolve(given, count) {
            return Ok(index);
        }
        let possible = count + (left + 1) / LEAST_VERTEX;
        match resolve(given.max(0), possible) {
            Some(index) => {
                self.make_room(index as usize);
                self.problems.set_forward();
                Ok(index)
            }
            None => {
                let problem = format!("a face uses vertex {given}, but {count} are defined before it");
                Err(Fault::new(line, problem, "indices count from 1, or backwards from -1"))
            }
        }
    }

    /// The index of a normal from 0, which may follow in the file; `None` if there is no such normal.
    fn odd_normal(&mut self, given: Option<i64>, line: usize) -> Option<u32> {
        let count = self.normals.len();
        if let Some(index) = given.and_then(|given| resolve(given, count)) {
            return Some(index);
        }
        match given.and_then(|given| u32::try_from(given).ok()).filter(|&given| given > 0 && given < u32::MAX) {
            Some(given) => {
                self.problems.add_forward_normal(given, line);
                Some(given - 1)
            }
            None => {
                self.problems.add_missing_normal(line);
                None
            }
        }
    }
}

/// Parses an integer at the start; also returns the rest.
#[inline]
fn index(bytes: &[u8]) -> Option<(i64, &[u8])> {
    let negative = bytes.first() == Some(&b'-');
    let digits = &bytes[usize::from(negative)..];
    let length = digits.iter().take_while(|b| b.is_ascii_digit()).count();
    if !(1..=18).contains(&length) {
        return None;
    }
    let value = digits[..length].iter().fold(0i64, |value, b| value * 10 + i64::from(b - b'0'));
    Some((if negative { -value } else { value }, &digits[length..]))
}

/// Parses a whole word as an index, also with a plus sign or with decimals, in which case `unusual` is set.
fn odd_index(word: &[u8], unusual: &mut bool) -> Option<i64> {
    if let Some((value, b"")) = index(word) {
        return Some(value);
    }
    let value = odd::whole(word)?;
    *unusual = true;
    Some(value)
}

/// Converts an index, which counts from 1 or backwards from -1, to one that counts from 0, if it is in range.
#[inline]
fn resolve(given: i64, count: usize) -> Option<u32> {
    let index = if given < 0 { given + count as i64 } else { given - 1 };
    (0..count as i64).contains(&index).then_some(index as u32)
}
