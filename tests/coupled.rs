//! Scenarios whose modes are coupled, by a wheel's back-EMF or a damping matrix: from the file to the log.

use flexsc_core::Scenario;
use flexsc_core::record::{Column, Trace};

use crate::plants::golden;
use crate::study::pairs;
use crate::traces::{column, traced};
use crate::util::Dir;

/// The relay law of the study through a wheel, on the plants (a) and (b).
const RELAY: &str = "
[body.planar]
angle = 4.5e-4
rate = 2.2e-5
MORE
[[body.planar.modes]]
frequency = 0.44
gain = 0.0213
displacement = 2.75e-6
[[body.planar.modes]]
frequency = 0.755
gain = 0.0216
[actuator.wheel]
gain = 1.0
back_emf = 2e-4
[law.relay]
dead_zone = 5e-4
hysteresis = 1e-4
strong = 4e-5
weak = 1e-6
";

const DASHPOT: &str = "damping_matrix = [[0.0061, -0.005964], [-0.006048, 0.0061]]";

fn trace(text: &str) -> Trace {
    let scenario = Scenario::parse("linear.toml", text).expect("a valid scenario");
    traced(&scenario)
}

/// Compares the switchings in a log with a file.
fn switches_as(text: &str, name: &str) {
    let trace = trace(text);
    let commands = trace.topic("/command").expect("switchings");
    let counts = |name: &str| match commands.get(name) {
        Some(Column::Counts(values)) => values.iter().map(|count| *count as f64).collect::<Vec<_>>(),
        _ => panic!("no counts {name}"),
    };
    let (whole, part) = (counts("time_whole_s"), counts("time_fs"));
    let events = golden(name);
    assert!(whole.len() >= events.len(), "{} of {}", whole.len(), events.len());
    for (index, (row, (whole, part))) in pairs(&events, whole.iter().zip(part).take(events.len())).enumerate()
    {
        let (seconds, decimals) = row[3].split_once('.').expect("decimals");
        let exact: f64 = format!("0.{decimals}").parse().expect("a number");
        let error = (whole - seconds.parse::<f64>().expect("seconds") + (part / 1e15 - exact)).abs();
        assert!(
            error < if index < 20 { 1e-12 } else { 1e-11 },
            "{name}, switching {index}: off by {error:e} s"
        );
    }
}

#[test]
fn a_scenario_with_a_relay_through_a_wheel() {
    let text = format!("duration = 740.0\n{}k_t = 0.31\n", RELAY.replace("MORE", ""));
    switches_as(&text, "a_backemf_31_events");
    // With a sampled sensor the loop moves from sample to sample, as it did before.
    let sampled = trace(&format!("{text}[sensor.sampled]\nperiod = 1e-3\n"));
    let first = column(&sampled, "/command", "time_s")[0];
    assert!((first - 2.094_213_964).abs() < 1e-3, "{first}");
}

#[test]
fn a_scenario_whose_damping_couples_the_modes() {
    let text = format!("duration = 900.0\n{}k_t = 0.3389\n", RELAY.replace("MORE", DASHPOT));
    switches_as(&text, "b_damping_3389_events");
    // A log contains the scenario that repeats it.
    let scenario = Scenario::parse("linear.toml", &text).expect("a valid scenario");
    let again = Scenario::parse("again.toml", &scenario.self_contained().to_toml()).expect("valid");
    assert_eq!(again.model, scenario.model);
}

/// A wheel that opposes the rigid rate alone: x_r' decays on its own, by exp(-a t), and drives the modes with all of
/// it.
#[test]
fn back_emf_of_the_rigid_rate() {
    let text = RELAY.replace("MORE", "").replace("2e-4", "2e-4\nopposes = \"rigid_rate\"");
    let trace = trace(&format!("duration = 2.0\n{text}k_t = 0.31\n[log]\nperiod = 0.5\n"));
    let rates = column(&trace, "/rate", "rigid_rad_s");
    for (index, rate) in rates.iter().enumerate() {
        let t = 0.5 * index as f64;
        let (a, m) = (2e-4, 1e-6);
        let exact = m / a + (2.2e-5 - m / a) * (-a * t).exp();
        assert!((rate - exact).abs() < 1e-18, "{t}: {rate} {exact}");
    }
    assert_eq!(rates.len(), 5);
}

