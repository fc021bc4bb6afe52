//! Parses the header of a PLY file: format, elements, properties.
//!
//! Line ends can be LF, CRLF, or CR (old Macintosh). The first line decides which, because in a binary file the byte
//! after the header's last line end belongs to the body.

use crate::scene::text::{Fault, quote};

/// The type of a number in the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
    /// A type that is unknown, of a property in an ASCII file that is not used.
    Other,
}

impl Scalar {
    /// Size in a binary file in bytes.
    pub fn size(self) -> usize {
        match self {
            Scalar::I8 | Scalar::U8 => 1,
            Scalar::I16 | Scalar::U16 => 2,
            Scalar::I32 | Scalar::U32 | Scalar::F32 => 4,
            Scalar::I64 | Scalar::U64 | Scalar::F64 => 8,
            Scalar::Other => 1,
        }
    }

    pub fn is_integer(self) -> bool {
        !matches!(self, Scalar::F32 | Scalar::F64 | Scalar::Other)
    }

    /// The type of a name, which is an original one or a later one with a width. Those of 64 bits are not of the
    /// format, but common.
    fn from_name(name: &str) -> Option<Scalar> {
        Some(match name.to_ascii_lowercase().as_str() {
            "char" | "int8" => Scalar::I8,
            "uchar" | "uint8" => Scalar::U8,
            "short" | "int16" => Scalar::I16,
            "ushort" | "uint16" => Scalar::U16,
            "int" | "int32" => Scalar::I32,
            "uint" | "uint32" => Scalar::U32,
            "int64" | "long" | "longlong" => Scalar::I64,
            "uint64" | "ulong" | "ulonglong" => Scalar::U64,
            "float" | "float32" => Scalar::F32,
            "double" | "float64" => Scalar::F64,
            _ => return None,
        })
    }
}

/// The type of a property.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PropertyType {
    Scalar(Scalar),
    /// A list: a number of type `count`, and that many items of type `item`.
    List {
        count: Scalar,
        item: Scalar,
    },
}

/// A property of an element.
#[derive(Clone, Debug)]
pub struct Property {
    pub name: String,
    pub kind: PropertyType,
}

/// An element: `count` rows with the same properties.
#[derive(Clone, Debug)]
pub struct Element {
    pub name: String,
    pub count: u64,
    pub properties: Vec<Property>,
    /// Line of its declaration.
    pub line: usize,
}

impl Element {
    /// The index of the property of that name; otherwise of one that differs only in case.
    pub fn find(&self, name: &str) -> Option<usize> {
        let like = |p: &Property| p.name.eq_ignore_ascii_case(name);
        self.find_exactly(name).or_else(|| self.properties.iter().position(like))
    }

    fn find_exactly(&self, name: &str) -> Option<usize> {
        self.properties.iter().position(|p| p.name == name)
    }
}

/// The encoding of numbers in the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// The content of the header, and the position of the body.
#[derive(Clone, Debug)]
pub struct Header {
    pub encoding: Encoding,
    pub elements: Vec<Element>,
    /// The byte that ends a line.
    pub newline: u8,
    /// Offset of the body's first byte.
    pub body: usize,
    /// Line number of the body's first line.
    pub body_line: usize,
    /// Lines with warnings about them.
    pub warnings: Vec<(usize, String)>,
}

impl Header {
    /// The element of that name; otherwise one that differs only in case.
    pub fn element(&self, name: &str) -> Option<&Element> {
        let like = |e: &&Element| e.name.eq_ignore_ascii_case(name);
        self.elements.iter().find(|e| e.name == name).or_else(|| self.elements.iter().find(like))
    }
}

/// The largest number of elements, and of properties of an element. Each is compared with all before it.
const MAX_DECLARATIONS: usize = 1000;

#[cold]
fn too_many(line: usize, declarations: &str) -> Fault {
    let problem = format!("there are more than {MAX_DECLARATIONS} {declarations}");
    Fault::new(Some(line), problem, "remove those that are not needed for triangles")
}

