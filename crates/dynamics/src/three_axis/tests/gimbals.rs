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
fn in_space(motion: &ThreeAxisMotion) -> Vector {
    let view = motion.view();
    (view.attitude * Quaternion::from_imag(view.momentum) * view.attitude.conjugate()).vector().into_owned()
}

/// Runs segments of 7 s; `look` is called before each.
fn run(
    mut motion: ThreeAxisMotion,
    stretches: u32,
    mut look: impl FnMut(&mut ThreeAxisMotion, &[Gimbal], f64),
) -> ThreeAxisMotion {
    let mut angles = [0.2, -0.5, 1.1, 0.0];
    for stretch in 0..stretches {
        let rates = rates(stretch);
        let now = gimbals(angles, rates);
        motion.begin_segment(&SegmentLoads { gimbals: now.clone(), ..SegmentLoads::default() });
        look(&mut motion, &now, 7.0);
        go(&mut motion, 7.0);
        angles.iter_mut().zip(rates).for_each(|(angle, rate)| *angle += rate * 7.0);
    }
    motion
}

#[test]
fn momentum_is_kept_over_a_long_run() {
    let mut before = None;
    let motion = run(craft().undamped().motion(TUMBLE), 300, |motion, _, _| {
        before.get_or_insert_with(|| in_space(motion));
    });
    let (before, after) = (before.expect("a start"), in_space(&motion));
    assert!((after - before).norm() < 1e-12 * before.norm(), "{:e}", (after - before).norm() / before.norm());
}

/// Checks the energy against the work of the gimbal motors, which act against w x h about the gimbal axis: -h d' (w .
/// t).
#[test]
fn the_motors_of_gimbals_give_the_energy() {
    let (mut work, mut first) = (0.0, None);
    let motion = run(craft().undamped().motion(TUMBLE), 12, |motion, gimbals, length| {
        first.get_or_insert_with(|| energy(motion));
        let cells = 700;
        let h = length / f64::from(cells);
        for cell in 0..cells {
            for (node, weight) in super::NODES.iter().zip(super::WEIGHTS) {
                let t = (f64::from(cell) + node) * h;
                go(motion, t);
                let rate = motion.view().rate;
                let power: f64 = gimbals.iter().map(|gimbal| -gimbal.at(t).1.dot(&rate)).sum();
                work += weight * h * power;
            }
        }
    });
    let gained = energy(&motion) - first.expect("a start");
    assert!(gained.abs() > 1e-2, "{gained}");
    assert!((gained - work).abs() < 1e-9 * gained.abs().max(1.0), "{gained} {work}");
}

#[test]
fn a_gimbal_at_rest_is_a_rotor() {
    let mut both = [craft().motion(TUMBLE), craft().motion(TUMBLE)];
    let still = gimbals([0.3, 0.1, -0.4, 2.0], [0.0; 4]);
    let rotor = |gimbal: &Gimbal| {
        let (momentum, _) = gimbal.at(0.0);
        Rotor { axis: momentum / gimbal.momentum, momentum: gimbal.momentum, torque: 0.0 }
    };
    let rotors = still.iter().map(rotor).collect();
    both[0].begin_segment(&SegmentLoads { gimbals: still, ..SegmentLoads::default() });
    both[1].begin_segment(&SegmentLoads { rotors, ..SegmentLoads::default() });
    for motion in &mut both {
        go(motion, 50.0);
    }
    let [a, b] = [both[0].view(), both[1].view()];
    assert!(apart(&a.attitude, &b.attitude) < 1e-12 && (a.rate - b.rate).norm() < 1e-13);
}

/// Compares SIMD steps with steps node by node, which a rotor in a bearing enforces.
#[test]
fn both_ways_of_taking_a_step_agree() {
    let mut both = [craft().motion(TUMBLE), craft().motion(TUMBLE)];
    both[1].set_bearings(vec![Bearing { inertia: 0.04, ..Bearing::default() }]);
    let rotors = vec![Rotor { axis: Vector::z(), momentum: 2.0, torque: 0.01 }];
    let gimbals = gimbals([0.3, 0.1, -0.4, 2.0], [0.4, -0.3, 0.9, 0.0]);
    for motion in &mut both {
        motion.begin_segment(&SegmentLoads {
            gimbals: gimbals.clone(),
            rotors: rotors.clone(),
            ..SegmentLoads::default()
        });
        go(motion, 30.0);
    }
    let [a, b] = [both[0].view(), both[1].view()];
    assert!(apart(&a.attitude, &b.attitude) < 1e-11, "{:e}", apart(&a.attitude, &b.attitude));
    // Compares the rate of change with the accelerations by the equations of motion.
    let reported = both[0].accelerations(None).hub;
    let rate = |t: f64, motion: &mut ThreeAxisMotion| {
        go(motion, t);
        motion.view().rate
    };
    let step = 1e-3;
    let near = (rate(30.0 + step, &mut both[0]) - rate(30.0 - step, &mut both[0])) * (8.0 / (12.0 * step));
    let far = (rate(30.0 + 2.0 * step, &mut both[0]) - rate(30.0 - 2.0 * step, &mut both[0])) / (12.0 * step);
    assert!((reported - near + far).norm() < 1e-8, "{reported} {near}");
}
