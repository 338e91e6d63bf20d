//! Requirements over time: known motions, modes and events, rows that do not matter, campaigns, and errors at their places.

use flexsc_core::metrics::{MetricValue, Metrics, MetricsCollector};
use flexsc_core::record::{Detail, Trace};
use flexsc_core::{Scenario, Simulation};

use serde_json::Value as Json;

use crate::util::Dir;

/// One undamped mode beside a fixed angle: the sensor has 1e-4 + 3e-4 cos(2 t) (rad).
const WAVE: &str = r#"
name = "wave"
duration = 100.0
log.period = 1.0

[body.planar]
angle = 1e-4
modes = [{ frequency = 2.0, gain = 1.0, displacement = 3e-4, damping = 0.0 }]

[sensor.sampled]
period = 10.0

[law.open]
"#;

/// A body that turns about z by 0.01 rad/s, away from its inertial reference.
const SPIN: &str = r#"
name = "spin"
duration = 100.0
log.period = 7.0

[spacecraft]
mass = 10.0
inertia = [[1.0, 0, 0], [0, 1.0, 0], [0, 0, 2.0]]
rate = [0, 0, 0.01]
points = [{ name = "hub" }]

[sensor.sampled]
period = 1.0

[law.open]
"#;

/// A free spacecraft whose panel vibrates about x: the hub starts and ends its half period near 0 rad.
const RING: &str = r#"
name = "ring"
duration = 2.2

[spacecraft]
mass = 100.0
inertia = [[70.0, 0, 0], [0, 50.0, 0], [0, 0, 60.0]]
attitude_error = [0, 0, 5e-4]
rate = [0, 0, -1e-4]
points = [{ name = "hub" }]

# It does next to nothing, but begins a segment.
[[disturbance]]
torque = 1e-15
about = "roll"
from = 0.2

[[appendage]]
name = "panel"
mass = 10.0
inertia = [[30.0, 0, 0], [0, 5.0, 0], [0, 0, 30.0]]
modes = [{ frequency = 1.2, damping = 0.005, rotation = [5.0, 0, 0], rate = 0.01 }]

[sensor.sampled]
period = 10.0

[law.open]
"#;

/// A spacecraft enters the Earth's shadow, in which its panel bends at once and vibrates about its new shape.
const SNAP: &str = r#"
name = "snap"
duration = 40.0

[spacecraft]
mass = 100.0
inertia = [[70.0, 0, 0], [0, 50.0, 0], [0, 0, 60.0]]
points = [{ name = "hub" }]

[[appendage]]
name = "panel"
mass = 10.0
inertia = [[30.0, 0, 0], [0, 5.0, 0], [0, 0, 30.0]]
modes = [{ frequency = 1.2, damping = 1e-6, rotation = [5.0, 0, 0] }]
thermal = { deflection = [1e-3], time_constant = 1e-3 }

[environment]
orbit = { semi_major_axis = 6.878137e6, anomaly = 1.93 }
sun = [1, 0, 0]
shadow = "cylinder"

[sensor.sampled]
period = 1000.0

[law.open]
"#;

/// Two modes of operation on one axis: `fine` from 20 s to 50 s, and from 70 s on.
const MODES: &str = r#"
name = "modes"
duration = 100.0

[body.planar]
angle = 1e-3
inertia = 100.0

[sensor.sampled]
period = 0.1
noise = 1e-5

[[mode]]
name = "coarse"
law.pd = { k_p = 1.0, k_d = 20.0, period = 0.1 }
leave = [{ to = "fine", when = "time > 20" }]

[[mode]]
name = "fine"
law.pd = { k_p = 25.0, k_d = 70.0, period = 0.1 }
leave = [{ to = "coarse", when = "time > 30" }]

[[mode]]
name = "safe"
law.pd = { k_p = 1.0, k_d = 20.0, period = 0.1 }
"#;

fn holding(text: &str, requirements: &[&str]) -> String {
    let table = |(index, keys): (usize, &&str)| format!("\n[[requirement]]\nname = \"{index}\"\n{keys}\n");
    text.to_owned() + &requirements.iter().enumerate().map(table).collect::<String>()
}

fn metrics(text: &str, detail: Option<Detail>) -> Metrics {
    let scenario = Scenario::parse("study.toml", text).expect("valid");
    let mut metrics = MetricsCollector::new(&scenario);
    let mut simulation = Simulation::new(&scenario, 0);
    match detail {
        Some(detail) => simulation.run(&mut (&mut metrics, &mut Trace::new(detail))),
        None => simulation.run(&mut metrics),
    }
    .expect("a run");
    metrics.finish(&scenario)
}

