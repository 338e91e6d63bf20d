//! Numbers at the boundaries of doubles: every figure of tables and logs of them, and every reader of them, ends with a result or
//! an error.

use std::collections::BTreeMap;
use std::io::Cursor;

use flexsc_core::Scenario;
use flexsc_core::campaign::CommandLog;
use roxmltree::Document;

use crate::util::{Dir, Ran, SCENARIOS, UNCERTAIN};

/// Values as they are written: zeros, the least and largest subnormal, the least normal, the largest numbers, and none.
const VALUES: [&str; 16] = [
    "0",
    "-0.0",
    "5e-324",
    "-5e-324",
    "1e-320",
    "2.225073858507201e-308",
    "2.2250738585072014e-308",
    "1e-300",
    "-1e-300",
    "1.0000000000000002",
    "1e300",
    "-1e300",
    "1.7976931348623157e308",
    "inf",
    "-inf",
    "nan",
];
/// Pairs of values between which numbers of tables and logs alternate: a range without a width, the narrowest and the widest.
const RANGES: [(f64, f64); 14] = [
    (0.0, 5e-324),
    (5e-324, 1e-323),
    (-5e-324, 5e-324),
    (0.0, 1e-320),
    (5e-324, 5e-324),
    (-0.0, 0.0),
    (0.0, 2.225_073_858_507_201_4e-308),
    (1.0, 1.000_000_000_000_000_2),
    (1e300, 1.000_000_000_000_000_2e300),
    (-1e300, 1e300),
    (-f64::MAX, f64::MAX),
    (5e-324, f64::MAX),
    (f64::NEG_INFINITY, f64::INFINITY),
    (f64::NAN, 1e-300),
];

/// Checks that a command ended with a result or an error.
#[track_caller]
fn ends(ran: &Ran, case: &str) {
    assert!(matches!(ran.code, Some(0..=2)), "{case}: {:?}\n{}", ran.code, ran.err);
    assert!(!ran.err.contains("panicked"), "{case}: {}", ran.err);
    assert!(ran.code == Some(0) || ran.err.contains("error"), "{case}: {}", ran.err);
}

/// Checks that the figures in a directory are well-formed, small, and have numbers as coordinates; returns how many there are.
fn check_figures(dir: &Dir, within: &str, case: &str) -> usize {
    let names = dir.names(within);
    for name in &names {
        let text = dir.text(&format!("{within}/{name}"));
        assert!(text.len() < 4_000_000, "{case}: {name} has {} bytes", text.len());
        let document = Document::parse(&text).unwrap_or_else(|error| panic!("{case}: {name}: {error}"));
        for node in document.descendants() {
            for attribute in
                node.attributes().filter(|of| ["points", "x", "y", "d", "cx", "cy"].contains(&of.name()))
            {
                let has = |word: &str| attribute.value().contains(word);
                assert!(!has("NaN") && !has("inf"), "{case}: {name}: {}", attribute.value());
            }
        }
    }
    names.len()
}

/// Returns a table whose numbers with a point or an exponent alternate between two values.
fn alternating(table: &str, (even, odd): (f64, f64)) -> String {
    let mut lines = table.lines().map(str::to_owned);
    let mut changed = lines.next().expect("a header") + "\n";
    for (row, line) in lines.enumerate() {
        let value = if row % 2 == 0 { even } else { odd };
        let cells = line.split(',').enumerate().map(|(place, cell)| {
            // Integers, such as the number of the run and its seed, stay.
            let is_real = cell.contains(['.', 'e']) && cell.parse::<f64>().is_ok();
            if place > 1 && is_real { format!("{value:e}") } else { cell.to_owned() }
        });
        changed += &(cells.collect::<Vec<_>>().join(",") + "\n");
    }
    changed
}

#[test]
#[cfg(target_os = "linux")]
fn figures_of_campaigns_and_sweeps_have_numbers() {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    let one_key = "--vary law.relay.k_t=0.30:0.32:6";
    let two_keys = "--vary law.relay.k_t=0.30:0.32:3 --vary body.planar.rate=1e-5:2e-5:3";
    for (name, command) in [
        ("campaign", "simulate u.toml --runs 8"),
        ("curve", &format!("sweep u.toml {one_key}")),
        ("region", &format!("sweep u.toml {two_keys}")),
    ] {
        dir.run(&format!("{command} --set duration=200 --table csv -o {name}")).exits(0);
        let table = dir.text(&format!("{name}/runs.csv"));
        let mut drawn = 0;
        for range in RANGES {
            dir.write(&format!("{name}/runs.csv"), alternating(&table, range));
            let case = format!("{name} {range:?}");
            let _ = std::fs::remove_dir_all(dir.path("figures"));
            ends(&dir.run_bounded(&format!("plot {name} --metric duty --format svg -o figures")), &case);
            drawn += check_figures(&dir, "figures", &case);
            ends(&dir.run_bounded(&format!("plot {name} --metric duty --json --worst 2")), &case);
        }
        assert!(drawn > 10, "{name}: {drawn} figures");
    }
}

