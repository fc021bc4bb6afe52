//! The grammar: from words to a tree.
//!
//! Every node is `Name { fields and nodes }`, and a field's values can be told from what follows without knowing its type:
//! numbers, a string, a list in brackets, words in parentheses, a node, or else one word. So nodes that nobody knows are
//! passed over like any other. Commas are blanks. `~` behind a field says that it is not to count, `=` connects it to
//! something that moves: what it is worth meanwhile stands before it.

use super::kind::{self, Kind};
use super::tree::{Field, Node, Tree, Values};
use crate::scene::mesh_builder::MeshBuilder;
use crate::scene::text::{Fault, Syntax, Words, number, quote_bytes};
use std::collections::HashMap;

/// Most nodes inside each other, also by way of `USE` and of included files.
pub const MAX_DEPTH: usize = 200;

static SYNTAX: Syntax = Syntax::new(b"#", b"{}[]()|=~\"").with_blanks(b",");

/// The tree of a file whose header has been checked. `mesh` is told of its memory, and of what is left out.
///
/// # Errors
/// The first fault in the file.
pub fn parse(bytes: &[u8], mesh: &mut MeshBuilder) -> Result<Tree, Fault> {
    let mut parser =
        Parser { words: Words::new(bytes, &SYNTAX), mesh, tree: Tree::default(), names: HashMap::new(), depth: 0 };
    while let Some(word) = parser.words.next() {
        if let Some(root) = parser.node(word)? {
            parser.mesh.charge(size_of::<u32>())?;
            parser.tree.roots.push(root);
        }
    }
    Ok(parser.tree)
}

struct Parser<'a, 'm> {
    words: Words<'a>,
    mesh: &'m mut MeshBuilder,
    tree: Tree,
    /// Nodes by the name that `DEF` gave them; `None` for one that is left out.
    names: HashMap<&'a [u8], Option<u32>>,
    depth: usize,
}

/// True for what no name of a node or field begins with.
fn is_punctuation(word: &[u8]) -> bool {
    matches!(word[0], b'{' | b'}' | b'[' | b']' | b'(' | b')' | b'|' | b'=' | b'~' | b'"')
}

fn is_number(word: &[u8]) -> bool {
    matches!(word[0], b'0'..=b'9' | b'+' | b'-' | b'.')
}