fn numbers(metrics: &Metrics, name: &str) -> Vec<f64> {
    metrics.get(name).map(MetricValue::numbers).expect("a list")
}

/// Compares numbers, NaN included.
fn assert_near(found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        let is_near = (found - expected).abs() <= tolerance || found.is_nan() && expected.is_nan();
        assert!(is_near, "{found:e} is not {expected:e}");
    }
}

#[test]
fn the_motion_counts_and_not_its_rows() {
    let text = holding(
        WAVE,
        &[
            "holds = \"always[1, 100] pointing_error < 5e-4\"",
            "holds = \"eventually[0, 20] always[0, 1] pointing_error < 3e-4\"",
            "holds = \"truth.rate < 7e-4\"",
            "holds = \"pointing_error < 5e-4 until[1, 3] truth.rate < 1e-5\"",
        ],
    );
    let found = metrics(&text, None);
    // Largest 4e-4, first at pi. A window of 1 s about a trough at pi/2 has 2e-4 there. The rate has 6e-4 at pi/4.
    // The rate is 0 at pi/2, until when the start has the largest angle: 1 - 4e-4/5e-4.
    let pi = std::f64::consts::PI;
    assert_near(&numbers(&found, "requirement_values"), &[4e-4, 2e-4, 6e-4, 0.8], 1e-13);
    let times = numbers(&found, "requirement_times_s");
    assert!((times[0] / pi).fract().min(1.0 - (times[0] / pi).fract()) < 1e-6, "{times:?}");
    // Rows of a log, and stops, change nothing.
    let logged = metrics(&text, Some(Detail::Full));
    for name in ["requirement_values", "requirement_times_s"] {
        assert_eq!(numbers(&logged, name), numbers(&found, name));
    }
    let scenario = Scenario::parse("study.toml", &text).expect("valid");
    let mut stopped = MetricsCollector::new(&scenario);
    let mut simulation = Simulation::new(&scenario, 0);
    for step in 1..200 {
        let at = flexsc_core::numerics::time::Span::from_seconds(0.73 * f64::from(step));
        let at = flexsc_core::numerics::time::Instant::START + at;
        simulation.run_until(at, &mut stopped).expect("a part of the run");
    }
    assert_eq!(
        numbers(&stopped.finish(&scenario), "requirement_values"),
        numbers(&found, "requirement_values")
    );
}

#[test]
fn a_turn_about_three_axes_is_followed_exactly() {
    let text = holding(
        SPIN,
        &[
            "holds = \"always[0, 33.3] pointing_error < 0.6\"",
            "holds = \"always[0, 40] (pointing_error < 0.3 or truth.rate > 0.005)\"",
            "holds = \"when pointing_error > 0.25: within 10 s, for 5 s: pointing_error < 0.5\"",
            "holds = \"truth.rate_error < 0.02\"",
        ],
    );
    let found = metrics(&text, None);
    // 0.333 rad; 1 - 1 of the rate; 0.3 rad 5 s after the crossing at 25 s; 0.01 rad/s.
    assert_near(&numbers(&found, "requirement_values"), &[0.333, 0.0, 0.3, 0.01], 1e-10);
    let times = numbers(&found, "requirement_times_s");
    assert_near(&[times[0], times[2]], &[33.3, 30.0], 1e-6);
    assert_eq!(
        numbers(&metrics(&text, Some(Detail::Full)), "requirement_values"),
        numbers(&found, "requirement_values")
    );
}

