//! Limits of requests, checked before any work: sizes of runs, campaigns, grids and files.

use std::process::Command;

use crate::structure::RELAY;
use crate::util::{Dir, Ran, UNCERTAIN};

/// A sampled loop with a wheel; the line of a key is replaced by the tests.
const LOOP: &str = "duration = 2000.0

[body.planar]
angle = 0.1
inertia = 100.0
modes = [{ frequency = 0.3, gain = 1.44 }]

[sensor.sampled]
period = 0.3

[law.pd]
k_p = 0.02
k_d = 0.4
period = 0.3

[actuator.wheel]
gain = 1.0
delay = 0.0

[log]
period = 0.1
";

#[track_caller]
fn refused(ran: Ran, words: &[&str]) {
    let ran = ran.exits(2).says(words);
    assert!(ran.err.starts_with("error: ") && !ran.err.contains("panicked"), "{}", ran.err);
    assert!(ran.err.len() < 2000 && ran.out.is_empty());
}

/// A key that requires more steps or more memory than any machine has.
#[test]
fn no_key_asks_for_what_cannot_be_done() {
    let thrusters = "[actuator.thrusters]\ntorque = 1.0\nperiod = 1e-11";
    let noise = "[[disturbance]]\nnoise = 1e-6\nperiod = 1e-11\nfrom = 100\nto = 300\n";
    let wheel = "[actuator.wheel]\ngain = 1.0\ndelay = 0.0";
    let many = |modes: usize| {
        let mode = |n: usize| format!("{{ frequency = {}, gain = 0.01 }}", 0.1 + 0.01 * n as f64);
        format!("modes = [{}]", (0..modes).map(mode).collect::<Vec<_>>().join(", "))
    };
    let modes = "modes = [{ frequency = 0.3, gain = 1.44 }]";
    let (hundreds, thousands) = (many(300), many(3000));
    let cases: [(&str, &str, &[&str]); 15] = [
        (
            "k_d = 0.4\nperiod = 0.3",
            "k_d = 0.4\nperiod = 1e-12",
            &["`law.pd.period` makes 2.0e15 steps in the run's 2000 s", "at most 1.0e12 are allowed"],
        ),
        (
            "[sensor.sampled]\nperiod = 0.3",
            "[sensor.sampled]\nperiod = 1e-12",
            &["`sensor.sampled.period` makes 2.0e15 steps"],
        ),
        ("[log]\nperiod = 0.1", "[log]\nperiod = 1e-12", &["`log.period` makes 1.0e16 steps"]),
        ("[log]\nperiod = 0.1", "[log.scene]\nperiod = 1e-12", &["`log.scene.period` makes 2.0e15 steps"]),
        ("[log]\nperiod = 0.1", noise, &["`disturbance[0].period` makes 2.0e13 steps"]),
        (wheel, thrusters, &["`actuator.thrusters.period` makes 2.0e14 steps"]),
        (wheel, "[actuator.hold]\nperiod = 1e-10", &["`actuator.hold.period` makes 2.0e13 steps"]),
        ("delay = 0.0", "delay = 1e21", &["`actuator.wheel.delay`", "must be a time of 0 to 1e13 s"]),
        ("delay = 0.0", "delay = 1.8e308", &["`actuator.wheel.delay`", "too large for a double"]),
        (
            "k_d = 0.4\nperiod = 0.3",
            "k_d = 0.4\nperiod = 1e21",
            &["`law.pd.period`", "must be a time of 1e-15 s to 1e13 s"],
        ),
        (
            "k_d = 0.4\nperiod = 0.3\n\n[actuator.wheel]\ngain = 1.0\ndelay = 0.0",
            "k_d = 0.4\nperiod = 1e-6\n[actuator.wheel]\ngain = 1.0\ndelay = 1e5",
            &["`actuator.wheel.delay` keeps 2.0e9 commands waiting", "at most 1.0e6 are supported"],
        ),
        (modes, &hundreds, &["`body.planar` gives 300 modes", "at most 200 that a wheel or a drift couples"]),
        (modes, &thousands, &["`body.planar` gives 3000 modes", "at most 2000 of a body"]),
        (
            "[log]\nperiod = 0.1",
            "[[disturbance]]\ntorque = 1.0\nfrom = 1e300\n",
            &["`disturbance[0].from`", "must be a time of 0 to 1e13 s"],
        ),
        (
            "[sensor.sampled]\nperiod = 0.3",
            "[sensor.sampled]\nperiod = 0.3\nfaults = [{ silent = { from = 1e19 } }]",
            &["from", "must be a time of 0 to 1e13 s"],
        ),
    ];
    for (line, other, words) in cases {
        assert!(LOOP.contains(line), "{line}");
        let dir = Dir::holding("a.toml", LOOP.replace(line, other));
        for command in ["check a.toml", "simulate a.toml -o out --yes", "tune a.toml --yes"] {
            refused(dir.run_bounded(command), words);
        }
        assert!(!dir.has("out"));
    }
}

