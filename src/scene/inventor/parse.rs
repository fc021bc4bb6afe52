//! Parses a file into a tree of nodes.
//!
//! Every node is `Name { fields and nodes }`. The extent of a field's values can be recognised without knowing the
//! field's type: they are numbers, a string, a list in brackets, words in parentheses, a node, or a single word. So
//! unknown nodes can be skipped. Only strings without quotes need the names of their fields (`strings`). Commas are
//! blanks. `~` after a field means that the field is ignored. `=` connects a field to an animated value; the values
//! before it are the initial ones.

use super::list::{List, is_number, value};
use super::node_type::{self, NodeType, NotANumber};
use super::strings;
use super::tree::{Field, Node, Tree, Values};
use crate::scene::mesh_builder::MeshBuilder;
use crate::scene::text::{Fault, Syntax, Tokenizer, odd, quote_bytes};
use std::collections::HashMap;

/// The largest nesting depth of nodes, through `USE` and includes.
pub const MAX_DEPTH: usize = 200;

static SYNTAX: Syntax = Syntax::new(b"#", b"{}[]()|=~\"").with_blanks(b",");

/// Parses a file of which the header has been checked. The tree's memory is charged to `mesh`, which also collects the
/// warnings.
///
/// # Errors
/// The first error in the file.
pub fn parse(bytes: &[u8], mesh: &mut MeshBuilder) -> Result<Tree, Fault> {
    let mut parser =
        Parser { tokens: Tokenizer::new(bytes, &SYNTAX), mesh, tree: Tree::default(), names: HashMap::new(), depth: 0 };
    while let Some(word) = parser.tokens.next() {
        if let Some(root) = parser.node(word)? {
            parser.mesh.charge(size_of::<u32>())?;
            parser.tree.roots.push(root);
        }
    }
    Ok(parser.tree)
}

struct Parser<'a, 'm> {
    tokens: Tokenizer<'a>,
    mesh: &'m mut MeshBuilder,
    tree: Tree,
    /// Nodes by the name that `DEF` gave them; `None` for an ignored node.
    names: HashMap<&'a [u8], Option<u32>>,
    depth: usize,
}

/// True for a token with which no name of a node or field can begin.
fn is_punctuation(word: &[u8]) -> bool {
    matches!(word[0], b'{' | b'}' | b'[' | b']' | b'(' | b')' | b'|' | b'=' | b'~' | b'"')
}

