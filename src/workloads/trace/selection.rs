//! One structure as a user selects it, and what it takes to build it.

use crate::device::{Interrupted, VulkanDevice};
use crate::error::{Error, Result};
use crate::scene::Scene;
use crate::threads;
use crate::workloads::trace::algorithm::{Algorithm, Made};
use crate::workloads::trace::build::gpu::BuildTimes;
use crate::workloads::trace::intersect::TriangleTest;
use crate::workloads::trace::method::{
    Fetch, Group, Method, Pattern, Reflections, ShadowRays, Threads, TriangleLayout,
};
use crate::workloads::trace::options::{Axis, OptionInfo};
use crate::workloads::trace::registry::algorithms;
use crate::workloads::trace::structure::Structure;
use std::sync::Arc;
use std::time::Instant;

/// An algorithm with its options, as `--structure` gives it: `name[:key=value,...]`.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Selection {
    algorithm: &'static Algorithm,
    /// One value per option, in the table's order and spelled as the table would.
    values: Vec<String>,
}

/// A structure, and what it took to build it.
#[derive(Clone, Debug)]
pub struct Built {
    /// The structure.
    pub structure: Arc<dyn Structure>,
    /// Wall-clock time, in milliseconds, from the scene's triangles to the finished structure.
    pub build_ms: f64,
    /// Threads that the builder could use; 0 for a structure that was built on a device.
    pub build_threads: usize,
    /// Of a structure that was built on a device; its build time is their total.
    pub device_times: Option<BuildTimes>,
    /// How it was built where not as selected; empty otherwise.
    pub note: String,
}

impl Selection {
    /// Reads `name[:key=value,...]`.
    pub fn parse(text: &str) -> Result<Selection> {
        let place = || format!("--structure {text}");
        let (name, options) = text.split_once(':').unwrap_or((text, ""));
        let is_called = |a: &&&Algorithm| a.name == name || (a.alias == name && !name.is_empty());
        let Some(&algorithm) = algorithms().iter().find(is_called) else {
            let names: Vec<&str> = algorithms().iter().map(|a| a.name).collect();
            let problem = format!("there is no structure '{name}'");
            return Err(Error::argument(place(), problem, format!("one of {}", names.join(", "))));
        };
        let table: Vec<&OptionInfo> = algorithm.options().collect();
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
        let selection = Selection { algorithm, values };
        // A default that is written out asks for nothing
        let asked = table.iter().zip(&set).zip(&selection.values).filter(|((o, set), v)| **set && o.default != **v);
        for ((option, _), _) in asked {
            if let Some(why) = option.idle.and_then(|idle| idle(&selection)) {
                let problem = format!("{} has no effect: {why}", option.key);
                return Err(Error::argument(place(), problem, format!("leave {} out", option.key)));
            }
        }
        Ok(selection)
    }

    /// Reads one element of a list of `--structure`: `all` is every algorithm but brute force.
    pub fn parse_all(text: &str) -> Result<Vec<Selection>> {
        if text != "all" {
            return Ok(vec![Selection::parse(text)?]);
        }
        let names = algorithms().iter().map(|a| a.name).filter(|&name| name != "brute");
        names.map(Selection::parse).collect()
    }

