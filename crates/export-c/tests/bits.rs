//! Sample of each construct of the subset: the C compiles without a warning, and returns the bits of the Rust.

#![expect(unexpected_cfgs, reason = "the sample has the condition of crates/flight")]

mod common;

#[expect(dead_code, reason = "fields and functions are there for the translator")]
#[path = "subset/angles.rs"]
mod angles;
#[expect(clippy::all, clippy::pedantic, reason = "each construct is there, clear or not")]
#[path = "subset/sample.rs"]
mod sample;

use std::fmt::Write as _;
use std::fs;
use std::process::{Command, Stdio};

use common::{STRICT, compile, compilers};
use flexsc_export_c::{SourceFile, Translation, translate};

/// Function of the sample: its path, and whether it returns a float.
struct Subject {
    name: &'static str,
    is_float: bool,
    rust: fn(f64, f64, u64) -> u64,
}

/// Bits of a float, of all NaN alike.
fn float_bits(x: f64) -> u64 {
    if x.is_nan() { u64::MAX } else { x.to_bits() }
}

const SUBJECTS: [Subject; 10] = [
    Subject { name: "arithmetic", is_float: true, rust: |a, b, n| float_bits(sample::arithmetic(a, b, n)) },
    Subject { name: "logic", is_float: false, rust: sample::logic },
    Subject { name: "bits", is_float: false, rust: sample::bits },
    Subject { name: "casts", is_float: false, rust: sample::casts },
    Subject { name: "divisions", is_float: false, rust: |a, b, n| sample::divisions(a, b, n) as u64 },
    Subject { name: "branches", is_float: true, rust: |a, b, n| float_bits(sample::branches(a, b, n)) },
    Subject { name: "loops", is_float: true, rust: |a, b, n| float_bits(sample::loops(a, b, n)) },
    Subject { name: "structs", is_float: true, rust: |a, b, n| float_bits(sample::structs(a, b, n)) },
    Subject { name: "references", is_float: true, rust: |a, b, n| float_bits(sample::references(a, b, n)) },
    Subject { name: "names", is_float: true, rust: |a, b, n| float_bits(sample::names(a, b, n)) },
];

const FILES: [SourceFile<'static>; 2] = [
    SourceFile { path: "subset/angles.rs", module: "angles", text: include_str!("subset/angles.rs") },
    SourceFile { path: "subset/sample.rs", module: "sample", text: include_str!("subset/sample.rs") },
];

fn translated() -> Translation {
    let roots: Vec<String> = SUBJECTS.iter().map(|subject| format!("sample::{}", subject.name)).collect();
    let roots: Vec<&str> = roots.iter().map(String::as_str).collect();
    match translate(&FILES, &roots, "sat") {
        Ok(translation) => translation,
        Err(error) => panic!("{error}"),
    }
}

/// Returns a program that prints the bits of each function for each line of arguments.
fn program(translation: &Translation) -> String {
    let mut text = format!(
        "#include <stdio.h>\n{}{}{}{}",
        translation.includes, translation.guards, translation.declarations, translation.definitions
    );
    text += "static uint64_t bits(double x) {\n    uint64_t y;\n    memcpy(&y, &x, sizeof y);\n    return x != x ? UINT64_MAX : y;\n}\n\n";
    text += "int main(void) {\n    uint64_t in[3];\n    uint64_t out;\n    double a;\n    double b;\n";
    text += "    while (fread(in, sizeof in, 1, stdin) == 1) {\n        memcpy(&a, &in[0], 8);\n        memcpy(&b, &in[1], 8);\n";
    for subject in &SUBJECTS {
        let name = translation.function_name(&format!("sample::{}", subject.name)).expect("a root");
        let call = if subject.is_float { "bits" } else { "(uint64_t)" };
        writeln!(text, "        out = {call}({name}(a, b, in[2]));").expect("a string");
        text += "        fwrite(&out, sizeof out, 1, stdout);\n";
    }
    text + "    }\n    return 0;\n}\n"
}

/// Returns arguments of many magnitudes, special ones among them.
fn arguments(count: usize) -> Vec<[u64; 3]> {
    let special = [0.0, -0.0, 1.0, -1.0, f64::INFINITY, f64::NAN, 1e300, 5e-324, 2_147_483_648.0, -1e19];
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut draw = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state
    };
    let mut list = Vec::new();
    for i in 0..count {
        let mut float = |kind: u64| match kind % 4 {
            0 => special[(draw() % 10) as usize],
            1 => f64::from_bits(draw()),
            2 => (draw() >> 11) as f64 / 9e15 * 2e3 - 1e3,
            _ => (draw() >> 11) as f64 / 9e15 * 20.0 - 10.0,
        };
        let (a, b) = (float(i as u64 / 3), float(i as u64));
        let n = if i % 5 == 0 { draw() & 15 } else { draw() };
        list.push([a.to_bits(), b.to_bits(), n]);
    }
    list
}

#[test]
fn sample_has_the_bits_of_rust() {
    let folder = tempfile::tempdir().expect("a folder");
    let source = folder.path().join("sample.c");
    fs::write(&source, program(&translated())).expect("a file");
    if let Ok(copy) = std::env::var("FLEXSC_KEEP_C") {
        fs::copy(&source, copy).expect("a copy");
    }
    let list = arguments(20_000);
    let bytes: Vec<u8> = list.iter().flatten().flat_map(|word| word.to_ne_bytes()).collect();
    fs::write(folder.path().join("in"), &bytes).expect("a file");
    for compiler in compilers() {
        for level in ["-O0", "-O3"] {
            let binary = folder.path().join("sample");
            let flags: Vec<&str> = STRICT.iter().copied().chain([level]).collect();
            let output = compile(compiler, &flags, &source, &binary);
            assert!(
                output.status.success(),
                "{compiler} {level}:\n{}",
                String::from_utf8_lossy(&output.stderr)
            );
            let input = fs::File::open(folder.path().join("in")).expect("the arguments");
            let output = Command::new(&binary).stdin(Stdio::from(input)).output().expect("it runs");
            assert!(output.status.success(), "{compiler} {level} fails");
            assert_eq!(output.stdout.len(), list.len() * SUBJECTS.len() * 8, "{compiler} {level}");
            let mut words = output.stdout.chunks_exact(8);
            for [a, b, n] in &list {
                for subject in &SUBJECTS {
                    let word =
                        words.next().map_or(0, |word| u64::from_ne_bytes(word.try_into().expect("8 bytes")));
                    let (x, y) = (f64::from_bits(*a), f64::from_bits(*b));
                    let expected = (subject.rust)(x, y, *n);
                    assert_eq!(word, expected, "{compiler} {level}: {}({x:?}, {y:?}, {n})", subject.name);
                }
            }
        }
    }
}
