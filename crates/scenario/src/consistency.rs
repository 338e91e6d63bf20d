//! Consistency of the keys of a scenario with each other.

use flexsc_control::law::{AttitudeProfile, AttitudeTarget};
use flexsc_control::offers::Offers;
use flexsc_control::requirement::{Requirements, Rule};
use flexsc_dynamics::axis_model::AxisModel;
use flexsc_dynamics::three_axis_model::ThreeAxisModel;
use flexsc_formats::document::ConfigError;
use flexsc_formats::document::key;
use flexsc_numerics::attitude::vector;
use flexsc_spacecraft::body::BodyAxes;
use flexsc_spacecraft::body::craft::RateLimit;
use flexsc_spacecraft::disturbance::Disturbance;

use super::{LineOfSight, Scenario, file_name, meant};

impl Scenario {
    /// Checks that the keys are consistent with each other.
    ///
    /// # Errors
    /// Fails with the first inconsistent key, and the reason.
    pub(super) fn validate(&self, offers: &Offers, unmet: &Requirements) -> Result<(), ConfigError> {
        self.inconsistency(offers, unmet).map_or(Ok(()), Err)
    }

    fn inconsistency(&self, offers: &Offers, unmet: &Requirements) -> Option<ConfigError> {
        let at = |key: &str, why: String| Some(ConfigError::new(key, why));
        if let Err(fault) = file_name::validate(&self.name) {
            return Some(fault);
        }
        // The first day of 2554 is the last whose nanoseconds since 1970 fit 64 bits.
        let longest = (u64::MAX - self.epoch_ns()) as f64 / 1e9;
        if self.duration.seconds() >= longest {
            let why = format!(
                "must be below {longest:.4e} s, so that the log can count its nanoseconds from 1970, got {:e}",
                self.duration.seconds()
            );
            return at("duration", why);
        }
        if let Some(impossible) = self.infeasible_key() {
            return Some(impossible);
        }
        if let Some(fault) = self.log.scene.inconsistency() {
            return Some(fault.within("log.scene"));
        }
        let bounds = self.bound.iter().enumerate();
        let mut faults =
            bounds.filter_map(|(index, bound)| Some(bound.fault()?.within(&format!("bound[{index}]"))));
        if let Some(fault) = faults.next() {
            return Some(fault);
        }
        if let Some(pointing) = &self.reference.pointing
            && let Some(fault) = pointing.fault(self.axis_count())
        {
            return Some(fault.within("reference.pointing"));
        }
        // The compatibility of three-axis parts was checked before.
        let parts = match self.model.axes() {
            BodyAxes::One(body) => self.one_axis_inconsistency(body, offers, unmet),
            BodyAxes::Three(body) => self.three_axis_inconsistency(body, offers, unmet),
        };
        parts.or_else(|| {
            if self.uncertain.is_empty() && self.correlated.is_empty() {
                return None;
            }
            if let Some(fault) = self.correlation_fault() {
                return Some(fault);
            }
            let mut written = self.written.clone();
            written.inline_files();
            let mut table = written.to_table();
            table.remove("uncertain");
            table.remove("correlated");
            self.uncertain.iter().find_map(|(key, distribution)| {
                let why = distribution.validate(key::get(&table, key))?;
                let near = if key::get(&table, key).is_none() { meant::number(&table, key) } else { None };
                let why = near.map_or(why.clone(), |near| format!("{why}; did you mean `{near}`?"));
                Some(ConfigError::new(format!("uncertain.\"{key}\""), why))
            })
        })
    }

    /// Checks the groups of correlated keys.
    fn correlation_fault(&self) -> Option<ConfigError> {
        self.correlated.iter().enumerate().find_map(|(group, correlated)| {
            let within = format!("correlated[{group}]");
            let why = |key: &String| match self.uncertain.get(key) {
                None => Some(format!("names `{key}`, which is no key of `[uncertain]`")),
                Some(distribution) if !distribution.is_continuous() => {
                    Some(format!("names `{key}`, a choice: only numbers of a range are correlated"))
                }
                _ if self.correlated[..group].iter().any(|other| other.keys.contains(key)) => {
                    Some(format!("names `{key}`, which is correlated with others already"))
                }
                _ => None,
            };
            let fault = correlated.keys.iter().find_map(why).map(|why| ConfigError::new("keys", why));
            fault.or_else(|| correlated.validate()).map(|fault| fault.within(&within))
        })
    }

    fn three_axis_inconsistency(
        &self,
        body: &ThreeAxisModel,
        offers: &Offers,
        unmet: &Requirements,
    ) -> Option<ConfigError> {
        self.validate_small_start(body, &self.study)
            .or_else(|| self.validate_drives(offers, unmet))
            .or_else(|| unmet.first(Rule::GainSchedule))
            .or_else(|| self.timing_inconsistency(unmet))
            .or_else(|| self.rate_inconsistency())
            .or_else(|| self.validate_drift())
            .or_else(|| self.validate_lines_of_sight(body, offers))
            .or_else(|| unmet.first_of(Rule::EnvelopeModes..=Rule::Filter))
            .or_else(|| self.validate_adaptation(offers))
    }

