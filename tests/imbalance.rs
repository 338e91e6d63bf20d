//! Imbalance on the reference spacecraft: steady motion through a mode's line, and a run-up through it, against two
//! oracles.

use nalgebra::{Complex, DMatrix, DVector, Matrix3, Quaternion};

use flexsc_core::Scenario;
use flexsc_core::control::actuator::Wheels;
use flexsc_core::dynamics::three_axis::{Bearing, FlexibleBody, Rotor, SegmentLoads, ThreeAxisMotion};
use flexsc_core::numerics::attitude::Vector;

const CRAFT: &str = include_str!("golden/craft.toml");
const MODES: &str = include_str!("golden/turning/modes.csv");
/// Speed of the wheel; amplitudes of the rate about x, y and z; their norm.
const LINE: &str = include_str!("golden/turning/f.csv");
/// Time; rate about x, y and z; speed of the wheel.
const RUN_UP: &str = include_str!("golden/turning/run-up.csv");
const INERTIA: f64 = 0.04;

type C = Complex<f64>;

fn wave(angle: f64) -> C {
    let (sin, cos) = angle.sin_cos();
    C::new(cos, sin)
}

fn rows(text: &str) -> Vec<Vec<f64>> {
    let row = |line: &str| line.split(',').map(str::parse).collect::<Result<Vec<f64>, _>>().ok();
    text.lines().filter(|line| !line.starts_with('#')).filter_map(row).collect()
}

fn wheels(imbalance: &str) -> Wheels {
    flexsc_core::formats::document::from_text(&format!(
        "arrangement = \"pyramid\"\ncant = 0.6108652381980153\ninertia = {INERTIA}\nimbalance = {{ {imbalance} }}"
    ))
    .expect("valid")
}

/// Imbalance of craft.json: the first wheel alone is out of balance.
const FIRST: &str = "static = [7.2e-6, 0, 0, 0], dynamic = [3e-7, 0, 0, 0], \
                     positions = [[0.3, 0.3, -0.4], [-0.3, 0.3, -0.4], [-0.3, -0.3, -0.4], [0.3, -0.3, -0.4]]";

/// A thousandth of this imbalance: such a small motion is linear to 1e-11.
const SLIGHT: &str = "static = [7.2e-9, 0, 0, 0], dynamic = [3e-10, 0, 0, 0], \
                      positions = [[0.3, 0.3, -0.4], [-0.3, 0.3, -0.4], [-0.3, -0.3, -0.4], [0.3, -0.3, -0.4]]";

/// Returns the reference spacecraft with its full damping matrix, and the bearings and axes of its wheels.
fn craft(imbalance: &str) -> (FlexibleBody, Vec<Bearing>, Vec<Vector>) {
    let text = format!(
        "{CRAFT}\n[actuator.wheels]\narrangement = \"pyramid\"\ncant = 0.6108652381980153\ninertia = {INERTIA}\n"
    );
    let scenario = Scenario::parse("craft", &text).expect("valid");
    let craft = scenario.model.spacecraft().expect("valid");
    let mut model = craft.model.clone();
    let coupling = model.coupling.as_mut().expect("two-way");
    let rows = rows(MODES);
    // The table's modes may have other signs.
    let sign = |mode: usize| {
        let there = Vector::from_row_slice(&rows[mode + 1][1..4]);
        there.dot(&coupling.rotations[mode]).signum()
    };
    let damping = DMatrix::from_fn(8, 8, |row, column| rows[row + 1][17 + column] * sign(row) * sign(column));
    (coupling.damping, coupling.couples_by_damping) = (damping, true);
    coupling.moments.fill(Matrix3::zeros());
    let flexible = model.flexible().expect("two-way");
    let wheels = wheels(imbalance);
    let bearings = wheels.bearings(&model).expect("valid");
    (flexible, bearings, wheels.rotors().expect("valid").iter().map(|rotor| rotor.axis).collect())
}

/// Returns the complex amplitudes of the modes and of the rate, rigid and total, at a steady speed (rad/s).
fn steady(flexible: &FlexibleBody, bearing: &Bearing, speed: f64) -> (DVector<C>, [nalgebra::Vector3<C>; 2]) {
    let line = &bearing.lines[0];
    let square = speed * speed;
    let torque =
        nalgebra::Vector3::from_fn(|axis, _| C::new(line.torque[0][axis], -line.torque[1][axis]) * square);
    let damping = flexible.damping.as_ref().expect("valid");
    let (count, modes) = (flexible.modes.len(), &flexible.modes);
    let force = DVector::from_fn(count, |mode, _| {
        let own = C::new(line.forces[0][mode], -line.forces[1][mode]) * square;
        (0..3).fold(own, |sum, axis| sum + torque[axis] * modes[mode].rotation[axis])
    });
    let i = C::new(0.0, speed);
    let matrix = DMatrix::from_fn(count, count, |row, column| {
        let w = modes[row].frequency;
        i * damping[(row, column)] + if row == column { C::from(w * w - square) } else { C::from(0.0) }
    });
    let q = matrix.lu().solve(&force).expect("valid");
    let inverse = flexible.inertia.try_inverse().expect("valid").map(C::from);
    let rigid = inverse * torque / i;
    let whole = modes.iter().zip(&q).fold(rigid, |sum, (mode, q)| sum + mode.rotation.map(C::from) * (i * q));
    (q, [rigid, whole])
}

