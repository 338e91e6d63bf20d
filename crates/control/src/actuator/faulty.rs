//! Failures of a single-axis actuator.

use std::sync::Arc;

use flexsc_dynamics::flow::ActiveWaveform;
use flexsc_dynamics::waveform::Waveform;
use flexsc_numerics::quantity::Time;
use flexsc_numerics::time::Instant;
use flexsc_record::Report;

use super::failure::{ActiveFailures, Failure, FailureScope};
use super::{AxisActuator, AxisProperties, AxisResponse, AxisTorques, AxisWaves};
use crate::custom::PartError;
use crate::interval::Interval;
use crate::part::{Part, ReportContext};

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
        let waveform = self.inner.waves(now).waveform;
        self.inner.torques().held + waveform.map_or(0.0, |forced| forced.at(0.0))
    }

    /// Returns the waveform of the actuator with that of its failures.
    fn waveform(&self, now: Instant) -> Option<ActiveWaveform> {
        let own = self.failing.fraction().and_then(|part| Some((self.inner.waves(now).waveform?, part)));
        match own {
            None if self.failing.sines().is_empty() => None,
            None => Some(ActiveWaveform::new(Arc::clone(&self.added), now.seconds())),
            Some((own, 1.0)) if self.failing.sines().is_empty() => Some(own),
            Some((own, part)) => Some(own.scaled_and_added(part, &self.added)),
        }
    }
}

impl Part for FaultyActuator {
    fn due(&self) -> Option<Instant> {
        [self.inner.due(), self.failing.due()].into_iter().flatten().min()
    }

    fn report(&self, at: &ReportContext<'_>, report: &mut Report) {
        self.inner.report(at, report);
    }

    fn failure(&self) -> Option<PartError> {
        self.inner.failure()
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

    fn torques(&self) -> AxisTorques {
        let torques = self.inner.torques();
        AxisTorques { held: self.failing.output(torques.held), ..torques }
    }

    fn response(&self, now: Instant, rates: [f64; 2]) -> AxisResponse {
        let (commanded, t) = (self.commanded(now), now.seconds());
        let added: f64 = self.failing.sines().iter().map(|sine| sine.at(t)).sum();
        let AxisResponse { applied, rotor } = self.inner.response(now, rates);
        // Back-EMF is not affected.
        AxisResponse { applied: applied - commanded + self.failing.output(commanded) + added, rotor }
    }

    fn properties(&self) -> AxisProperties {
        self.inner.properties()
    }

    fn waves(&self, now: Instant) -> AxisWaves<'_> {
        AxisWaves { waveform: self.waveform(now), sines: self.failing.sines() }
    }

    fn copy(&self) -> Box<dyn AxisActuator> {
        Box::new(self.clone())
    }
}
