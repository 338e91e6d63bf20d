//! Exported control systems as the flight software of `flexsc serve`: the rows of a run in one process, and a CubeSat with faults.

use std::path::{Path, PathBuf};
use std::process::{Command as Program, Stdio};
use std::sync::atomic::Ordering;

use crate::control_client::{Faults, FaultyLink};
use crate::day_balance::SHORT;
use crate::serve::{rows, serve};
use crate::util::Dir;

/// Exports a scenario, with its options, and compiles a program of `clients/c` around it with definitions of macros; `None` on a machine without a
/// compiler, which is reported.
fn flight_program(
    dir: &Dir,
    scenario: &str,
    prefix: &str,
    program: &str,
    definitions: &[&str],
) -> Option<PathBuf> {
    dir.run(&format!("export-c {scenario} -o flight --name {prefix} --calls 10")).exits(0);
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../clients/c");
    let (made, flight) = (dir.path(program), dir.path("flight"));
    let mut compiler = Program::new("cc");
    compiler.args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-Wpedantic", "-Wconversion"]);
    compiler.args(definitions).args(["-ffp-contract=off", "-O2", "-I"]).arg(&flight).arg("-o").arg(&made);
    compiler.args([format!("{program}.c"), "flexsc_lockstep.c".to_owned()].map(|name| sources.join(name)));
    compiler.arg(flight.join(format!("{prefix}.c")));
    let Ok(done) = compiler.output() else {
        eprintln!("skipped: there is no `cc` on this machine, so exported code does not fly");
        return None;
    };
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    Some(made)
}

/// Runs a program against a server over a link with faults, and returns what it printed.
fn fly(program: &Path, server: &str, faults: Faults, more: &[&str]) -> String {
    let link = FaultyLink::new(server, faults, 5);
    let (host, port) = link.address.split_once(':').expect("a port");
    let arguments = [&[host, port, "udp"], more].concat();
    let ran = Program::new(program).args(arguments).stdout(Stdio::piped()).output().expect("it starts");
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stdout));
    assert_eq!(link.faults.load(Ordering::Relaxed) > 20, faults.lost > 0.0);
    String::from_utf8(ran.stdout).expect("UTF-8")
}

#[test]
fn exported_code_gives_the_rows_of_simulate() {
    let dir = Dir::with(&["earth-observer"]);
    let Some(program) = flight_program(&dir, "earth-observer.toml", "aocs", "earth_observer", &[]) else {
        return;
    };
    let said = rows_are_equal(&dir, "earth-observer.toml --set duration=99.9", "0.05", &program, 0.01);
    assert_eq!(said, "1998 cycles, complete\n");
}

/// Flies a scenario by a program, with faults of the link, compares the rows of the log with those of a run in one process, and returns
/// what the program printed. At an instant of the law at the very end, no command would act any more.
fn rows_are_equal(dir: &Dir, scenario: &str, period: &str, program: &Path, lost: f64) -> String {
    dir.run(&format!("simulate {scenario} --log full -o own.mcap"));
    let (server, _, address) = serve(dir, &format!("{scenario} --log full --period {period} -o served.mcap"));
    let said = fly(
        program,
        &address,
        Faults { lost, repeated: lost, damaged: lost, late: lost, foreign: lost },
        &[],
    );
    // A requirement may be missed in the short run.
    server.wait().says(&["lockstep"]);
    let (own, served) = (rows(dir, "own.mcap"), rows(dir, "served.mcap"));
    assert_eq!(own.len(), served.len());
    let different: Vec<_> = own.iter().zip(&served).filter(|(own, served)| own != served).collect();
    let topics: Vec<_> = different.iter().map(|(own, _)| (&own.0, own.1)).take(4).collect();
    assert!(different.is_empty(), "{scenario}: {} of {} rows: {topics:?}", different.len(), own.len());
    said
}

/// CubeSats with modes or stages: the scenario, keys that shorten it, modes with a star tracker, and the modes that follow the first.
const CUBESATS: [(&str, &str, &str, &[&str]); 3] = [
    (
        "cubesat-day",
        "--set duration=1499.9",
        "-DTRACKER_MODES=0x1f",
        &["mode 1", "mode 2", "mode 3", "mode 2"],
    ),
    ("safe-mode", "--set duration=6599.9", "-DTRACKER_MODES=0x6", &["mode 1", "mode 2", "mode 1"]),
    (
        "detumble-and-point",
        "--set duration=1499.9 --set law.stages[1].from=700 --set estimator.attitude.assess=[60,1400]",
        "-DTRACKER_MODES=0",
        &["mode 1"],
    ),
];