#[test]
fn the_crest_of_a_vibration_counts_between_the_ends_of_a_segment() {
    let text = holding(RING, &["holds = \"always pointing_error < 5.1e-4\""]);
    let found = metrics(&text, None);
    // J angle + r q = 0 of the hub with the panel's mode, and 1 - r²/J of its modal mass remains. About yaw the body turns steadily.
    let (inertia, coupling, rate) = (100.0, 5.0, 0.01);
    let free = f64::sqrt(1.0 - coupling * coupling / inertia);
    let (frequency, damping): (f64, f64) = (1.2 / free, 0.005 / free);
    let root = f64::sqrt(1.0 - damping * damping);
    let error = |t: f64| {
        let decay = f64::exp(-damping * frequency * t);
        let roll = coupling / inertia * rate / (frequency * root) * decay * f64::sin(frequency * root * t);
        roll.hypot(5e-4 - 1e-4 * t)
    };
    let largest = (0..=22_000).map(|k| error(1e-4 * f64::from(k))).fold(0.0, f64::max);
    // The largest error of the first segment, 5e-4 at its start, is above both ends of the second.
    assert!(error(0.2) < 4.95e-4 && error(2.2) < 4e-4 && largest > 5.2e-4, "{largest:e}");
    assert_near(&numbers(&found, "requirement_values"), &[largest], 1e-6 * largest);
    let dir = Dir::new();
    dir.write("ring.toml", &text);
    dir.run("simulate ring.toml --log none").exits(3).says(&["MISSED: 1 of 1 requirement"]);
}

#[test]
fn the_crest_after_a_thermal_snap_counts_between_the_ends_of_a_segment() {
    let holds = ["holds = \"always truth.sunlight > 0.5\"", "holds = \"always pointing_error < 8e-5\""];
    let shadow = numbers(&metrics(&holding(SNAP, &holds[..1]), None), "requirement_times_s")[0];
    assert!(shadow > 15.0 && shadow < 30.0, "{shadow}");
    // J angle + r q = 0, and 1 - r²/J of the modal mass remains: q = d (1 - cos(W t)) is 0 again after a period.
    let (inertia, coupling, deflection) = (100.0, 5.0, 1e-3);
    let frequency = 1.2 / f64::sqrt(1.0 - coupling * coupling / inertia);
    let end = shadow + 2.0 * std::f64::consts::PI / frequency;
    // The error about yaw, the largest before the shadow, is 0 there: both ends of what follows are near 0.
    let (yaw, middle) = (7e-5, f64::midpoint(shadow, end));
    let text = SNAP.replace("duration = 40.0", &format!("duration = {end:?}"));
    let turning = format!("attitude_error = [0, 0, {yaw:?}]\nrate = [0, 0, {:?}]\npoints", -yaw / shadow);
    let found = metrics(&holding(&text.replacen("points", &turning, 1), &holds[1..]), None);
    let largest = f64::hypot(2.0 * deflection * coupling / inertia, yaw * (middle / shadow - 1.0));
    assert_near(&numbers(&found, "requirement_values"), &[largest], 1e-5 * largest);
    assert_near(&numbers(&found, "requirement_times_s"), &[middle], 0.01);
}

#[test]
fn modes_and_events_select_the_time() {
    let dir = Dir::new();
    dir.write(
        "good.toml",
        holding(
            MODES,
            &[
                "holds = \"pointing_error < 6e-4\"\nmode = \"fine\"",
                "holds = \"pointing_error < 1e-4\"\nafter = \"mode enters fine\"\nwithin = \"10 s\"\nfor = \"15 s\"",
                "holds = \"when mode enters safe: within 5 s: pointing_error < 1e-9\"",
                "holds = \"always[25 s, 45 s] mode(fine)\"",
                "quantity = \"pointing_error\"\nmode = \"fine\"\nlevel = 0.95\ninterpretation = \"temporal\"\nlimit = 6e-4",
                "quantity = \"pointing_error\"\nmode = \"safe\"\nlimit = 1e-9",
                "holds = \"always (mode(coarse) implies estimate.attitude_error < 2e-3)\"",
            ],
        ),
    );
    dir.run("simulate good.toml --log none --all").exits(0).says(&[
        "5 of 7 requirements met, 2 not exercised",
        "- 2",
        "not exercised",
        "pointing_error < 6e-4, in mode fine",
        "after mode enters fine, within 10 s, for 15 s: pointing_error < 1e-4",
        "APE of the pointing error, from 0 to 100 s, in mode fine, 95 % temporal",
    ]);
    let bad =
        holding(MODES, &["holds = \"when mode enters fine: within 60 s, for 30 s: pointing_error < 1e-3\""]);
    dir.write("bad.toml", &bad);
    // The second entry is at 70 s.
    dir.run("simulate bad.toml --log none").exits(3).says(&[
        "undecided: 1 of 1 requirement",
        "undecided, the run ends too early",
        "modes: 0 is undecided",
    ]);
    dir.write("missed.toml", bad.replace("1e-3", "1e-9"));
    dir.run("simulate missed.toml --log none").exits(3).says(&["MISSED: 1 of 1 requirement", "decided at"]);
}

