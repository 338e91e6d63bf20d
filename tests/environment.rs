//! The environment of a three-axis body, in whole scenarios.

use flexsc_core::record::Trace;
use flexsc_core::{Scenario, ScenarioError};

use crate::study::pairs;
use crate::traces::{column, traced, within};
use crate::util::{Dir, table};

/// All parts of the environment together.
const AROUND: &str = "[environment]\ntorque = [2e-4, 0.0, -1e-4]\n\
    gravity_gradient = { orbit_rate = 1.1e-3, local = [0.6, 0.0, 0.8, 0.0] }\n\
    solar_pressure = { force = [1e-4, -2e-4, 5e-5], at = [0.2, 0.4, -0.3], shadow = [[33.3, 61.7], [90.05, 1000.0]] }\n\
    dipole = { moment = [3.0, -1.0, 2.0], strength = 2.4e-5, inclination = 0.9, orbit_rate = 1.1e-3, local = [0.6, 0.0, 0.8, 0.0] }\n";
const HUB: &str =
    "mass = 600.0\ninertia = [[1100, 6, 1], [6, 310, 5], [1, 5, 1090]]\nrate = [4e-3, 6e-3, -2e-3]\n";
const PANEL: &str = "[[appendage]]\nname = \"panel\"\nmass = 30.0\ncentre = [0.0, 2.5, 0.0]\nat = [0.0, 1.0, 0.2]\nplate = \"y\"\n\
    inertia = [[62.5, 0, 0], [0, 5.625, 0], [0, 0, 68.125]]\n\
    modes = [{ frequency = 1.1, damping = 0.005, translation = [0, 0, 4.2887], rotation = [15.577, 0, 0], displacement = 0.1 }]\n";

fn scenario(body: &str, around: &str, period: f64) -> Result<Scenario, ScenarioError> {
    let text = format!(
        "duration = 120.0\n{body}{around}\n[law.pd]\nk_p = 2.0\nk_d = 60.0\nperiod = 0.5\n[log]\nperiod = {period}\n"
    );
    Scenario::parse("around.toml", &text)
}

fn run(body: &str, around: &str, period: f64) -> Trace {
    let scenario = scenario(body, around, period).expect("a scenario");
    traced(&scenario)
}

/// Returns the disturbing torques, three a row.
fn torques(trace: &Trace) -> &[f64] {
    within(trace, "/torques", "axes", "disturbance_nm")
}

const POINTING: [&str; 4] = ["q_w", "q_x", "q_y", "q_z"];

/// A rigid spacecraft in the flow of spacecraft has the motion of a three-axis body in its own flow, environment
/// torques included.
#[test]
fn both_motions_of_a_rigid_body_agree() {
    let spacecraft = run(&format!("[spacecraft]\n{HUB}"), AROUND, 1.0);
    let spatial =
        run(&format!("[body.spatial]\n{}points = [{{ name = \"hub\" }}]\n", &HUB[13..]), AROUND, 1.0);
    for name in POINTING {
        let (a, b) = (column(&spacecraft, "/pointing", name), column(&spatial, "/pointing", name));
        assert_eq!(a.len(), 121);
        assert!(pairs(a, b).all(|(a, b)| (a - b).abs() < 1e-12), "{name}");
    }
    let (a, b) = (torques(&spacecraft), torques(&spatial));
    assert!(pairs(a, b).all(|(a, b)| (a - b).abs() < 1e-15));
    assert!(a.iter().any(|torque| torque.abs() > 1e-4));
    // Sunlight begins and ends where the shadow does, between the rows of the log and on them.
    let alone = "[environment]\nsolar_pressure = { force = [1e-4, -2e-4, 5e-5], at = [0.2, 0.4, -0.3], shadow = [[33.3, 60.0]] }\n";
    let lit = run(&format!("[spacecraft]\n{HUB}"), alone, 1.0);
    for (second, row) in torques(&lit).chunks(3).enumerate() {
        assert_eq!(row.iter().all(|torque| *torque == 0.0), (34..60).contains(&second), "{second}");
    }
}