/// Returns wheels without total momentum, the first of which rotates at this speed (rad/s), with torques that cancel (N
/// m).
fn rotors(axes: &[Vector], speed: f64, torque: f64, rate: &Vector) -> Vec<Rotor> {
    let rotor = |(axis, sign): (&Vector, f64)| Rotor {
        axis: *axis,
        momentum: INERTIA * (sign * speed + axis.dot(rate)),
        torque: sign * torque,
    };
    axes.iter().zip([1.0, -1.0, 1.0, -1.0]).map(rotor).collect()
}

#[test]
fn steady_amplitudes_through_the_line_of_a_mode() {
    let (flexible, bearings, _) = craft(FIRST);
    let table = rows(LINE);
    assert!(table.len() > 20);
    for row in &table {
        let (_, [_, whole]) = steady(&flexible, &bearings[0], row[0]);
        for (found, exact) in
            whole.iter().map(|part| part.re.hypot(part.im)).chain([whole.norm()]).zip(&row[1..5])
        {
            // Both codes agree to 2e-12; the table has 13 digits.
            assert!((found - exact).abs() < 1e-11 * row[4], "{}: {found:e} {exact:e}", row[0]);
        }
    }
}

/// The motion stays on the steady one that it begins with.
#[test]
fn the_motion_is_the_steady_one() {
    let (flexible, bearings, axes) = craft(SLIGHT);
    for speed in [40.0, 50.2, 50.4, 60.0] {
        let (q, [rigid, whole]) = steady(&flexible, &bearings[0], speed);
        let modes: Vec<[f64; 2]> = q.iter().map(|q| [q.re, (q * C::new(0.0, speed)).re]).collect();
        let rate = rigid.map(|part| part.re);
        let mut motion = ThreeAxisMotion::new(&flexible, Quaternion::identity(), rate, &modes);
        motion.set_bearings(bearings.clone());
        let hub = motion.view().rate;
        motion.begin_segment(&SegmentLoads {
            rotors: rotors(&axes, speed, 0.0, &hub),
            ..SegmentLoads::default()
        });
        motion.resolve_stick_slip(None);
        let mut worst = 0.0_f64;
        for k in 1..=40 {
            let t = 0.1 * f64::from(k) + 1e-3;
            motion.advance(t, None, || Ok::<(), ()>(())).expect("valid");
            let turn = wave(speed * t);
            let exact = whole.map(|part| (part * turn).re);
            worst = worst.max((motion.view().rate - exact).norm() / whole.norm());
        }
        assert!(worst < 2e-8, "{speed}: {worst:e}");
    }
}

/// The first wheel speeds up by 1 rad/s² from 40 to 60 rad/s, through the line at 50.2 rad/s.
#[test]
fn a_run_up_through_the_line() {
    let (flexible, bearings, axes) = craft(SLIGHT);
    let mut motion = ThreeAxisMotion::new(&flexible, Quaternion::identity(), Vector::zeros(), &[[0.0; 2]; 8]);
    motion.set_bearings(bearings);
    motion.begin_segment(&SegmentLoads {
        rotors: rotors(&axes, 40.0, INERTIA, &Vector::zeros()),
        ..SegmentLoads::default()
    });
    motion.resolve_stick_slip(None);
    let table = rows(RUN_UP);
    let most = table.iter().map(|row| Vector::from_row_slice(&row[1..4]).norm()).fold(0.0, f64::max);
    assert!(table.len() == 80 && most > 3e-10);
    for row in table {
        motion.advance(row[0], None, || Ok::<(), ()>(())).expect("valid");
        let off = (motion.view().rate - Vector::from_row_slice(&row[1..4])).norm();
        assert!(off < 2e-8 * most, "{}: {off:e}", row[0]);
        assert!((motion.rotor_observations(None)[0].speed - row[4]).abs() < 1e-9);
    }
}