#[test]
fn campaigns_count_what_decides_and_stop_when_it_has() {
    let dir = Dir::new();
    let drawn = "\n[uncertain]\n\"body.planar.angle\" = { uniform = [0.0, 1e-3] }\n";
    let text = |keys: &str| holding(MODES, &[keys]) + drawn;
    dir.write("all.toml", text("holds = \"always[60 s, end] pointing_error < 2e-4\""));
    let one = dir.run("simulate all.toml --runs 12 --jobs 1 --json").exits(0).printed();
    assert_eq!(one, dir.run("simulate all.toml --runs 12 --jobs 3 --json").exits(0).printed());
    let half = "holds = \"always[0, 1] pointing_error < 5e-4\"";
    dir.write("half.toml", text(half));
    dir.run("simulate half.toml --runs 40 --until-decided").exits(3).says(&[
        "decided after ",
        " of 40 runs",
        "MISSED",
    ]);
    dir.write("level.toml", text(&format!("{half}\nlevel = 0.2")));
    dir.run("simulate level.toml --runs 40 --until-decided").exits(0).says(&["decided after ", "median"]);
    dir.write(
        "idle.toml",
        text("holds = \"when pointing_error > 5e-4: within 60 s: pointing_error < 1e-4\""),
    );
    dir.run("simulate idle.toml --runs 20").exits(0).says(&["not exercised"]);
    dir.run("simulate idle.toml --runs 20 --until-decided -o out").exits(2).says(&["--until-decided"]);
    dir.run("worst half.toml --requirement 0 --points 20").exits(3).says(&["missed"]);
}

/// A rigid body whose sampled law settles from 0.01 rad.
const AIM: &str = r#"
name = "aim"
duration = 60.0

[body.planar]
angle = 0.01
inertia = 100.0

[sensor.sampled]
period = 0.1

[law.pd]
k_p = 4.0
k_d = 20.0
period = 0.1
"#;

#[test]
fn a_law_is_tuned_for_a_requirement_over_time() {
    let dir = Dir::new();
    let keys = "holds = \"pointing_error < 1e-3\"\nwithin = \"20 s\"\nfor = \"30 s\"";
    let text = holding(AIM, &[keys]);
    dir.write("aim.toml", &text);
    let value = |k_d: f64| {
        let text = text.replace("k_d = 20.0", &format!("k_d = {k_d:?}"));
        numbers(&metrics(&text, None), "requirement_values")[0]
    };
    let line = "tune aim.toml --vary law.pd.k_d=5:60 --objective 0 --json";
    let tuned = dir.run(line).exits(0).json();
    let number = |pointer: &str| tuned.pointer(pointer).and_then(Json::as_f64).expect("a number");
    let (k_d, after) = (number("/keys/0/after"), number("/measures/0/after"));
    assert_near(&[number("/measures/0/before"), after], &[value(20.0), value(k_d)], 1e-12);
    let best = (0..56).map(|k| value(5.0 + f64::from(k))).fold(f64::INFINITY, f64::min);
    assert!(after <= best && after < 0.5 * value(20.0), "{after:e} at {k_d}, {best:e}");
    let kept = "tune aim.toml --vary law.pd.k_d=5:60 --keep 0";
    dir.run(kept).exits(0).says(&["206.3 arcsec"]);
    dir.write(
        "zero.toml",
        holding(
            AIM,
            &["holds = \"time > 3 implies pointing_error < 0.1\"", "holds = \"pointing_error < 0\""],
        ),
    );
    dir.run("tune zero.toml --vary law.pd.k_d=5:60 --objective 1")
        .exits(2)
        .says(&["requirement[1]", "not above 0"]);
}

