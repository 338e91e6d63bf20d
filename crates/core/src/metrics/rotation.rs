//! What a rotation comes to: where the manoeuvre ends, what vibration it leaves, how large torques and deflections are.
//!
//! All of it is found on the stretches of the motion, whose polynomials are exact to rounding: no log has a part in it.

use super::goal::Verdict;
use super::{
    ANGLE_ERROR_LATE, ANGLE_ERROR_PEAK, ANGLE_RESIDUAL, ARRIVAL_ANGLE, ARRIVAL_RATE, ITAE, OUTPUT_RESIDUALS,
    OUTPUT_SWINGS, OUTPUT_SWINGS_LATE, PEAK_ACCELERATION, PEAK_FEEDBACK, PEAK_FEEDBACK_ACCELERATION,
    PEAK_OUTPUTS, PEAK_TORQUE, Quantity, RESIDUAL_ENERGY, RESIDUAL_ENERGY_UNIT_INERTIA, SETTLING_TIME,
    SPECTRAL_RADIUS, Told, Value,
};
use crate::analysis::sampled_loop::{Held, Loop};
use crate::law::{Goal, Law, Promise};
use crate::motion::Stretch;
use crate::numerics::polynomial::Polynomial;
use crate::record::{Arrival, Course, Record, RecordError, Sample};
use crate::scenario::Scenario;
use crate::time::Instant;

/// What is late in a run (s).
const LATE: f64 = 5.0;
/// Frequencies of a drift at which its loop is judged, besides its kinks and its end.
const DRIFTING: u32 = 8;

/// Gathers the motion of a rotation.
#[derive(Clone, Debug)]
pub struct Rotation {
    goal: Goal,
    promise: Promise,
    planned: bool,
    /// Whether a torque is an acceleration, and whether an energy is that of a unit of inertia.
    reduced: (bool, bool),
    /// From when on a motion is late, and when the run ends (s).
    late: f64,
    end: f64,
    arrival: Option<Arrival>,
    /// Largest torques: the actuator's, the law's (N m).
    torque: (f64, f64),
    /// Largest distances from the goal: after the manoeuvre, and late (rad).
    error: (f64, f64),
    /// Whether the goal is met; none before it begins.
    verdict: Option<Verdict>,
    /// Integral of time times distance, and what rounding has taken from it (rad s²).
    itae: (f64, f64),
    /// Of a sampled loop, its spectral radius.
    radius: Option<f64>,
    outputs: Vec<Seen>,
}

/// What is seen of an observed coordinate.
#[derive(Clone, Debug)]
struct Seen {
    unit: String,
    /// Largest absolute value.
    peak: f64,
    /// After the manoeuvre, and late.
    after: Range,
    late: Range,
}

/// The smallest and the largest of some values.
#[derive(Copy, Clone, Debug)]
struct Range(f64, f64);

impl Range {
    const EMPTY: Self = Self(f64::INFINITY, f64::NEG_INFINITY);

    fn widen(&mut self, values: &Polynomial) {
        *self = Self(-values.negative().maximum(-self.0), values.maximum(self.1));
    }

    /// Half the width; NaN of nothing.
    fn swing(self) -> f64 {
        if self.0 <= self.1 { 0.5 * (self.1 - self.0) } else { f64::NAN }
    }
}

/// The largest spectral radius of the loop over the frequencies that the run comes to; NaN of what is no such loop.
fn spectral_radius(scenario: &Scenario) -> f64 {
    let Ok((sampled, law)) = Loop::of(scenario) else { return f64::NAN };
    let end = scenario.duration.seconds();
    let modes = 0..sampled.body.modes.len();
    let at = |t: f64| {
        let ratio = |mode| scenario.drift.as_ref().map_or(1.0, |drift| drift.ratio(mode, t));
        let ratios: Vec<f64> = modes.clone().map(ratio).collect();
        let gain = law.extra_gain(sampled.frequency() * ratios[sampled.dominant]);
        Held::new(&sampled, &ratios).closed(gain).spectral_radius()
    };
    let drifting = scenario.drift.iter().flat_map(|drift| {
        let even = (0..DRIFTING).map(|index| end * f64::from(index) / f64::from(DRIFTING));
        drift.kinks().into_iter().filter(move |kink| *kink < end).chain(even)
    });
    drifting.chain([end]).map(at).fold(f64::NAN, f64::max)
}

