//! `rtbench completions`: prints a script with which a shell completes commands and flags.

use super::output;
use crate::error::Result;
use clap::Args;
use clap_complete::Shell;

/// Print a shell's completion script
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// The shell that the script is for
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
/// Standard output cannot be written.
pub fn run(arguments: &Arguments) -> Result<()> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut super::cli(), "rtbench", &mut script);
    output::print(&String::from_utf8_lossy(&script))
}