#[test]
fn the_figure_of_a_requirement_names_what_decides() {
    let dir = Dir::new();
    let after =
        "holds = \"pointing_error < 1e-4\"\nafter = \"mode enters fine\"\nwithin = \"10 s\"\nfor = \"15 s\"";
    let all = [
        "holds = \"pointing_error < 2e-3\"",
        after,
        "holds = \"when mode enters fine: within 5 s: mode(fine)\"",
        "holds = \"always not mode(safe)\"",
    ];
    dir.write("modes.toml", holding(MODES, &all));
    dir.run("simulate modes.toml").exits(0);
    dir.run("plot modes.mcap --what requirement -o all.svg").exits(0).says(&["repeats the run"]);
    let drawn = dir.text("all.svg");
    for words in [
        "R1 0: robustness",
        "R2 1: robustness",
        "R3 2: robustness",
        "decides at",
        "condition holds",
        "counts",
    ] {
        assert!(drawn.contains(words), "{words}");
    }
    dir.run("plot modes.mcap --what requirement:R2 -o one.svg").exits(0);
    let one = dir.text("one.svg");
    assert!(one.contains("R2 1: robustness") && !one.contains("R1 0"), "{one}");
    // A flag that never holds has its panel.
    dir.run("plot modes.mcap --what requirement:R4 -o never.svg").exits(0);
    assert!(dir.text("never.svg").contains("R4 3: robustness"));
    dir.run("plot modes.mcap --what requirement --what requirement:R2 -o both.svg").exits(0);
    assert!(dir.text("both.svg").contains("R1 0: robustness"));
    dir.run("plot modes.mcap --what requirement:R9").exits(2).says(&["requirement:R9", "R2 (1)"]);
}

