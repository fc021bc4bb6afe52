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
    F32,
    F64,
}

impl Scalar {
    /// Size in a binary file in bytes.
    pub fn size(self) -> usize {
        match self {
            Scalar::I8 | Scalar::U8 => 1,
            Scalar::I16 | Scalar::U16 => 2,
            Scalar::I32 | Scalar::U32 | Scalar::F32 => 4,
            Scalar::F64 => 8,
        }
    }

    pub fn is_integer(self) -> bool {
        !matches!(self, Scalar::F32 | Scalar::F64)
    }

    /// The type of a name, which is an original one or a later one with a width.
    fn from_name(name: &str) -> Option<Scalar> {
        Some(match name {
            "char" | "int8" => Scalar::I8,
            "uchar" | "uint8" => Scalar::U8,
            "short" | "int16" => Scalar::I16,
            "ushort" | "uint16" => Scalar::U16,
            "int" | "int32" => Scalar::I32,
            "uint" | "uint32" => Scalar::U32,
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
    /// The index of the property of that name.
    pub fn find(&self, name: &str) -> Option<usize> {
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
}

impl Header {
    /// The element of that name.
    pub fn element(&self, name: &str) -> Option<&Element> {
        self.elements.iter().find(|e| e.name == name)
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
    let Some(first_end) = first_end.filter(|&end| bytes[..end].trim_ascii() == b"ply") else {
        return Err(Fault::new(Some(1), "not a PLY file: the first line is not `ply`", "check the file's extension"));
    };
    let newline = if bytes[first_end] == b'\r' && bytes.get(first_end + 1) != Some(&b'\n') { b'\r' } else { b'\n' };

    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    let (mut at, mut line) = (0, 0);
    while at < bytes.len() {
        let end = at + bytes[at..].iter().position(|&b| b == newline).unwrap_or(bytes.len() - at);
        let text = String::from_utf8_lossy(&bytes[at..end]);
        at = (end + 1).min(bytes.len());
        line += 1;
        let words: Vec<&str> = text.split_ascii_whitespace().collect();
        match words[..] {
            ["ply"] if line == 1 => {}
            [] | ["comment" | "obj_info", ..] => {}
            ["format", name, version] => encoding = Some(parse_format(name, version, line)?),
            ["element", name, count] => {
                if elements.iter().any(|e| e.name == name) {
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
                let property = parse_property(&words, line)?;
                let Some(element) = elements.last_mut() else {
                    return Err(Fault::new(
                        Some(line),
                        "there is a property before the first element",
                        "put it below an element",
                    ));
                };
                if element.find(&property.name).is_some() {
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
                return Ok(Header { encoding, elements, newline, body: at, body_line: line + 1 });
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

const FORMAT_HINT: &str = "it must be `format ascii 1.0`, `binary_little_endian 1.0` or `binary_big_endian 1.0`";

fn parse_format(name: &str, version: &str, line: usize) -> Result<Encoding, Fault> {
    if version != "1.0" {
        return Err(Fault::new(Some(line), format!("PLY version {} is unknown", quote(version)), FORMAT_HINT));
    }
    match name {
        "ascii" => Ok(Encoding::Ascii),
        "binary_little_endian" => Ok(Encoding::LittleEndian),
        "binary_big_endian" => Ok(Encoding::BigEndian),
        _ => Err(Fault::new(Some(line), format!("PLY format {} is unknown", quote(name)), FORMAT_HINT)),
    }
}

/// Parses `property TYPE NAME` or `property list COUNT-TYPE ITEM-TYPE NAME`.
fn parse_property(words: &[&str], line: usize) -> Result<Property, Fault> {
    let scalar = |name: &str| {
        Scalar::from_name(name).ok_or_else(|| {
            Fault::new(
                Some(line),
                format!("type {} is unknown", quote(name)),
                "types are char, uchar, short, ushort, int, uint, float, double",
            )
        })
    };
    match *words {
        ["property", "list", count, item, name] => {
            let (count, item) = (scalar(count)?, scalar(item)?);
            if !count.is_integer() {
                return Err(Fault::new(
                    Some(line),
                    format!("the type of the count of list {} is not an integer type", quote(name)),
                    "use uchar or int",
                ));
            }
            Ok(Property { name: name.to_owned(), kind: PropertyType::List { count, item } })
        }
        ["property", kind, name] if kind != "list" => {
            Ok(Property { name: name.to_owned(), kind: PropertyType::Scalar(scalar(kind)?) })
        }
        _ => Err(Fault::new(
            Some(line),
            "this is not the declaration of a property",
            "write `property TYPE NAME` or `property list TYPE TYPE NAME`",
        )),
    }
}