    /// Checks the lines of sight.
    fn validate_lines_of_sight(&self, body: &ThreeAxisModel, offers: &Offers) -> Option<ConfigError> {
        let fault = |(index, line): (usize, &LineOfSight)| {
            Some(line.fault(body, offers)?.within(&format!("line_of_sight[{index}]")))
        };
        self.line_of_sight.iter().enumerate().find_map(fault)
    }

    /// Checks that a spacecraft does not rotate faster than the limit of its modal model.
    fn rate_inconsistency(&self) -> Option<ConfigError> {
        let craft = self.model.spacecraft()?;
        let RateLimit { rate: limit, why } = craft.rate_limit()?;
        let start = vector(&craft.model.rate).norm();
        if start > limit {
            let why = format!("must be below {limit:.3e} rad/s together, {why}, got {start:.3e}");
            return Some(ConfigError::new("spacecraft.rate", why));
        }
        let is_own = !self.law.own_targets().is_empty();
        let key = if is_own { format!("law.{}.targets", self.law.kind()) } else { "target".to_owned() };
        let way = AttitudeProfile::new(self.targets(), &self.orbit_environment(), &self.model.free_modes());
        let fast = |(index, target): (usize, &AttitudeTarget)| {
            let planned = || Some(("duration", way.fastest(index).filter(|_| target.command.is_some())?));
            let (of, rate) = target.fastest().or_else(planned).filter(|(_, rate)| *rate > limit)?;
            let why = format!("must be below {limit:.3e} rad/s, {why}, got {rate}");
            Some(ConfigError::new(format!("{key}[{index}].{of}"), why))
        };
        self.targets().iter().enumerate().find_map(fast)
    }

    fn one_axis_inconsistency(
        &self,
        body: &AxisModel,
        offers: &Offers,
        unmet: &Requirements,
    ) -> Option<ConfigError> {
        unmet
            .first(Rule::Crossings)
            .or_else(|| self.damping_inconsistency(body, unmet))
            .or_else(|| unmet.first(Rule::GainSchedule))
            .or_else(|| self.validate_drift())
            .or_else(|| self.coupling_inconsistency(offers))
            .or_else(|| self.timing_inconsistency(unmet))
            .or_else(|| unmet.first_of(Rule::EnvelopeTorques..=Rule::EnvelopeBackEmf))
            .or_else(|| self.motion_inconsistency(offers))
            .or_else(|| self.load_inconsistency(body))
            .or_else(|| unmet.first_of(Rule::EnvelopeModes..=Rule::Filter))
            .or_else(|| self.validate_adaptation(offers))
    }

    fn damping_inconsistency(&self, body: &AxisModel, unmet: &Requirements) -> Option<ConfigError> {
        if self.manoeuvre.as_ref().is_some_and(|manoeuvre| manoeuvre.planned_for(body).is_coupled()) {
            let why = "couples modes, and a `[manoeuvre]` treats each mode on its own: give it a `model` without this matrix";
            return Some(ConfigError::new(self.damping_key(), why));
        }
        if body.is_coupled() && self.drift.is_some() {
            return Some(ConfigError::new(self.damping_key(), "has no closed form for modes that drift"));
        }
        unmet.first(Rule::DampingMatrix)
    }

    fn coupling_inconsistency(&self, offers: &Offers) -> Option<ConfigError> {
        let at = |key: &str, why: String| Some(ConfigError::new(key, why));
        let wheel = self.actuator.flywheel().map(|(_, key)| key);
        if wheel.is_none() && self.drift.is_none() {
            return None;
        }
        let key = wheel.as_deref().unwrap_or("drift");
        if wheel.is_some() && self.manoeuvre.is_some() && self.law.period().is_none() {
            let why = "executes a `[manoeuvre]` sample by sample of a law, and the law has no period: give it a `[law.pd]`";
            return at(key, why.to_owned());
        }
        if offers.follows_waveform() {
            let why = "has no closed form: execute the `[manoeuvre]` by an `[actuator.hold]` or thrusters";
            return at(key, why.to_owned());
        }
        if offers.body.is_chain || offers.body.follows_motion {
            let why = "needs linear modes of a body that a torque drives";
            return at(key, why.to_owned());
        }
        None
    }

    /// Checks the order of times, and times against their periods.
    fn timing_inconsistency(&self, unmet: &Requirements) -> Option<ConfigError> {
        if let Some(fault) = Disturbance::validate_times(&self.disturbance) {
            return Some(fault.within("disturbance"));
        }
        self.validate_failures().or_else(|| unmet.first(Rule::PulseLength))
    }

    /// Checks that no torque acts on a hub that follows a given motion.
    fn motion_inconsistency(&self, offers: &Offers) -> Option<ConfigError> {
        if !offers.body.follows_motion {
            return None;
        }
        let moves = |key: &str| {
            let why =
                "moves the hub by force, but the body's hub follows a given motion (`drive = \"motion\"`)";
            Some(ConfigError::new(key, why))
        };
        if !self.disturbance.is_empty() {
            return moves("disturbance[0]");
        }
        if let Some(member) = offers.actuators.iter().find(|member| member.offers.pulses) {
            return moves(&member.key);
        }
        if !offers.laws.iter().all(|law| law.offers.is_open) {
            return moves("law");
        }
        let why = "must be \"linear\" where the hub's motion is given";
        offers.body.is_chain.then(|| ConfigError::new("body.panels.kinematics", why))
    }
}
