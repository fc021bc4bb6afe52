//! The first line of a file, which names its dialect.

use crate::scene::text::{Fault, quote_bytes};

/// The properties of a file that depend on its header.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dialect {
    /// Default crease angle in radians.
    pub crease_angle: f64,
}

/// The dialect of a file.
///
/// # Errors
/// The dialect is not supported; the hint names a converter.
pub fn dialect(bytes: &[u8]) -> Result<Dialect, Fault> {
    let fault = |problem: &str, hint: &str| Err(Fault::new(Some(1), problem, hint));
    if bytes.starts_with(&[0x1f, 0x8b]) {
        return fault("the file is compressed", "gunzip it first");
    }
    let line = bytes.split(|&b| b == b'\n' || b == b'\r').next().unwrap_or_default();
    let words: Vec<&[u8]> = line.split(|&b| b <= b' ').filter(|word| !word.is_empty()).take(3).collect();
    match words.as_slice() {
        [b"#Inventor", _, b"binary", ..] => fault(
            "binary Open Inventor is not supported",
            "ivcat of Debian's inventor-clients converts it to text: ivcat -o out.iv in.iv",
        ),
        // The default of the reference implementation
        [b"#Inventor", b"V2.0" | b"V2.1", b"ascii", ..] => Ok(Dialect { crease_angle: 0.0 }),
        // The default of the specification
        [b"#VRML", b"V1.0", ..] => Ok(Dialect { crease_angle: 0.5 }),
        [b"#VRML", b"V2.0", ..] => {
            fault("VRML 2.0 (VRML97) is not supported, only VRML 1.0 is", "MeshLab converts it to PLY or OBJ")
        }
        [b"#Inventor", b"V1.0", ..] => fault(
            "Open Inventor V1.0 is not supported",
            "ivcat of Debian's inventor-clients converts it to V2.1: ivcat -o out.iv in.iv",
        ),
        _ => {
            let problem = format!("{} is not a header of Open Inventor or VRML 1.0", quote_bytes(line));
            fault(&problem, "the first line must be `#Inventor V2.1 ascii` or `#VRML V1.0 ascii`")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn supported_headers_are_accepted_and_others_refused() {
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
