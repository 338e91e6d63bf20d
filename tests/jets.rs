//! Jets with individual allocation: the least propellant for the demand of the laws. The linear programme itself is
//! compared with SciPy's in `crates/numerics/src/simplex.rs`; here its effects are tested.

use flexsc_core::Scenario;
use flexsc_core::metrics::{MetricValue, Metrics};
use flexsc_core::record::{Column, Detail, Trace};

use crate::util::SCENARIOS;

fn text(name: &str) -> String {
    std::fs::read_to_string(format!("{SCENARIOS}/{name}.toml")).expect("a file")
}

fn flown(text: &str) -> (Metrics, Trace) {
    let scenario = Scenario::parse("jets.toml", text).unwrap_or_else(|error| panic!("{error}"));
    crate::traces::flown(&scenario, 0, Detail::Full)
}

/// Returns the on-times of each cycle in which any thruster fires.
fn pulses(trace: &Trace) -> Vec<Vec<f64>> {
    match trace.topic("/thrusters").and_then(|rows| rows.get("thrusters")) {
        Some(Column::Rows(counts, columns)) => {
            let all = columns.numbers("on_s").expect("times");
            all.chunks(counts[0] as usize).map(<[f64]>::to_vec).collect()
        }
        _ => panic!("no thrusters"),
    }
}

/// The scenario's comment: canted thrusters turn the body as the law demands, and hold it.
#[test]
fn canted_thrusters_turn_a_body_by_what_is_cheapest() {
    let (metrics, trace) = flown(&text("canted-jets"));
    assert_eq!(metrics.get("goal"), Some(&MetricValue::Word("met")));
    let (fuel, pulses) = (metrics.number("fuel_kg").expect("propellant"), pulses(&trace));
    let on: f64 = pulses.iter().flatten().sum();
    assert!((fuel / (on * 0.5 / (220.0 * 9.806_65)) - 1.0).abs() < 1e-12, "{fuel}");
    // A vertex of three rows has three thrusters that fire in part, unless the torque is more than there is.
    assert!(pulses.iter().all(|row| row.iter().filter(|on| **on > 0.0 && **on < 1.0).count() <= 3));
    assert!(pulses.iter().flatten().all(|on| *on == 0.0 || (0.005..=1.0).contains(on)));
    // Without a force the body stays where it is, and propellant is more.
    let (free, calm) =
        flown(&text("canted-jets").replace("minimum_on = 0.005", "force_free = true\nminimum_on = 0.0"));
    assert_eq!(free.get("goal"), Some(&MetricValue::Word("met")));
    let speed = |trace: &Trace| {
        let last = |name: &str| {
            *trace.topic("/position").and_then(|rows| rows.numbers(name)?.last()).expect("a row")
        };
        ["x_m_s", "y_m_s", "z_m_s"].map(last).iter().map(|v| v * v).sum::<f64>().sqrt()
    };
    assert!(free.number("fuel_kg").expect("propellant") > fuel);
    assert!(speed(&calm) < 5e-3 * speed(&trace), "{} {}", speed(&calm), speed(&trace));
}

/// The pulses of a cycle turn a rigid body by the impulse that was demanded: J w' = torque over the cycle, but for the
/// gyroscopic torque.
#[test]
fn pulses_give_what_is_demanded() {
    let rigid = "duration = 4.0\n[spacecraft]\nmass = 100.0\ninertia = [[30, 0, 0], [0, 40, 0], [0, 0, 35]]\npoints = [{ name = \"bus\" }]\n\
        [law.open]\n[[disturbance]]\nabout = \"roll\"\n[log]\nperiod = 1.0\n";
    let jets = text("canted-jets");
    let jets = &jets[jets.find("[actuator.jets]").expect("jets")..jets.find("[reference]").expect("an end")];
    let jets = jets.replace("minimum_on = 0.005", "minimum_on = 0.0");
    let body = rigid.replace(
        "[law.open]",
        "attitude = [0.9999929999754998, 0.003, -0.002, 0.001]\n[law.pd]\nk_p = 3.0\nk_d = 0.0\nperiod = 1.0",
    );
    let (_, trace) = flown(&format!("{body}{jets}"));
    let rows = |topic: &str, name: &str| match trace.topic(topic).and_then(|rows| rows.get("axes")) {
        Some(Column::Rows(_, columns)) => columns.numbers(name).expect("numbers").to_vec(),
        _ => panic!("{topic}"),
    };
    let pulses = pulses(&trace);
    let places = [[1.0, 1.0, 1.0], [-1.0, 1.0, 1.0], [-1.0, -1.0, 1.0], [1.0, -1.0, 1.0]];
    let directions = [
        [0.48, -0.64, -0.6],
        [-0.48, 0.64, -0.6],
        [0.64, 0.48, -0.6],
        [-0.64, -0.48, -0.6],
        [-0.64, 0.48, 0.6],
        [0.64, -0.48, 0.6],
        [-0.48, -0.64, 0.6],
        [0.48, 0.64, 0.6],
    ];
    let mut turned = [0.0; 3];
    for (thruster, on) in pulses[0].iter().enumerate() {
        let [x, y, z] = places[thruster % 4];
        let (x, y, z) = (0.5 * x, 0.5 * y, if thruster < 4 { 0.4 * z } else { -0.4 * z });
        let [u, v, w] = directions[thruster].map(|part| 0.5 * part * on);
        let torque = [y * w - z * v, z * u - x * w, x * v - y * u];
        (0..3).for_each(|axis| turned[axis] += torque[axis]);
    }
    // Half of an angle is in the quaternion: -3 times 0.006, -0.004 and 0.002 rad.
    let rates = rows("/rates", "rigid_rad_s");
    for (axis, (angle, inertia)) in [(0.006, 30.0), (-0.004, 40.0), (0.002, 35.0)].into_iter().enumerate() {
        assert!((turned[axis] + 3.0 * angle).abs() < 1e-6, "{axis}: {}", turned[axis]);
        // Within a second (J_y - J_x) w_x w_y adds 1.8e-6 N m s about yaw at most.
        assert!((rates[3 + axis] * inertia - turned[axis]).abs() < 2e-6, "{axis}");
    }
}

