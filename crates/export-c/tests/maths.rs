//! Mathematics of `crates/flight`: all of it is translated, and the C returns the bits of the Rust.
//!
//! The folder is `crates/flight/src`, or that of the variable `FLEXSC_FLIGHT`.

mod common;

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use common::{STRICT, compile, compilers};
use flexsc_export_c::{SourceFile, Translation, translate};

/// Functions of one and of two numbers that are compared.
const ONE: [&str; 14] = [
    "trigonometry::sin",
    "trigonometry::cos",
    "trigonometry::tan",
    "inverse_trigonometry::asin",
    "inverse_trigonometry::acos",
    "inverse_trigonometry::atan",
    "exponentials::exp",
    "exponentials::expm1",
    "exponentials::log",
    "square_root::sqrt",
    "maths::round",
    "maths::trunc",
    "maths::floor",
    "binary64::upper_half",
];
const TWO: [&str; 4] = ["inverse_trigonometry::atan2", "hypotenuse::hypot", "maths::min", "maths::max"];

/// Number of arguments.
const COUNT: usize = 100_000;

/// Module and text of each translated file.
struct FlightFile {
    path: String,
    module: String,
    text: String,
}

fn flight_folder() -> Option<PathBuf> {
    let folder = match std::env::var("FLEXSC_FLIGHT") {
        Ok(folder) => PathBuf::from(folder),
        Err(_) => Path::new(env!("CARGO_MANIFEST_DIR")).join("../flight/src"),
    };
    if folder.join("trigonometry.rs").exists() {
        return Some(folder);
    }
    eprintln!("SKIPPED: no mathematics in {}", folder.display());
    None
}

fn flight_files(folder: &Path) -> Vec<FlightFile> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).expect("the folder") {
        let path = entry.expect("an entry").path();
        let module = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default().to_owned();
        if path.extension().is_some_and(|extension| extension == "rs") && module != "lib" {
            let text = fs::read_to_string(&path).expect("a file");
            files.push(FlightFile { path: path.display().to_string(), module, text });
        }
    }
    files.sort_by(|a, b| a.module.cmp(&b.module));
    files
}

fn translated(files: &[FlightFile], roots: &[&str]) -> Translation {
    let sources: Vec<SourceFile<'_>> = files
        .iter()
        .map(|file| SourceFile { path: &file.path, module: &file.module, text: &file.text })
        .collect();
    match translate(&sources, roots, "sat") {
        Ok(translation) => translation,
        Err(error) => panic!("{error}"),
    }
}

fn whole(translation: &Translation) -> String {
    format!(
        "#include <stdio.h>\n{}{}{}{}",
        translation.includes, translation.guards, translation.declarations, translation.definitions
    )
}

/// Returns a program in C that prints the bits of each function for each pair of numbers.
fn program(translation: &Translation) -> String {
    let mut text = whole(translation);
    text += "int main(void) {\n    double in[2];\n    double out;\n    while (fread(in, sizeof in, 1, stdin) == 1) {\n";
    for (roots, arguments) in [(&ONE[..], "in[0]"), (&TWO[..], "in[0], in[1]")] {
        for root in roots {
            let name = translation.function_name(root).expect("a root");
            writeln!(text, "        out = {name}({arguments});\n        fwrite(&out, 8, 1, stdout);")
                .expect("a string");
        }
    }
    text + "    }\n    return 0;\n}\n"
}

/// Returns the program in Rust that does so with the crate itself.
fn reference() -> String {
    let mut text = String::from(
        "use std::io::{Read, Write};\nfn main() {\n    let mut bytes = Vec::new();\n    std::io::stdin().read_to_end(&mut bytes).unwrap();\n    \
         let mut out = Vec::new();\n    for pair in bytes.chunks_exact(16) {\n        \
         let a = f64::from_ne_bytes(pair[..8].try_into().unwrap());\n        let b = f64::from_ne_bytes(pair[8..].try_into().unwrap());\n",
    );
    for (roots, arguments) in [(&ONE[..], "a"), (&TWO[..], "a, b")] {
        for root in roots {
            writeln!(text, "        out.extend(flight::{root}({arguments}).to_ne_bytes());")
                .expect("a string");
        }
    }
    text + "        let _ = b;\n    }\n    std::io::stdout().write_all(&out).unwrap();\n}\n"
}

