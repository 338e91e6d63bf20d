//! Small rotations about three axes in closed form: relays with a continuous sensor against numbers of 40 digits and
//! against one axis, the finite rotation, conservation, limits, and what is refused.
//!
//! Golden numbers: tests/golden/small_angles_oracle.py, mpmath.

use std::fmt::Write as _;

use flexsc_core::control::quantity::total_width;
use flexsc_core::numerics::attitude::{Vector, rotation_vector};
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::{Scenario, Simulation, StopAt};
use nalgebra::Quaternion;

const ZONE: f64 = 5e-4;
const HYSTERESIS: f64 = 1e-4;

/// Returns the relay law about an axis with these torques (N m).
fn relay(strong: f64, weak: f64) -> String {
    format!(
        "relay = {{ dead_zone = {ZONE}, hysteresis = {HYSTERESIS}, strong = {strong}, weak = {weak}, k_t = 0.33 }}"
    )
}

/// Body of tests/golden/small_angles_oracle.py, whose tensor and modes couple the axes.
fn coupled(duration: f64) -> Scenario {
    let text = format!(
        "duration = {duration}
[body.spatial]
inertia = [[100.0, 6.0, -9.0], [6.0, 80.0, 4.0], [-9.0, 4.0, 60.0]]
rate = [3e-5, -2e-5, 1e-5]
small_angles = {{ angle = 0.01, rate = 1e-3 }}
points = [{{ name = \"hub\" }}]
modes = [
    {{ frequency = 0.7, damping = 0.01, displacement = 2e-4, shapes.hub = {{ rotation = [0.05, 0.02, -0.03] }} }},
    {{ frequency = 1.9, damping = 0.004, shapes.hub = {{ rotation = [-0.01, 0.04, 0.03] }} }},
    {{ frequency = 3.1, displacement = -1e-4, shapes.hub = {{ rotation = [0.02, -0.03, 0.04] }} }},
]
[law.per_axis]
roll = {{ {} }}
pitch = {{ {} }}
yaw = {{ {} }}
[[disturbance]]
about = \"pitch\"
torque = 2e-5
",
        relay(8e-3, 2e-4),
        relay(5e-3, 1e-4),
        relay(4e-3, 1e-4)
    );
    Scenario::parse("coupled.toml", &text).expect("valid")
}

/// Returns the femtoseconds of an instant.
fn femtoseconds(at: Instant) -> i128 {
    let (whole, part) = at.parts();
    i128::from(whole) * 1_000_000_000_000_000 + i128::from(part)
}

/// Returns the femtoseconds of a decimal number of seconds.
fn decimal(text: &str) -> i128 {
    let (seconds, digits) = text.split_once('.').expect("decimals");
    let digits = format!("{digits:0<15}")[..15].parse::<i128>().expect("digits");
    seconds.parse::<i128>().expect("seconds") * 1_000_000_000_000_000 + digits
}

/// Returns the instants (fs) at which laws switch, and the run at its end.
fn switchings(scenario: &Scenario) -> (Vec<i128>, Simulation) {
    let mut run = Simulation::new(scenario, 0);
    let mut times = Vec::new();
    while run.run_to_next(StopAt::Switching, Instant::END, &mut ()).expect("a run") {
        times.push(femtoseconds(run.time()));
    }
    (times, run)
}

/// Returns the observation of a run.
fn observed(scenario: &Scenario, run: &mut Simulation) -> Vec<f64> {
    let width = total_width(&run.observation_fields(scenario));
    let mut row = vec![0.0; width];
    run.observe(&mut row).expect("finite");
    row
}

#[test]
fn relays_about_coupled_axes_switch_where_40_digits_put_them() {
    // Rounding grows in the chaotic transient of these relays: by a factor of 10 in about 40 s.
    let scenario = coupled(120.0);
    let (times, mut run) = switchings(&scenario);
    let golden = include_str!("golden/small_angles.csv");
    let (exact, end): (Vec<&str>, Vec<&str>) = golden.lines().partition(|line| !line.starts_with("end"));
    assert_eq!(times.len(), exact.len());
    let mut worst = 0;
    for (time, line) in times.iter().zip(&exact) {
        let (instant, _) = line.split_once(',').expect("an axis");
        worst = worst.max((time - decimal(instant)).abs());
    }
    let first = (times[0] - decimal(exact[0].split(',').next().expect("a time"))).abs();
    assert!(first < 20 && worst < 5_000, "{first} {worst} fs");
    let end: Vec<f64> = end[0].split(',').skip(1).map(|cell| cell.parse().expect("a number")).collect();
    let row = observed(&scenario, &mut run);
    let angles = rotation_vector(&Quaternion::identity(), &Quaternion::new(row[0], row[1], row[2], row[3]));
    let found: Vec<f64> = angles.iter().copied().chain(row[10..16].iter().copied()).collect();
    assert_eq!(found.len(), end.len());
    for (found, exact) in found.iter().zip(&end) {
        assert!((found - exact).abs() < 2e-15, "{found} {exact}");
    }
}

/// About each axis of a diagonal tensor, with modes of its own, a relay switches when it does on that axis alone.
#[test]
fn uncoupled_axes_switch_as_each_does_alone() {
    let inertias = [100.0, 80.0, 60.0];
    let torques = [(8e-3, 2e-4), (5e-3, 1e-4), (4e-3, 1e-4)];
    let rates = [3e-5, -2e-5, 1e-5];
    let disturbed = [1e-5, 2e-5, -3e-5];
    // Frequency, damping, rotation of the hub, and displacement at the start of a mode about each axis.
    let modes = [(0.44, 0.0, 0.015, 2e-4), (0.755, 0.01, 0.02, 0.0), (1.3, 1.5, 0.03, 1e-4)];
    let mut alone: Vec<i128> = Vec::new();
    let (mut modes_text, mut laws, mut loads) = (String::new(), String::new(), String::new());
    for (axis, name) in ["roll", "pitch", "yaw"].into_iter().enumerate() {
        let ((frequency, damping, shape, start), inertia) = (modes[axis], inertias[axis]);
        let (rate, torque, law) = (rates[axis], disturbed[axis], relay(torques[axis].0, torques[axis].1));
        let (gain, shown) = (shape * shape * inertia, shape * start);
        let text = format!(
            "duration = 600.0\nlaw = {{ {law} }}\n[[disturbance]]\ntorque = {torque}\n[body.planar]\ninertia = {inertia}
rate = {rate}\nmodes = [{{ frequency = {frequency}, damping = {damping}, gain = {gain}, displacement = {shown} }}]"
        );
        alone.extend(switchings(&Scenario::parse("alone.toml", &text).expect("valid")).0);
        let mut rotation = [0.0; 3];
        rotation[axis] = shape;
        let _ = writeln!(
            modes_text,
            "{{ frequency = {frequency}, damping = {damping}, displacement = {start}, shapes.hub = {{ rotation = {rotation:?} }} }},"
        );
        let _ = writeln!(laws, "{name} = {{ {law} }}");
        let _ = writeln!(loads, "[[disturbance]]\nabout = \"{name}\"\ntorque = {torque}");
    }
    let [x, y, z] = inertias;
    let text = format!(
        "duration = 600.0\n[law.per_axis]\n{laws}{loads}[body.spatial]\nsmall_angles = {{}}\nrate = {rates:?}
inertia = [[{x}, 0, 0], [0, {y}, 0], [0, 0, {z}]]\npoints = [{{ name = \"hub\" }}]\nmodes = [\n{modes_text}]"
    );
    let (together, _) = switchings(&Scenario::parse("together.toml", &text).expect("valid"));
    alone.sort_unstable();
    assert!(alone.len() > 60, "{}", alone.len());
    assert_eq!(together.len(), alone.len());
    let worst = together.iter().zip(&alone).map(|(a, b)| (a - b).abs()).max().unwrap_or(0);
    assert!(worst <= 1_000, "{worst} fs");
}

/// At each trip the law reads an angle that is at or beyond the level on which the guard was tested.
#[test]
fn laws_read_the_angle_on_which_guards_trip() {
    let scenario = coupled(400.0);
    let mut run = Simulation::new(&scenario, 0);
    let (mut trips, mut decisions) = (0, 0);
    while run.run_to_next(StopAt::Decision, Instant::END, &mut ()).expect("a run") {
        decisions += 1;
        let row = observed(&scenario, &mut run);
        let read = &row[row.len() - 6..row.len() - 3];
        let back = ZONE - HYSTERESIS;
        let outward = |angle: f64| (angle.abs() - ZONE).abs() < 1e-15 && angle.abs() >= ZONE;
        let inward = |angle: f64| (angle.abs() - back).abs() < 1e-15 && angle.abs() <= back;
        trips += usize::from(read.iter().any(|angle| outward(*angle) || inward(*angle)));
    }
    assert!(decisions > 100, "{decisions}");
    // Two of three decisions are trips; the brake ends by its time.
    let apart = (3 * trips).abs_diff(2 * decisions);
    assert!(apart <= 9, "{trips} trips of {decisions} decisions");
}

/// The difference from the finite rotation is of second order: a quarter at half the amplitude.
#[test]
fn the_difference_from_finite_rotation_is_of_second_order() {
    let spacecraft = |amplitude: f64, small: &str| {
        let half = 0.5 * amplitude / f64::sqrt(3.0);
        let w = f64::sqrt(1.0 - 3.0 * half * half);
        format!(
            "duration = 40.0\n[sensor.sampled]\nperiod = 0.1\n[law.pd]\nk_p = 4.0\nk_d = 30.0\nperiod = 0.1
[spacecraft]\nmass = 200.0\ninertia = [[80.0, 1.0, 0.0], [1.0, 70.0, 0.0], [0.0, 0.0, 60.0]]
attitude = [{w}, {half}, {half}, {half}]\n{small}
[[appendage]]\nname = \"panel\"\nmass = 10.0\ncentre = [0.0, 1.5, 0.0]\nat = [0.0, 0.5, 0.0]\nplate = \"y\"
inertia = [[10.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 10.0]]
modes = [{{ frequency = 1.0, damping = 0.01, translation = [0.0, 0.0, 2.0], rotation = [4.0, 0.0, 0.0] }}]\n"
        )
    };
    let body = |amplitude: f64, small: &str| {
        let half = 0.5 * amplitude / f64::sqrt(3.0);
        let w = f64::sqrt(1.0 - 3.0 * half * half);
        format!(
            "duration = 40.0\n[sensor.sampled]\nperiod = 0.1\n[law.pd]\nk_p = 4.0\nk_d = 30.0\nperiod = 0.1
[body.spatial]\ninertia = [[80.0, 5.0, 0.0], [5.0, 70.0, 0.0], [0.0, 0.0, 40.0]]
attitude = [{w}, {half}, {half}, {half}]\n{small}\npoints = [{{ name = \"hub\" }}]
modes = [{{ frequency = 1.0, damping = 0.01, shapes.hub = {{ rotation = [0.05, 0.02, 0.01] }} }}]\n"
        )
    };
    let attitude = |text: &str| {
        let scenario = Scenario::parse("amplitude.toml", text).expect("valid");
        let mut run = Simulation::new(&scenario, 0);
        run.run_until(Instant::START + Span::from_seconds(8.0), &mut ()).expect("a run");
        let row = observed(&scenario, &mut run);
        Quaternion::new(row[0], row[1], row[2], row[3])
    };
    for is_spacecraft in [true, false] {
        let write = |amplitude, small| {
            if is_spacecraft { spacecraft(amplitude, small) } else { body(amplitude, small) }
        };
        let difference = |amplitude: f64| {
            let small = attitude(&write(amplitude, "small_angles = { angle = 0.3, rate = 0.1 }"));
            rotation_vector(&small, &attitude(&write(amplitude, ""))).norm()
        };
        let [large, half, quarter] = [0.08, 0.04, 0.02].map(difference);
        assert!(large > 1e-6 && large < 0.08 * 0.08, "{large}");
        for ratio in [large / half, half / quarter] {
            assert!((ratio / 4.0 - 1.0).abs() < 0.1, "{ratio}");
        }
    }
}

/// Torques change the momentum by their impulse, and a constant force by its moment and its push on the modes.
#[test]
fn momentum_and_energy_balance() {
    let text = "duration = 50.0
law.open = {}
[body.spatial]
inertia = [[100.0, 6.0, -9.0], [6.0, 80.0, 4.0], [-9.0, 4.0, 60.0]]
rate = [1e-4, 2e-4, -1e-4]
small_angles = {}
points = [{ name = \"hub\" }, { name = \"tip\", position = [0.0, 2.0, 0.0] }]
disturbance = { constant = [0.0, 0.0, 1e-4] }
modes = [
    { frequency = 1.7, shapes.hub = { rotation = [0.03, 0.01, 0.0] }, shapes.tip = { translation = [0.0, 0.0, 0.2] } },
]
[[disturbance]]
about = \"roll\"
torque = 1e-3
from = 10.0
to = 30.0
[[disturbance]]
force = [0.0, 0.0, 1e-3]
point = \"tip\"
from = 5.0
to = 25.0
";
    let scenario = Scenario::parse("balance.toml", text).expect("valid");
    let body = scenario.model.three_axis().expect("three axes");
    let mut run = Simulation::new(&scenario, 0);
    run.run_until(Instant::END, &mut ()).expect("a run");
    let row = observed(&scenario, &mut run);
    let (rates, q, v) = (Vector::new(row[10], row[11], row[12]), row[13], row[14]);
    let start = body.inertia * Vector::new(1e-4, 2e-4, -1e-4);
    let impulse = Vector::new(20.0 * 1e-3 + 20.0 * 2e-3, 0.0, 50.0 * 1e-4);
    let error = body.inertia * rates - start - impulse;
    assert!(error.norm() < 1e-15, "{error}");
    // Undamped: the mode rings by the pushes at their beginnings and ends, each with f/w² (1 - cos w (t - t')).
    let w = 1.7;
    let pushes = [(0.2 * 1e-3, 5.0), (-0.2 * 1e-3, 25.0), (0.03 * 1e-3, 10.0), (-0.03 * 1e-3, 30.0)];
    let swing = |(force, from): (f64, f64)| {
        let phase = w * (50.0 - from);
        [force / (w * w) * (1.0 - f64::cos(phase)), force / w * f64::sin(phase)]
    };
    let sum = pushes.map(swing).into_iter().fold([0.0; 2], |sum, of| [sum[0] + of[0], sum[1] + of[1]]);
    assert!((q - sum[0]).abs() < 1e-16 && (v - sum[1]).abs() < 1e-16, "{q} {v} {sum:?}");
}

#[test]
fn a_rotation_beyond_its_limits_ends_the_run_with_its_instant() {
    let text = |limits: &str| {
        format!(
            "duration = 100.0\nlaw.open = {{}}\n[body.spatial]\ninertia = [[100, 0, 0], [0, 80, 0], [0, 0, 60]]
rate = [0, 1e-3, 0]\nsmall_angles = {{ {limits} }}\n[[disturbance]]\nabout = \"pitch\"\ntorque = -8e-3\nfrom = 10.0\n"
        )
    };
    // The pitch is 0.01 rad after 10 s, at most 0.015 rad after 20 s, and -0.005 rad after 10 + 10 + sqrt(400) s.
    for (limits, outcome) in [
        ("angle = 0.0125", Some("pitch is no longer small at t = 12.928932188134")),
        ("angle = 0.0149999, rate = 1e-3", Some("pitch is no longer small at t = 19.9552")),
        (
            "angle = 0.02, rate = 1.5e-3",
            Some("t = 35.000000000000000 s: it leaves `small_angles.rate = 0.0015`"),
        ),
        ("", None),
    ] {
        let run = |stops: &[f64]| {
            let scenario = Scenario::parse("far.toml", &text(limits)).expect("valid");
            let mut run = Simulation::new(&scenario, 0);
            for stop in stops {
                run.run_up_to(Instant::START + Span::from_seconds(*stop), &mut ())?;
            }
            run.run_until(Instant::START + Span::from_seconds(40.0), &mut ())
        };
        for result in [run(&[]), run(&[3.0, 19.0, 36.0])] {
            match (result, outcome) {
                (Err(error), Some(words)) => {
                    assert!(error.to_string().contains(words), "{limits}: {error}");
                }
                (Ok(()), None) => {}
                (result, _) => panic!("{limits}: {result:?}"),
            }
        }
    }
}

const SMALL: &str = "duration = 10.0
[spacecraft]
mass = 200.0
inertia = [[80.0, 1.0, 0.0], [1.0, 70.0, 0.0], [0.0, 0.0, 60.0]]
small_angles = {}
[[appendage]]
name = \"panel\"
mass = 10.0
centre = [0.0, 1.5, 0.0]
inertia = [[10.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 10.0]]
at = [0.0, 0.5, 0.0]
plate = \"y\"
modes = [{ frequency = 1.0, damping = 0.01, translation = [0.0, 0.0, 2.0], rotation = [4.0, 0.0, 0.0] }]
";

#[test]
fn what_is_not_linear_is_refused_with_its_reason() {
    let pd = "[law.pd]\nk_p = 0.4\nk_d = 6.0\nperiod = 0.2\n";
    let orbit = "[environment]\norbit = { semi_major_axis = 7e6, inclination = 1.0 }\n";
    let wheels = "actuator.wheels = { arrangement = \"pyramid\", inertia = 0.01";
    #[rustfmt::skip]
    let cases = [
        ("small_angles = {}", "small_angles = { angle = 1.5 }", "", "`spacecraft.small_angles.angle`"),
        ("small_angles = {}", "small_angles = { rate = -1 }", "", "must be a positive number, got -1"),
        ("small_angles = {}", "small_angles = { size = 1 }", "", "unknown key `size`"),
        ("small_angles = {}", "small_angles = {}\nrate = [0, 0.02, 0]", "", "`spacecraft.rate` must be within `small_angles.rate = 0.01` about each axis, got 0.02 rad/s about pitch"),
        ("small_angles = {}", "small_angles = {}\nattitude = [0.8, 0, 0, 0.6]", "", "`spacecraft.attitude` must be within `small_angles.angle = 0.1` about each axis"),
        ("small_angles = {}", "small_angles = {}\nwhole_damping = true", "", "`spacecraft.whole_damping` needs uncoupled free modes"),
        ("plate = ", "drive = { about = [0, 1, 0], rate = 0.001 }\nplate = ", "", "`appendage[0].drive` changes the modes"),
        ("", "", "[[target]]\nfrom = 5.0\nroll = 0.01\n", "`target` must stay fixed from the start"),
        ("", "", "[[target]]\nfrom = 0.0\nroll = 0.01\nrate_limit = 1e-3\nacceleration = 1e-3\n", "`target` must stay fixed"),
        ("", "", "[environment]\ngravity_gradient = { orbit_rate = 1.1e-3 }\n", "`environment.gravity_gradient` is a torque that changes with the attitude"),
        ("", "", "[environment]\ntorque = [1e-4, 0, 0]\n", "`environment.torque`"),
        ("duration", "actuator.magnetorquers = { moment = 10.0 }\nduration", &format!("{orbit}magnetic_field = {{}}\n"), "`actuator.magnetorquers` push with a torque that changes"),
        ("duration", &format!("{wheels}, speeds = [9.0, 5.0, 5.0, 5.0] }}\nduration"), "", "`actuator.wheels.speeds` stores momentum from the start"),
        ("duration", &format!("{wheels}, friction = {{ viscous = 1e-5 }} }}\nduration"), "", "`actuator.wheels.friction`"),
        ("", "", "[[sensor]]\nsampled = { period = 0.2 }\n[[sensor]]\naccelerometer = { period = 0.2 }\n", "`sensor[1].accelerometer` measures the force on the coupled motion"),
        ("", "", "[[disturbance]]\nabout = \"roll\"\nsines = [{ amplitude = 1e-3, frequency = 1.0 }]\n", "`disturbance[0].sines` change with time"),
    ];
    for (from, to, more, words) in cases {
        let text = format!("{}{pd}{more}", SMALL.replacen(from, to, 1));
        let error = Scenario::parse("refused.toml", &text).expect_err(words).to_string();
        assert!(error.contains(words), "{words}: {error}");
    }
    let accepted = format!("{SMALL}{pd}[[target]]\nfrom = 0.0\nroll = 0.01\n{orbit}magnetic_field = {{}}\n");
    Scenario::parse("accepted.toml", &accepted).expect("valid");
}

/// Boundaries of two axes that are reached at one instant concern each its own law, roll first.
#[test]
fn simultaneous_trips_are_answered_axis_by_axis() {
    let text = format!(
        "duration = 60.0\nlaw = {{ {} }}\n[body.spatial]\ninertia = [[50, 0, 0], [0, 50, 0], [0, 0, 50]]
rate = [1e-4, 1e-4, 0]\nsmall_angles = {{}}\n",
        relay(4e-3, 1e-4)
    );
    let (times, _) = switchings(&Scenario::parse("twins.toml", &text).expect("valid"));
    // Yaw, which starts at rest under the weak torque, is slower.
    let pairs = times.chunks(2).filter(|pair| pair.len() == 2 && pair[0] == pair[1]).count();
    assert!(times.len() >= 6 && pairs >= 2, "{times:?}");
}
