//! Test of a 60 degree slew by law, allocation and wheels on a flexible spacecraft, against a second code:
//! tests/golden/turning/d.csv without friction, e.csv with friction.

use flexsc_dynamics::three_axis::{
    Bearing, FlexibleBody, FreeMode, SegmentLoads, SlipDirection, ThreeAxisMotion,
};
use flexsc_dynamics::wrench::Wrench;
use flexsc_numerics::attitude::{Vector, rotation, rotation_vector};
use flexsc_numerics::time::{Instant, Span};
use flexsc_spacecraft::manoeuvre::{Slew, SlewProfile};
use nalgebra::{DMatrix, Matrix3, Quaternion};

use super::{
    AttitudeLaw, AttitudeProfile, Authority, DecisionCause, Law, LawSpec, Setpoint, TorqueDistribution,
};
use crate::actuator::{
    Actuator, ActuatorEvent, AxisActuatorContext, MomentumStorage, PulseWidth, Wheels, WheelsState,
};
use crate::state_estimate::StateEstimate;

const MODES: &str = include_str!("../../../../tests/golden/turning/modes.csv");
/// Columns: t, attitude, rate, wheel speeds, angle relative to the reference.
const TURN: &str = include_str!("../../../../tests/golden/turning/d.csv");
const RUBBING: &str = include_str!("../../../../tests/golden/turning/e.csv");
const PERIOD: f64 = 0.25;

fn rows(text: &str) -> Vec<Vec<f64>> {
    let row = |line: &str| line.split(',').map(str::parse).collect::<Result<Vec<f64>, _>>().ok();
    text.lines().filter_map(row).collect()
}

/// Returns the spacecraft without first moments, with its full damping matrix.
fn craft() -> FlexibleBody {
    let rows = rows(MODES);
    let mode = |row: &Vec<f64>| FreeMode {
        frequency: row[0],
        damping: 0.0,
        rotation: Vector::from_row_slice(&row[1..4]),
        moments: Matrix3::zeros(),
    };
    FlexibleBody {
        inertia: Matrix3::from_row_slice(&rows[0]),
        modes: rows[1..].iter().map(mode).collect(),
        damping: Some(DMatrix::from_fn(8, 8, |row, column| rows[row + 1][17 + column])),
    }
}

fn wheels(speed: f64) -> WheelsState {
    let wheels: Wheels = flexsc_formats::document::from_text(&format!(
        "arrangement = \"pyramid\"\ncant = 0.6108652381980153\ninertia = 0.04\ntorque = 0.4\nspeed_limit = 600.0\n\
         speeds = [{speed}, -{speed}, {speed}, -{speed}]"
    ))
    .unwrap();
    let setting = |axis| AxisActuatorContext {
        axis,
        inertia: 1.0,
        planned_inertia: 1.0,
        rate: 0.0,
        cycle: Some(Span::from_seconds(PERIOD)),
        waveform: None,
        share: 1.0,
    };
    WheelsState::new(&wheels, &wheels.allocation().unwrap(), &[0, 1, 2].map(setting))
}

/// Time at which a wheel stopped (s), index of the wheel, and its slip afterwards.
type Met = (f64, usize, SlipDirection);

#[test]
fn sixty_degrees_by_four_wheels() {
    let contacts = turn(wheels(200.0), Vec::new(), TURN);
    assert!(contacts.is_empty());
}

/// Checks the slew with friction: six times a wheel stops and then slips in the other direction; the first two times
/// are those of both codes.
#[test]
fn the_same_with_friction() {
    let bearing =
        Bearing { inertia: 0.04, viscous: 5e-5, coulomb: 0.01, breakaway: 0.01, ..Bearing::default() };
    let contacts = turn(wheels(40.0), vec![bearing; 4], RUBBING);
    assert_eq!(contacts.len(), 6, "{contacts:?}");
    for ((found, wheel, direction), (time, expected)) in contacts
        .iter()
        .filter(|(_, wheel, _)| *wheel == 0)
        .zip([(12.712_848_560_1, -1.0), (166.691_652_789_7, 1.0)])
    {
        assert!((found - time).abs() < 6e-10 && direction.sign() == expected, "{wheel}: {found}");
    }
}