/// Replaces the doubles of a message by a value, in messages within it too.
fn replace_doubles(data: &mut [u8], value: f64) -> Option<()> {
    let mut at = 0;
    let varint = |data: &[u8], at: &mut usize| {
        let mut number = 0_u64;
        for shift in (0..64).step_by(7) {
            let byte = *data.get(*at)?;
            *at += 1;
            number |= u64::from(byte & 0x7f) << shift;
            if byte & 0x80 == 0 {
                return Some(number);
            }
        }
        None
    };
    while at < data.len() {
        match varint(data, &mut at)? & 7 {
            0 => drop(varint(data, &mut at)?),
            1 => {
                data.get_mut(at..at + 8)?.copy_from_slice(&value.to_le_bytes());
                at += 8;
            }
            2 => {
                let length = usize::try_from(varint(data, &mut at)?).ok()?;
                let inner = data.get_mut(at..at + length)?;
                // A list of doubles, a message, or a text.
                let mut copy = inner.to_vec();
                let is_text = inner.iter().all(|byte| (0x20..0x7f).contains(byte));
                if !is_text && replace_doubles(&mut copy, value).is_some() {
                    inner.copy_from_slice(&copy);
                } else if !is_text && length % 8 == 0 {
                    inner.chunks_mut(8).for_each(|number| number.copy_from_slice(&value.to_le_bytes()));
                }
                at += length;
            }
            5 => at += 4,
            _ => return None,
        }
    }
    Some(())
}

/// Returns a log in whose messages the doubles alternate between two values.
fn alternating_log(log: &[u8], (even, odd): (f64, f64)) -> Vec<u8> {
    let options = mcap::WriteOptions::new().compression(None).library("flexsc");
    let mut writer = mcap::Writer::with_options(Cursor::new(Vec::new()), options).expect("a writer");
    let summary = mcap::Summary::read(log).expect("whole").expect("a summary");
    for index in &summary.attachment_indexes {
        writer.attach(&mcap::read::attachment(log, index).expect("whole")).expect("written");
    }
    for index in &summary.metadata_indexes {
        writer.write_metadata(&mcap::read::metadata(log, index).expect("whole")).expect("written");
    }
    let mut counts = BTreeMap::new();
    for message in mcap::MessageStream::new(log).expect("a log") {
        let mut message = message.expect("whole");
        let count = counts.entry(message.channel.topic.clone()).or_insert(0_u32);
        *count += 1;
        let mut data = message.data.to_vec();
        let value = if *count % 2 == 0 { even } else { odd };
        if replace_doubles(&mut data, value).is_some() {
            message.data = data.into();
        }
        writer.write(&message).expect("written");
    }
    writer.finish().expect("written");
    writer.into_inner().into_inner()
}

#[test]
#[cfg(target_os = "linux")]
fn figures_of_logs_have_numbers() {
    for (name, duration) in [("relay-adaptive", 400), ("earth-observer", 4), ("wheel-ekf", 20)] {
        let dir = Dir::with(&[name]);
        dir.run(&format!("simulate {name}.toml --set duration={duration} --log full -o whole.mcap")).exits(0);
        let whole = dir.read("whole.mcap");
        let mut drawn = 0;
        for range in RANGES {
            let case = format!("{name} {range:?}");
            dir.write("a.mcap", alternating_log(&whole, range));
            let _ = std::fs::remove_dir_all(dir.path("figures"));
            ends(&dir.run_bounded("plot a.mcap --format svg -o figures"), &case);
            ends(&dir.run_bounded("plot a.mcap --what /estimate,/pointing --format svg -o figures"), &case);
            drawn += check_figures(&dir, "figures", &case);
            ends(&dir.run_bounded("export a.mcap -o rows"), &case);
            ends(&dir.run_bounded("layout a.mcap -o layout.json"), &case);
            for file in ["a.glb", "a.bin"] {
                ends(
                    &dir.run_bounded(&format!("export a.mcap --epoch 2026-01-01T00:00:00Z -o {file}")),
                    &case,
                );
            }
        }
        assert!(drawn > RANGES.len(), "{name}: {drawn} figures");
    }
}

