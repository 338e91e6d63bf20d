//! The adaptive observers of a run: what they are fed with, what the law believes of them, and how that compares with the body.

use crate::belief::{AxesBelief, ElasticRate};
use crate::estimator::adaptive::{Channel, Estimate, Merged, Plan, Pulse};
use crate::law::Damped;
use crate::record::{ChannelState, TrackedMode, Tracking};

/// The observers of all axes.
#[derive(Clone, Debug)]
pub struct Observers {
    plan: Plan,
    channels: [Channel; 3],
    /// What they know of their modes after the last sample.
    modes: [Vec<Estimate>; 3],
}

impl Observers {
    /// The observers at the start of a run.
    pub fn new(plan: &Plan) -> Self {
        Self { plan: plan.clone(), channels: plan.channels(), modes: Default::default() }
    }

    /// Takes the measured rates (rad/s); returns the rigid ones.
    pub fn update(&mut self, measured: [f64; 3]) -> [f64; 3] {
        for (axis, channel) in self.channels.iter_mut().enumerate() {
            channel.update(measured[axis]);
            self.modes[axis] = channel.modes();
        }
        [0, 1, 2].map(|axis| self.channels[axis].rate())
    }

    /// Tells the elastic rates so long after the sample (s), under the pulses that wait to be executed.
    pub fn tell(&self, belief: &mut AxesBelief, ahead: f64, waiting: &[Pulse]) {
        for (axis, channel) in self.channels.iter().enumerate() {
            let rates = channel.predict(ahead, waiting).into_iter();
            let mode = |(rate, mode): (f64, &Estimate)| ElasticRate {
                rate,
                frequency: mode.frequency,
                influence: channel.influence(mode),
            };
            belief.elastic[axis].clear();
            belief.elastic[axis].extend(rates.zip(&self.modes[axis]).map(mode));
            belief.trusted[axis] = channel.is_trusted();
        }
    }

    /// What they estimate, beside what is: the rates of the body's modes (m sqrt(kg)/s).
    pub fn tracking(&self, rates: &[f64], damped: &[Damped; 3]) -> Tracking {
        let mut tracking = Tracking { channels: Vec::with_capacity(3), trackers: Vec::new() };
        for (axis, (channel, design)) in self.channels.iter().zip(&self.plan.axes).enumerate() {
            let seen = |mode: &usize| design.seen[*mode] * rates[*mode];
            let (residual, modes) = (channel.residual(), &self.modes[axis]);
            let damped = &damped[axis];
            tracking.channels.push(ChannelState {
                elastic_rad_s: modes.iter().map(|mode| mode.phase[0]).sum(),
                true_elastic_rad_s: (0..rates.len()).map(|mode| seen(&mode)).sum(),
                innovation_rms_rad_s: libm::sqrt(residual.innovation),
                elastic_rms_rad_s: libm::sqrt(residual.elastic),
                trusted: channel.is_trusted().into(),
                acted_on_rad_s: damped.rate,
                threshold_rad_s: damped.threshold,
                latched: damped.latched.into(),
                resting: damped.resting.into(),
                damping_on_s: damped.on,
            });
            let own = design.own(axis);
            let state = |(mode, truth): (&Estimate, &Merged)| TrackedMode {
                axis: axis as u64,
                frequency_rad_s: mode.frequency,
                true_frequency_rad_s: truth.tracker.frequency.get(),
                influence: channel.influence(mode),
                true_influence: truth.tracker.influence.get(own).map_or(f64::NAN, |of| of.get()),
                rate_rad_s: mode.phase[0],
                true_rate_rad_s: truth.modes.iter().map(seen).sum(),
                amplitude_rad_s: mode.amplitude(),
            };
            tracking.trackers.extend(modes.iter().zip(&design.modes).map(state));
        }
        tracking
    }

    /// Carries the estimates over the cycle that begins, in which these pulses are executed.
    pub fn advance(&mut self, executed: &[Pulse]) {
        for channel in &mut self.channels {
            channel.advance(executed);
        }
    }
}
