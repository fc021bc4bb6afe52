//! `rtbench structures`: what can be measured.

use super::output;
use crate::error::Result;
use crate::report::wrap::wrap;
use crate::workloads::trace::{self, OptionInfo};
use clap::Args;

/// List structures with their options and values, as --structure takes them
#[derive(Args, Debug)]
pub struct Arguments {}

/// Where an option's description begins.
const INDENT: &str = "                     ";

/// Runs the command.
///
/// # Errors
/// Standard output's.
pub fn run(_: &Arguments) -> Result<()> {
    let mut text = String::from("Structures, as NAME or NAME:KEY=VALUE,...\n");
    for algorithm in trace::algorithms() {
        text += &format!("\n  {}\n      {}\n", algorithm.name, algorithm.summary);
        if !algorithm.paper.is_empty() {
            text += &format!("      after {}\n", algorithm.paper);
        }
        text += &algorithm.own_options().map(describe).collect::<String>();
    }
    text += "\nOptions of all structures\n";
    text += &trace::COMMON_OPTIONS.iter().map(describe).collect::<String>();
    output::print(&text)
}

/// An option: its key, what it does, and what it takes.
fn describe(option: &OptionInfo) -> String {
    let meaning = wrap(&format!("{} (default {})", option.meaning, option.default), INDENT);
    let values = wrap(&option.values(), &format!("{INDENT}= "));
    // Only the first line of the values begins with the sign
    let values = values.replace(&format!("\n{INDENT}= "), &format!("\n{INDENT}  "));
    format!("      {:<14} {}{values}", option.key, meaning.trim_start())
}
