//! Appendages on hinges: against an oracle of rigid bodies, balances, shipped satellites with hinges, and refused
//! settings.

use flexsc_core::metrics::MetricValue;
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::record::{Detail, Trace};
use flexsc_core::{Scenario, Simulation};

use crate::study::pairs;
use crate::traces::{column, flown, golden_rows, traced, within};
use crate::util::SCENARIOS;

const GOLDEN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden");

fn golden() -> String {
    std::fs::read_to_string(format!("{GOLDEN}/hinged.toml")).expect("a file")
}

fn parsed(text: &str) -> Scenario {
    Scenario::parse("hinged.toml", text).expect("a scenario")
}

/// Rigid bodies by Newton and Euler have the same motion, at angles of half a radian: `golden/hinged_oracle.py`.
#[test]
fn panels_swing_as_rigid_bodies_do() {
    let trace = traced(&parsed(&golden()));
    let rows = golden_rows("hinged.csv");
    let attitude = ["q_w", "q_x", "q_y", "q_z"].map(|name| column(&trace, "/pointing", name));
    let rates = within(&trace, "/rates", "axes", "rate_rad_s");
    let [angles, speeds] = ["angle_rad", "rate_rad_s"].map(|name| within(&trace, "/hinges", "hinges", name));
    let position = ["x_m", "y_m", "z_m"].map(|name| column(&trace, "/position", name));
    assert_eq!(attitude[0].len(), rows.len());
    let most = |count: usize, of: &dyn Fn(usize) -> f64| (0..count).map(of).fold(0.0, f64::max);
    for (at, row) in rows.iter().enumerate() {
        let off = [
            most(4, &|k| (attitude[k][at] - row[1 + k]).abs()),
            most(3, &|k| (rates[3 * at + k] - row[5 + k]).abs()),
            most(2, &|k| (angles[2 * at + k] - row[8 + k]).abs()),
            most(2, &|k| (speeds[2 * at + k] - row[10 + k]).abs()),
            most(3, &|k| (position[k][at] - row[12 + k]).abs()),
        ];
        assert!(off.iter().all(|off| *off < 3e-12), "{} s: {off:?}", row[0]);
    }
}

/// The kinetic energy of point masses, whose centre moves with a hinge and with modes beside it: `golden/swung_oracle.py`.
#[test]
fn a_hinge_beside_modes_swings_as_point_masses_do() {
    let text = std::fs::read_to_string(format!("{GOLDEN}/swung.toml")).expect("a file");
    let trace = traced(&Scenario::parse("swung.toml", &text).expect("a scenario"));
    let rows = golden_rows("swung.csv");
    let attitude = ["q_w", "q_x", "q_y", "q_z"].map(|name| column(&trace, "/pointing", name));
    let rates = within(&trace, "/rates", "axes", "rate_rad_s");
    let [angles, speeds] = ["angle_rad", "rate_rad_s"].map(|name| within(&trace, "/hinges", "hinges", name));
    let [elastic, rotational] = ["elastic_j", "rotational_j"].map(|name| column(&trace, "/energy", name));
    assert_eq!(attitude[0].len(), rows.len());
    let mut worst = [0.0_f64; 5];
    for (at, row) in rows.iter().enumerate() {
        let off = [
            (0..4).map(|k| (attitude[k][at] - row[1 + k]).abs()).fold(0.0, f64::max),
            (0..3).map(|k| (rates[3 * at + k] - row[5 + k]).abs()).fold(0.0, f64::max),
            (angles[at] - row[8]).abs(),
            (speeds[at] - row[9]).abs(),
            (elastic[at] + rotational[at] - row[10]).abs(),
        ];
        worst.iter_mut().zip(off).for_each(|(most, off)| *most = most.max(off));
    }
    for (most, bound) in worst.into_iter().zip([1e-11, 1e-11, 1e-11, 3e-11, 1e-10]) {
        assert!(most < bound, "{worst:?}");
    }
}

