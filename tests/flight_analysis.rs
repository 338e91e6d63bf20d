//! Exported control systems under analysis: the most instructions of a call, kinds of findings of static analysis, and panics of
//! the Rust code.

use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

use flexsc_export_c::control_system::ControlSystem;
use flexsc_export_c::self_test::self_test;

use crate::flight_exports::{
    EXPORTED, WITH_MODES, document, exported, is_installed, make, scenario_of, text,
};
use crate::util::Dir;

/// Returns the most instructions of each function on each board: in the run, with random inputs and with extreme ones.
fn counts(printed: &str) -> BTreeMap<String, Vec<u64>> {
    let mut counts: BTreeMap<String, Vec<u64>> = BTreeMap::new();
    for line in printed.lines() {
        let Some((function, rest)) = line.split_once(": at most ") else { continue };
        let numbers =
            rest.split(|letter: char| !letter.is_ascii_digit()).filter_map(|word| word.parse::<u64>().ok());
        counts.entry(function.to_owned()).or_default().extend(numbers);
    }
    counts
}

/// Cycles of the self-test in which instructions are counted on the boards.
const COUNTED_CYCLES: u64 = 4096;

#[test]
fn instructions_are_those_of_the_document_but_for_a_tenth() {
    if !["make", "arm-none-eabi-gcc", "qemu-system-arm"].iter().all(|command| is_installed(command)) {
        return;
    }
    let document = document();
    for name in EXPORTED {
        let dir = exported(name);
        let printed = text(&make(&dir, "out", &["instructions"]));
        assert_eq!(printed.matches("a loop of 2000 instructions: 2000 counted").count(), 2, "{printed}");
        assert_eq!(printed.matches("calls equal").count(), 2, "{printed}");
        let system = ControlSystem::new(&scenario_of(name)).expect("an exportable scenario");
        let hash = format!("\n{:016x}\n", self_test(&system, COUNTED_CYCLES));
        assert_eq!(printed.matches(&hash).count(), 2, "{hash}{printed}");
        let counts = counts(&printed);
        let rows = document.lines().filter(|line| line.starts_with(&format!("| `{name}`, `")));
        assert_eq!(rows.count(), counts.len(), "{name}: {counts:?}");
        for (function, found) in counts {
            let row = document.lines().find_map(|line| {
                line.strip_prefix(&format!("| `{name}`, `{function}` | "))?.strip_suffix(" |")
            });
            let cells = row.unwrap_or_else(|| panic!("no row of {name}, {function}: {found:?}")).split(" | ");
            let told: Vec<u64> = cells.map(|cell| cell.parse().expect("a number")).collect();
            assert_eq!(found.len(), told.len(), "{name}, {function}: {printed}");
            for (found, told) in found.iter().zip(&told) {
                assert!(
                    found * 10 <= told * 11 && told * 10 <= found * 11,
                    "{name}, {function}: {found} and {told} instructions"
                );
            }
        }
    }
}

/// Returns the kinds of findings that the Makefile accepts.
fn accepted(makefile: &str) -> BTreeSet<String> {
    let line = makefile.lines().find_map(|line| line.strip_prefix("DEVIATIONS = ")).expect("the deviations");
    let (plain, misra) = line.split_once("$(addprefix misra-c2012-,").expect("rules of MISRA C");
    let rules = misra.trim_end_matches(')').split_whitespace().map(|rule| format!("misra-c2012-{rule}"));
    plain.split_whitespace().map(str::to_owned).chain(rules).collect()
}

#[test]
fn static_analysis_finds_what_the_document_lists() {
    let document = document();
    let section = document.split("## Static analysis").nth(1).expect("a section").split("\n## ").next();
    let told: BTreeSet<String> = section
        .expect("a section")
        .lines()
        .filter_map(|line| Some(line.strip_prefix("| `")?.split_once('`')?.0.to_owned()))
        .collect();
    let all: Vec<(&str, Dir)> =
        EXPORTED.into_iter().chain([WITH_MODES]).map(|name| (name, exported(name))).collect();
    for (_, dir) in &all {
        assert_eq!(accepted(&dir.text("out/Makefile")), told);
    }
    if !is_installed("make") {
        return;
    }
    for (name, dir) in &all {
        let output = make(dir, "out", &["lint"]);
        let said = text(&output);
        assert!(output.status.success(), "{name}: {said}");
        said.lines().filter(|line| line.contains("skipped")).for_each(|line| eprintln!("{name}: {line}"));
    }
    // A finding of another kind is an error.
    let (_, dir) = &all[0];
    let source = dir.text("out/relay_sampled.c");
    if is_installed("cppcheck") {
        let body = "\nint relay_sampled_spoilt(int count);\nint relay_sampled_spoilt(int count)\n{\n    int list[2];\n    \
                    (void)count;\n    goto end;\nend:\n    return list[1];\n}\n";
        dir.write("out/relay_sampled.c", format!("{source}{body}"));
        let output = make(dir, "out", &["lint", "CC=absent"]);
        let said = text(&output);
        assert!(!output.status.success() && said.contains("misra-c2012-15.1 relay_sampled.c:"), "{said}");
        assert!(said.contains("warnings: skipped, absent is not installed"), "{said}");
    }
    if is_installed("gcc") {
        dir.write(
            "out/relay_sampled.c",
            format!("{source}\nint relay_sampled_spoilt(void) {{ return 1; }}\n"),
        );
        let output = make(dir, "out", &["lint"]);
        assert!(
            !output.status.success() && text(&output).contains("missing-prototypes"),
            "{}",
            text(&output)
        );
    }
}

/// The exported C has no panics. Optimised Rust keeps tests of an index into a slice, and no other panic: no `unwrap`, no overflow.
#[test]
fn optimised_rust_has_no_panic_but_of_bounds() {
    let dir = Dir::with(&[]);
    let crate_root = format!("{}/../flight/src/lib.rs", env!("CARGO_MANIFEST_DIR"));
    let rustc = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
    let output = Command::new(rustc)
        .args(["--edition", "2024", "--crate-type", "lib", "--crate-name", "flexsc_flight", &crate_root])
        .args(["-Copt-level=3", "-Cpanic=abort", "-Ccodegen-units=1", "--emit=asm", "-o"])
        .arg(dir.path("flight.s"))
        .output()
        .expect("rustc runs");
    assert!(output.status.success(), "{}", text(&output));
    let (mut functions, mut checks, mut current) = (BTreeSet::new(), 0, String::new());
    let assembly = dir.text("flight.s");
    for line in assembly.lines() {
        if let Some(label) = line.strip_suffix(':').filter(|label| label.starts_with('_')) {
            label.clone_into(&mut current);
        }
        // Calls and jumps, in the assembly of any processor.
        let is_code = line.starts_with('\t') && !line.trim_start().starts_with('.');
        if is_code && line.contains("panic") {
            assert!(line.contains("panic_bounds_check"), "{current}: {line}");
            functions.insert(current.clone());
            checks += 1;
        }
    }
    let document = document();
    let row = document.lines().find_map(|line| line.strip_prefix("Tests of bounds: ")).expect("the list");
    let told: Vec<&str> = row.split('`').skip(1).step_by(2).collect();
    assert!(checks > 0 && functions.len() == told.len(), "{checks} in {functions:?}, told {told:?}");
    for name in told {
        let words: Vec<&str> = name.split("::").collect();
        let is_among =
            |label: &String| words.iter().all(|word| label.contains(&format!("{}{word}", word.len())));
        assert!(functions.iter().any(is_among), "{name}: {functions:?}");
    }
}
