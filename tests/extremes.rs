//! Every option of every verb at absurd values: each is refused or answered within seconds of the processor.

use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use clap::ValueHint;

#[cfg(unix)]
use crate::help::examples;
use crate::util::{Dir, FLEXSC};

/// Numbers, and grids of numbers.
const VALUES: &[&str] = &["0", "-1", "nan", "1e-300", "1e9", "1e20", "1e300", "18446744073709551615"];
const GRIDS: &[&str] = &["0.5:1e12:5", "1e-300:1e300:5", "1:2:4294967295", "1:1e9:100"];
/// Verbs that need minutes, or take no numbers.
const WITHOUT: &[&str] = &["reproduce", "report", "completions", "help"];
/// Options that wait for others, that ask for long work, or whose values are keys of scenarios.
const SKIPPED: &[&str] = &["live", "scheduler", "yes", "set", "vary", "help", "log"];
/// Arguments with which the example of a verb takes less time.
const SHORTER: &[(&str, &str)] = &[("plot", "--what torque")];
/// Time of the processor for each (s), and of the clock where it waits.
const CPU: u32 = 5;
const PATIENCE: Duration = Duration::from_secs(120);

/// Arguments with a value of an option, in place of the one that they have.
fn with(arguments: &[String], option: &str, value: &str) -> Vec<String> {
    let flag = format!("--{option}");
    let mut all: Vec<String> = Vec::new();
    let mut drops = false;
    for word in arguments {
        if std::mem::take(&mut drops) && !word.starts_with('-') {
            continue;
        }
        if *word == flag {
            drops = true;
        } else if !word.starts_with(&format!("{flag}=")) {
            all.push(word.clone());
        }
    }
    all.push(format!("{flag}={value}"));
    all
}

/// Runs a command, and returns how it ended if it did not end by itself in time.
fn ends(dir: &Dir, arguments: &[String]) -> Option<String> {
    let mut command = Command::new("sh");
    command.args(["-c", &format!("ulimit -t {CPU}; exec \"$0\" \"$@\""), FLEXSC]).args(arguments);
    command.env("RAYON_NUM_THREADS", "2").current_dir(dir.path(""));
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    let mut child = command.spawn().expect("started");
    let begun = Instant::now();
    loop {
        if let Some(status) = child.try_wait().expect("a child") {
            let code = status.code();
            return (!matches!(code, Some(0..=2))).then(|| format!("{}: {status}", arguments.join(" ")));
        }
        if begun.elapsed() > PATIENCE {
            child.kill().expect("killed");
            child.wait().expect("ended");
            return Some(format!("{}: still there after {PATIENCE:?}", arguments.join(" ")));
        }
        thread::sleep(Duration::from_millis(5));
    }
}

/// Keys with which a run takes minutes: the estimate is printed before the run begins.
#[test]
#[cfg(unix)]
fn runs_of_minutes_are_announced() {
    let dir = Dir::with(&["relay-fixed", "detumble-and-point"]);
    for (name, key, what) in [
        ("relay-fixed", "law.relay.hysteresis=1e-15", "note: `law.relay.hysteresis` makes 1."),
        ("relay-fixed", "law.relay.strong=1e3", "note: `law.relay.hysteresis` makes 1."),
        ("detumble-and-point", "spacecraft.rate=[100,0,0]", "note: `duration` makes 2."),
    ] {
        let command = format!("simulate {name}.toml --log none --set {key}");
        let mut running = dir.start_by(&format!("ulimit -t {CPU}"), &command);
        let note = running.line("on one core");
        assert!(note.contains(what), "{note}");
        assert_eq!(running.signal("KILL").code, None, "{note}");
    }
}

