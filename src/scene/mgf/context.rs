//! Named and unnamed contexts: the current vertex, colour or material.

use crate::scene::text::{Fault, quote_bytes};
use std::collections::HashMap;

/// The contexts of one kind.
#[derive(Default)]
pub struct Contexts<T> {
    named: HashMap<Vec<u8>, T>,
    current: T,
    /// Name of the current one, if it has one: what is changed is kept under it.
    name: Option<Vec<u8>>,
}

impl<T: Clone + Default> Contexts<T> {
    /// `[id [= [template]]]`: makes a context current, an old one or a new one.
    pub fn select(&mut self, arguments: &[&[u8]]) -> Result<(), Fault> {
        self.keep();
        match *arguments {
            [] => (self.current, self.name) = (T::default(), None),
            [name] => (self.current, self.name) = (self.find(name)?.clone(), Some(name.to_vec())),
            [name, b"="] => (self.current, self.name) = (T::default(), Some(name.to_vec())),
            [name, b"=", template] => {
                (self.current, self.name) = (self.find(template)?.clone(), Some(name.to_vec()));
            }
            _ => {
                let mend = "write nothing, a name, `name =` or `name = template`";
                return Err(Fault::new(None, "this selects no context", mend));
            }
        }
        Ok(())
    }

    fn keep(&mut self) {
        if let Some(name) = self.name.take() {
            self.named.insert(name, self.current.clone());
        }
    }

    /// The current context.
    pub fn current(&self) -> &T {
        &self.current
    }

    /// The current context, to be changed.
    pub fn change(&mut self) -> &mut T {
        &mut self.current
    }

    /// A context by name.
    pub fn find(&self, name: &[u8]) -> Result<&T, Fault> {
        if self.name.as_deref() == Some(name) {
            return Ok(&self.current);
        }
        self.named.get(name).ok_or_else(|| {
            let problem = format!("{} is not defined", quote_bytes(name));
            Fault::new(None, problem, "define it before, with `NAME =`")
        })
    }
}