/// Jets that unload wheels do so by the least propellant too, and one that is dead is made up for by the wheels.
#[test]
fn wheels_are_unloaded_by_the_least_propellant() {
    let unloading = text("momentum-unloading");
    let groups = unloading.find("groups = {").expect("groups");
    let end = unloading.find("\n[reference]").expect("an end");
    let alone = format!("{}{}", &unloading[..groups], &unloading[end..])
        .replace("minimum_on = 0.01", "allocation = \"least_propellant\"\nminimum_on = 0.01");
    let ((by_groups, _), (by_itself, trace)) = (flown(&unloading), flown(&alone));
    assert_eq!(by_itself.get("goal"), Some(&MetricValue::Word("met")));
    let fuel = |metrics: &Metrics| metrics.number("fuel_kg").expect("propellant");
    // Only the axis that a group turns is unloaded: there is nothing to gain.
    assert!((fuel(&by_itself) / fuel(&by_groups) - 1.0).abs() < 1e-12);
    assert!(!pulses(&trace).is_empty());
}

#[test]
fn what_does_not_go_with_it_is_refused() {
    let jets = text("canted-jets");
    let refused = |from: &str, to: &str, words: &str| {
        assert!(jets.contains(from), "{from}");
        let error = Scenario::parse("j.toml", &jets.replace(from, to)).expect_err(to).to_string();
        assert!(error.contains(words), "{error}");
    };
    let groups = "groups = { roll = { plus = [\"a\"], minus = [\"b\"] }, pitch = { plus = [\"a\"], minus = [\"b\"] }, yaw = { plus = [\"a\"], minus = [\"b\"] } }\nspecific";
    refused("specific", groups, "`actuator.jets.groups` apply only to `allocation");
    refused("allocation = \"least_propellant\"\n", "", "`actuator.jets.groups` must be given, or");
    refused(
        "allocation = \"least_propellant\"\n",
        "force_free = true\n",
        "`actuator.jets.force_free` applies only to",
    );
    let only = jets.find("    { name = \"e\"").expect("a thruster");
    let last = jets.find("]\n\n[reference]").expect("an end");
    let error = Scenario::parse("j.toml", &format!("{}{}", &jets[..only], &jets[last..]))
        .expect_err("four")
        .to_string();
    assert!(error.contains("`actuator.jets.thrusters` must be able to turn the body to"), "{error}");
    refused(
        "[actuator.jets]",
        "[sensor.gyro]\n[estimator.adaptive]\n[actuator.jets]",
        "`estimator.adaptive` predicts by the pulses of groups",
    );
}

/// A rigid body with the thrusters of the shipped orbit correction, and a burn from 1.25 s to 3 s.
fn burning(force: &str, attitude: &str) -> String {
    let jets = text("orbit-correction");
    let jets = &jets[jets.find("[actuator.jets]").expect("jets")..jets.find("[reference]").expect("an end")];
    let jets = jets.replace("minimum_on = 0.01 ", "minimum_on = 0.0 ").replace(
        "from = 320.0, to = 420.0, force = [0.0, 0.0, 36.0]",
        &format!("from = 1.25, to = 3.0, force = {force}"),
    );
    format!(
        "duration = 5.0\n[spacecraft]\nmass = 2800.0\ninertia = [[2600, 0, 0], [0, 1900, 0], [0, 0, 2700]]\n\
         attitude = {attitude}\npoints = [{{ name = \"bus\" }}]\n[law.pd]\nk_p = 100.0\nk_d = 0.0\nperiod = 0.5\n[log]\nperiod = 0.5\n{jets}"
    )
}

const THRUSTER_TORQUES: [[f64; 3]; 4] = [
    [7.139_696_961_966_999, -4.937_686_860_769_999, 1.22],
    [7.139_696_961_966_999, 4.541_707_063_323_333, -1.18],
    [-7.139_696_961_966_999, 4.541_707_063_323_333, 1.18],
    [-7.139_696_961_966_999, -4.937_686_860_769_999, -1.22],
];
const AXIAL_FORCE: f64 = 9.899_494_936_611_665;