impl<'a> Parser<'a, '_> {
    /// Parses a node that begins with this word; `None` if the node is ignored.
    fn node(&mut self, word: &'a [u8]) -> Result<Option<u32>, Fault> {
        if word == b"USE" {
            let name = self.tokens.need("USE")?;
            return self.names.get(name).copied().ok_or_else(|| {
                let problem = format!("USE {}: the name is not defined", quote_bytes(name));
                self.tokens.fault(problem, "define it with DEF before it is used")
            });
        }
        let (mut word, mut names) = (word, None);
        while word == b"DEF" {
            names = Some(self.tokens.need("DEF")?);
            word = self.tokens.need("DEF")?;
        }
        let line = self.tokens.line();
        if is_punctuation(word) || is_number(word) {
            let problem = format!("{} is not the start of a node", quote_bytes(word));
            return Err(self.tokens.fault(problem, "a node is `Name { ... }`"));
        }
        if self.tokens.need("a node")? != b"{" {
            return Err(self.tokens.fault(format!("{} has no `{{`", quote_bytes(word)), "a node is `Name { ... }`"));
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
        self.tokens.fault(format!("nodes are nested more than {MAX_DEPTH} levels deep"), "flatten the hierarchy")
    }

    /// Parses a node after its opening brace.
    fn body(&mut self, name: &'a [u8], line: usize) -> Result<Option<u32>, Fault> {
        let kind = NodeType::of(name);
        let mut node = Node {
            kind: kind.unwrap_or(NodeType::Irrelevant),
            line,
            fields: Vec::new(),
            children: Vec::new(),
            height: 1,
            cost: 1,
            varies: false,
        };
        loop {
            let Some(word) = self.tokens.next() else {
                let problem = format!("the {} that begins here has no `}}`", String::from_utf8_lossy(name));
                return Err(Fault::new(Some(line), problem, "the file is truncated or a brace is missing"));
            };
            if word == b"}" {
                break;
            }
            if matches!(word, b"DEF" | b"USE") || self.tokens.peek() == Some(b"{") {
                let within = self.tokens.line();
                let child = self.node(word)?;
                if !node.kind.has_children() {
                    let problem = format!("a {} cannot contain nodes", String::from_utf8_lossy(name));
                    return Err(Fault::new(Some(within), problem, "close it with `}` before the node"));
                }
                // The children of an ignored node are ignored.
                if let Some(child) = child.filter(|_| node.kind != NodeType::Irrelevant) {
                    self.mesh.charge(size_of::<u32>())?;
                    self.raise_height(&mut node, child)?;
                    node.children.push(child);
                }
            } else {
                self.field(&mut node, word)?;
            }
        }
        match kind {
            None => {
                let warning = format!("unknown node {} ignored", quote_bytes(name));
                self.mesh.warnings.add(&warning);
                Ok(None)
            }
            Some(NodeType::Irrelevant) => Ok(None),
            Some(NodeType::Unsupported) => {
                self.mesh.warnings.add(&format!("{} ignored", String::from_utf8_lossy(name)));
                Ok(None)
            }
            Some(kind) => {
                self.mesh.charge(size_of::<Node>())?;
                node.varies = match kind {
                    NodeType::Include => true,
                    NodeType::Switch => node.varies || matches!(node.integer("whichChild", -1), Ok(-2)),
                    // Their children depend on the number of their own copies.
                    NodeType::Array | NodeType::MultipleCopy => false,
                    _ => node.varies,
                };
                self.tree.nodes.push(node);
                Ok(Some(self.tree.nodes.len() as u32 - 1))
            }
        }
    }

    /// Makes the height of a node exceed that of a child, and the node vary with it.
    ///
    /// # Errors
    /// The nesting is too deep.
    fn raise_height(&mut self, node: &mut Node, child: u32) -> Result<(), Fault> {
        node.height = node.height.max(1 + self.tree.node(child).height);
        node.varies |= self.tree.node(child).varies;
        if node.height > MAX_DEPTH { Err(self.too_deep()) } else { Ok(()) }
    }

    /// Parses a field, and stores it if this reader supports it.
    fn field(&mut self, node: &mut Node, name: &'a [u8]) -> Result<(), Fault> {
        let line = self.tokens.line();
        if is_punctuation(name) || is_number(name) {
            let problem = format!("{} is not the start of a field or a node", quote_bytes(name));
            return Err(self.tokens.fault(problem, "check for a missing bracket before it"));
        }
        let known = node_type::field(name).filter(|_| node.kind != NodeType::Irrelevant);
        let values = self.values(name, known)?;
        let ignored = self.tokens.peek() == Some(b"~");
        if ignored {
            self.tokens.next();
        }
        let values = if ignored && node.kind.can_ignore(&String::from_utf8_lossy(name)) {
            Some(Values::Ignored)
        } else {
            values
        };
        if self.tokens.peek() == Some(b"=") {
            self.tokens.next();
            self.connection()?;
        }
        if let (Some(name), Some(values)) = (known, values) {
            // The sum saturates, because nested nodes that are used repeatedly can have any cost.
            node.cost = node.cost.saturating_add(match &values {
                Values::Numbers(numbers) => numbers.len(),
                Values::Words(words) => words.len(),
                Values::Node(inner) => self.tree.node(*inner).cost,
                Values::Ignored => 0,
            });
            if let Values::Node(inner) = values {
                self.raise_height(node, inner)?;
            }
            self.mesh.charge(size_of::<Field>())?;
            node.fields.push(Field { name, line, values });
        }
        Ok(())
    }

    /// Parses the values of a field; `None` if there are none, or they are not of a `known` field.
    fn values(&mut self, name: &'a [u8], known: Option<&'static str>) -> Result<Option<Values>, Fault> {
        let Some(first) = self.tokens.peek() else {
            return Err(self.tokens.fault(format!("{}: the file ends", quote_bytes(name)), "the file is truncated"));
        };
        let mut list = List::new(known);
        let string = if strings::is_string(name) { self.string() } else { None };
        match first[0] {
            _ if string.is_some() => list.words.extend(string.filter(|_| list.wanted).map(Into::into)),
            b'~' | b'=' => return Ok(None),
            b'[' => {
                self.tokens.next();
                loop {
                    while let Some(value) = self.tokens.plain_number() {
                        list.number(value);
                    }
                    match self.tokens.need("a list")? {
                        b"]" => break,
                        word => self.item(name, word, &mut list)?,
                    }
                }
            }
            b'(' => {
                self.tokens.next();
                loop {
                    match self.tokens.need("a list")? {
                        b")" => break,
                        b"|" => {}
                        word => self.item(name, word, &mut list)?,
                    }
                }
            }
            _ if list.begins(first) => {
                while let Some(word) = self.tokens.peek().filter(|word| list.continues(word)) {
                    self.tokens.next();
                    self.item(name, word, &mut list)?;
                }
            }
            _ => {
                self.tokens.next();
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

    /// Reads the string without quotes that begins here; `None` if the value has another form.
    fn string(&mut self) -> Option<&'a [u8]> {
        let length = strings::length(self.tokens.peek_to_space())?;
        let mut after = self.tokens.clone();
        let text = after.take(length);
        // Only a node has a brace after its name.
        if matches!(text, b"DEF" | b"USE") || after.clone().peek() == Some(b"{") {
            return None;
        }
        self.tokens = after;
        Some(text)
    }

    /// Adds a value that begins with `word` to the list.
    #[inline]
    fn item(&mut self, name: &[u8], word: &'a [u8], list: &mut List) -> Result<(), Fault> {
        match is_number(word).then(|| value(word)).flatten() {
            Some(value) if list.rule != NotANumber::Word => {
                list.number(value);
                Ok(())
            }
            _ => self.item_of_words(name, word, list),
        }
    }

    /// The value of a word of a numeric field that is not a finite number; `None` if it remains a word.
    #[cold]
    fn odd_number(&self, name: &[u8], word: &[u8], list: &List) -> Result<Option<f64>, Fault> {
        match (list.rule, odd::value(word)) {
            (NotANumber::Word, _) => Ok(None),
            (_, Some(value)) if value.is_finite() => Ok(Some(value)),
            (NotANumber::Position, Some(value)) => Ok(Some(value)),
            (NotANumber::Default, _) => Ok(Some(f64::NAN)),
            _ if is_number(word) && list.wanted => {
                let (name, word) = (String::from_utf8_lossy(name), quote_bytes(word));
                Err(self.tokens.fault(format!("{name}: {word} is not a finite number"), ""))
            }
            _ => Ok(None),
        }
    }

    fn item_of_words(&mut self, name: &[u8], word: &'a [u8], list: &mut List) -> Result<(), Fault> {
        if matches!(word, b"DEF" | b"USE") || self.tokens.peek() == Some(b"{") {
            list.node = self.node(word)?;
            return Ok(());
        }
        let text = match word {
            [b'"', .., b'"'] if list.wanted && list.rule == NotANumber::Default => {
                list.number(f64::NAN);
                return Ok(());
            }
            [b'"', inner @ .., b'"'] => inner,
            _ if is_punctuation(word) => {
                let (name, word) = (String::from_utf8_lossy(name), quote_bytes(word));
                return Err(self.tokens.fault(format!("{name}: {word} is not a value"), ""));
            }
            _ => {
                if list.wanted
                    && let Some(value) = self.odd_number(name, word, list)?
                {
                    list.number(value);
                    return Ok(());
                }
                word
            }
        };
        if list.wanted {
            list.words.push(text.into());
        }
        Ok(())
    }

    /// Skips the connection of a field: a node, and the name of its output. The field keeps its values.
    fn connection(&mut self) -> Result<(), Fault> {
        let word = self.tokens.need("a connection")?;
        if word == b"USE" {
            // `USE name.output` can be one token or several.
            self.tokens.need("USE")?;
        } else {
            self.node(word)?;
        }
        if self.tokens.peek().is_some_and(|word| word[0] == b'.') && self.tokens.next() == Some(b".") {
            self.tokens.need("a connection")?;
        }
        self.mesh.warnings.add("connected fields keep the values in the file: animations are ignored");
        Ok(())
    }
}
