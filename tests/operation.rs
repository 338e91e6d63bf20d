//! Modes of operation: their changes are those of the conditions on the logged quantities, modes that end by time are
//! stages, and what does not fit is refused.

use flexsc_core::metrics::MetricValue;
use flexsc_core::record::{Column, Detail, Trace};
use flexsc_core::{Scenario, Simulation};

use crate::study::{pairs, scenario as shipped};
use crate::traces::{self, column, flown, traced, within};
use crate::util::Dir;

fn scenario(text: &str) -> Scenario {
    Scenario::parse("modes.toml", text).unwrap_or_else(|error| panic!("{error}"))
}

fn refused(text: &str) -> String {
    match Scenario::parse("modes.toml", text) {
        Ok(_) => panic!("accepted: {text}"),
        Err(error) => error.to_string(),
    }
}

/// Returns the times of the changes (s) and the modes that begin there.
fn modes(trace: &Trace) -> Vec<(f64, String)> {
    let Some(Column::Texts(names)) = trace.topic("/mode").and_then(|rows| rows.get("mode")) else { panic!() };
    column(trace, "/mode", "time_s").iter().copied().zip(names.clone()).collect()
}

/// Every number of some topics is equal to the bit.
fn agree(a: &Trace, b: &Trace, topics: &[&str]) {
    for topic in topics {
        let (one, other) = (a.topic(topic).expect("rows"), b.topic(topic).expect("rows"));
        assert_eq!(format!("{:?}", one.columns), format!("{:?}", other.columns), "{topic}");
    }
}

const STAGES: &str = "[[law.stages]]\nlaw.b_dot = { period = 1.0, gain = 8e5 }                                # s, A m² s/T\n\
                      [[law.stages]]\nfrom = 6000.0                           # s\n";

/// Modes that end by time are the stages of a law: the motion and the filter are equal to the bit.
#[test]
fn modes_that_end_by_time_are_stages() {
    let text = std::fs::read_to_string(format!("{}/detumble-and-point.toml", crate::util::SCENARIOS))
        .expect("a file");
    let text = text.replace("duration = 12000.0", "duration = 700.0").replace("12000.0]", "700.0]");
    let staged = text.replace("from = 6000.0", "from = 300.0");
    let head = "[[mode]]\nname = \"one\"\nlaw.b_dot = { period = 1.0, gain = 8e5 }\n\
                leave = [{ to = \"two\", when = \"time >= 5 min\" }]\n[[mode]]\nname = \"two\"\n";
    let moded = text.replace(STAGES, head);
    assert!(staged != text && moded != text);
    let [staged, moded] = [staged, moded].map(|text| traced(&scenario(&text)));
    assert_eq!(modes(&moded), [(0.0, "one".to_owned()), (300.0, "two".to_owned())]);
    agree(
        &staged,
        &moded,
        &["/pointing", "/rates", "/energy", "/wheels", "/magnetorquers", "/attitude_filter"],
    );
}

const BODY: &str = "duration = 30.0\n[body.planar]\ninertia = 100.0\nangle = 2e-3\nrate = 1e-4\n[log]\nperiod = 0.5\n\
                    [[actuator]]\nthrusters = { torque = 0.5, period = 0.5 }\n[[actuator]]\nhold = { period = 0.25 }\n";
const LAW: &str = "law.pd = { k_p = 4.0, k_d = 30.0, period = 0.5 }";

/// Of two conditions that are met at one sample, the first as written ends the mode.
#[test]
fn the_first_condition_in_order_ends_the_mode() {
    for [first, second] in [["b", "c"], ["c", "b"]] {
        let text = format!(
            "{BODY}[[mode]]\nname = \"a\"\n{LAW}\nactuators = [\"thrusters\"]\n\
             leave = [{{ to = \"{first}\", when = \"run_time >= 10\" }}, {{ to = \"{second}\", when = \"run_time > 9\", for = 0.5 }}]\n\
             [[mode]]\nname = \"b\"\n{LAW}\nactuators = [\"thrusters\"]\n[[mode]]\nname = \"c\"\n{LAW}\nactuators = [\"thrusters\"]\n"
        );
        assert_eq!(modes(&traced(&scenario(&text)))[1], (10.0, first.to_owned()));
    }
}

