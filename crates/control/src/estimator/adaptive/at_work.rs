//! Run-time state of the adaptive observers: inputs, state estimate, and log row with the true values.

use super::{Channel, Merged, ModeEstimate, ObserverDesign};
use crate::belief::Damped;
use crate::belief::{Belief, Dominant, ElasticRate};
use crate::estimator::{self, GivenRecord, Taken};
use crate::record::{ChannelState, TrackedMode, Tracking};
use crate::time::Instant;

/// Adaptive observers of all axes.
#[derive(Clone, Debug)]
pub struct Observers {
    plan: ObserverDesign,
    channels: Vec<Channel>,
    /// Mode estimates of each axis after the last sample.
    modes: Vec<Vec<ModeEstimate>>,
    given: GivenRecord,
    /// True after the first sample.
    sampled: bool,
}

impl Observers {
    /// Creates the observers at the start of a run.
    pub fn new(plan: &ObserverDesign) -> Self {
        let channels = plan.channels();
        let modes = vec![Vec::new(); channels.len()];
        Self { plan: plan.clone(), channels, modes, given: GivenRecord::default(), sampled: false }
    }
}

impl estimator::Estimate for Observers {
    fn given(&mut self, now: Instant, moments: [f64; 3]) {
        self.given.change(now, moments);
    }

    fn take(&mut self, taken: &Taken<'_>, beliefs: &mut [Belief]) {
        let executed = self.given.take(taken.now, taken.actuator);
        if std::mem::replace(&mut self.sampled, true) {
            self.channels.iter_mut().for_each(|channel| channel.advance(&executed));
        }
        let waiting = taken.actuator.waiting();
        for (axis, (channel, belief)) in self.channels.iter_mut().zip(beliefs).enumerate() {
            if let Some(measured) = taken.measured {
                let [angle, rate] = measured[axis];
                channel.update(rate);
                belief.angle = angle;
            }
            channel.put_modes(&mut self.modes[axis]);
            belief.rate = channel.rate();
            let rates = channel.predict(taken.ahead, &waiting).into_iter();
            let mode = |(rate, mode): (f64, &ModeEstimate)| ElasticRate {
                rate,
                frequency: mode.frequency,
                influence: channel.influence(mode),
            };
            belief.elastic.clear();
            belief.elastic.extend(rates.zip(&self.modes[axis]).map(mode));
            belief.trusted = channel.is_trusted();
            belief.dominant = dominant(&self.modes[axis]);
        }
    }

    fn tracking(&self, rates: &dyn Fn() -> Vec<f64>, damped: &dyn Fn() -> Vec<Damped>) -> Option<Tracking> {
        let (rates, damped) = (rates(), damped());
        let mut tracking = Tracking { channels: Vec::with_capacity(3), trackers: Vec::new() };
        for (axis, (channel, design)) in self.channels.iter().zip(&self.plan.axes).enumerate() {
            let seen = |mode: &usize| design.seen[*mode] * rates[*mode];
            let (residual, modes) = (channel.residual(), &self.modes[axis]);
            let damped = &damped[axis];
            tracking.channels.push(ChannelState {
                elastic_rad_s: modes.iter().map(|mode| mode.phase[0]).sum(),
                true_elastic_rad_s: (0..rates.len()).map(|mode| seen(&mode)).sum(),
                innovation_rms_rad_s: f64::sqrt(residual.innovation),
                elastic_rms_rad_s: f64::sqrt(residual.elastic),
                trusted: channel.is_trusted().into(),
                acted_on_rad_s: damped.rate,
                threshold_rad_s: damped.threshold,
                latched: damped.latched.into(),
                resting: damped.resting.into(),
                damping_on_s: damped.on,
            });
            let own = design.own(axis);
            let state = |(mode, truth): (&ModeEstimate, &Merged)| TrackedMode {
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
        Some(tracking)
    }

    fn copy(&self) -> Box<dyn estimator::Estimate> {
        Box::new(self.clone())
    }
}

/// Returns the mode with the largest amplitude; its displacement follows from the quadrature.
fn dominant(modes: &[ModeEstimate]) -> Dominant {
    let largest = modes.iter().max_by(|a, b| a.amplitude().total_cmp(&b.amplitude()));
    largest.map_or_else(Dominant::default, |mode| Dominant {
        displacement: mode.displacement(),
        rate: mode.phase[0],
        frequency: mode.frequency,
    })
}