impl Rotation {
    /// An empty gathering for runs of a scenario.
    pub fn new(scenario: &Scenario) -> Self {
        let (model, end) = (&scenario.model, scenario.duration.seconds());
        let seen =
            |unit: &String| Seen { unit: unit.clone(), peak: 0.0, after: Range::EMPTY, late: Range::EMPTY };
        Self {
            goal: scenario.goal(),
            promise: scenario.promise(),
            planned: scenario.plan.is_some(),
            reduced: (model.commands_acceleration(), model.has_unit_inertia()),
            late: end - LATE,
            end,
            arrival: None,
            torque: (0.0, 0.0),
            error: (f64::NAN, f64::NAN),
            verdict: None,
            itae: (0.0, 0.0),
            radius: matches!(scenario.law, Law::Pd(_)).then(|| spectral_radius(scenario)),
            outputs: model.outputs.iter().map(|output| seen(&output.unit)).collect(),
        }
    }

    /// The metrics of the run that has ended.
    pub fn finish(self) -> Vec<Told> {
        let mut metrics = Vec::new();
        let (acceleration, unit_inertia) = self.reduced;
        if self.planned {
            let of =
                |value: fn(&Arrival) -> f64| Value::Number(self.arrival.as_ref().map_or(f64::NAN, value));
            let residuals = self.arrival.iter().flat_map(|arrival| &arrival.outputs);
            let residual = |(output, seen): (&crate::record::Residual, &Seen)| Quantity {
                value: output.amplitude,
                unit: seen.unit.clone(),
            };
            let energy = if unit_inertia { &RESIDUAL_ENERGY_UNIT_INERTIA } else { &RESIDUAL_ENERGY };
            metrics.extend([
                (&ARRIVAL_ANGLE, of(|arrival| arrival.angle_error_rad)),
                (&ARRIVAL_RATE, of(|arrival| arrival.rate_error_rad_s)),
                (&ANGLE_RESIDUAL, of(|arrival| arrival.angle_residual_rad)),
                (&OUTPUT_RESIDUALS, Value::Quantities(residuals.zip(&self.outputs).map(residual).collect())),
                (energy, of(|arrival| arrival.elastic_energy_j)),
            ]);
        }
        let outputs = |value: fn(&Seen) -> f64| {
            let quantity = |seen: &Seen| Quantity { value: value(seen), unit: seen.unit.clone() };
            Value::Quantities(self.outputs.iter().map(quantity).collect())
        };
        let (peak, feedback) = if acceleration {
            (&PEAK_ACCELERATION, &PEAK_FEEDBACK_ACCELERATION)
        } else {
            (&PEAK_TORQUE, &PEAK_FEEDBACK)
        };
        let verdict = self.verdict.unwrap_or(Verdict::new(self.end, f64::NAN));
        let itae = if self.verdict.is_some() { self.itae.0 } else { f64::NAN };
        metrics.extend([
            (peak, Value::Number(self.torque.0)),
            (feedback, Value::Number(self.torque.1)),
            (&PEAK_OUTPUTS, outputs(|output| output.peak)),
            (&ANGLE_ERROR_PEAK, Value::Number(self.error.0)),
            (&SETTLING_TIME, Value::Number(verdict.settled(self.end))),
            (&ITAE, Value::Number(itae)),
            (&ANGLE_ERROR_LATE, Value::Number(self.error.1)),
            (&OUTPUT_SWINGS, outputs(|output| output.after.swing())),
            (&OUTPUT_SWINGS_LATE, outputs(|output| output.late.swing())),
        ]);
        metrics.extend(verdict.finish(self.end));
        metrics.extend(self.radius.map(|radius| (&SPECTRAL_RADIUS, Value::Number(radius))));
        metrics
    }

    fn see(&mut self, stretch: &Stretch) {
        self.torque.0 = stretch.applied.magnitude(self.torque.0);
        self.torque.1 = self.torque.1.max(stretch.feedback.abs());
        for (seen, output) in self.outputs.iter_mut().zip(&stretch.outputs) {
            seen.peak = output.magnitude(seen.peak);
        }
        // Of a stretch in which the goal begins, or the run becomes late, the part from there on.
        let part = |from: f64| (from - stretch.from) / stretch.length;
        let (goal, late) = (part(self.goal.from.seconds()), part(self.late));
        if goal < 1.0 {
            self.see_after(stretch, goal.max(0.0));
        }
        if goal < 1.0 && late < 1.0 {
            self.see_late(stretch, goal.max(late).max(0.0));
        }
    }

    /// The distance from the goal (rad) over the last part of a stretch, from a point on.
    fn error(&self, stretch: &Stretch, from: f64) -> Polynomial {
        let since = stretch.from - self.goal.from.seconds();
        let (start, slope) = (self.goal.angle + self.goal.rate * since, self.goal.rate * stretch.length);
        let error = stretch.angle.less(start, slope);
        if from > 0.0 { error.part(from, 1.0) } else { error }
    }