#[test]
fn actuators_change_with_the_mode_as_with_the_stage() {
    let staged = format!(
        "{BODY}[[law.stages]]\n{LAW}\nactuators = [\"thrusters\"]\n[[law.stages]]\nfrom = 10.0\n{LAW}\nactuators = [\"hold\"]\n"
    );
    let moded = format!(
        "{BODY}[[mode]]\nname = \"a\"\n{LAW}\nactuators = [\"thrusters\"]\nleave = [{{ to = \"b\", when = \"run_time >= 10\" }}]\n\
         [[mode]]\nname = \"b\"\n{LAW}\nactuators = [\"hold\"]\n"
    );
    let [staged, moded] = [staged, moded].map(|text| traced(&scenario(&text)));
    assert_eq!(modes(&moded)[1], (10.0, "b".to_owned()));
    agree(&staged, &moded, &["/attitude", "/rate", "/torque"]);
}

/// The changes of the example follow from the rates of its log and the failure of its star tracker.
#[test]
fn changes_are_those_of_the_conditions_on_the_log() {
    let mut scenario = shipped("safe-mode", &[("log.period", "0.5"), ("duration", "7000")]);
    scenario.written.log.period = Some(flexsc_core::numerics::time::Span::from_seconds(0.5));
    let (metrics, trace) = flown(&scenario, 0, Detail::Full);
    let times = traces::times(&trace, "/rates");
    let rates = within(&trace, "/rates", "axes", "believed_rad_s");
    let slow = |row: usize| {
        let square: f64 = rates[3 * row..3 * row + 3].iter().map(|rate| rate * rate).sum();
        square.sqrt() < 4e-3
    };
    // The B-dot law samples each second from 1 s on; the condition has to hold for 60 s.
    let mut since = None;
    let point = pairs(&times, 0..times.len()).find_map(|(time, row)| {
        if *time < 1.0 || time.fract() != 0.0 {
            return None;
        }
        since = if slow(row) { since.or(Some(*time)) } else { None };
        since.filter(|since| time - since >= 60.0).map(|_| *time)
    });
    let point = point.expect("a slow body");
    // The last reading before the failure is at 5799 s, samples of the law are 0.5 s apart, and those of the safe mode 1 s.
    let safe =
        (0..100_000).map(|k| point + 0.5 * f64::from(k)).find(|time| time - 5799.0 > 30.0).expect("a sample");
    let back =
        (1..100_000).map(|k| safe + f64::from(k)).find(|time| *time >= 6400.0).expect("a sample") + 120.0;
    let expected = [(0.0, "detumble"), (point, "point"), (safe, "safe"), (back, "point")];
    assert_eq!(modes(&trace), expected.map(|(time, name)| (time, name.to_owned())));
    assert_eq!([point, safe, back], [1377.0, 5829.5, 6520.5]);
    let times = [point, safe - point + 7000.0 - back, back - safe];
    assert_eq!(metrics.get("mode_times_s"), Some(&MetricValue::Numbers(times.to_vec())));
    assert_eq!(metrics.get("mode_starts_s"), Some(&MetricValue::Numbers(vec![0.0, point, safe])));
    assert_eq!(metrics.get("mode_changes"), Some(&MetricValue::Count(3)));
    let Some(Column::Texts(causes)) = trace.topic("/mode").and_then(|rows| rows.get("cause")) else {
        panic!()
    };
    assert_eq!(causes[2], "silent(star_tracker) > 30");
}

#[test]
fn the_example_meets_its_goal() {
    let (metrics, _) = flown(&shipped("safe-mode", &[]), 0, Detail::Events);
    assert_eq!(metrics.get("goal"), Some(&MetricValue::Word("met")));
    assert!(metrics.number("attitude_estimate_error_rms_rad").expect("a filter") < 1e-3);
}

/// A law that begins again has no state of its last time: an integrator commands nothing at first.
#[test]
fn laws_start_without_a_past() {
    let integrator =
        "law.state_space = { period = 0.5, a = [[1.0]], b = [[0.1]], c = [[-1.0]], d = [[0.0]] }";
    let text = format!(
        "duration = 20.0\n[body.planar]\ninertia = 100.0\nangle = 2e-3\n[log]\nperiod = 0.25\n\
         [[mode]]\nname = \"a\"\n{integrator}\nleave = [{{ to = \"b\", when = \"time >= 5\" }}]\n\
         [[mode]]\nname = \"b\"\n{LAW}\nleave = [{{ to = \"a\", when = \"time >= 3\" }}]\n"
    );
    let trace = traced(&scenario(&text));
    assert_eq!(modes(&trace).iter().map(|(time, _)| *time).collect::<Vec<_>>(), [0.0, 5.0, 8.0, 13.0, 16.0]);
    let torque = |time: f64| {
        let row = traces::times(&trace, "/torque").iter().position(|row| *row == time).expect("a row");
        column(&trace, "/torque", "feedback_nm")[row]
    };
    assert!(torque(4.75) != 0.0 && torque(8.75) != 0.0 && torque(5.0) != 0.0);
    assert_eq!([torque(0.25), torque(8.0), torque(8.25), torque(16.25)], [0.0; 4]);
}