/// A log twice as dense, and one without rows, has the same motion to the last bit: edges of the shadow are events.
#[test]
fn looking_more_often_changes_no_bit() {
    let spacecraft = format!("[spacecraft]\n{HUB}{PANEL}");
    let spatial = format!(
        "[body.spatial]\n{}points = [{{ name = \"hub\" }}]\ndisturbance = {{ constant = [1e-3, 0, 0] }}\n\
         modes = [{{ frequency = 1.3, displacement = 0.1, shapes.hub = {{ rotation = [0.02, 0.01, 0.03] }} }}]\n",
        &HUB[13..]
    );
    for body in [spacecraft, spatial] {
        let (thin, dense) = (run(&body, AROUND, 0.5), run(&body, AROUND, 0.25));
        for (topic, name) in
            POINTING.map(|name| ("/pointing", name)).into_iter().chain([("/energy", "elastic_j")])
        {
            let (a, b) = (column(&thin, topic, name), column(&dense, topic, name));
            assert_eq!((a.len(), b.len()), (241, 481));
            assert!(pairs(a, b.iter().step_by(2)).all(|(a, b)| a.to_bits() == b.to_bits()), "{topic} {name}");
        }
        // The environment acts, and so does its shadow.
        let without = run(&body, "", 0.5);
        let bright = run(&body, &AROUND.replace(", shadow = [[33.3, 61.7], [90.05, 1000.0]]", ""), 0.5);
        for other in [without, bright] {
            let (a, b) = (column(&thin, "/pointing", "q_x"), column(&other, "/pointing", "q_x"));
            assert!(a.iter().zip(b).any(|(a, b)| (a - b).abs() > 1e-7));
        }
    }
}

#[test]
fn what_does_not_fit_is_refused() {
    let refused = |body: &str, around: &str, words: &[&str]| {
        let error = scenario(body, around, 1.0).expect_err(around).to_string();
        assert!(words.iter().all(|word| error.contains(word)), "{error}");
    };
    let rigid = format!("[spacecraft]\n{HUB}");
    let around = |text: &str| format!("[environment]\n{text}\n");
    refused(
        "[body.planar]\ninertia = 10.0\n",
        &around("torque = [1, 0, 0]"),
        &["`environment` is for a body with three axes, and the body is `planar`", "`[[disturbance]]`"],
    );
    let sun = "solar_pressure = { force = [1, 0, 0], at = [0, 0, 0], shadow = [[1, 2], [5, 4]] }";
    refused(
        &rigid,
        &around(sun),
        &["`environment.solar_pressure.shadow[1]` must be [from, to]", "got [5, 4]"],
    );
    let gravity = "gravity_gradient = { orbit_rate = 1e-3 }";
    let dipole = |rest: &str| {
        format!("{gravity}\ndipole = {{ moment = [1, 0, 0], strength = 2e-5, inclination = 0.1, {rest} }}")
    };
    refused(
        &rigid,
        &around(&dipole("orbit_rate = 1.1e-3")),
        &["`environment.dipole.orbit_rate` must be that of `gravity_gradient`, 0.001 rad/s, got 0.0011"],
    );
    refused(
        &rigid,
        &around(&dipole("orbit_rate = 1e-3, local = [0, 1, 0, 0]")),
        &["`environment.dipole.local`", "there is one orbit"],
    );
    refused(&rigid, &around("gravity_gradient = {}"), &["orbit_rate"]);
    refused(&rigid, &around("gravity_gradient = { orbit_rate = 1e15 }"), &["`environment` makes", "steps"]);
}

/// A spacecraft that rotates faster than its modes allow is refused, and sooner if first moments are not known.
#[test]
fn a_spacecraft_that_turns_too_fast_is_refused() {
    let panel = |rate: &str, panel: &str, rest: &str| {
        let hub = HUB.replace("[4e-3, 6e-3, -2e-3]", rate);
        scenario(&format!("[spacecraft]\n{hub}{panel}"), rest, 1.0)
    };
    let turn = |limit: f64| {
        format!("[[target]]\nfrom = 1.0\nyaw = 0.5\nacceleration = 1e-3\nrate_limit = {limit}\n")
    };
    let unknown = PANEL.replace("plate = \"y\"\n", "");
    assert!(panel("[0.0, 0.21, 0.0]", PANEL, &turn(0.21)).is_ok());
    assert!(panel("[0.0, 0.0109, 0.0]", &unknown, &turn(0.0109)).is_ok());
    assert!(panel("[0.0, 3.0, 0.0]", "", &turn(3.0)).is_ok(), "a rigid one");
    for (rate, of, rest, words) in [
        (
            "[0.0, 0.15, 0.17]",
            PANEL,
            String::new(),
            ["`spacecraft.rate` must be below 2.200e-1 rad/s", "a fifth"],
        ),
        (
            "[0.0, 0.0, 0.0]",
            PANEL,
            turn(0.23),
            ["`target[0].rate_limit` must be below 2.200e-1 rad/s", "a fifth"],
        ),
        (
            "[0.0, 0.0111, 0.0]",
            &unknown,
            String::new(),
            ["`spacecraft.rate` must be below 1.100e-2", "`plate`"],
        ),
        (
            "[0.0, 0.0, 0.0]",
            &unknown,
            turn(0.0111),
            ["`target[0].rate_limit` must be below 1.100e-2", "`plate`"],
        ),
    ] {
        let error = panel(rate, of, &rest).expect_err(rate).to_string();
        assert!(words.iter().all(|word| error.contains(word)), "{error}");
    }
}