/// A structure by its matrices, with dashpots between its parts: 1 N m turns the hub as mpmath's matrix exponential of
/// the coordinates themselves has it (40 digits).
#[test]
fn a_damping_matrix_of_a_structure() {
    let body = "[body.matrices]
mass = [[100, 6, 4], [6, 2, 0], [4, 0, 1.5]]
stiffness = [[0, 0, 0], [0, 0.5, 0], [0, 0, 0.9]]
damping_matrix = [[0, 0, 0], [0, 0.05, -0.03], [0, -0.03, 0.04]]
outputs = [{ name = \"tip\", weights = { q1 = 1 } }]";
    let text =
        format!("duration = 40.0\n{body}\n[law.open]\n[[disturbance]]\ntorque = 1.0\n[log]\nperiod = 10.0\n");
    let trace = trace(&text);
    let exact = [
        (1, 0.507_022_360_598_761_8, 0.100_384_709_787_563_63, -0.065_453_666_079_163_45),
        (2, 2.010_634_993_023_874_1, 0.195_880_785_656_839_33, -0.132_846_763_483_596_13),
        (4, 8.012_870_175_492_793, 0.401_730_866_295_227_85, -0.176_486_743_607_228_97),
    ];
    let (angles, rates) = (column(&trace, "/attitude", "angle_rad"), column(&trace, "/rate", "rate_rad_s"));
    let outputs = trace.topic("/outputs").and_then(|columns| columns.get("outputs"));
    let Some(Column::Rows(_, outputs)) = outputs else { panic!("no outputs") };
    let tips = outputs.numbers("value").expect("values");
    for (index, angle, rate, tip) in exact {
        let errors = [angles[index] - angle, rates[index] - rate, tips[index] - tip].map(f64::abs);
        assert!(errors.iter().all(|error| *error < 1e-13), "{errors:?}");
    }
}

/// Parts that do not support the coupling are refused, by the key that couples.
#[test]
fn what_does_not_go_with_coupled_damping_is_refused() {
    let dir = Dir::with(&["relay-fixed", "relay-wheel", "rotation-sine", "wheel-ekf"]);
    let two = "[[0.01,0.0],[0.0,0.01]]";
    let four = "[[0.01,0,0,0],[0,0,0,0],[0,0,0,0],[0,0,0,0]]";
    let cases = [
        ("relay-fixed", two, "couples modes, and an `[estimator.envelope]` treats each mode on its own"),
        ("relay-wheel", "[[0.01,0.0]]", "must have one row for each of 2 modes, got 1"),
        (
            "relay-wheel",
            "[[0.01,0.0],[0.0]]",
            "`body.planar.damping_matrix[1]` must have one number for each of 2 modes, got 1",
        ),
        ("wheel-ekf", four, "`body.planar.damping_matrix` has no closed form for modes that drift"),
    ];
    for (name, matrix, words) in cases {
        let set = format!("body.planar.damping_matrix={matrix}");
        dir.run(&format!("simulate {name}.toml --set {set}")).exits(2).says(&[words]);
    }
    dir.run("cycle relay-wheel.toml").exits(2).says(&["not for a wheel"]);
}

/// Proportional damping, written as a matrix, is equal to damping ratios.
#[test]
fn a_diagonal_damping_matrix_is_ratios() {
    let modes = |damping: &str| RELAY.replace("MORE", damping).replace("2e-4", "0.0");
    let ratios = modes("").replace("frequency = 0.44", "frequency = 0.44\ndamping = 0.01");
    let matrix = modes("damping_matrix = [[0.0088, 0], [0, 0]]");
    let run = |text: &str| trace(&format!("duration = 400.0\n{text}k_t = 0.31\n"));
    let (a, b) = (run(&ratios), run(&matrix));
    let (a, b) = (column(&a, "/command", "time_s"), column(&b, "/command", "time_s"));
    assert!(a.len() > 40 && a.len() == b.len());
    assert!(pairs(a, b).all(|(a, b)| (a - b).abs() < 1e-11));
}
