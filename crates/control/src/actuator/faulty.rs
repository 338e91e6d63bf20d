//! Failures of a single-axis actuator.

use std::sync::Arc;

use flexsc_dynamics::waveform::Waveform;
use flexsc_numerics::quantity::Time;
use flexsc_numerics::time::Instant;
use flexsc_record::WheelMotion;
use flexsc_spacecraft::flow::ActiveWaveform;
use flexsc_spacecraft::sine::Sine;

use super::AxisActuator;
use super::failure::{ActiveFailures, Failure, FailureScope};
use crate::interval::Interval;

/// Single-axis actuator with failures, which change its torque; estimators and laws are not informed of them.
#[derive(Clone, Debug)]
pub(super) struct FaultyActuator {
    inner: Box<dyn AxisActuator>,
    failing: ActiveFailures,
    /// Waveform of all sines that failures add.
    added: Arc<Waveform>,
}

impl FaultyActuator {
    /// Wraps an actuator with the failures that concern it; returns it unchanged if there are none.
    pub fn with_failures(
        failures: &[Failure],
        concerns: impl Fn(&FailureScope<'_>) -> bool,
        inner: Box<dyn AxisActuator>,
    ) -> Box<dyn AxisActuator> {
        let Some(failing) = ActiveFailures::new(failures, concerns) else { return inner };
        let until = |outage: Interval| outage.to.map_or(f64::MAX, Time::get);
        let terms = failing
            .scheduled_sines()
            .map(|(sine, scope)| sine.term(scope.from.get(), until(scope)))
            .collect();
        Box::new(Self { inner, failing, added: Arc::new(Waveform { terms }) })
    }

    /// Returns the torque without failures, with the waveform (N m).
    fn commanded(&self, now: Instant) -> f64 {
        self.inner.torque() + self.inner.waveform(now).map_or(0.0, |forced| forced.at(0.0))
    }
}

impl AxisActuator for FaultyActuator {
    fn command(&mut self, now: Instant, command: f64, rigid_rate: f64) {
        self.inner.command(now, command, rigid_rate);
    }

    fn serve(&mut self, now: Instant, rigid_rate: f64) {
        self.inner.serve(now, rigid_rate);
        let commanded = self.commanded(now);
        self.failing.update(now, commanded);
    }

    fn due(&self) -> Option<Instant> {
        [self.inner.due(), self.failing.due()].into_iter().flatten().min()
    }

    fn torque_per_unit(&self) -> f64 {
        self.inner.torque_per_unit()
    }

    fn torque(&self) -> f64 {
        self.failing.output(self.inner.torque())
    }

    fn nominal_torque(&self) -> f64 {
        self.inner.nominal_torque()
    }

    fn firing(&self) -> f64 {
        self.inner.firing()
    }

    fn sines(&self) -> &[Sine] {
        self.failing.sines()
    }

    fn demanded_torque(&self) -> f64 {
        self.inner.demanded_torque()
    }

    fn executes_waveform(&self) -> bool {
        self.inner.executes_waveform()
    }

    fn waveform(&self, now: Instant) -> Option<ActiveWaveform> {
        let own = self.failing.fraction().and_then(|part| Some((self.inner.waveform(now)?, part)));
        match own {
            None if self.failing.sines().is_empty() => None,
            None => Some(ActiveWaveform::new(Arc::clone(&self.added), now.seconds())),
            Some((own, 1.0)) if self.failing.sines().is_empty() => Some(own),
            Some((own, part)) => Some(own.scaled_and_added(part, &self.added)),
        }
    }

    fn applied(&self, now: Instant, rates: [f64; 2]) -> f64 {
        let (commanded, t) = (self.commanded(now), now.seconds());
        let added: f64 = self.failing.sines().iter().map(|sine| sine.at(t)).sum();
        // Back-EMF is not affected.
        self.inner.applied(now, rates) - commanded + self.failing.output(commanded) + added
    }

    fn back_emf(&self) -> (f64, bool) {
        self.inner.back_emf()
    }

    fn rotor(&self, rigid_rate: f64) -> Option<WheelMotion> {
        self.inner.rotor(rigid_rate)
    }

    fn copy(&self) -> Box<dyn AxisActuator> {
        Box::new(self.clone())
    }
}
