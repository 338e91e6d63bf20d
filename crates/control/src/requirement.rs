//! Requirements of a part on the other parts of a scenario, each with the text of its error.
//!
//! A kind states its requirements in its own file, as conditions on the `Offers` of all parts. The
//! crate `core` asks every part, and reports the first requirement that is not met, in the order of [`Rule`].

use std::ops::RangeInclusive;

use flexsc_formats::document::ConfigError;

/// Error text for an array where a body with one angle needs a number.
pub const ONE_NUMBER: &str = "must be one number for a body with one angle, got one for each of three axes";

/// Error text for a part at a point that may move.
pub const OFF_HUB: &str =
    "must be a point of the hub: with drives or hinges, the motion of points on appendages is not computed";

/// Error text for wheels whose motion depends on that of a body with modes that do not act back.
pub const ROTATION: &str = "is for wheels on a `[spacecraft]`: the modes of a `[body.spatial]` do not act back on its rotation, \
                            against which wheels turn";

/// Rule to which a requirement belongs. Unmet requirements are reported in the order of the rules, those of one rule in the
/// order of the parts.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rule {
    /// Three axes for a law about each axis.
    AxisLaws,
    /// Three axes for jets.
    JetAxes,
    /// Three axes for magnetorquers.
    MagnetorquerAxes,
    /// Three axes for commands of magnetic moments.
    MomentAxes,
    /// Three axes for sensors at points of the body.
    SensorPoint,
    /// Three axes for an estimator of the attitude.
    AttitudeAxes,
    /// Three axes for reaction wheels.
    WheelAxes,
    /// Three axes for control moment gyros.
    GimbalAxes,
    /// Three axes for sensors of the attitude or of a vector.
    SensorAxes,
    /// One number in place of one for each of three axes.
    OneNumber,
    /// Coupling of the modes by the back-EMF of a wheel.
    BackEmf,
    /// One actuator of a kind.
    Repetition,
    /// Phase of the periods of an actuator.
    Phase,
    /// Law about an axis: its own settings, its sensors and its actuators.
    Law,
    /// Sensor: its own settings, the environment and the other sensors.
    Sensor,
    /// Wheels of a tachometer.
    Tachometer,
    /// Spacecraft of an accelerometer.
    Accelerometer,
    /// Magnetic field of magnetorquers.
    MagneticField,
    /// Updates of the gimbal rates.
    GimbalPeriod,
    /// Cycle of jets.
    JetCycle,
    /// Estimate of the dominant mode.
    DominantMode,
    /// Samples of an estimator, and the law that reads it.
    EstimatorInputs,
    /// Bearings of wheels.
    Bearings,
    /// Bearings of wheels with a tachometer.
    TachometerBearings,
    /// Motion of a body with control moment gyros.
    GimbalBody,
    /// Rule: an adaptive observer needs an actuator whose pulses are known.
    ObserverInputs,
    /// Elastic rates for active damping.
    ElasticRates,
    /// Crossings found in closed form.
    Crossings,
    /// Modes that a damping matrix couples.
    DampingMatrix,
    /// Points of a gain schedule.
    GainSchedule,
    /// Lengths of pulses.
    PulseLength,
    /// Torques that an envelope follows.
    EnvelopeTorques,
    /// Back-EMF of a wheel with an envelope.
    EnvelopeBackEmf,
    /// Modes of an envelope.
    EnvelopeModes,
    /// Modes and settings of a filter.
    Filter,
    /// Appendages that do not turn, for sensors.
    FixedSensors,
    /// Appendages that do not turn, for jets.
    FixedJets,
    /// Appendages that do not turn, for wheels in bearings.
    FixedBearings,
}

/// Unmet requirements of the parts of a scenario.
#[derive(Clone, Debug, Default)]
pub struct Requirements {
    part: String,
    unmet: Vec<(Rule, ConfigError)>,
}

impl Requirements {
    /// Sets the key of the part whose requirements follow.
    pub fn set_part(&mut self, key: String) {
        self.part = key;
    }

    /// Adds a requirement of the part at `key` within it; empty for the part itself.
    pub fn require(&mut self, rule: Rule, is_met: bool, key: &str, why: &str) {
        self.require_with(rule, is_met, key, || why.to_owned());
    }

    /// Adds a requirement of the part at `key` within it, with a text that is only composed if the requirement is not met.
    pub fn require_with(&mut self, rule: Rule, is_met: bool, key: &str, why: impl FnOnce() -> String) {
        if !is_met {
            self.unmet.push((rule, ConfigError::new(key, why()).within(&self.part)));
        }
    }

    /// Adds a requirement of the part at a key of the scenario outside the part.
    pub fn require_elsewhere(&mut self, rule: Rule, is_met: bool, key: &str, why: &str) {
        if !is_met {
            self.unmet.push((rule, ConfigError::new(key, why)));
        }
    }

    /// Adds the error that a check of the part has found, with its key within the part.
    pub fn report(&mut self, rule: Rule, error: Option<ConfigError>) {
        self.unmet.extend(error.map(|error| (rule, error.within(&self.part))));
    }

    /// Returns the error of the first unmet requirement of these rules.
    pub fn first_of(&self, rules: RangeInclusive<Rule>) -> Option<ConfigError> {
        let among = self.unmet.iter().filter(|(rule, _)| rules.contains(rule));
        among.min_by_key(|(rule, _)| *rule).map(|(_, error)| error.clone())
    }

    /// Returns the error of the first unmet requirement of a rule.
    pub fn first(&self, rule: Rule) -> Option<ConfigError> {
        self.first_of(rule..=rule)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_unmet_requirement_is_that_of_the_first_rule_and_part() {
        let mut needs = Requirements::default();
        needs.set_part("law.pd".to_owned());
        needs.require(Rule::Sensor, false, "period", "must be given");
        needs.require(Rule::Phase, true, "", "must not be reported");
        needs.set_part("sensor.gyro".to_owned());
        needs.require(Rule::Law, false, "", "needs a law");
        needs.require(Rule::Law, false, "", "is reported after the other");
        let text = |error: Option<ConfigError>| error.map(|error| error.to_string());
        let law = text(needs.first_of(Rule::AxisLaws..=Rule::FixedBearings));
        assert_eq!(law.as_deref(), Some("`sensor.gyro` needs a law"));
        assert_eq!(text(needs.first(Rule::Sensor)).as_deref(), Some("`law.pd.period` must be given"));
        assert_eq!(needs.first_of(Rule::AxisLaws..=Rule::Phase), None);
    }
}
