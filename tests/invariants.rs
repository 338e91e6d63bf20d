//! Invariants of a run, whatever its parts: momentum balances the external torque, energy does not grow by
//! itself, pieces give the whole, and metrics are numbers.

use std::hash::{Hash, Hasher};

use flexsc_core::control::actuator::JetCycle;
use flexsc_core::control::quantity::total_width;
use flexsc_core::metrics::{MetricValue, Metrics, MetricsCollector};
use flexsc_core::numerics::attitude::Vector;
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::record::{
    Column, Columns, Detail, Energy, Magnetorquers, Modes, Orbit, Pointing, Rate, Record, RecordError,
    Report, Sample, ThreeAxisCycle, Torque, Torques, Trace,
};
use flexsc_core::{Scenario, Simulation};
use nalgebra::{Matrix3, Quaternion};

/// Times at which a run in pieces is stopped (s): between all events, at a sample, and at one of a law's
/// stages.
const STOPS: [f64; 5] = [0.0, 1.71, 3.0, 3.2, 33.333];

/// External torque in the rows of a three-axis body, from one row to the next.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum External<'a> {
    /// No torque: rotors inside the body act.
    None,
    /// The torque of the row acts, fixed in the body, until the next row.
    Applied,
    /// The magnetic moments of the row act in the field.
    Magnetic,
    /// Thrusters with these torques (N m) fire from the start of a cycle on: one after the other, or in
    /// groups that turn about +x, -x, +y, -y, +z and -z.
    Pulses(&'a [Vector; 6]),
}

/// Motion of a three-axis body in a row.
struct ThreeAxisRow {
    t: f64,
    attitude: Quaternion<f64>,
    /// Absolute value of the whole angular momentum (N m s), and energy of rotation and modes (J).
    momentum: f64,
    energy: f64,
    applied: Vector,
    /// Magnetic moments until the next row (A m²), and the field (T), in the body's axes.
    moment: Vector,
    field: Vector,
}

/// Motion of a one-axis body in a row.
struct OneAxisRow {
    t: f64,
    rigid_rate: f64,
    applied: f64,
    modes: Vec<[f64; 2]>,
}

/// Pulse of a thruster: start and end (s), and the thruster's index.
type Pulse = (f64, f64, usize);

/// Rows of a run.
#[derive(Default)]
struct Rows {
    one: Vec<OneAxisRow>,
    three: Vec<ThreeAxisRow>,
    pulses: Vec<Pulse>,
    /// Instants (s) of control cycles, with the rigid rates (rad/s) and the momentum of the rotors (N m s).
    cycles: Vec<(f64, Vector, Vector)>,
    /// Number of pulses of jets since the start.
    fired: u64,
    /// Torque of a one-axis law without actuator since its last switching (N m).
    switched: f64,
}

/// Run with everything that the invariants are about.
pub struct Flown {
    rows: Rows,
    metrics: Metrics,
    /// Hash of all rows of a full log, and the last observation to the bit.
    log: u64,
    end: Vec<u64>,
}

impl Rows {
    fn add_one_axis(&mut self, t: f64, rate: &Rate, report: &Report) {
        let torque = report.get::<Torque>().map(|torque| torque.applied_nm);
        let modes = report.get::<Modes>().map_or(&[][..], |modes| &modes.modes);
        self.one.push(OneAxisRow {
            t,
            rigid_rate: rate.rigid_rad_s,
            applied: torque.unwrap_or(self.switched),
            modes: modes.iter().map(|mode| [mode.displacement_rad, mode.rate_rad_s]).collect(),
        });
    }

    fn add_three_axes(&mut self, t: f64, pointing: &Pointing, report: &Report) {
        let energy = report.get::<Energy>().expect("energies beside an attitude");
        let applied = |axis: usize| report.get::<Torques>().map_or(0.0, |all| all.axes[axis].applied_nm);
        let moment = |axis: usize| report.get::<Magnetorquers>().map_or(0.0, |all| all.axes[axis].moment_am2);
        let field = |axis: usize| report.get::<Orbit>().map_or(0.0, |orbit| orbit.axes[axis].field_t);
        self.three.push(ThreeAxisRow {
            t,
            attitude: Quaternion::new(pointing.q_w, pointing.q_x, pointing.q_y, pointing.q_z),
            momentum: energy.momentum_nm_s,
            energy: energy.rotational_j + energy.elastic_j,
            applied: Vector::from_fn(|axis, _| applied(axis)),
            moment: Vector::from_fn(|axis, _| moment(axis)),
            field: Vector::from_fn(|axis, _| field(axis)),
        });
    }

