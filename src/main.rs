//! The `rtbench` program: everything is in the library's [`rtbench::cli`].

fn main() -> std::process::ExitCode {
    rtbench::cli::main()
}
