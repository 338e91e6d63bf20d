//! Files that are left when a run cannot continue: no directory, a full disk, Ctrl-C, a kill.

use std::path::Path;

use flexsc_core::campaign::{Campaign, CampaignRun};
use flexsc_core::numerics::time::Instant;
use flexsc_core::record::{Detail, LogFile, Record, RecordError, Sample, recover};
use flexsc_core::{Document, Scenario};

use crate::util::{Dir, UNCERTAIN, end, has_extension, table};

#[test]
fn a_directory_that_cannot_be_made_is_named() {
    let dir = Dir::with(&["relay-fixed"]);
    dir.write("file", "");
    for arguments in ["", "--runs 2", "--runs 2 --log events"] {
        let ran = dir.run(&format!("simulate relay-fixed.toml -o file/sub {arguments}")).exits(1);
        ran.says(&["error: cannot write file/sub: "]);
    }
    dir.run("sweep relay-fixed.toml --vary law.relay.k_t=0.3:0.4:5 --table csv -o file/sub")
        .exits(1)
        .says(&["file/sub"]);
    std::fs::create_dir(dir.path("relay-fixed.mcap")).expect("a directory");
    dir.run("simulate relay-fixed.toml --set duration=10")
        .exits(1)
        .says(&["cannot write relay-fixed.mcap: "]);
    assert_eq!(dir.names(""), ["file", "relay-fixed.mcap", "relay-fixed.toml"]);
}

#[cfg(unix)]
#[test]
fn a_full_disk_leaves_nothing() {
    let dir = Dir::with(&["relay-fixed"]);
    dir.write("u.toml", UNCERTAIN);
    let full = |blocks: u32, file: &str, arguments: &str| {
        let ran = dir.run_within(blocks, arguments).exits(1);
        ran.says(&["error: cannot write ", file, "File too large"]);
        let left: Vec<_> = dir.names("out").into_iter().filter(|n| n.ends_with(".partial")).collect();
        assert!(left.is_empty() && !dir.has(&format!("out/{file}")), "{left:?}");
    };
    // Full before the first chunk, amid the run, and only at its end.
    full(1, "relay-fixed.mcap", "simulate relay-fixed.toml -o out --log full");
    full(100, "relay-fixed.mcap", "simulate relay-fixed.toml -o out");
    full(10, "relay-fixed.mcap", "simulate relay-fixed.toml -o out --set duration=10");
    assert!(dir.names("out").is_empty());
    full(10, "run 1", "simulate u.toml --runs 1:2 --table csv -o out --log events");
    assert_eq!(dir.names("out"), ["scenario.toml"]);
    // The rows that were written are kept, and no part of one.
    full(100, "runs.csv", "simulate u.toml --runs 2000 --set duration=1 --table csv -o out --force");
    assert_eq!(dir.names("out"), ["runs-interrupted.csv", "scenario.toml"]);
    dir.run("simulate u.toml --runs 2000 --set duration=1 --table csv -o whole").exits(0);
    let (kept, whole) = (dir.text("out/runs-interrupted.csv"), dir.text("whole/runs.csv"));
    assert!(whole.starts_with(&kept) && kept.ends_with('\n'));
    assert!((10..2000).contains(&kept.lines().count()), "{} lines", kept.lines().count());
    // Full before any row is written.
    std::fs::remove_dir_all(dir.path("out")).expect("removed");
    full(2, "runs.csv", "simulate u.toml --runs 20 --set duration=1 --table csv -o out");
    assert_eq!(dir.names("out"), ["scenario.toml"]);
    dir.run("simulate relay-fixed.toml -o whole").exits(0);
    dir.run("log recover whole/relay-fixed.mcap -o /dev/full").exits(1).says(&["cannot write /dev/full"]);
    assert!(Path::new("/dev/full").exists());
}

const LONG: &str = "simulate relay-fixed.toml -o out --log events --set duration=5e8";

#[cfg(unix)]
#[test]
fn an_interrupted_run_has_a_whole_log() {
    let dir = Dir::with(&["relay-fixed"]);
    for signal in ["INT", "TERM"] {
        let run = dir.start(LONG);
        dir.wait_for("out/relay-fixed.mcap.partial", 200_000);
        run.signal(signal).exits(130).says(&["interrupted", "out/relay-fixed.mcap"]);
        assert_eq!(dir.names("out"), ["relay-fixed.mcap"]);
        let end = end(&dir, "out/relay-fixed.mcap");
        assert_eq!(end["end"], "interrupted");
        let rows = command_rows(&dir, "out/relay-fixed.mcap");
        assert!(rows.len() > 2000);
        // The log ends with its last event, a switching or the mean of a window.
        let (last, end) = (seconds(rows.last().expect("rows")), seconds(&end["time_s"]));
        assert!((0.0..100.0).contains(&(end - last)), "{last} {end}");
        std::fs::remove_dir_all(dir.path("out")).expect("removed");
    }
}

