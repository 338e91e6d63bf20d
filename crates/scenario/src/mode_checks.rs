//! Checks of the modes of operation: their conditions, targets and sensors against the other parts.

use flexsc_control::estimator::EstimatorKind;
use flexsc_control::law::EstimateNeeds;
use flexsc_control::offers::Offers;
use flexsc_control::operation::{ModeQuantity, ModeTarget, OperatingMode, Vocabulary};
use flexsc_control::sensor::SensorKind;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::Positive;
use flexsc_spacecraft::body::craft::{Appendage, RateLimit};
use flexsc_spacecraft::body::{AssembledSpacecraft, BodyModel};

use super::ScenarioSpec;

impl ScenarioSpec {
    /// Returns which sensors are in use in a mode; all without modes.
    pub fn sensors_in_use(&self, mode: usize) -> Vec<bool> {
        let kinds: Vec<&str> = self.sensor.iter().map(SensorKind::kind).collect();
        let used = self.mode.get(mode).and_then(|mode| mode.sensor_indices(&kinds).ok().flatten());
        (0..kinds.len()).map(|index| used.as_ref().is_none_or(|used| used.contains(&index))).collect()
    }

    /// Checks the modes of operation.
    pub(super) fn validate_modes(&self, model: &BodyModel, offers: &Offers, errors: &mut Vec<ConfigError>) {
        if self.mode.is_empty() {
            return;
        }
        self.validate_mode_targets(model, errors);
        let kinds: Vec<&str> = self.sensor.iter().map(SensorKind::kind).collect();
        let names = self.mode.iter().map(|mode| mode.name.as_str()).collect();
        let known = Vocabulary { sensors: kinds.clone(), modes: names, ..Vocabulary::default() };
        if let Some(error) = OperatingMode::fault(&self.mode, &kinds) {
            // Sensors in use and conditions are found by their names.
            errors.push(error.within("mode"));
            return;
        }
        for (index, mode) in self.mode.iter().enumerate() {
            let sensors = self.mode_sensor_error(index, mode);
            let exits = self.mode_exit_errors(index, mode, &known, offers);
            errors.extend(
                sensors.into_iter().chain(exits).map(|error| error.within(&format!("mode[{index}]"))),
            );
        }
    }

    fn validate_mode_targets(&self, model: &BodyModel, errors: &mut Vec<ConfigError>) {
        let targets = self.mode.iter().enumerate();
        let targets: Vec<_> =
            targets.filter_map(|(index, mode)| Some((index, mode.target.as_ref()?))).collect();
        let tracks = |of: &Appendage| of.drive.as_ref().is_some_and(|drive| drive.track.is_some());
        let unknown = if model.three_axis().is_some_and(|body| body.small_angles.is_some()) {
            Some("must be left out with `small_angles`, for which the target must stay fixed")
        } else if self.appendage.iter().any(tracks) {
            Some(
                "must be left out with a drive that tracks the Sun, whose angle has to be known before the run",
            )
        } else {
            None
        };
        if !targets.is_empty() && !self.target.is_empty() {
            let why = "must be left out: the modes have targets of their own, from the start of each on";
            errors.push(ConfigError::new("target", why));
        }
        let sky = self.orbit_environment();
        let limit = model.spacecraft().and_then(AssembledSpacecraft::rate_limit);
        for (index, target) in targets {
            let fast = || {
                let RateLimit { rate: limit, why } = limit.as_ref()?;
                let rate = target.rate_limit.map(Positive::get).filter(|rate| rate > limit)?;
                let why = format!("must be below {limit:.3e} rad/s, {why}, got {rate}");
                Some(ConfigError::new("rate_limit", why))
            };
            let error = match unknown {
                Some(why) => Some(ConfigError::new("", why)),
                None => target.fault(&sky).or_else(fast),
            };
            errors.extend(error.map(|error| error.within(&format!("mode[{index}].target"))));
        }
    }

    /// Checks that the sensors that the law of a mode needs are in use.
    fn mode_sensor_error(&self, index: usize, mode: &OperatingMode) -> Option<ConfigError> {
        let in_use = self.sensors_in_use(index);
        let missing = |wanted: &dyn Fn(usize, &SensorKind) -> bool| {
            let all = self.sensor.iter().enumerate();
            all.filter(|(place, sensor)| !in_use[*place] && wanted(*place, sensor))
                .map(|(place, _)| place)
                .next()
        };
        let at = |why: String| Some(ConfigError::new("sensors", why));
        let name = |place: usize| self.sensor_key(place);
        let law = mode.law.kind();
        if mode.law.offers().commands_moments
            && !self.sensor.iter().enumerate().any(|(place, of)| in_use[place] && of.measures_field())
        {
            return at(format!("must include `magnetometer`, which the law `{law}` needs"));
        }
        if let Some(place) = missing(&|_, sensor| sensor.is_continuous()) {
            return at(format!("must include `{}`, which measures at every instant", name(place)));
        }
        let filter = self.estimator.as_ref().and_then(EstimatorKind::attitude);
        if filter.is_some() {
            let place = missing(&|_, sensor| sensor.rate_noise(0).is_some())?;
            return at(format!(
                "must include `{}`, with which the `[estimator.attitude]` goes on through all modes",
                name(place)
            ));
        }
        if self.estimator.is_some() || mode.law.needs() > EstimateNeeds::Field {
            let of_motion =
                |_: usize, sensor: &SensorKind| sensor.measures_motion() && !sensor.measures_vector();
            let place = missing(&of_motion)?;
            let reader = match &self.estimator {
                Some(estimator) => format!("the `[estimator.{}]`", estimator.kind()),
                None => format!("the law `{law}`"),
            };
            return at(format!("must include `{}`, which {reader} needs", name(place)));
        }
        None
    }

