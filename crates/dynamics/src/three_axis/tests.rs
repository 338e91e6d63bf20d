//! Tests of the three-axis integrator against two independent codes: tests/golden/turning, made by
//! tests/golden/turning_oracle.py.

use nalgebra::{DMatrix, DVector, Matrix3, Matrix3x4, Quaternion};

mod bearings;
mod gimbals;
mod steps;

use flexsc_numerics::attitude::{Vector, rotation};
use flexsc_numerics::gauss_legendre::{NODES, WEIGHTS};

use super::step_levels::StepLevels;
use super::{FlexibleBody, FreeMode, Rotor, SegmentLoads, ThreeAxisMotion};

macro_rules! golden {
    ($name:literal) => {
        include_str!(concat!("../../../../tests/golden/turning/", $name))
    };
}

type Never = std::convert::Infallible;

/// Returns the numeric rows of a table without its header lines; a name within a row becomes NaN.
fn rows(text: &str) -> Vec<Vec<f64>> {
    let numbers =
        |line: &str| -> Vec<f64> { line.split(',').map(|v| v.parse().unwrap_or(f64::NAN)).collect() };
    text.lines().map(numbers).filter(|row| row.iter().filter(|v| v.is_nan()).count() <= 1).collect()
}

/// Reference spacecraft, with the rotation of its bench in each mode and the modal forces of jet 1.
struct Craft {
    body: FlexibleBody,
    bench: Vec<Vector>,
    jet: Vec<f64>,
}

fn craft() -> Craft {
    let rows = rows(golden!("modes.csv"));
    let three = |row: &[f64]| Vector::from_row_slice(row);
    let mode = |row: &Vec<f64>| FreeMode {
        frequency: row[0],
        damping: 0.0,
        rotation: three(&row[1..4]),
        moments: Matrix3::from_row_slice(&row[8..17]),
    };
    let damping = DMatrix::from_fn(8, 8, |row, column| rows[row + 1][17 + column]);
    Craft {
        body: FlexibleBody {
            inertia: Matrix3::from_row_slice(&rows[0]),
            modes: rows[1..].iter().map(mode).collect(),
            damping: Some(damping),
        },
        bench: rows[1..].iter().map(|row| three(&row[4..7])).collect(),
        jet: rows[1..].iter().map(|row| row[7]).collect(),
    }
}

impl Craft {
    /// Removes the change of the inertia by the modes.
    fn stiff(mut self) -> Self {
        self.body.modes.iter_mut().for_each(|mode| mode.moments = Matrix3::zeros());
        self
    }

    fn undamped(mut self) -> Self {
        self.body.damping = None;
        self
    }

    /// Returns the motion with the given initial rate and the modes at rest.
    fn motion(&self, rate: Vector) -> ThreeAxisMotion {
        ThreeAxisMotion::new(&self.body, Quaternion::identity(), rate, &[[0.0; 2]; 8])
    }
}

/// Initial rate of the tumbles (rad/s), and momenta of the wheels (N m s).
const TUMBLE: Vector = Vector::new(0.04, 0.05, -0.03);
const SPUN: [f64; 4] = [2.0, -1.0, 0.5, 1.5];

/// Spin inertia of a wheel (kg m²).
const WHEEL: f64 = 0.04;

/// Returns the wheels in their pyramid.
fn rotors(momenta: [f64; 4], torques: [f64; 4]) -> Vec<Rotor> {
    let (rise, turn) = (35.0_f64.to_radians(), 90.0_f64.to_radians());
    let rotor = |k: usize| {
        let azimuth = turn * (k as f64 + 0.5);
        let ((up, along), (y, x)) = (libm::sincos(rise), libm::sincos(azimuth));
        let axis = Vector::new(along * x, along * y, up);
        Rotor { axis, momentum: momenta[k], torque: torques[k] }
    };
    (0..4).map(rotor).collect()
}

fn go(motion: &mut ThreeAxisMotion, t: f64) {
    motion.advance(t, None, || Ok::<(), Never>(())).expect("nothing stops it");
}

/// Returns the angle between two attitudes (rad).
fn apart(a: &Quaternion<f64>, b: &Quaternion<f64>) -> f64 {
    2.0 * (a.conjugate() * b).vector().norm()
}

/// Returns the energy without rotors (J).
fn energy(motion: &ThreeAxisMotion) -> f64 {
    motion.view().rotational_energy + motion.energies().sum::<f64>()
}

