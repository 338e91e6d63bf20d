//! Everything a user can observe, frozen: bytes of logs, metrics, schema, topics, help and errors. A change of any of them is
//! made on purpose, and named in the changelog.
//!
//! `INSTA_UPDATE=always cargo test --release --workspace --exclude flexsc-bench --test tests frozen` writes the snapshots anew.

use std::fmt::Write as _;
use std::io::Write as _;
use std::process::{Command, Stdio};

use toml::{Table, Value};

use crate::util::{Dir, FLEXSC, SCENARIOS};

/// Returns the FNV-1a hash of bytes.
fn hash(bytes: &[u8]) -> u64 {
    bytes
        .iter()
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x100_0000_01b3))
}

/// Returns the names of the shipped scenarios, sorted.
fn shipped() -> Vec<String> {
    let entries = std::fs::read_dir(SCENARIOS).expect("shipped").flatten();
    let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
    let mut names: Vec<_> = names.filter_map(|name| name.strip_suffix(".toml").map(str::to_owned)).collect();
    names.sort();
    names
}

/// Compares a text with the snapshot of that name in `tests/frozen`.
#[track_caller]
pub fn is_frozen(name: &str, text: &str) {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("frozen");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| insta::assert_snapshot!(name, text));
}

/// Compares bytes with those of a file of the repository, which `INSTA_UPDATE=always` writes anew: pages in Markdown and
/// their figures, which are read as they are.
#[track_caller]
pub fn is_frozen_file(path: &str, made: &[u8]) {
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path);
    if std::env::var_os("INSTA_UPDATE").is_some_and(|update| update == "always") {
        std::fs::write(&file, made).expect("a file");
    }
    let kept = std::fs::read(&file).unwrap_or_default();
    let [old, new] = [&kept, made].map(String::from_utf8_lossy);
    for (line, (old, new)) in old.lines().zip(new.lines()).enumerate() {
        assert!(old == new, "{path}:{}: has `{old}`, made is `{new}`", line + 1);
    }
    assert!(kept == made, "{path} has another end");
}

#[test]
fn logs_and_metrics_of_shipped_scenarios_are_frozen() {
    let names = shipped();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let dir = Dir::with(&names);
    let mut lines = String::new();
    for name in names {
        let printed = dir.run(&format!("simulate {name}.toml --json")).exits(0).json();
        let metrics = printed.get("metrics").unwrap_or(&printed);
        let (log, metrics) = (dir.read(&format!("{name}.mcap")), metrics.to_string());
        writeln!(lines, "{name:<28} log {:016x}  metrics {:016x}", hash(&log), hash(metrics.as_bytes()))
            .expect("memory");
    }
    is_frozen("runs", &lines);
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn schema_topics_and_metrics_are_frozen() {
    let dir = Dir::new();
    let mut lines = String::new();
    for arguments in ["schema", "schema --topics", "schema --metrics"] {
        let printed = dir.run(arguments).printed();
        writeln!(lines, "{arguments:<18} {:016x} {} bytes", hash(printed.as_bytes()), printed.len())
            .expect("memory");
    }
    is_frozen("schema", &lines);
    is_frozen("topics", &dir.run("schema --topics").printed());
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn help_is_frozen() {
    let dir = Dir::new();
    let overview = dir.run("--help").printed();
    let verbs = overview.lines().filter_map(|line| line.strip_prefix("  ")?.split_whitespace().next());
    let mut text = overview.clone();
    for verb in verbs.filter(|word| !word.starts_with('-')) {
        writeln!(text, "\n### {verb}\n{}", dir.run(&format!("{verb} --help")).printed()).expect("memory");
    }
    is_frozen("help", &text);
}

/// Appends the paths of all values that are no tables, in the order of the document.
fn leaves(value: &Value, path: &mut Vec<String>, found: &mut Vec<Vec<String>>) {
    match value {
        Value::Table(table) => {
            for (key, value) in table {
                path.push(key.clone());
                leaves(value, path, found);
                path.pop();
            }
        }
        Value::Array(items) if items.first().is_some_and(Value::is_table) => {
            for (index, item) in items.iter().enumerate() {
                path.push(index.to_string());
                leaves(item, path, found);
                path.pop();
            }
        }
        _ => found.push(path.clone()),
    }
}

/// Returns the table that holds the last key of a path.
fn parent<'a>(root: &'a mut Table, path: &[String]) -> &'a mut Table {
    let mut at = path[..path.len() - 1].iter().peekable();
    let mut table = root;
    while let Some(key) = at.next() {
        let mut value = table.get_mut(key).expect("there");
        while value.is_array() {
            let index: usize = at.next().expect("an index").parse().expect("an index");
            value = &mut value.as_array_mut().expect("an array")[index];
        }
        table = value.as_table_mut().expect("a table");
    }
    table
}

