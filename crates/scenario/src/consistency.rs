//! Consistency of the keys of a scenario with each other.

use flexsc_control::law::{AttitudeProfile, AttitudeTarget};
use flexsc_control::offers::Offers;
use flexsc_control::requirement::OFF_HUB;
use flexsc_dynamics::axis_model::AxisModel;
use flexsc_dynamics::three_axis_model::ThreeAxisModel;
use flexsc_formats::document::ConfigError;
use flexsc_formats::document::key;
use flexsc_numerics::attitude::vector;
use flexsc_spacecraft::body::craft::RateLimit;
use flexsc_spacecraft::body::{BodyAxes, BodyModel};
use flexsc_spacecraft::disturbance::Disturbance;

use super::uncertain::{Correlated, Distribution};
use super::{BoundSpec, Scenario, ScenarioSpec, file_name, meant};

/// Returns the errors of the parts of a list, with their keys in it.
pub fn errors_in<T>(
    list: &str,
    parts: &[T],
    validate: impl Fn(&T) -> Option<ConfigError>,
) -> impl Iterator<Item = ConfigError> {
    let parts = parts.iter().enumerate();
    parts.filter_map(move |(index, part)| Some(validate(part)?.within(&format!("{list}[{index}]"))))
}

impl ScenarioSpec {
    /// Checks the keys of tables that depend on no other part.
    pub(super) fn validate_keys(&self, errors: &mut Vec<ConfigError>) {
        errors.extend(file_name::validate(&self.name).err());
        // The first day of 2554 is the last whose nanoseconds since 1970 fit 64 bits.
        let longest = (u64::MAX - self.epoch_ns()) as f64 / 1e9;
        let duration = self.duration.seconds();
        if duration >= longest {
            let why = format!(
                "must be below {longest:.4e} s, so that the log can count its nanoseconds from 1970, got {duration:e}"
            );
            errors.push(ConfigError::new("duration", why));
        }
        errors.extend(self.log.scene.validate().map(|error| error.within("log.scene")));
        errors.extend(errors_in("bound", &self.bound, BoundSpec::validate));
        errors.extend(errors_in("disturbance", &self.disturbance, Disturbance::validate_times));
        if let Some(pointing) = &self.reference.pointing {
            let error = pointing.validate(self.axis_count());
            errors.extend(error.map(|error| error.within("reference.pointing")));
        }
        self.validate_assignments(errors);
        for (index, group) in self.correlated.iter().enumerate() {
            let error = self.validate_correlation(index, group);
            errors.extend(error.map(|error| error.within(&format!("correlated[{index}]"))));
        }
        if !self.uncertain.is_empty() {
            self.validate_uncertain(errors);
        }
    }

    fn validate_uncertain(&self, errors: &mut Vec<ConfigError>) {
        let mut written = self.clone();
        written.inline_files();
        let mut table = written.to_table();
        table.remove("uncertain");
        table.remove("correlated");
        for (key, distribution) in &self.uncertain {
            let nominal = key::get(&table, key);
            let Some(why) = distribution.validate(nominal) else { continue };
            let near = if nominal.is_none() { meant::number(&table, key) } else { None };
            let why = near.map_or(why.clone(), |near| format!("{why}; did you mean `{near}`?"));
            errors.push(ConfigError::new(format!("uncertain.\"{key}\""), why));
        }
    }

    /// Checks a group of correlated keys; returns the inconsistent key of the group and the reason.
    fn validate_correlation(&self, group: usize, correlated: &Correlated) -> Option<ConfigError> {
        let why = |key: &String| match self.uncertain.get(key).map(Distribution::is_continuous) {
            None => Some(format!("names `{key}`, which is no key of `[uncertain]`")),
            Some(false) => Some(format!("names `{key}`, a choice: only numbers of a range are correlated")),
            Some(true) if self.correlated[..group].iter().any(|other| other.keys.contains(key)) => {
                Some(format!("names `{key}`, which is correlated with others already"))
            }
            Some(true) => None,
        };
        let error = correlated.keys.iter().find_map(why).map(|why| ConfigError::new("keys", why));
        error.or_else(|| correlated.validate())
    }

