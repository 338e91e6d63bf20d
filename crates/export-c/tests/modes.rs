//! Exported control systems with modes of operation and stages: the supervisor and the laws of every mode, by bits.

use std::process::Command;

use flexsc_core::Scenario;
use flexsc_export_c::control_system::ControlSystem;
use flexsc_export_c::package::{self, ExportOrigin};
use flexsc_export_c::self_test;
use flexsc_export_c::vectors::{self, CallVector};
use tempfile::TempDir;

/// Returns the scenario `safe-mode` with laws by wheels in all modes, of different periods.
fn three_modes() -> String {
    let path = format!("{}/../../scenarios/safe-mode.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a shipped scenario");
    let law = "law.attitude = { period = 1.0, bandwidth = 0.02, damping = 0.9, rate_limit = 3e-3, integral = { time = 300.0, limit = 1.0 } }";
    text.replace("law.b_dot = { period = 1.0, gain = 8e5 }", law)
        .replace("actuators = [\"magnetorquers\"]", "actuators = [\"wheels\"]")
        .replace("duration = 9000.0", "duration = 1500.0")
        .replace("assess = [600.0, 9000.0]", "assess = [600.0, 1500.0]")
        .replace("from = 5800.0, to = 6400.0", "from = 600.0, to = 900.0")
}