/// Makes one mistake at a key, and returns its description.
fn spoil(table: &mut Table, key: &str, kind: usize) -> &'static str {
    let value = table.get_mut(key).expect("there");
    match kind {
        0 => {
            let value = table.remove(key).expect("there");
            table.insert(format!("{}_", &key[..key.len() - 1]), value);
            "misspelt"
        }
        1 => {
            *value = Value::Float(f64::NAN);
            "not a number"
        }
        2 => {
            *value = Value::Float(-1e300);
            "far below"
        }
        3 => {
            *value = Value::String("3 furlongs".to_owned());
            "of an unknown unit"
        }
        4 => {
            *value = Value::Array(vec![Value::Boolean(true); 7]);
            "an array of truths"
        }
        5 => {
            table.remove(key);
            "absent"
        }
        _ => {
            *value = Value::Float(1e300);
            "far above"
        }
    }
}

/// Runs `flexsc check` on a text, and returns its exit code and what it says.
fn checked(text: &str) -> (i32, String) {
    let mut command = Command::new(FLEXSC);
    command.args(["check", "-"]).stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
    let mut child = command.current_dir(SCENARIOS).spawn().expect("the command starts");
    // The command may refuse the text before it has read all of it.
    let _ = child.stdin.take().expect("piped").write_all(text.as_bytes());
    let output = child.wait_with_output().expect("the command ends");
    (output.status.code().unwrap_or(-1), String::from_utf8(output.stderr).expect("UTF-8"))
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn errors_of_spoilt_scenarios_are_frozen() {
    let (mut text, mut refused, mut count) = (String::new(), 0, 0);
    for name in shipped() {
        let document = std::fs::read_to_string(format!("{SCENARIOS}/{name}.toml")).expect("shipped");
        let document: Table = document.parse().expect("TOML");
        let mut paths = Vec::new();
        leaves(&Value::Table(document.clone()), &mut Vec::new(), &mut paths);
        // Some six of the keys, each with another mistake; which ones does not depend on the other scenarios.
        let first: usize = name.bytes().map(usize::from).sum();
        for (index, path) in paths.iter().skip(first % 5).step_by(1 + paths.len() / 6).enumerate() {
            let mut spoilt = document.clone();
            let key = path.last().expect("a key");
            let mistake = spoil(parent(&mut spoilt, path), key, (first + index) % 7);
            count += 1;
            let (code, error) = checked(&toml::to_string(&spoilt).expect("TOML"));
            assert!(code == 0 || code == 2, "{name} {path:?} {mistake}: {code}\n{error}");
            if code == 2 {
                refused += 1;
                writeln!(text, "### {name}: {} {mistake}\n{error}", path.join(".")).expect("memory");
            }
        }
    }
    assert!(refused >= 160, "{refused} of {count} mistakes are refused");
    is_frozen("errors", &text);
}

/// Command lines that are refused.
const REFUSED: &[&str] = &[
    "simulate",
    "simulate nothing.toml",
    "simulate relay-fixed.toml --log all",
    "simulate relay-fixed.toml --runs -1",
    "simulate relay-fixed.toml --runs 5:2",
    "simulate relay-fixed.toml --set law.relay.k_t",
    "simulate relay-fixed.toml --set law.relay.k_t=fast",
    "simulate relay-fixed.toml --set law.relay.kt=0.3",
    "simulate relay-fixed.toml --jobs 0",
    "simulate relay-fixed.toml --speed 0",
    "check nothing.toml",
    "new",
    "new boom --like nothing",
    "examples nothing",
    "modes nothing.toml",
    "cycle wheel-ekf.toml",
    "plan relay-fixed.toml",
    "tune relay-fixed.toml",
    "map relay-fixed.toml",
    "damping --frequency 1:0:3",
    "damping --frequency 0 --acceleration 0.1",
    "damping --frequency 1 --acceleration -0.1",
    "observer",
    "observer --frequency -1",
    "identify relay-fixed.toml",
    "sweep relay-fixed.toml",
    "sweep relay-fixed.toml --vary law.relay.k_t=1:0:-3",
    "sweep relay-fixed.toml --vary law.relay.kt=0:1:3",
    "sweep relay-fixed.toml --vary law.relay.k_t=0:1:0",
    "plot nothing.mcap",
    "plot relay-fixed.toml --what angles",
    "export nothing.mcap --topic /command",
    "export relay-fixed.toml",
    "layout nothing.mcap",
    "log scenario nothing.mcap",
    "log recover nothing.mcap -o other.mcap",
    "merge nothing -o all",
    "top nothing",
    "schema --metric",
    "completions cobol",
];

#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn errors_of_command_lines_are_frozen() {
    let dir = Dir::with(&["relay-fixed", "wheel-ekf"]);
    let mut text = String::new();
    for arguments in REFUSED {
        let ran = dir.run(arguments).exits(2);
        writeln!(text, "### {arguments}\n{}", ran.err).expect("memory");
    }
    is_frozen("command_lines", &text);
}
