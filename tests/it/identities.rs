//! Identities that do not depend on comments: of kernels (`device::tokens` has its own tests) and of the readers'
//! sources.

use rtbench::workloads::trace::Selection;
use rtbench::workloads::trace::backend::Config;
use rtbench::workloads::trace::gpu::kernels::{Entry, Kernel};

#[path = "../../build/tokens.rs"]
mod tokens;

#[test]
fn comments_do_not_make_a_cache_stale() {
    let plain = "fn f(x: u32) -> u32 { x + 1 }";
    for same in [
        "/// Adds one.\nfn f(x: u32) -> u32 {\n    // really\n    x + 1\n}\n",
        "//! A file.\n\nfn f(x:u32)->u32{/* why */x+1}",
        "/** Adds\none. */ fn f(/* to */ x: u32) -> u32 { x + 1 }",
    ] {
        assert_eq!(tokens::of(same), tokens::of(plain), "{same}");
    }
    for other in
        ["fn f(x: u32) -> u32 { x + 2 }", "#[inline] fn f(x: u32) -> u32 { x + 1 }", "fn g(x: u32) -> u32 { x + 1 }"]
    {
        assert_ne!(tokens::of(other), tokens::of(plain), "{other}");
    }
    // What looks like a comment inside a string is none
    assert_ne!(tokens::of("const A: &str = \"http://a\";"), tokens::of("const A: &str = \"http://b\";"));
    // Source that is none is taken as it is
    assert_eq!(tokens::of("a \" b"), "a \" b");
}

#[test]
fn comments_do_not_make_another_kernel() {
    let entry = Entry::Render { config: Config::PSR, counting: false };
    let method = Selection::parse("bvh-stack").unwrap().method();
    let kernel = Kernel { entry, method, stack_size: 32, software_threads: 0, textures: false, leaf_order: false };
    let source = kernel.assemble().unwrap();
    let mut commented = source.clone();
    commented.text = source.text.replace(" // ", " // another word, ").replace(";\n", ";   // end\n\n");
    assert_ne!(commented.text, source.text);
    assert_eq!(commented.hash(), source.hash());
    commented.text = source.text.replacen("0.25", "0.5", 1);
    assert_ne!(commented.hash(), source.hash());
}
