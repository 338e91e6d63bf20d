//! Compatibility of the parts of a scenario: the offers of all parts, and the requirements of each that they do not meet.

use flexsc_control::law::{AttitudeProfile, AttitudeTarget, PlacedLaw, Stage};
use flexsc_control::offers::{AxisLaw, BodyOffers, EnvironmentOffers, Offers};
use flexsc_control::requirement::{Requirements, Rule};
use flexsc_dynamics::axis_model::CommandedQuantity;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::time::Span;
use flexsc_spacecraft::body::{Body, BodyAxes, BodyModel};
use flexsc_spacecraft::disturbance::Disturbance;

use super::ScenarioSpec;

/// Distance from the planet's centre (m) up to which directions to the Moon change slowly.
const BELOW_MOON: f64 = 1e8;

impl ScenarioSpec {
    /// Returns the sampling period of sensors and estimator; `None` if the angle is measured at every instant.
    pub(super) fn sample_period(&self) -> Option<Span> {
        let cycle = self.law.period();
        let samples = self.estimator.as_ref().is_some_and(|estimator| estimator.envelope().is_none());
        // With an estimator that works on samples, a continuous sensor is sampled at the law's period.
        self.sensor.period(cycle).or(cycle.filter(|_| samples))
    }

    /// Returns the offers of all parts.
    pub(super) fn offers(&self, model: &BodyModel) -> Offers {
        let law = |axis: usize, of: PlacedLaw<'_>| AxisLaw {
            axis,
            offers: of.law.offers(),
            actuators: of.stage.and_then(Stage::actuator_kinds),
            key: of.key,
        };
        let about = |axis: usize| self.law.laws_about(axis).into_iter().map(move |of| law(axis, of));
        let around = self.environment.as_ref();
        Offers {
            body: self.body_offers(model),
            environment: EnvironmentOffers {
                magnetic_field: around.is_some_and(|around| around.magnetic_field.is_some()),
                sun: around.is_some_and(|around| around.sun.is_some()),
                orbit: around.is_some_and(|around| around.orbit.is_some()),
                moon: around.is_some() && self.date_ns().is_some(),
                is_below_moon: around
                    .and_then(|around| around.orbit.as_ref()?.path(self.duration.seconds(), self.date_ns()))
                    .is_none_or(|orbit| orbit.farthest() <= BELOW_MOON),
            },
            laws: (0..self.axis_count()).flat_map(about).collect(),
            law_kind: self.law.kind(),
            law_period: self.law.period(),
            sensors: self.sensor.offers(self.law.period()),
            sample_period: self.sample_period(),
            actuators: self.actuator.offers(),
            estimator: self.estimator.as_ref().map(|estimator| estimator.offers()),
        }
    }

    fn body_offers(&self, model: &BodyModel) -> BodyOffers {
        let one_axis = model.one_axis();
        let turns_appendages = model.three_axis().is_some_and(|body| body.articulation.is_some());
        let hub_points = match &self.spacecraft {
            Some(craft) if turns_appendages && craft.points.is_empty() => vec!["hub".to_owned()],
            Some(craft) if turns_appendages => craft.points.iter().map(|point| point.name.clone()).collect(),
            _ => Vec::new(),
        };
        BodyOffers {
            axes: self.axis_count(),
            kind: self.body_kind(),
            is_spacecraft: self.spacecraft.is_some(),
            is_two_way: model.is_two_way(),
            has_small_angles: model.three_axis().is_some_and(|body| body.small_angles.is_some()),
            modes: model.mode_count(),
            overdamped: self.overdamped_mode(model),
            is_chain: model.chain().is_some(),
            follows_motion: one_axis.is_some_and(|body| body.drive == CommandedQuantity::Motion),
            damping_matrix: one_axis.filter(|body| body.is_coupled()).map(|_| self.damping_key()),
            drifts: self.drift.is_some(),
            turns_appendages,
            hub_points,
            has_manoeuvre: self.manoeuvre.is_some(),
        }
    }

    /// Returns key and damping ratio of the first mode at or above critical damping.
    fn overdamped_mode(&self, model: &BodyModel) -> Option<(String, f64)> {
        let of_body = || format!("{}.damping", self.body_key());
        match model.axes() {
            BodyAxes::One(body) => {
                let (index, ratio) = overdamped(body.modes.iter().map(|mode| mode.damping.get()))?;
                let key = match &self.body {
                    Some(Body::Matrices(_) | Body::Panels(_)) => of_body(),
                    _ => format!("body.planar.modes[{index}].damping"),
                };
                Some((key, ratio))
            }
            BodyAxes::Three(body) => {
                let (_, ratio) = overdamped(body.modes.iter().map(|mode| mode.damping.get()))?;
                Some((of_body(), ratio))
            }
        }
    }

    /// Returns the requirements of the parts that the others do not meet.
    pub(super) fn unmet_requirements(&self, offers: &Offers) -> Requirements {
        let mut needs = Requirements::default();
        self.law.add_requirements(offers, &mut needs);
        self.sensor.add_requirements(offers, &mut needs);
        self.actuator.add_requirements(offers, &mut needs);
        if let Some(estimator) = &self.estimator {
            estimator.add_requirements(offers, &mut needs);
        }
        needs
    }

    /// Checks that the parts of the scenario are compatible, in the order in which errors are reported.
    ///
    /// # Errors
    /// Fails with the first key that is incompatible with the others, and the reason.
    pub(super) fn validate_compatibility(
        &self,
        model: &BodyModel,
        offers: &Offers,
        unmet: &Requirements,
    ) -> Result<(), ConfigError> {
        let checks: [&dyn Fn() -> Option<ConfigError>; 18] = [
            &|| self.validate_modes(model, offers),
            &|| unmet.first_of(Rule::AxisLaws..=Rule::MomentAxes),
            &|| self.validate_one_axis_tables(),
            &|| unmet.first_of(Rule::SensorPoint..=Rule::OneNumber),
            &|| self.validate_one_axis_disturbances(),
            &|| self.validate_three_axis_tables(),
            &|| self.validate_small_angles(model),
            &|| unmet.first(Rule::BackEmf),
            &|| self.validate_assignments(),
            &|| unmet.first_of(Rule::Repetition..=Rule::Phase),
            &|| self.validate_shares(offers),
            &|| self.validate_environment(),
            &|| self.validate_targets(model),
            &|| unmet.first(Rule::Law),
            &|| unmet.first_of(Rule::Sensor..=Rule::Accelerometer),
            &|| self.validate_sensor_set(offers),
            &|| unmet.first_of(Rule::MagneticField..=Rule::JetCycle),
            &|| unmet.first_of(Rule::DominantMode..=Rule::EstimatorInputs),
        ];
        checks.iter().find_map(|check| check()).map_or(Ok(()), Err)
    }

    /// Checks that a one-axis body has no tables for three axes.
    fn validate_one_axis_tables(&self) -> Option<ConfigError> {
        if self.axis_count() == 3 {
            return None;
        }
        let tables = [
            ("target", !self.target.is_empty(), "a `[manoeuvre]` turns a body with one angle"),
            ("environment", self.environment.is_some(), "a `[[disturbance]]` acts on a body with one angle"),
            (
                "line_of_sight",
                !self.line_of_sight.is_empty(),
                "the angle, or an output, is that of a body with one angle",
            ),
        ];
        let (key, _, instead) = tables.into_iter().find(|(_, is_given, _)| *is_given)?;
        let kind = self.body_kind();
        let why = format!("is for a body with three axes, and the body is `{kind}`: {instead}");
        Some(ConfigError::new(key, why))
    }

    fn validate_one_axis_disturbances(&self) -> Option<ConfigError> {
        let list = Some(&self.disturbance).filter(|_| self.axis_count() == 1)?;
        Disturbance::validate_one_axis(list).map(|fault| fault.within("disturbance"))
    }

    /// Checks that a three-axis body has no tables for one axis, and that its disturbances have a direction.
    fn validate_three_axis_tables(&self) -> Option<ConfigError> {
        if self.axis_count() == 1 {
            return None;
        }
        if self.manoeuvre.is_some() {
            let why = "is for bodies with one angle: use `[[target]]` for three axes";
            return Some(ConfigError::new("manoeuvre", why));
        }
        if self.drift.is_some() && self.spacecraft.is_some() {
            let why = "is for modes that are given: those of a `[spacecraft]` follow from its appendages, which a `drive` can turn";
            return Some(ConfigError::new("drift", why));
        }
        self.disturbance.iter().enumerate().find_map(|(index, disturbance)| {
            Some(disturbance.validate_three_axis()?.within(&format!("disturbance[{index}]")))
        })
    }

    fn validate_targets(&self, model: &BodyModel) -> Option<ConfigError> {
        let own = self.law.own_targets();
        if !own.is_empty() {
            let key = format!("law.{}.targets", self.law.kind());
            if !self.target.is_empty() {
                let why = format!("are those of the scenario: leave out `{key}`");
                return Some(ConfigError::new("target", why));
            }
            // The order of the targets is checked with the law.
            if AttitudeTarget::validate_order(own).is_some() {
                return None;
            }
            let fault = AttitudeProfile::validate(own, &self.orbit_environment(), &model.free_modes())?;
            return Some(fault.within(&key));
        }
        if let Some((late, why)) = AttitudeTarget::validate_order(&self.target) {
            return Some(ConfigError::new(format!("target[{late}].from"), why));
        }
        AttitudeProfile::validate(&self.target, &self.orbit_environment(), &model.free_modes())
            .map(|fault| fault.within("target"))
    }
}

/// Returns index and value of the first damping ratio at or above 1.
fn overdamped(ratios: impl Iterator<Item = f64>) -> Option<(usize, f64)> {
    ratios.enumerate().find(|(_, ratio)| *ratio >= 1.0)
}