/// Parses the header.
pub fn parse(bytes: &[u8]) -> Result<Header, Fault> {
    if bytes.is_empty() {
        return Err(Fault::new(None, "the file is empty", "if it was downloaded, download it again"));
    }
    let first_end = bytes.iter().take(64).position(|&b| b == b'\n' || b == b'\r');
    let Some(first_end) = first_end.filter(|&end| bytes[..end].trim_ascii().eq_ignore_ascii_case(b"ply")) else {
        return Err(Fault::new(Some(1), "not a PLY file: the first line is not `ply`", "check the file's extension"));
    };
    let newline = if bytes[first_end] == b'\r' && bytes.get(first_end + 1) != Some(&b'\n') { b'\r' } else { b'\n' };

    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    let mut warnings: Vec<(usize, String)> = Vec::new();
    let (mut unknown_type, mut ignored) = (None, 0);
    let (mut at, mut line) = (0, 0);
    while at < bytes.len() {
        let end = at + bytes[at..].iter().position(|&b| b == newline).unwrap_or(bytes.len() - at);
        let text = String::from_utf8_lossy(&bytes[at..end]);
        at = (end + 1).min(bytes.len());
        line += 1;
        let mut words: Vec<&str> = text.split_ascii_whitespace().collect();
        let keyword = words.first().map(|word| word.to_ascii_lowercase()).unwrap_or_default();
        if let Some(word) = words.first_mut().filter(|word| KEYWORDS.contains(&keyword.as_str()) && **word != keyword) {
            *word = &keyword;
            if !warnings.iter().any(|(_, text)| text == CAPITALS) {
                warnings.push((line, CAPITALS.to_owned()));
            }
        }
        match words[..] {
            ["ply"] if line == 1 => {}
            [] | ["comment" | "obj_info", ..] => {}
            ["format", name] => {
                encoding = Some(parse_format(name, "1.0", line)?);
                warnings.push((line, "the format has no version: 1.0 is assumed".to_owned()));
            }
            ["format", name, version] => encoding = Some(parse_format(name, version, line)?),
            ["element", name, count] => {
                let used = FACES.iter().chain(["vertex"].iter()).any(|used| used.eq_ignore_ascii_case(name));
                if used && elements.iter().any(|e| e.name == name) {
                    return Err(Fault::new(
                        Some(line),
                        format!("the element {} is declared twice", quote(name)),
                        "merge them",
                    ));
                }
                let count = count.parse().map_err(|_| {
                    Fault::new(
                        Some(line),
                        format!("{} is not a number of {} elements", quote(count), quote(name)),
                        "write a whole number of 0 or more",
                    )
                })?;
                if elements.len() == MAX_DECLARATIONS {
                    return Err(too_many(line, "elements"));
                }
                elements.push(Element { name: name.to_owned(), count, properties: Vec::new(), line });
            }
            ["property", ..] => {
                let property = parse_property(&words, line, &mut unknown_type, &mut warnings)?;
                let Some(element) = elements.last_mut() else {
                    return Err(Fault::new(
                        Some(line),
                        "there is a property before the first element",
                        "put it below an element",
                    ));
                };
                if is_used(&property.name) && element.find_exactly(&property.name).is_some() {
                    return Err(Fault::new(
                        Some(line),
                        format!(
                            "the property {} of element {} is declared twice",
                            quote(&property.name),
                            quote(&element.name)
                        ),
                        "rename or remove one of them",
                    ));
                }
                if element.properties.len() == MAX_DECLARATIONS {
                    return Err(too_many(line, "properties of an element"));
                }
                element.properties.push(property);
            }
            ["end_header"] => {
                let Some(encoding) = encoding else {
                    return Err(Fault::new(Some(line), "the header has no `format` line", FORMAT_HINT));
                };
                if let Some(fault) = unknown_type.filter(|_| encoding != Encoding::Ascii) {
                    return Err(fault);
                }
                return Ok(Header { encoding, elements, newline, body: at, body_line: line + 1, warnings });
            }
            [word, ..] if ignored < MAX_IGNORED && is_prose(word) => {
                ignored += 1;
                warnings.push((line, "the line is none of a PLY header, and is taken for a comment".to_owned()));
            }
            _ => {
                return Err(Fault::new(
                    Some(line),
                    format!("{} is not a line of a PLY header", quote(text.trim())),
                    "the header must end with a line `end_header`",
                ));
            }
        }
    }
    Err(Fault::new(
        Some(line),
        "the file ends within its header: there is no `end_header`",
        "the file is truncated: download it again",
    ))
}

