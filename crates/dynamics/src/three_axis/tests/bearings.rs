//! Rotors in bearings: balances of momentum and energy over long runs, stick-slip, and rotors coupled by the body.

use flexsc_numerics::attitude::Vector;
use nalgebra::{Matrix3, Quaternion};

use crate::three_axis::{
    Bearing, FlexibleBody, FreeMode, Rotor, RotorObservation, SegmentLoads, SlipDirection, ThreeAxisMotion,
};

const INERTIA: f64 = 0.04;

fn axes() -> [Vector; 4] {
    let (up, level) = libm::sincos(35.0_f64.to_radians());
    let half = level * std::f64::consts::FRAC_1_SQRT_2;
    [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]].map(|[x, y]| Vector::new(half * x, half * y, up))
}

/// Returns an undamped body of about 1000 kg m² with slow modes.
fn body(modes: usize) -> FlexibleBody {
    let rows = [(1.15, [-9e-4, -1.6e-3, 4.4e-4]), (2.07, [0.042, -5e-4, -0.02]), (4.4, [1e-4, 0.02, 3e-4])];
    let mode = |(frequency, rotation): (f64, [f64; 3])| FreeMode {
        frequency,
        damping: 0.0,
        rotation: rotation.into(),
        moments: Matrix3::new(0.7, -2.0, 0.1, -2.0, 0.5, -3.0, 0.1, -3.0, -0.2),
    };
    FlexibleBody {
        inertia: Matrix3::new(1112.5, 6.0, 0.6, 6.0, 311.9, 4.9, 0.6, 4.9, 1089.3),
        modes: rows.into_iter().take(modes).map(mode).collect(),
        damping: None,
    }
}

fn bearing(coulomb: f64, breakaway: f64) -> Bearing {
    Bearing { inertia: INERTIA, viscous: 5e-5, coulomb, breakaway, lines: Vec::new(), tilts: Vec::new() }
}

/// Simulation of a body with rotors, with records of motor work and slip changes.
struct Run {
    motion: ThreeAxisMotion,
    rotors: Vec<Rotor>,
    /// Work of the motors (J).
    work: f64,
    /// Time and new slip state of each change of a rotor.
    events: Vec<(f64, usize, SlipDirection)>,
    t: f64,
}

impl Run {
    fn new(body: &FlexibleBody, rate: Vector, bearing: &Bearing, speeds: &[f64]) -> Self {
        let modes = [[1e-3, 2e-3]; 3];
        let mut motion = ThreeAxisMotion::new(body, Quaternion::identity(), rate, &modes[..body.modes.len()]);
        motion.set_bearings(vec![bearing.clone(); speeds.len()]);
        let hub = motion.view().rate;
        let rotor = |(axis, speed): (Vector, &f64)| Rotor {
            axis,
            momentum: INERTIA * (speed + axis.dot(&hub)),
            torque: 0.0,
        };
        let rotors = axes().into_iter().zip(speeds).map(rotor).collect();
        Self { motion, rotors, work: 0.0, events: Vec::new(), t: 0.0 }
    }

    fn turned(&self) -> Vec<RotorObservation> {
        self.motion.rotor_observations(None)
    }

    fn go(&mut self, torques: &[f64], h: f64) {
        for (rotor, torque) in self.rotors.iter_mut().zip(torques) {
            rotor.torque = *torque;
        }
        let loads = SegmentLoads { rotors: self.rotors.clone(), ..SegmentLoads::default() };
        let mut left = h;
        self.begin_segment(&loads);
        let began: Vec<f64> = self.turned().iter().map(|wheel| wheel.angle).collect();
        while let Some(at) = self.motion.advance(left, None, || Ok::<(), ()>(())).unwrap() {
            self.motion.stop_at_event(at, None);
            (left, self.t) = (left - at, self.t + at);
            self.begin_segment(&loads);
        }
        self.t += left;
        for ((wheel, began), torque) in self.turned().iter().zip(began).zip(torques) {
            self.work += torque * (wheel.angle - began);
        }
    }

    fn begin_segment(&mut self, loads: &SegmentLoads) {
        let before = self.motion.slip_states().to_vec();
        self.motion.begin_segment(loads);
        self.motion.resolve_stick_slip(None);
        for (wheel, (before, after)) in before.iter().zip(self.motion.slip_states()).enumerate() {
            if before != after {
                self.events.push((self.t, wheel, *after));
            }
        }
    }