#[cfg(unix)]
#[test]
fn runs_that_ignore_a_signal_end_by_another() {
    let dir = Dir::with(&["relay-fixed"]);
    // By `nohup`, and in the background of a script besides.
    for (ignored, other) in [("HUP", "INT"), ("INT HUP", "TERM")] {
        let run = dir.start_ignoring(ignored, LONG);
        dir.wait_for("out/relay-fixed.mcap.partial", 200_000);
        ignored.split(' ').for_each(|signal| run.sends(signal));
        let so_far = dir.size("out/relay-fixed.mcap.partial");
        dir.wait_for("out/relay-fixed.mcap.partial", so_far + 200_000);
        run.signal(other).exits(130).says(&["interrupted", "out/relay-fixed.mcap"]);
        assert_eq!(dir.names("out"), ["relay-fixed.mcap"]);
        assert_eq!(end(&dir, "out/relay-fixed.mcap")["end"], "interrupted");
        std::fs::remove_dir_all(dir.path("out")).expect("removed");
    }
}

#[cfg(unix)]
#[test]
fn an_interrupted_campaign_keeps_whole_files_only() {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    let run = dir.start("simulate u.toml --runs 100000 --table csv -o out --log events");
    dir.wait_for("out/u-300.mcap", 1);
    run.signal("INT").exits(130).says(&["interrupted at run "]);
    let names = dir.names("out");
    assert!(names.iter().all(|name| !name.ends_with(".partial")), "{names:?}");
    assert!(!names.contains(&"statistics.csv".to_owned()) && !names.contains(&"runs.csv".to_owned()));
    let rows = table(&dir, "out/runs-interrupted.csv").len();
    assert!((100..100_000).contains(&rows), "{rows}");
    // Only the runs that were under way when the signal came have logs that stop early.
    let early = names.iter().filter(|name| has_extension(name, "mcap"));
    let early = early.filter(|name| end(&dir, &format!("out/{name}"))["end"] != "complete").count();
    assert!(early <= 64, "{early} logs of runs that never were");
}

/// The rows of `/command` without their header.
fn command_rows(dir: &Dir, log: &str) -> Vec<String> {
    let text = dir.run(&format!("export {log} --topic /command")).printed();
    text.lines().skip(1).map(str::to_owned).collect()
}

/// The time with which a row begins.
fn seconds(row: &str) -> f64 {
    row.split(',').next().expect("a time").parse().expect("a number")
}

#[cfg(unix)]
#[test]
fn a_killed_run_is_recovered() {
    let dir = Dir::with(&["relay-fixed"]);
    let run = dir.start(LONG);
    dir.wait_for("out/relay-fixed.mcap.partial", 1_000_000);
    assert_eq!(run.signal("KILL").code, None);
    assert_eq!(dir.names("out"), ["relay-fixed.mcap.partial"]);
    let torn = "out/relay-fixed.mcap.partial";
    let hint = format!("`flexsc log recover {torn}`");
    dir.run(&format!("export {torn} --topic /command")).exits(2).says(&["torn", &hint]);
    dir.run(&format!("log scenario {torn}")).exits(2).says(&["torn", &hint]);
    dir.run(&format!("log recover {torn}"))
        .exits(0)
        .says(&["messages saved", "out/relay-fixed-recovered.mcap"]);
    let saved = command_rows(&dir, "out/relay-fixed-recovered.mcap");
    assert!(saved.len() > 5000, "{} rows", saved.len());
    let last = seconds(saved.last().expect("rows"));
    dir.run(&format!("simulate relay-fixed.toml -o whole --set duration={}", last + 1.0)).exits(0);
    assert_eq!(command_rows(&dir, "whole/relay-fixed.mcap")[..saved.len()], saved);
    dir.run("log scenario out/relay-fixed-recovered.mcap").exits(0).prints(&["duration = 500000000.0"]);
}

/// Observer of the log that a run would leave if it were killed at some instants.
struct Killer<'a> {
    dir: &'a Dir,
    /// Number of written messages, that of `/params` among them.
    written: u64,
    looks: u64,
}

impl Record for Killer<'_> {
    fn record(&mut self, _: Instant, _: Sample<'_>) -> Result<(), RecordError> {
        self.written += 1;
        if self.written.is_multiple_of(1777) {
            self.looks += 1;
            let (_, saved) = recover(&self.dir.path("x.mcap.partial")).expect("recovered");
            assert!(saved <= self.written && saved + 2000 >= self.written, "{saved} of {}", self.written);
        }
        Ok(())
    }
}

