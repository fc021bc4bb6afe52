//! `rtbench env`: what a run would record about program, machine and device, and what spoils its times.

use super::device::DeviceArguments;
use super::output;
use crate::error::{Error, Result};
use crate::harness::{environment, warnings};
use crate::record::run::DeviceRecord;
use clap::{Args, ValueEnum};
use serde_json::{Value, json};
use std::path::Path;

/// Print what a run would record about program, machine and device, and warn about what spoils times
///
/// The warnings are also in the record of every run. They do not change the exit code.
#[derive(Args, Debug)]
pub struct Arguments {
    /// Format
    #[arg(long, value_enum, default_value_t)]
    format: Format,
    #[command(flatten)]
    device: DeviceArguments,
}

/// A format.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum Format {
    /// A line per value
    #[default]
    Text,
    /// An object with program, environment, devices and warnings, named as in the record of a run
    Json,
}

/// Runs the command.
///
/// # Errors
/// A device that cannot be opened, standard output's.
pub fn run(arguments: &Arguments) -> Result<()> {
    let opened = arguments.device.open()?;
    let devices = [DeviceRecord { info: opened.device.info().clone(), reason: opened.reason }];
    let program = environment::program();
    let environment = environment::capture(&program, &devices);
    let found = warnings::find(&program, &environment, &devices, Path::new("/"));
    let json = json!({ "program": program, "environment": environment, "devices": devices, "warnings": found });
    if arguments.format == Format::Json {
        let text = serde_json::to_string_pretty(&json).map_err(|e| Error::output(Path::new("JSON"), e.into()))?;
        return output::print(&(text + "\n"));
    }
    let mut text = String::new();
    for section in ["program", "environment", "devices"] {
        text += &format!("{section}\n");
        let values = match &json[section] {
            Value::Array(list) => list.iter().collect(),
            value => vec![value],
        };
        for value in values {
            // The warnings come last
            lines(value, "", &mut |name, value| {
                if !name.starts_with("warnings") {
                    text += &format!("  {name:<24} {value}\n");
                }
            });
        }
        text.push('\n');
    }
    text += "warnings\n";
    if found.is_empty() {
        text += "  none\n";
    }
    for warning in found {
        text += &format!("  {}\n    {}\n", warning.problem, warning.hint);
    }
    output::print(&text)
}

/// Each value of an object with its name; lists of words on one line.
fn lines(value: &Value, name: &str, write: &mut dyn FnMut(&str, &str)) {
    match value {
        Value::Object(object) => {
            for (key, value) in object {
                let name = if name.is_empty() { key.clone() } else { format!("{name}.{key}") };
                lines(value, &name, write);
            }
        }
        Value::Array(list) => {
            let list: Vec<String> = list.iter().map(plain).collect();
            write(name, &list.join(", "));
        }
        value => write(name, &plain(value)),
    }
}

/// A value without quotes; a dash for one that is unknown.
fn plain(value: &Value) -> String {
    match value {
        Value::Null => "-".into(),
        Value::String(text) => text.clone(),
        value => value.to_string(),
    }
}
