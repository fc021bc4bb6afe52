//! The texts of all kernels, which are part of the program.

// FILES: every file of `kernels/` (written by `build/main.rs`)
include!(concat!(env!("OUT_DIR"), "/kernel_files.rs"));