    /// Checks the parts of a three-axis body.
    pub(super) fn validate_three_axis(
        &self,
        model: &BodyModel,
        body: &ThreeAxisModel,
        offers: &Offers,
        errors: &mut Vec<ConfigError>,
    ) {
        self.validate_points(body, offers, errors);
        errors.extend(errors_in("disturbance", &self.disturbance, Disturbance::validate_three_axis));
        errors.extend(self.guidance_conflict());
        errors.extend(errors_in("line_of_sight", &self.line_of_sight, |line| line.validate(body, offers)));
        if body.small_angles.is_some() {
            self.require_small_angles(model, body, errors);
        }
    }

    /// Checks that no targets are beside a guidance of a program.
    fn guidance_conflict(&self) -> Option<ConfigError> {
        self.first_guidance()?;
        let why = if !self.law.own_targets().is_empty() {
            "gives the target, and so do the `targets` of the law: leave them out"
        } else if self.guidance("").is_some() && self.has_mode_targets() {
            "gives the target of the whole run, and a mode has a `target`: give the guidance to modes by their names"
        } else {
            return None;
        };
        Some(ConfigError::new("guidance", why))
    }

    /// Checks the points at which sensors are mounted and forces act.
    fn validate_points(&self, body: &ThreeAxisModel, offers: &Offers, errors: &mut Vec<ConfigError>) {
        let sensors = self.sensor.iter().enumerate();
        let sensors = sensors.map(|(index, sensor)| (self.sensor_key(index), sensor.point()));
        let forces = self.disturbance.iter().enumerate();
        let forces = forces.map(|(index, force)| (format!("disturbance[{index}]"), force.point.as_deref()));
        let listed = self.disturbance.len();
        let own = self.own_disturbances.iter().zip(listed..).flat_map(|((_, own), index)| {
            own.points().iter().map(move |point| (format!("disturbance[{index}]"), Some(&**point)))
        });
        for (key, point) in sensors.chain(forces).chain(own).filter_map(|(key, point)| Some((key, point?))) {
            let why = if body.point(point).is_none() {
                format!("must be one of the body's points, {}, got `{point}`", body.point_names())
            } else if key.starts_with("disturbance") && !offers.body.has_motion_at(point) {
                OFF_HUB.to_owned()
            } else {
                continue;
            };
            errors.push(ConfigError::new("point", why).within(&key));
        }
    }

    /// Checks the parts of a one-axis body.
    pub(super) fn validate_one_axis(&self, body: &AxisModel, offers: &Offers, errors: &mut Vec<ConfigError>) {
        self.require_separate_modes(body, errors);
        self.require_uncoupled_torque(offers, errors);
        if offers.body.follows_motion {
            self.require_given_motion(offers, errors);
        }
        self.require_hub_torque(body, errors);
        let pointed = self.own_disturbances.iter().any(|(_, own)| !own.points().is_empty());
        if pointed {
            let why = "names points of a body with three axes, and the body has one angle";
            errors.push(ConfigError::new("disturbance.points", why));
        }
        if !self.own_guidance.is_empty() {
            let why =
                "gives attitudes of a body with three axes, and the body has one angle: use a `[manoeuvre]`";
            errors.push(ConfigError::new("guidance", why));
        }
    }

    /// Adds the requirements of manoeuvre and drift on a damping matrix.
    fn require_separate_modes(&self, body: &AxisModel, errors: &mut Vec<ConfigError>) {
        if self.manoeuvre.as_ref().is_some_and(|manoeuvre| manoeuvre.planned_for(body).is_coupled()) {
            let why = "couples modes, and a `[manoeuvre]` treats each mode on its own: give it a `model` without this matrix";
            errors.push(ConfigError::new(self.damping_key(), why));
        }
        if body.is_coupled() && self.drift.is_some() {
            errors.push(ConfigError::new(self.damping_key(), "has no closed form for modes that drift"));
        }
    }

