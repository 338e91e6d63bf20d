//! Logs of runs with custom parts: drawn, laid out and exported from their rows, without the parts.

use std::path::Path;
use std::sync::Arc;

use flexsc_cli::figures;
use flexsc_core::Scenario;
use flexsc_core::campaign::{CampaignRun, CommandLog};
use flexsc_core::control::adaptation::AdaptationSpec;
use flexsc_core::control::custom::Custom;
use flexsc_core::numerics::time::Instant;
use flexsc_core::record::{Detail, Log};
use flexsc_core::scenario::CustomParts;

use super::{ONE_ANGLE, RELAY, THREE_AXES, adaptation, of_own_parts};
use crate::util::Dir;

/// Returns the log of a scenario's run.
pub fn logged(scenario: &Scenario, detail: Detail) -> Log {
    let run = CampaignRun::new(scenario.clone(), 0);
    figures::log_of(&run, &CommandLog::default(), Instant::END, detail).expect("a log")
}

/// Returns the relay study with an adaptation of its own.
fn climbing() -> Scenario {
    let own: Custom<dyn AdaptationSpec> =
        Custom::new(Arc::new(adaptation::Climber { step: 0.01, most: 1.0 }));
    let parts = CustomParts { adaptation: Some(own), ..CustomParts::default() };
    let plain = Scenario::parse("relay.toml", RELAY).expect("a scenario");
    plain.with_custom_parts(parts).expect("it fits")
}

#[test]
fn a_full_log_is_drawn_without_the_parts_as_with_them() {
    let path = Path::new("own.mcap");
    for shown in ["angle", "pointing", "gain"] {
        let study = match shown {
            "angle" => of_own_parts(ONE_ANGLE),
            "pointing" => of_own_parts(THREE_AXES),
            _ => climbing(),
        };
        let log = logged(&study, Detail::Full);
        let names = figures::names(&log, path, None).expect("figures");
        assert_eq!(names, figures::names(&log, path, Some(&study)).expect("figures"));
        assert!(names.iter().any(|name| name == shown), "{names:?}");
        for name in names {
            let svg = |known| {
                let figure = figures::log_figure(&log, path, &name, known).expect("a figure");
                figure.svg().expect("a picture")
            };
            assert!(svg(None) == svg(Some(&study)), "{name}");
        }
    }
}

#[test]
fn a_log_of_events_is_drawn_where_the_parts_are() {
    let path = Path::new("own.mcap");
    for (study, name, topic) in
        [(of_own_parts(ONE_ANGLE), "angle", "/attitude"), (of_own_parts(THREE_AXES), "pointing", "/pointing")]
    {
        let log = logged(&study, Detail::Events);
        let fault = figures::log_figure(&log, path, name, None).err().expect("no rows");
        let words = [
            format!("own.mcap: has no rows of {topic}"),
            "only the program of its parts (law, sensor, estimator, actuator) can repeat its run".to_owned(),
            "hint: a log made with `--log full`".to_owned(),
        ];
        assert!(words.iter().all(|words| fault.contains(words)), "{fault}");
        figures::log_figure(&log, path, name, Some(&study)).expect("a figure of the repeated run");
    }
}

#[test]
fn the_command_draws_lays_out_and_exports_a_log_of_own_parts() {
    for (text, topic) in [(ONE_ANGLE, "/attitude.angle_rad"), (THREE_AXES, "/pointing.roll_error_rad")] {
        let study = of_own_parts(text);
        let dir = Dir::holding("own.mcap", logged(&study, Detail::Full).bytes());
        let drawn = dir.run("plot own.mcap --format svg -o figures").exits(0);
        assert!(!drawn.err.contains("repeats the run"), "{}", drawn.err);
        assert!(dir.names("figures").len() > 2);
        dir.run("layout own.mcap -o layout.json").exits(0);
        let layout = dir.text("layout.json");
        for path in [topic, "/pid.integral", "/encoder.x", "/alpha_beta.innovation", "/servo.travel"] {
            assert!(layout.contains(path), "no panel shows {path}");
        }
        dir.run("export own.mcap -o own.glb").exits(0);
        assert!(dir.size("own.glb") > 1000);
        dir.write("events.mcap", logged(&study, Detail::Events).bytes());
        let refused = dir.run("plot events.mcap -o more").exits(2);
        refused.says(&["only the program of its parts", "hint: a log made with `--log full`"]);
        assert!(!dir.has("more"));
    }
}
