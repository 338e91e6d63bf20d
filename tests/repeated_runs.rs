//! Figures of logs without the rows that they show: the run is repeated, noted, and checked against the log.

use std::path::Path;

use flexsc_cli::figures;
use flexsc_core::Scenario;
use flexsc_core::answer::{RunVerdict, ScreenOptions};
use flexsc_core::campaign::{Campaign, CampaignRun, CommandLog};
use flexsc_core::control::law::Command;
use flexsc_core::formats::reader_units::ReaderUnits;
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::record::{Detail, Log, LogBytes, RunEnd};

use crate::util::Dir;

const ONE_ANGLE: &str =
    "duration = 10.0\n[law.open]\n[body.planar]\ninertia = 2.0\nmodes = [{ frequency = 1.3, gain = 0.2 }]";
const THREE_AXES: &str = "duration = 10.0\n[law.open]\n[body.spatial]\ninertia = [[100, 0, 0], [0, 80, 0], [0, 0, 60]]\n\
                          points = [{ name = \"hub\" }]\n\
                          modes = [{ frequency = 1.3, damping = 0.02, shapes.hub = { rotation = [0.02, 0.01, 0.03] } }]";

fn at(seconds: f64) -> Instant {
    Instant::START + Span::from_seconds(seconds)
}

/// Returns commands of a torque about the first axis (N m) from each of some times on (s).
fn commands(given: &[(f64, f64)]) -> CommandLog {
    let mut log = CommandLog::default();
    for (time, torque) in given {
        log.push(at(*time), [*torque, 0.0, 0.0].map(Command::Torque));
    }
    log
}

/// Returns a log of the events of a run under some commands that says it is one under others.
fn log(text: &str, given: &CommandLog, written: &CommandLog, until: Instant) -> Log {
    detailed(text, [given, written], until, Detail::Events)
}

fn detailed(text: &str, [given, written]: [&CommandLog; 2], until: Instant, detail: Detail) -> Log {
    let scenario = Scenario::parse("steered.toml", text).expect("a scenario");
    let run = CampaignRun::new(scenario, 0);
    let mut provenance = Campaign::provenance(&run);
    provenance.attachments.push(written.attachment());
    let mut bytes = LogBytes::new(&provenance, detail).expect("a log");
    let metrics = given.simulate(&run, until, &mut bytes).expect("a run");
    let end = RunEnd::at(until, run.scenario.duration);
    Log::read(Path::new("steered.mcap"), bytes.finish(&metrics, end).expect("a log")).expect("a log")
}

#[test]
fn a_run_under_other_commands_than_those_of_its_log_is_not_drawn() {
    let given = commands(&[(1.0, 0.5), (3.0, -0.1), (5.0, 0.2)]);
    let fewer = commands(&[(1.0, 0.5), (5.0, 0.2)]);
    let path = Path::new("steered.mcap");
    for (text, name) in [(ONE_ANGLE, "angle"), (THREE_AXES, "pointing")] {
        for until in [Instant::END, at(7.5)] {
            figures::log_figure(&log(text, &given, &given, until), path, name, None).expect("the same run");
            let fault = figures::log_figure(&log(text, &given, &fewer, until), path, name, None);
            let fault = fault.err().expect("another run");
            let words = [
                "repeats another run than that of this log",
                "its metric `",
                "hint: a log made with `--log full`",
            ];
            assert!(words.iter().all(|words| fault.contains(words)), "{fault}");
        }
    }
}

/// A log whose run cannot be repeated is answered from its rows, and says so: with their largest error, and the values of its metrics.
#[test]
fn a_log_that_cannot_be_repeated_is_answered_from_its_rows() {
    let required =
        "\n[[requirement]]\nname = \"end\"\nquantity = \"pointing_error_end_rad\"\nlimit = \"0.001 deg\"\n";
    let text = format!("{THREE_AXES}\n[log]\nperiod = 0.5\n") + required;
    let (given, none) = (commands(&[(1.0, 0.5), (3.0, -0.1)]), CommandLog::default());
    let (path, units) = (Path::new("steered.mcap"), ReaderUnits::default());
    let answer = |log: &Log| flexsc_cli::answer_of_log(log, path, units).expect("an answer").1;
    let repeated = answer(&detailed(&text, [&given, &given], Instant::END, Detail::Full));
    let log = detailed(&text, [&given, &none], Instant::END, Detail::Full);
    let from_rows = answer(&log);
    assert_eq!((repeated.from_rows_s, from_rows.from_rows_s), (None, Some(0.5)));
    assert_eq!(from_rows.requirements[0].value, repeated.requirements[0].value);
    assert_eq!(from_rows.verdict, RunVerdict::Missed);
    let screen = from_rows.screen(None, ScreenOptions::default());
    assert!(screen.contains("10 s, from rows every 0.5 s"), "{screen}");
    // The body drifts away from its target: the row at the end has the largest error.
    let columns = log.columns("/pointing").expect("rows");
    let error = |row: usize| {
        let axes = ["roll_error_rad", "pitch_error_rad", "yaw_error_rad"];
        axes.map(|name| columns.numbers(name).expect("a column")[row])
            .iter()
            .map(|own| own * own)
            .sum::<f64>()
            .sqrt()
    };
    let largest = units.fitting(error(20), "rad").number(error(20));
    let line = from_rows.lines.iter().find(|line| line.head == "pointing").expect("a line");
    assert!(line.text.contains(&format!("largest {largest} at 10 s")), "{}: {largest}", line.text);
}

#[test]
fn a_repeated_run_is_noted_and_rows_are_not_repeated() {
    let dir = Dir::with(&["relay-fixed", "iss-ringdown"]);
    for (name, figure, topic) in
        [("relay-fixed", "angle", "/attitude"), ("iss-ringdown", "energy", "/energy")]
    {
        for detail in ["events", "full"] {
            dir.run(&format!("simulate {name}.toml --set duration=60 --log {detail} -o {detail}")).exits(0);
        }
        let note = format!("note: repeats the run, because events/{name}.mcap has no rows of {topic}\n");
        let plot = |detail: &str, more: &str| {
            dir.run(&format!("plot {detail}/{name}.mcap --what {figure} --format svg -o {detail} {more}"))
                .exits(0)
        };
        assert_eq!(plot("events", "").err.matches(&note).count(), 1);
        assert!(!plot("full", "").err.contains("note: "));
        assert_eq!(plot("events", "--json").err, "");
    }
}

#[test]
fn decisions_and_pulses_are_drawn_from_the_rows_of_any_log() {
    let dir = Dir::with(&["iss-ringdown", "wheels-and-jets", "relay-adaptive"]);
    for (name, figure) in [("iss-ringdown", "jets"), ("wheels-and-jets", "jets"), ("relay-adaptive", "gain")]
    {
        let svg = |detail: &str| {
            dir.run(&format!("simulate {name}.toml --set duration=1500 --log {detail} -o {detail}")).exits(0);
            let drawn = dir
                .run(&format!("plot {detail}/{name}.mcap --what {figure} --format svg -o {detail}"))
                .exits(0);
            assert!(!drawn.err.contains("note: "), "{}", drawn.err);
            dir.text(&format!("{detail}/{name}-{figure}.svg"))
        };
        assert!(svg("events") == svg("full"), "{name}");
    }
}