/// The first words of lines of a header.
const KEYWORDS: [&str; 7] = ["ply", "format", "comment", "obj_info", "element", "property", "end_header"];

/// The elements with faces.
pub const FACES: [&str; 2] = ["face", "tristrips"];

/// The warning about keywords in capitals.
const CAPITALS: &str = "the keywords are not in lower case: they are read";

/// The largest number of lines that lack the word `comment`.
const MAX_IGNORED: usize = 100;

/// True for the first word of a line that may be a comment without the word `comment`.
fn is_prose(word: &str) -> bool {
    word.starts_with(|c: char| c.is_alphabetic()) && !KEYWORDS.contains(&word)
}

/// True for the name of a property that this reader uses.
fn is_used(name: &str) -> bool {
    let used = ["x", "y", "z", "nx", "ny", "nz", "vertex_indices", "vertex_index"];
    used.iter().any(|used| used.eq_ignore_ascii_case(name))
}

const FORMAT_HINT: &str = "it must be `format ascii 1.0`, `binary_little_endian 1.0` or `binary_big_endian 1.0`";

fn parse_format(name: &str, version: &str, line: usize) -> Result<Encoding, Fault> {
    if version.parse() != Ok(1.0) {
        return Err(Fault::new(Some(line), format!("PLY version {} is unknown", quote(version)), FORMAT_HINT));
    }
    match name.to_ascii_lowercase().as_str() {
        "ascii" => Ok(Encoding::Ascii),
        "binary_little_endian" => Ok(Encoding::LittleEndian),
        "binary_big_endian" => Ok(Encoding::BigEndian),
        _ => Err(Fault::new(Some(line), format!("PLY format {} is unknown", quote(name)), FORMAT_HINT)),
    }
}

/// Parses `property TYPE NAME` or `property list COUNT-TYPE ITEM-TYPE NAME`. An unknown type of a property that is not
/// used is no error in an ASCII file; `unknown` then has the error for a binary file.
fn parse_property(
    words: &[&str],
    line: usize,
    unknown: &mut Option<Fault>,
    warnings: &mut Vec<(usize, String)>,
) -> Result<Property, Fault> {
    let used = words.last().is_some_and(|name| is_used(name));
    let mut scalar = |name: &str| match Scalar::from_name(name) {
        Some(found) => Ok(found),
        None => {
            let fault = Fault::new(
                Some(line),
                format!("type {} is unknown", quote(name)),
                "types are char, uchar, short, ushort, int, uint, float, double",
            );
            if used {
                return Err(fault);
            }
            unknown.get_or_insert(fault);
            Ok(Scalar::Other)
        }
    };
    match *words {
        ["property", list, count, item, name] if list.eq_ignore_ascii_case("list") => {
            let (count, item) = (scalar(count)?, scalar(item)?);
            if used && !(count.is_integer() && item.is_integer()) {
                warnings
                    .push((line, "the list has a count or indices of a type that is not for whole numbers".to_owned()));
            }
            Ok(Property { name: name.to_owned(), kind: PropertyType::List { count, item } })
        }
        ["property", kind, name] if !kind.eq_ignore_ascii_case("list") => {
            Ok(Property { name: name.to_owned(), kind: PropertyType::Scalar(scalar(kind)?) })
        }
        _ => Err(Fault::new(
            Some(line),
            "this is not the declaration of a property",
            "write `property TYPE NAME` or `property list TYPE TYPE NAME`",
        )),
    }
}