    fn momentum(&self) -> Vector {
        let view = self.motion.view();
        (view.attitude * Quaternion::from_imag(view.momentum) * view.attitude.conjugate()).vector().into()
    }

    /// Returns the energy of body, modes and rotors (J).
    fn energy(&self) -> f64 {
        let spins =
            self.turned().iter().map(|wheel| wheel.momentum * wheel.momentum / (2.0 * INERTIA)).sum::<f64>();
        self.motion.view().rotational_energy + self.motion.energies().sum::<f64>() + spins
    }

    fn heat(&self) -> f64 {
        self.turned().iter().map(|wheel| wheel.heat).sum()
    }
}

/// Runs alternating motor torques with stick-slip for 1e4 s on a flexible body without other loads.
#[test]
fn momentum_stays_and_energy_is_work_less_heat() {
    let mut run =
        Run::new(&body(3), Vector::new(0.01, -0.02, 0.015), &bearing(0.01, 0.012), &[40.0, -30.0, 5.0, 0.0]);
    run.go(&[0.0; 4], 0.0);
    let (momentum, energy) = (run.momentum(), run.energy());
    for leg in 0..200_u32 {
        let push = |wheel: u32| 0.03 * (libm::sin(f64::from(leg * 7 + wheel * 3)));
        run.go(&[0, 1, 2, 3].map(push), 50.0);
    }
    assert!((run.t - 1e4).abs() < 1e-9);
    let off = (run.momentum() - momentum).norm() / momentum.norm();
    assert!(off < 1e-13, "{off:e}");
    let gap = run.energy() - energy - (run.work - run.heat());
    assert!(run.heat() > 100.0 && run.events.len() > 100, "{} {}", run.heat(), run.events.len());
    assert!(gap.abs() < 1e-11 * run.heat(), "{gap:e} of {}", run.heat());
    let stuck = run.events.iter().filter(|(_, _, slip)| *slip == SlipDirection::Stuck).count();
    assert!(stuck > 0, "of {}", run.events.len());
}

/// Checks |H| and energy of a flexible body with frictionless wheels and no torques, over 1e4 s.
#[test]
fn free_wheels_keep_momentum_and_energy() {
    let free = Bearing { inertia: INERTIA, ..Bearing::default() };
    let mut run = Run::new(&body(3), Vector::new(0.01, -0.02, 0.015), &free, &[40.0, -30.0, 5.0, 0.0]);
    run.go(&[0.0; 4], 0.0);
    let (momentum, energy) = (run.momentum(), run.energy());
    run.go(&[0.0; 4], 1e4);
    assert!((run.momentum() - momentum).norm() < 1e-13 * momentum.norm());
    assert!((run.energy() / energy - 1.0).abs() < 1e-12, "{:e}", run.energy() / energy - 1.0);
}

/// Checks the known instant at which a rotor running down on a rigid body at rest stops: with s = 1/I + 1/J about its
/// axis, Omega = (O0 + t/c) exp(-c s T) - t/c.
#[test]
fn a_rotor_runs_down_and_sticks() {
    let body = FlexibleBody { inertia: Matrix3::from_diagonal_element(200.0), ..FlexibleBody::default() };
    let mut run = Run::new(&body, Vector::zeros(), &bearing(0.01, 0.01), &[10.0]);
    run.go(&[0.0], 100.0);
    let (c, t, s) = (5e-5, 0.01, 1.0 / INERTIA + 1.0 / 200.0);
    let stops = libm::log(1.0 + 10.0 * c / t) / (c * s);
    let [(at, 0, SlipDirection::Stuck)] = run.events[..] else { panic!("{:?}", run.events) };
    assert!((at - stops).abs() < 1e-12, "{at} {stops}");
    // Its momentum is now in the body, which turns with it.
    let turns = INERTIA * 10.0 * axes()[0] / (200.0 + INERTIA);
    assert!((run.motion.view().rate - turns).norm() < 1e-16);
    assert_eq!(run.turned()[0].speed, 0.0);
    assert!((run.heat() - 0.5 * INERTIA * 100.0 / (1.0 + INERTIA / 200.0)).abs() < 1e-13, "{}", run.heat());
    // Below the breakaway torque it stays; above it, it slips in the driven direction.
    run.go(&[0.0099], 10.0);
    assert_eq!((run.events.len(), run.turned()[0].slip), (1, SlipDirection::Stuck));
    let held = run.turned()[0].friction;
    assert!((held - 0.0099).abs() < 1e-17, "{held}");
    run.go(&[-0.02], 1.0);
    assert_eq!(run.events[1].2, SlipDirection::Backward);
    let speed = (1.0 - libm::exp(-c * s)) * -0.01 / c;
    assert!((run.turned()[0].speed - speed).abs() < 1e-13);
}

