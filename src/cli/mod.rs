//! The command line. One file per command; only here is anything printed.
//!
//! Results go to standard output, everything else to standard error. Exit codes: 0 all is well or skipped, 1 a
//! check's answer is no (a kernel was wrong, a structure is not valid, a document is not up to date), 2 something could
//! not run, 130 Ctrl-C.

mod ab;
mod baselines;
mod bless;
mod build;
mod camera_path;
mod claims;
mod compare;
mod completions;
mod device;
mod devices;
mod env;
mod figures;
mod flags;
mod gate;
mod interrupt;
mod kernels;
mod library;
mod merge;
mod output;
mod plan;
mod progress;
mod render;
mod report;
mod runs;
mod scenes;
mod simt;
mod structures;
mod tables;
mod trace;
mod workload;

use crate::error::Result;
use crate::harness::environment;
use clap::error::ErrorKind;
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use std::process::ExitCode;

/// Ray tracing on a GPU with a uniform grid, a kd-tree and a BVH, measured against each other.
#[derive(Parser)]
#[command(name = "rtbench", version = environment::VERSION, max_term_width = 100, arg_required_else_help = true, after_help = AFTER_HELP)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

const AFTER_HELP: &str = "\
Begin with:
  rtbench sweep                          measure everything on built-in scenes, in minutes
  rtbench sweep --scene bunny.ply        the same for a scene of your own
  rtbench render --scene hall -o hall.png
  rtbench devices                        what there is to measure
  rtbench report results/RUN -o run.html what was measured, with the numbers of 2009

Exit codes: 0 all is well, 1 a check's answer is no (a kernel was wrong, a structure is not valid, a
document is not up to date), 2 something could not run, 130 Ctrl-C.";

#[derive(Subcommand)]
enum Command {
    Tables(tables::Arguments),
    Claims(claims::Arguments),
    Figures(figures::Arguments),
    Report(report::Arguments),
    Merge(merge::Arguments),
    Compare(compare::Arguments),
    Ab(ab::Arguments),
    Gate(gate::Arguments),
    Bless(bless::Arguments),
    Render(render::Arguments),
    Build(build::Arguments),
    Trace(trace::Arguments),
    #[command(subcommand)]
    Scenes(scenes::Command),
    #[command(subcommand)]
    CameraPath(camera_path::Command),
    Simt(simt::Arguments),
    Structures(structures::Arguments),
    Kernels(kernels::Arguments),
    Devices(devices::Arguments),
    Env(env::Arguments),
    Completions(completions::Arguments),
}

/// The whole command line: the commands of this folder, and one per workload.
fn cli() -> clap::Command {
    let mut cli = Cli::command();
    for (index, command) in workload::commands().into_iter().chain([workload::plan_command()]).enumerate() {
        cli = cli.subcommand(command.display_order(index));
    }
    let others: Vec<String> = cli.get_subcommands().map(|command| command.get_name().to_owned()).collect();
    for (index, name) in others.iter().enumerate() {
        if crate::workloads::find(name).is_none() && name != "plan" {
            cli = cli.mut_subcommand(name, |command| command.display_order(100 + index));
        }
    }
    cli
}

/// Runs the program.
pub fn main() -> ExitCode {
    interrupt::survive_file_size_limit();
    let matches = match cli().try_get_matches() {
        Ok(matches) => matches,
        Err(error) => return usage(&error),
    };
    let result = match workload::run(&matches) {
        Some(result) => result,
        None => match Cli::from_arg_matches(&matches) {
            Ok(cli) => run(cli.command),
            Err(error) => return usage(&error),
        },
    };
    result.unwrap_or_else(|error| {
        output::complain(&error.to_string());
        ExitCode::from(error.exit_code())
    })
}

fn run(command: Command) -> Result<ExitCode> {
    let done = |()| ExitCode::SUCCESS;
    match command {
        Command::Tables(arguments) => tables::run(&arguments).map(done),
        Command::Claims(arguments) => claims::run(&arguments).map(done),
        Command::Figures(arguments) => figures::run(&arguments).map(done),
        Command::Report(arguments) => report::run(&arguments).map(done),
        Command::Merge(arguments) => merge::run(&arguments),
        Command::Compare(arguments) => compare::run(&arguments).map(done),
        Command::Ab(arguments) => ab::run(&arguments).map(done),
        Command::Gate(arguments) => gate::run(&arguments),
        Command::Bless(arguments) => bless::run(&arguments).map(done),
        Command::Render(arguments) => render::run(&arguments).map(done),
        Command::Build(arguments) => build::run(&arguments),
        Command::Trace(arguments) => trace::run(&arguments).map(done),
        Command::Scenes(command) => scenes::run(&command).map(done),
        Command::CameraPath(command) => camera_path::run(&command).map(done),
        Command::Simt(arguments) => simt::run(&arguments).map(done),
        Command::Structures(arguments) => structures::run(&arguments).map(done),
        Command::Kernels(arguments) => kernels::run(&arguments).map(done),
        Command::Devices(arguments) => devices::run(&arguments).map(done),
        Command::Env(arguments) => env::run(&arguments).map(done),
        Command::Completions(arguments) => completions::run(&arguments).map(done),
    }
}

/// What clap has to say: help and version go to standard output, a mistake becomes one line like every other error.
fn usage(error: &clap::Error) -> ExitCode {
    match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => {
            // A reader that closed the pipe has read enough.
            let _ = error.print();
            ExitCode::SUCCESS
        }
        ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => {
            let _ = error.print();
            ExitCode::from(2)
        }
        _ => {
            let text = error.render().to_string();
            let lines = text.lines().map(str::trim).take_while(|line| !line.starts_with("Usage:"));
            let lines: Vec<&str> = lines
                .filter(|line| !line.is_empty() && !line.starts_with("For more information"))
                .map(|line| line.trim_start_matches("error: ").trim_start_matches("tip: "))
                .collect();
            output::complain(&format!("{} (see --help)", sentence(&lines)));
            ExitCode::from(2)
        }
    }
}

/// Several lines as one: what follows a colon belongs to it.
fn sentence(lines: &[&str]) -> String {
    let mut sentence = String::new();
    for line in lines {
        sentence += match sentence.chars().last() {
            None => "",
            Some(':') => " ",
            Some(_) => "; ",
        };
        sentence += line;
    }
    sentence
}