/// Rotations that cannot be integrated are refused before the run, and long ones need a yes.
#[test]
fn steps_of_a_rotation_are_counted() {
    let long = |duration: f64, panel: &str| {
        let hub = HUB.replace("[4e-3, 6e-3, -2e-3]", "[1e-6, 0, 0]");
        let text = format!(
            "duration = {duration}\n[spacecraft]\n{hub}{panel}[law.pd]\nk_p = 1\nk_d = 1\nperiod = 1e5\n[log]\nperiod = 1e5\n"
        );
        Scenario::parse("long.toml", &text)
    };
    assert_eq!(
        long(1.8e10, "").expect("a rigid one takes steps of 1000 s").cost(None, false).limit_exceeded(),
        None
    );
    let error = long(1.8e10, &PANEL.replace("1.1,", "120.0,")).expect_err("too many").to_string();
    assert!(error.contains("`duration` makes 1."), "{error}");
    let years = long(1e10, &PANEL.replace("1.1,", "11.0,")).expect("possible").cost(None, false);
    assert!(years.limit_exceeded().is_some_and(|why| why.starts_with("`duration` makes")), "{years:?}");
}

/// The Sun of the date acts like a given direction; without a date it is refused.
#[test]
fn the_sun_of_the_date_is_a_direction() {
    let text = |sun: &str, epoch: &str| {
        format!(
            "duration = 10.0\n{epoch}\n[spacecraft]\n{HUB}[environment]\norbit = {{ semi_major_axis = 7e6, inclination = 1.7 }}\nsun = {sun}\n\
             [[sensor]]\nsun_sensor = {{ period = 1.0, noise = 1e-3 }}\n[[sensor]]\ngyro = {{ period = 1.0, angle_random_walk = 1e-6 }}\n[estimator.attitude]\n[law.pd]\nk_p = 0.1\n\
             k_d = 1.0\nperiod = 1.0\n[log]\nperiod = 1.0\n"
        )
    };
    let sun = |text: &str| {
        let scenario = Scenario::parse("sun.toml", text).unwrap_or_else(|error| panic!("{error}"));
        scenario.orbit_environment().sun().expect("a Sun").direction(0.0)
    };
    // The solstice of June: over the tropic, at a right ascension of 90 degrees.
    let found = sun(&text("\"epoch\"", "epoch = 2024-06-20T20:51:00Z"));
    let given = sun(&text("[0.0, 0.917482, 0.397777]", ""));
    assert!((found - given).norm() < 4e-4, "{found} {given}");
    for (sun, words) in [
        ("\"epoch\"", "`environment.sun` follows from the scenario's `epoch`, and there is none"),
        ("\"epok\"", "did you mean `epoch`?"),
        ("[0, 0, 0]", "`environment.sun` must not be zero"),
    ] {
        let error = Scenario::parse("sun.toml", &text(sun, "")).expect_err(sun).to_string();
        assert!(error.contains(words), "{error}");
    }
}

/// A dated satellite as a user wrote it: magnetorquers, wheels, the Sun of the date, uncertain panels.
#[test]
fn a_dated_satellite_flies_a_campaign() {
    let dir = Dir::holding("cube12u.toml", include_str!("golden/cube12u.toml"));
    dir.run("simulate cube12u.toml --set duration=200 --runs 4 --table csv -o mc")
        .exits(3)
        .says(&["4 runs", "missed"]);
    let rows = table(&dir, "mc/runs.csv");
    assert_eq!(rows.len(), 4);
    for row in rows {
        assert!(row["rate_end_rad_s"].parse::<f64>().is_ok_and(f64::is_finite), "{row:?}");
    }
}

/// The camera of `ground-pass` follows the site: its boresight, from the truth, is along the line to the site within the
/// pointing error, which is small only with the rates of the reference fed forward.
#[test]
fn a_camera_follows_a_ground_site() {
    let dir = Dir::with(&["ground-pass"]);
    dir.run("simulate ground-pass.toml").exits(0).says(&["1 of 1 requirement met", "✓ pass"]);
    let text = dir.text("ground-pass.toml");
    let refused = |from: &str, to: &str, key: &str, why: &str| {
        assert!(text.contains(from), "{from}");
        let error = Scenario::parse("pass.toml", &text.replacen(from, to, 1)).expect_err(to).to_string();
        assert!(error.contains(key) && error.contains(why), "{error}");
    };
    let named = "from = 0\nframe = \"nadir\"                                # s";
    refused(
        "from = 0                                # s",
        named,
        "target[0].frame",
        "must be left out with `primary`",
    );
    refused("along = \"velocity\"", "along = \"nadir\"", "target[0].secondary.along", "is not defined there");
    refused("height = 100", "height = 9e5", "target[1].primary.along", "below the orbit's perigee");
    refused(
        "secondary = { body = [1, 0, 0], along = \"velocity\" }",
        "",
        "target[0].primary",
        "needs `secondary` too",
    );
}