/// Checks that a vibrating body breaks a stuck rotor loose when the torque that turns it with the body, I a.w',
/// reaches the breakaway torque.
#[test]
fn a_vibration_shakes_a_rotor_loose() {
    let body = FlexibleBody {
        inertia: Matrix3::from_diagonal_element(200.0),
        modes: vec![FreeMode {
            frequency: 10.0,
            damping: 0.0,
            rotation: axes()[0] * 0.05,
            moments: Matrix3::zeros(),
        }],
        damping: None,
    };
    let mut run = Run::new(&body, Vector::zeros(), &bearing(0.01, 0.01), &[0.0]);
    run.go(&[0.0], 0.0);
    run.go(&[0.009_798], 1.0);
    let at = run.events.iter().find(|(_, _, slip)| *slip == SlipDirection::Forward).expect("it lets go").0;
    // While stuck, w (1 + I/J) = phi q' and q'' (1 + I phi²/(1 + I/J)) = -W² q.
    let (more, phi) = (1.0 + INERTIA / 200.0, 0.05);
    let square = 100.0 / (1.0 + INERTIA * phi * phi / more);
    let w = f64::sqrt(square);
    let holds = |t: f64| {
        let q = 1e-3 * libm::cos(w * t) + 2e-3 / w * libm::sin(w * t);
        0.01 - (0.009_798 + INERTIA * phi / more * square * q)
    };
    assert!(holds(0.0) > 1e-6 && holds(at).abs() < 1e-15 && holds(at + 1e-4) < 0.0, "{at} {:e}", holds(at));
}

/// Checks that rotors at rest on a light body are resolved together: a driven one drags the other with the body.
#[test]
fn rotors_share_the_body() {
    let body = FlexibleBody { inertia: Matrix3::from_diagonal_element(0.02), ..FlexibleBody::default() };
    let mut run = Run::new(&body, Vector::zeros(), &bearing(0.01, 0.01), &[0.0; 4]);
    run.go(&[0.05, 0.0, 0.0, 0.0], 1e-3);
    let turned = run.turned();
    assert_eq!(turned[0].slip, SlipDirection::Forward);
    for wheel in &turned[1..] {
        match wheel.slip {
            SlipDirection::Stuck => assert!(wheel.friction.abs() <= 0.01 && wheel.speed == 0.0),
            slip => assert!(slip.sign() * wheel.speed > 0.0, "{wheel:?}"),
        }
    }
    // The reaction of the first turns the body backwards: another slips forwards where its bearing yields.
    assert!(
        turned.iter().any(|wheel| wheel.slip == SlipDirection::Stuck)
            || turned[1].slip == SlipDirection::Forward
    );
}

/// Checks that observations between do not move the instant of a rotor's zero crossing, nor the motion after it.
#[test]
fn looking_moves_no_event() {
    let run = |looks: &[f64]| {
        let mut run = Run::new(
            &body(3),
            Vector::new(0.01, -0.02, 0.015),
            &bearing(0.01, 0.012),
            &[1.0, -2.0, 0.5, 0.0],
        );
        let loads = |run: &mut Run, torque: f64| {
            run.rotors.iter_mut().for_each(|rotor| rotor.torque = torque);
            SegmentLoads { rotors: run.rotors.clone(), ..SegmentLoads::default() }
        };
        let loads = loads(&mut run, -0.03);
        run.begin_segment(&loads);
        let mut from = 0.0;
        loop {
            for look in looks.iter().filter(|look| **look > from) {
                if run.motion.advance(look - from, None, || Ok::<(), ()>(())).unwrap().is_some() {
                    break;
                }
            }
            let Some(at) = run.motion.advance(5.0 - from, None, || Ok::<(), ()>(())).unwrap() else { break };
            run.motion.stop_at_event(at, None);
            (from, run.t) = (from + at, run.t + at);
            run.begin_segment(&loads);
        }
        (run.events.clone(), run.turned(), run.motion.view().clone())
    };
    let quiet = run(&[]);
    assert!(quiet.0.len() >= 2, "{:?}", quiet.0);
    assert_eq!(quiet, run(&[0.001, 0.3, 0.31, 1.0, 2.5, 4.999]));
}
