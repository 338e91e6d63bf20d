//! Control moment gyros: against an oracle of point masses and Euler's equations, with other parts, refused settings,
//! and the shipped scenario.

use flexsc_core::Simulation;
use flexsc_core::control::quantity::total_width;
use flexsc_core::metrics::MetricValue;
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::record::{Detail, Trace};
use flexsc_core::scenario::Scenario;

use crate::drawing::Drawing;
use crate::traces::{column, flown, traced, within};
use crate::util::{Dir, SCENARIOS};

const GOLDEN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden");

fn text(path: &str) -> String {
    std::fs::read_to_string(path).expect("a file")
}

fn parsed(text: &str) -> Scenario {
    Scenario::parse("gimbals.toml", text).expect("a scenario")
}

/// Returns the shipped scenario with some of its words changed.
fn changed(change: &[(&str, &str)]) -> String {
    change.iter().fold(text(&format!("{SCENARIOS}/agile-observer.toml")), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    })
}

fn golden(name: &str) -> Vec<Vec<f64>> {
    let cells = |line: &str| line.split(',').map(|cell| cell.parse().expect("a number")).collect();
    text(&format!("{GOLDEN}/{name}.csv")).lines().map(cells).collect()
}

/// Returns the largest differences from rows of t, Q, w and |H|.
fn off(trace: &Trace, rows: &[Vec<f64>]) -> [f64; 3] {
    let attitude = ["q_w", "q_x", "q_y", "q_z"].map(|name| column(trace, "/pointing", name));
    let rates = within(trace, "/rates", "axes", "rate_rad_s");
    let momentum = column(trace, "/energy", "momentum_nm_s");
    assert_eq!(attitude[0].len(), rows.len());
    let mut worst = [0.0_f64; 3];
    for (at, row) in rows.iter().enumerate() {
        let off = [
            (0..4).map(|k| (attitude[k][at] - row[1 + k]).abs()).fold(0.0, f64::max),
            (0..3).map(|k| (rates[3 * at + k] - row[5 + k]).abs()).fold(0.0, f64::max),
            (momentum[at] - row[8]).abs(),
        ];
        worst.iter_mut().zip(off).for_each(|(most, off)| *most = most.max(off));
    }
    worst
}

/// The kinetic energy of point masses gives the same motion as gimbals turn: `golden/gimbals_oracle.py`. The energy
/// gained by the body is the work of the gimbals' motors.
#[test]
fn a_flexible_body_turns_as_the_oracle_says() {
    let trace = traced(&parsed(&text(&format!("{GOLDEN}/gimbals.toml"))));
    let rows = golden("gimbals");
    let worst = off(&trace, &rows);
    assert!(worst[0] < 1e-11 && worst[1] < 1e-11 && worst[2] < 1e-12, "{worst:?}");
    let [elastic, rotational] = ["elastic_j", "rotational_j"].map(|name| column(&trace, "/energy", name));
    for (at, row) in rows.iter().enumerate() {
        let gained = elastic[at] + rotational[at] - elastic[0] - rotational[0];
        assert!((elastic[at] - row[9]).abs() < 1e-11, "{at}");
        assert!((gained - row[11] + row[12]).abs() < 1e-11, "{at}: {gained}");
    }
    assert!(rows[80][11] > 0.4);
}

/// Euler's equations of the hub alone.
#[test]
fn a_rigid_body_turns_as_the_oracle_says() {
    let text = text(&format!("{GOLDEN}/gimbals.toml"));
    let rigid = text.split("[[appendage]]").next().expect("the hub");
    let trace = traced(&parsed(rigid));
    let worst = off(&trace, &golden("gimbals_rigid"));
    assert!(worst[0] < 1e-11 && worst[1] < 1e-11 && worst[2] < 1e-12, "{worst:?}");
}

/// A step turns body and gimbals by at most 1/16 rad: at (0.0269 + 0.5) rad/s the longest power of two is 1/16 s, and
/// 40 s have 640.
#[test]
fn the_steps_of_fast_gimbals_are_counted() {
    let text = text(&format!("{GOLDEN}/gimbals.toml"));
    let rigid = text.split("[[appendage]]").next().expect("the hub");
    let limited = rigid.replace("momentum = 4.0", "momentum = 4.0\nrate_limit = 0.5");
    assert_eq!(parsed(&limited).cost(None, false).most, ("`duration`".to_owned(), 640.0));
}

