//! Metrics of a rotation: errors at the end of the manoeuvre, residual vibration, largest torques and deflections.
//!
//! All of them are computed from the stretches of the motion, whose polynomials are exact to rounding, and from no log.

mod lanes;

use flexsc_control::law::{ErrorBand, Setpoint};
use flexsc_dynamics::MotionPiece;
use flexsc_dynamics::axis_model::AxisModel;
use flexsc_numerics::polynomial::Polynomial;
use flexsc_numerics::time::Instant;
use flexsc_record::{Arrival, PieceDemand, Record, RecordError, Sample};

use super::goal::GoalMetrics;
use super::{
    ANGLE_ERROR_LATE, ANGLE_ERROR_PEAK, ANGLE_RESIDUAL, ARRIVAL_ANGLE, ARRIVAL_RATE, ITAE, MetricDescription,
    MetricValue, NamedMetric, NumberWithUnit, OUTPUT_RESIDUALS, OUTPUT_SWINGS, OUTPUT_SWINGS_LATE,
    PEAK_ACCELERATION, PEAK_FEEDBACK, PEAK_FEEDBACK_ACCELERATION, PEAK_OUTPUTS, PEAK_TORQUE, RESIDUAL_ENERGY,
    RESIDUAL_ENERGY_UNIT_INERTIA, SETTLING_TIME, SPECTRAL_RADIUS, Selection,
};
use flexsc_analysis::sampled_loop::{DiscretePlant, SampledLoop};
use flexsc_scenario::Scenario;
use flexsc_scenario::metric_descriptions::OF_GOAL;

pub use lanes::{LaneManoeuvreMetrics, LanePiece};

/// Length of the late part of a run, at its end (s).
const LATE: f64 = 5.0;
/// Number of frequencies of a drift at which its loop is analysed, besides its kinks and its end.
const DRIFTING: u32 = 8;

/// Collector of the motion of a rotation.
#[derive(Clone, Debug)]
pub struct ManoeuvreMetrics {
    goal: Setpoint,
    promise: ErrorBand,
    planned: bool,
    /// True if torques are accelerations, and true if energies are per unit of inertia.
    reduced: (bool, bool),
    /// Start of the late part of the run, and end of the run (s).
    late: f64,
    end: f64,
    arrival: Option<Arrival>,
    /// Largest torques: of the actuator, of the law (N m).
    torque: (f64, f64),
    /// Largest distances from the goal: after the manoeuvre, and in the late part (rad).
    error: (f64, f64),
    /// Verdict on the goal; none before the goal starts.
    verdict: Option<GoalMetrics>,
    /// Integral of time times distance, and the rounding carry of the sum (rad s²).
    itae: (f64, f64),
    /// Spectral radius of a sampled loop.
    radius: Option<f64>,
    outputs: Vec<CoordinateRange>,
    /// True if any metric of the motion is wanted.
    wants_course: bool,
}

/// Metrics that are computed from the motion.
const OF_COURSE: &[MetricDescription] = &[
    PEAK_TORQUE,
    PEAK_FEEDBACK,
    PEAK_OUTPUTS,
    ANGLE_ERROR_PEAK,
    SETTLING_TIME,
    ITAE,
    ANGLE_ERROR_LATE,
    OUTPUT_SWINGS,
    OUTPUT_SWINGS_LATE,
];

/// Values of an observed coordinate.
#[derive(Clone, Debug)]
struct CoordinateRange {
    unit: String,
    /// Largest absolute value.
    peak: f64,
    /// Ranges after the manoeuvre, and in the late part.
    after: Range,
    late: Range,
}

/// Smallest and largest of some values.
#[derive(Copy, Clone, Debug)]
struct Range(f64, f64);

impl Range {
    const EMPTY: Self = Self(f64::INFINITY, f64::NEG_INFINITY);

    fn widen(&mut self, values: &Polynomial) {
        *self = Self(-values.negative().maximum(-self.0), values.maximum(self.1));
    }

    /// Returns half the width of the range; NaN if it is empty.
    fn swing(self) -> f64 {
        if self.0 <= self.1 { 0.5 * (self.1 - self.0) } else { f64::NAN }
    }
}