    fn add_cycle(&mut self, t: f64, cycle: &ThreeAxisCycle, report: &Report) {
        self.cycles.push((t, cycle.rigid_rate_rad_s.into(), cycle.stored_momentum_nm_s.into()));
        let Some(jets) = report.get::<JetCycle>() else { return };
        // Jets may have cycles of their own, which are longer.
        if std::mem::replace(&mut self.fired, jets.pulses) == jets.pulses {
            return;
        }
        let grouped =
            jets.on.iter().enumerate().map(|(axis, on)| (2 * axis + usize::from(*on < 0.0), on.abs()));
        let each = jets.each.iter().copied().enumerate();
        let fired: Vec<_> = if jets.each.is_empty() { grouped.collect() } else { each.collect() };
        self.pulses
            .extend(fired.into_iter().filter(|(_, on)| *on > 0.0).map(|(index, on)| (t, t + on, index)));
    }
}

impl Record for Rows {
    fn wants_motion(&self) -> bool {
        true
    }

    fn record(&mut self, now: Instant, sample: Sample<'_>) -> Result<(), RecordError> {
        let t = now.seconds();
        match sample {
            Sample::Begin(law) => self.switched = law.torque_nm,
            Sample::Switching(command, _) => self.switched = command.torque_nm,
            Sample::Row(_) => {}
            Sample::Report(report) => {
                if let Some(cycle) = report.get::<ThreeAxisCycle>() {
                    self.add_cycle(t, cycle, report);
                } else if let Some(pointing) = report.get::<Pointing>() {
                    self.add_three_axes(t, pointing, report);
                } else if let Some(rate) = report.get::<Rate>() {
                    self.add_one_axis(t, rate, report);
                }
            }
        }
        Ok(())
    }
}

/// Returns a vector of the body's axes in inertial axes.
fn turned(attitude: &Quaternion<f64>, v: &Vector) -> Vector {
    let u = attitude.imag();
    v + 2.0 * u.cross(&(u.cross(v) + attitude.w * v))
}

/// Hash by one multiplication for each word: every bit of a row changes it.
#[derive(Default)]
struct WordHasher(u64);

impl Hasher for WordHasher {
    fn write(&mut self, bytes: &[u8]) {
        for piece in bytes.chunks(8) {
            let mut word = [0; 8];
            word[..piece.len()].copy_from_slice(piece);
            self.write_u64(u64::from_le_bytes(word));
        }
    }

    fn write_u64(&mut self, word: u64) {
        self.0 = (self.0.rotate_left(5) ^ word).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    }

    fn finish(&self) -> u64 {
        self.0
    }
}

/// Hashes every row of every topic, to the bit.
fn hash(columns: &Columns, hasher: &mut WordHasher) {
    for (name, column) in &columns.columns {
        name.hash(hasher);
        match column {
            Column::Numbers(values) => values.iter().for_each(|value| value.to_bits().hash(hasher)),
            Column::Counts(values) => values.hash(hasher),
            Column::Integers(values) => values.hash(hasher),
            Column::Labels(values, _) => values.hash(hasher),
            Column::Texts(values) => values.hash(hasher),
            Column::Rows(counts, rows) => {
                counts.hash(hasher);
                hash(rows, hasher);
            }
        }
    }
}

