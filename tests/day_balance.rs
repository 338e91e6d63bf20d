//! Balances of the CubeSat's first day, from the rows of its log: angular momentum and kinetic energy change by what the
//! torques of the environment, of the magnetorquers and of the motors of the wheels give.

use flexsc_core::numerics::attitude::Vector;
use flexsc_core::numerics::time::Instant;
use flexsc_core::record::{
    Energy, Magnetorquers, Orbit, Pointing, Rates, Record, RecordError, Sample, Torques, Wheels,
};
use flexsc_core::{Scenario, Simulation};
use nalgebra::Quaternion;

use crate::util::SCENARIOS;

/// The day in two hours, with each of its modes, and rows at the ends and in the middle of the law's periods of 0.5 s.
pub const SHORT: [(&str, &str); 7] = [
    ("duration = 86400.0", "duration = 7200.0"),
    ("log.period = 20.0", "log.period = 0.25"),
    ("run_time > 17600", "run_time > 4800"),
    ("from = 60000.0, to = 67200.0", "from = 5600.0, to = 6600.0"),
    ("silent(star_tracker) > 2400", "silent(star_tracker) > 300"),
    ("from = 17850", "from = 5000"),
    ("to = 18150", "to = 5300"),
];

/// Tolerance of the energy (J), of 2.1e-3 J of work: modes hold at most 7.3e-7 J and damp out what the steps of the
/// torques give them, which the rows of the rigid body do not have.
const ENERGY: f64 = 2e-9;

/// Tolerance of the momentum (N m s), of 0.026 N m s: bending turns the hub, whose attitude the rows have, against the mean
/// axes of the body.
const MOMENTUM: f64 = 3e-7;

/// Motion of the body and the torques on it in a row.
struct Row {
    t: f64,
    attitude: Quaternion<f64>,
    rate: Vector,
    /// Rotational energy, without the spin of the wheels (J).
    energy: f64,
    /// Momenta (N m s) and torques (N m) of the three wheels, which are along the axes.
    stored: Vector,
    motors: Vector,
    /// Moments until the next command (A m²), and the field (T).
    moment: Vector,
    field: Vector,
    /// Torque of the environment (N m).
    environment: Vector,
}

/// Factors of the torques of the environment, the magnetorquers and the motors in a balance.
type Factors = [f64; 3];

#[derive(Default)]
struct Rows(Vec<Row>);

impl Record for Rows {
    fn wants_motion(&self) -> bool {
        true
    }

    fn record(&mut self, now: Instant, sample: Sample<'_>) -> Result<(), RecordError> {
        let Sample::Report(report) = sample else { return Ok(()) };
        let Some(pointing) = report.get::<Pointing>() else { return Ok(()) };
        let rates = &report.get::<Rates>().expect("rates").axes;
        let wheels = &report.get::<Wheels>().expect("wheels").wheels;
        let torquers = &report.get::<Magnetorquers>().expect("magnetorquers").axes;
        let orbit = &report.get::<Orbit>().expect("an orbit").axes;
        let torques = &report.get::<Torques>().expect("torques").axes;
        self.0.push(Row {
            t: now.seconds(),
            attitude: Quaternion::new(pointing.q_w, pointing.q_x, pointing.q_y, pointing.q_z),
            rate: Vector::from_fn(|axis, _| rates[axis].rigid_rad_s),
            energy: report.get::<Energy>().expect("energies").rotational_j,
            stored: Vector::from_fn(|axis, _| wheels[axis].momentum_nm_s),
            motors: Vector::from_fn(|axis, _| wheels[axis].torque_nm),
            moment: Vector::from_fn(|axis, _| torquers[axis].moment_am2),
            field: Vector::from_fn(|axis, _| orbit[axis].field_t),
            environment: Vector::from_fn(|axis, _| torques[axis].disturbance_nm),
        });
        Ok(())
    }
}

impl Row {
    fn inertial(&self, v: Vector) -> Vector {
        let u = self.attitude.imag();
        v + 2.0 * u.cross(&(u.cross(&v) + self.attitude.w * v))
    }

    /// Returns the external torque (N m) and the power on the body (W), with the commands of the first row of the period.
    fn loads(&self, commanded: &Self, [environment, magnetic, motors]: Factors) -> (Vector, f64) {
        let external = environment * self.environment + magnetic * commanded.moment.cross(&self.field);
        (external, (external - motors * commanded.motors).dot(&self.rate))
    }
}

/// Returns the largest gaps of the momentum (N m s) and of the energy (J).
fn gaps(rows: &[Row], inertia: &nalgebra::Matrix3<f64>, factors: Factors) -> (f64, f64) {
    let momentum = |row: &Row| row.inertial(inertia * row.rate + row.stored);
    let (mut impulse, mut work) = (momentum(&rows[0]), rows[0].energy);
    let mut largest = (0.0_f64, 0.0_f64);
    for period in rows.windows(3).step_by(2) {
        let [first, middle, last] = period else { unreachable!() };
        for (row, weight) in [(first, 1.0), (middle, 4.0), (last, 1.0)] {
            let (torque, power) = row.loads(first, factors);
            let part = weight / 6.0 * (last.t - first.t);
            impulse += part * row.inertial(torque);
            work += part * power;
        }
        largest.0 = largest.0.max((momentum(last) - impulse).norm());
        largest.1 = largest.1.max((last.energy - work).abs());
    }
    largest
}

/// Both balances close, and neither would with 1 % more of the torque of one part, of which the motors exchange momentum
/// within the spacecraft.
#[test]
fn the_torques_of_a_day_give_its_momentum_and_energy() {
    let mut text = std::fs::read_to_string(format!("{SCENARIOS}/cubesat-day.toml")).expect("a file");
    for (long, short) in SHORT {
        assert!(text.contains(long), "{long}");
        text = text.replace(long, short);
    }
    let scenario = Scenario::parse("cubesat-day.toml", &text).unwrap_or_else(|error| panic!("{error}"));
    let mut rows = Rows::default();
    Simulation::new(&scenario, 0).run(&mut rows).expect("a run");
    let Rows(rows) = rows;
    assert_eq!(rows.len(), 28801);
    let inertia = scenario.model.three_axis().expect("three axes").inertia;
    let (momentum, energy) = gaps(&rows, &inertia, [1.0; 3]);
    assert!(momentum < MOMENTUM && energy < ENERGY, "{momentum:e} N m s, {energy:e} J");
    for (factors, is_external) in
        [([1.01, 1.0, 1.0], true), ([1.0, 1.01, 1.0], true), ([1.0, 1.0, 1.01], false)]
    {
        let (momentum, energy) = gaps(&rows, &inertia, factors);
        assert!(energy > 5.0 * ENERGY, "{factors:?}: {energy:e} J");
        assert!(!is_external || momentum > 10.0 * MOMENTUM, "{factors:?}: {momentum:e} N m s");
    }
}
