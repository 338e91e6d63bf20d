//! Run-time state of the adaptive observers: inputs, state estimate, and log row with the true values.

use std::mem;

use flexsc_numerics::time::Instant;
use flexsc_record::{ChannelState, Report, TrackedMode, Tracking};

use super::{AxisObserver, MergedTracker, ModeEstimate, ObserverDesign};
use crate::actuator::PulsedActuator;
use crate::estimator::{self, AppliedPulses, SampleContext};
use crate::part::{Occasion, Part, ReportContext};
use crate::state_estimate::DampingStatus;
use crate::state_estimate::{DominantMode, ElasticRateEstimate, StateEstimate};

/// Adaptive observers of all axes.
#[derive(Clone, Debug)]
pub struct ObserverSet {
    plan: ObserverDesign,
    channels: Vec<AxisObserver>,
    /// Mode estimates of each axis after the last sample.
    modes: Vec<Vec<ModeEstimate>>,
    applied_pulses: AppliedPulses,
    /// True after the first sample.
    sampled: bool,
}

impl ObserverSet {
    /// Creates the observers at the start of a run.
    pub fn new(plan: &ObserverDesign) -> Self {
        let channels = plan.channels();
        let modes = vec![Vec::new(); channels.len()];
        Self { plan: plan.clone(), channels, modes, applied_pulses: AppliedPulses::default(), sampled: false }
    }
}

impl ObserverSet {
    /// Writes the log row over an earlier one, with the true rates of the modes and the status of active damping about each
    /// axis.
    fn write_row(&self, rates: &[f64], damped: &[DampingStatus], tracking: &mut Tracking) {
        tracking.channels.clear();
        tracking.trackers.clear();
        for (axis, (channel, design)) in self.channels.iter().zip(&self.plan.axes).enumerate() {
            let measured_rate = |mode: &usize| design.visibilities[*mode] * rates[*mode];
            let (residual, modes) = (channel.residual(), &self.modes[axis]);
            let damped = &damped[axis];
            tracking.channels.push(ChannelState {
                elastic_rad_s: modes.iter().map(|mode| mode.phase[0]).sum(),
                true_elastic_rad_s: (0..rates.len()).map(|mode| measured_rate(&mode)).sum(),
                innovation_rms_rad_s: f64::sqrt(residual.innovation),
                elastic_rms_rad_s: f64::sqrt(residual.elastic),
                trusted: channel.is_trusted().into(),
                acted_on_rad_s: damped.rate,
                threshold_rad_s: damped.threshold,
                latched: damped.latched.into(),
                resting: damped.resting.into(),
                damping_on_s: damped.on,
            });
            let own = design.own_axis_input(axis);
            let state = |(mode, truth): (&ModeEstimate, &MergedTracker)| TrackedMode {
                axis: axis as u64,
                frequency_rad_s: mode.frequency,
                true_frequency_rad_s: truth.tracker.frequency.get(),
                influence: channel.influence(mode),
                true_influence: truth
                    .tracker
                    .influence
                    .get(own)
                    .map_or(f64::NAN, |influence| influence.get()),
                rate_rad_s: mode.phase[0],
                true_rate_rad_s: truth.modes.iter().map(measured_rate).sum(),
                amplitude_rad_s: mode.amplitude(),
            };
            tracking.trackers.extend(modes.iter().zip(&design.modes).map(state));
        }
    }
}

impl Part for ObserverSet {
    fn report(&self, at: &ReportContext<'_>, report: &mut Report) {
        if at.occasion == Occasion::Cycle {
            let rates = at.truth.mode_rates();
            let take = |row: &mut Tracking| (mem::take(&mut row.channels), mem::take(&mut row.trackers));
            let (channels, trackers) = report.reuse(take);
            let mut row = Tracking { channels, trackers };
            self.write_row(&rates, at.damping, &mut row);
            report.add(row);
        }
    }
}

impl estimator::Estimator for ObserverSet {
    fn input_changed(&mut self, now: Instant, moments: [f64; 3]) {
        self.applied_pulses.input_changed(now, moments);
    }

    fn update(&mut self, taken: &SampleContext<'_>, state_estimates: &mut [StateEstimate]) {
        let executed = self.applied_pulses.take_executed(taken.now, taken.pulses);
        if std::mem::replace(&mut self.sampled, true) {
            self.channels.iter_mut().for_each(|channel| channel.advance(&executed));
        }
        let waiting = taken.pulses.map_or_else(Vec::new, PulsedActuator::pending_pulses);
        for (axis, (channel, state_estimate)) in self.channels.iter_mut().zip(state_estimates).enumerate() {
            if let Some(measured) = taken.measured {
                let [angle, rate] = measured[axis];
                channel.update(rate);
                state_estimate.angle = angle;
            }
            channel.write_modes(&mut self.modes[axis]);
            state_estimate.rate = channel.rate();
            let rates = channel.predict(taken.ahead, &waiting).into_iter();
            let mode = |(rate, mode): (f64, &ModeEstimate)| ElasticRateEstimate {
                rate,
                frequency: mode.frequency,
                influence: channel.influence(mode),
            };
            state_estimate.elastic.clear();
            state_estimate.elastic.extend(rates.zip(&self.modes[axis]).map(mode));
            state_estimate.elastic_is_trusted = channel.is_trusted();
            state_estimate.dominant = dominant(&self.modes[axis]);
        }
    }

    fn copy(&self) -> Box<dyn estimator::Estimator> {
        Box::new(self.clone())
    }
}

/// Returns the mode with the largest amplitude; its displacement follows from the quadrature.
fn dominant(modes: &[ModeEstimate]) -> DominantMode {
    let amplitudes = modes.iter().map(|mode| (mode.amplitude(), mode));
    let largest = amplitudes.max_by(|(a, _), (b, _)| a.total_cmp(b));
    largest.map_or_else(DominantMode::default, |(_, mode)| DominantMode {
        displacement: mode.displacement(),
        rate: mode.phase[0],
        frequency: mode.frequency,
    })
}
