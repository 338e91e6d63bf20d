//! Forces at points of a spacecraft, steady and in pulses: the motion under them, and refused ones.

use flexsc_core::metrics::MetricsCollector;
use flexsc_core::record::{Columns, Trace};
use flexsc_core::{Scenario, ScenarioError, Simulation};

use crate::study::pairs;
use crate::traces::{column, traced};

const HUB: &str = "duration = 100.0\n[law.open]\n[log]\nperiod = 10.0\n[spacecraft]\nmass = 250.0\n\
    inertia = [[80, 0, 0], [0, 80, 0], [0, 0, 120]]\n";
/// A mass that swings along y.
const MASS: &str = "[[appendage]]\nname = \"tank\"\nmass = 40.0\nat = [0.3, 0.0, 0.4]\n\
    modes = [{ frequency = 0.7, damping = 0.02, along = [0, 2, 0] }]\n";

fn scenario(text: &str) -> Result<Scenario, ScenarioError> {
    Scenario::parse("forces.toml", text)
}

fn flown(text: &str) -> Trace {
    let scenario = scenario(text).unwrap_or_else(|error| panic!("{error}"));
    traced(&scenario)
}

#[track_caller]
fn near(found: f64, exact: f64, error: f64) {
    assert!((found - exact).abs() <= error, "{found:e} is off {exact:e} by {:e}", found - exact);
}

/// A force that turns with a body which spins: x'' = a cos wt, y'' = a sin wt.
#[test]
fn a_force_turns_with_its_body() {
    let trace = flown(&format!(
        "{HUB}rate = [0.0, 0.0, 0.1]\npoints = [{{ name = \"hub\", position = [0.0, 0.0, 0.5] }}]\n\
         [[disturbance]]\nforce = [5.0, 0.0, 0.0]\npoint = \"hub\"\nto = 40.0\n\
         [[disturbance]]\nabout = \"pitch\"\ntorque = -2.5\nto = 40.0\n"
    ));
    // The torque undoes that of the force about the centre of mass.
    let (a, w) = (5.0 / 250.0, 0.1_f64);
    for row in 0..=10 {
        let t = 10.0 * f64::from(row);
        let burn = f64::min(t, 40.0);
        let (sin, cos) = (w * burn).sin_cos();
        let (v_x, v_y) = (a / w * sin, a / w * (1.0 - cos));
        let x = a / (w * w) * (1.0 - cos) + v_x * (t - burn);
        let y = a / (w * w) * (w * burn - sin) + v_y * (t - burn);
        let row = row as usize;
        near(column(&trace, "/position", "x_m")[row], x, 1e-11);
        near(column(&trace, "/position", "y_m")[row], y, 1e-11);
        near(column(&trace, "/position", "x_m_s")[row], v_x, 1e-12);
        near(column(&trace, "/position", "z_m")[row], 0.0, 1e-12);
    }
}

/// Pulses give the impulse of their time, on whatever grid a log has, and the centre of mass keeps the velocity.
#[test]
fn pulses_give_their_impulse_and_a_swinging_mass_takes_its_part() {
    let body = format!("{HUB}centre = [-0.048, 0.0, -0.064]\n{MASS}");
    let pulsed = flown(&format!(
        "{body}[[disturbance]]\nforce = [0.0, 3.0, 0.0]\npulse = {{ period = 7.0, on = 0.3 }}\nfrom = 1.0\nto = 60.0\n"
    ));
    // Nine pulses, the last at 57 s. Oscillations about the centre of mass decay as exp(-zeta W t), and turn the body a
    // little.
    let delta = 9.0 * 0.3 * 3.0 / 290.0;
    let v_y = column(&pulsed, "/position", "y_m_s");
    assert!(v_y[..6].iter().any(|v| (v - delta).abs() > 1e-2 * delta));
    near(v_y[10], delta, 0.1 * delta);
    // Pulses written one by one give this position too, to the errors of other steps.
    let one = |index: i32| {
        let from = 1.0 + 7.0 * f64::from(index);
        format!("[[disturbance]]\nforce = [0.0, 3.0, 0.0]\nfrom = {from}\nto = {}\n", from + 0.3)
    };
    let single = flown(&format!("{body}{}", (0..9).map(one).collect::<String>()));
    for name in ["x_m", "y_m", "z_m", "y_m_s"] {
        for (a, b) in pairs(column(&pulsed, "/position", name), column(&single, "/position", name)) {
            near(*a, *b, 2e-11);
        }
    }
}

