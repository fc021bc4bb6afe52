//! `rtbench completions`: scripts that let a shell complete commands and flags.

use super::output;
use crate::error::Result;
use clap::{Args, CommandFactory};
use clap_complete::Shell;

/// Print a shell's completion script
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// Shell
    #[arg(value_enum)]
    shell: Shell,
}

const EXAMPLES: &str = "\
Examples:
  rtbench completions bash > ~/.local/share/bash-completion/completions/rtbench
  rtbench completions fish > ~/.config/fish/completions/rtbench.fish";

/// Runs the command.
///
/// # Errors
/// Standard output's.
pub fn run(arguments: &Arguments) -> Result<()> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut super::Cli::command(), "rtbench", &mut script);
    output::print(&String::from_utf8_lossy(&script))
}
