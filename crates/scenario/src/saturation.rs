//! Limits of a scenario's actuators, and when its laws pursue a target, as runs watch them.

use flexsc_control::actuator::{ActuatorLimits, Saturation, TargetLossMonitor, Wheels};
use flexsc_control::law::{ErrorBand, LawKind};
use flexsc_numerics::time::Instant;

use super::Scenario;
use super::authority::promised_band;

impl Scenario {
    /// Returns the limits of the actuators.
    pub fn actuator_limits(&self) -> ActuatorLimits {
        ActuatorLimits::new(&self.actuator, self.study.law_period)
    }

    /// Returns the counts of a run's cycles with actuators at their limits, before its start.
    pub fn saturation(&self) -> Saturation {
        let wheels = self.actuator.wheels().map_or(0, |(wheels, _)| Wheels::count(wheels));
        let losses =
            TargetLossMonitor::new(self.pursuits(), self.accepted_errors(), self.study.assessment_period);
        Saturation::new(self.actuator_limits(), losses, self.duration, [wheels, self.mode.len()])
    }

    /// Returns, for each mode of operation or once without modes, the norm of the errors (rad) that the scenario or its laws accept
    /// about the axes: `reference.band`, or dead zones; 0 without any.
    fn accepted_errors(&self) -> Vec<f64> {
        let count = self.mode.len().max(1);
        if let Some(band) = self.reference.band {
            return vec![libm::sqrt(3.0) * band.get(); count];
        }
        let norm = |bands: &[ErrorBand]| {
            let square =
                |band: &ErrorBand| if let ErrorBand::Absolute(band) = band { band * band } else { 0.0 };
            libm::sqrt(bands.iter().map(square).sum())
        };
        if !self.mode.is_empty() {
            return self.study.mode_bands.iter().map(|bands| norm(bands)).collect();
        }
        let about = |(axis, authority)| promised_band(self.law.about(axis), Some(authority));
        let bands: Vec<ErrorBand> = self.study.authorities.iter().enumerate().map(about).collect();
        vec![norm(&bands)]
    }

    /// Returns, for each mode of operation or once without modes, the instants from which on the law pursues a target or does
    /// not.
    fn pursuits(&self) -> Vec<Vec<(Instant, bool)>> {
        let pursues = |law: &LawKind| law.offers().reads_motion();
        if !self.mode.is_empty() {
            return self.mode.iter().map(|mode| vec![(Instant::START, pursues(&mode.law))]).collect();
        }
        let stages = self.law.stages();
        if stages.is_empty() {
            return vec![vec![(Instant::START, pursues(&self.law))]];
        }
        vec![stages.iter().map(|stage| (stage.begins(), pursues(&stage.law))).collect()]
    }
}