impl Flown {
    /// Runs a scenario, stopped at these times (s).
    pub fn new(scenario: &Scenario, stops: &[f64]) -> Self {
        let mut simulation = Simulation::new(scenario, 0);
        let mut record = ((Trace::new(Detail::Full), Rows::default()), MetricsCollector::new(scenario));
        for stop in stops {
            let until = Instant::START + Span::from_seconds(*stop);
            simulation.run_up_to(until, &mut record).expect("a piece");
        }
        simulation.run(&mut record).expect("a run");
        let fields = simulation.observation_fields(scenario);
        let mut end = vec![0.0; total_width(&fields)];
        simulation.observe(&mut end).expect("finite numbers");
        let ((trace, rows), metrics) = record;
        let mut hasher = WordHasher::default();
        trace.into_columns().for_each(|(topic, columns)| {
            topic.hash(&mut hasher);
            hash(&columns, &mut hasher);
        });
        Self {
            rows,
            metrics: metrics.finish(scenario),
            log: hasher.finish(),
            end: end.into_iter().map(f64::to_bits).collect(),
        }
    }
}

/// Checks that a run in pieces has the rows, the metrics and the last observation of the run in one.
pub fn pieces_give_the_whole(scenario: &Scenario, whole: &Flown) -> Result<(), String> {
    let pieces = Flown::new(scenario, &STOPS);
    let texts = [whole, &pieces].map(|run| run.metrics.to_json().to_string());
    if pieces.end != whole.end || texts[0] != texts[1] {
        return Err(format!("pieces end elsewhere:\n{}\n{}", texts[0], texts[1]));
    }
    if pieces.log == whole.log { Ok(()) } else { Err("pieces have other rows".to_owned()) }
}

/// Metrics that a run may lack although their descriptions do not say `null`: a run without a band, without a window
/// that begins in its second half, and of one axis, which has no cycles.
const MISSING: [&str; 3] = ["time_outside_s", "envelope_late_mean_rad", "elastic_rate_error_rms_rad_s"];

/// Checks that every metric is a finite number, or may be missing by its description.
pub fn metrics_are_numbers(run: &Flown) -> Result<(), String> {
    for (meaning, value) in &run.metrics.0 {
        let numbers = match value {
            MetricValue::Number(number) => vec![*number],
            MetricValue::Numbers(_) | MetricValue::Quantities(_) => value.numbers(),
            MetricValue::Count(_) | MetricValue::Word(_) | MetricValue::Words(_) => Vec::new(),
        };
        let may_be_missing = meaning.doc.contains("null") || MISSING.contains(&meaning.name);
        let wrong = numbers.iter().find(|number| !(number.is_finite() || may_be_missing && number.is_nan()));
        if let Some(wrong) = wrong {
            return Err(format!("{} is {wrong}", meaning.name));
        }
    }
    Ok(())
}

/// Checks that the rigid rate of a one-axis body changes by the integral of the torque over its inertia
/// (kg m²), within `tolerance` of it.
pub fn torque_changes_the_rate(run: &Flown, inertia: f64, tolerance: f64) -> Result<(), String> {
    let rows = &run.rows.one;
    let (mut impulse, mut scale) = (0.0, 1e-12);
    for (row, next) in rows.iter().zip(&rows[1..]) {
        impulse += row.applied * (next.t - row.t);
        scale += row.applied.abs() * (next.t - row.t);
        let gained = inertia * (next.rigid_rate - rows[0].rigid_rate);
        if (gained - impulse).abs() > tolerance * scale {
            return Err(format!("at {} s the momentum has grown by {gained}, not by {impulse}", next.t));
        }
    }
    Ok(())
}

/// Angular impulse (N m s) of external torques from one row to the next, in inertial axes, and that of their
/// absolute values. The attitude turns little between rows: the trapezoidal rule suffices.
fn impulse(rows: [&ThreeAxisRow; 2], external: External, pulses: &[Pulse]) -> (Vector, f64) {
    let [row, next] = rows;
    let h = next.t - row.t;
    let mean = |before: Vector, after: Vector| {
        (0.5 * h * (turned(&row.attitude, &before) + turned(&next.attitude, &after)), h * before.norm())
    };
    match external {
        External::None => (Vector::zeros(), 0.0),
        External::Applied => mean(row.applied, row.applied),
        External::Magnetic => mean(row.moment.cross(&row.field), row.moment.cross(&next.field)),
        External::Pulses(torques) => {
            let mut sum = (Vector::zeros(), 0.0);
            for (from, to, thruster) in pulses {
                let (from, to) = (from.max(row.t), to.min(next.t));
                if to > from {
                    let (torque, part) = (&torques[*thruster], (0.5 * (from + to) - row.t) / h);
                    let [before, after] = rows.map(|row| turned(&row.attitude, torque));
                    sum.0 += (to - from) * before.lerp(&after, part);
                    sum.1 += (to - from) * torque.norm();
                }
            }
            sum
        }
    }
}

