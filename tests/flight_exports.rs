//! Exported control systems that several tests compile: the command exports each of them once.

use std::collections::BTreeMap;
use std::process::{Command, Output};
use std::sync::LazyLock;

use flexsc_core::Scenario;
use flexsc_flight_precision::Precision;

use crate::util::Dir;

/// A relay at samples, a PD law with a gain schedule, phase planes with active damping, attitude laws with wheels in both
/// precisions, a compensator about three axes, PD laws on Kalman filters, and B-dot laws in a mode of operation.
pub const EXPORTED: [&str; 8] = [
    "relay-sampled",
    "wheel-scheduled-gain",
    "iss-ringdown",
    "earth-observer",
    "earth-observer --precision single",
    "earth-observer-lqg",
    "attitude-hold",
    "safe-mode --mode detumble",
];

/// Modes of operation, one of which has a compensator without states.
pub const WITH_MODES: &str = "site-pass";

/// Most vectors of each export.
pub const CALLS: u64 = 2000;

/// Exported files, by their paths.
type Files = Vec<(String, Vec<u8>)>;

/// Returns a directory with the file of an exported scenario, and the arguments of its export.
fn prepared(exported: &str) -> (Dir, String) {
    let (name, mode) = exported.split_once(' ').unwrap_or((exported, ""));
    (Dir::with(&[name]), format!("{name}.toml {mode}"))
}

/// Returns an exported scenario, in the mode that is exported.
pub fn scenario_of(exported: &str) -> Scenario {
    let (dir, arguments) = prepared(exported);
    let (file, mode) = arguments.split_once(' ').expect("a file, and perhaps a mode");
    let scenario = Scenario::load(&dir.path(file)).expect("an exportable scenario");
    match mode.split_once(' ') {
        Some(("--mode", mode)) => scenario.in_mode(mode).expect("a mode of the scenario"),
        Some(("--precision", _)) => scenario
            .with(|written| written.flight_precision = Precision::Single)
            .expect("exportable in single"),
        _ => scenario,
    }
}

/// Exports a scenario, with both guests, and returns the files.
fn files_of(exported: &str) -> Files {
    let (dir, arguments) = prepared(exported);
    // Messages of guests have doubles.
    let has_guests = !arguments.contains("--precision");
    let guests = if has_guests { "--guest cfs --guest fprime" } else { "" };
    let said = dir.run(&format!("export-c {arguments} -o out --calls {CALLS} {guests}")).exits(0);
    let said = said.says(&["calls of the run as vectors"]);
    if has_guests {
        said.says(&["app of cFS", "component of F Prime"]);
    }
    let (mut files, mut folders) = (Vec::new(), vec!["out".to_owned()]);
    while let Some(folder) = folders.pop() {
        for name in dir.names(&folder) {
            let path = format!("{folder}/{name}");
            if dir.path(&path).is_dir() {
                folders.push(path);
            } else {
                files.push((path.clone(), dir.read(&path)));
            }
        }
    }
    files
}

/// Returns a directory of its own with the export of one of [`EXPORTED`], or of [`WITH_MODES`], in `out`.
pub fn exported(name: &str) -> Dir {
    static FILES: LazyLock<BTreeMap<&str, Files>> = LazyLock::new(|| {
        std::thread::scope(|scope| {
            let names = EXPORTED.into_iter().chain([WITH_MODES]);
            let exports: Vec<_> = names.map(|name| (name, scope.spawn(move || files_of(name)))).collect();
            let whole = |(name, export): (_, std::thread::ScopedJoinHandle<'_, Files>)| {
                (name, export.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
            };
            exports.into_iter().map(whole).collect()
        })
    });
    let dir = Dir::new();
    for (path, bytes) in &FILES[name] {
        let path = dir.path(path);
        std::fs::create_dir_all(path.parent().expect("a directory")).expect("a directory");
        std::fs::write(path, bytes).expect("a file");
    }
    dir
}

/// Returns the name of the files of an export.
pub fn prefix(exported: &str) -> String {
    exported.split(' ').next().map(|name| name.replace('-', "_")).expect("a name")
}

/// Returns the hashes in the description of an exported control system.
pub fn hashes(dir: &Dir, within: &str) -> BTreeMap<u64, String> {
    let readme = dir.text(&format!("{within}/README.md"));
    let rows =
        readme.lines().filter_map(|line| line.strip_prefix("| ")?.strip_suffix(" |")?.split_once(" | "));
    rows.filter_map(|(cycles, hash)| Some((cycles.parse().ok()?, hash.to_owned()))).collect()
}

/// True if a command is installed; else it says aloud what is skipped.
pub fn is_installed(command: &str) -> bool {
    let is_there = Command::new(command).arg("--version").output().is_ok_and(|out| out.status.success());
    if !is_there {
        eprintln!("skipped: {command} is not installed");
    }
    is_there
}

/// Runs `make` in a directory of another.
pub fn make(dir: &Dir, within: &str, arguments: &[&str]) -> Output {
    Command::new("make").arg("-C").arg(dir.path(within)).args(arguments).output().expect("make runs")
}

/// Returns what a command printed.
pub fn text(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

/// Returns the page about flight code.
pub fn document() -> String {
    let path = format!("{}/../../docs/flight-code.md", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(path).expect("the document")
}
