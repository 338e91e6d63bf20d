//! Failures of actuators and sensors: each has its effect from its own instant on, and laws and estimators are not
//! informed.

use flexsc_core::Scenario;
use flexsc_core::record::{Column, Trace};

use crate::traces::{column, traced, within};

/// A wheel's axes in the pyramid of equal torques.
const PART: f64 = 0.577_350_269_189_625_8;

fn flown(text: &str) -> Trace {
    let scenario = Scenario::parse("failures.toml", text).unwrap_or_else(|error| panic!("{error}"));
    traced(&scenario)
}

fn refused(text: &str) -> String {
    Scenario::parse("failures.toml", text).expect_err("it does not fit").to_string()
}

const RIGID: &str = "duration = 20.0\nlog = { period = 1.0 }\n[body.planar]\ninertia = 100.0\n";

/// Added torques turn a body by their integrals, and drive a mode as an oscillator.
#[test]
fn a_constant_and_a_sine_are_added_to_nothing() {
    let text = format!(
        "{RIGID}modes = [{{ frequency = 0.9, damping = 0.05, gain = 0.4 }}]\n[law.open]\n[actuator.ideal]
        faults = [{{ added = {{ from = 1.5, to = 12.25, constant = 0.2, sines = [{{ amplitude = 0.3, frequency = 1.3, phase = 0.4 }}] }} }}]"
    );
    let trace = flown(&text);
    let torque = |t: f64| {
        if (1.5..12.25).contains(&t) { 0.2 + 0.3 * (1.3 * t + 0.4).sin() } else { 0.0 }
    };
    // Runge and Kutta by steps that end where the torque jumps: rigid angle and rate, and the mode's.
    let rates = |t: f64, x: [f64; 4]| {
        let u = torque(t);
        [x[1], u / 100.0, x[3], 0.4 * u / 100.0 - 2.0 * 0.05 * 0.9 * x[3] - 0.81 * x[2]]
    };
    let (mut x, h) = ([0.0; 4], 1.0 / 1024.0);
    let ahead = |x: [f64; 4], k: [f64; 4], h: f64| std::array::from_fn(|i| x[i] + h * k[i]);
    for step in 0..20 * 1024_u32 {
        let t = f64::from(step) * h;
        if step % 1024 == 0 {
            let row = step as usize / 1024;
            let off = (column(&trace, "/attitude", "rigid_rad")[row] - x[0]).abs();
            assert!(off < 1e-12, "{t} s: {off:e}");
            let mode = within(&trace, "/modes", "modes", "displacement_rad")[row];
            assert!((mode - x[2]).abs() < 1e-12, "{t} s: {:e}", mode - x[2]);
            assert!((column(&trace, "/torque", "applied_nm")[row] - torque(t)).abs() < 1e-14);
        }
        // The right limit at a jump counts for the step that begins there.
        let end = (t + h).min(if t < 12.25 { 12.25 - 1e-13 } else { f64::MAX });
        let end = if t < 1.5 { end.min(1.5 - 1e-13) } else { end };
        let middle = 0.5 * (t + end);
        let k1 = rates(t, x);
        let k2 = rates(middle, ahead(x, k1, 0.5 * h));
        let k3 = rates(middle, ahead(x, k2, 0.5 * h));
        let k4 = rates(end, ahead(x, k3, h));
        x = std::array::from_fn(|i| x[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
    }
}

/// Failures of each axis' actuator: half, reversed, stuck and dead, against a rigid body under such torques.
#[test]
fn torques_are_scaled_stuck_and_dead() {
    let faults = "faults = [{ scaled = { from = 2.0, to = 8.0, factor = -0.5 } }, { stuck = { from = 8.0, to = 10.0 } }, \
                  { stuck = { from = 10.0, to = 13.0, at = 0.25 } }, { dead = { from = 13.0, to = 16.0 } }]";
    for actuator in ["[actuator.ideal]", "[actuator.hold]\nperiod = 0.5", "[actuator.wheel]\ngain = 1.0"] {
        let text = format!(
            "{RIGID}angle = 0.01\n[law.pd]\nk_p = 4.0\nk_d = 30.0\nperiod = 0.5\n{actuator}\n{faults}"
        );
        let trace = flown(&text);
        let (mut x, mut v, mut held) = (0.01_f64, 0.0_f64, 0.0);
        for cycle in 0..40 {
            let t = 0.5 * f64::from(cycle);
            let wanted = -4.0 * x - 30.0 * v;
            let given = match t {
                t if t < 2.0 => wanted,
                t if t < 8.0 => -0.5 * wanted,
                // At 8 s the law has decided once more before the failure begins, and the other one has not ended.
                8.0 => -0.5 * wanted,
                t if t < 10.0 => held,
                t if t < 13.0 => 0.25,
                t if t < 16.0 => 0.0,
                _ => wanted,
            };
            held = given;
            if cycle % 2 == 0 {
                let found = column(&trace, "/attitude", "angle_rad")[cycle as usize / 2];
                assert!((found - x).abs() < 1e-12, "{actuator} {t} s: {:e}", found - x);
                let applied = column(&trace, "/torque", "applied_nm")[cycle as usize / 2];
                assert!((applied - given).abs() < 1e-10, "{actuator} {t} s: {applied} {given}");
            }
            x += 0.5 * v + 0.125 * given / 100.0;
            v += 0.5 * given / 100.0;
        }
    }
}

const THREE: &str = "duration = 40.0
log = { period = 1.0 }
[spacecraft]
mass = 400.0
inertia = [[100.0, 0.0, 0.0], [0.0, 80.0, 0.0], [0.0, 0.0, 60.0]]
rate = [0.002, -0.001, 0.003]
";

/// A wheel whose motor is dead keeps its momentum, one with a bias gains it, and all together lose none.
#[test]
fn a_wheel_fails_alone() {
    let text = format!(
        "{THREE}[law.attitude]\nperiod = 0.5\nbandwidth = 0.2\ndamping = 0.7\n[actuator.wheels]\narrangement = \"pyramid\"\n\
         inertia = 0.05\nfaults = [{{ dead = {{ from = 10.25, wheel = 2 }} }}, {{ added = {{ from = 20.0, to = 30.0, constant = 1e-3, wheel = 3 }} }}]"
    );
    let trace = flown(&text);
    let momenta = within(&trace, "/wheels", "wheels", "momentum_nm_s");
    let torques = within(&trace, "/wheels", "wheels", "torque_nm");
    assert!(torques[4 * 5 + 1] != 0.0);
    for row in 11..=40 {
        assert_eq!((torques[4 * row + 1], momenta[4 * row + 1]), (0.0, momenta[4 * 11 + 1]), "{row}");
    }
    let norms = column(&trace, "/energy", "momentum_nm_s");
    assert!(norms.iter().all(|norm| (norm / norms[0] - 1.0).abs() < 1e-12));
    // Demand on three wheels about each axis, and the addition of one of them.
    let asked = within(&trace, "/torques", "axes", "feedback_nm");
    let given = within(&trace, "/torques", "axes", "applied_nm");
    for row in [12, 25, 35] {
        let wanted = &asked[3 * row..3 * row + 3];
        let share = |[x, y, z]: [f64; 3]| -(x * wanted[0] + y * wanted[1] + z * wanted[2]) * PART * 0.75;
        // Axes (x, y, z) with signs, halfway between x and y: cos of the cant over sqrt(2) and its sine are all 0.5774.
        let signs = [[1.0, 1.0, 1.0], [-1.0, 1.0, 1.0], [-1.0, -1.0, 1.0], [1.0, -1.0, 1.0]];
        let mut sum = [0.0; 3];
        for (wheel, signs) in signs.into_iter().enumerate() {
            let mut torque = if wheel == 1 { 0.0 } else { share(signs) };
            if wheel == 2 && (20..30).contains(&row) {
                torque += 1e-3;
            }
            assert!((torques[4 * row + wheel] - torque).abs() < 1e-12, "{row} {wheel}");
            (0..3).for_each(|axis| sum[axis] -= signs[axis] * PART * torque);
        }
        assert!((0..3).all(|axis| (given[3 * row + axis] - sum[axis]).abs() < 1e-12), "{row}");
    }
}

/// A thruster that is stuck open turns the body and takes propellant; a dead one takes none.
#[test]
fn a_thruster_fails_alone() {
    let jets = |faults: &str| {
        format!(
            "{THREE}[law.open]\n[actuator.jets]\nperiod = 1.0\nspecific_impulse = 200.0\nfaults = [{faults}]
            thrusters = [
            {{ name = \"a\", point = \"hub\", offset = [0.0, 1.0, 0.0], direction = [0.0, 0.0, 1.0], thrust = 0.5 }},
            {{ name = \"b\", point = \"hub\", offset = [0.0, 1.0, 0.0], direction = [0.0, 0.0, -1.0], thrust = 0.5 }},
            {{ name = \"c\", point = \"hub\", offset = [0.0, 0.0, 1.0], direction = [1.0, 0.0, 0.0], thrust = 0.5 }},
            {{ name = \"d\", point = \"hub\", offset = [0.0, 0.0, 1.0], direction = [-1.0, 0.0, 0.0], thrust = 0.5 }},
            {{ name = \"e\", point = \"hub\", offset = [1.0, 0.0, 0.0], direction = [0.0, 1.0, 0.0], thrust = 0.5 }},
            {{ name = \"f\", point = \"hub\", offset = [1.0, 0.0, 0.0], direction = [0.0, -1.0, 0.0], thrust = 0.5 }}]
            groups = {{ roll = {{ plus = [\"a\"], minus = [\"b\"] }}, pitch = {{ plus = [\"c\"], minus = [\"d\"] }}, yaw = {{ plus = [\"e\"], minus = [\"f\"] }} }}"
        )
        .replace("rate = [0.002, -0.001, 0.003]", "points = [{ name = \"hub\" }]")
    };
    // 0.5 N, 1 m out, on 100 kg m² for 12.5 s; half of that for 4 s.
    let trace = flown(&jets(
        "{ stuck = { from = 5.25, to = 17.75, at = 1.0, thruster = \"a\" } }, { added = { from = 20.0, to = 24.0, constant = 0.25, thruster = \"a\" } }",
    ));
    let rates = within(&trace, "/rates", "axes", "rate_rad_s");
    assert!((rates[3 * 18] - 0.5 * 12.5 / 100.0).abs() < 1e-15, "{}", rates[3 * 18]);
    assert!((rates[3 * 40] - (0.5 * 12.5 + 1.0) / 100.0).abs() < 1e-15, "{}", rates[3 * 40]);
    // With a law the same pulses, but for those of a dead thruster, of which none turns the body.
    let text = jets("{ dead = { from = 0.0, thruster = \"a\" } }");
    let text = text.replace("[law.open]", "[law.pd]\nk_p = 2.0\nk_d = 40.0\nperiod = 1.0");
    let pushed = |rate: &str| {
        let trace = flown(&text.replace("points =", &format!("rate = {rate}\npoints =")));
        let rates = within(&trace, "/rates", "axes", "rate_rad_s");
        (rates[3 * 40], column(&trace, "/jets", "fuel_kg").last().copied().unwrap_or_default())
    };
    let (left, fuel) = pushed("[-1e-3, 0.0, 0.0]");
    assert!((left + 1e-3).abs() < 1e-15 && fuel == 0.0, "{left} {fuel}");
    let (left, fuel) = pushed("[1e-3, 0.0, 0.0]");
    assert!(left.abs() < 2e-4 && fuel > 0.0, "{left} {fuel}");
    // The propellant is impulse over specific impulse: 100 kg m² are turned by thrusters with an arm of 1 m.
    let impulse = 100.0 * (1e-3 - left);
    assert!((fuel * 200.0 * 9.806_65 / impulse - 1.0).abs() < 1e-12, "{fuel} {impulse}");
}

/// A magnetorquer that sticks, and one that is dead.
#[test]
fn magnetorquers_fail_by_axes() {
    let text = format!(
        "{THREE}[law.pd]\nk_p = 1e-3\nk_d = 0.05\nperiod = 1.0\n[environment]\norbit = {{ semi_major_axis = 7e6, inclination = 1.0 }}\n\
         magnetic_field = {{}}\n[actuator.magnetorquers]\nmoment = 50.0\n\
         faults = [{{ dead = {{ from = 5.5, about = \"roll\" }} }}, {{ stuck = {{ from = 10.5, at = 7.0, about = \"yaw\" }} }}]"
    );
    let trace = flown(&text);
    let moments = within(&trace, "/magnetorquers", "axes", "moment_am2");
    assert!(moments[3 * 5] != 0.0 && moments[3 * 10 + 2] != 7.0 && moments[3 * 20 + 1] != 0.0);
    for row in 11..=40 {
        assert_eq!([moments[3 * row], moments[3 * row + 2]], [0.0, 7.0], "{row}");
    }
}

/// Failures of sensors are logged like those of actuators, with their exact instants; a gyro has them too.
#[test]
fn failures_are_reported() {
    let text = format!(
        "{RIGID}rate = 1e-3\n[sensor.gyro]\nperiod = 0.5\nfaults = [{{ stuck = {{ from = 4.2, to = 9.0 }} }}]\n\
         [law.pd]\nk_p = 4.0\nk_d = 30.0\nperiod = 0.5\n[actuator.hold]\nperiod = 0.5\nfaults = [{{ dead = {{ from = 0.1 }} }}]"
    );
    let trace = flown(&text);
    assert_eq!(column(&trace, "/faults", "time_s"), [0.1, 4.2, 9.0]);
    let Some(Column::Texts(parts)) = trace.topic("/faults").and_then(|rows| rows.get("part")) else {
        panic!()
    };
    assert_eq!(parts[..], ["actuator.hold", "sensor.gyro", "sensor.gyro"]);
    let Some(Column::Counts(fs)) = trace.topic("/faults").and_then(|rows| rows.get("time_fs")) else {
        panic!()
    };
    assert_eq!(fs[..], [100_000_000_000_000, 200_000_000_000_000, 0]);
}

#[test]
fn what_does_not_fit_is_refused() {
    let one = |rest: &str| refused(&format!("{RIGID}[law.pd]\nk_p = 4.0\nk_d = 30.0\nperiod = 0.5\n{rest}"));
    let three =
        |rest: &str| refused(&format!("{THREE}[law.pd]\nk_p = 4.0\nk_d = 30.0\nperiod = 0.5\n{rest}"));
    let wheels = "[actuator.wheels]\narrangement = \"pyramid\"\ninertia = 0.05\n";
    for (found, words) in [
        (
            one("[actuator.ideal]\nfaults = [{ dead = { from = 3.0, to = 2.0 } }]"),
            "`actuator.ideal.faults[0]` must have `from` before `to`",
        ),
        (
            one("[actuator.ideal]\nfaults = [{ dead = { from = 3.0, about = \"roll\" } }]"),
            "faults[0].dead.about` must be left out",
        ),
        (
            one("[actuator.ideal]\nfaults = [{ dead = { from = 3.0, wheel = 1 } }]"),
            "dead.wheel` applies only to `[actuator.wheels]`",
        ),
        (one("[actuator.ideal]\nfaults = [{ bent = { from = 3.0 } }]"), "`dead`"),
        (refused("duration = 1.0\nactuator = \"best\""), "`ideal`"),
        (
            one(
                "[actuator.wheel]\ngain = 1.0\nfaults = [{ added = { from = 0.0, sines = [{ amplitude = 1.0, frequency = 1.0 }] } }]",
            ),
            "added.sines` have no closed form with a wheel",
        ),
        (
            three(&format!("{wheels}faults = [{{ dead = {{ from = 3.0, wheel = 5 }} }}]")),
            "must be one of 4 wheels, counted from 1, got 5",
        ),
        (
            three(&format!(
                "{wheels}faults = [{{ added = {{ from = 0.0, sines = [{{ amplitude = 1.0, frequency = 1.0 }}] }} }}]"
            )),
            "added.sines` apply only to a torque on the body",
        ),
        (
            three("[actuator.ideal]\nfaults = [{ dead = { from = 3.0, thruster = \"a\" } }]"),
            "dead.thruster` applies only to `[actuator.jets]`",
        ),
        (
            one("[[disturbance]]\nsines = [{ amplitude = 1.0, frequency = 1.0 }]"),
            "disturbance[0].sines` are for a `[spacecraft]`",
        ),
    ] {
        assert!(found.contains(words), "{found}\n\n{words}");
    }
    // A word is still an actuator, and so is a table without keys.
    for actuator in ["actuator = \"ideal\"", "[actuator.ideal]"] {
        let text = format!("duration = 1.0\nbody = {{ planar = {{}} }}\nlaw = {{ open = {{}} }}\n{actuator}");
        let scenario = Scenario::parse("word.toml", &text).expect("it fits");
        assert!(scenario.to_toml().contains("actuator = \"ideal\""));
    }
}

/// Returns the time of each refusal, its sensor and its outcome.
fn refusals(trace: &Trace) -> Vec<(f64, usize, String)> {
    let Some(rows) = trace.topic("/refusals") else { return Vec::new() };
    let Some(Column::Rows(counts, inner)) = rows.get("readings") else { panic!("no readings") };
    let (Some(Column::Counts(sensors)), Some(Column::Labels(outcomes, labels))) =
        (inner.get("sensor"), inner.get("outcome"))
    else {
        panic!("no sensors and outcomes")
    };
    let times = crate::traces::times(trace, "/refusals");
    let times =
        times.iter().zip(counts).flat_map(|(time, count)| std::iter::repeat_n(*time, *count as usize));
    let each = times.zip(sensors).zip(outcomes);
    each.map(|((time, sensor), outcome)| (time, *sensor as usize, labels[usize::from(*outcome)].clone()))
        .collect()
}

/// The shipped scenario: each false reading is refused when it arrives, and only that which nothing shows turns the estimate.
#[test]
fn an_attitude_filter_refuses_false_readings() {
    let path = format!("{}/../../scenarios/false-readings.toml", env!("CARGO_MANIFEST_DIR"));
    let scenario = Scenario::load(path.as_ref()).expect("a shipped scenario");
    let trace = traced(&scenario);
    let found = refusals(&trace);
    let of = |from: f64, to: f64| -> Vec<(usize, &str)> {
        let within = found.iter().filter(|(time, ..)| (from..to).contains(time));
        within.map(|(_, sensor, outcome)| (*sensor, outcome.as_str())).collect()
    };
    // A star tracker reports 0.2 s after its exposure.
    assert_eq!(of(60.1, 60.3), [(1, "improbable")]);
    assert_eq!(of(90.0, 90.05), [(0, "unsound")]);
    assert_eq!(of(120.1, 120.3), [(1, "unsound")]);
    assert_eq!(of(135.0, 135.05), [(0, "unsound")]);
    assert_eq!(of(150.1, 160.1), vec![(1, "unsound"); 20]);
    assert_eq!(of(180.1, 182.0), vec![(1, "improbable"); 3]);
    let spiked = of(240.0, 260.0);
    assert_eq!(spiked[..6], [[(1, "improbable"); 5].as_slice(), &[(1, "reaccepted")]].concat(), "{spiked:?}");
    let errors = within(&trace, "/attitude_filter", "axes", "angle_error_rad");
    let times = crate::traces::times(&trace, "/attitude_filter");
    for (time, error) in times.iter().zip(errors.chunks(3)) {
        let most = if (20.0..240.0).contains(time) || *time > 300.0 { 6e-4 } else { 1e-1 };
        assert!(error.iter().all(|part| part.abs() < most), "{time}: {error:?}");
    }
}

#[test]
fn false_readings_need_a_filter_and_a_size() {
    let text = |fault: &str, estimator: &str| {
        format!(
            "duration = 20.0\n[spacecraft]\nmass = 1.0\ninertia = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]\n\
             [[sensor]]\ngyro = {{ period = 0.1, angle_random_walk = 1e-6 }}\n\
             [[sensor]]\nstar_tracker = {{ period = 0.5, noise = [1e-5, 1e-5, 1e-5], faults = [{fault}] }}\n\
             {estimator}\n[law.attitude]\nperiod = 0.5\nbandwidth = 0.05\n"
        )
    };
    let said = refused(&text("{ outlier = { from = 1.0 } }", "[estimator.attitude]"));
    assert!(
        said.contains("faults") && said.contains("must have an `angle` or a `rate` other than 0"),
        "{said}"
    );
    let said = refused(&text("{ outlier = { from = 1.0, rate = 0.1 } }", "[estimator.attitude]"));
    assert!(said.contains("`sensor[1].star_tracker.faults[0].outlier.rate` alters measured rates"), "{said}");
    let gyro = text("{ outlier = { from = 1.0, angle = 0.1 } }", "[estimator.attitude]")
        .replace("1e-6 }", "1e-6, faults = [{ outlier = { from = 1.0, angle = 0.1 } }] }");
    let said = refused(&gyro);
    assert!(said.contains("`sensor[0].gyro.faults[0].outlier.angle` alters a measured angle"), "{said}");
    let said = refused(&text("{ zero = { from = 1.0 } }", ""));
    assert!(said.contains("has `zero`, which an `[estimator.attitude]` refuses"), "{said}");
    let said = refused(&text("{ invalid = { from = 2.0, to = 1.0 } }", "[estimator.attitude]"));
    assert!(said.contains("`from` before `to`"), "{said}");
    let said =
        refused(&text("{ silent = { from = 1.0 } }", "[estimator.attitude]\ngate = { deviations = 0 }"));
    assert!(said.contains("deviations"), "{said}");
}
