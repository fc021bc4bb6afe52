//! The first line of a file: which language follows.

use crate::scene::text::{Fault, quote_bytes};

/// What the header decides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dialect {
    /// Radians up to which edges are smooth where the file does not say so.
    pub crease_angle: f64,
}

/// The language of a file.
///
/// # Errors
/// It is one that this reader does not know, with what to do about it.
pub fn dialect(bytes: &[u8]) -> Result<Dialect, Fault> {
    let fault = |problem: &str, hint: &str| Err(Fault::new(Some(1), problem, hint));
    if bytes.starts_with(&[0x1f, 0x8b]) {
        return fault("the file is compressed", "gunzip it first");
    }
    let line = bytes.split(|&b| b == b'\n' || b == b'\r').next().unwrap_or_default();
    let words: Vec<&[u8]> = line.split(|&b| b <= b' ').filter(|word| !word.is_empty()).take(3).collect();
    match words.as_slice() {
        [b"#Inventor", _, b"binary", ..] => fault(
            "binary Open Inventor",
            "ivcat of Debian's inventor-clients turns it into text: ivcat -o out.iv in.iv",
        ),
        // As in the format's own library
        [b"#Inventor", b"V2.0" | b"V2.1", b"ascii", ..] => Ok(Dialect { crease_angle: 0.0 }),
        // As its specification says
        [b"#VRML", b"V1.0", ..] => Ok(Dialect { crease_angle: 0.5 }),
        [b"#VRML", b"V2.0", ..] => {
            fault("VRML 2.0 (VRML97) is another language than VRML 1.0", "MeshLab turns it into PLY or OBJ")
        }
        [b"#Inventor", b"V1.0", ..] => fault(
            "Open Inventor V1.0 is an older language",
            "ivcat of Debian's inventor-clients brings it to V2.1: ivcat -o out.iv in.iv",
        ),
        _ => {
            let problem = format!("{} is no header of Open Inventor or VRML 1.0", quote_bytes(line));
            fault(&problem, "the first line is `#Inventor V2.1 ascii` or `#VRML V1.0 ascii`")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tells_what_it_reads_from_what_it_refuses() {
        for (header, crease) in [
            ("#Inventor V2.1 ascii", 0.0),
            ("#Inventor V2.1 ascii   \r\nCube{}", 0.0),
            ("#Inventor V2.0 ascii\n", 0.0),
            ("#VRML V1.0 ascii\n", 0.5),
        ] {
            assert_eq!(dialect(header.as_bytes()), Ok(Dialect { crease_angle: crease }), "{header}");
        }
        for (header, hint) in [
            ("#Inventor V2.1 binary\n", "ivcat"),
            ("#Inventor V2.0 binary  ", "ivcat"),
            ("#Inventor V1.0 ascii", "ivcat"),
            ("#VRML V2.0 utf8\n", "MeshLab"),
            ("\x1f\u{8b}", "first line"),
            ("Separator {}", "first line"),
            ("", "first line"),
        ] {
            let fault = dialect(header.as_bytes()).expect_err(header);
            assert!(fault.line == Some(1) && fault.hint.contains(hint), "{header}: {fault:?}");
        }
        assert_eq!(dialect(&[0x1f, 0x8b, 8, 0]).unwrap_err().hint, "gunzip it first");
    }
}
