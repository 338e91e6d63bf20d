//! Rotors in gimbals: balances of momentum and energy over a long run, and comparison of both ways to compute a step.

use flexsc_numerics::attitude::Vector;
use nalgebra::Quaternion;

use super::super::{Bearing, Gimbal, Rotor, SegmentLoads, ThreeAxisMotion};
use super::{TUMBLE, apart, craft, energy, go};

/// Returns four gimbals about the normals of a pyramid's faces.
fn gimbals(angles: [f64; 4], rates: [f64; 4]) -> Vec<Gimbal> {
    let (sin, cos) = libm::sincos(0.955);
    let faces = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
    let gimbal = |k: usize| {
        let [x, y] = faces[k];
        Gimbal {
            spin: Vector::new(-y, x, 0.0),
            across: Vector::new(-cos * x, -cos * y, sin),
            momentum: 6.0,
            angle: angles[k],
            rate: rates[k],
        }
    };
    (0..4).map(gimbal).collect()
}

/// Returns the gimbal rates during a segment of a run (rad/s).
fn rates(stretch: u32) -> [f64; 4] {
    [0.0, 1.0, 2.0, 3.0].map(|k| 0.7 * libm::sin(1.3 * f64::from(stretch) + 2.1 * k))
}

/// Returns the angular momentum in inertial axes (N m s).
fn in_space(turning: &ThreeAxisMotion) -> Vector {
    let seen = turning.seen();
    (seen.attitude * Quaternion::from_imag(seen.momentum) * seen.attitude.conjugate()).vector().into_owned()
}

/// Runs segments of 7 s; `look` is called before each.
fn run(
    mut turning: ThreeAxisMotion,
    stretches: u32,
    mut look: impl FnMut(&mut ThreeAxisMotion, &[Gimbal], f64),
) -> ThreeAxisMotion {
    let mut angles = [0.2, -0.5, 1.1, 0.0];
    for stretch in 0..stretches {
        let rates = rates(stretch);
        let now = gimbals(angles, rates);
        turning.depart(&SegmentLoads { gimbals: now.clone(), ..SegmentLoads::default() });
        look(&mut turning, &now, 7.0);
        go(&mut turning, 7.0);
        angles.iter_mut().zip(rates).for_each(|(angle, rate)| *angle += rate * 7.0);
    }
    turning
}

#[test]
fn momentum_is_kept_over_a_long_run() {
    let mut before = None;
    let turning = run(craft().undamped().turning(TUMBLE), 300, |turning, _, _| {
        before.get_or_insert_with(|| in_space(turning));
    });
    let (before, after) = (before.expect("a start"), in_space(&turning));
    assert!((after - before).norm() < 1e-12 * before.norm(), "{:e}", (after - before).norm() / before.norm());
}

/// Checks the energy against the work of the gimbal motors, which act against w x h about the gimbal axis: -h d' (w .
/// t).
#[test]
fn the_motors_of_gimbals_give_the_energy() {
    let (mut work, mut first) = (0.0, None);
    let turning = run(craft().undamped().turning(TUMBLE), 12, |turning, gimbals, length| {
        first.get_or_insert_with(|| energy(turning));
        let cells = 700;
        let h = length / f64::from(cells);
        for cell in 0..cells {
            for (node, weight) in super::NODES.iter().zip(super::WEIGHTS) {
                let t = (f64::from(cell) + node) * h;
                go(turning, t);
                let rate = turning.seen().rate;
                let power: f64 = gimbals.iter().map(|gimbal| -gimbal.at(t).1.dot(&rate)).sum();
                work += weight * h * power;
            }
        }
    });
    let gained = energy(&turning) - first.expect("a start");
    assert!(gained.abs() > 1e-2, "{gained}");
    assert!((gained - work).abs() < 1e-9 * gained.abs().max(1.0), "{gained} {work}");
}

#[test]
fn a_gimbal_at_rest_is_a_rotor() {
    let mut both = [craft().turning(TUMBLE), craft().turning(TUMBLE)];
    let still = gimbals([0.3, 0.1, -0.4, 2.0], [0.0; 4]);
    let rotor = |gimbal: &Gimbal| {
        let (momentum, _) = gimbal.at(0.0);
        Rotor { axis: momentum / gimbal.momentum, momentum: gimbal.momentum, torque: 0.0 }
    };
    let rotors = still.iter().map(rotor).collect();
    both[0].depart(&SegmentLoads { gimbals: still, ..SegmentLoads::default() });
    both[1].depart(&SegmentLoads { rotors, ..SegmentLoads::default() });
    for turning in &mut both {
        go(turning, 50.0);
    }
    let [a, b] = [both[0].seen(), both[1].seen()];
    assert!(apart(&a.attitude, &b.attitude) < 1e-12 && (a.rate - b.rate).norm() < 1e-13);
}

/// Compares SIMD steps with steps node by node, which a rotor in a bearing enforces.
#[test]
fn both_ways_of_taking_a_step_agree() {
    let mut both = [craft().turning(TUMBLE), craft().turning(TUMBLE)];
    both[1].set_bearings(vec![Bearing { inertia: 0.04, ..Bearing::default() }]);
    let rotors = vec![Rotor { axis: Vector::z(), momentum: 2.0, torque: 0.01 }];
    let gimbals = gimbals([0.3, 0.1, -0.4, 2.0], [0.4, -0.3, 0.9, 0.0]);
    for turning in &mut both {
        turning.depart(&SegmentLoads {
            gimbals: gimbals.clone(),
            rotors: rotors.clone(),
            ..SegmentLoads::default()
        });
        go(turning, 30.0);
    }
    let [a, b] = [both[0].seen(), both[1].seen()];
    assert!(apart(&a.attitude, &b.attitude) < 1e-11, "{:e}", apart(&a.attitude, &b.attitude));
    // Compares the rate of change with the accelerations by the equations of motion.
    let reported = both[0].accelerations(None).hub;
    let rate = |t: f64, turning: &mut ThreeAxisMotion| {
        go(turning, t);
        turning.seen().rate
    };
    let step = 1e-3;
    let near = (rate(30.0 + step, &mut both[0]) - rate(30.0 - step, &mut both[0])) * (8.0 / (12.0 * step));
    let far = (rate(30.0 + 2.0 * step, &mut both[0]) - rate(30.0 - 2.0 * step, &mut both[0])) / (12.0 * step);
    assert!((reported - near + far).norm() < 1e-8, "{reported} {near}");
}
