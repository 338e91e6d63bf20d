//! Pages on flight code: their commands run as they stand, and their C compiles.

use std::path::Path;
use std::process::Command;

use flexsc_export_c::control_system::ControlSystem;
use flexsc_export_c::self_test::self_tests;

use crate::flight_exports::{CALLS, is_installed, scenario_of, text};
use crate::util::Dir;

/// Returns a page of the documentation.
fn page(name: &str) -> String {
    let path = format!("{}/../../docs/{name}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(path).expect("the page")
}

/// Returns the lines of the blocks of a language, indented or not.
fn lines_of(page: &str, language: &str) -> Vec<String> {
    let (opening, mut lines, mut is_within) = (format!("```{language}"), Vec::new(), false);
    for line in page.lines() {
        match line.trim_start() {
            mark if mark == opening => is_within = true,
            "```" => is_within = false,
            _ if is_within => lines.push(line.to_owned()),
            _ => {}
        }
    }
    lines
}

/// Options that shorten the commands of a page: of `flexsc export-c`, and variables of `make`.
#[derive(Default)]
struct Shortened {
    export: String,
    make: String,
}

/// Runs the commands of a page in one directory, and returns their number. Those whose tools are absent are left out.
fn run_commands(dir: &Dir, page: &str, shortened: &Shortened) -> usize {
    let lines = lines_of(page, "console");
    for line in &lines {
        let (command, arguments) = line.trim().split_once(' ').expect("a command and its arguments");
        if command == "flexsc" {
            let options = if arguments.starts_with("export-c ") { shortened.export.as_str() } else { "" };
            dir.run(&format!("{arguments} {options}")).exits(0);
            continue;
        }
        if !["make", "gcc", "g++"].iter().all(|command| is_installed(command)) {
            continue;
        }
        let mut made = Command::new(command);
        made.args(arguments.split(' ')).current_dir(dir.path("")).env("MAKEFLAGS", &shortened.make);
        let output = made.output().expect(line);
        assert!(output.status.success(), "{line}: {}", text(&output));
        text(&output).lines().filter(|line| line.contains("skipped")).for_each(|line| eprintln!("{line}"));
    }
    lines.len()
}

#[test]
fn commands_about_guests_run() {
    let count =
        run_commands(&Dir::with(&["earth-observer"]), &page("flight-guests.md"), &Shortened::default());
    assert!(count >= 3, "{count} commands");
}

#[test]
fn commands_from_a_scenario_to_a_board_run_and_the_code_compiles() {
    let page = page("flight-code.md");
    let (head, tutorial) = page.split_once("## From a scenario to a Cortex-M board").expect("the section");
    let tutorial = tutorial.split("\n## ").next().expect("a section");
    let dir = Dir::new();
    // The last of 16 blocks of 256 cycles has extreme inputs.
    let system = ControlSystem::new(&scenario_of("earth-observer")).expect("an exportable scenario");
    let [host, board] = self_tests(&system, [20_000, 4096]);
    let shortened = Shortened {
        export: format!("--calls {CALLS}"),
        make: format!("CYCLES=20000 HASH={host:016x} BOARD_CYCLES=4096 BOARD_HASH={board:016x}"),
    };
    let count = run_commands(&Dir::with(&["earth-observer"]), head, &shortened);
    assert!(count >= 2, "{count} commands");
    let count = run_commands(&dir, tutorial, &shortened);
    assert!(count >= 6, "{count} commands");
    let code = lines_of(tutorial, "c").join("\n");
    assert!(code.contains("aocs_init"), "{code}");
    dir.write("flight/board.c", format!("#include \"aocs.h\"\n{code}\n"));
    if is_installed("gcc") {
        let mut compiler = Command::new("gcc");
        compiler.args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-ffp-contract=off", "-c", "board.c"]);
        let output = compiler.current_dir(dir.path("flight")).output().expect("gcc runs");
        assert!(output.status.success(), "{}", text(&output));
        assert!(Path::new(&dir.path("flight/board.o")).exists());
    }
}