/// Runs the slew against a table of the second code; returns the times at which wheels stopped.
fn turn(mut wheels: WheelsState, bearings: Vec<Bearing>, table: &str) -> Vec<Met> {
    let craft = craft();
    let mut motion = ThreeAxisMotion::new(&craft, Quaternion::identity(), Vector::zeros(), &[[0.0; 2]; 8]);
    motion.set_bearings(bearings);
    let mut events = Vec::new();
    let to = rotation(&(Vector::new(1.0, 2.0, 2.0) * (std::f64::consts::FRAC_PI_3 / 3.0)));
    let slew = Slew::new([Quaternion::identity(), to], 2e-4, 8e-3, SlewProfile::Trapezoid);
    let law: AttitudeLaw =
        flexsc_formats::document::from_text("period = 0.25\nbandwidth = 0.1\ndamping = 0.8").unwrap();
    let authority = Authority {
        axis: 0,
        accelerations: [f64::INFINITY; 2],
        width: PulseWidth::default(),
        delay: 0.0,
        threshold: 0.0,
    };
    let mut laws: [Box<dyn Law>; 3] = [0, 1, 2].map(|_| law.start(&authority));
    let distribution = TorqueDistribution::for_three_axes(craft.inertia);
    let table = rows(table);
    let mut count = 0;
    for k in 0..=920 {
        let (t, now) = (PERIOD * f64::from(k), Instant::START + Span::from_seconds(PERIOD * f64::from(k)));
        let (attitude, rate) = (motion.view().attitude, motion.view().rate);
        let pose = slew.at(t);
        let angles = rotation_vector(&pose.attitude, &attitude);
        if let Some(row) = table.iter().find(|row| row[0] == t) {
            count += 1;
            let three = |from: usize| Vector::from_row_slice(&row[from..from + 3]);
            let q = Quaternion::new(row[1], row[2], row[3], row[4]);
            // The reference table has 13 digits; the two codes agree to 1e-13, 1e-14, 2e-10 and 2e-13.
            assert!((attitude - q).norm() < 1e-12, "{t} {:e}", (attitude - q).norm());
            assert!((rate - three(5)).norm() < 1e-13, "{t} {:e}", (rate - three(5)).norm());
            for (wheel, speed) in wheels.wheels(now, rate.into()).iter().zip(&row[8..12]) {
                assert!((wheel.speed_rad_s - speed).abs() < 1e-9, "{t} {}", wheel.speed_rad_s - speed);
            }
            // It has twice the vectors of quaternions.
            let twice = (pose.attitude.conjugate() * attitude).vector() * 2.0;
            assert!((twice - three(12)).norm() < 5e-13, "{t} {:e}", (twice - three(12)).norm());
        }
        let whole = angles.norm();
        let estimate = |axis: usize| StateEstimate {
            angle: angles[axis],
            total_angle: whole,
            rate: rate[axis],
            ..StateEstimate::default()
        };
        let estimates = [0, 1, 2].map(estimate);
        let [reference, acceleration] = pose.in_body_axes(&angles);
        let mut axis = 0;
        let commands = laws.each_mut().map(|law| {
            let goal =
                Setpoint { from: now, angle: 0.0, rate: reference[axis], acceleration: acceleration[axis] };
            axis += 1;
            law.decide(now, DecisionCause::Timeout, &goal, &estimates[axis - 1]).command
        });
        let demands = distribution.demands(commands, &estimates, |_| wheels.stored_momentum(now));
        wheels.command(now, &demands, rate.into());
        let mut wrench = Wrench::default();
        wheels.apply(now, &mut wrench);
        let acting = SegmentLoads { rotors: wrench.rotors, ..SegmentLoads::default() };
        motion.begin_segment(&acting);
        motion.resolve_stick_slip(None);
        let mut began = 0.0;
        while let Some(at) = go(&mut motion, PERIOD - began) {
            let before: Vec<SlipDirection> =
                motion.rotor_observations(None).iter().map(|wheel| wheel.slip).collect();
            motion.stop_at_event(at, None);
            began += at;
            motion.begin_segment(&acting);
            motion.resolve_stick_slip(None);
            for (wheel, (turned, before)) in motion.rotor_observations(None).iter().zip(before).enumerate() {
                if turned.slip != before {
                    events.push((t + began, wheel, turned.slip));
                }
            }
        }
        let rotors = motion.rotor_observations(None);
        wheels.update(now + Span::from_seconds(PERIOD), ActuatorEvent::Rotors(&rotors));
    }
    assert_eq!(count, table.len());
    events
}

fn go(motion: &mut ThreeAxisMotion, t: f64) -> Option<f64> {
    motion.advance(t, None, || Ok::<(), std::convert::Infallible>(())).unwrap()
}

#[test]
fn a_reference_is_seen_in_the_axes_of_the_body() {
    // The rate about x appears about -y on a body a quarter turn about z from it.
    let pose = Slew::instantaneous(Quaternion::identity()).at(0.0);
    let pose =
        flexsc_spacecraft::manoeuvre::AttitudeMotion { rate: Vector::x(), acceleration: Vector::z(), ..pose };
    let by = Vector::new(0.0, 0.0, std::f64::consts::FRAC_PI_2);
    let [rate, acceleration] = pose.in_body_axes(&by);
    assert!((rate + Vector::y()).norm() < 1e-15 && (acceleration - Vector::z()).norm() < 1e-15);
    assert!(!AttitudeProfile::default().is_moving(Instant::START));
}