/// Changes of the CubeSat's day that shorten its modes.
const MODES_SOON: [(&str, &str); 4] = [
    ("rate = [0.028, -0.03, 0.022]", "rate = [0.002, -0.001, 0.001]"),
    ("run_time > 17600", "run_time > 900"),
    ("\"time > 600\"", "\"time > 200\""),
    ("log.period = 20.0", "log.period = 1.0"),
];

#[test]
fn exported_modes_give_the_rows_of_simulate() {
    for (scenario, keys, tracker, changes) in CUBESATS {
        let dir = Dir::with(&[scenario]);
        if scenario == "cubesat-day" {
            dir.write("cubesat-day.toml", changed(&dir.text("cubesat-day.toml"), &MODES_SOON));
        }
        let shortened = format!("{scenario}.toml {keys}");
        let Some(program) = flight_program(&dir, &shortened, "sat", "cubesat", &[tracker]) else { return };
        let said = rows_are_equal(&dir, &shortened, "0.5", &program, 0.004);
        let modes: Vec<_> =
            said.lines().filter_map(|line| line.split_once(" at ")).map(|(mode, _)| mode).collect();
        assert_eq!(modes, changes, "{scenario}: {said}");
    }
}

/// Returns the text of a scenario with changes, each of which is in it.
fn changed(text: &str, changes: &[(&str, &str)]) -> String {
    changes.iter().fold(text.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    })
}

/// False readings of the CubeSat's sensors: numbers that are none, zeros and spikes, around a time (s).
fn with_false_readings(text: &str, at: f64) -> String {
    let [a, b, c] = [at, at + 40.0, at + 80.0];
    let during = |from: f64| format!("{{ from = {from:?}, to = {:?} }}", from + 3.0);
    let spike = |from: f64, what: &str| {
        format!("{{ outlier = {{ from = {from:?}, to = {:?}, {what} }} }}", from + 3.0)
    };
    let tracker = format!("{{ invalid = {} }}, {}, ", during(a), spike(b, "angle = 2.0"));
    let gyro = format!("{{ invalid = {} }}, {}", during(c), spike(c + 40.0, "rate = 0.3"));
    let magnetometer = format!("{{ invalid = {} }}, {{ zero = {} }}", during(a), during(b));
    let mut changed = text.to_owned();
    for (from, to) in [
        ("faults = [{ silent", format!("faults = [{tracker}{{ silent")),
        ("range = 0.5 }", format!("range = 0.5, faults = [{gyro}] }}")),
        ("noise = 1e-7 }", format!("noise = 1e-7, faults = [{magnetometer}] }}")),
    ] {
        assert!(changed.contains(from), "{from}");
        changed = changed.replacen(from, &to, 1);
    }
    changed
}

/// Flies the CubeSat by its exported code, with lost packets, false readings, and a computer that fails at a time (s); returns what the
/// flight software printed.
fn fly_cubesat(changes: &[(&str, &str)], false_at: f64, failure: &str) -> String {
    let dir = Dir::with(&["cubesat-day"]);
    let text = changed(&dir.text("cubesat-day.toml"), changes);
    dir.write("cubesat-day.toml", with_false_readings(&text, false_at));
    let Some(program) = flight_program(&dir, "cubesat-day.toml", "sat", "cubesat", &[]) else {
        return String::new();
    };
    let (server, _, address) = serve(&dir, "cubesat-day.toml --period 0.5 --log none --timeout 60");
    let faults = Faults { lost: 0.002, repeated: 0.002, damaged: 0.002, late: 0.002, foreign: 0.002 };
    let said = fly(&program, &address, faults, &[failure]);
    // A requirement that is missed has the code 3.
    server.wait().exits(0).says(&["requirement"]);
    said
}

#[test]
fn a_cubesat_meets_its_requirements_with_losses_false_readings_and_a_restart() {
    let shortened: Vec<_> = SHORT.into_iter().filter(|(from, _)| !from.starts_with("log")).collect();
    let said = fly_cubesat(&shortened, 1280.0, "4200");
    assert!(said.is_empty() || said.ends_with("14400 cycles, complete\n"), "{said}");
    // The supervisor that was restored counts from the start of the run, and knows that `pass` was not entered yet.
    assert!(said.is_empty() || said.matches("mode 3 at 4800 s").count() == 1, "{said}");
}