/// Periods and delays beyond a run's duration do not count: no event follows its end.
#[test]
fn times_beyond_the_end_are_harmless() {
    for (line, other) in [
        ("k_d = 0.4\nperiod = 0.3", "k_d = 0.4\nperiod = 1.45e7"),
        ("k_d = 0.4\nperiod = 0.3", "k_d = 0.4\nperiod = 1e13"),
        ("delay = 0.0", "delay = 1.45e7"),
        ("delay = 0.0", "delay = 1e13"),
        ("[sensor.sampled]\nperiod = 0.3", "[sensor.sampled]\nperiod = 1e13"),
        ("[log]\nperiod = 0.1", "[log]\nperiod = 1e13"),
    ] {
        let dir = Dir::holding("a.toml", LOOP.replace(line, other));
        dir.run_bounded("simulate a.toml --log full").exits(0);
        dir.run_bounded("plot a.mcap --format svg").exits(0);
        let analysed = dir.run_bounded("tune a.toml --json");
        if line.starts_with("delay") {
            refused(analysed, &["actuator.wheel.delay", "periods of the law", "waits for at most 200"]);
        } else {
            assert!(analysed.code == Some(0) || analysed.code == Some(2), "{other}: {}", analysed.err);
        }
    }
}

/// Long work prints its duration, and is done with a yes.
#[test]
fn long_work_needs_a_yes() {
    let dir = Dir::holding(
        "a.toml",
        LOOP.replace("[sensor.sampled]\nperiod = 0.3", "[sensor.sampled]\nperiod = 1e-8"),
    );
    let words = [
        "`sensor.sampled.period` makes 2.0e11 steps: about",
        "on one core",
        "must be confirmed",
        "hint: `--yes` runs it anyway",
    ];
    refused(dir.run_bounded("simulate a.toml --log none"), &words);
    let reported = dir.run_bounded("check a.toml").exits(0).says(&["accepted", words[0]]);
    assert!(!reported.err.contains("hint"));
    assert_eq!(dir.run_bounded("check a.toml --json").exits(0).json()["needs_yes"], true);
    let running = dir.start("simulate a.toml --log none --yes");
    std::thread::sleep(std::time::Duration::from_millis(500));
    // The run had begun, and was not refused.
    assert_eq!(running.signal("KILL").code, None);

    dir.write("b.toml", LOOP.replace("[log]\nperiod = 0.1", "[log]\nperiod = 1e-7"));
    refused(
        dir.run_bounded("simulate b.toml --log full"),
        &["`log.period` makes 1.0e11 steps", "TB for logs"],
    );
    // Each exposure costs several evaluations.
    dir.write(
        "d.toml",
        "duration = 1e5
[body.spatial]
inertia = [[5.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 2.0]]
points = [{ name = \"hub\" }]
[sensor.star_tracker]
period = 1e-6
latency = 1e-6
exposure = 1e-6
[law.attitude]
period = 1.0
bandwidth = 0.06
",
    );
    refused(
        dir.run_bounded("simulate d.toml --log none"),
        &["`sensor.star_tracker.exposure` makes 6.0e11 steps", "must be confirmed"],
    );
    dir.write("c.toml", UNCERTAIN);
    refused(
        dir.run_bounded("simulate c.toml --runs 100000000 --table csv -o out"),
        &["in each of 1.0e8 runs", "200 GB of memory"],
    );
    assert!(!dir.has("out"));
}

/// Campaigns and grids.
#[test]
fn campaigns_and_grids_have_bounds() {
    let dir = Dir::holding("a.toml", LOOP);
    dir.write("b.toml", UNCERTAIN);
    for runs in ["18446744073709551615", "0:18446744073709551615", "1000000000000", "5:100000006"] {
        let ran = dir.run_bounded(&format!("simulate b.toml --yes --runs {runs}")).exits(2);
        assert!(ran.err.contains("a campaign has at most 100000000 runs"), "{}", ran.err);
    }
    // The last numbers of the range.
    let ran =
        dir.run_bounded("simulate b.toml --json --runs 18446744073709551612:18446744073709551615").exits(0);
    // The last line is the answer.
    assert_eq!(ran.out.lines().count(), 4);
    let vary = "--vary law.relay.k_t=0.3:0.4:10000000 --vary duration=1:2:10000000 --vary seed=1:2:10000000";
    refused(dir.run_bounded(&format!("sweep b.toml --yes {vary}")), &["at most 10000000 combinations"]);
    let vary = "--vary law.relay.k_t=0.3:0.4:10000000000";
    refused(
        dir.run_bounded(&format!("sweep b.toml --yes {vary}")),
        &["at most 10000000 values, got 10000000000"],
    );
    refused(
        dir.run_bounded("sweep b.toml --vary duration=1:1e10:10000"),
        &["in each of 10000 runs", "must be confirmed"],
    );

    let grid = "--frequency 0.1:1:100000";
    refused(
        dir.run_bounded(&format!("map a.toml {grid} --period 0.1:1:100000")),
        &["the grid makes 1.0e10 steps", "must be confirmed"],
    );
    refused(
        dir.run_bounded("map a.toml --yes --frequency 0.1:1:3 --period 1e-15:1:3"),
        &["--horizon must be at most 1e7 samples"],
    );
    refused(
        dir.run_bounded(&format!("tune a.toml {grid} --gain 0:1:50001")),
        &["the grid makes 5.0e9 steps"],
    );
    refused(
        dir.run_bounded("tune a.toml --yes --robust 0.1 --delay 1e9"),
        &["--delay must leave at most 200 periods"],
    );
    refused(
        dir.run_bounded("identify --runs 1000000 --cycles 1000000"),
        &["the identification makes 4.0e12 steps"],
    );
}

/// A scenario with a structure's mass in a file.
fn structure(file: &str) -> String {
    format!("{RELAY}\n[body.matrices]\nmass = \"{file}\"\nstiffness = [[0, 0], [0, 5]]\n")
}

/// Files that never end, or are larger than any structure.
#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn files_of_structures_have_bounds() {
    let dir = Dir::new();
    let made = |program: &str, arguments: &[&str]| {
        let status = Command::new(program).args(arguments).current_dir(dir.path("")).status();
        assert!(status.expect("it starts").success());
    };
    for kind in ["mtx", "csv", "npz"] {
        let (pipe, link, sparse) = (format!("pipe.{kind}"), format!("zero.{kind}"), format!("sparse.{kind}"));
        made("mkfifo", &[&pipe]);
        made("ln", &["-s", "/dev/zero", &link]);
        made("truncate", &["-s", "1T", &sparse]);
        for (file, why) in [
            (pipe, "not a file"),
            (link, "not a file"),
            (sparse, "must have at most 268435456 bytes, got 1099511627776"),
        ] {
            dir.write("a.toml", structure(&file));
            refused(dir.run_bounded("check a.toml"), &["`body.matrices.mass` cannot be used", why]);
        }
    }
    let lies = [
        (
            "a.mtx",
            "%%MatrixMarket matrix coordinate real general\n2 2 18446744073709551615\n1 1 1\n",
            "must have 18446744073709551615 elements, got 1",
        ),
        (
            "a.mtx",
            "%%MatrixMarket matrix array real general\n4000000000 4000000000\n",
            "must have at most 2000 rows",
        ),
    ];
    for (name, text, why) in lies {
        dir.write(name, text);
        dir.write("a.toml", structure(name));
        refused(dir.run_bounded("check a.toml"), &[why]);
    }
    dir.write("wide.csv", "1,".repeat(3_000_000));
    dir.write("a.toml", structure("wide.csv"));
    refused(dir.run_bounded("check a.toml"), &["line 1: must have at most 2000 columns, got 3000001"]);
}

/// An array of NumPy with this header.
fn npy(header: &str, data: &[u8]) -> Vec<u8> {
    [b"\x93NUMPY\x01\x00", &(header.len() as u16).to_le_bytes()[..], header.as_bytes(), data].concat()
}

fn array(kind: &str, shape: &str, data: &[u8]) -> Vec<u8> {
    npy(&format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}\n"), data)
}

/// An archive of files that are stored as they are.
fn zip(files: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let (mut bytes, mut directory) = (Vec::new(), Vec::new());
    for (name, data) in files {
        let (length, offset) = ((data.len() as u32).to_le_bytes(), (bytes.len() as u32).to_le_bytes());
        let about =
            [&[0; 8][..], &crc32(data).to_le_bytes(), &length, &length, &(name.len() as u32).to_le_bytes()]
                .concat();
        bytes.extend([b"PK\x03\x04\x14\x00", &about[..], name.as_bytes(), data].concat());
        directory
            .extend([b"PK\x01\x02\x14\x00\x14\x00", &about[..], &[0; 10], &offset, name.as_bytes()].concat());
    }
    let count = (files.len() as u16).to_le_bytes();
    let (length, offset) = ((directory.len() as u32).to_le_bytes(), (bytes.len() as u32).to_le_bytes());
    [&bytes[..], &directory, b"PK\x05\x06\0\0\0\0", &count, &count, &length, &offset, &[0; 2]].concat()
}

fn crc32(bytes: &[u8]) -> u32 {
    let step = |crc: u32, _| crc >> 1 ^ (0xedb8_8320 & (crc & 1).wrapping_neg());
    !bytes.iter().fold(!0, |crc, byte| (0..8).fold(crc ^ u32::from(*byte), step))
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn archives_have_bounds() {
    let doubles = |values: &[f64]| values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<_>>();
    let counts = |values: &[i64]| values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<_>>();
    let mass = array("<f8", "(2, 2)", &doubles(&[10.0, 1.0, 1.0, 2.0]));
    let dir = Dir::holding("a.npz", zip(&[("m.npy", mass)]));
    dir.write("a.toml", structure("a.npz"));
    dir.run_bounded("check a.toml").exits(0);

    let nested = npy(&format!("{}{}", "[".repeat(40), "]".repeat(40)), &[]);
    let hidden = npy(&"(')',".repeat(40), &[]);
    let long = [b"\x93NUMPY\x02\x00\xff\xff\xff\xff".as_slice(), b"{"].concat();
    let sparse = |format: Vec<u8>, indptr: &[i64]| {
        zip(&[
            ("format.npy", format),
            ("shape.npy", array("<i8", "(2,)", &counts(&[2, 2]))),
            ("data.npy", array("<f8", "(4,)", &doubles(&[10.0, 1.0, 1.0, 2.0]))),
            ("indices.npy", array("<i8", "(4,)", &counts(&[0, 1, 0, 1]))),
            ("indptr.npy", array("<i8", &format!("({},)", indptr.len()), &counts(indptr))),
        ])
    };
    let csr = || array("|S3", "()", b"csr");
    dir.write("a.npz", sparse(csr(), &[0, 2, 4]));
    dir.run_bounded("check a.toml").exits(0);

    let again: Vec<i64> = (0..1_000_000).map(|place| 4 * (place % 2)).collect();
    let cases = [
        (zip(&[("m.npy", nested)]), "array `m`: its header must have at most 8 brackets"),
        (zip(&[("m.npy", hidden)]), "array `m`: its header must have at most 8 brackets"),
        (zip(&[("m.npy", long)]), "array `m`: its header must have at most 1024 bytes, got 4294967295"),
        (
            zip(&[("m.npy", array("<f8", "(4000000000, 4000000000)", &[]))]),
            "array `m` must have at most 2000 rows",
        ),
        (sparse(array("|S4000000000", "()", b"csr"), &[0, 2, 4]), "array `format` must be one short text"),
        (sparse(array("|S3", "(4000000000,)", b"csr"), &[0, 2, 4]), "array `format` must be one short text"),
        (sparse(csr(), &again), "array `indptr` must hold 3 increasing indices"),
        (sparse(csr(), &[4, 0, 4]), "array `indptr` must hold 3 increasing indices"),
    ];
    for (archive, why) in cases {
        dir.write("a.npz", archive);
        refused(dir.run_bounded("check a.toml"), &[why]);
    }
}

/// Estimates (s) follow from the values of keys: measured times are within a factor of two of the middle.
#[test]
fn estimates_follow_the_keys() {
    let cases = [
        ("relay-fixed", "hysteresis = 1e-4", "hysteresis = 1e-15", [50.0, 220.0]),
        ("relay-fixed", "duration = 20000.0", "duration = 1e6", [0.02, 0.09]),
        ("relay-fixed", "strong = 4e-5", "strong = 10.0", [1.0, 6.5]),
        ("relay-one-sided", "duration = 20000.0", "duration = 1e6", [0.1, 0.4]),
        ("detumble-and-point", "rate = [0.035, -0.03, 0.025]", "rate = [100, 0, 0]", [50.0, 230.0]),
        ("wheel-unstable-band", "duration = 1500.0", "duration = 145000.0", [0.3, 1.2]),
        ("four-clamped-modes-faults", "duration = 300.0", "duration = 3000.0", [0.12, 0.5]),
    ];
    for (name, line, other, [low, high]) in cases {
        let dir = Dir::with(&[name]);
        let shipped = dir.text(&format!("{name}.toml"));
        assert!(shipped.contains(line), "{line}");
        dir.write("a.toml", shipped.replace(line, other));
        let estimate = dir.run("check a.toml --json").exits(0).json()["estimate_s"].as_f64().expect("a time");
        assert!((low..=high).contains(&estimate), "{name}, {other}: {estimate}");
    }
}

/// Shipped scenarios, and ordinary large studies, need no yes.
#[test]
fn ordinary_work_needs_no_yes() {
    let dir = Dir::new();
    let scenarios =
        std::fs::read_dir(crate::util::SCENARIOS).expect("shipped").flatten().map(|file| file.path());
    for path in scenarios.filter(|path| path.extension().is_some_and(|kind| kind == "toml")) {
        let reported = dir.run(&format!("check {} --json", path.display())).exits(0).json();
        assert_eq!(reported["needs_yes"], false, "{}", path.display());
    }
}