impl<'a> Parser<'a, '_> {
    /// A node that begins with this word; `None` if it is left out.
    fn node(&mut self, word: &'a [u8]) -> Result<Option<u32>, Fault> {
        if word == b"USE" {
            let name = self.words.need("USE")?;
            return self.names.get(name).copied().ok_or_else(|| {
                let problem = format!("USE {}: there is no such name", quote_bytes(name));
                self.words.fault(problem, "names are given with DEF, before they are used")
            });
        }
        let (mut word, mut names) = (word, None);
        while word == b"DEF" {
            names = Some(self.words.need("DEF")?);
            word = self.words.need("DEF")?;
        }
        let line = self.words.line();
        if is_punctuation(word) || is_number(word) {
            let problem = format!("{} where a node should begin", quote_bytes(word));
            return Err(self.words.fault(problem, "a node is `Name { ... }`"));
        }
        if self.words.need("a node")? != b"{" {
            return Err(self.words.fault(format!("{} has no `{{`", quote_bytes(word)), "a node is `Name { ... }`"));
        }
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return Err(self.too_deep());
        }
        let node = self.body(word, line)?;
        self.depth -= 1;
        if let Some(name) = names {
            self.mesh.charge(2 * size_of::<(&[u8], Option<u32>)>())?;
            self.names.insert(name, node);
        }
        Ok(node)
    }

    #[cold]
    fn too_deep(&self) -> Fault {
        self.words.fault(format!("more than {MAX_DEPTH} nodes inside each other"), "flatten the hierarchy")
    }

    /// What stands between the braces of a node.
    fn body(&mut self, name: &'a [u8], line: usize) -> Result<Option<u32>, Fault> {
        let kind = Kind::of(name);
        let mut node = Node {
            kind: kind.unwrap_or(Kind::Nothing),
            line,
            fields: Vec::new(),
            children: Vec::new(),
            height: 1,
            cost: 1,
        };
        loop {
            let Some(word) = self.words.next() else {
                let problem = format!("the {} that begins here has no `}}`", String::from_utf8_lossy(name));
                return Err(Fault::new(Some(line), problem, "the file is truncated or a brace is missing"));
            };
            if word == b"}" {
                break;
            }
            if matches!(word, b"DEF" | b"USE") || self.words.peek() == Some(b"{") {
                let within = self.words.line();
                let child = self.node(word)?;
                if !node.kind.holds_nodes() {
                    let problem = format!("a {} holds no other nodes", String::from_utf8_lossy(name));
                    return Err(Fault::new(Some(within), problem, "close it with `}` before"));
                }
                // What is inside of an unknown node is passed over with it
                if let Some(child) = child.filter(|_| node.kind != Kind::Nothing) {
                    self.mesh.charge(size_of::<u32>())?;
                    self.adopt(&mut node, child)?;
                    node.children.push(child);
                }
            } else {
                self.field(&mut node, word)?;
            }
        }
        match kind {
            None => {
                let warning = format!("unknown node {} passed over", quote_bytes(name));
                self.mesh.warnings.add(&warning);
                Ok(None)
            }
            Some(Kind::Nothing) => Ok(None),
            Some(Kind::LeftOut) => {
                self.mesh.warnings.add(&format!("{} left out", String::from_utf8_lossy(name)));
                Ok(None)
            }
            Some(_) => {
                self.mesh.charge(size_of::<Node>())?;
                self.tree.nodes.push(node);
                Ok(Some(self.tree.nodes.len() as u32 - 1))
            }
        }
    }

    /// Notes that a node is inside of another.
    fn adopt(&mut self, node: &mut Node, child: u32) -> Result<(), Fault> {
        node.height = node.height.max(1 + self.tree.node(child).height);
        if node.height > MAX_DEPTH { Err(self.too_deep()) } else { Ok(()) }
    }

    /// A field of this name. It is kept if this reader uses it.
    fn field(&mut self, node: &mut Node, name: &'a [u8]) -> Result<(), Fault> {
        let line = self.words.line();
        if is_punctuation(name) || is_number(name) {
            let problem = format!("{} where a field or a node should begin", quote_bytes(name));
            return Err(self.words.fault(problem, "is a bracket missing before it?"));
        }
        let known = kind::field(name).filter(|_| node.kind != Kind::Nothing);
        let values = self.values(name, known.is_some())?;
        let ignored = self.words.peek() == Some(b"~");
        if ignored {
            self.words.next();
        }
        let values = if ignored { Some(Values::Ignored) } else { values };
        if self.words.peek() == Some(b"=") {
            self.words.next();
            self.connection()?;
        }
        if let (Some(name), Some(values)) = (known, values) {
            // Nodes of nodes that are used twice may cost any number
            node.cost = node.cost.saturating_add(match &values {
                Values::Numbers(numbers) => numbers.len(),
                Values::Words(words) => words.len(),
                Values::Node(inner) => self.tree.node(*inner).cost,
                Values::Ignored => 0,
            });
            if let Values::Node(inner) = values {
                self.adopt(node, inner)?;
            }
            self.mesh.charge(size_of::<Field>())?;
            node.fields.push(Field { name, line, values });
        }
        Ok(())
    }

    /// A field's values; `None` if there are none, or if nobody wants them.
    fn values(&mut self, name: &'a [u8], wanted: bool) -> Result<Option<Values>, Fault> {
        let Some(first) = self.words.peek() else {
            return Err(self.words.fault(format!("{}: the file ends", quote_bytes(name)), "the file is truncated"));
        };
        let mut list = List::new(wanted);
        match first[0] {
            b'~' | b'=' => return Ok(None),
            b'[' => {
                self.words.next();
                loop {
                    while let Some(value) = self.words.plain_number() {
                        list.number(value);
                    }
                    match self.words.need("a list")? {
                        b"]" => break,
                        word => self.item(name, word, &mut list)?,
                    }
                }
            }
            b'(' => {
                self.words.next();
                loop {
                    match self.words.need("a list")? {
                        b")" => break,
                        b"|" => {}
                        word => self.item(name, word, &mut list)?,
                    }
                }
            }
            _ if is_number(first) => {
                while let Some(word) = self.words.peek().filter(|word| is_number(word)) {
                    self.words.next();
                    self.item(name, word, &mut list)?;
                }
            }
            _ => {
                self.words.next();
                self.item(name, first, &mut list)?;
            }
        }
        let values = list.values();
        if let Some(values) = &values {
            self.mesh.charge(match values {
                Values::Numbers(numbers) => size_of_val(&**numbers),
                Values::Words(words) => words.iter().map(|word| size_of_val(word) + word.len()).sum(),
                Values::Node(_) | Values::Ignored => 0,
            })?;
        }
        Ok(values)
    }

    /// One value.
    #[inline]
    fn item(&mut self, name: &[u8], word: &'a [u8], list: &mut List) -> Result<(), Fault> {
        if is_number(word) {
            let Some(value) = value(word) else {
                let (name, word) = (String::from_utf8_lossy(name), quote_bytes(word));
                return Err(self.words.fault(format!("{name}: {word} is not a finite number"), ""));
            };
            list.number(value);
            return Ok(());
        }
        self.item_of_words(name, word, list)
    }

    fn item_of_words(&mut self, name: &[u8], word: &'a [u8], list: &mut List) -> Result<(), Fault> {
        if matches!(word, b"DEF" | b"USE") || self.words.peek() == Some(b"{") {
            list.node = self.node(word)?;
            return Ok(());
        }
        let text = match word {
            [b'"', inner @ .., b'"'] => inner,
            _ if is_punctuation(word) => {
                let (name, word) = (String::from_utf8_lossy(name), quote_bytes(word));
                return Err(self.words.fault(format!("{name}: {word} where a value should be"), ""));
            }
            _ => word,
        };
        if list.wanted {
            list.words.push(text.into());
        }
        Ok(())
    }

    /// What a field is connected to: a node, and the name of what comes out of it. The field stays as it is.
    fn connection(&mut self) -> Result<(), Fault> {
        let word = self.words.need("a connection")?;
        if word == b"USE" {
            // `USE name.output`, which is one word or several
            self.words.need("USE")?;
        } else {
            self.node(word)?;
        }
        if self.words.peek().is_some_and(|word| word[0] == b'.') && self.words.next() == Some(b".") {
            self.words.need("a connection")?;
        }
        self.mesh.warnings.add("fields that something moves stay as they stand in the file");
        Ok(())
    }
}

