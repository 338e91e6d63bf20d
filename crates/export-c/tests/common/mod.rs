//! Compilers of C for the tests.

use std::path::Path;
use std::process::{Command, Output};

/// Flags under which the C has to compile without a warning.
pub const STRICT: [&str; 9] = [
    "-std=c99",
    "-Wall",
    "-Wextra",
    "-Werror",
    "-Wpedantic",
    "-Wconversion",
    "-Wsign-conversion",
    "-Wparentheses",
    "-ffp-contract=off",
];

/// Returns the compilers of C at hand; says aloud which one is absent.
pub fn compilers() -> Vec<&'static str> {
    let mut found = Vec::new();
    for name in ["cc", "clang"] {
        if Command::new(name).arg("--version").output().is_ok_and(|output| output.status.success()) {
            found.push(name);
        } else {
            eprintln!("SKIPPED: no compiler `{name}`");
        }
    }
    found
}

/// Runs a compiler of C.
pub fn compile(compiler: &str, flags: &[&str], source: &Path, output: &Path) -> Output {
    Command::new(compiler)
        .args(flags)
        .arg(source)
        .arg("-o")
        .arg(output)
        .output()
        .expect("the compiler starts")
}