#[test]
fn the_shipped_scenario_does_what_its_comment_says() {
    let (metrics, trace) = flown(&parsed(&changed(&[])), 0, Detail::Full);
    assert_eq!(metrics.get("goal"), Some(&MetricValue::Word("met")), "{metrics:?}");
    let rates = within(&trace, "/control_moment_gyros", "gyros", "rate_rad_s");
    let largest = rates.iter().map(|rate| rate.abs()).fold(0.0, f64::max);
    let reported = metrics.number("gimbal_rate_peak_rad_s").expect("a rate");
    assert!(largest <= reported && reported <= 1.0, "{largest} {reported}");
    let measure = column(&trace, "/control_moment_gyros", "singularity");
    let least = measure.iter().copied().fold(f64::INFINITY, f64::min);
    assert!((least - metrics.number("singularity_min").expect("a measure")).abs() < 1e-9, "{least}");
    // It ends at rest: what the gyros stored during the turn is given back.
    let momentum =
        ["x", "y", "z"].map(|axis| column(&trace, "/control_moment_gyros", &format!("momentum_{axis}_nm_s")));
    let size = |at: usize| momentum.iter().map(|of| of[at] * of[at]).sum::<f64>().sqrt();
    let last = momentum[0].len() - 1;
    assert!(size(last) < 0.05, "{}", size(last));
    let end = metrics.number("gyro_momentum_end_nm_s").expect("a momentum");
    assert!((size(last) - end).abs() < 1e-3);
    assert!(metrics.number("gyro_momentum_peak_nm_s").expect("a momentum") > 10.0);
    assert!(metrics.number("torque_error_peak_nm").expect("a torque") >= 0.0);
}

#[test]
fn a_clone_repeats_the_run_to_the_last_bit() {
    let scenario = parsed(&changed(&[("duration = 120.0", "duration = 40.0")]));
    let mut first = Simulation::new(&scenario, 0);
    let mut nothing = Trace::new(Detail::Events);
    first.run_until(Instant::START + Span::from_seconds(27.3), &mut nothing).expect("a run");
    let mut second = first.clone();
    let ends = [&mut first, &mut second].map(|run| {
        run.run(&mut Trace::new(Detail::Events)).expect("a run");
        let mut row = vec![0.0; total_width(&run.observation_fields(&scenario))];
        run.observe(&mut row).expect("a state");
        let names: Vec<&str> = run.observation_fields(&scenario).iter().map(|field| field.name).collect();
        assert!(names.contains(&"gimbal_angles") && names.contains(&"gimbal_rates"));
        row.iter().map(|value| value.to_bits()).collect::<Vec<_>>()
    });
    assert_eq!(ends[0], ends[1]);
    let mut whole = Simulation::new(&scenario, 0);
    whole.run(&mut Trace::new(Detail::Full)).expect("a run");
    let mut row = vec![0.0; ends[0].len()];
    whole.observe(&mut row).expect("a state");
    assert_eq!(row.iter().map(|value| value.to_bits()).collect::<Vec<_>>(), ends[0]);
}