/// Returns the golden spacecraft without torques, and with modes of the usual kind on the antenna, which is fixed.
fn alone(damping: &str) -> String {
    let modes = "modes = [{ frequency = 1.7, translation = [0.0, 0.4, 2.1], moments = [[0.1, 0.3, 2.5], [0.0, 0.1, 0.4], \
                 [0.0, 0.0, 0.2]], displacement = 0.1 }, { frequency = 4.1, translation = [0.3, 0.9, -0.2], moments = \
                 [[0.0, 0.9, -0.2], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0]], rate = 0.2 }]";
    let text = golden();
    let drive = text.lines().find(|line| line.starts_with("drive = ")).expect("one").to_owned();
    let text = text.replace(&drive, modes).replace("damping = 0.8", damping);
    text[..text.find("[[disturbance]]").expect("one")].to_owned()
        + &text[text.find("[law.open]").expect("one")..]
}

/// Without torques momentum and energy are constant while panels swing by half a radian and modes couple with them.
#[test]
fn momentum_and_energy_stay_while_hinges_and_modes_swing() {
    let text = alone("damping = 0.0").replace("duration = 40.0", "duration = 1000.0");
    let trace = traced(&parsed(&text));
    let momentum = column(&trace, "/energy", "momentum_nm_s");
    let [elastic, rotational] = ["elastic_j", "rotational_j"].map(|name| column(&trace, "/energy", name));
    let energy: Vec<f64> = elastic.iter().zip(rotational).map(|(a, b)| a + b).collect();
    let (least, most) = elastic.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), e| (a.min(*e), b.max(*e)));
    assert!(least < 0.99 * most, "modes and rotation exchange energy: {least} to {most}");
    for (of, what) in [(momentum, "momentum"), (&energy[..], "energy")] {
        let off = of.iter().map(|now| (now / of[0] - 1.0).abs()).fold(0.0, f64::max);
        assert!(off < 1e-11, "{what} {off:e}");
    }
}

/// At small angles a hinge moves as its mode: the free modes are those of a panel given by its mode.
#[test]
fn small_swings_are_those_of_the_mode() {
    let of = |name: &str| -> Vec<f64> {
        let scenario = Scenario::load(format!("{GOLDEN}/outside/{name}.toml").as_ref()).expect("a scenario");
        scenario.model.frequencies().collect()
    };
    for (hinge, mode) in pairs(of("two-panels"), of("two-modes")) {
        assert!((hinge - mode).abs() < 1e-13 * mode, "{hinge} {mode}");
    }
}

/// Returns a shipped scenario whose panels swing on hinges in place of their modes, for 50 s.
fn hinged(name: &str) -> Scenario {
    let text = std::fs::read_to_string(format!("{SCENARIOS}/{name}.toml")).expect("a file");
    let (mut kept, mut within) = (String::new(), false);
    for line in text.lines() {
        if line.starts_with("duration") {
            kept += "duration = 50.0\n";
            continue;
        }
        let begins = line.starts_with("modes = [");
        if begins {
            kept += "hinge = { about = [1, 0, 0], stiffness = 450.0, damping = 6.0, angle = 0.01 }\n";
        }
        within |= begins;
        if !(within || line.starts_with("plate")) {
            kept = kept + line + "\n";
        }
        within &= !(line == "]" || begins && line.contains("] }]"));
    }
    let scenario = Scenario::parse(&format!("{name}.toml"), &kept).expect("valid");
    assert!(scenario.study.drives.as_ref().is_some_and(|drives| drives.driven.hinges() > 0), "{name}");
    scenario
}

/// Laws, sensors, filters and actuators of shipped satellites on panels that swing; where a run stops changes nothing.
#[test]
fn satellites_fly_with_hinges_and_stop_anywhere() {
    for name in ["agile-observer", "earth-observer", "momentum-unloading", "canted-jets", "wheels-and-jets"] {
        let scenario = hinged(name);
        let reported = |pieces: u32| {
            let mut trace = Trace::new(Detail::Full);
            let mut run = Simulation::new(&scenario, 0);
            for piece in 1..=pieces {
                let until = scenario.duration.seconds() * f64::from(piece) / f64::from(pieces);
                run = run.clone();
                run.run_until(Instant::START + Span::from_seconds(until), &mut trace).expect(name);
            }
            let topics =
                ["/pointing", "/rates", "/hinges", "/energy"].map(|topic| trace.topic(topic).cloned());
            assert!(topics.iter().all(Option::is_some), "{name}");
            format!("{topics:?}")
        };
        assert!(reported(1) == reported(7), "{name}");
    }
}