    /// Checks that the quantities of a mode's conditions are known in it, and that something tests them.
    fn mode_exit_errors(
        &self,
        index: usize,
        mode: &OperatingMode,
        known: &Vocabulary<'_>,
        offers: &Offers,
    ) -> Vec<ConfigError> {
        let in_use = self.sensors_in_use(index);
        let why = |quantity| self.unknown_quantity(quantity, &in_use, offers);
        let samples = offers.law_period.or(offers.sample_period).is_some();
        let leave = mode.leave.iter().enumerate();
        let errors = leave.filter_map(|(place, exit)| {
            let read = exit.read(known).ok()?;
            let error = read.leaves().into_iter().find_map(|(quantity, _)| why(quantity)).or_else(|| {
                let why = "is tested at the samples of a law or of a sensor, and here neither has a period: give the sensor one";
                (!samples && !read.reads_truth()).then_some(why)
            });
            error.map(|why| ConfigError::new(format!("leave[{place}].when"), why))
        });
        errors.collect()
    }

    /// Returns why a quantity is not known with the sensors that are in use; `None` if it is.
    pub(super) fn unknown_quantity(
        &self,
        quantity: ModeQuantity,
        in_use: &[bool],
        offers: &Offers,
    ) -> Option<&'static str> {
        let used = |wanted: &dyn Fn(&SensorKind) -> bool| {
            self.sensor.iter().zip(in_use).any(|(sensor, in_use)| *in_use && wanted(sensor))
        };
        let knows_motion =
            self.estimator.is_some() || used(&|sensor| sensor.measures_motion() && !sensor.measures_vector());
        let filters = self.estimator.as_ref().is_some_and(|estimator| estimator.filters_measurements());
        let stores = |kind: &str| offers.actuators.iter().any(|member| member.kind == kind);
        match quantity {
            ModeQuantity::Rate | ModeQuantity::RateError | ModeQuantity::AttitudeError => (!knows_motion)
                .then_some(
                    "reads the estimated motion, and no sensor of attitude or rates is in use in this mode",
                ),
            ModeQuantity::Momentum => (!stores("wheels") && !stores("control_moment_gyros")).then_some(
                "reads a stored momentum, and there are neither `wheels` nor `control_moment_gyros`",
            ),
            ModeQuantity::WheelSpeed => {
                (!stores("wheels")).then_some("reads the speeds of `wheels`, and there are none")
            }
            ModeQuantity::Field | ModeQuantity::FieldRate => {
                (!used(&|sensor: &SensorKind| sensor.measures_field()))
                    .then_some("reads the measured field, and no `magnetometer` is in use in this mode")
            }
            ModeQuantity::Sunlight | ModeQuantity::TrueSunlight => {
                (!offers.environment.sun).then_some("reads the light of `environment.sun`, and there is none")
            }
            ModeQuantity::Elevation(mode) | ModeQuantity::TrueElevation(mode) => {
                let site = self.mode[mode].target.as_ref().and_then(ModeTarget::site);
                site.is_none().then_some(
                    "reads the elevation at the `site` in the target of a mode, and that one has none",
                )
            }
            ModeQuantity::Blinded(sensor) => self
                .sensor
                .exclusions()
                .all(|(excluding, ..)| excluding != sensor)
                .then_some("names a sensor without exclusion angles, which nothing blinds"),
            ModeQuantity::LockLost => {
                (!filters).then_some("reads the lock of a Kalman filter about each axis, and there is none")
            }
            ModeQuantity::FilterAge | ModeQuantity::FilterInnovation | ModeQuantity::FilterDeviation => {
                let filter = self.estimator.as_ref().and_then(EstimatorKind::attitude);
                filter.is_none().then_some("reads an `[estimator.attitude]`, and there is none")
            }
            ModeQuantity::Silent(sensor) => {
                let of = &self.sensor[sensor];
                if !in_use[sensor] {
                    Some("names a sensor that is not in use in this mode")
                } else if of.is_continuous() || !of.measures_motion() {
                    Some("names a sensor without readings at samples")
                } else {
                    None
                }
            }
            _ => None,
        }
    }
}
