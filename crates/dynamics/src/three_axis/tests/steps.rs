//! Step errors: of the rule for step lengths, and of halved steps.

use std::sync::Arc;

use flexsc_numerics::lanes::SimdWidth4;

use super::*;
use crate::three_axis::SharedSteps;

/// Checks that the rule's steps err by less than 1e-10 rad in 1e4 s, against steps a quarter as long, over 200 s.
#[test]
fn the_rule_of_steps_meets_its_bound() {
    let craft = craft().stiff().undamped();
    let (mut motion, mut finer) = (vibrating(&craft), vibrating(&craft));
    finer.set_levels(StepLevels::fixed(1.0 / 256.0));
    let mut worst = 0.0_f64;
    for t in 1..=10 {
        go(&mut motion, 20.0 * f64::from(t));
        go(&mut finer, 20.0 * f64::from(t));
        worst = worst.max(apart(&motion.view().attitude, &finer.view().attitude));
    }
    assert!(worst < 2e-12, "{worst:e}");
}

/// Checks that a free body whose steps do not resolve all modes drifts by less than 1e-14 rad/s, due to its rotation
/// or to mutual rotation of the modes, against steps that resolve all.
#[test]
fn unresolved_modes_make_a_free_body_drift_no_faster_than_promised() {
    for (damping, rate, speed) in [
        (0.005, 1e-6, 1e-3),
        (0.005, 1e-6, 1e-2),
        (0.005, 1e-3, 1e-4),
        (1e-4, 1e-6, 1e-3),
        (1e-4, 1e-3, 1e-4),
    ] {
        let mut craft = craft();
        craft.body.damping = None;
        craft.body.modes.iter_mut().for_each(|mode| mode.damping = damping);
        let start = || {
            let modes: Vec<_> = craft.body.modes.iter().map(|mode| [speed / mode.frequency, 0.0]).collect();
            ThreeAxisMotion::new(&craft.body, Quaternion::identity(), TUMBLE * (rate / TUMBLE.norm()), &modes)
        };
        let (mut motion, mut finer) = (start(), start());
        finer.set_levels(StepLevels::fixed(1.0 / 128.0));
        let end = 2000.0;
        go(&mut motion, end);
        go(&mut finer, end);
        let drift = apart(&motion.view().attitude, &finer.view().attitude) / end;
        assert!(drift < 1e-14, "damping {damping}, {rate} rad/s, {speed}: {drift:e} rad/s");
        assert!(motion.counts().steps < finer.counts().steps / 4);
    }
}

/// Compares a body that starts to tumble with its modes at rest, so that the rotation excites them, with steps an
/// eighth as long.
#[test]
fn what_the_rotation_bends_counts_from_the_first_step_on() {
    let craft = craft().stiff().undamped();
    for (rate, bound) in [(0.014, 1e-15), (0.07, 1e-12), (0.21, 2e-11)] {
        let start = || {
            let rate = TUMBLE * (rate / TUMBLE.norm());
            let mut motion = ThreeAxisMotion::new(&craft.body, Quaternion::identity(), rate, &[]);
            motion.begin_segment(&SegmentLoads { rotors: rotors(SPUN, [0.0; 4]), ..SegmentLoads::default() });
            motion
        };
        let (mut motion, mut finer) = (start(), start());
        finer.set_levels(StepLevels::fixed(1.0 / 512.0));
        for t in [0.5, 2.0, 20.0] {
            go(&mut motion, t);
            go(&mut finer, t);
            let off = apart(&motion.view().attitude, &finer.view().attitude);
            assert!(off < bound, "{rate} rad/s, {t} s: {off:e}");
        }
    }
}

/// Compares a body driven by its wheels at four commands per second, with first moments, with steps that resolve all
/// modes.
#[test]
fn steps_are_longer_where_modes_hardly_move() {
    let mut craft = craft();
    craft.body.damping = None;
    craft.body.modes.iter_mut().for_each(|mode| mode.damping = 0.005);
    let (mut motion, mut finer) = (craft.motion(Vector::zeros()), craft.motion(Vector::zeros()));
    finer.set_levels(StepLevels::fixed(1.0 / 128.0));
    let mut wheels = rotors(SPUN, [0.0; 4]);
    let mut worst = 0.0_f64;
    for command in 0..480 {
        // Profile: up to 9 mrad/s within 40 s, unevenly; a coast; and back.
        let push = match command {
            0..160 => 0.07,
            160..320 => 0.0,
            _ => -0.07,
        };
        let jitter = f64::from(command % 7) * 1e-3;
        for (index, wheel) in wheels.iter_mut().enumerate() {
            wheel.momentum += wheel.torque * 0.25;
            wheel.torque = if index % 2 == 0 { push + jitter } else { 0.3 * push - jitter };
        }
        let loads = SegmentLoads { rotors: wheels.clone(), ..SegmentLoads::default() };
        for motion in [&mut motion, &mut finer] {
            motion.begin_segment(&loads);
            go(motion, 0.1);
            go(motion, 0.25);
        }
        worst = worst.max(apart(&motion.view().attitude, &finer.view().attitude));
    }
    assert!(finer.view().rate.norm() < 4e-3 && worst < 1e-12, "{worst:e} {}", finer.view().rate);
    let (steps, fine) = (motion.counts().steps, finer.counts().steps);
    assert!(5 * steps < 3 * fine, "{steps} {fine}");
}