/// A number, also in hexadecimal.
#[inline]
fn value(word: &[u8]) -> Option<f64> {
    match number::double(word) {
        Some((value, length)) if length == word.len() => value.is_finite().then_some(value),
        _ => {
            let digits = word.strip_prefix(b"0x").or(word.strip_prefix(b"0X"))?;
            u32::from_str_radix(std::str::from_utf8(digits).ok()?, 16).ok().map(f64::from)
        }
    }
}

/// Values that are being read.
struct List {
    wanted: bool,
    numbers: Vec<f64>,
    words: Vec<Box<[u8]>>,
    node: Option<u32>,
}

impl List {
    fn new(wanted: bool) -> List {
        List { wanted, numbers: Vec::new(), words: Vec::new(), node: None }
    }

    #[inline]
    fn number(&mut self, value: f64) {
        if self.wanted {
            self.numbers.push(value);
        }
    }

    /// Of mixed values the words count: they are refused where numbers are needed.
    fn values(self) -> Option<Values> {
        match self {
            List { wanted: false, .. } => None,
            List { node: Some(node), .. } => Some(Values::Node(node)),
            List { words, numbers, .. } if !words.is_empty() || numbers.is_empty() => Some(Values::Words(words.into())),
            List { numbers, .. } => Some(Values::Numbers(numbers.into())),
        }
    }
}
