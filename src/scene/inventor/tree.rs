//! The tree of a parsed file: its nodes, with the supported fields, in one list. A node that is used repeatedly is
//! stored once.

use super::node_type::NodeType;
use crate::scene::text::{Fault, quote_bytes};
use glam::{DQuat, DVec3};

/// The values of a field.
#[derive(Debug)]
pub enum Values {
    Numbers(Box<[f64]>),
    Words(Box<[Box<[u8]>]>),
    Node(u32),
    /// The field is marked with `~`: the state remains unchanged.
    Ignored,
}

/// A field, with the line in which it begins.
#[derive(Debug)]
pub struct Field {
    pub name: &'static str,
    pub line: usize,
    pub values: Values,
}

/// A node of the tree; nodes are referred to by their index in [`Tree::nodes`].
#[derive(Debug)]
pub struct Node {
    pub kind: NodeType,
    /// Line in which it begins.
    pub line: usize,
    pub fields: Vec<Field>,
    /// Indices of the child nodes.
    pub children: Vec<u32>,
    /// Height of the subtree; 1 for a leaf.
    pub height: usize,
    /// Number of values that are processed when the node is visited.
    pub cost: usize,
    /// True if the subtree may depend on the number of the copy that it is in.
    pub varies: bool,
}

/// The nodes of a file.
#[derive(Debug, Default)]
pub struct Tree {
    pub nodes: Vec<Node>,
    /// Indices of the nodes without a parent.
    pub roots: Vec<u32>,
}

impl Tree {
    pub fn node(&self, index: u32) -> &Node {
        &self.nodes[index as usize]
    }
}

impl Node {
    /// The last field of that name, unless it is ignored (`~`).
    pub fn field(&self, name: &str) -> Option<&Field> {
        let field = self.fields.iter().rev().find(|field| field.name == name)?;
        Some(field).filter(|field| !matches!(field.values, Values::Ignored))
    }

    /// True if the last field of that name is ignored (`~`).
    pub fn ignores(&self, name: &str) -> bool {
        let field = self.fields.iter().rev().find(|field| field.name == name);
        field.is_some_and(|field| matches!(field.values, Values::Ignored))
    }

    /// The numbers of a field; `None` if the field is absent.
    pub fn numbers(&self, name: &str) -> Result<Option<&[f64]>, Fault> {
        self.field(name).map(Field::numbers).transpose()
    }

    /// The numbers of a field with `width` numbers per value.
    pub fn tuples(&self, name: &str, width: usize) -> Result<Option<&[f64]>, Fault> {
        match self.numbers(name)? {
            Some(numbers) if !numbers.len().is_multiple_of(width) => {
                let problem = format!("{name}: {} numbers are not a multiple of {width}", numbers.len());
                Err(Fault::new(self.field(name).map(|field| field.line), problem, "check for a missing number"))
            }
            numbers => Ok(numbers),
        }
    }

    /// A field of `N` numbers.
    pub fn array<const N: usize>(&self, name: &str, default: [f64; N]) -> Result<[f64; N], Fault> {
        match self.field(name) {
            None => Ok(default),
            Some(field) => field.numbers()?.try_into().map_err(|_| field.fault(format!("needs {N} numbers"))),
        }
    }

    /// A field of one number.
    pub fn number(&self, name: &str, default: f64) -> Result<f64, Fault> {
        self.array(name, [default]).map(|[number]| number)
    }

    /// A field of one integer.
    pub fn integer(&self, name: &str, default: i64) -> Result<i64, Fault> {
        let number = self.number(name, default as f64)?;
        match self.field(name) {
            Some(field) if number.fract() != 0.0 => Err(field.fault(format!("{number} is not a whole number"))),
            _ => Ok(number as i64),
        }
    }

    /// A field of one vector or colour.
    pub fn vector(&self, name: &str, default: DVec3) -> Result<DVec3, Fault> {
        self.array(name, default.to_array()).map(DVec3::from)
    }

    /// A field of one rotation: axis and angle in radians. An axis of length zero gives the identity.
    pub fn rotation(&self, name: &str) -> Result<DQuat, Fault> {
        let [x, y, z, angle] = self.array(name, [0.0, 0.0, 1.0, 0.0])?;
        match DVec3::new(x, y, z).try_normalize() {
            Some(axis) => Ok(DQuat::from_axis_angle(axis, angle)),
            None => Ok(DQuat::IDENTITY),
        }
    }

    /// A field of one word.
    pub fn word(&self, name: &str) -> Result<Option<&[u8]>, Fault> {
        match self.field(name) {
            None => Ok(None),
            Some(field) => match field.words()? {
                [word] => Ok(Some(word)),
                words => Err(field.fault(format!("there are {} words, but one is needed", words.len()))),
            },
        }
    }

    /// True if the field `parts` names that part, or is absent.
    pub fn has_part(&self, part: &[u8]) -> Result<bool, Fault> {
        let Some(field) = self.field("parts") else { return Ok(true) };
        Ok(field.words()?.iter().any(|word| **word == *part || **word == *b"ALL"))
    }

    /// A boolean field: `TRUE`, `FALSE`, `1` or `0`.
    pub fn flag(&self, name: &str, default: bool) -> Result<bool, Fault> {
        match self.field(name) {
            None => Ok(default),
            Some(field) => match &field.values {
                Values::Words(words) if matches!(&**words, [word] if **word == *b"TRUE") => Ok(true),
                Values::Words(words) if matches!(&**words, [word] if **word == *b"FALSE") => Ok(false),
                Values::Numbers(numbers) if matches!(**numbers, [0.0]) => Ok(false),
                Values::Numbers(numbers) if matches!(**numbers, [1.0]) => Ok(true),
                _ => Err(field.fault("give TRUE or FALSE")),
            },
        }
    }

    /// A field of one node.
    pub fn inner(&self, name: &str) -> Result<Option<u32>, Fault> {
        match self.field(name) {
            None => Ok(None),
            Some(field) => match &field.values {
                Values::Node(index) => Ok(Some(*index)),
                // The list is empty if the node is ignored.
                Values::Words(words) if words.is_empty() || matches!(&**words, [word] if **word == *b"NULL") => {
                    Ok(None)
                }
                _ => Err(field.fault("a node is needed")),
            },
        }
    }
}

impl Field {
    /// An error in this field.
    #[cold]
    pub fn fault(&self, problem: impl AsRef<str>) -> Fault {
        Fault::new(Some(self.line), format!("{}: {}", self.name, problem.as_ref()), "")
    }

    fn numbers(&self) -> Result<&[f64], Fault> {
        match &self.values {
            Values::Numbers(numbers) => Ok(numbers),
            Values::Words(words) => match words.first() {
                // An empty list is stored as words.
                None => Ok(&[]),
                Some(word) => Err(self.fault(format!("{} is not a number", quote_bytes(word)))),
            },
            Values::Node(_) | Values::Ignored => Err(self.fault("numbers are needed")),
        }
    }

    fn words(&self) -> Result<&[Box<[u8]>], Fault> {
        match &self.values {
            Values::Words(words) => Ok(words),
            _ => Err(self.fault("a word is needed")),
        }
    }
}