/// Returns the angular impulse (N m s) and the axial impulse (N s) of each cycle of half a second.
fn impulses(trace: &Trace) -> Vec<([f64; 3], f64)> {
    let impulse = |on: &Vec<f64>| {
        let about = |axis: usize| on.iter().zip(THRUSTER_TORQUES).map(|(on, torque)| on * torque[axis]).sum();
        ([0, 1, 2].map(about), on.iter().sum::<f64>() * AXIAL_FORCE)
    };
    pulses(trace).iter().map(impulse).collect()
}

/// A burn gives its impulse, a partial cycle a part of it, without a torque; the body keeps its attitude.
#[test]
fn a_burn_gives_the_commanded_impulse() {
    let (metrics, trace) = flown(&burning("[0.0, 0.0, 36.0]", "[1.0, 0.0, 0.0, 0.0]"));
    let cycles = impulses(&trace);
    // From 1.0 to 3.0 s; later pulses only correct the attitude.
    for (index, (angular, axial)) in cycles[..4].iter().enumerate() {
        let exact = if index == 0 { 9.0 } else { 18.0 };
        assert!((axial - exact).abs() < 1e-9, "{index}: {axial}");
        // The law corrects what pulses of unequal lengths turn the body within the cycle before.
        let most = if index == 0 { 1e-10 } else { 5e-3 };
        assert!(angular.iter().all(|part| part.abs() < most), "{index}: {angular:?}");
    }
    let impulse = metrics.number("burn_impulse_n_s").expect("a burn");
    assert!((impulse - 63.0).abs() < 1e-8, "{impulse}");
    let speed = *trace.topic("/position").and_then(|rows| rows.numbers("z_m_s")?.last()).expect("a row");
    // The pulses that correct the attitude push as well.
    assert!((speed - 63.0 / 2800.0).abs() < 5e-5, "{speed}");
    // A thruster that fails is missing in the impulse along the force.
    let failing = burning("[0.0, 0.0, 36.0]", "[1.0, 0.0, 0.0, 0.0]").replace(
        "specific_impulse",
        "faults = [{ dead = { from = 2.0, thruster = \"b\" } }]\nspecific_impulse",
    );
    let (weak, _) = flown(&failing);
    assert!(weak.number("burn_impulse_n_s").expect("a burn") < 55.0);
}

/// With more force than the thrusters have, the torque of the law comes first and they are off-modulated: SciPy's `linprog`
/// (tests/golden/burn_oracle.py) finds the same on-times for the demanded torque.
#[test]
fn the_torque_comes_before_the_force() {
    let attitude = "[0.9999988750004219, 0.001, -0.0005, 0.001]";
    let (_, trace) = flown(&burning("[0.0, 0.0, 40.0]", attitude));
    let attitude =
        |name: &str| trace.topic("/pointing").and_then(|rows| rows.numbers(name)).expect("attitudes");
    let times = crate::traces::times(&trace, "/pointing");
    let golden = crate::traces::golden_rows("burn.csv");
    for (row, cycle) in golden.iter().zip([2, 3]) {
        let at = times.iter().position(|time| *time == 0.5 * cycle as f64).expect("a row");
        for (demand, name) in row.iter().zip(["q_x", "q_y", "q_z"]) {
            assert!((demand + 200.0 * attitude(name)[at]).abs() < 1e-12, "{name}");
        }
        let on = &pulses(&trace)[cycle];
        assert!(row[3..].iter().zip(on).all(|(exact, on)| (exact - on).abs() < 1e-11), "{on:?}");
    }
}

#[test]
fn burns_that_cannot_be_flown_are_refused() {
    let good = burning("[0.0, 0.0, 36.0]", "[1.0, 0.0, 0.0, 0.0]");
    let burn = "{ from = 1.25, to = 3.0, force = [0.0, 0.0, 36.0] }";
    let cases = [
        (good.replace("to = 3.0", "to = 1.0"), "burns[0].to", "must be later than `from`, 1.25 s, got 1"),
        (
            good.replace(burn, &format!("{burn}, {{ from = 2.0, to = 4.0, force = [0, 0, 1] }}")),
            "burns[1].from",
            "at or after the end of the burn before, 3 s, got 2",
        ),
        (good.replace("36.0]", "0.0]"), "burns[0].force", "must not be zero"),
        (good.replace("36.0]", "-36.0]"), "burns[0].force", "without turning it"),
        (
            good.replace("36.0]", "36e3]"),
            "burns[0].force",
            "at most 40 N, the thrust of all thrusters, got 36000",
        ),
    ];
    for (text, key, why) in cases {
        let error = Scenario::parse("burn.toml", &text).expect_err(why).to_string();
        assert!(error.contains(key) && error.contains(why), "{key}: {error}");
    }
    let grouped = text("momentum-unloading").replacen(
        "specific_impulse",
        &format!("burns = [{burn}]\nspecific_impulse"),
        1,
    );
    let error = Scenario::parse("burn.toml", &grouped).expect_err("unloading").to_string();
    assert!(error.contains("burns") && error.contains("unload"), "{error}");
}