/// Twice in a turn, with a force along the axis and a phase.
#[test]
fn harmonics_are_followed() {
    let keys = "harmonics = [{ order = 2.0, force = 1e-6, torque = 1e-7, axial = 2e-6, phase = 0.4 }]";
    let (flexible, bearings, axes) = craft(keys);
    assert_eq!((bearings[0].lines.len(), bearings[0].highest_order()), (1, 2.0));
    let (q, [rigid, whole]) = steady_at(&flexible, &bearings[..1], 31.0, 2.0);
    let modes: Vec<[f64; 2]> = q.iter().map(|q| [q.re, (q * C::new(0.0, 62.0)).re]).collect();
    let mut motion =
        ThreeAxisMotion::new(&flexible, Quaternion::identity(), rigid.map(|part| part.re), &modes);
    let quiet = Bearing { inertia: INERTIA, ..Bearing::default() };
    motion.set_bearings(vec![bearings[0].clone(), quiet.clone(), quiet.clone(), quiet]);
    let hub = motion.view().rate;
    motion.begin_segment(&SegmentLoads { rotors: rotors(&axes, 31.0, 0.0, &hub), ..SegmentLoads::default() });
    motion.resolve_stick_slip(None);
    for k in 1..=20 {
        let t = 0.1 * f64::from(k);
        motion.advance(t, None, || Ok::<(), ()>(())).expect("valid");
        let turn = wave(62.0 * t);
        let off = (motion.view().rate - whole.map(|part| (part * turn).re)).norm() / whole.norm();
        assert!(off < 2e-8, "{t}: {off:e}");
    }
}

/// Returns the steady amplitudes for a line of this order: those of a wheel at `order` times the speed with a
/// coefficient smaller by the square of the order.
fn steady_at(
    flexible: &FlexibleBody,
    bearings: &[Bearing],
    speed: f64,
    order: f64,
) -> (DVector<C>, [nalgebra::Vector3<C>; 2]) {
    let mut bearing = bearings[0].clone();
    let line = &mut bearing.lines[0];
    for part in 0..2 {
        line.torque[part] /= order * order;
        line.forces[part].iter_mut().for_each(|force| *force /= order * order);
    }
    steady(flexible, &bearing, speed * order)
}

#[test]
fn what_does_not_fit_is_refused_with_its_key() {
    let scenario = Scenario::parse("craft", CRAFT).expect("valid");
    let model = &scenario.model.spacecraft().expect("valid").model;
    let found = wheels("static = 1e-6, point = \"nowhere\"").bearings(model).expect_err("refused");
    assert_eq!(found.key, "imbalance.point");
    for (keys, key) in [
        ("static = [1e-6, 2e-6]", "imbalance.static"),
        ("dynamic = [1e-6]", "imbalance.dynamic"),
        ("angle = [0, 1]", "imbalance.angle"),
        ("positions = [[0, 0, 1]]", "imbalance.positions"),
    ] {
        assert_eq!(wheels(keys).allocation().expect_err("refused").key, key);
    }
}

/// A rotor that starts half a turn ahead pushes the other way once per turn, and alike twice per turn; a quarter ahead, its
/// cosine is the sine of one that starts at 0.
#[test]
fn loads_begin_at_the_angle_of_the_rotor() {
    let scenario = Scenario::parse("craft", CRAFT).expect("valid");
    let model = &scenario.model.spacecraft().expect("valid").model;
    let harmonics = "static = 7.2e-6, dynamic = 3e-7, phase = 0.4, \
                     harmonics = [{ order = 2.0, force = 1e-6, axial = 2e-6, phase = 0.7 }]";
    let lines = |angle: f64| {
        let found = wheels(&format!("{harmonics}, angle = [0, {angle}, 0, 0]")).bearings(model);
        found.expect("valid")[1].lines.clone()
    };
    let [at_rest, half, quarter] = [0.0, std::f64::consts::PI, std::f64::consts::FRAC_PI_2].map(lines);
    let near = |one: &Vector, other: &Vector| (one - other).norm() < 1e-15 * other.norm().max(1e-9);
    for part in 0..2 {
        assert!(near(&half[0].force[part], &-at_rest[0].force[part]));
        assert!(near(&half[0].torque[part], &-at_rest[0].torque[part]));
        assert!(near(&half[1].force[part], &at_rest[1].force[part]));
    }
    assert!(
        near(&quarter[0].force[0], &at_rest[0].force[1]) && near(&quarter[0].force[1], &-at_rest[0].force[0])
    );
}

/// Equal wheels that turn against each other cancel where they start at one angle: `check` says so.
#[test]
fn loads_that_cancel_are_remarked() {
    let dir = crate::util::Dir::with(&["wheel-run-up"]);
    let remark = "starts equal wheels of opposite speeds at the same angle";
    let check = |more: &str| {
        let equal =
            "--set actuator.wheels.imbalance.static=1e-6 --set actuator.wheels.imbalance.dynamic=1e-7";
        dir.run(&format!("check wheel-run-up.toml {equal} {more}")).exits(0).err
    };
    let told = check("");
    assert!(told.contains(remark), "{told}");
    assert!(!check("--set actuator.wheels.imbalance.angle=[0,1,2,3]").contains(remark));
    assert!(!dir.run("check wheel-run-up.toml").exits(0).err.contains(remark));
}
