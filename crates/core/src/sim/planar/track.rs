//! The estimator that acts at each sample: what the actuator gave and the sensor measured become a belief of the modes.

use crate::actuator::{Actuator, Opposes};
use crate::belief::{Belief, Dominant};
use crate::body::{Drift, State};
use crate::estimator::Estimator;
use crate::estimator::kalman::{Filter, Prediction, Setting, Told};
use crate::random::Seed;
use crate::record::foxglove::Level;
use crate::record::{self, ModeEstimate, Record, RecordError, Sample};
use crate::scenario::Scenario;
use crate::sim::journal::Journal;
use crate::time::Instant;

/// The estimator at work.
#[derive(Clone, Debug)]
pub struct Track {
    eye: Eye,
    /// Natural frequencies at the start (rad/s), and how they drift.
    frequencies: Vec<f64>,
    excitability: Vec<f64>,
    drift: Option<Drift>,
    /// The reduced moment since an instant, and its integral from the last sample until then (rad/s², rad/s).
    moment: f64,
    since: Instant,
    impulse: f64,
    /// The last sample.
    sampled: Option<Instant>,
    /// Whether the filter had lost the body then.
    lost: bool,
    journal: Journal,
}

/// Who looks.
#[derive(Clone, Debug)]
enum Eye {
    /// An ideal observer.
    Ideal,
    /// A filter.
    Filter(Box<Filter>),
}

impl Track {
    /// The estimator that a scenario asks for, if it acts at samples.
    pub fn new(scenario: &Scenario, seed: Seed) -> Option<Self> {
        let model = &scenario.model;
        let back_emf = match &scenario.actuator {
            Actuator::Wheel(wheel) => {
                (wheel.back_emf.get() / model.inertia.get(), wheel.opposes == Opposes::BodyRate)
            }
            _ => (0.0, false),
        };
        let setting = Setting {
            body: model,
            back_emf,
            period: scenario.sensor.period()?.seconds(),
            angle_noise: scenario.sensor.angle_noise(),
            rate_noise: scenario.sensor.rate_noise(),
        };
        let draws = &mut seed.stream("prior");
        let filter = |filter| Eye::Filter(Box::new(filter));
        let eye = match scenario.estimator.as_ref()? {
            Estimator::Envelope(_) | Estimator::RigidRate(_) | Estimator::Adaptive(_) => return None,
            Estimator::Truth(_) => Eye::Ideal,
            Estimator::Kalman(spec) => filter(spec.filter(&setting, draws)),
            Estimator::ExtendedKalman(spec) => filter(spec.filter(&setting, Prediction::Extended, draws)),
            Estimator::UnscentedKalman(spec) => filter(spec.filter(&setting, Prediction::Unscented, draws)),
        };
        Some(Self {
            eye,
            frequencies: model.modes.iter().map(|mode| mode.frequency.get()).collect(),
            excitability: model.modes.iter().map(|mode| mode.excitability().abs()).collect(),
            drift: scenario.drift.clone(),
            moment: 0.0,
            since: Instant::START,
            impulse: 0.0,
            sampled: None,
            lost: false,
            journal: Journal::new(scenario),
        })
    }

    /// Takes over the reduced moment (rad/s²) that the actuator gives from now on.
    pub fn command(&mut self, now: Instant, moment: f64) {
        self.impulse += self.moment * now.since(self.since).seconds();
        (self.moment, self.since) = (moment, now);
    }

    /// Takes a sample of the body in its true state, of which the sensor measured something or not: the belief follows.
    pub fn sample(
        &mut self,
        now: Instant,
        state: &State,
        belief: &mut Belief,
        measured: bool,
        record: &mut impl Record,
    ) -> Result<(), RecordError> {
        self.command(now, self.moment);
        let period = self.sampled.replace(now).map(|sampled| now.since(sampled).seconds());
        let impulse = std::mem::take(&mut self.impulse);
        let t = now.seconds();
        let told = match &mut self.eye {
            Eye::Ideal => {
                belief.dominant = self.ideal(t, state);
                return Ok(());
            }
            Eye::Filter(filter) => {
                if let Some(period) = period {
                    filter.predict(impulse / period);
                }
                let seen = measured.then_some((belief.angle, belief.rate));
                let told = filter.update(seen);
                belief.dominant = filter.dominant();
                told
            }
        };
        self.tell_lock(now, record)?;
        match self.row(t, state, told) {
            Some(row) if record.dense() => record.record(now, Sample::Estimate(&row)),
            _ => Ok(()),
        }
    }