/// A hold about one axis whose rate passes the limit of a condition several times within its time, an open loop, conditions with
/// `not`, `or` and brackets, and one on the truth.
const ONE_AXIS: &str = "duration = 120.0
[body.planar]
inertia = 10.0
rate = 0.02
[[mode]]
name = \"coast\"
law.open = {}
leave = [{ to = \"hold\", when = \"truth.run_time >= 2.345678901234\", for = 0.1 }]
[[mode]]
name = \"hold\"
law.pd = { period = 0.5, k_p = 1.0, k_d = 0.45 }
leave = [
    { to = \"Fine-hold\", when = \"not (rate > slow or rate_error >= 1) and attitude_error < 0.2\", numbers = { slow = 0.012 }, for = 5.0 },
    { to = \"coast\", when = \"time > 60 and entries(hold) > 3\" },
]
[[mode]]
name = \"Fine-hold\"
law.pd = { period = 0.2, k_p = 4.0, k_d = 12.0 }
leave = [{ to = \"hold\", when = \"time >= 10 and run_time < 90\" }]
[sensor.sampled]
period = 0.1
";

/// Stages of a law, the second with an integral.
const STAGES: &str = "duration = 60.0
[spacecraft]
mass = 50.0
inertia = [[20, 1, 0], [1, 30, 0], [0, 0, 25]]
rate = [0.01, -0.02, 0.005]
[[law.stages]]
law.attitude = { period = 0.5, bandwidth = 0.3 }
[[law.stages]]
from = 20.123456789
law.attitude = { period = 0.4, bandwidth = 0.5, integral = { time = 20.0, limit = 1.0 } }
[[law.stages]]
from = 40.0
law.pd = { period = 1.0, k_p = 2.0, k_d = 20.0 }
";

fn scenario(text: &str) -> Scenario {
    Scenario::parse("modes.toml", text).expect("a scenario")
}

/// Returns the modes after each test of conditions, as they follow each other.
fn modes(system: &ControlSystem, calls: &[CallVector]) -> Vec<u64> {
    let supervise = system.calls().iter().position(|call| call.name == "supervise").expect("a supervisor");
    let mut found: Vec<u64> =
        calls.iter().filter(|call| call.call == supervise).map(|call| call.outputs[0]).collect();
    found.dedup();
    found
}

#[test]
fn the_supervisor_enters_the_modes_of_the_run() {
    for (text, expected) in [
        (three_modes(), &[0, 1, 2, 1][..]),
        (ONE_AXIS.to_owned(), &[0, 1, 2, 1, 2]),
        (STAGES.to_owned(), &[1, 2]),
    ] {
        let scenario = scenario(&text);
        let system = ControlSystem::new(&scenario).expect("an exportable scenario");
        let calls = vectors::record(&scenario, 1_000_000).expect("equal commands and modes");
        let found = modes(&system, &calls);
        assert_eq!(found[..expected.len()], *expected, "{found:?}");
    }
}

#[test]
fn a_dwell_is_broken_and_resumed_in_the_vectors() {
    let scenario = scenario(ONE_AXIS);
    let system = ControlSystem::new(&scenario).expect("an exportable scenario");
    let calls = vectors::record(&scenario, 1_000_000).expect("vectors");
    let layout = system.calls();
    let supervise = layout.iter().position(|call| call.name == "supervise").expect("a supervisor");
    let number = |call: &CallVector, name: &str| {
        let inputs = layout[supervise].inputs.iter();
        let place: usize =
            inputs.take_while(|channel| channel.name != name).map(|channel| channel.count).sum();
        f64::from_bits(call.inputs[place])
    };
    // The spans for which the condition of the mode `hold` holds, up to the first change to `Fine-hold`.
    let (mut since, mut spans) = (None, Vec::new());
    for call in calls.iter().filter(|call| call.call == supervise) {
        let (now, mode) = (call.now.seconds(), call.outputs[0]);
        let [rate, angle] = ["rate", "angle"].map(|name| number(call, name));
        // Before it is in use, a reading is not known.
        let holds = rate.abs() <= 0.012 && angle.abs() < 0.2;
        since = if holds { since.or(Some(now)) } else { None };
        if mode == 2 {
            assert!(now - since.expect("a condition that holds") >= 5.0);
            break;
        }
        spans.extend(since.map(|since| now - since));
    }
    let breaks = spans.windows(2).filter(|pair| pair[1] < pair[0]).count();
    assert!(breaks >= 1 && spans.iter().all(|span| *span < 5.0), "{spans:?}");
}

/// True if a command is installed; else it says aloud what is skipped.
fn is_installed(command: &str) -> bool {
    let is_there = Command::new(command).arg("--version").output().is_ok_and(|out| out.status.success());
    if !is_there {
        eprintln!("skipped: {command} is not installed");
    }
    is_there
}

/// Replays the vectors of a scenario, and repeats the self-test, in every home: on this machine with and without optimisation, and
/// emulated at one level.
fn bits_are_equal(name: &str, text: &str, level: &str) {
    if !is_installed("make") || !is_installed("gcc") {
        return;
    }
    let scenario = scenario(text);
    let origin = ExportOrigin { file: "modes.toml", changes: &[] };
    let files = package::export(&scenario, origin, name, 20_000, &[]).expect("a package").files;
    let dir = TempDir::new().expect("a directory");
    for file in files {
        let path = dir.path().join(&file.path);
        std::fs::create_dir_all(path.parent().expect("a directory")).expect("a directory");
        std::fs::write(path, file.bytes).expect("a file");
    }
    let system = ControlSystem::new(&scenario).expect("an exportable scenario");
    // The last of 16 blocks of 256 cycles has extreme inputs.
    let [board, emulated, host] = self_test::self_tests(&system, [1000, 4096, 20_000]);
    for (targets, levels, cycles, hash) in [
        (&["check-gcc", "check-clang"][..], "-O0 -O3", 20_000, host),
        (&["check-aarch64", "check-riscv64"], level, 4096, emulated),
        (&["check-m4", "check-m7"], level, 4096, emulated),
    ] {
        if targets[0] == "check-m4" {
            // Boards are emulated a hundred times slower: they replay the beginning of the run.
            let calls = vectors::record(&scenario, 2000).expect("vectors");
            std::fs::write(dir.path().join("vectors.bin"), vectors::to_bytes(&calls)).expect("a file");
        }
        let output = Command::new("make")
            .arg("-C")
            .arg(dir.path())
            .args(targets)
            .args([format!("LEVELS={levels}"), format!("CYCLES={cycles}"), format!("HASH={hash:016x}")])
            .args(["BOARD_CYCLES=1000".to_owned(), format!("BOARD_HASH={board:016x}")])
            .output()
            .expect("make runs");
        let said =
            [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).concat();
        assert!(output.status.success(), "{name}: {said}");
        assert!(targets[0] != "check-gcc" || said.contains("gcc -O3: 20000 cycles"), "{said}");
        said.lines().filter(|line| line.contains("skipped")).for_each(|line| eprintln!("{name}: {line}"));
    }
}

// The longest of three tests side by side comes first.
#[test]
fn bits_are_equal_of_attitude_laws_in_modes() {
    bits_are_equal("three", &three_modes(), "-O3");
}

#[test]
fn bits_are_equal_of_laws_about_one_axis() {
    bits_are_equal("one_axis", ONE_AXIS, "-O0");
}

#[test]
fn bits_are_equal_of_stages() {
    bits_are_equal("stages", STAGES, "-O3");
}

#[test]
fn the_self_test_enters_every_mode() {
    for text in [three_modes(), ONE_AXIS.to_owned()] {
        let system = ControlSystem::new(&scenario(&text)).expect("an exportable scenario");
        let hashes = [100, 256 * 15, 256 * 16].map(|cycles| self_test::self_test(&system, cycles));
        assert!(hashes[0] != hashes[1] && hashes[1] != hashes[2], "{hashes:x?}");
    }
}

#[test]
fn a_mode_without_flight_code_is_refused_with_its_name_and_law() {
    let path = format!("{}/../../scenarios/site-pass.toml", env!("CARGO_MANIFEST_DIR"));
    let refused = |text: &str| ControlSystem::new(&scenario(text)).expect_err("a refusal").to_string();
    let text = std::fs::read_to_string(path).expect("a shipped scenario");
    let own = text.replace("law.state_space = { period = 0.25, d = [[0.04, 0.32]], command = \"acceleration\" }", "law.per_axis = { roll.pd = { period = 0.25, k_p = 1.0, k_d = 9.0 }, pitch.open = {}, yaw.open = {} }");
    for words in ["`mode[1].law.", "(in the mode `pass`)"] {
        assert!(refused(&own).contains(words), "{}", refused(&own));
    }
}
