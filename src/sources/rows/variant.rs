//! A record's `variant`: `default`, or the options that differ from the defaults, `key=value,...`.

use std::fmt;

/// Options that differ from the defaults, in the order of `rtbench structures`.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Variant {
    options: Vec<(String, String)>,
}

impl Variant {
    /// Reads a record's text. An option without a value keeps its name: it is not the default either.
    pub fn parse(text: &str) -> Variant {
        let options = text.split(',').filter(|option| !option.is_empty() && *option != "default");
        let pair = |option: &str| match option.split_once('=') {
            Some((key, value)) => (key.trim().to_owned(), value.trim().to_owned()),
            None => (option.trim().to_owned(), String::new()),
        };
        Variant { options: options.map(pair).collect() }
    }

    /// One option only.
    pub fn of(key: &str, value: &str) -> Variant {
        Variant { options: vec![(key.to_owned(), value.to_owned())] }
    }

    /// True if every option has its default.
    pub fn is_default(&self) -> bool {
        self.options.is_empty()
    }

    /// An option's value, if it is not the default.
    pub fn get(&self, key: &str) -> Option<&str> {
        self.options.iter().find(|(k, _)| k == key).map(|(_, value)| value.as_str())
    }

    /// True if these options, in any order, are all that differ from the defaults.
    pub fn is_exactly(&self, options: &[(&str, &str)]) -> bool {
        self.options.len() == options.len() && options.iter().all(|(key, value)| self.get(key) == Some(value))
    }

    /// The option, if it is the only one that differs from `base`.
    pub fn only_beyond(&self, base: &Variant) -> Option<(&str, &str)> {
        let mut beyond = self.options.iter().filter(|option| !base.options.contains(option));
        let (key, value) = beyond.next()?;
        let rest_is_base = beyond.next().is_none() && self.options.len() == base.options.len() + 1;
        rest_is_base.then_some((key.as_str(), value.as_str()))
    }

    /// True for `base` with this option in addition, in any order.
    pub fn is(&self, base: &Variant, key: &str, value: &str) -> bool {
        self.only_beyond(base) == Some((key, value))
    }
}

impl fmt::Display for Variant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_default() {
            return f.write_str("default");
        }
        for (index, (key, value)) in self.options.iter().enumerate() {
            let comma = if index > 0 { "," } else { "" };
            let equals = if value.is_empty() { "" } else { "=" };
            write!(f, "{comma}{key}{equals}{value}")?;
        }
        Ok(())
    }
}