/// A sensor that is not in use gives no readings, as one that is silent.
#[test]
fn a_sensor_that_is_not_in_use_is_silent() {
    let text = std::fs::read_to_string(format!("{}/safe-mode.toml", crate::util::SCENARIOS)).expect("a file");
    let text =
        text.replace("duration = 9000.0", "duration = 200.0").replace("[600.0, 9000.0]", "[0.0, 200.0]");
    let all = "sensors = [\"gyro\", \"magnetometer\", \"sun_sensor\"]\n";
    assert!(text.contains(all));
    let silent = text.replace(all, "").replace("from = 5800.0, to = 6400.0", "from = 0.0, to = 300.0");
    let [used, silent] = [text, silent].map(|text| traced(&scenario(&text)));
    agree(&used, &silent, &["/attitude_filter", "/rates", "/magnetorquers"]);
}

#[test]
fn conditions_on_the_truth_end_a_mode_at_their_instant() {
    let text = format!(
        "{BODY}[[mode]]\nname = \"a\"\n{LAW}\nactuators = [\"hold\"]\nleave = [{{ to = \"b\", when = \"truth.time >= 2.345678901\" }}]\n\
         [[mode]]\nname = \"b\"\n{LAW}\nactuators = [\"hold\"]\n"
    );
    let trace = traced(&scenario(&text));
    assert_eq!(modes(&trace)[1].0, 2.345_678_901);
    let Some(Column::Counts(fs)) = trace.topic("/mode").and_then(|rows| rows.get("time_fs")) else {
        panic!()
    };
    assert_eq!(fs[1], 345_678_901_000_000);
}

#[test]
fn endless_changes_are_chatter() {
    let law = "law.pd = { k_p = 4.0, k_d = 30.0, period = 0.01 }";
    let text = format!(
        "duration = 30.0\n[body.planar]\ninertia = 100.0\n[[mode]]\nname = \"a\"\n{law}\nleave = [{{ to = \"b\", when = \"rate >= 0\" }}]\n\
         [[mode]]\nname = \"b\"\n{law}\nleave = [{{ to = \"a\", when = \"rate >= 0\" }}]\n"
    );
    let error = Simulation::new(&scenario(&text), 0).run(&mut ()).expect_err("chatter").to_string();
    let words = "chatter: the mode of operation changed 33 times within a second, up to t = 0.330000000000000 s, between `a` and `b`";
    assert!(error.starts_with(words), "{error}");
    let slow = text.replace("0.01", "0.04");
    Simulation::new(&scenario(&slow), 0).run(&mut ()).expect("25 changes in a second");
}

/// A run in pieces, and from a copy, is the run as a whole.
#[test]
fn a_run_in_pieces_is_the_whole() {
    let scenario = shipped("safe-mode", &[("duration", "1500"), ("log.period", "1")]);
    let whole = traced(&scenario);
    let mut trace = Trace::new(Detail::Full);
    let mut simulation = Simulation::new(&scenario, 0);
    for piece in 1..=30 {
        let until = flexsc_core::numerics::time::Span::from_seconds(f64::from(piece) * 51.3);
        let mut copy = simulation.clone();
        copy.run_until(flexsc_core::numerics::time::Instant::START + until, &mut ()).expect("a run");
        simulation.run_until(flexsc_core::numerics::time::Instant::START + until, &mut trace).expect("a run");
    }
    agree(&whole, &trace, &["/mode", "/rates", "/wheels", "/attitude_filter"]);
}

const MARGINS: &str = "duration = 30.0\n[body.planar]\ninertia = 100.0\nangle = 2e-3\n[[body.planar.modes]]\nfrequency = 2.0\ngain = 0.02\n\
                       damping = 0.005\n[sensor.sampled]\nperiod = 0.5\n";

