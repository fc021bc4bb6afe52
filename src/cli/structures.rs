//! `rtbench structures`: what can be measured.

use super::output;
use crate::accel;
use crate::error::Result;
use clap::Args;

/// List structures with their options, as --structure takes them
#[derive(Args, Debug)]
pub struct Arguments {}

/// Runs the command.
///
/// # Errors
/// Standard output's.
pub fn run(_: &Arguments) -> Result<()> {
    let mut text = String::from("Structures, as NAME or NAME:KEY=VALUE,...\n");
    for variant in accel::variants() {
        text += &format!("\n  {}\n      {}\n", variant.name, variant.summary);
        if !variant.paper.is_empty() {
            text += &format!("      after {}\n", variant.paper);
        }
        for option in variant.build_options.iter().chain(variant.walk_options) {
            text += &format!("      {:<14} {} (default {})\n", option.key, option.meaning, option.default);
        }
    }
    text += "\nOptions of all structures\n";
    for option in accel::COMMON_OPTIONS {
        text += &format!("      {:<14} {} (default {})\n", option.key, option.meaning, option.default);
    }
    output::print(&text)
}