/// Checks that the angular momentum of a three-axis body is at each row that of the start, of the body
/// without its rotors (N m s, inertial axes), and the integral of the external torque, within `tolerance` of
/// it.
pub fn torque_changes_the_momentum(
    run: &Flown,
    body: Vector,
    external: External,
    tolerance: f64,
) -> Result<(), String> {
    let rows = &run.rows.three;
    let start = body + run.rows.cycles[0].2;
    let (mut momentum, mut scale) = (start, 0.0);
    // Displaced hinges change the inertia, by less than this.
    let begun = rows[0].momentum;
    if (begun - start.norm()).abs() > 1e-3 * begun {
        return Err(format!("at the start the momentum is {begun}, not {}", start.norm()));
    }
    momentum *= begun / start.norm();
    for (row, next) in rows.iter().zip(&rows[1..]) {
        let (change, size) = impulse([row, next], external, &run.rows.pulses);
        (momentum, scale) = (momentum + change, scale + size);
        let off = next.momentum - momentum.norm();
        if off.abs() > 1e-12 * begun.max(scale) + tolerance * scale {
            return Err(format!("at {} s the momentum is {} N m s, off by {off:e}", next.t, next.momentum));
        }
    }
    Ok(())
}

/// Checks that the momentum of a three-axis body with this inertia (kg m²) is at each cycle that of its rates
/// and of its rotors, within `tolerance` of the larger of it and the body's own.
pub fn momentum_is_that_of_rates_and_rotors(
    run: &Flown,
    inertia: &Matrix3<f64>,
    tolerance: f64,
) -> Result<(), String> {
    let mut rows = run.rows.three.iter();
    for (t, rate, stored) in &run.rows.cycles {
        let Some(row) = rows.find(|row| row.t == *t) else { return Err(format!("no row at {t} s")) };
        let own = inertia * rate;
        let off = (own + stored).norm() - row.momentum;
        // Modes change the inertia, so that the error is a part of the body's own momentum, which rotors may cancel.
        if off.abs() > tolerance * own.norm().max(row.momentum) {
            return Err(format!("at {t} s the momentum is {} N m s, off by {off:e}", row.momentum));
        }
    }
    Ok(())
}

/// Checks that no energy comes from nowhere, in a run without torques: that of a three-axis body as a whole,
/// and that of each mode of a one-axis body, with natural frequencies `frequencies` (rad/s), never grows.
pub fn energy_does_not_grow(run: &Flown, frequencies: &[f64]) -> Result<(), String> {
    let three = run.rows.three.iter().map(|row| (row.t, vec![row.energy]));
    let energy = |([x, rate], w): (&[f64; 2], &f64)| rate * rate + w * w * x * x;
    let one = run.rows.one.iter().map(|row| (row.t, row.modes.iter().zip(frequencies).map(energy).collect()));
    let rows: Vec<(f64, Vec<f64>)> = three.chain(one).collect();
    for pair in rows.windows(2) {
        for (before, after) in pair[0].1.iter().zip(&pair[1].1) {
            if after - before > 1e-12 * before {
                return Err(format!("at {} s the energy {before} J has grown to {after} J", pair[1].0));
            }
        }
    }
    Ok(())
}

/// A hash that never differs would prove nothing.
#[test]
fn every_bit_of_a_row_changes_the_hash() {
    let hashed = |values: Vec<f64>| {
        let mut hasher = WordHasher::default();
        let columns = vec![("angle_rad".to_owned(), Column::Numbers(values))];
        hash(&Columns { columns }, &mut hasher);
        hasher.finish()
    };
    let row = [1e-3, -0.0, f64::NAN];
    let whole = hashed(row.to_vec());
    for (place, bit) in (0..row.len()).flat_map(|place| (0..64).map(move |bit| (place, bit))) {
        let mut other = row.to_vec();
        other[place] = f64::from_bits(row[place].to_bits() ^ (1 << bit));
        assert_ne!(hashed(other), whole, "{place} {bit}");
    }
}
