//! Guards: the C stops the build under flags that change bits.

mod common;

use std::fs;

use common::{STRICT, compile, compilers};
use flexsc_export_c::{SourceFile, translate};

/// Flags, and words of the error that they give.
const FLAGS: [(&[&str], &str); 6] = [
    (&["-ffast-math"], "sat: -ffast-math"),
    (&["-Ofast"], "sat: -ffast-math"),
    (&["-ffinite-math-only"], "sat: -ffast-math"),
    (&["-freciprocal-math"], "sat: -fassociative-math"),
    (&["-mfpmath=387"], "sat: doubles are not evaluated in their own precision (x87)"),
    (&["-fsingle-precision-constant"], "sat_constant_has_8_bytes"),
];

fn written(folder: &tempfile::TempDir) -> std::path::PathBuf {
    let text = "pub fn sum(a: f64, b: f64, c: f64) -> f64 { a * b + c }";
    let file = SourceFile { path: "law.rs", module: "law", text };
    let translation = translate(&[file], &["law::sum"], "sat").expect("the subset");
    let main = "double sum(double a, double b, double c);\ndouble sum(double a, double b, double c) {\n    return law_sum(a, b, c);\n}\n";
    let path = folder.path().join("law.c");
    let text = translation.includes
        + &translation.guards
        + &translation.declarations
        + &translation.definitions
        + main;
    fs::write(&path, text).expect("a file");
    path
}

#[test]
fn flags_that_change_bits_stop_the_build() {
    let folder = tempfile::tempdir().expect("a folder");
    let source = written(&folder);
    let object = folder.path().join("law.o");
    let strict: Vec<&str> = STRICT.iter().copied().chain(["-c"]).collect();
    for compiler in compilers() {
        let output = compile(compiler, &strict, &source, &object);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        // A compiler that does not know a flag cannot be tested with it.
        let empty = folder.path().join("empty.c");
        fs::write(&empty, "#include <float.h>\nint method = FLT_EVAL_METHOD;\n").expect("a file");
        for (flags, words) in FLAGS {
            let all: Vec<&str> = ["-O2", "-Werror", "-c"].into_iter().chain(flags.iter().copied()).collect();
            if !compile(compiler, &all, &empty, &object).status.success() {
                eprintln!("SKIPPED: {compiler} does not take {flags:?}");
                continue;
            }
            let output = compile(compiler, &all, &source, &object);
            let errors = String::from_utf8_lossy(&output.stderr);
            if compiler == "clang"
                && output.status.success()
                && *flags != ["-ffast-math"]
                && *flags != ["-Ofast"]
            {
                // Clang defines no macro for some of them.
                eprintln!("SKIPPED: {compiler} does not show {flags:?}");
                continue;
            }
            assert!(!output.status.success() && errors.contains(words), "{compiler} {flags:?}: {errors}");
        }
    }
}

#[test]
fn floats_may_be_evaluated_as_doubles() {
    // As on s390x in C99: the code has no floats, so that nothing changes.
    let folder = tempfile::tempdir().expect("a folder");
    let source = written(&folder);
    let text = fs::read_to_string(&source).expect("the code");
    let redefined = "#include <float.h>\n#undef FLT_EVAL_METHOD\n#define FLT_EVAL_METHOD ";
    for (method, builds) in [(0, true), (1, true), (2, false), (-1, false)] {
        fs::write(&source, format!("{redefined}{method}\n{}", text.replace("#include <float.h>\n", "")))
            .expect("a file");
        for compiler in compilers() {
            let output = compile(compiler, &["-O2", "-c"], &source, &folder.path().join("law.o"));
            let errors = String::from_utf8_lossy(&output.stderr);
            assert_eq!(output.status.success(), builds, "{compiler} {method}: {errors}");
        }
    }
}

#[test]
fn products_and_sums_are_not_joined() {
    let folder = tempfile::tempdir().expect("a folder");
    let source = written(&folder);
    let assembly = folder.path().join("law.s");
    for compiler in compilers() {
        // Without -ffp-contract=off: the file itself has to ask for it.
        let output = compile(compiler, &["-O2", "-mfma", "-S"], &source, &assembly);
        if !output.status.success() {
            eprintln!("SKIPPED: {compiler} does not take -mfma");
            continue;
        }
        let text = fs::read_to_string(&assembly).expect("the assembly");
        assert!(text.contains("mulsd") && !text.contains("fmadd"), "{compiler} joins:\n{text}");
    }
}