    /// Tells when the filter loses the body, and when it follows again.
    fn tell_lock(&mut self, now: Instant, record: &mut impl Record) -> Result<(), RecordError> {
        let Eye::Filter(filter) = &self.eye else { return Ok(()) };
        let lost = filter.is_lost();
        if std::mem::replace(&mut self.lost, lost) == lost {
            return Ok(());
        }
        let (level, line) = if lost {
            (Level::Warning, "the filter has lost the body")
        } else {
            (Level::Info, "the filter follows the body again")
        };
        self.journal.tell(now, (level, "estimator"), line.to_owned(), record)
    }

    /// What an ideal observer knows.
    fn ideal(&self, t: f64, state: &State) -> Dominant {
        let ratio = |mode: usize| self.drift.as_ref().map_or(1.0, |drift| drift.ratio(mode, t));
        let value = |mode: usize| self.excitability[mode] / (ratio(mode) * ratio(mode));
        let modes = 1..self.frequencies.len();
        let mode = modes.fold(0, |best, mode| if value(mode) > value(best) { mode } else { best });
        Dominant {
            displacement: state.modes[mode].displacement,
            rate: self.frequencies[mode] * state.modes[mode].quadrature,
            frequency: self.frequencies[mode] * ratio(mode),
        }
    }

    /// What is logged of a filter.
    fn row(&self, t: f64, state: &State, told: Told) -> Option<record::Estimate> {
        let Eye::Filter(filter) = &self.eye else { return None };
        let (model, mode, mean) = (filter.model(), filter.mode(), filter.mean());
        let ratio = |mode: usize| self.drift.as_ref().map_or(1.0, |drift| drift.ratio(mode, t));
        let slope = |mode: usize| self.drift.as_ref().map_or(0.0, |drift| drift.slope(mode, t));
        let mut truth = state.to_vector(&self.frequencies).as_slice().to_vec();
        for at in (model.motion()..model.order()).step_by(2) {
            // A ratio of all modes is judged by the dominant one.
            let mut owners = (0..model.modes()).filter(|owner| model.ratio_of(*owner) == Some(at));
            let of = if model.ratio_of(mode) == Some(at) { mode } else { owners.next().unwrap_or(mode) };
            // Relative to the frequency that the filter knows.
            let own = self.frequencies[of] * mean[at] / model.frequency(of, mean.as_slice());
            truth.extend([own * ratio(of), own * slope(of)]);
        }
        let known = model.ratio_of(mode);
        let value = |offset: usize| known.map_or(1.0 - offset as f64, |at| mean[at + offset]);
        let sd = |offset: usize| {
            known.map_or(0.0, |at| libm::sqrt(filter.covariance()[(at + offset, at + offset)]))
        };
        let modes = (0..model.modes()).map(|index| {
            let (amplitude_rad, amplitude_sd_rad) = filter.amplitude(index);
            ModeEstimate {
                displacement_rad: mean[2 + 2 * index],
                rate_rad_s: mean[3 + 2 * index],
                frequency_rad_s: filter.frequency(index).0,
                amplitude_rad,
                amplitude_sd_rad,
            }
        });
        Some(record::Estimate {
            dominant: mode as u64,
            frequency_rad_s: filter.dominant().frequency,
            frequency_sd_rad_s: filter.frequency(mode).1,
            true_frequency_rad_s: self.frequencies[mode] * ratio(mode),
            displacement_rad: filter.dominant().displacement,
            ratio: value(0),
            ratio_sd: sd(0),
            ratio_rate_1_s: value(1),
            ratio_rate_sd_1_s: sd(1),
            modes: modes.collect(),
            innovation_rad: told.innovation,
            nis: told.nis.unwrap_or(0.0),
            measured: told.nis.is_some().into(),
            nees: filter.nees(&truth),
            gated: filter.is_gated().into(),
            lock: (!filter.is_lost()).into(),
        })
    }
}
