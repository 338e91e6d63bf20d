//! Compatibility of the parts of a scenario: the offers of all parts, and the requirements of each that they do not meet.

use flexsc_control::law::{AttitudeProfile, AttitudeTarget, PlacedLaw, Stage};
use flexsc_control::offers::{AxisLaw, BodyOffers, EnvironmentOffers, Offers};
use flexsc_control::requirement::Requirements;
use flexsc_dynamics::axis_model::CommandedQuantity;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::time::Span;
use flexsc_spacecraft::body::{Body, BodyAxes, BodyModel};
use flexsc_spacecraft::disturbance::Disturbance;

use super::consistency::errors_in;
use super::{ScenarioSpec, requirement_checks};

/// Period of the cycles if neither law nor sensors have a period (s).
const DEFAULT_CYCLE: f64 = 1.0;

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

    /// Returns the period of the cycles of a three-axis body: that of the law, else of the sensors, else 1 s.
    pub(super) fn assessment_period(&self) -> Span {
        self.law.period().or(self.sample_period()).unwrap_or(Span::from_seconds(DEFAULT_CYCLE))
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
        let articulated = model.three_axis().filter(|body| body.articulation.is_some());
        let is_of_hub = |name: &str| match self.spacecraft.as_ref().map(|craft| &craft.points[..]) {
            None | Some([]) => name == "hub",
            Some(points) => points.iter().any(|point| point.name == name),
        };
        let points = articulated.into_iter().flat_map(|body| &body.points).map(|point| point.name.clone());
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
            turns_appendages: articulated.is_some(),
            moving_points: points.filter(|name| !is_of_hub(name)).collect(),
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

    /// Returns all errors of the parts: of their own keys, and of their combination.
    pub(super) fn conflicts(&self, model: &BodyModel, offers: &Offers) -> Vec<ConfigError> {
        let mut errors = Vec::new();
        self.validate_keys(&mut errors);
        let mut needs = Requirements::default();
        self.law.add_requirements(offers, &mut needs);
        self.sensor.add_requirements(offers, &mut needs);
        self.actuator.add_requirements(offers, &mut needs);
        if let Some(estimator) = &self.estimator {
            estimator.add_requirements(offers, &mut needs);
        }
        errors.extend_from_slice(needs.invalid());
        let valid = errors.len();
        errors.extend_from_slice(needs.wrong_axes());
        self.require_axes(&mut errors);
        // What parts require of each other follows from the number of axes, which may be the error.
        if errors.len() == valid {
            self.validate_combination(model, offers, needs.unmet(), &mut errors);
        }
        // A law about three axes requires the same of the others about each.
        let is_new = |index: usize| !errors[..index].contains(&errors[index]);
        (0..errors.len()).filter(|index| is_new(*index)).map(|index| errors[index].clone()).collect()
    }

    /// Checks the combination of parts that are for the axes of the body, with their unmet requirements on each other. This is the
    /// place that knows which errors are mere consequences of others.
    fn validate_combination(
        &self,
        model: &BodyModel,
        offers: &Offers,
        unmet: &[ConfigError],
        errors: &mut Vec<ConfigError>,
    ) {
        errors.extend_from_slice(unmet);
        self.validate_modes(model, offers, errors);
        self.validate_environment(errors);
        self.validate_drift(model, errors);
        self.validate_unloading(errors);
        self.validate_failures(model, errors);
        self.validate_adaptation(offers, errors);
        self.validate_flight_precision(errors);
        match model.axes() {
            BodyAxes::One(body) => self.validate_one_axis(body, offers, errors),
            BodyAxes::Three(body) => self.validate_three_axis(model, body, offers, errors),
        }
        requirement_checks::assessed(self, model, self.assessment_period(), errors);
        errors.extend(self.topic_conflict());
        // A sensor, an estimator or an actuator that has to change, or to go, measures, combines or executes something else then.
        if is_valid("sensor", errors) && is_valid("estimator", errors) {
            self.require_sensor_set(offers, errors);
        }
        if is_valid("actuator", errors) {
            self.require_shares(offers, errors);
        }
        // Directions and times of targets follow from the environment.
        if is_valid("environment", errors) {
            self.validate_targets(model, errors);
        }
    }

    /// Checks that tables are for the axes of the body.
    fn require_axes(&self, errors: &mut Vec<ConfigError>) {
        if self.axis_count() == 3 {
            if self.manoeuvre.is_some() {
                let why = "is for bodies with one angle: use `[[target]]` for three axes";
                errors.push(ConfigError::new("manoeuvre", why));
            }
            return;
        }
        let turned = "a `[manoeuvre]` turns a body with one angle";
        let tables = [
            ("target", !self.target.is_empty(), turned),
            ("environment", self.environment.is_some(), "a `[[disturbance]]` acts on a body with one angle"),
            (
                "line_of_sight",
                !self.line_of_sight.is_empty(),
                "the angle, or an output, is that of a body with one angle",
            ),
        ];
        let kind = self.body_kind();
        for (key, _, instead) in tables.into_iter().filter(|(_, is_given, _)| *is_given) {
            let why = format!("is for a body with three axes, and the body is `{kind}`: {instead}");
            errors.push(ConfigError::new(key, why));
        }
        for index in (0..self.mode.len()).filter(|index| self.mode[*index].target.is_some()) {
            let why = format!("is for a body with three axes: {turned}");
            errors.push(ConfigError::new(format!("mode[{index}].target"), why));
        }
        errors.extend(errors_in("disturbance", &self.disturbance, Disturbance::validate_one_axis));
        for (index, _) in self.actuator.iter().enumerate().filter(|(_, of)| of.axes.is_some()) {
            let key = self.actuator.key("actuator", index);
            // An actuator for three axes has to go with its axes.
            if is_valid(&key, errors) {
                let why = "names axes of three, and the body has one angle: leave it out";
                errors.push(ConfigError::new("axes", why).within(&key));
            }
        }
    }

    fn validate_targets(&self, model: &BodyModel, errors: &mut Vec<ConfigError>) {
        let own = self.law.own_targets();
        let key = self.targets_key();
        if !own.is_empty() && !self.target.is_empty() {
            errors.push(ConfigError::new("target", format!("are those of the scenario: leave out `{key}`")));
            return;
        }
        let targets = if own.is_empty() { &self.target } else { own };
        let error = match AttitudeTarget::validate_order(targets) {
            // The order of the law's own targets is checked with the law.
            Some(_) if !own.is_empty() => None,
            Some((late, why)) => Some(ConfigError::new(format!("[{late}].from"), why)),
            None => AttitudeProfile::validate(targets, &self.orbit_environment(), &model.free_modes()),
        };
        errors.extend(error.map(|error| error.within(&key)));
    }

    /// Returns the key of the targets: of those of the law if it has its own.
    pub(super) fn targets_key(&self) -> String {
        match self.law.own_targets() {
            [] => "target".to_owned(),
            _ => format!("law.{}.targets", self.law.kind()),
        }
    }
}

/// Returns true if there is no error of a part, of which this is the begin of the key.
fn is_valid(part: &str, errors: &[ConfigError]) -> bool {
    !errors.iter().any(|error| error.key.starts_with(part))
}

/// Returns index and value of the first damping ratio at or above 1.
fn overdamped(ratios: impl Iterator<Item = f64>) -> Option<(usize, f64)> {
    ratios.enumerate().find(|(_, ratio)| *ratio >= 1.0)
}
