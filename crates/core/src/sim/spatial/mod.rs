//! A run of a spatial body: one cycle of gyro, estimator, law and jets after the other.
//!
//! At the start of a cycle, in this order: the body arrives, the gyro measures, the estimator learns what the pulses of the
//! last cycle did and takes the measurement, the law decides, the jets execute what was commanded now or a cycle ago, the
//! record is told. Pulses end at exact instants within the cycle.

mod jets;
mod news;
mod plant;
mod tracking;

use super::SimulationError;
use crate::belief::AxesBelief;
use crate::body::spatial::{SpatialState, Vector, beyond};
use crate::estimator::RateFilter;
use crate::law::PhasePlaneLaw;
use crate::random::Seed;
use crate::record::{AxisRate, Cycle, Jets, Rates, Record, Sample, SpatialMotion};
use crate::scenario::{AxesEstimator, Scenario, SpatialLoop};
use crate::scene::SpatialScene;
use crate::sensor::Readout;
use crate::time::{Instant, Span};

use jets::JetsAtWork;
use news::News;
use plant::Plant;
use tracking::Observers;

/// What estimates.
#[derive(Clone, Debug)]
enum Estimation {
    /// Nothing: the law reads the gyro.
    None,
    /// A filter of the rigid rates.
    Rigid(RateFilter),
    /// Adaptive observers.
    Adaptive(Box<Observers>),
}

impl Estimation {
    fn new(spatial: &SpatialLoop) -> Self {
        match &spatial.estimator {
            None => Self::None,
            Some(AxesEstimator::RigidRate(estimator)) => Self::Rigid(estimator.filter()),
            Some(AxesEstimator::Adaptive(plan)) => Self::Adaptive(Box::new(Observers::new(plan))),
        }
    }
}

/// All that moves in a run of a spatial body.
#[derive(Clone, Debug)]
pub struct SpatialRun {
    end: Instant,
    body: Plant,
    gyro: Readout,
    estimator: Estimation,
    law: PhasePlaneLaw,
    jets: JetsAtWork,
    belief: AxesBelief,
    /// What the gyro gave at the last cycle (rad/s).
    measured: [f64; 3],
    period: Span,
    next_cycle: Instant,
    log_period: Span,
    next_dense: Option<Instant>,
    /// The scene, and when its frames are due.
    scene: Option<Box<SpatialScene>>,
    next_frames: Option<Instant>,
    news: News,
    begun: bool,
}

impl SpatialRun {
    /// A run of a scenario with this loop, before its start.
    pub fn new(scenario: &Scenario, spatial: &SpatialLoop, run: u64) -> Self {
        let jets = JetsAtWork::new(spatial);
        Self {
            end: Instant::START + scenario.duration,
            body: Plant::new(spatial),
            gyro: spatial.gyro.readout(Seed { scenario: scenario.seed, run }),
            estimator: Estimation::new(spatial),
            law: PhasePlaneLaw::new(&spatial.law, &spatial.jets, jets.accelerations(), spatial.thresholds),
            jets,
            belief: AxesBelief::default(),
            measured: [0.0; 3],
            period: spatial.law.period,
            next_cycle: Instant::START,
            log_period: scenario.log_period(),
            next_dense: None,
            scene: None,
            next_frames: None,
            news: News::new(scenario, spatial, run),
            begun: false,
        }
    }

    /// Draws this scene for records that want one.
    pub fn draw(&mut self, scene: SpatialScene) {
        self.scene = Some(Box::new(scene));
    }

    /// Runs to an instant, or to the end of the scenario if that is earlier, everything that is due then included.
    pub fn run_until(&mut self, until: Instant, record: &mut impl Record) -> Result<(), SimulationError> {
        let until = until.min(self.end);
        if !self.begun {
            self.begun = true;
            self.news.begin(Instant::START, record)?;
            self.next_dense = record.dense().then_some(Instant::START);
            match &self.scene {
                Some(scene) if record.scene() => {
                    let parts = scene.parts(self.news.stamp(Instant::START));
                    record.record(Instant::START, Sample::Scene(&parts))?;
                    self.next_frames = Some(Instant::START);
                }
                _ => self.scene = None,
            }
        }
        loop {
            let due = [self.jets.due(), self.next_dense, self.next_frames];
            let next = due.into_iter().flatten().fold(self.next_cycle, Instant::min);
            if next > until {
                self.body.view(until, record)?;
                return if until == self.end { Ok(self.news.end(until, record)?) } else { Ok(()) };
            }
            self.body.view(next, record)?;
            let ended = self.jets.end(next);
            if next == self.next_cycle {
                self.cycle(next, record)?;
                self.body.depart(self.jets.push());
            } else if ended {
                self.body.depart(self.jets.push());
            }
            if self.next_dense == Some(next) {
                record.record(next, Sample::SpatialMotion(&self.motion(next)))?;
                self.next_dense = Some(next + self.log_period);
            }
            self.show(next, record)?;
        }
    }