/// Checks the order of the method with the six slow modes, which all steps here resolve, first moments and damping.
#[test]
fn halving_the_step_divides_the_error_by_64() {
    let mut craft = craft();
    craft.body.modes.truncate(6);
    let damping = craft.body.damping.take().expect("it is damped");
    craft.body.damping = Some(damping.view((0, 0), (6, 6)).into_owned());
    let run = |h: f64| {
        let modes = [[1e-3, 0.0]; 6];
        let mut motion = ThreeAxisMotion::new(&craft.body, Quaternion::identity(), TUMBLE * 3.0, &modes);
        motion.set_levels(StepLevels::fixed(h));
        let forces = vec![1e-3; 6];
        let loads = SegmentLoads {
            torque: Vector::new(0.3, -0.2, 0.5),
            forces,
            com_acceleration: Vector::new(2e-3, -1e-3, 3e-3),
            rotors: rotors(SPUN, [0.1, 0.0, -0.2, 0.0]),
            ..SegmentLoads::default()
        };
        motion.begin_segment(&loads);
        go(&mut motion, 20.0);
        motion.view().clone()
    };
    let exact = run(1.0 / 64.0);
    let error = |h: f64| {
        let view = run(h);
        [
            apart(&view.attitude, &exact.attitude),
            (view.rate - exact.rate).norm(),
            (view.rigid_angle - exact.rigid_angle).norm(),
            (view.com[0] - exact.com[0]).norm(),
            (view.com[1] - exact.com[1]).norm(),
        ]
    };
    let (coarse, fine) = (error(1.0 / 4.0), error(1.0 / 8.0));
    for (index, (coarse, fine)) in coarse.into_iter().zip(fine).enumerate() {
        // Position and velocity err by little more than rounding.
        let most = if index < 3 { 90.0 } else { f64::INFINITY };
        assert!(coarse / fine > 45.0 && coarse / fine < most, "{index}: {coarse:e} {fine:e}");
    }
}

/// Checks that wheels without first moments turn a body from rest as commanded: one iteration suffices, confirmed by
/// steps of a sixteenth of the length.
#[test]
fn one_pass_is_enough_where_nothing_acts_back() {
    let craft = craft().stiff().undamped();
    let (mut motion, mut finer) = (craft.motion(Vector::zeros()), craft.motion(Vector::zeros()));
    finer.set_levels(StepLevels::fixed(1.0 / 256.0));
    let mut wheels = rotors([0.0; 4], [0.0; 4]);
    for command in 0..80 {
        for (index, wheel) in wheels.iter_mut().enumerate() {
            wheel.momentum += wheel.torque * 0.25;
            wheel.torque = 0.02 * (1.0 + libm::sin(f64::from(command * (index as i32 + 1))));
        }
        for motion in [&mut motion, &mut finer] {
            motion.begin_segment(&SegmentLoads { rotors: wheels.clone(), ..SegmentLoads::default() });
            go(motion, 0.25);
        }
    }
    let (view, finer) = (motion.view(), finer.view());
    let off = apart(&view.attitude, &finer.attitude);
    assert!(view.rate.norm() > 1e-4 && off < 1e-12, "{off:e} {}", view.rate);
    assert!((view.rate - finer.rate).norm() < 1e-14);
    let counts = motion.counts();
    assert_eq!(counts.iterations, counts.steps);
}

/// Checks bit-equal results for all SIMD instruction sets, with small and large elastic rotations.
#[test]
fn no_bit_depends_on_the_processor() {
    for speed in [1e-4, 0.02] {
        let craft = craft();
        let modes: Vec<[f64; 2]> =
            craft.body.modes.iter().map(|mode| [0.0, speed / mode.rotation.norm()]).collect();
        let start = || ThreeAxisMotion::new(&craft.body, Quaternion::identity(), TUMBLE, &modes);
        let (mut best, mut any) = (start(), start());
        Arc::make_mut(&mut any.model).lanes = SimdWidth4::portable();
        for motion in [&mut best, &mut any] {
            motion
                .begin_segment(&SegmentLoads { rotors: rotors(SPUN, [0.01; 4]), ..SegmentLoads::default() });
            go(motion, 20.0);
        }
        assert_eq!(best.view(), any.view());
    }
}

/// Checks that runs with shared responses move as one that computes its own, and that another body gets its own.
#[test]
fn what_runs_have_in_common_changes_nothing() {
    let (craft, other) = (craft().undamped(), self::craft().undamped().stiff());
    let common = SharedSteps::default();
    let run = |craft: &Craft, common: &SharedSteps, ends: &[f64]| {
        let start = (Quaternion::identity(), TUMBLE);
        let mut motion = ThreeAxisMotion::with_shared(common, &craft.body, start, &[[0.0; 2]; 8]);
        motion.begin_segment(&SegmentLoads { rotors: rotors(SPUN, [0.1; 4]), ..SegmentLoads::default() });
        for end in ends {
            go(&mut motion, *end);
        }
        motion.view().clone()
    };
    // Uses more step lengths than the cache keeps.
    let many: Vec<f64> = (1..100).map(|step| f64::from(step) * 0.011).collect();
    for craft in [&craft, &other] {
        for _ in 0..2 {
            assert_eq!(run(craft, &common, &many), run(craft, &SharedSteps::default(), &[1.089]));
        }
    }
    assert_ne!(run(&craft, &common, &[1.0]), run(&other, &common, &[1.0]));
}
