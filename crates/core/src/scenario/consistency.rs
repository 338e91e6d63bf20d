//! Consistency of the keys of a scenario with each other.

use flexsc_control::actuator::{ActuatorKind, AssignedMember, Wheel};
use flexsc_control::estimator::EstimatorKind;
use flexsc_control::law::{AttitudeProfile, AttitudeTarget, Extra, LawKind};
use flexsc_dynamics::axis_model::{AxisModel, CommandedQuantity};
use flexsc_formats::document::ConfigError;
use flexsc_formats::document::key;
use flexsc_numerics::attitude::vector;
use flexsc_numerics::quantity::Time;
use flexsc_spacecraft::body::BodyAxes;
use flexsc_spacecraft::body::craft::RateLimit;
use flexsc_spacecraft::disturbance::{Disturbance, Pulses};

use super::epoch::nanoseconds_since_1970;
use super::{Scenario, meant};

impl Scenario {
    /// Checks that the keys are consistent with each other.
    ///
    /// # Errors
    /// Fails with the first inconsistent key, and the reason.
    pub(super) fn validate(&self) -> Result<(), ConfigError> {
        self.inconsistency().map_or(Ok(()), Err)
    }

    fn inconsistency(&self) -> Option<ConfigError> {
        let at = |key: &str, why: String| Some(ConfigError::new(key, why));
        if self.name.contains(['/', '\\']) || self.name.contains(char::is_control) || self.name.len() > 200 {
            let why = "is used for file names: at most 200 bytes, no slash, no control character";
            return at("name", why.to_owned());
        }
        if self.epoch.is_some_and(|epoch| nanoseconds_since_1970(&epoch).is_none()) {
            let example = "2026-03-20T14:46:00Z";
            return at("epoch", format!("must be a date and time from 1970 to 2500, such as {example}"));
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
        if let Some(pointing) = &self.reference.pointing
            && let Some(fault) = pointing.fault(self.axis_count())
        {
            return Some(fault.within("reference.pointing"));
        }
        // The compatibility of three-axis parts was checked before.
        let parts = match self.model.axes() {
            BodyAxes::One(body) => self.planar_inconsistency(body),
            BodyAxes::Three(_) => self.spatial_inconsistency(),
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

    fn spatial_inconsistency(&self) -> Option<ConfigError> {
        let estimator = self.estimator.as_ref();
        self.validate_drives()
            .or_else(|| self.schedule_inconsistency())
            .or_else(|| self.timing_inconsistency())
            .or_else(|| self.rate_inconsistency())
            .or_else(|| self.validate_drift())
            .or_else(|| self.validate_envelope())
            .or_else(|| self.validate_filter(estimator?))
            .or_else(|| self.validate_adaptation())
    }

    /// Checks that a spacecraft does not rotate faster than the limit of its modal model.
    fn rate_inconsistency(&self) -> Option<ConfigError> {
        let craft = self.model.craft()?;
        let RateLimit { rate: limit, why } = craft.rate_limit()?;
        let start = vector(&craft.spatial.rate).norm();
        if start > limit {
            let why = format!("must be below {limit:.3e} rad/s together, {why}, got {start:.3e}");
            return Some(ConfigError::new("spacecraft.rate", why));
        }
        let own = matches!(&self.law, LawKind::PhasePlane(law) if !law.targets.is_empty());
        let key = if own { "law.phase_plane.targets" } else { "target" };
        let way = AttitudeProfile::new(self.targets(), &self.orbit_environment(), &self.model.free_modes());
        let fast = |(index, target): (usize, &AttitudeTarget)| {
            let planned = || Some(("duration", way.fastest(index).filter(|_| target.command.is_some())?));
            let (of, rate) = target.fastest().or_else(planned).filter(|(_, rate)| *rate > limit)?;
            let why = format!("must be below {limit:.3e} rad/s, {why}, got {rate}");
            Some(ConfigError::new(format!("{key}[{index}].{of}"), why))
        };
        self.targets().iter().enumerate().find_map(fast)
    }

    fn planar_inconsistency(&self, body: &AxisModel) -> Option<ConfigError> {
        self.law_inconsistency()
            .or_else(|| self.damping_inconsistency(body))
            .or_else(|| self.schedule_inconsistency())
            .or_else(|| self.validate_drift())
            .or_else(|| self.coupling_inconsistency(body))
            .or_else(|| self.timing_inconsistency())
            .or_else(|| self.drive_inconsistency(body))
            .or_else(|| self.validate_estimator(body))
            .or_else(|| self.validate_adaptation())
    }

    fn law_inconsistency(&self) -> Option<ConfigError> {
        let LawKind::Relay(_) = &self.law else { return None };
        let at = |key: &str, why: String| Some(ConfigError::new(key, why));
        if self.manoeuvre.is_some() {
            let why = "holds the angle at 0: with a `[manoeuvre]` use the law `pd`, or none";
            return at("law.relay", why.to_owned());
        }
        let continuous = self.study.sample_period.is_none();
        if self.model.chain().is_some() && continuous {
            let why = "must be \"linear\" for a law `relay`, whose crossings are found in closed form; or use a `[sensor.sampled]`";
            return at("body.panels.kinematics", why.to_owned());
        }
        if self.drift.is_some() && continuous {
            let why = "finds its crossings in closed form: with a drift it needs a `[sensor.sampled]`";
            return at("law.relay", why.to_owned());
        }
        let limited = |wheel: &Wheel| wheel.rotor.as_ref().is_some_and(|rotor| rotor.speed_limit.is_some());
        if let Some((_, key)) = self.actuator.flywheel().filter(|(wheel, _)| limited(wheel) && continuous) {
            let why = "is checked at the law's commands: with a law `relay` it needs a `[sensor.sampled]`";
            return at(&format!("{key}.rotor.speed_limit"), why.to_owned());
        }
        None
    }

    /// Returns the key of the damping matrix.
    pub(super) fn damping_key(&self) -> String {
        format!("body.{}.damping_matrix", self.body_kind())
    }

    fn damping_inconsistency(&self, body: &AxisModel) -> Option<ConfigError> {
        if self.manoeuvre.as_ref().is_some_and(|manoeuvre| manoeuvre.planned_for(body).is_coupled()) {
            let why = "couples modes, and a `[manoeuvre]` treats each mode on its own: give it a `model` without this matrix";
            return Some(ConfigError::new(self.damping_key(), why));
        }
        if !body.is_coupled() {
            return None;
        }
        let why = match &self.estimator {
            _ if self.drift.is_some() => "has no closed form for modes that drift",
            _ if self.manoeuvre.is_some()
                && self.actuator.has_kind(|kind| matches!(kind, ActuatorKind::Ideal(_))) =>
            {
                "needs torques that are constant for a while: execute the `[manoeuvre]` by an `[actuator.hold]` or \
                 thrusters"
            }
            Some(EstimatorKind::Envelope(_)) => {
                "couples modes, and an `[estimator.envelope]` treats each mode on its own"
            }
            Some(EstimatorKind::ExtendedKalman(_) | EstimatorKind::UnscentedKalman(_)) => {
                "couples modes, and a filter of their frequencies predicts each mode on its own: use `kalman`"
            }
            _ => return None,
        };
        Some(ConfigError::new(self.damping_key(), why))
    }

    fn coupling_inconsistency(&self, body: &AxisModel) -> Option<ConfigError> {
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
        if self.manoeuvre.is_some() && self.actuator.has_kind(|kind| matches!(kind, ActuatorKind::Ideal(_))) {
            let why = "has no closed form: execute the `[manoeuvre]` by an `[actuator.hold]` or thrusters";
            return at(key, why.to_owned());
        }
        if self.model.chain().is_some() || body.drive == CommandedQuantity::Motion {
            let why = "needs linear modes of a body that a torque drives";
            return at(key, why.to_owned());
        }
        None
    }

    /// Checks that the points of gain schedules are in order.
    fn schedule_inconsistency(&self) -> Option<ConfigError> {
        (0..self.axis_count()).find_map(|axis| {
            let LawKind::Pd(pd) = self.law.about(axis) else { return None };
            let Some(Extra::Schedule(points)) = &pd.extra else { return None };
            let at = |key: &str, why: String| {
                Some(ConfigError::new(format!("{}.extra.schedule{key}", self.law_key(axis)), why))
            };
            if points.is_empty() {
                return at("", "must have at least one point".to_owned());
            }
            let index = points.windows(2).position(|pair| pair[0].frequency >= pair[1].frequency)?;
            let frequency = points[index + 1].frequency.get();
            at(
                &format!("[{}].frequency", index + 1),
                format!("must be above the one before, got {frequency}"),
            )
        })
    }

    /// Checks the order of times, and times against their periods.
    fn timing_inconsistency(&self) -> Option<ConfigError> {
        let at = |key: &str, why: String| Some(ConfigError::new(key, why));
        let ordered = |d: &Disturbance| d.to.is_none_or(|to| d.from < to);
        if let Some(index) = self.disturbance.iter().position(|d| !ordered(d)) {
            let Disturbance { from, to, .. } = &self.disturbance[index];
            let (from, to) = (from.get(), to.map_or(f64::NAN, Time::get));
            return at(
                &format!("disturbance[{index}].to"),
                format!("must be later than `from`, {from} s, got {to}"),
            );
        }
        let heldless = |d: &Disturbance| d.noise.get() > 0.0 && d.period.is_none();
        if let Some(index) = self.disturbance.iter().position(heldless) {
            let why = "must be given: how long (s) each draw of the noise is held".to_owned();
            return at(&format!("disturbance[{index}].period"), why);
        }
        for (index, disturbance) in self.disturbance.iter().enumerate() {
            if let Some(Pulses { period, on }) = disturbance.pulse.filter(|pulse| pulse.on >= pulse.period) {
                let (period, on) = (period.seconds(), on.seconds());
                let why = format!("must be shorter than the period of {period} s, got {on}");
                return at(&format!("disturbance[{index}].pulse.on"), why);
            }
        }
        if let Some(fault) = self.validate_failures() {
            return Some(fault);
        }
        for member in self.actuator.members() {
            let ActuatorKind::Thrusters(thrusters) = &*member.kind else { continue };
            let at = |key: &str, why: String| Some(ConfigError::new(format!("{}.{key}", member.key), why));
            let (period, minimum) = (thrusters.period.seconds(), thrusters.minimum_on.get());
            if minimum > period {
                let why = format!("must be at most the period of {period} s, got {minimum}");
                return at("minimum_on", why);
            }
            if thrusters.quantum.get() > period {
                let why =
                    format!("must be at most the period of {period} s, got {}", thrusters.quantum.get());
                return at("quantum", why);
            }
        }
        None
    }

    fn drive_inconsistency(&self, body: &AxisModel) -> Option<ConfigError> {
        let at = |key: &str, why: String| Some(ConfigError::new(key, why));
        let estimates = self.estimator.as_ref().is_some_and(|estimator| estimator.envelope().is_some());
        if estimates
            && self.manoeuvre.is_some()
            && self.actuator.has_kind(|kind| matches!(kind, ActuatorKind::Ideal(_)))
        {
            let why = "follows torques that are constant for a while: execute the `[manoeuvre]` by an `[actuator.hold]`, \
                       thrusters or a wheel";
            return at("estimator.envelope", why.to_owned());
        }
        if let Some((wheel, key)) = self.actuator.flywheel()
            && estimates
            && wheel.back_emf.get() > 0.0
        {
            let why = "must be 0 with an `[estimator.envelope]`, which follows each mode on its own";
            return at(&format!("{key}.back_emf"), why.to_owned());
        }
        if body.drive == CommandedQuantity::Motion {
            let moves =
                "moves the hub by force, but the body's hub follows a given motion (`drive = \"motion\"`)";
            if !self.disturbance.is_empty() {
                return at("disturbance[0]", moves.to_owned());
            }
            let thrusters = |member: &AssignedMember<'_>| matches!(&*member.kind, ActuatorKind::Thrusters(_));
            if let Some(member) = self.actuator.members().into_iter().find(thrusters) {
                return at(&member.key, moves.to_owned());
            }
            if !matches!(self.law, LawKind::Open(_)) {
                return at("law", moves.to_owned());
            }
            if self.model.chain().is_some() {
                let why = "must be \"linear\" where the hub's motion is given";
                return at("body.panels.kinematics", why.to_owned());
            }
        }
        None
    }
}
