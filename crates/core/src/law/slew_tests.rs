//! A turn of 60 degrees by law, allocation and wheels on a flexible spacecraft, against a second code: tests/golden/turning/d.csv.

use nalgebra::{DMatrix, Matrix3, Quaternion};

use super::{AttitudeLaw, Authority, Cause, Control, Distribution, Goal, Itinerary, Rule};
use crate::actuator::{Actuate, PulseWidth, Setting, Spinning, Wheels};
use crate::attitude::{Vector, beyond, rotation};
use crate::belief::Belief;
use crate::body::Wrench;
use crate::manoeuvre::{Profile, Slew};
use crate::motion::turning::{Acting, Flexible, FreeMode, Turning};
use crate::time::{Instant, Span};

const MODES: &str = include_str!("../../../../tests/golden/turning/modes.csv");
/// t, attitude, rate, speeds of the wheels, angle beyond the reference.
const TURN: &str = include_str!("../../../../tests/golden/turning/d.csv");
const PERIOD: f64 = 0.25;

fn rows(text: &str) -> Vec<Vec<f64>> {
    let row = |line: &str| line.split(',').map(str::parse).collect::<Result<Vec<f64>, _>>().ok();
    text.lines().filter_map(row).collect()
}

/// The spacecraft without first moments, its damping matrix whole.
fn craft() -> Flexible {
    let rows = rows(MODES);
    let mode = |row: &Vec<f64>| FreeMode {
        frequency: row[0],
        damping: 0.0,
        rotation: Vector::from_row_slice(&row[1..4]),
        moments: Matrix3::zeros(),
    };
    Flexible {
        inertia: Matrix3::from_row_slice(&rows[0]),
        modes: rows[1..].iter().map(mode).collect(),
        damping: Some(DMatrix::from_fn(8, 8, |row, column| rows[row + 1][17 + column])),
    }
}

fn wheels() -> Spinning {
    let wheels: Wheels = toml::from_str(
        "arrangement = \"pyramid\"\ncant = 0.6108652381980153\ninertia = 0.04\ntorque = 0.4\nspeed_limit = 600.0\n\
         speeds = [200.0, -200.0, 200.0, -200.0]",
    )
    .unwrap();
    let setting = |axis| Setting {
        axis,
        inertia: 1.0,
        planned_inertia: 1.0,
        rate: 0.0,
        cycle: Some(Span::from_seconds(PERIOD)),
        waveform: None,
    };
    wheels.start(&wheels.allocation().unwrap(), &[0, 1, 2].map(setting))
}

#[test]
fn sixty_degrees_by_four_wheels() {
    let craft = craft();
    let mut turning = Turning::new(&craft, Quaternion::identity(), Vector::zeros(), &[[0.0; 2]; 8]);
    let mut wheels = wheels();
    let to = rotation(&(Vector::new(1.0, 2.0, 2.0) * (std::f64::consts::FRAC_PI_3 / 3.0)));
    let slew = Slew::new([Quaternion::identity(), to], 2e-4, 8e-3, Profile::Trapezoid);
    let law: AttitudeLaw = toml::from_str("period = 0.25\nbandwidth = 0.1\ndamping = 0.8").unwrap();
    let authority = Authority {
        accelerations: [f64::INFINITY; 2],
        width: PulseWidth::default(),
        delay: 0.0,
        threshold: 0.0,
    };
    let mut laws: [Box<dyn Control>; 3] = [0, 1, 2].map(|_| law.start(&authority));
    let distribution = Distribution::of_three_axes(craft.inertia);
    let table = rows(TURN);
    let mut met = 0;
    for k in 0..=920 {
        let (t, now) = (PERIOD * f64::from(k), Instant::START + Span::from_seconds(PERIOD * f64::from(k)));
        let (attitude, rate) = (turning.seen().attitude, turning.seen().rate);
        let pose = slew.at(t);
        let angles = beyond(&pose.attitude, &attitude);
        if let Some(row) = table.iter().find(|row| row[0] == t) {
            met += 1;
            let three = |from: usize| Vector::from_row_slice(&row[from..from + 3]);
            let q = Quaternion::new(row[1], row[2], row[3], row[4]);
            // The table has 13 digits; the two codes agree to 1e-13, 1e-14, 2e-10 and 2e-13.
            assert!((attitude - q).norm() < 1e-12, "{t} {:e}", (attitude - q).norm());
            assert!((rate - three(5)).norm() < 1e-13, "{t} {:e}", (rate - three(5)).norm());
            for (wheel, speed) in wheels.wheels(now, rate.into()).iter().zip(&row[8..12]) {
                assert!((wheel.speed_rad_s - speed).abs() < 1e-9, "{t} {}", wheel.speed_rad_s - speed);
            }
            assert!((angles - three(12)).norm() < 5e-13, "{t} {:e}", (angles - three(12)).norm());
        }
        let belief = |axis: usize| Belief { angle: angles[axis], rate: rate[axis], ..Belief::default() };
        let beliefs = [0, 1, 2].map(belief);
        let [wanted, acceleration] = pose.seen_from(&angles);
        let mut axis = 0;
        let commands = laws.each_mut().map(|law| {
            let goal = Goal { from: now, angle: 0.0, rate: wanted[axis], acceleration: acceleration[axis] };
            axis += 1;
            law.decide(now, Cause::Timeout, &goal, &beliefs[axis - 1]).command
        });
        let demands = distribution.demands(commands, &beliefs, || wheels.stored(now));
        wheels.command(now, &demands, rate.into());
        let mut wrench = Wrench::default();
        wheels.exert(now, &mut wrench);
        turning.depart(&Acting { rotors: wrench.rotors, ..Acting::default() });
        turning.advance(PERIOD, None, || Ok::<(), std::convert::Infallible>(())).unwrap();
    }
    assert_eq!(met, table.len());
}

#[test]
fn a_reference_is_seen_in_the_axes_of_the_body() {
    // A body a quarter turn about z beyond it sees its rate about x as one about -y.
    let pose = Slew::at_once(Quaternion::identity()).at(0.0);
    let pose = crate::manoeuvre::Pose { rate: Vector::x(), acceleration: Vector::z(), ..pose };
    let by = Vector::new(0.0, 0.0, std::f64::consts::SQRT_2);
    let [rate, acceleration] = pose.seen_from(&by);
    assert!((rate + Vector::y()).norm() < 1e-15 && (acceleration - Vector::z()).norm() < 1e-15);
    assert!(!Itinerary::default().moves(Instant::START));
}