/// Pulses of a torque on a one-axis body: a rigid body's rate is their impulse.
#[test]
fn pulses_act_on_one_angle_too() {
    let text = "duration = 10.0\n[body.planar]\ninertia = 2.0\n[law.open]\n\
        [[disturbance]]\ntorque = 0.5\npulse = { period = 1.0, on = 0.25 }\nfrom = 0.5\nto = 4.6\n";
    let scenario = scenario(text).expect("valid");
    let mut simulation = Simulation::new(&scenario, 0);
    simulation.run(&mut MetricsCollector::new(&scenario)).expect("a run");
    // Four whole pulses, and 0.1 s of the fifth.
    near(simulation.state().expect("one angle").rigid_rate, 0.25 * 1.1, 1e-15);
}

#[test]
fn what_is_no_force_is_refused() {
    let body = format!("{HUB}{MASS}");
    for (text, words) in [
        (
            "force = [1, 0, 0]\npoint = \"tip\"",
            "`disturbance[0].point` must be one of the body's points, `hub`, got `tip`",
        ),
        ("force = [1, 0, 0]\nabout = \"roll\"", "`disturbance[0].about` applies only to a torque"),
        ("force = [1, 0, 0]\ntorque = 1.0", "`disturbance[0].force` must be alone"),
        ("about = \"roll\"\npoint = \"hub\"", "`disturbance[0].point` applies only to a `force`"),
        (
            "about = \"roll\"\ntorque = 1.0\npulse = { period = 1.0, on = 1.0 }",
            "`disturbance[0].pulse.on` must be shorter",
        ),
        (
            "about = \"roll\"\ntorque = 1.0\ntable = [[0.0, 1.0], [1.0, 2.0]]",
            "`disturbance[0].table` takes the place of a constant `torque`",
        ),
    ] {
        let error = scenario(&format!("{body}[[disturbance]]\n{text}\n")).expect_err(text).to_string();
        assert!(error.contains(words), "{text}: {error}");
    }
    for (mode, words) in [
        ("along = [0, 0, 0]", "`appendage[0].modes[0].along` must be a direction"),
        ("along = [1, 0, 0], translation = [1, 0, 0]", "`appendage[0].modes[0].along` replaces"),
    ] {
        let error = scenario(&body.replace("along = [0, 2, 0]", mode)).expect_err(mode).to_string();
        assert!(error.contains(words), "{mode}: {error}");
    }
    let one_angle = "duration = 1.0\n[body.planar]\n[law.open]\n[[disturbance]]\nforce = [1, 0, 0]\n";
    let error = scenario(one_angle).expect_err("a force").to_string();
    assert!(error.contains("`disturbance[0].force` acts on a body with three axes"), "{error}");
    let requirement = format!("{HUB}[reference]\npointing = {{ window = [50.0, 50.0] }}\n");
    let error = scenario(&requirement).expect_err("late").to_string();
    assert!(error.contains("`reference.pointing.window` must be [from, to]"), "{error}");
}

/// A force on a body with given modes, which do not act back, turns it as it turns a rigid spacecraft.
#[test]
fn a_force_turns_every_body_with_three_axes() {
    let force = "[[disturbance]]\nforce = [1.0, -2.0, 0.5]\npoint = \"jet\"\nfrom = 3.0\nto = 8.5\n";
    let point = "points = [{ name = \"hub\" }, { name = \"jet\", position = [0.1, 0.4, -0.2] }]\n";
    let spacecraft = flown(&format!("{HUB}{point}{force}"));
    let spatial =
        flown(&format!("{}{point}{force}", HUB.replace("[spacecraft]\nmass = 250.0", "[body.spatial]")));
    assert!(spatial.topic("/position").is_none_or(Columns::is_empty), "nobody knows its mass");
    for name in ["q_w", "q_x", "q_y", "q_z"] {
        for (a, b) in pairs(column(&spacecraft, "/pointing", name), column(&spatial, "/pointing", name)) {
            near(*a, *b, 1e-10);
        }
    }
}