    /// Adds the requirements of a wheel or of a drift, which couple the modes.
    fn require_uncoupled_torque(&self, offers: &Offers, errors: &mut Vec<ConfigError>) {
        let wheel = self.actuator.flywheel().map(|(_, key)| key);
        if wheel.is_none() && self.drift.is_none() {
            return;
        }
        let unsampled = wheel.is_some() && self.manoeuvre.is_some() && self.law.period().is_none();
        let conflicts = [
            (
                unsampled,
                "executes a `[manoeuvre]` sample by sample of a law, and the law has no period: give it a `[law.pd]`",
            ),
            (
                offers.follows_waveform() && !unsampled,
                "has no closed form: execute the `[manoeuvre]` by an `[actuator.hold]` or thrusters",
            ),
            (
                offers.body.is_chain || offers.body.follows_motion,
                "needs linear modes of a body that a torque drives",
            ),
        ];
        let key = wheel.as_deref().unwrap_or("drift");
        let conflicts = conflicts.into_iter().filter(|(applies, _)| *applies);
        errors.extend(conflicts.map(|(_, why)| ConfigError::new(key, why)));
    }

    /// Adds the requirement that no torque acts on a hub that follows a given motion.
    fn require_given_motion(&self, offers: &Offers, errors: &mut Vec<ConfigError>) {
        let disturbances = self.disturbance_keys();
        let pulses = offers.actuators.iter().filter(|member| member.offers.pulses);
        let law = offers.laws.iter().any(|law| !law.offers.is_open).then(|| "law".to_owned());
        let torques = disturbances.chain(pulses.map(|member| member.key.clone())).chain(law);
        let why = "moves the hub by force, but the body's hub follows a given motion (`drive = \"motion\"`)";
        errors.extend(torques.map(|key| ConfigError::new(key, why)));
        if offers.body.is_chain {
            let why = "must be \"linear\" where the hub's motion is given";
            errors.push(ConfigError::new("body.panels.kinematics", why));
        }
    }

    /// Adds the requirement that no other torque acts on the hub of a body whose modes have the gains of a load elsewhere.
    fn require_hub_torque(&self, body: &AxisModel, errors: &mut Vec<ConfigError>) {
        if body.modes.iter().all(|mode| mode.gain == mode.hub_gain) {
            return;
        }
        let disturbances = self.disturbance_keys().map(|key| (key, "is a torque that"));
        let wheel = self.actuator.flywheel().map(|(_, key)| (key, "is a wheel that"));
        for (key, what) in disturbances.chain(wheel) {
            let why = format!(
                "{what} acts on the hub, but the actuator of this body elsewhere (`manoeuvre.load`, or a `hub_gain` of modes)"
            );
            errors.push(ConfigError::new(key, why));
        }
    }
}

impl Scenario {
    /// Returns the errors that show only in the data resolved from all parts: costs, and the motion at the start and in turns.
    pub(super) fn conflicts_of_motion(&self) -> Vec<ConfigError> {
        let mut errors: Vec<ConfigError> = self.infeasible_key().into_iter().collect();
        if let BodyAxes::Three(body) = self.model.axes() {
            errors.extend(self.validate_small_start(body, &self.study));
            self.validate_rates(&mut errors);
        }
        errors
    }

    /// Checks that a spacecraft does not rotate faster than the limit of its modal model.
    fn validate_rates(&self, errors: &mut Vec<ConfigError>) {
        let Some(craft) = self.model.spacecraft() else { return };
        let Some(RateLimit { rate: limit, why }) = craft.rate_limit() else { return };
        let start = vector(&craft.model.rate).norm();
        if start > limit {
            let why = format!("must be below {limit:.3e} rad/s together, {why}, got {start:.3e}");
            errors.push(ConfigError::new("spacecraft.rate", why));
        }
        let key = self.targets_key();
        let way = AttitudeProfile::new(self.targets(), &self.orbit_environment(), &self.model.free_modes());
        let fast = |(index, target): (usize, &AttitudeTarget)| {
            let planned = || Some(("duration", way.fastest(index).filter(|_| target.command.is_some())?));
            let (of, rate) = target.fastest().or_else(planned).filter(|(_, rate)| *rate > limit)?;
            let why = format!("must be below {limit:.3e} rad/s, {why}, got {rate}");
            Some(ConfigError::new(format!("{key}[{index}].{of}"), why))
        };
        errors.extend(self.targets().iter().enumerate().filter_map(fast));
    }
}