    fn see_after(&mut self, stretch: &Stretch, from: f64) {
        let error = self.error(stretch, from);
        let (begins, length) = (stretch.from + from * stretch.length, (1.0 - from) * stretch.length);
        let goal = self.goal.from.seconds();
        let band = || Verdict::new(goal, self.promise.band(error.at(0.0).abs()));
        self.verdict.get_or_insert_with(band).see(begins, length, &error);
        // The larger one, whichever is a number.
        self.error.0 = error.magnitude(self.error.0.max(0.0));
        let integral = integral(&error, begins - goal, length) - self.itae.1;
        let total = self.itae.0 + integral;
        self.itae = (total, (total - self.itae.0) - integral);
        for (seen, output) in self.outputs.iter_mut().zip(&stretch.outputs) {
            if from > 0.0 {
                seen.after.widen(&output.part(from, 1.0));
            } else {
                seen.after.widen(output);
            }
        }
    }

    fn see_late(&mut self, stretch: &Stretch, from: f64) {
        self.error.1 = self.error(stretch, from).magnitude(self.error.1.max(0.0));
        for (seen, output) in self.outputs.iter_mut().zip(&stretch.outputs) {
            if from > 0.0 {
                seen.late.widen(&output.part(from, 1.0));
            } else {
                seen.late.widen(output);
            }
        }
    }
}

/// The integral of time times the absolute value over a stretch that begins at a time and is so long (s).
fn integral(value: &Polynomial, begins: f64, length: f64) -> f64 {
    let (low, high) = value.bounds();
    let mut edges = vec![0.0];
    if low < 0.0 && high > 0.0 {
        value.roots(0.0, &mut edges);
    }
    edges.push(1.0);
    let piece = |ends: &[f64]| {
        let [plain, weighted] = value.integrals(ends[0], ends[1]);
        (length * (begins * plain + length * weighted)).abs()
    };
    edges.windows(2).map(piece).sum()
}

impl Record for Rotation {
    fn course(&self) -> Course {
        Course::All
    }

    fn record(&mut self, _: Instant, sample: Sample<'_>) -> Result<(), RecordError> {
        if let Sample::Arrival(arrival) = sample {
            self.arrival = Some(arrival.clone());
        }
        Ok(())
    }

    fn stretch(&mut self, _: Instant, stretch: &Stretch) -> Result<(), RecordError> {
        self.see(stretch);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector, RowDVector};

    use super::*;
    use crate::motion::stretch::Linear;

    /// What a motion comes to: largest and smallest value, integral, ITAE, time outside a band, zeros.
    struct Arc {
        range: Range,
        integral: f64,
        itae: f64,
        outside: f64,
        zeros: usize,
    }

    fn arc(system: &DMatrix<f64>, push: DVector<f64>, z: &[f64], output: &[f64], end: f64, band: f64) -> Arc {
        let fastest =
            system.row_iter().map(|row| row.iter().map(|a| a.abs()).sum::<f64>()).fold(0.0, f64::max);
        let mut linear = Linear::new(system, push, &DVector::from_column_slice(z), fastest);
        let output = RowDVector::from_row_slice(output);
        let mut verdict = Verdict::new(0.0, band);
        let (mut range, mut sums, mut zeros, mut h) = (Range::EMPTY, (0.0, 0.0), Vec::new(), 0.0);
        while h < end {
            let length = linear.expand(h).min(end - h);
            let series =
                std::array::from_fn(|n| output.iter().zip(linear.series()).map(|(c, z)| c * z[n]).sum());
            let y = Polynomial::of(&series, length);
            range.widen(&y);
            y.roots(0.0, &mut zeros);
            verdict.see(h, length, &y);
            sums = (sums.0 + length * y.integrals(0.0, 1.0)[0], sums.1 + integral(&y, h, length));
            h = if length < end - h { h + length } else { end };
        }
        let [_, _, (_, Value::Number(outside))] = verdict.finish(end) else { panic!("a time outside") };
        Arc { range, integral: sums.0, itae: sums.1, outside, zeros: zeros.len() }
    }

    fn agrees(arc: &Arc, [max, min, integral, itae, outside]: [f64; 5], zeros: usize) {
        let close = |value: f64, exact: f64| {
            assert!((value - exact).abs() <= 1e-13 * exact.abs().max(1e-9), "{value:e} {exact:e}");
        };
        close(arc.range.1, max);
        close(arc.range.0, min);
        close(arc.integral, integral);
        close(arc.itae, itae);
        assert!((arc.outside - outside).abs() < 2e-12, "{} {outside}", arc.outside);
        assert_eq!(arc.zeros, zeros);
    }

    /// x_r'' = m, x_i'' + w_i² x_i = k_i m with m = u - a y', y = x_r + x_1 + x_2: A, and what a unit of u pushes.
    fn two_modes(order: usize, back_emf: f64) -> (DMatrix<f64>, DVector<f64>) {
        let (mut system, mut push) = (DMatrix::zeros(order, order), DVector::zeros(order));
        for (x, w, k) in [(0, 0.0, 1.0), (2, 0.44, 0.0213), (4, 0.755, 0.0216)] {
            system[(x, x + 1)] = 1.0;
            system[(x + 1, x)] = -w * w;
            push[x + 1] = k;
            for rate in [1, 3, 5] {
                system[(x + 1, rate)] -= back_emf * k;
            }
        }
        (system, push)
    }