const GYROS: &str = "[[actuator]]
control_moment_gyros = { arrangement = \"pyramid\", momentum = 15.0, rate_limit = 1.0, angles = [-0.5, 0, 0.5, 0] }
";

const WHEELS: &str = "share = 0.8
[[actuator]]
wheels = { arrangement = \"pyramid\", inertia = 0.04, torque = 0.4, speeds = [9, -9, 9, -9], friction = { coulomb = 1e-3 } }
share = 0.2
";

const TORQUERS: &str = "[[actuator]]
magnetorquers = { moment = 400.0 }
unloads = { above = 1.0, below = 0.5, gain = 0.01, period = 1.0 }
[environment]
orbit = { semi_major_axis = 7e6, inclination = 1.0 }
magnetic_field = {}
";

/// The shipped scenario with other actuators.
fn with(actuators: &[&str]) -> String {
    let text = changed(&[]);
    let (before, after) = text.split_once("[actuator.control_moment_gyros]").expect("the actuator");
    let (_, after) = after.split_once("[log]").expect("what follows");
    format!("{before}{}[log]{after}", actuators.concat())
}

#[test]
fn they_share_the_demand_with_wheels_that_stick_and_slip() {
    let text = with(&[GYROS, WHEELS]).replace("duration = 120.0", "duration = 50.0");
    let trace = traced(&parsed(&text));
    let momentum = column(&trace, "/energy", "momentum_nm_s");
    let of = |fold: fn(f64, f64) -> f64, from: f64| momentum.iter().copied().fold(from, fold);
    let spread = of(f64::max, 0.0) - of(f64::min, f64::INFINITY);
    assert!(momentum[0] > 1.0 && spread < 1e-9, "{spread}");
    assert!(trace.topic("/wheel_events").is_some_and(|events| !events.is_empty()));
    let turned = column(&trace, "/pointing", "roll_rad");
    assert!((turned[turned.len() - 1] - turned[0]).abs() > 0.1);
}

#[test]
fn magnetorquers_unload_them() {
    let text = with(&[GYROS, TORQUERS]).replace("duration = 120.0", "duration = 300.0");
    let (metrics, trace) = flown(&parsed(&text), 0, Detail::Full);
    let [x, y, z] = ["x", "y", "z"]
        .map(|axis| column(&trace, "/control_moment_gyros", &format!("momentum_{axis}_nm_s"))[0]);
    let start = (x * x + y * y + z * z).sqrt();
    let end = metrics.number("gyro_momentum_end_nm_s").expect("a momentum");
    // 0.73 is left after 300 s, a twentieth of the orbit.
    assert!(start > 5.0 && end < 0.75 * start, "{end} of {start}");
    assert_eq!(metrics.get("goal"), Some(&MetricValue::Word("met")));
}

#[test]
fn what_does_not_fit_is_refused_with_the_reason() {
    let of_spatial = "duration = 10.0\n[body.spatial]\ninertia = [[100, 0, 0], [0, 80, 0], [0, 0, 60]]\npoints = [{ name = \"hub\" }]\n\
        [sensor.sampled]\nperiod = 0.2\n[law.attitude]\nperiod = 0.2\nbandwidth = 0.1\n[actuator.control_moment_gyros]\narrangement = \"pyramid\"\nmomentum = 1.0";
    let of_one = "duration = 10.0\n[body.planar]\ninertia = 100.0\n[law.pd]\nk_p = 1.0\nk_d = 1.0\nperiod = 0.2\n[actuator.control_moment_gyros]\narrangement = \"pyramid\"\nmomentum = 1.0";
    let law = "[law.attitude]\nperiod = 0.1                            # s\nbandwidth = 0.5                         # rad/s\ndamping = 0.8";
    let relay = "[law.relay]\ndead_zone = 5e-4\nhysteresis = 1e-4\nstrong = 4e-3\nweak = 1e-4\nk_t = 0.3";
    let plane = "[law.phase_plane]\nperiod = 0.1\ndead_zone = 5e-4\nrate_limit = 1e-3\nswitch_on = 1e-4\nswitch_off = 3e-5";
    let cases = [
        (of_spatial.to_owned(), "needs no appendages"),
        (of_one.to_owned(), "the body has one angle"),
        (changed(&[(law, relay)]), "gimbals at constant rates"),
        (changed(&[(law, plane)]), "changes with their gimbal angles"),
        (
            changed(&[(
                "momentum = 15.0",
                "momentum = 15.0\nfaults = [{ dead = { gimbal = 5, from = 1.0 } }]",
            )]),
            "must be one of 4 gimbals",
        ),
        (
            changed(&[(
                "momentum = 15.0",
                "momentum = 15.0\nfaults = [{ dead = { wheel = 1, from = 1.0 } }]",
            )]),
            "has no wheels",
        ),
        (with(&[GYROS, GYROS]), "in one `control_moment_gyros`"),
        (with(&[GYROS, WHEELS, TORQUERS]), "cannot tell apart"),
    ];
    for (text, why) in cases {
        let error = Scenario::parse("gimbals.toml", &text).expect_err(why).to_string();
        assert!(error.contains(why), "{error}");
    }
    // A relay decides at samples, and gimbals follow at a period of their own.
    let text = changed(&[
        (law, relay),
        ("momentum = 15.0", "momentum = 15.0\nperiod = 0.1"),
        ("duration = 120.0", "duration = 15.0"),
    ]);
    let (metrics, _) = flown(&parsed(&text), 0, Detail::Full);
    assert!(metrics.number("torque_error_peak_nm").expect("a torque") < 1e-2);
}

#[test]
fn their_summary_and_figure_show_gimbals_and_limits() {
    let (metrics, _) =
        flown(&parsed(&changed(&[("duration = 120.0", "duration = 45.0")])), 0, Detail::Events);
    let [rate, measure, off] = ["gimbal_rate_peak_rad_s", "singularity_min", "torque_error_peak_nm"]
        .map(|name| metrics.number(name).expect(name));
    let dir = Dir::with(&["agile-observer"]);
    dir.run("simulate agile-observer.toml --set duration=45 --units si").exits(0).says(&[
        &format!("  gimbals    rate at most {rate:.4} rad/s; "),
        &format!("singularity measure at least {measure:.3}; "),
        &format!("{off:.5} N m of the demand"),
    ]);
    dir.run("plot agile-observer.mcap --what gimbals --format svg").exits(0);
    let drawing = Drawing::at(&dir, "agile-observer-gimbals.svg");
    drawing.shows(&[
        "gimbal angle (deg)",
        "gimbal rate (deg/s)",
        "singularity measure",
        "momentum (N m s)",
        "limit 57.3 deg/s",
        "gimbal 4",
    ]);
}