#[test]
#[cfg(target_os = "linux")]
fn figures_of_boundary_times_and_states_have_numbers() {
    let dir = Dir::with(&["wheel-fixed-gain"]);
    dir.run("simulate wheel-fixed-gain.toml --set duration=10 --log full -o whole.mcap").exits(0);
    for value in VALUES {
        let _ = std::fs::remove_dir_all(dir.path("figures"));
        for option in ["--to", "--from"] {
            ends(
                &dir.run_bounded(&format!("plot whole.mcap {option}={value} --format svg -o figures")),
                value,
            );
        }
        for key in ["body.planar.angle", "body.planar.rate"] {
            let ran = dir.run_bounded(&format!(
                "simulate wheel-fixed-gain.toml --set {key}={value} --set duration=4 --log full --force -o a.mcap"
            ));
            ends(&ran, value);
            if ran.code == Some(0) {
                ends(&dir.run_bounded("plot a.mcap --format svg -o figures"), value);
            }
        }
        check_figures(&dir, "figures", value);
    }
}

/// Places of the numbers in a text, apart from those within words.
fn numbers(text: &str) -> Vec<std::ops::Range<usize>> {
    let is_part = |c: char| c.is_ascii_digit() || matches!(c, '.' | '-' | '+' | 'e' | 'E');
    let mut places = Vec::new();
    let mut start = None;
    let mut before = ' ';
    for (place, c) in text.char_indices().chain([(text.len(), ' ')]) {
        match start {
            None if (c.is_ascii_digit() || c == '-') && !before.is_alphanumeric() && before != '_' => {
                start = Some(place);
            }
            Some(from) if !is_part(c) => {
                if text[from..place].parse::<f64>().is_ok() && !c.is_alphanumeric() && c != ':' {
                    places.push(from..place);
                }
                start = None;
            }
            _ => {}
        }
        before = c;
    }
    places
}

/// Gives every number of a text every value; `read` returns true if the text is accepted. Returns how many were.
fn substitute(text: &str, read: &dyn Fn(&str) -> bool) -> (usize, usize) {
    let (mut accepted, mut refused) = (0, 0);
    for place in numbers(text) {
        for value in VALUES {
            let mut changed = text.to_owned();
            changed.replace_range(place.clone(), value);
            *if read(&changed) { &mut accepted } else { &mut refused } += 1;
        }
    }
    (accepted, refused)
}

#[test]
fn keys_of_scenarios_take_or_refuse_boundary_values() {
    for name in ["safe-mode", "flexible-boom", "relay-adaptive"] {
        let text = std::fs::read_to_string(format!("{SCENARIOS}/{name}.toml")).expect("shipped");
        // A comment has no keys.
        let lines = text
            .lines()
            .map(|line| line.split(" #").next().unwrap_or_default())
            .filter(|line| !line.starts_with('#'));
        let text = lines.collect::<Vec<_>>().join("\n");
        let read = |changed: &str| match Scenario::parse("a.toml", changed) {
            Ok(_) => true,
            Err(error) => {
                assert!(error.to_string().contains("a.toml"), "{name}: {error}");
                false
            }
        };
        let (accepted, refused) = substitute(&text, &read);
        assert!(accepted > 100 && refused > 100, "{name}: {accepted} accepted, {refused} refused");
    }
}

/// Head of a scenario around an environment.
const CRAFT: &str = "duration = 2.0\nepoch = 2026-01-01T00:00:00Z\n[spacecraft]\nmass = 600.0\n\
    inertia = [[250, 0, 0], [0, 300, 0], [0, 0, 220]]\npoints = [{ name = \"bus\" }]\n\
    [law.pd]\nk_p = 1.0\nk_d = 20.0\nperiod = 0.5\n";
const ORBIT: &str = "[environment]\norbit = { semi_major_axis = 6.878e6 }\n";
const DRAG: &str = "drag = { model = \"table\", table = \"d.csv\", \
    plates = [{ area = 4.0, normal = [1, 0, 0], at = [1.0, 0, 0] }] }\n";
const APPENDAGE: &str = "[[appendage]]\nname = \"a\"\nmass = 14.4\ncentre = [2.4, 0.3, 0.9]\n\
    inertia = [[14.8, -2.4, -8.0], [-2.4, 24.3, -4.3], [-8.0, -4.3, 15.7]]\nmodes = \"m.csv\"\n";
const MATRICES: &str = "duration = 2.0\n[law.relay]\ndead_zone = 2e-3\nhysteresis = 2e-4\nstrong = 1.0\nweak = 0.02\n\
    k_t = 0.33\n[body.matrices]\nstiffness = [[0.0, 0.0], [0.0, 4.0]]\n";

/// Small files that scenarios name.
const SHC: &str = "1 1 2 2 1 2025.0 2030.0\n2025.0 2030.0\n1 0 -29350.0 -29287.0\n1 1 -1410.3 -1360.3\n\
    1 -1 4545.5 4438.0\n";
const WORLD_MODEL: &str = "2025.0 WMM-2025 11/13/2024\n1 0 -29351.8 0.0 12.0 0.0\n1 1 -1410.8 4545.4 9.7 -21.5\n\
    9999999999999999999999999\n";