    // The numbers are those of an implementation with 66 digits (Taylor series of the matrix exponential, certified strides).

    #[test]
    fn a_coast_with_back_emf() {
        let (system, push) = two_modes(6, 2e-4);
        let start = [5e-4, 4e-5, 4e-6, 1e-6, -2e-6, 1e-6];
        let found = arc(&system, push * -1e-6, &start, &[1.0, 0.0, 1.0, 0.0, 1.0, 0.0], 19.0, 4e-4);
        let exact =
            [1.079_838_841_452_594_3e-3, 5.02e-4, 1.558_141_700_035_610_4e-2, 1.654_199_654_189_871e-1, 19.0];
        agrees(&found, exact, 0);
    }

    #[test]
    fn three_axes_with_a_momentum_bias() {
        let (n, h) = (1.1e-3, 20.0);
        let inertia = [900.0, 1000.0, 600.0];
        let delta = [[8.0, 0.5, -1.0], [0.7, 7.0, 2.0], [-0.4, 1.5, 5.0]];
        let (frequency, damping) = ([0.37, 0.62, 1.1], [0.002, 0.003, 0.002]);
        let [j1, j2, j3] = inertia;
        let mut mass = DMatrix::identity(6, 6);
        let (mut stiffness, mut gyro) = (DMatrix::zeros(6, 6), DMatrix::<f64>::zeros(6, 6));
        for i in 0..3 {
            mass[(i, i)] = inertia[i];
            for mode in 0..3 {
                mass[(i, 3 + mode)] = delta[i][mode];
                mass[(3 + mode, i)] = delta[i][mode];
            }
            stiffness[(3 + i, 3 + i)] = frequency[i] * frequency[i];
            gyro[(3 + i, 3 + i)] = 2.0 * damping[i] * frequency[i];
        }
        gyro[(0, 2)] = h - n * (j1 - j2 + j3);
        gyro[(2, 0)] = -gyro[(0, 2)];
        stiffness[(0, 0)] = 4.0 * n * n * (j2 - j3) + n * h;
        stiffness[(1, 1)] = 3.0 * n * n * (j1 - j3);
        stiffness[(2, 2)] = n * n * (j2 - j1) + n * h;
        let inverse = mass.try_inverse().expect("regular");
        let mut system = DMatrix::zeros(12, 12);
        system.view_mut((0, 6), (6, 6)).copy_from(&DMatrix::identity(6, 6));
        system.view_mut((6, 0), (6, 6)).copy_from(&(-&inverse * stiffness));
        system.view_mut((6, 6), (6, 6)).copy_from(&(-&inverse * gyro));
        let mut push = DVector::zeros(12);
        let torque = DVector::from_column_slice(&[1e-4, -2e-4, 1e-4, 0.0, 0.0, 0.0]);
        push.rows_mut(6, 6).copy_from(&(&inverse * torque));
        let start = [1e-5, -2e-5, 3e-5, 0.02, -0.03, 0.02, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let yaw: [f64; 12] = std::array::from_fn(|index| f64::from(u8::from(index == 2)));
        let found = arc(&system, push, &start, &yaw, 60.0, 5e-5);
        let exact = [
            7.283_159_757_285_736e-4,
            -1.167_052_922_413_150_9e-4,
            1.820_836_446_177_067e-2,
            6.845_346_442_340_301e-1,
            57.437_801_542_955_22,
        ];
        agrees(&found, exact, 2);
    }

    #[test]
    fn an_angle_behind_filters() {
        let (mut system, push) = two_modes(9, 2e-4);
        let notch = 0.755;
        for (column, value) in [(0, 2.0), (2, 2.0), (4, 2.0), (6, -2.0)] {
            system[(6, column)] = value;
        }
        system[(7, 8)] = 1.0;
        (system[(8, 6)], system[(8, 7)], system[(8, 8)]) = (1.0, -notch * notch, -1.4 * notch);
        let start = [1e-4, -1.2e-5, 5e-5, 0.0, 3e-5, 1e-5, 0.0, 0.0, 0.0];
        let output = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -1.3 * notch];
        let found = arc(&system, push * 1e-6, &start, &output, 30.0, 1e-4);
        let exact = [
            1.814_486_010_142_417e-4,
            0.0,
            1.755_608_189_591_963e-3,
            3.105_650_300_898_445e-2,
            3.390_977_317_271_245,
        ];
        agrees(&found, exact, 0);
    }
}