#[test]
fn a_killed_run_loses_at_most_2000_messages() {
    let dir = Dir::with(&["relay-fixed"]);
    let mut document = Document::load(&dir.path("relay-fixed.toml")).expect("a scenario");
    document.set_text("duration", "1e5").expect("a key");
    let scenario = Scenario::from_document(&document).expect("a scenario");
    let run = CampaignRun::new(scenario, 0);
    let provenance = Campaign::provenance(&run);
    let mut log = LogFile::create(&dir.path("x.mcap"), &provenance, Detail::Events).expect("created");
    let mut killer = Killer { dir: &dir, written: 1, looks: 0 };
    Campaign::simulate(&run, (&mut log, &mut killer)).expect("a run");
    assert!(killer.looks > 5);
    drop(log);
    assert_eq!(dir.names(""), ["relay-fixed.toml"]);
}

/// Wherever a log is torn, all chunks before are saved, and no chunk has more than 2000 messages.
#[test]
fn a_log_torn_anywhere_is_recovered() {
    let dir = Dir::with(&["relay-fixed"]);
    dir.run("simulate relay-fixed.toml -o out --log full --set duration=2000").exits(0);
    let bytes = dir.read("out/relay-fixed.mcap");
    let summary = mcap::Summary::read(&bytes).expect("whole").expect("a summary");
    let chunks = &summary.chunk_indexes;
    let messages: Vec<_> =
        mcap::MessageStream::new(&bytes).expect("a log").map(|m| m.expect("whole")).collect();
    for part in [0.0, 0.1, 0.5, 0.77, 0.999] {
        let cut = 8 + ((bytes.len() - 8) as f64 * part) as usize;
        dir.write("torn.mcap.partial", &bytes[..cut]);
        let ran = dir.run("log recover torn.mcap.partial -o saved.mcap --force").exits(0);
        let saved: usize = ran.err.split_whitespace().next().expect("a count").parse().expect("a count");
        let before = chunks.iter().filter(|c| c.chunk_start_offset + c.chunk_length <= cut as u64);
        let indexes = before.map(|c| summary.read_message_indexes(&bytes, c).expect("indexes"));
        let whole: usize = indexes.flat_map(|indexes| indexes.into_values().map(|of| of.len())).sum();
        assert!(saved >= whole && saved <= whole + 2000, "{saved} messages of {whole} at {part}");
        let saved_bytes = dir.read("saved.mcap");
        let stream = mcap::MessageStream::new(&saved_bytes).expect("a log").map(|m| m.expect("whole"));
        let same = stream.zip(&messages).take_while(|(a, b)| {
            (&*a.channel.topic, a.log_time, &a.data) == (&*b.channel.topic, b.log_time, &b.data)
        });
        assert_eq!(same.count(), saved);
    }
}

#[test]
fn what_is_no_log_is_not_recovered() {
    let dir = Dir::with(&["relay-fixed"]);
    dir.run("log recover relay-fixed.toml -o saved.mcap")
        .exits(2)
        .says(&["relay-fixed.toml: a scenario, not a log"]);
    let other = Dir::holding("notes.txt", "no log");
    other.run("log recover notes.txt -o saved.mcap").exits(2).says(&["notes.txt: not a readable MCAP log"]);
    dir.run("log recover relay-fixed.toml").exits(2);
    dir.run("log recover missing.mcap").exits(2).says(&["missing.mcap", "No such file"]);
    dir.run("log recover relay-fixed.toml -o relay-fixed.toml").exits(2).says(&["is the input"]);
    dir.run("export relay-fixed.toml").exits(2).says(&["relay-fixed.toml: a scenario, not a log"]);
    dir.run("export missing.mcap").exits(2).says(&["missing.mcap", "No such file"]);
    assert_eq!(dir.names(""), ["relay-fixed.toml"]);
    dir.run("simulate relay-fixed.toml").exits(0);
    dir.run("log recover relay-fixed.mcap -o relay-fixed.mcap/saved.mcap")
        .exits(1)
        .says(&["cannot write relay-fixed.mcap"]);
}

/// A device in the place of a file fails as a full disk does, and stays.
#[test]
fn tables_and_figures_on_a_full_disk_fail() {
    let dir = Dir::with(&["relay-fixed"]);
    dir.run("simulate relay-fixed.toml").exits(0);
    dir.run("export relay-fixed.mcap --topic /command -o /dev/full")
        .exits(1)
        .says(&["/dev/full", "No space left"]);
    assert!(std::path::Path::new("/dev/full").exists());
    std::os::unix::fs::symlink("/dev/full", dir.path("torque.svg")).expect("linked");
    dir.run("plot relay-fixed.mcap -o torque.svg --what torque")
        .exits(1)
        .says(&["torque.svg", "No space left"]);
}