/// Checks that the view is updated at the start of a segment: rotors with another momentum change the body's rate.
#[test]
fn a_jump_of_the_rotors_momenta_is_seen_at_once() {
    let craft = craft().stiff().undamped();
    let mut motion = craft.motion(TUMBLE);
    let depart = |motion: &mut ThreeAxisMotion, momenta: [f64; 4]| {
        motion.begin_segment(&SegmentLoads { rotors: rotors(momenta, [0.0; 4]), ..SegmentLoads::default() });
    };
    depart(&mut motion, SPUN);
    go(&mut motion, 0.7);
    let before = motion.view().clone();
    depart(&mut motion, SPUN);
    assert_eq!(*motion.view(), before);
    let jump = 0.3;
    depart(&mut motion, [SPUN[0] + jump, SPUN[1], SPUN[2], SPUN[3]]);
    let view = motion.view();
    let change =
        craft.body.inertia.try_inverse().expect("an inertia") * rotors(SPUN, [0.0; 4])[0].axis * -jump;
    assert!(
        (view.rigid_rate - before.rigid_rate - change).norm() < 1e-15 && view.momentum == before.momentum
    );
}

#[test]
fn pulses_from_rest() {
    let craft = craft().stiff();
    let centre = Vector::new(30.0, -12.0, 72.0) / 660.0;
    let jet = (Vector::new(0.0, 0.9, -0.8) - centre).cross(&Vector::new(0.0, 0.0, 5.0));
    let cases = [(Vector::x(), Vec::new()), (Vector::z(), Vec::new()), (jet, craft.jet.clone())];
    let rows = rows(golden!("b.csv"));
    assert_eq!(rows.len(), 15);
    for ((torque, forces), rows) in cases.into_iter().zip(rows.chunks(5)) {
        let mut motion = craft.motion(Vector::zeros());
        motion.begin_segment(&SegmentLoads { torque, forces, ..SegmentLoads::default() });
        let mut began = 0.0;
        for row in rows {
            let t = row[1];
            go(&mut motion, t - began);
            let view = motion.view();
            let vector = |from: usize| Vector::from_row_slice(&row[from..from + 3]);
            let rate = (view.rate - vector(2)).norm();
            let attitude = 2.0 * (view.attitude.vector() - vector(5)).norm();
            let bent = |sum: Vector, (q, bench): (&f64, &Vector)| sum + bench * *q;
            let bench = view.displacements.iter().zip(&craft.bench).fold(Vector::zeros(), bent);
            let bench = (bench - vector(8)).norm();
            let modes = view.displacements.iter().zip(&row[11..19]).map(|(q, exact)| (q - exact).abs());
            let modes = modes.fold(0.0, f64::max);
            assert!(rate < 1e-13 && attitude < 1e-13 && bench < 1e-16 && modes < 1e-13, "{t}");
            if t == 2.0 {
                motion.begin_segment(&SegmentLoads::default());
                began = 2.0;
            }
        }
    }
}

/// Compares a tumble with wheels with a table of attitude, rate, momentum and energy; returns the largest error of
/// each.
fn tumble(craft: &Craft, text: &str) -> [f64; 4] {
    let mut motion = craft.motion(TUMBLE);
    motion.begin_segment(&SegmentLoads { rotors: rotors(SPUN, [0.0; 4]), ..SegmentLoads::default() });
    let spin = SPUN.iter().map(|h| h * h / (2.0 * WHEEL)).sum::<f64>();
    let mut worst = [0.0_f64; 4];
    for row in rows(text) {
        go(&mut motion, row[0]);
        let view = motion.view();
        let vector = |from: usize| Vector::from_row_slice(&row[from..from + 3]);
        let errors = [
            apart(&view.attitude, &Quaternion::new(row[1], row[2], row[3], row[4])),
            (view.rate - vector(5)).norm(),
            (view.momentum - vector(8)).norm(),
            (energy(&motion) + spin - row[11]).abs(),
        ];
        worst = [0, 1, 2, 3].map(|i| worst[i].max(errors[i]));
    }
    worst
}

#[test]
fn tumbling_with_wheels() {
    let [attitude, rate, momentum, energy] = tumble(&craft().stiff(), golden!("c.csv"));
    assert!(attitude < 5e-13 && rate < 1e-13 && momentum < 2e-11 && energy < 2e-12);
}

#[test]
fn tumbling_with_first_moments() {
    let [attitude, rate, momentum, energy] = tumble(&craft(), golden!("c2.csv"));
    assert!(attitude < 1e-13 && rate < 1e-13 && momentum < 2e-12 && energy < 2e-12);
}