    /// Tells the frames of the scene when they are due, and its plumes when they are new.
    fn show(&mut self, now: Instant, record: &mut impl Record) -> Result<(), SimulationError> {
        let Some(scene) = &mut self.scene else { return Ok(()) };
        let stamp = self.news.stamp(now);
        if self.next_frames == Some(now) {
            let SpatialState { turn, modes } = self.body.state();
            record.record(now, Sample::Frames(scene.frames(stamp, &turn.attitude, modes)))?;
            self.next_frames = Some(now + scene.period);
        }
        match scene.plumes(stamp, self.jets.burning()) {
            Some(plumes) => Ok(record.record(now, Sample::Plumes(&plumes))?),
            None => Ok(()),
        }
    }

    /// The state of the body at the instant reached.
    pub fn state(&self) -> &SpatialState {
        self.body.state()
    }

    fn cycle(&mut self, now: Instant, record: &mut impl Record) -> Result<(), SimulationError> {
        if !self.body.state().is_finite() {
            return Err(SimulationError::NonFinite { at: now });
        }
        let (rigid, elastic) = self.body.rates();
        self.measured = self.gyro.measure((rigid + elastic).into());
        let rate = match &mut self.estimator {
            Estimation::None => self.measured,
            Estimation::Rigid(filter) => filter.step(self.measured, self.jets.pushed()),
            Estimation::Adaptive(observers) => observers.update(self.measured),
        };
        self.belief.angle = self.error(now);
        self.belief.rate = rate;
        self.belief.queued = self.jets.queued();
        if let Estimation::Adaptive(observers) = &self.estimator {
            observers.tell(&mut self.belief, self.law.ahead(), &self.jets.pulses_waiting());
        }
        let [roll_on_s, pitch_on_s, yaw_on_s] = self.jets.begin(now, self.law.decide(&self.belief));
        let pulses = [roll_on_s, pitch_on_s, yaw_on_s].into_iter().filter(|on| *on != 0.0).count();
        let cycle = Cycle {
            jets: Jets { roll_on_s, pitch_on_s, yaw_on_s, fuel_kg: self.jets.fuel() },
            pulses: pulses as u64,
            elastic_energy_j: self.body.elastic_energy(),
            visible_energy_j: self.body.visible_energy(),
            rigid_rate_rad_s: rigid.into(),
            elastic_rate_rad_s: elastic.into(),
            error_rad: self.belief.angle,
        };
        record.record(now, Sample::Cycle(&cycle))?;
        self.news.target(now, self.law.target(now), self.belief.angle, record)?;
        if let Estimation::Adaptive(observers) = &mut self.estimator {
            let tracking = observers.tracking(&self.body.modal_rates(), self.law.damped());
            record.record(now, Sample::Tracking(&tracking))?;
            self.news.damping(now, self.law.damped(), self.belief.trusted, record)?;
            observers.advance(&self.jets.pulses());
        }
        self.next_cycle = now + self.period;
        Ok(())
    }

    /// By which angles the attitude is beyond its target (rad).
    fn error(&self, now: Instant) -> [f64; 3] {
        beyond(&self.law.target(now), &self.body.state().turn.attitude).into()
    }

    /// The motion now, for a dense record.
    fn motion(&self, now: Instant) -> SpatialMotion {
        let (rigid, elastic): (Vector, Vector) = self.body.rates();
        let axis = |axis: usize| AxisRate {
            rate_rad_s: rigid[axis] + elastic[axis],
            rigid_rad_s: rigid[axis],
            elastic_rad_s: elastic[axis],
            measured_rad_s: self.measured[axis],
            believed_rad_s: self.belief.rate[axis],
        };
        SpatialMotion {
            pointing: self.body.pointing(self.error(now)),
            rates: Rates { axes: [0, 1, 2].map(axis).into() },
            vibrations: self.body.vibrations(),
            energy: self.body.energy(),
        }
    }
}
