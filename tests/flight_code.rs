//! Exported control systems: the same bits as the engine's in every home that the machine has, and what is refused.

use std::process::Output;

use flexsc_core::Scenario;
use flexsc_export_c::control_system::ControlSystem;
use flexsc_export_c::{self_test, vectors};
use flexsc_flight::ticks::Ticks;

use crate::flight_exports::{EXPORTED, document, exported, hashes, is_installed, make, scenario_of, text};
use crate::flight_rust::cargo_test;
use crate::frozen::is_frozen;
use crate::util::Dir;

/// Cycles of the self-test on the host and on emulated processors. The last of 16 blocks of 256 is extreme.
const HOST_CYCLES: u64 = 20_000;
const EMULATED_CYCLES: u64 = 4096;

/// Returns a shipped scenario.
fn shipped(name: &str) -> Scenario {
    let path = format!("{}/../../scenarios/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    Scenario::load(path.as_ref()).expect("a shipped scenario")
}

#[test]
fn the_plain_laws_give_the_commands_of_every_exportable_scenario() {
    let directory = format!("{}/../../scenarios", env!("CARGO_MANIFEST_DIR"));
    let (mut exported, mut refused) = (Vec::new(), Vec::new());
    let mut names: Vec<String> = std::fs::read_dir(directory)
        .expect("the scenarios")
        .filter_map(|entry| Some(entry.ok()?.file_name().to_str()?.strip_suffix(".toml")?.to_owned()))
        .collect();
    names.sort();
    for name in names {
        let scenario = shipped(&name);
        match ControlSystem::new(&scenario) {
            Ok(_) => match vectors::record(&scenario, 1000) {
                Ok(calls) => exported.push(format!("{name}: {} calls", calls.len())),
                Err(error) => panic!("{name}: {error}"),
            },
            Err(error) => refused.push(format!("{name}: {error}")),
        }
    }
    is_frozen("flight_code", &format!("{}\n\nrefused\n{}", exported.join("\n"), refused.join("\n")));
}

/// Time by which the calls of a run are moved.
const LATER: Ticks = Ticks { whole: 5000, part: 0 };

#[test]
fn a_start_at_any_time_gives_the_rows_of_a_start_at_zero() {
    for name in ["earth-observer", "site-pass", "half-turn", "relay-sampled", "attitude-hold"] {
        let scenario = shipped(name);
        let mut system = ControlSystem::new(&scenario).expect("an exportable scenario");
        system.start_at(LATER);
        let layouts = system.calls();
        for (number, call) in vectors::record(&scenario, 3000).expect("a run").iter().enumerate() {
            let found = system.call(call.call, call.now.plus(LATER), &call.inputs);
            let channels = layouts[call.call].outputs.iter();
            let each = channels.flat_map(|channel| std::iter::repeat_n(channel.name.as_str(), channel.count));
            for ((channel, found), early) in each.zip(found).zip(&call.outputs) {
                let is_time = matches!(channel, "next_whole" | "until_whole") && found >= 5000;
                let expected = if is_time { early + 5000 } else { *early };
                assert_eq!(found, expected, "{name}: {channel} of call {number}");
            }
        }
    }
}

#[test]
fn exported_laws_have_equal_bits_in_every_home() {
    if !is_installed("make") {
        return;
    }
    for (index, name) in EXPORTED.into_iter().enumerate() {
        let dir = exported(name);
        let system = ControlSystem::new(&scenario_of(name)).expect("an exportable scenario");
        let [host, emulated] = self_test::self_tests(&system, [HOST_CYCLES, EMULATED_CYCLES]);
        let (known, emulated) = (hashes(&dir, "out"), format!("{emulated:016x}"));
        assert_eq!(known[&HOST_CYCLES], format!("{host:016x}"), "{name}");
        // Emulated, every second system is compiled without optimisation.
        let level = if index % 2 == 0 { "-O0" } else { "-O3" };
        let homes = [
            (&["check-gcc", "check-v3", "check-clang"][..], "-O0 -O3", HOST_CYCLES, &known[&HOST_CYCLES]),
            (
                &["check-aarch64", "check-riscv64", "check-powerpc", "check-sparc64"],
                level,
                EMULATED_CYCLES,
                &emulated,
            ),
        ];
        let makefile = dir.text("out/Makefile");
        let all = homes
            .iter()
            .flat_map(|(targets, ..)| *targets)
            .fold(String::new(), |all, target| all + " " + target);
        // Tests of the instructions, of the page and of modes check the boards.
        assert!(makefile.contains(&format!("\ncheck-all:{all} check-m4 check-m7\n")), "{all}");
        for (targets, levels, cycles, hash) in homes {
            let own = [format!("LEVELS={levels}"), format!("CYCLES={cycles}"), format!("HASH={hash}")];
            let variables = own.iter().map(String::as_str);
            let output = make(&dir, "out", &targets.iter().copied().chain(variables).collect::<Vec<_>>());
            let said = text(&output);
            assert!(output.status.success(), "{name}: {said}");
            said.lines().filter(|line| line.contains("skipped")).for_each(|line| eprintln!("{name}: {line}"));
            if targets.contains(&"check-gcc") && is_installed("gcc") {
                assert!(
                    said.contains("gcc -O0: 20000 cycles") && said.contains("gcc -O3: 20000 cycles"),
                    "{said}"
                );
            }
        }
    }
}

/// As its user runs it: all calls of the run, and a million cycles.
#[test]
fn an_export_is_checked_at_full_length() {
    if !is_installed("make") || !is_installed("gcc") {
        return;
    }
    let dir = Dir::with(&["relay-sampled"]);
    dir.run("export-c relay-sampled.toml -o out").exits(0);
    let said = text(&make(&dir, "out", &["check"]));
    assert_eq!(said.matches(" calls equal").count(), 2, "{said}");
    assert_eq!(said.matches(": 1000000 cycles, hash ").count(), 2, "{said}");
}

/// A self-test that never differs would prove nothing.
#[test]
fn contraction_and_fast_mathematics_are_found() {
    if !is_installed("make") || !is_installed("gcc") {
        return;
    }
    let dir = exported("earth-observer");
    let has_fma = std::fs::read_to_string("/proc/cpuinfo").is_ok_and(|text| text.contains(" fma "));
    if has_fma {
        let hash = format!("HASH={}", hashes(&dir, "out")[&HOST_CYCLES]);
        let output = make(&dir, "out", &["check-contraction", &format!("CYCLES={HOST_CYCLES}"), &hash]);
        assert!(text(&output).contains("contraction: differs, as it must"), "{}", text(&output));
    } else {
        eprintln!("skipped: the processor has no fused multiply-add");
    }
    let output = make(&dir, "out", &["driver", "CFLAGS=-O2 -ffast-math"]);
    assert!(!output.status.success() && text(&output).contains("#error"), "{}", text(&output));
    // Flags for which clang defines no macro are switched off by pragmas. With the first it also links a start-up that flushes the
    // smallest numbers to zero, which the hash shows.
    let unseen = [
        ("-funsafe-math-optimizations", false),
        ("-freciprocal-math", true),
        ("-fassociative-math -fno-signed-zeros -fno-trapping-math", true),
    ];
    let hash = format!("HASH={}", hashes(&dir, "out")[&HOST_CYCLES]);
    let cycles = format!("CYCLES={HOST_CYCLES}");
    let has_clang = cfg!(target_arch = "x86_64") && is_installed("clang");
    for (flags, is_equal) in unseen.into_iter().filter(|_| has_clang) {
        let exact = format!("EXACT=-std=c99 -ffp-contract=off {flags}");
        let output = make(&dir, "out", &["check-clang", "LEVELS=-O3", &exact, &cycles, &hash]);
        assert_eq!(output.status.success(), is_equal, "{flags}: {}", text(&output));
    }
    // A changed gain differs from the vectors.
    let source =
        dir.text("out/earth_observer.c").replace("total_angle = axis", "total_angle = 1.0000001 * axis");
    dir.write("out/earth_observer.c", source);
    let output = make(&dir, "out", &["check"]);
    assert!(!output.status.success() && text(&output).contains("call "), "{}", text(&output));
}

/// Returns bytes of code and the largest stack with callees on each board, and bytes of the state, as `make size` prints them.
fn sizes(printed: &str) -> Vec<u64> {
    let (mut sizes, mut state) = (Vec::new(), 0);
    for board in printed.split("-mcpu=").skip(1) {
        let row = board.lines().find(|line| line.ends_with("-size.o")).expect("a row of sizes");
        let bytes: u64 =
            row.split_whitespace().next().and_then(|cell| cell.parse().ok()).expect("bytes of code");
        let number = |line: &str, before: &str| -> Option<u64> {
            line.split_once(before)?.1.strip_suffix(" bytes")?.parse().ok()
        };
        let stack = board.lines().filter_map(|line| number(line, ": stack of ")).max().expect("stacks");
        state = board.lines().find_map(|line| number(line, "state: ")).expect("the state");
        sizes.extend([bytes, stack]);
    }
    sizes.push(state);
    sizes
}

#[test]
fn sizes_are_those_of_the_document_but_for_a_tenth() {
    if !is_installed("make") || !is_installed("arm-none-eabi-gcc") {
        return;
    }
    let document = document();
    for name in EXPORTED {
        let dir = exported(name);
        let found = sizes(&text(&make(&dir, "out", &["size"])));
        let row = document.lines().find_map(|line| line.strip_prefix(&format!("| `{name}` | ")));
        let cells = row.expect("a row of the table").trim_end_matches(" |").split(" | ");
        let told: Vec<u64> = cells.map(|cell| cell.parse().expect("a number")).collect();
        assert_eq!(found.len(), told.len());
        for (found, told) in found.iter().zip(&told) {
            assert!(found * 10 <= told * 11 && told * 10 <= found * 11, "{name}: {found} and {told} bytes");
        }
    }
}

#[test]
fn the_self_test_reaches_limits_and_not_a_number() {
    for name in EXPORTED {
        let system = ControlSystem::new(&scenario_of(name)).expect("an exportable scenario");
        // One block of 16 is extreme: the hash of 15 blocks has no such input.
        let hashes = [100, 256 * 15, 256 * 16].map(|cycles| self_test::self_test(&system, cycles));
        assert!(hashes[0] != hashes[1] && hashes[1] != hashes[2], "{name}: {hashes:x?}");
        assert_eq!(hashes[0], self_test::self_test(&system, 100), "{name}");
    }
}

#[test]
fn scenarios_without_plain_laws_are_refused_at_their_key() {
    let dir = Dir::with(&["rotation-thrusters", "safe-mode", "relay-sampled"]);
    let mixed = "law.per_axis = { roll.attitude = { period = 1.0, bandwidth = 0.03 }, pitch.open = {}, yaw.open = {} }";
    let own = "law.attitude = { period = 1.0, bandwidth = 0.03, damping = 0.8, rate_limit = 3e-3 }";
    let modes =
        dir.text("safe-mode.toml").replace("law.b_dot = { period = 1.0, gain = 8e5 }", "law.open = {}");
    dir.write("mixed.toml", modes.replace(own, mixed));
    for (command, words) in [
        (
            "export-c rotation-thrusters.toml -o out",
            ["rotation-thrusters.toml", "`law.open`", "has no code for flight"],
        ),
        ("export-c mixed.toml -o out", ["mixed.toml:", "`mode[2].law", "(in the mode `safe`)"]),
        (
            "vectors rotation-thrusters.toml -o out.bin",
            ["rotation-thrusters.toml", "`law.open`", "`relay`, `pd`"],
        ),
        (
            "export-c relay-sampled.toml -o out --name 9",
            ["--name 9", "lower-case letters", "begin with a letter"],
        ),
        (
            "export-c relay-sampled.toml -o relay-sampled.toml",
            ["relay-sampled.toml", "must be a directory", "is a file"],
        ),
        ("vectors relay-sampled.toml -o out.txt", ["out.txt", "must end in", ".bin"]),
        ("export-c relay-sampled.toml -o out --calls 0", ["--calls", "0", "1..="]),
    ] {
        dir.run(command).exits(2).says(&words);
        assert!(!dir.has("out") && !dir.has("out.bin"), "{command}");
    }
}

#[test]
fn an_export_is_written_again_and_does_not_replace_other_files() {
    let dir = Dir::with(&["relay-sampled"]);
    dir.run("export-c relay-sampled.toml -o out").exits(0);
    let first = dir.read("out/relay_sampled.c");
    dir.run("export-c relay-sampled.toml -o out").exits(0);
    assert_eq!(dir.read("out/relay_sampled.c"), first);
    dir.write("out/relay_sampled.c", "changed");
    dir.run("export-c relay-sampled.toml -o out")
        .exits(2)
        .says(&["already exists, with other content", "--force"]);
    dir.run("export-c relay-sampled.toml -o out --force").exits(0);
    assert_eq!(dir.read("out/relay_sampled.c"), first);
    dir.run("vectors relay-sampled.toml -o all.bin --calls 20000").exits(0).says(&["calls"]);
    assert_eq!(dir.read("all.bin"), dir.read("out/vectors.bin"));
}

/// Files of 4 kB at most stand for a full disk.
#[cfg(unix)]
#[test]
fn an_export_on_a_full_disk_leaves_nothing() {
    let dir = Dir::with(&["relay-sampled"]);
    std::fs::create_dir(dir.path("mine")).expect("a directory");
    for out in ["new/out", "mine"] {
        let command = format!("export-c relay-sampled.toml -o {out}");
        dir.start_by("trap '' XFSZ; ulimit -f 8", &command).wait().exits(1).says(&["cannot write"]);
        assert!(!dir.path("new").exists());
        assert!(dir.names("mine").is_empty());
    }
}

/// Returns the text of a scenario with other lines from one header up to another.
fn replaced(name: &str, from: &str, to: &str, lines: &str) -> String {
    let dir = Dir::with(&[name]);
    let text = dir.text(&format!("{name}.toml"));
    let (before, rest) = text.split_once(from).expect("the first header");
    let (_, after) = rest.split_once(to).expect("the second header");
    format!("{before}{lines}\n{to}{after}")
}

/// Laws and filters in forms that no shipped scenario has: with and without states, of torques and accelerations, with wheels, modes
/// and jets.
#[test]
fn other_forms_of_laws_replay_their_run() {
    if !is_installed("make") || !is_installed("gcc") {
        return;
    }
    let slew = |law: &str| replaced("slew-wheel-lqg", "[law.pd]", "[actuator.wheel]", law);
    let about = |axis: &str| {
        format!(
            "[law.per_axis.{axis}.state_space]\nperiod = 0.2\ncommand = \"acceleration\"\na = [[0.5]]\nb = [[0.1, 0.2]]\n\
             c = [[0.01]]\nd = [[0.04, 0.28]]\n"
        )
    };
    let together = "[law.state_space]\nperiod = 0.25\nlimit = 0.3\noutputs = [\"pitch\", \"roll\", \"yaw\"]\n\
        inputs = [\"quaternion_x\", \"pitch\", \"quaternion_z\", \"roll_rate\", \"pitch_rate\", \"yaw_rate\", \"wheel1_speed\"]\n\
        d = [[0, 12.0, 0, 0, 80.0, 0, 1e-6], [20.0, 0, 0, 70.0, 0, 0, 0], [0, 0, 20.0, 0, 0, 60.0, 0]]\n";
    let jets = "[law.attitude]\nperiod = 0.2\nbandwidth = 0.5\ndamping = 0.8\n";
    let forms = [
        ("gain", slew("[law.state_space]\nperiod = 0.1\nd = [[90.0, 840.0]]\ntrack = true\n")),
        (
            "lag",
            slew(
                "[law.state_space]\nperiod = 0.1\na = [[0.9]]\nb = [[1.0]]\nc = [[3.0]]\nd = [[90.0]]\nlimit = 4.0\n",
            ),
        ),
        (
            "mode",
            slew("[law.pd]\nk_p = 90.0\nk_d = 840.0\nperiod = 0.1\ntrack = true\nextra = { gain = 0.2 }\n"),
        ),
        (
            "axes",
            replaced(
                "attitude-hold",
                "[law.per_axis.roll.pd]",
                "[actuator.wheel]",
                &["roll", "pitch", "yaw"].map(about).concat(),
            ),
        ),
        ("together", replaced("earth-observer-lqg", "[law.state_space]", "[[target]]", together)),
        ("jets", replaced("iss-ringdown-off", "[law.phase_plane]", "[actuator.jets]", jets)),
    ];
    let target = Dir::new();
    for (name, text) in forms {
        let dir = Dir::with(&[]);
        dir.write(&format!("{name}.toml"), text);
        dir.run(&format!("export-c {name}.toml -o out --calls 1500")).exits(0);
        let hash = format!("HASH={}", hashes(&dir, "out")[&1000]);
        let output = make(&dir, "out", &["check", "CYCLES=1000", &hash]);
        let replays = equal_replays(&output);
        assert_eq!(replays, 2, "{name}: {}", self::text(&output));
        std::fs::remove_dir_all(dir.path("out")).expect("a directory");
        dir.run(&format!("export-c {name}.toml -o out --calls 1500 --as rust")).exits(0);
        let output = cargo_test(&dir, &target.path("."));
        assert!(output.status.success(), "{name}: {}", self::text(&output));
    }
}

/// Returns how often the driver has found all calls equal: without and with optimisation.
fn equal_replays(output: &Output) -> usize {
    if output.status.success() { text(output).matches(" calls equal").count() } else { 0 }
}