/// An existing file stays until the new one is complete, and a read-only file stays unchanged.
#[test]
fn a_file_that_cannot_be_replaced_stays() {
    let dir = Dir::with(&["relay-fixed"]);
    dir.write("layout.json", "mine");
    let path = dir.path("layout.json");
    let mut permissions = std::fs::metadata(&path).expect("there").permissions();
    permissions.set_readonly(true);
    std::fs::set_permissions(&path, permissions.clone()).expect("mine");
    dir.run("layout relay-fixed.toml -o layout.json --force").exits(1).says(&["layout.json", "denied"]);
    assert_eq!(dir.text("layout.json"), "mine");
    #[allow(clippy::permissions_set_readonly_false)] // It is the test's own, and about to be removed.
    permissions.set_readonly(false);
    std::fs::set_permissions(&path, permissions).expect("mine");
    dir.run("layout relay-fixed.toml -o layout.json --force").exits(0);
    assert!(dir.text("layout.json").contains("configById"));
    assert_eq!(dir.names("."), ["layout.json", "relay-fixed.toml"]);
}

/// A file at a temporary name is neither followed, nor waited for, nor removed.
#[cfg(unix)]
#[test]
fn links_and_pipes_in_the_way_are_left_alone() {
    let dir = Dir::with(&["relay-fixed"]);
    dir.write("u.toml", UNCERTAIN);
    dir.run("simulate relay-fixed.toml --set duration=100 -o log").exits(0);
    dir.write("victim", "mine");
    for (name, arguments) in [
        ("out/relay-fixed.mcap", "simulate relay-fixed.toml --set duration=10 -o out"),
        ("out/runs.csv", "simulate u.toml --runs 2 --table csv -o out"),
        ("out/scenario.toml", "simulate u.toml --runs 2 --table csv -o out"),
        ("out/statistics.csv", "simulate u.toml --runs 2 --table csv -o out"),
        (
            "out/runs.csv",
            "sweep relay-fixed.toml --set duration=10 --vary law.relay.k_t=0.3:0.4:2 --table csv -o out",
        ),
        ("out/a.csv", "export log/relay-fixed.mcap --topic /command -o out/a.csv"),
        ("out/layout.json", "layout relay-fixed.toml -o out/layout.json"),
        ("out/saved.mcap", "log recover log/relay-fixed.mcap -o out/saved.mcap"),
        ("out/relay-fixed-torque.svg", "plot log/relay-fixed.mcap --what torque --format svg -o out"),
        ("out/all.svg", "plot log/relay-fixed.mcap --what torque -o out/all.svg"),
    ] {
        let partial = format!("{name}.partial");
        std::fs::create_dir_all(dir.path("out")).expect("made");
        std::os::unix::fs::symlink(dir.path("victim"), dir.path(&partial)).expect("linked");
        dir.run(arguments).exits(1).says(&["cannot write", &partial, "in the way"]);
        assert_eq!(dir.text("victim"), "mine", "{arguments}");
        std::fs::remove_file(dir.path(&partial)).expect("still there");
        let made = std::process::Command::new("mkfifo").arg(dir.path(&partial)).status();
        assert!(made.expect("mkfifo starts").success());
        dir.run(arguments).exits(1).says(&["cannot write", &partial, "in the way"]);
        assert!(!dir.has(name), "{arguments}");
        std::fs::remove_dir_all(dir.path("out")).expect("removed");
        // Without them it works, and a link in the place itself stays one.
        std::fs::create_dir_all(dir.path("out")).expect("made");
        dir.run(arguments).exits(0);
        assert!(dir.has(name) && !dir.has(&partial), "{arguments}");
        std::fs::remove_dir_all(dir.path("out")).expect("removed");
    }
}

/// The remains of a killed run do not hinder the next one.
#[cfg(unix)]
#[test]
fn a_killed_run_leaves_no_lock() {
    let dir = Dir::with(&["relay-fixed"]);
    let run = dir.start(LONG);
    dir.wait_for("out/relay-fixed.mcap.partial", 200_000);
    dir.run("simulate relay-fixed.toml -o out").exits(2).says(&[
        "cannot write out/relay-fixed.mcap",
        "another process is writing it",
        "hint:",
    ]);
    run.signal("KILL");
    dir.run("simulate relay-fixed.toml --set duration=100 -o out").exits(0);
    assert_eq!(dir.names("out"), ["relay-fixed.mcap"]);
}
