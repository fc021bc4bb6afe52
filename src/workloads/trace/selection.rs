//! One structure as a user selects it, and what it takes to build it.

use crate::error::{Error, Result};
use crate::scene::Scene;
use crate::threads;
use crate::workloads::trace::Structure;
use crate::workloads::trace::intersect::TriangleTest;
use crate::workloads::trace::method::{Fetch, Group, Method, Pattern, ShadowRays};
use crate::workloads::trace::registry::{Made, OptionInfo, VariantInfo, variants};
use std::time::Instant;

/// A variant with its options, as `--structure` gives it: `name[:key=value,...]`.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Selection {
    /// Row in [`variants`].
    variant: usize,
    /// One value per option, in the table's order and spelled as the table would.
    values: Vec<String>,
}

/// A structure, and what it took to build it.
#[derive(Clone, Debug)]
pub struct Built {
    /// The structure.
    pub structure: Structure,
    /// Wall-clock time, in milliseconds, from the scene's triangles to the finished structure.
    pub build_ms: f64,
    /// Threads that the builder could use.
    pub build_threads: usize,
    /// How it was built where not as selected; empty otherwise.
    pub note: String,
}

impl Selection {
    /// Reads `name[:key=value,...]`.
    pub fn parse(text: &str) -> Result<Selection> {
        let place = || format!("--structure {text}");
        let (name, options) = text.split_once(':').unwrap_or((text, ""));
        let Some(variant) = variants().iter().position(|v| v.name == name || (v.alias == name && !name.is_empty()))
        else {
            let names: Vec<&str> = variants().iter().map(|v| v.name).collect();
            let problem = format!("there is no structure '{name}'");
            return Err(Error::argument(place(), problem, format!("one of {}", names.join(", "))));
        };
        let table: Vec<&OptionInfo> = variants()[variant].options().collect();
        let mut values: Vec<String> = table.iter().map(|o| o.default.to_owned()).collect();
        let mut set = vec![false; table.len()];
        for option in options.split(',').filter(|o| !o.is_empty()) {
            let (key, value) = option.split_once('=').unwrap_or((option, ""));
            let Some(index) = table.iter().position(|o| o.key == key) else {
                let keys: Vec<&str> = table.iter().map(|o| o.key).collect();
                let hint = format!("one of {}", keys.join(", "));
                return Err(Error::argument(place(), format!("{name} has no option '{key}'"), hint));
            };
            let given = &mut set[index];
            if std::mem::replace(given, true) {
                return Err(Error::argument(place(), format!("{key} is given twice"), "give it once"));
            }
            values[index] = table[index]
                .kind
                .parse(value)
                .map_err(|hint| Error::argument(place(), format!("'{value}' is no value for {key}"), hint))?;
        }
        Ok(Selection { variant, values })
    }

    /// The variant's row in the table.
    pub fn info(&self) -> &'static VariantInfo {
        &variants()[self.variant]
    }

    /// The variant's name.
    pub fn name(&self) -> &'static str {
        self.info().name
    }

    /// The options that differ from their defaults, `key=value,...`, or `default`.
    pub fn variant(&self) -> String {
        let options = self.info().options().zip(&self.values);
        let set: Vec<String> =
            options.filter(|(o, v)| o.default != *v).map(|(o, v)| format!("{}={v}", o.key)).collect();
        if set.is_empty() { "default".to_owned() } else { set.join(",") }
    }

    /// How rays go through it.
    pub fn method(&self) -> Method {
        let shape = if self.has("packet") { self.value("packet") } else { self.value("group") };
        let (width, height) = shape.split_once('x').expect("the table lists shapes");
        let side = |text: &str| text.parse().expect("the table lists shapes");
        Method {
            traversal: (self.info().traversal)(self),
            shadows: match self.value("shadows") {
                "to-light" => ShadowRays::ToLight,
                _ => ShadowRays::FromLight,
            },
            pattern: if self.value("pattern") == "four" { Pattern::Four } else { Pattern::Image },
            intersect: match self.value("intersect") {
                "moller-trumbore" => TriangleTest::MollerTrumbore,
                _ => TriangleTest::Watertight,
            },
            group: Group { width: side(width), height: side(height) },
            tiles: self.count("tiles").unwrap_or(1),
            checked: self.value("checks") == "on",
            fetch: match self.value("fetch") {
                "buffers" => Fetch::Buffers,
                "textures" => Fetch::Textures,
                _ => Fetch::Auto,
            },
        }
    }

    /// Equal for selections whose built structures are the same.
    pub fn build_key(&self) -> String {
        format!("{}:{}", self.info().builder, self.values[..self.info().build_options.len()].join(","))
    }

    /// Builds the structure on `threads` threads (0: as many as there are).
    pub fn build(&self, scene: &Scene, threads: usize) -> Result<Built> {
        let pool = threads::pool(if self.info().parallel { threads } else { 1 })?;
        pool.install(|| {
            let start = Instant::now();
            let Made { structure, note } = (self.info().build)(self, scene)?;
            let build_ms = start.elapsed().as_secs_f64() * 1e3;
            Ok(Built { structure, build_ms, build_threads: rayon::current_num_threads(), note })
        })
    }

    fn has(&self, key: &str) -> bool {
        self.info().options().any(|o| o.key == key)
    }

    pub(crate) fn value(&self, key: &str) -> &str {
        let index = self.info().options().position(|o| o.key == key).expect("an option of the table");
        &self.values[index]
    }

    /// `None` for `auto`.
    pub(crate) fn count(&self, key: &str) -> Option<u32> {
        self.value(key).parse().ok()
    }

    pub(crate) fn size(&self, key: &str) -> usize {
        self.value(key).parse().expect("checked when it was read")
    }

    pub(crate) fn number(&self, key: &str) -> f64 {
        self.value(key).parse().expect("checked when it was read")
    }
}