/// Values at which a search, a series or an integration would never end are answered or refused at once.
#[test]
#[cfg(target_os = "linux")]
fn values_without_end_are_answered_or_refused() {
    let dir = Dir::with(&["relay-fixed", "relay-one-sided", "rotation-sine", "wheel-friction"]);
    // A coast of up to 1e296 s, in closed form.
    for (weak, told) in [("1e-15", "coast          14.43 s"), ("1e-300", "period         39.39 s")] {
        dir.run_bounded(&format!("cycle relay-fixed.toml --set law.relay.weak={weak}"))
            .exits(0)
            .says(&[told]);
        dir.run_bounded(&format!("cycle relay-one-sided.toml --set law.relay.weak={weak}"))
            .exits(0)
            .says(&["one-sided cycle, stable", "0.0000 under strong torque"]);
        dir.run_bounded(&format!("simulate relay-fixed.toml --log none --set law.relay.weak={weak}"))
            .exits(0);
    }
    // A command of 1e7 periods, and one of no number of them.
    for (peak, told) in
        [("1e-9", "lasts at most 2e4 periods of the fastest mode"), ("1e-300", "in some time")]
    {
        dir.run_bounded(&format!("plan rotation-sine.toml --peak-torque {peak}")).exits(2).says(&[
            "--peak-torque: must be enough for",
            told,
            &format!("got {peak} N m"),
        ]);
    }
    for peak in ["1e30", "1e300"] {
        dir.run_bounded(&format!("plan rotation-sine.toml --peak-torque {peak}")).exits(2).says(&[
            "--peak-torque: must be so small that the command lasts at least 1e-4 periods",
            &format!("got {peak} N m"),
        ]);
    }
    // Bearings that stop a wheel at once, and bearings that no motor turns.
    let friction = "simulate wheel-friction.toml --log none --set actuator.wheels.friction";
    dir.run_bounded(&format!("{friction}.coulomb=1000")).exits(2).says(&[
        "`actuator.wheels.friction.coulomb` must be at most 10 times the torque of the motor",
        "got 1000",
    ]);
    dir.run_bounded(&format!("{friction}.breakaway=1000 --all")).exits(0).says(&["4 stops"]);
    // A wheel that its bearing stops within 40 ms: the steps resolve that.
    let short = "--set duration=40 --set estimator.attitude.assess=[0,30]";
    dir.run_bounded(&format!("{friction}.viscous=1 {short}")).exits(0);
    dir.run_bounded(&format!("{friction}.viscous=1e9")).exits(2).says(&["at most 1.0e12 are allowed"]);
}

/// Runs the first example of each verb with each of its options at each value, in a directory in which all examples have run.
#[cfg(unix)]
pub fn every_option_ends_in_seconds(dir: &Dir) {
    let mut cases: Vec<Vec<String>> = Vec::new();
    for verb in flexsc_cli::command().get_subcommands() {
        if WITHOUT.contains(&verb.get_name()) {
            continue;
        }
        let examples = examples(dir, verb.get_name());
        let waits = |line: &str| line.starts_with("serve ") && !line.contains("--describe");
        let Some(line) = examples.iter().find(|line| !waits(line)) else { continue };
        let shorter = SHORTER.iter().find(|(of, _)| *of == verb.get_name()).map_or("", |(_, words)| words);
        let words = line.split_whitespace().chain(shorter.split_whitespace());
        let base: Vec<_> = words.map(|word| word.trim_matches('\'').to_owned()).collect();
        for option in verb.get_arguments().filter(|option| option.get_action().takes_values()) {
            let Some(name) = option.get_long().filter(|name| !SKIPPED.contains(name)) else { continue };
            let of = option.get_value_names().unwrap_or_default();
            let is_grid = of.iter().any(|name| name.contains("LO:HI"));
            // A path has no size: numbers are names there.
            let is_path = option.get_value_hint() == ValueHint::AnyPath;
            let values = if is_grid { GRIDS } else { &VALUES[..if is_path { 2 } else { VALUES.len() }] };
            cases.extend(values.iter().map(|value| with(&base, name, value)));
        }
    }
    assert!(cases.len() > 200, "{}", cases.len());
    let (next, wrong) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                while let Some(case) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
                    if let Some(told) = ends(dir, case) {
                        wrong.lock().expect("whole").push(told);
                    }
                }
            });
        }
    });
    let wrong = wrong.into_inner().expect("whole");
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), cases.len(), wrong.join("\n"));
}