/// Returns a motion in which each slow mode turns the hub by 1e-4 rad/s, each fast one by 2e-5 rad/s.
fn vibrating(craft: &Craft) -> ThreeAxisMotion {
    let speed = |mode: &FreeMode| if mode.frequency < 20.0 { 1e-4 } else { 2e-5 };
    let modes = craft.body.modes.iter().map(|mode| [0.0, speed(mode) / mode.rotation.norm()]);
    let modes: Vec<[f64; 2]> = modes.collect();
    let mut motion = ThreeAxisMotion::new(&craft.body, Quaternion::identity(), TUMBLE, &modes);
    motion.begin_segment(&SegmentLoads { rotors: rotors(SPUN, [0.0; 4]), ..SegmentLoads::default() });
    motion
}

#[test]
fn a_tumble_of_1e4_s_keeps_momentum_and_energy() {
    let mut motion = vibrating(&craft().stiff().undamped());
    let space = |motion: &ThreeAxisMotion| {
        let view = motion.view();
        view.attitude * Quaternion::from_imag(view.momentum) * view.attitude.conjugate()
    };
    let (energy_before, before) = (energy(&motion), space(&motion));
    go(&mut motion, 1e4);
    let size = before.norm();
    assert!((motion.view().momentum.norm() / size - 1.0).abs() < 2e-14);
    assert!((space(&motion) - before).norm() / size < 2e-14);
    assert!((motion.view().attitude.norm() - 1.0).abs() < 1e-15);
    assert!((energy(&motion) / energy_before - 1.0).abs() < 1e-12);
    // About four iterations per step; the last step is off the grid.
    let counts = motion.counts();
    assert!(counts.steps == 619_726 && counts.iterations < 4 * counts.steps, "{counts:?}");
}

/// Checks the energy of an uncoupled mode over 128 000 steps: uncorrected rounded transitions would lose 1e-11 of it.
#[test]
fn a_free_mode_rings_on() {
    let mut craft = craft().stiff().undamped();
    craft.body.modes.iter_mut().for_each(|mode| mode.rotation = Vector::zeros());
    let mut motion =
        ThreeAxisMotion::new(&craft.body, Quaternion::identity(), Vector::zeros(), &[[0.1, 0.0]; 8]);
    motion.set_levels(StepLevels::fixed(1.0 / 64.0));
    let before: Vec<f64> = motion.energies().collect();
    go(&mut motion, 2000.0);
    for (energy, before) in motion.energies().zip(before) {
        assert!((energy / before - 1.0).abs() < 2e-13, "{energy} {before}");
    }
}

#[test]
fn looking_changes_nothing() {
    let craft = craft();
    let run = |looks: &[f64]| {
        let mut motion = craft.motion(TUMBLE);
        for leg in 0..3 {
            let loads = SegmentLoads {
                torque: Vector::new(1.0, 0.0, -0.5) * f64::from(leg),
                forces: craft.jet.clone(),
                rotors: rotors(SPUN, [0.0; 4]),
                ..SegmentLoads::default()
            };
            motion.begin_segment(&loads);
            for at in looks {
                go(&mut motion, *at);
            }
            go(&mut motion, 7.3);
        }
        motion.view().clone()
    };
    let quiet = run(&[]);
    assert_eq!(quiet, run(&[0.0, 0.001, 0.3, 0.300_000_1, 5.0, 7.2999]));
    // Going back in time gives the same motion.
    assert_eq!(quiet, run(&[7.0, 2.0, 6.9, 0.01]));
    let (mut there, mut back) = (craft.motion(TUMBLE), craft.motion(TUMBLE));
    go(&mut there, 2.0);
    go(&mut back, 7.0);
    go(&mut back, 2.0);
    assert_eq!(there.view(), back.view());
}