/// Returns numbers of all exponents, of common magnitudes, and special ones.
fn arguments() -> Vec<u8> {
    let special = [0.0, -0.0, 1.0, -1.0, f64::INFINITY, -f64::INFINITY, f64::NAN, 5e-324, 1e300, 0.5];
    let mut state = 0x0123_4567_89ab_cdef_u64;
    let mut draw = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state
    };
    let mut bytes = Vec::new();
    for i in 0..2 * COUNT {
        let unit = (draw() >> 11) as f64 / 9_007_199_254_740_992.0;
        let number = match (i / 2 + i % 2 * 3) % 5 {
            0 => f64::from_bits(draw()),
            1 => 2.0 * unit - 1.0,
            2 => 200.0 * unit - 100.0,
            3 => 1500.0 * unit - 750.0,
            _ if i % 7 == 0 => special[(draw() % 10) as usize],
            _ => (unit * 1e9 - 5e8) * unit,
        };
        bytes.extend(number.to_ne_bytes());
    }
    bytes
}

fn run(program: &Path, input: &Path) -> Vec<u8> {
    let input = fs::File::open(input).expect("the arguments");
    let output = Command::new(program).stdin(Stdio::from(input)).output().expect("it runs");
    assert!(output.status.success(), "{} fails", program.display());
    output.stdout
}

fn compile_reference(folder: &Path, flight: &Path) -> PathBuf {
    let source = folder.join("reference.rs");
    fs::write(&source, reference()).expect("a file");
    let library = folder.join("libflight.rlib");
    let rustc = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
    let start = || {
        let mut command = Command::new(&rustc);
        command.args(["--edition", "2024", "-O", "--cap-lints", "allow"]);
        command
    };
    let mut first = start();
    first
        .args(["--crate-type", "rlib", "--crate-name", "flight", "-o"])
        .arg(&library)
        .arg(flight.join("lib.rs"));
    assert!(first.status().expect("rustc starts").success(), "the crate compiles");
    let binary = folder.join("reference");
    let mut second = start();
    second.arg("--extern").arg(format!("flight={}", library.display())).arg("-o").arg(&binary).arg(&source);
    assert!(second.status().expect("rustc starts").success(), "the reference compiles");
    binary
}

#[test]
fn mathematics_has_the_bits_of_rust() {
    let Some(flight) = flight_folder() else { return };
    let files = flight_files(&flight);
    let folder = tempfile::tempdir().expect("a folder");
    let roots: Vec<&str> = ONE.iter().chain(&TWO).copied().collect();
    let source = folder.path().join("maths.c");
    fs::write(&source, program(&translated(&files, &roots))).expect("a file");
    let input = folder.path().join("in");
    fs::write(&input, arguments()).expect("a file");
    let expected = run(&compile_reference(folder.path(), &flight), &input);
    for compiler in compilers() {
        for level in ["-O0", "-O3"] {
            let binary = folder.path().join("maths");
            let flags: Vec<&str> = STRICT.iter().copied().chain([level]).collect();
            let output = compile(compiler, &flags, &source, &binary);
            assert!(
                output.status.success(),
                "{compiler} {level}:\n{}",
                String::from_utf8_lossy(&output.stderr)
            );
            let found = run(&binary, &input);
            assert_eq!(found.len(), expected.len(), "{compiler} {level}");
            for (i, (a, b)) in found.chunks_exact(8).zip(expected.chunks_exact(8)).enumerate() {
                assert_eq!(
                    a,
                    b,
                    "{compiler} {level}: {} of the arguments {}",
                    roots[i % roots.len()],
                    i / roots.len()
                );
            }
        }
    }
}

#[test]
fn each_function_of_the_mathematics_compiles() {
    let Some(flight) = flight_folder() else { return };
    let files = flight_files(&flight);
    let mut roots = Vec::new();
    for file in &files {
        for line in file.text.lines() {
            let line = line.strip_prefix("pub ").unwrap_or(line);
            if let Some((name, _)) = line.strip_prefix("fn ").and_then(|rest| rest.split_once('(')) {
                roots.push(format!("{}::{name}", file.module));
            }
        }
    }
    assert!(roots.len() > 40, "{roots:?}");
    let roots: Vec<&str> = roots.iter().map(String::as_str).collect();
    let folder = tempfile::tempdir().expect("a folder");
    let source = folder.path().join("all.c");
    fs::write(&source, whole(&translated(&files, &roots))).expect("a file");
    for compiler in compilers() {
        let flags: Vec<&str> = STRICT.iter().copied().chain(["-O2", "-c", "-Wno-unused-function"]).collect();
        let output = compile(compiler, &flags, &source, &folder.path().join("all.o"));
        assert!(output.status.success(), "{compiler}:\n{}", String::from_utf8_lossy(&output.stderr));
    }
}