#[test]
fn requirements_become_sentences_of_fret() {
    let dir = Dir::new();
    let cases = [
        ("holds = \"pointing_error < 6e-5\"", "the modes shall always satisfy (pointing_error < 6e-5)"),
        (
            "holds = \"pointing_error < 6e-4\"\nmode = \"fine\"",
            "while mode_fine the modes shall always satisfy (pointing_error < 0.0006)",
        ),
        (
            "holds = \"always[60 s, 300 s] (truth.rate <= 2 or not mode(fine))\"",
            "while ((run_time >= 60) & (run_time <= 300)) the modes shall always satisfy ((truth_rate <= 2) | (! mode_fine))",
        ),
        (
            "holds = \"eventually[0, 1 min] mode(fine)\"",
            "the modes shall within 60 seconds satisfy mode_fine",
        ),
        ("holds = \"eventually mode(fine)\"", "the modes shall eventually satisfy mode_fine"),
        (
            "holds = \"when silent(sampled) > 3: within 10 s: mode(safe)\"",
            "upon (silent_sampled > 3) the modes shall within 10 seconds satisfy mode_safe",
        ),
        (
            "holds = \"when mode enters fine: for 30 s: estimate.rate < 0.1\"",
            "upon mode_fine the modes shall for 30 seconds satisfy (estimate_rate < 0.1)",
        ),
        (
            "holds = \"when mode enters fine: always estimate.rate < 0.1\"",
            "upon mode_fine the modes shall always satisfy (estimate_rate < 0.1)",
        ),
        (
            "holds = \"when mode enters fine: estimate.rate < 0.1\"",
            "upon mode_fine the modes shall immediately satisfy (estimate_rate < 0.1)",
        ),
        (
            "holds = \"when mode enters fine: within 60 s, for 30 s: mode(fine)\"",
            "\"when mode enters fine: within 60 s, for 30 s: mode(fine)\"",
        ),
        ("holds = \"mode(coarse) until[0, 60] mode(fine)\"", "\"mode(coarse) until[0, 60] mode(fine)\""),
        ("holds = \"time_outside_s < 1 min\"", "\"time_outside_s, at most 1 min\""),
    ];
    dir.write("modes.toml", holding(MODES, &cases.map(|(keys, _)| keys)));
    let printed = dir.run("export modes.toml --format fret").exits(0);
    let printed = printed
        .says(&["R10 is text alone", "one operator over time", "R11", "until", "R12", "one value"])
        .printed();
    let file: Json = serde_json::from_str(&printed).expect("JSON");
    let texts = file["requirements"].as_array().expect("a list").iter();
    let texts: Vec<&str> = texts.map(|own| own["fulltext"].as_str().expect("a text")).collect();
    assert_eq!(texts, cases.map(|(_, text)| text));
    let variables = file["variables"].as_array().expect("a list").iter();
    let kinds: Vec<String> = variables
        .map(|own| format!("{} {} {}", own["variable_name"], own["dataType"], own["description"]))
        .collect();
    assert!(kinds.contains(&r#""estimate_rate" "double" "estimate.rate (rad/s)""#.to_owned()), "{kinds:?}");
    assert!(kinds.contains(&r#""mode_fine" "boolean" "mode(fine)""#.to_owned()), "{kinds:?}");
    dir.run("simulate modes.toml -o run.mcap");
    dir.run("export run.mcap -o log.json").exits(0);
    assert_eq!(dir.text("log.json"), printed);
    dir.write("bare.toml", MODES);
    dir.run("export bare.toml -o bare.json").exits(2).says(&["has no [[requirement]]"]);
    dir.run("export modes.toml -o a.json --speed 3").exits(2).says(&["--speed"]);
}

#[test]
fn what_cannot_be_read_is_refused_at_its_place() {
    let dir = Dir::new();
    for (keys, expected, place) in [
        ("holds = \"always[60, 30] pointing_error < 1\"", "ends at 30 s, before it starts", "^^^^^^^^"),
        ("holds = \"always[60 pointing_error < 1\"", "has a bracket that is not closed", "^"),
        ("holds = \"always pointing_eror < 1\"", "did you mean `pointing_error`?", "^^^^^^^^^^^^^"),
        ("holds = \"rate < 1\"", "must be `estimate.rate` or the truth, `truth.rate`", "^^^^"),
        ("holds = \"pointing_error < 1 s\"", "has the unit `s`", "^^^"),
        (
            "holds = \"when mode enters cruise: pointing_error < 1\"",
            "must name one of the modes, `coarse`",
            "^^^^^^",
        ),
        ("holds = \"always (mode(fine) until[0, 2] mode(safe))\"", "cannot be within `always`", "^^^^^"),
        ("holds = \"when always mode(fine): mode(safe)\"", "cannot be in an event", "^^^^^^"),
        (
            "holds = \"(mode(fine) until mode(safe)) until mode(coarse)\"",
            "cannot be within `until`",
            "^^^^^^^^^^^^^^^^^^^^^^^^^^^^^",
        ),
        ("holds = \"mode(fine) until when mode(safe): mode(coarse)\"", "cannot be within `always`", "^^^^"),
        ("holds = \"estimate.mode(fine)\"", "must be `mode`, got `estimate.mode`", "^^^^^^^^^^^^^"),
        ("holds = \"estimate.rat < 1\"", "did you mean `estimate.rate`?", "^^^^^^^^^^^^"),
        ("holds = \"mode(fine) within 3 s\"", "must end or go on with", "^^^^^^"),
        ("holds = \"when mode enters fine pointing_error < 1\"", "needs a `:`", "^^^^"),
        ("holds = \"blinded(sampled)\"", "which nothing blinds", ""),
        ("holds = \"pointing_error < 0 and mode(fine)\"", "compares with 0 beside other conditions", ""),
        ("holds = \"settling_time_s < 3 and mode(fine)\"", "has one value in a run", ""),
        ("holds = \"mode(fine)\"\nlimit = 1", "must be left out beside `holds`", ""),
        (
            "holds = \"always mode(fine)\"\nmode = \"fine\"",
            "is for a `holds` without operators over time",
            "",
        ),
        ("holds = \"mode(fine)\"\nduring = \"mode(fien)\"", "must name one of the modes", "^^^^"),
        ("holds = \"mode(fine)\"\nduring = \"mode enters fine\"", "needs a mode in brackets", "^^^^"),
        ("holds = \"mode(fine)\"\nduring = \"always mode(fine)\"", "in `during`", "^^^^^^"),
        ("quantity = \"pointing_error\"\nlimit = 1\nwithin = 3", "is for `holds`: write", ""),
        ("quantity = \"settling_time_s\"\nlimit = 1\nmode = \"fine\"", "the quantity is the metric", ""),
        ("limit = 1", "a `quantity` with its `limit`, or `holds`", ""),
        ("holds = \"mode(fine)\"\ninterpretation = \"temporal\"", "is `ensemble`", ""),
    ] {
        dir.write("bad.toml", holding(MODES, &[keys]));
        dir.run("check bad.toml").exits(2).says(&[expected, "requirement[0]", "bad.toml:", place]);
    }
    dir.write("mode.toml", MODES.replace("time > 20", "always time > 20"));
    dir.run("check mode.toml").exits(2).says(&["is for requirements", "^^^^^^"]);
    dir.write("metric.toml", holding(MODES, &["holds = \"time_outside_s < 1 min\""]));
    dir.run("simulate metric.toml --log none").exits(0).says(&["at most 1 min"]);
    dir.write("absent.toml", holding(MODES, &["holds = \"fuel_kg < 1\""]));
    dir.run("check absent.toml")
        .exits(2)
        .says(&["requirement[0].holds", "runs of this scenario do not have"]);
}