/// Checks dE = T.w + f.q' - sum u a.w - q' D q' for the body without its rotors; all terms but the last need no
/// quadrature.
#[test]
fn energy_is_the_work_of_what_acts() {
    for damped in [false, true] {
        let craft = if damped { craft() } else { craft().undamped() };
        let mut motion = craft.motion(TUMBLE);
        let (torque, torques) = (Vector::new(1.0, -2.0, 0.7), [0.1, -0.3, 0.2, 0.05]);
        let rotors = rotors(SPUN, torques);
        let on_body = rotors.iter().fold(torque, |sum, rotor| sum - rotor.axis * rotor.torque);
        motion.begin_segment(&SegmentLoads {
            torque,
            forces: craft.jet.clone(),
            rotors,
            ..SegmentLoads::default()
        });
        let before = energy(&motion);
        let mut dissipated = 0.0;
        if let Some(damping) = &craft.body.damping {
            let h = 1.0 / 256.0;
            for step in 0..2560 {
                for (node, weight) in NODES.into_iter().zip(WEIGHTS) {
                    go(&mut motion, h * (f64::from(step) + node));
                    let rates = DVector::from_column_slice(&motion.view().rates);
                    dissipated += h * weight * rates.dot(&(damping * &rates));
                }
            }
        }
        go(&mut motion, 10.0);
        let view = motion.view();
        let bent = |sum: Vector, (q, mode): (&f64, &FreeMode)| sum + mode.rotation * *q;
        let angle = view.displacements.iter().zip(&craft.body.modes).fold(view.rigid_angle, bent);
        let pushed: f64 = view.displacements.iter().zip(&craft.jet).map(|(q, force)| q * force).sum();
        let work = on_body.dot(&angle) + pushed - dissipated;
        let gap = energy(&motion) - before - work;
        assert!(gap.abs() < 2e-12 * work.abs().max(1.0), "{gap:e} of {work}, {dissipated:e} lost");
        assert!(!damped || dissipated > 1e-6);
    }
}

/// Compares a slew of 60 degrees by four wheels under a law at 4 Hz with a table.
#[test]
fn a_slew_by_wheels() {
    let craft = craft().stiff();
    let (axis, angle) = (Vector::new(1.0, 2.0, 2.0) / 3.0, 60.0_f64.to_radians());
    let (acceleration, limit, bandwidth, damping) = (2e-4, 8e-3, 0.1, 0.8);
    let (rise, end) = (limit / acceleration, angle / limit + limit / acceleration);
    let goal = |t: f64| {
        if t < rise {
            (0.5 * acceleration * t * t, acceleration * t, acceleration)
        } else if t < end - rise {
            (limit * (t - 0.5 * rise), limit, 0.0)
        } else if t < end {
            (angle - 0.5 * acceleration * (end - t) * (end - t), acceleration * (end - t), -acceleration)
        } else {
            (angle, 0.0, 0.0)
        }
    };
    let mut motion = craft.motion(Vector::zeros());
    let mut wheels = rotors([200.0, -200.0, 200.0, -200.0].map(|speed| WHEEL * speed), [0.0; 4]);
    let axes = Matrix3x4::from_columns(&[wheels[0].axis, wheels[1].axis, wheels[2].axis, wheels[3].axis]);
    let least = axes.transpose() * (axes * axes.transpose()).try_inverse().expect("three axes");
    let golden = rows(golden!("d.csv"));
    let mut rows = golden.iter().peekable();
    for sample in 0..=920 {
        let t = 0.25 * f64::from(sample);
        if sample > 0 {
            go(&mut motion, 0.25);
            for wheel in &mut wheels {
                wheel.momentum += wheel.torque * 0.25;
            }
        }
        let view = motion.view();
        let (turned, speed, change) = goal(t);
        let off = rotation(&(axis * turned)).conjugate() * view.attitude;
        let error = off.vector() * (2.0 * off.w.signum());
        let here = |v: Vector| (off.conjugate() * Quaternion::from_imag(v) * off).vector().clone_owned();
        if let Some(row) = rows.next_if(|row| row[0] == t) {
            let attitude = Quaternion::new(row[1], row[2], row[3], row[4]);
            assert!(apart(&view.attitude, &attitude) < 1e-12, "{t}");
            for (wheel, speed) in wheels.iter().zip(&row[8..12]) {
                let found = wheel.momentum / WHEEL - wheel.axis.dot(&view.rate);
                assert!((found - speed).abs() < 2e-9, "{t}: {found} {speed}");
            }
            assert!((error - Vector::from_row_slice(&row[12..15])).norm() < 5e-13, "{t}");
        }
        let wanted = error * (bandwidth * bandwidth)
            + (view.rate - here(axis * speed)) * (2.0 * damping * bandwidth)
            - here(axis * change);
        let stored = wheels
            .iter()
            .fold(craft.body.inertia * view.rate, |sum, wheel| sum + wheel.axis * wheel.momentum);
        let torque = view.rate.cross(&stored) - craft.body.inertia * wanted;
        let motors = -(least * torque);
        wheels.iter_mut().zip(&motors).for_each(|(wheel, motor)| wheel.torque = motor.clamp(-0.4, 0.4));
        motion.begin_segment(&SegmentLoads { rotors: wheels.clone(), ..SegmentLoads::default() });
    }
    assert!(rows.next().is_none());
}