#[test]
fn what_does_not_go_with_hinges_is_refused() {
    let refused = |from: &str, to: &str| {
        let text = golden();
        assert!(text.contains(from), "{from}");
        Scenario::parse("hinged.toml", &text.replacen(from, to, 1)).expect_err("refused").to_string()
    };
    let hinge = "about = [1.0, 0.2, -0.1], stiffness = 70.0";
    for (from, to, words) in [
        (hinge, "about = [0, 0, 0], stiffness = 70.0", "`appendage[0].hinge.about` must have a length"),
        (hinge, "about = [1, 0, 0], stiffness = 0.0", "stiffness"),
        ("angle = 0.5", "angle = 5.0", "`appendage[0].hinge.angle` must be an angle"),
        ("angle = 0.5", "angel = 0.5", "angle"),
        ("hinge = {", "plate = \"y\"\nhinge = {", "`appendage[0].plate` must be left out"),
        (
            "hinge = {",
            "drive = { about = [0, 1, 0], rate = 0.1 }\nhinge = {",
            "`appendage[0].drive` must be left out",
        ),
        ("hinge = {", "modes = [{ frequency = 1.0 }]\nhinge = {", "`appendage[0].modes` must be left out"),
        (
            "torque = 0.1\n",
            "torque = 0.1\nfriction = { coulomb = 0.01 }\n",
            "`actuator.wheels.friction` needs",
        ),
        ("inertia = [[14.0, 0.2, 0.0], [0.2, 2.5, -0.1], [0.0, -0.1, 16.0]]\n", "", ""),
    ] {
        if words.is_empty() {
            // A point mass swings too.
            let text = golden().replacen(from, to, 1);
            assert!(Scenario::parse("hinged.toml", &text).is_ok());
            continue;
        }
        let error = refused(from, to);
        assert!(error.contains(words), "{error}");
    }
}

/// The comment of the scenario: how the panels unfold, what that does to the hub, and that the goal is met.
#[test]
fn panels_unfold() {
    let flight = |stiffness: &str| {
        let text = std::fs::read_to_string(format!("{SCENARIOS}/panel-deployment.toml")).expect("a file");
        let text = text.replace("stiffness = 0.45", &format!("stiffness = {stiffness}"));
        let (metrics, trace) = flown(&parsed(&text), 0, Detail::Full);
        assert_eq!(metrics.get("goal"), Some(&MetricValue::Word("met")), "{metrics:?}");
        trace
    };
    let most = |of: &[f64]| of.iter().map(|of| of.abs()).fold(0.0, f64::max);
    let (trace, equal) = (flight("0.45"), flight("0.5"));
    let [roll, pitch] = ["roll_error_rad", "pitch_error_rad"].map(|name| column(&trace, "/pointing", name));
    assert!((most(roll) - 1.17e-3).abs() < 1e-5 && (most(roll) - roll[15].abs()).abs() < 1e-6);
    assert!((most(pitch) - 3.89e-4).abs() < 1e-6);
    let [roll, pitch] = ["roll_error_rad", "pitch_error_rad"].map(|name| column(&equal, "/pointing", name));
    assert!((most(roll) - 1.33e-4).abs() < 1e-6 && (most(pitch) - 4.25e-4).abs() < 1e-6);
    let angles = within(&trace, "/hinges", "hinges", "angle_rad");
    let rates = within(&trace, "/hinges", "hinges", "rate_rad_s");
    assert!((angles[0] - 1.4).abs() < 1e-15 && angles[180..].iter().all(|angle| angle.abs() < 0.05));
    assert!((most(rates) - 0.0655).abs() < 1e-4, "{}", most(rates));
}