    /// What is registered under its name.
    pub fn info(&self) -> &'static Algorithm {
        self.algorithm
    }

    /// The algorithm's name.
    pub fn name(&self) -> &'static str {
        self.algorithm.name
    }

    /// The options that differ from their defaults, `key=value,...`, or `default`.
    pub fn variant(&self) -> String {
        let set = self.changed(|_| true);
        if set.is_empty() { "default".to_owned() } else { set }
    }

    /// Options of the structure that differ from their defaults, `key=value,...`; empty if none does.
    pub fn build_options(&self) -> String {
        self.changed(|axis| axis == Axis::Build)
    }

    /// The same for options of the traversal.
    pub fn traversal_options(&self) -> String {
        self.changed(|axis| axis == Axis::Traversal)
    }

    /// The same for options that decide which rays there are and what they hit.
    pub fn ray_options(&self) -> String {
        self.changed(|axis| axis == Axis::Rays)
    }

    /// The same for options of the device, which change times only.
    pub fn device_options(&self) -> String {
        self.changed(|axis| axis == Axis::Device)
    }

    fn changed(&self, of: impl Fn(Axis) -> bool) -> String {
        let options = self.info().options().zip(&self.values);
        let changed = options.filter(|(o, v)| o.default != *v && of(o.axis));
        changed.map(|(o, v)| format!("{}={v}", o.key)).collect::<Vec<_>>().join(",")
    }

    /// Name and options as they are written, `name[:key=value,...]`.
    pub fn full_name(&self) -> String {
        match self.variant().as_str() {
            "default" => self.name().to_owned(),
            variant => format!("{}:{variant}", self.name()),
        }
    }

    /// The options that differ from their defaults, by the axis of a row that holds them.
    pub fn option_axes(&self) -> [(&'static str, String); 4] {
        [
            (Axis::Build.name(), self.build_options()),
            (Axis::Traversal.name(), self.traversal_options()),
            (Axis::Rays.name(), self.ray_options()),
            (Axis::Device.name(), self.device_options()),
        ]
    }

    /// How rays go through it.
    pub fn method(&self) -> Method {
        let shape = self.find("packet").or(self.find("group"));
        let group = shape.map_or(Group::SQUARE, |shape| {
            let (width, height) = shape.split_once('x').expect("the table lists shapes");
            let side = |text: &str| text.parse().expect("the table lists shapes");
            Group { width: side(width), height: side(height) }
        });
        let traversal = (self.info().traversal)(self);
        Method {
            traversal,
            parameters: (traversal.parameters)(self),
            shadows: match self.value("shadows") {
                "to-light" => ShadowRays::ToLight,
                _ => ShadowRays::FromLight,
            },
            pattern: if self.value("pattern") == "four" { Pattern::Four } else { Pattern::Image },
            intersect: match self.value("intersect") {
                "moller-trumbore" => TriangleTest::MollerTrumbore,
                _ => TriangleTest::Watertight,
            },
            reflections: match self.value("reflections") {
                "staged" => Reflections::Staged,
                _ => Reflections::Fused,
            },
            threads: match self.find("loop") {
                Some("persistent") => Threads::Persistent,
                _ => Threads::PerPixel,
            },
            group,
            tiles: self.count("tiles").unwrap_or(1),
            checked: self.value("checks") == "on",
            fetch: match self.value("fetch") {
                "buffers" => Fetch::Buffers,
                "textures" => Fetch::Textures,
                _ => Fetch::Auto,
            },
            triangles: match self.value("triangles") {
                "indexed" => TriangleLayout::Indexed,
                "leaf-order" => TriangleLayout::LeafOrder,
                _ => TriangleLayout::Auto,
            },
        }
    }

    /// Equal for selections whose built structures are the same.
    pub fn build_key(&self) -> String {
        let builder = self.info().builder;
        format!("{}:{}:{}", builder.name, (builder.purpose)(self), self.values[..builder.options.len()].join(","))
    }

    /// Builds the structure on `threads` threads (0: as many as there are).
    pub fn build(&self, scene: &Scene, threads: usize) -> Result<Built> {
        let pool = threads::pool(if self.info().builder.parallel { threads } else { 1 })?;
        pool.install(|| {
            let start = Instant::now();
            let Made { structure, note } = (self.info().builder.build)(self, scene)?;
            let build_ms = start.elapsed().as_secs_f64() * 1e3;
            let build_threads = rayon::current_num_threads();
            Ok(Built { structure, build_ms, build_threads, device_times: None, note })
        })
    }

    /// Builds the structure on a device; `None` where its builder works on the CPU alone.
    pub fn build_on(&self, scene: &Scene, device: &VulkanDevice, interrupted: Interrupted) -> Result<Option<Built>> {
        let Some(on_device) = self.info().builder.on_device else { return Ok(None) };
        let built = on_device(self, scene, device, interrupted)?.map(|(Made { structure, note }, times)| Built {
            structure,
            build_ms: times.total_ms,
            build_threads: 0,
            device_times: Some(times),
            note,
        });
        Ok(built)
    }

    /// The value of an option; `None` if the algorithm has no such option.
    pub(crate) fn find(&self, key: &str) -> Option<&str> {
        let index = self.info().options().position(|o| o.key == key)?;
        Some(&self.values[index])
    }

    pub(crate) fn value(&self, key: &str) -> &str {
        self.find(key).expect("an option of the table")
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