/// Returns the largest spectral radius of the loop over the frequencies of the run; NaN for a scenario without a
/// sampled loop.
fn spectral_radius(scenario: &Scenario) -> f64 {
    let Ok((sampled, law)) = SampledLoop::from_scenario(scenario) else { return f64::NAN };
    let end = scenario.duration.seconds();
    let modes = 0..sampled.body.modes.len();
    let ratios = |t: f64| {
        let ratio = |mode| scenario.study.drift.as_ref().map_or(1.0, |drift| drift.ratio(mode, t));
        modes.clone().map(ratio).collect()
    };
    let drifting = scenario.study.drift.iter().flat_map(|drift| {
        let even = (0..DRIFTING).map(|index| end * f64::from(index) / f64::from(DRIFTING));
        drift.kinks().into_iter().filter(move |kink| *kink < end).chain(even)
    });
    let all: Vec<Vec<f64>> = drifting.chain([end]).map(ratios).collect();
    let arrival_of = |(held, ratios): (DiscretePlant<'_>, &Vec<f64>)| {
        let gain = law.extra_gain(sampled.frequency() * ratios[sampled.dominant]);
        held.closed(gain).spectral_radius()
    };
    DiscretePlant::for_ratios(&sampled, &all).into_iter().zip(&all).map(arrival_of).fold(f64::NAN, f64::max)
}

impl ManoeuvreMetrics {
    /// Creates an empty collector for runs of a scenario.
    pub fn new(scenario: &Scenario, body: &AxisModel, selection: &Selection) -> Self {
        let end = scenario.duration.seconds();
        let range_of = |unit: &String| CoordinateRange {
            unit: unit.clone(),
            peak: 0.0,
            after: Range::EMPTY,
            late: Range::EMPTY,
        };
        Self {
            goal: scenario.goal(),
            promise: scenario.expected_band(),
            planned: scenario.plan.is_some(),
            reduced: (body.commands_acceleration(), body.has_unit_inertia()),
            late: end - LATE,
            end,
            arrival: None,
            torque: (0.0, 0.0),
            error: (f64::NAN, f64::NAN),
            verdict: None,
            itae: (0.0, 0.0),
            radius: scenario.law.pd().is_some().then(|| {
                if selection.wants_any(&[SPECTRAL_RADIUS]) { spectral_radius(scenario) } else { f64::NAN }
            }),
            outputs: body.outputs.iter().map(|output| range_of(&output.unit)).collect(),
            wants_course: selection.wants_any(OF_COURSE) || selection.wants_any(OF_GOAL),
        }
    }

    /// Returns the metrics of the run that has ended.
    pub fn finish(self) -> Vec<NamedMetric> {
        let mut metrics = Vec::new();
        let (acceleration, unit_inertia) = self.reduced;
        if self.planned {
            let arrival_value = |value: fn(&Arrival) -> f64| {
                MetricValue::Number(self.arrival.as_ref().map_or(f64::NAN, value))
            };
            let residuals = self.arrival.iter().flat_map(|arrival| &arrival.outputs);
            let residual = |(output, range): (&flexsc_record::Residual, &CoordinateRange)| NumberWithUnit {
                value: output.amplitude,
                unit: range.unit.clone(),
            };
            let energy = if unit_inertia { &RESIDUAL_ENERGY_UNIT_INERTIA } else { &RESIDUAL_ENERGY };
            metrics.extend([
                (&ARRIVAL_ANGLE, arrival_value(|arrival| arrival.angle_error_rad)),
                (&ARRIVAL_RATE, arrival_value(|arrival| arrival.rate_error_rad_s)),
                (&ANGLE_RESIDUAL, arrival_value(|arrival| arrival.angle_residual_rad)),
                (
                    &OUTPUT_RESIDUALS,
                    MetricValue::Quantities(residuals.zip(&self.outputs).map(residual).collect()),
                ),
                (energy, arrival_value(|arrival| arrival.elastic_energy_j)),
            ]);
        }
        let outputs = |value: fn(&CoordinateRange) -> f64| {
            let quantity =
                |range: &CoordinateRange| NumberWithUnit { value: value(range), unit: range.unit.clone() };
            MetricValue::Quantities(self.outputs.iter().map(quantity).collect())
        };
        let (peak, feedback) = if acceleration {
            (&PEAK_ACCELERATION, &PEAK_FEEDBACK_ACCELERATION)
        } else {
            (&PEAK_TORQUE, &PEAK_FEEDBACK)
        };
        let verdict = self.verdict.unwrap_or(GoalMetrics::new(self.end, f64::NAN));
        let itae = if self.verdict.is_some() { self.itae.0 } else { f64::NAN };
        metrics.extend([
            (peak, MetricValue::Number(self.torque.0)),
            (feedback, MetricValue::Number(self.torque.1)),
            (&PEAK_OUTPUTS, outputs(|output| output.peak)),
            (&ANGLE_ERROR_PEAK, MetricValue::Number(self.error.0)),
            (&SETTLING_TIME, MetricValue::Number(verdict.settling_time(self.end))),
            (&ITAE, MetricValue::Number(itae)),
            (&ANGLE_ERROR_LATE, MetricValue::Number(self.error.1)),
            (&OUTPUT_SWINGS, outputs(|output| output.after.swing())),
            (&OUTPUT_SWINGS_LATE, outputs(|output| output.late.swing())),
        ]);
        metrics.extend(verdict.finish(self.end));
        metrics.extend(self.radius.map(|radius| (&SPECTRAL_RADIUS, MetricValue::Number(radius))));
        metrics
    }

