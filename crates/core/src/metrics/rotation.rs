//! What a rotation comes to: where the manoeuvre ends, what vibration it leaves, how large torques and deflections are.

use super::{
    ANGLE_ERROR_LATE, ANGLE_ERROR_PEAK, ANGLE_RESIDUAL, ARRIVAL_ANGLE, ARRIVAL_RATE, ITAE, OUTPUT_RESIDUALS,
    OUTPUT_SWINGS, OUTPUT_SWINGS_LATE, PEAK_FEEDBACK, PEAK_OUTPUTS, PEAK_TORQUE, RESIDUAL_ENERGY,
    SETTLING_TIME, SPECTRAL_RADIUS, Told, Value,
};
use crate::analysis::sampled_loop::{Held, Loop};
use crate::law::{Goal, Law};
use crate::quantity::Positive;
use crate::record::{Arrival, Motion, Record, RecordError, Sample};
use crate::scenario::Scenario;
use crate::time::Instant;

/// What is late in a run (s).
const LATE: f64 = 5.0;
/// Frequencies of a drift at which its loop is judged, besides its kinks and its end.
const DRIFTING: u32 = 8;
/// What counts as settled, as a part of the distance when the goal begins.
const PART: f64 = 0.05;

/// Gathers the motion of a rotation.
#[derive(Clone, Debug)]
pub struct Rotation {
    goal: Goal,
    planned: bool,
    /// From when on a motion is late (s).
    late: f64,
    arrival: Option<Arrival>,
    /// Largest torques: the actuator's, the law's (N m).
    torque: (f64, f64),
    /// Largest distances from the goal: after the manoeuvre, and late (rad).
    error: (f64, f64),
    settling: Settling,
    /// Of a sampled loop, its spectral radius.
    radius: Option<f64>,
    /// Of each output, the largest absolute value, and the ranges after the manoeuvre and late.
    outputs: Vec<(f64, Range, Range)>,
}

/// How the distance from the goal dies away.
#[derive(Copy, Clone, Debug)]
struct Settling {
    /// What counts as settled (rad); NaN until the goal begins, if it is a part of the distance then.
    band: f64,
    /// The last time outside it (s), and the last time of all.
    outside: f64,
    last: f64,
    itae: f64,
    /// The last time and integrand of it.
    before: Option<(f64, f64)>,
}

impl Settling {
    fn new(band: f64) -> Self {
        Self { band, outside: 0.0, last: 0.0, itae: 0.0, before: None }
    }

    /// Takes a distance (rad), so long after the goal begins (s).
    fn see(&mut self, now: f64, since: f64, distance: f64) {
        if self.band.is_nan() {
            self.band = PART * distance;
        }
        if distance > self.band {
            self.outside = now;
        }
        self.last = now;
        let integrand = since * distance;
        if let Some((then, before)) = self.before {
            self.itae += 0.5 * (integrand + before) * (now - then);
        }
        self.before = Some((now, integrand));
    }

    fn time(&self) -> f64 {
        if self.outside < self.last { self.outside } else { f64::NAN }
    }
}

/// The smallest and the largest of some values.
#[derive(Copy, Clone, Debug)]
struct Range(f64, f64);

impl Range {
    const EMPTY: Self = Self(f64::INFINITY, f64::NEG_INFINITY);

    fn widen(&mut self, value: f64) {
        *self = Self(self.0.min(value), self.1.max(value));
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
        Self {
            goal: scenario.goal(),
            planned: scenario.plan.is_some(),
            late: scenario.duration.seconds() - LATE,
            arrival: None,
            torque: (0.0, 0.0),
            error: (f64::NAN, f64::NAN),
            settling: Settling::new(scenario.reference.band.map_or(f64::NAN, Positive::get)),
            radius: matches!(scenario.law, Law::Pd(_)).then(|| spectral_radius(scenario)),
            outputs: vec![(0.0, Range::EMPTY, Range::EMPTY); scenario.model.outputs.len()],
        }
    }

    /// The metrics of the run that has ended.
    pub fn finish(self) -> Vec<Told> {
        let mut metrics = Vec::new();
        if self.planned {
            let of =
                |value: fn(&Arrival) -> f64| Value::Number(self.arrival.as_ref().map_or(f64::NAN, value));
            let residuals = self.arrival.iter().flat_map(|arrival| &arrival.outputs);
            metrics.extend([
                (&ARRIVAL_ANGLE, of(|arrival| arrival.angle_error_rad)),
                (&ARRIVAL_RATE, of(|arrival| arrival.rate_error_rad_s)),
                (&ANGLE_RESIDUAL, of(|arrival| arrival.angle_residual_rad)),
                (&OUTPUT_RESIDUALS, Value::Numbers(residuals.map(|output| output.amplitude).collect())),
                (&RESIDUAL_ENERGY, of(|arrival| arrival.elastic_energy_j)),
            ]);
        }
        let outputs =
            |value: fn(&(f64, Range, Range)) -> f64| Value::Numbers(self.outputs.iter().map(value).collect());
        metrics.extend([
            (&PEAK_TORQUE, Value::Number(self.torque.0)),
            (&PEAK_FEEDBACK, Value::Number(self.torque.1)),
            (&PEAK_OUTPUTS, outputs(|output| output.0)),
            (&ANGLE_ERROR_PEAK, Value::Number(self.error.0)),
            (&SETTLING_TIME, Value::Number(self.settling.time())),
            (&ITAE, Value::Number(self.settling.itae)),
            (&ANGLE_ERROR_LATE, Value::Number(self.error.1)),
            (&OUTPUT_SWINGS, outputs(|output| output.1.swing())),
            (&OUTPUT_SWINGS_LATE, outputs(|output| output.2.swing())),
        ]);
        metrics.extend(self.radius.map(|radius| (&SPECTRAL_RADIUS, Value::Number(radius))));
        metrics
    }

    fn see(&mut self, now: Instant, motion: &Motion) {
        let (after, late) = (now >= self.goal.from, now.seconds() >= self.late);
        if let Some((_, torque)) = &motion.drive {
            self.torque.0 = self.torque.0.max(torque.applied_nm.abs());
            self.torque.1 = self.torque.1.max(torque.feedback_nm.abs());
        }
        if after {
            let error = (motion.attitude.angle_rad - self.goal.at(now).0).abs();
            let since = now.since(self.goal.from).seconds();
            self.settling.see(now.seconds(), since, error);
            // The larger one, whichever is a number.
            self.error.0 = self.error.0.max(error);
            if late {
                self.error.1 = self.error.1.max(error);
            }
        }
        let seen = motion.outputs.iter().flat_map(|outputs| &outputs.outputs);
        for ((peak, range, late_range), output) in self.outputs.iter_mut().zip(seen) {
            *peak = peak.max(output.value.abs());
            if after {
                range.widen(output.value);
            }
            if after && late {
                late_range.widen(output.value);
            }
        }
    }
}

impl Record for Rotation {
    fn dense(&self) -> bool {
        true
    }

    fn record(&mut self, now: Instant, sample: Sample<'_>) -> Result<(), RecordError> {
        match sample {
            Sample::Arrival(arrival) => self.arrival = Some(arrival.clone()),
            Sample::Motion(motion) => self.see(now, motion),
            _ => {}
        }
        Ok(())
    }
}