const BLOCKS: &str = "IGRF2025 2025.00 1 1 0 2025.00 2030.00 -1.0 600.0\n1 0 -29350.0 0.0 12.6 0.0\n\
    1 1 -1410.3 4545.5 10.0 -21.5\n";
const MESSAGE: &str = "CCSDS_OEM_VERS = 2.0\nMETA_START\nCENTER_NAME = EARTH\nREF_FRAME = EME2000\n\
    TIME_SYSTEM = UTC\nMETA_STOP\n";
const DENSITIES: &str = "height,density\n1e5,5.6e-7\n4e5,2.8e-12\n6e5,1.1e-13\n1e6,3.5e-15\n";
const MODES: &str = "frequency,damping,tx,ty,tz,rx,ry,rz\n1.5,0.005,0.1,0.2,0.3,0.1,0.2,0.3\n\
    3.0,0.005,0.3,0.1,0.2,0.2,0.3,0.1\n";
const MARKET: &str = "%%MatrixMarket matrix coordinate real symmetric\n2 2 3\n1 1 10.0\n2 1 1\n2 2 2.0\n";

/// A small file of every kind that scenarios name, with its name and the text of its scenario.
fn files() -> Vec<(&'static str, String, String)> {
    let field = |name: &str| format!("{CRAFT}{ORBIT}magnetic_field = {{ table = \"{name}\" }}\n");
    let orbit = |name: &str| format!("{CRAFT}[environment]\norbit = {{ ephemeris = \"{name}\" }}\n");
    let mass = |name: &str| format!("{MATRICES}mass = \"{name}\"\n");
    let place = |row: u32, radius: f64| {
        let angle = 0.066 * f64::from(row);
        (radius * angle.cos(), radius * angle.sin())
    };
    let row = |row: u32| {
        let (x, y) = place(row, 6.9e6);
        format!("{},{x:.3},{y:.3},6e5\n", 60.0 * f64::from(row) - 60.0)
    };
    let state = |row: u32| {
        let (x, y) = place(row, 6.9e3);
        format!("2026-01-01T00:0{row}:00 {x:.6} {y:.6} 600 0 7.5 0\n")
    };
    vec![
        ("f.shc", SHC.to_owned(), field("f.shc")),
        ("f.COF", WORLD_MODEL.to_owned(), field("f.COF")),
        ("g.COF", BLOCKS.to_owned(), field("g.COF")),
        ("o.csv", (0..9).map(row).collect(), orbit("o.csv")),
        ("o.oem", MESSAGE.to_owned() + &(0..9).map(state).collect::<String>(), orbit("o.oem")),
        ("d.csv", DENSITIES.to_owned(), format!("{CRAFT}{ORBIT}{DRAG}")),
        ("m.csv", MODES.to_owned(), format!("{CRAFT}{APPENDAGE}")),
        ("k.csv", "10.0,1.0\n1.0,2.0\n".to_owned(), mass("k.csv")),
        ("k.mtx", MARKET.to_owned(), mass("k.mtx")),
    ]
}

#[test]
fn files_of_scenarios_take_or_refuse_boundary_values() {
    for (name, text, scenario) in files() {
        let dir = Dir::holding("a.toml", &scenario);
        let read = |changed: &str| {
            dir.write(name, changed);
            match Scenario::load(&dir.path("a.toml")) {
                Ok(_) => true,
                Err(error) => {
                    assert!(
                        error.to_string().contains("a.toml") || error.to_string().contains(name),
                        "{name}: {error}"
                    );
                    false
                }
            }
        };
        assert!(read(&text), "{name}: {}", Scenario::load(&dir.path("a.toml")).expect_err("refused"));
        let (accepted, refused) = substitute(&text, &read);
        assert!(accepted > 5 && refused > 10, "{name}: {accepted} accepted, {refused} refused");
    }
}

#[test]
#[cfg(target_os = "linux")]
fn tables_of_points_and_commands_take_or_refuse_boundary_values() {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    for value in VALUES {
        dir.write("p.csv", format!("law.relay.k_t,body.planar.rate\n0.31,{value}\n{value},1e-5\n"));
        ends(&dir.run_bounded("sweep u.toml --points p.csv --set duration=50 --force -o rows.csv"), value);
    }
    let commands = "time_whole_s,time_fs,x,y,z\n0,0,0.1,0.2,0.3\n1,500000000000000,0.1,0.2,0.3\n";
    assert!(CommandLog::parse(commands).is_some());
    let (accepted, refused) = substitute(commands, &|changed| CommandLog::parse(changed).is_some());
    assert!(accepted > 50 && refused > 30, "{accepted} accepted, {refused} refused");
}