#[test]
fn linear_tools_take_one_mode() {
    let dir = Dir::new();
    let quick = "law.pd = { k_p = 9.0, k_d = 50.0, period = 0.5 }";
    dir.write(
        "two.toml",
        format!(
            "{MARGINS}[[mode]]\nname = \"calm\"\n{LAW}\nleave = [{{ to = \"quick\", when = \"time > 3\" }}]\n\
             [[mode]]\nname = \"quick\"\n{quick}\n[uncertain.\"mode[1].law.pd.k_p\"]\nuniform = [8.0, 10.0]\n"
        ),
    );
    dir.write("one.toml", format!("{quick}\n{MARGINS}"));
    let margins = |arguments: &str| {
        let mut json = dir.run(arguments).exits(0).json();
        json.as_object_mut().expect("an object").remove("scenario");
        json.to_string().replace("\"two\"", "\"one\"")
    };
    assert_eq!(margins("margins two.toml --mode quick --json"), margins("margins one.toml --json"));
    dir.run("margins two.toml")
        .exits(2)
        .says(&["mode", "choose one with `--mode`, in Python `in_mode`: `calm`, `quick`"]);
    dir.run("margins two.toml --mode fast").exits(2).says(&["must be one of `calm`, `quick`, got `fast`"]);
    dir.run("margins one.toml --mode fast").exits(2).says(&["has no modes of operation"]);
    // A campaign draws numbers of the law of a mode.
    dir.run("simulate two.toml --runs 3 --table csv -o out").exits(0);
    let rows = crate::util::table(&dir, "out/runs.csv");
    assert_eq!(rows.len(), 3);
    assert!(rows.iter().all(|row| row["mode_changes"] == "1"), "{rows:?}");
}

#[test]
fn a_figure_has_a_band_of_each_mode() {
    let dir = Dir::with(&["safe-mode"]);
    let said = dir.run("simulate safe-mode.toml --set duration=1500 --log full -o .").exits(0);
    let row = |mode: &str| {
        let line = said.err.lines().find(|line| line.starts_with(&format!("  {mode} ")));
        line.unwrap_or_else(|| panic!("{}", said.err)).split_whitespace().collect::<Vec<_>>().join(" ")
    };
    assert!(row("detumble").starts_with("detumble 1 1377 s no target"), "{}", row("detumble"));
    assert!(row("point").starts_with("point 1 123 s "), "{}", row("point"));
    assert!(row("safe").starts_with("safe never"), "{}", row("safe"));
    dir.run("plot safe-mode.mcap --what rates -o .").exits(0);
    let svg = dir.text("safe-mode-rates.svg");
    assert!(svg.contains("detumble") && svg.contains("point") && !svg.contains(">safe<"));
}

#[test]
fn what_does_not_fit_is_refused() {
    let one = |keys: &str| {
        format!("{MARGINS}[[mode]]\nname = \"a\"\n{LAW}\n{keys}\n[[mode]]\nname = \"b\"\nlaw.open = {{}}\n")
    };
    let when = |condition: &str| one(&format!("leave = [{{ to = \"b\", when = \"{condition}\" }}]"));
    for (text, words) in [
        (format!("{LAW}\n{}", one("")), "`law` must be left out with `[[mode]]`"),
        (one("target = { yaw = 0.1 }"), "`mode[0].target` is for a body with three axes"),
        (one("actuators = [\"wheels\"]"), "`mode[0].actuators[0]` must be one of the actuators"),
        (
            one("sensors = [\"gyro\"]"),
            "`mode[0].sensors[0]` must be one of the sensors, `sampled`, got `gyro`",
        ),
        (one("sensors = []"), "`mode[0].sensors` must include `sensor.sampled`, which the law `pd` needs"),
        (
            one("leave = [{ to = \"c\", when = \"time > 1\" }]"),
            "`mode[0].leave[0].to` must name one of the modes, `a`, `b`, got `c`",
        ),
        (when("momentum > 1"), "`mode[0].leave[0].when` reads a stored momentum"),
        (when("wheel_speed > 1"), "`mode[0].leave[0].when` reads the speeds of `wheels`"),
        (when("field > 1"), "`mode[0].leave[0].when` reads the measured field"),
        (when("sunlight < 0.5"), "`mode[0].leave[0].when` reads the light"),
        (when("lock_lost"), "`mode[0].leave[0].when` reads the lock"),
        (when("truth.rate < 1"), "`mode[0].leave[0].when` reads the truth"),
        (
            one("leave = [{ to = \"b\", when = \"time > 1\", for = -1.0 }]"),
            "`mode[0].leave[0].for`: must be a time of 0 to 1e13 s, got -1",
        ),
        (one("leave = [{ to = \"b\", when = 3 }]"), "leave[0].when"),
        (one("leave = [{ to = \"b\", if = \"time > 1\" }]"), "if"),
    ] {
        let found = refused(&text);
        assert!(found.contains(words), "{words}: {found}");
    }
    // The carets stand under the part of the condition.
    let found = refused(&when("rte < 1 or time > 3"));
    let lines: Vec<&str> = found.lines().collect();
    let (text, carets) = (lines[lines.len() - 2], lines[lines.len() - 1]);
    assert_eq!(text.find("rte"), carets.find("^^^"), "{found}");
    assert!(!carets.contains("^^^^"), "{found}");
}