    fn observe(&mut self, piece: &MotionPiece) {
        self.torque.0 = piece.applied.magnitude(self.torque.0);
        self.torque.1 = self.torque.1.max(piece.feedback.abs());
        for (range, output) in self.outputs.iter_mut().zip(&piece.outputs) {
            range.peak = output.magnitude(range.peak);
        }
        // If the goal or the late part starts within the piece, only the rest of the piece counts.
        let part = |from: f64| (from - piece.from) / piece.length;
        let (goal, late) = (part(self.goal.from.seconds()), part(self.late));
        if goal < 1.0 {
            self.observe_after_end(piece, goal.max(0.0));
        }
        if goal < 1.0 && late < 1.0 {
            self.observe_late(piece, goal.max(late).max(0.0));
        }
    }

    /// Returns the distance from the goal (rad) over the last part of a piece, from the fraction `from` of it on.
    fn error(&self, piece: &MotionPiece, from: f64) -> Polynomial {
        let since = piece.from - self.goal.from.seconds();
        let (start, slope) = (self.goal.angle + self.goal.rate * since, self.goal.rate * piece.length);
        let error = piece.angle.minus_line(start, slope);
        if from > 0.0 { error.restrict(from, 1.0) } else { error }
    }

    /// Returns the collector of the verdict, which starts at a distance from the goal (rad).
    fn judge(&mut self, distance: f64) -> &mut GoalMetrics {
        let Self { goal, promise, .. } = self;
        self.verdict
            .get_or_insert_with(|| GoalMetrics::new(goal.from.seconds(), promise.band(distance.abs())))
    }

    fn observe_after_end(&mut self, piece: &MotionPiece, from: f64) {
        let error = self.error(piece, from);
        let (begins, length) = (piece.from + from * piece.length, (1.0 - from) * piece.length);
        let goal = self.goal.from.seconds();
        self.judge(error.at(0.0)).observe(begins, length, &error);
        // The larger one; NaN is ignored.
        self.error.0 = error.magnitude(self.error.0.max(0.0));
        let integral = integral(&error, begins - goal, length) - self.itae.1;
        let total = self.itae.0 + integral;
        self.itae = (total, (total - self.itae.0) - integral);
        for (range, output) in self.outputs.iter_mut().zip(&piece.outputs) {
            if from > 0.0 {
                range.after.widen(&output.restrict(from, 1.0));
            } else {
                range.after.widen(output);
            }
        }
    }

    fn observe_late(&mut self, piece: &MotionPiece, from: f64) {
        self.error.1 = self.error(piece, from).magnitude(self.error.1.max(0.0));
        for (range, output) in self.outputs.iter_mut().zip(&piece.outputs) {
            if from > 0.0 {
                range.late.widen(&output.restrict(from, 1.0));
            } else {
                range.late.widen(output);
            }
        }
    }
}

/// Returns the integral of time times the absolute value over a piece of `length` (s) that begins at `begins` (s).
fn integral(value: &Polynomial, begins: f64, length: f64) -> f64 {
    let (low, high) = value.bounds();
    let piece = |ends: &[f64]| {
        let [plain, weighted] = value.integrals(ends[0], ends[1]);
        (length * (begins * plain + length * weighted)).abs()
    };
    if !(low < 0.0 && high > 0.0) {
        return piece(&[0.0, 1.0]);
    }
    let mut times = vec![0.0];
    value.roots(0.0, &mut times);
    times.push(1.0);
    times.windows(2).map(piece).sum()
}

impl Record for ManoeuvreMetrics {
    fn piece_demand(&self) -> PieceDemand {
        if self.wants_course { PieceDemand::All } else { PieceDemand::None }
    }

    fn record(&mut self, _: Instant, sample: Sample<'_>) -> Result<(), RecordError> {
        if let Some(arrival) = sample.get::<Arrival>() {
            self.arrival = Some(arrival.clone());
        }
        Ok(())
    }

    fn piece(&mut self, _: Instant, piece: &MotionPiece) -> Result<(), RecordError> {
        self.observe(piece);
        Ok(())
    }
}

#[cfg(test)]
mod tests;
