//! What the single values of a scenario cannot show to be wrong: keys that do not fit each other.

use super::Scenario;
use super::epoch::nanoseconds_since_1970;
use crate::actuator::{Actuator, Wheel};
use crate::adaptation::Adaptation;
use crate::body::{Body, Drift, Drive, Planar, Profile};
use crate::disturbance::Disturbance;
use crate::document::key;
use crate::estimator::{Estimator, Form};
use crate::law::{Extra, Law};
use crate::quantity::{Finite, Positive, Time};
use crate::sensor::Outage;

impl Scenario {
    /// The first key that does not fit the others, and what is wrong with it.
    pub(super) fn inconsistency(&self) -> Option<(String, String)> {
        let at = |key: &str, why: String| Some((key.to_owned(), why));
        if self.name.contains(['/', '\\']) || self.name.contains(char::is_control) || self.name.len() > 200 {
            let why = "names files: it has at most 200 bytes, no slash and no control character";
            return at("name", why.to_owned());
        }
        if self.epoch.is_some_and(|epoch| nanoseconds_since_1970(&epoch).is_none()) {
            let example = "2026-03-20T14:46:00Z";
            return at("epoch", format!("must be a date and time from 1970 to 2500, such as {example}"));
        }
        // The first day of 2554 is the last whose nanoseconds fit 64 bits.
        let longest = (u64::MAX - self.epoch_ns()) as f64 / 1e9;
        if self.duration.seconds() >= longest {
            let why = format!(
                "must be below {longest:.4e} s, so that the log can count its nanoseconds from 1970, got {:e}",
                self.duration.seconds()
            );
            return at("duration", why);
        }
        if let Some(impossible) = self.impossible() {
            return Some(impossible);
        }
        if let Some((key, why)) = self.log.scene.inconsistency() {
            return at(key, why);
        }
        // The parts of a spatial loop were found to fit each other when it was put together.
        let parts = if self.spatial.is_some() { None } else { self.planar_inconsistency() };
        parts.or_else(|| {
            if self.uncertain.is_empty() {
                return None;
            }
            let mut table = self.clone().with_own_modes().to_table();
            table.remove("uncertain");
            self.uncertain.iter().find_map(|(key, distribution)| {
                let why = distribution.problem(key::get(&table, key))?;
                Some((format!("uncertain.\"{key}\""), why))
            })
        })
    }

    fn planar_inconsistency(&self) -> Option<(String, String)> {
        self.law_inconsistency()
            .or_else(|| self.damping_inconsistency())
            .or_else(|| self.coupling_inconsistency())
            .or_else(|| self.drive_inconsistency())
            .or_else(|| self.estimator_inconsistency())
            .or_else(|| self.adaptation_inconsistency())
    }

    fn law_inconsistency(&self) -> Option<(String, String)> {
        let Law::Relay(relay) = &self.law else { return None };
        let (eps, gamma) = (relay.dead_zone.get(), relay.hysteresis.get());
        let at = |key: &str, why: String| Some((key.to_owned(), why));
        if gamma >= 2.0 * eps {
            let width = 2.0 * eps;
            let why = format!("must be less than the dead zone's width of {width}, got {gamma}");
            return at("law.relay.hysteresis", why);
        }
        if self.manoeuvre.is_some() {
            let why = "holds the angle at 0: with a `[manoeuvre]` the law is `pd` or left out";
            return at("law.relay", why.to_owned());
        }
        let continuous = self.sensor.period().is_none();
        if self.chain.is_some() && continuous {
            let why = "must be \"linear\" for a law `relay`, whose crossings are found in closed form, or the sensor `sampled`";
            return at("body.panels.kinematics", why.to_owned());
        }
        if self.drift.is_some() && continuous {
            let why = "finds its crossings in closed form: with a drift the sensor is `sampled`";
            return at("law.relay", why.to_owned());
        }
        let limited = |wheel: &Wheel| wheel.rotor.as_ref().is_some_and(|rotor| rotor.speed_limit.is_some());
        if matches!(&self.actuator, Actuator::Wheel(wheel) if limited(wheel)) && continuous {
            let why = "is watched at the law's commands: with a law `relay` the sensor is `sampled`";
            return at("actuator.wheel.rotor.speed_limit", why.to_owned());
        }
        None
    }

    /// The key of the damping matrix.
    pub(super) fn damping_key(&self) -> String {
        format!("body.{}.damping_matrix", self.body.kind())
    }

    fn damping_inconsistency(&self) -> Option<(String, String)> {
        let couples = |body: &Planar| !body.damping_matrix.is_empty();
        if self.manoeuvre.is_some() && couples(self.planned_for()) {
            let why = "couples modes, which a `[manoeuvre]` takes each on its own: give it a `model` without";
            return Some((self.damping_key(), why.to_owned()));
        }
        if !couples(&self.model) {
            return None;
        }
        let why = match &self.estimator {
            _ if self.drift.is_some() => "leaves no closed form of modes that drift",
            _ if self.manoeuvre.is_some() && self.actuator == Actuator::Ideal => {
                "moves in closed form under torques that are constant for a while: a `[manoeuvre]` is then executed by \
                 an `[actuator.hold]` or thrusters"
            }
            Some(Estimator::Envelope(_)) => {
                "couples modes, which an `[estimator.envelope]` follows each on its own"
            }
            Some(Estimator::ExtendedKalman(_) | Estimator::UnscentedKalman(_)) => {
                "couples modes, which a filter of their frequencies predicts each on its own: `kalman` knows it"
            }
            _ => return None,
        };
        Some((self.damping_key(), why.to_owned()))
    }

    fn coupling_inconsistency(&self) -> Option<(String, String)> {
        let at = |key: &str, why: String| Some((key.to_owned(), why));
        if let Some(drift) = &self.drift {
            let modes = self.model.modes.len();
            let profiles: Vec<(String, &Profile)> = match drift {
                Drift::Common(profile) => vec![("drift.common".to_owned(), profile)],
                Drift::Each(profiles) if profiles.len() != modes => {
                    return at(
                        "drift.each",
                        format!("must have a profile for each of {modes} modes, got {}", profiles.len()),
                    );
                }
                Drift::Each(profiles) => {
                    let key = |(index, profile)| (format!("drift.each[{index}]"), profile);
                    profiles.iter().enumerate().map(key).collect()
                }
            };
            for (key, profile) in profiles {
                match profile {
                    Profile::Sinusoid(sinusoid) if sinusoid.amplitude.get() >= 0.5 => {
                        let why = format!(
                            "must be below 0.5, so that no frequency vanishes, got {}",
                            sinusoid.amplitude.get()
                        );
                        return at(&format!("{key}.sinusoid.amplitude"), why);
                    }
                    Profile::Table(points) if points.len() < 2 => {
                        return at(
                            &format!("{key}.table"),
                            format!("must have two points or more, got {}", points.len()),
                        );
                    }
                    Profile::Table(points) => {
                        if let Some(index) = points.windows(2).position(|pair| pair[0].time >= pair[1].time) {
                            let (index, time) = (index + 1, points[index + 1].time.get());
                            return at(
                                &format!("{key}.table[{index}].time"),
                                format!("must be later than the one before, got {time}"),
                            );
                        }
                    }
                    _ => {}
                }
            }
        }
        let blind = self.estimator.as_ref().is_none_or(|estimator| estimator.envelope().is_some());
        if matches!(&self.law, Law::Pd(pd) if pd.extra.is_some()) && blind {
            let why = "feeds back the dominant mode, which an `[estimator]` that acts at samples (`truth`, `kalman`, \
                       `extended_kalman`, `unscented_kalman`) tells, and there is none";
            return at("law.pd.extra", why.to_owned());
        }
        if let Law::Pd(pd) = &self.law
            && let Some(Extra::Schedule(points)) = &pd.extra
        {
            if points.is_empty() {
                return at("law.pd.extra.schedule", "must have at least one point".to_owned());
            }
            if let Some(index) = points.windows(2).position(|pair| pair[0].frequency >= pair[1].frequency) {
                let frequency = points[index + 1].frequency.get();
                let key = format!("law.pd.extra.schedule[{}].frequency", index + 1);
                return at(&key, format!("must be above the one before, got {frequency}"));
            }
        }
        let wheel = matches!(self.actuator, Actuator::Wheel(_));
        let key = if wheel { "actuator.wheel" } else { "drift" };
        if !wheel && self.drift.is_none() {
            return None;
        }
        if wheel && self.manoeuvre.is_some() {
            return at(key, "executes a law's samples, not a `[manoeuvre]`".to_owned());
        }
        if self.manoeuvre.is_some() && self.actuator == Actuator::Ideal {
            let why = "leaves no closed form: a `[manoeuvre]` is then executed by an `[actuator.hold]` or thrusters";
            return at(key, why.to_owned());
        }
        if self.chain.is_some() || self.model.drive == Drive::Motion {
            let why = "needs linear modes of a body that a torque drives";
            return at(key, why.to_owned());
        }
        None
    }

    fn drive_inconsistency(&self) -> Option<(String, String)> {
        let at = |key: &str, why: String| Some((key.to_owned(), why));
        let estimates = self.estimator.as_ref().is_some_and(|estimator| estimator.envelope().is_some());
        if let (Some(_), Some(estimator)) = (&self.manoeuvre, &self.estimator) {
            let why = "follows torques that are constant between switchings, not a `[manoeuvre]`";
            return at(&format!("estimator.{}", estimator.kind()), why.to_owned());
        }
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
        let unordered = |outage: Outage| outage.to.is_some_and(|to| outage.from >= to);
        if let Some(index) = self.sensor.faults().iter().position(|fault| unordered(fault.outage())) {
            let why = "must have `from` before `to`".to_owned();
            return at(&format!("sensor.sampled.faults[{index}]"), why);
        }
        if let Actuator::Thrusters(thrusters) = &self.actuator {
            let (period, minimum) = (thrusters.period.seconds(), thrusters.minimum_on.get());
            if minimum > period {
                let why = format!("must be at most the period of {period} s, got {minimum}");
                return at("actuator.thrusters.minimum_on", why);
            }
            if thrusters.quantum.get() > period {
                let why =
                    format!("must be at most the period of {period} s, got {}", thrusters.quantum.get());
                return at("actuator.thrusters.quantum", why);
            }
        }
        if estimates && self.actuator != Actuator::Ideal {
            let why = "must be `ideal` with an `[estimator.envelope]`, which knows the commanded torque only";
            return at("actuator", why.to_owned());
        }
        if self.model.drive == Drive::Motion {
            let moves =
                "moves the hub by force, but the body's hub follows a given motion (`drive = \"motion\"`)";
            if !self.disturbance.is_empty() {
                return at("disturbance[0]", moves.to_owned());
            }
            if matches!(self.actuator, Actuator::Thrusters(_)) {
                return at("actuator.thrusters", moves.to_owned());
            }
            if !matches!(self.law, Law::Open(_)) {
                return at("law", moves.to_owned());
            }
            if self.chain.is_some() {
                let why = "must be \"linear\" where the hub's motion is given";
                return at("body.panels.kinematics", why.to_owned());
            }
        }
        None
    }

    fn estimator_inconsistency(&self) -> Option<(String, String)> {
        let envelope = match self.estimator.as_ref()? {
            Estimator::Envelope(envelope) => envelope,
            estimator => return self.filter_inconsistency(estimator),
        };
        if envelope.form == Form::Truth && envelope.modes.is_some() {
            let why = "of its own have no use for the form `truth`, which reads the body's".to_owned();
            return Some(("estimator.envelope.modes".to_owned(), why));
        }
        let own = envelope.modes.as_ref().map(|modes| ("estimator.envelope", modes.as_slice()));
        let (place, modes) = own.unwrap_or(("body.planar", &self.model.modes));
        modes.iter().enumerate().find(|(_, mode)| mode.damping.get() >= 1.0).map(|(index, mode)| {
            let why = format!("must be below 1 for a mode to have an envelope, got {}", mode.damping.get());
            match (&self.body, own) {
                (Body::Matrices(_) | Body::Panels(_) | Body::Spatial(_), None) => {
                    (format!("body.{}.damping", self.body.kind()), why)
                }
                _ => (format!("{place}.modes[{index}].damping"), why),
            }
        })
    }

    /// What is wrong with an estimator that acts at each sample.
    fn filter_inconsistency(&self, estimator: &Estimator) -> Option<(String, String)> {
        let kind = estimator.kind();
        let at = |key: &str, why: String| Some((format!("estimator.{kind}{key}"), why));
        if self.sensor.period().is_none() {
            return at("", "acts at each sample of a `[sensor.sampled]`, and there is none".to_owned());
        }
        if self.model.modes.is_empty() {
            return at("", "has no modes to estimate: the body has none".to_owned());
        }
        if self.model.drive == Drive::Motion {
            let why = "sees the modes in the hub's angle, and with `drive = \"motion\"` they do not show";
            return at("", why.to_owned());
        }
        if self.chain.is_some() {
            let why = "must be \"linear\" for an estimator of modes";
            return Some(("body.panels.kinematics".to_owned(), why.to_owned()));
        }
        if let Some(modes) = estimator.modes().filter(|modes| modes.len() != self.model.modes.len()) {
            let (found, own) = (modes.len(), self.model.modes.len());
            return at(".modes", format!("must be as many as the body's, {own}, got {found}"));
        }
        let silent = estimator.angle_noise().is_none() && self.sensor.angle_noise() == 0.0;
        if estimator.filters() && silent {
            let why = "must be given where the sensor has neither noise nor a resolution".to_owned();
            return at(".angle_noise", why);
        }
        let [from, to] = estimator.assess();
        if from >= to {
            return at(".assess", format!("must be [from, to] in this order, got [{from}, {to}]"));
        }
        let read = matches!(&self.law, Law::Pd(pd) if pd.extra.is_some());
        if read && estimator.watches_only() {
            return at(".watch_only", "must be left out where `law.pd.extra` reads the filter".to_owned());
        }
        if !read && !estimator.watches_only() {
            let instead = if estimator.filters() {
                "or with `watch_only = true` the filter is assessed and changes nothing"
            } else {
                "and without one the estimator is left out"
            };
            let why =
                format!("is read by nothing: what reads it is an `extra` loop of `[law.pd]`, {instead}");
            return at("", why);
        }
        let (Estimator::ExtendedKalman(filter) | Estimator::UnscentedKalman(filter)) = estimator else {
            return None;
        };
        let [low, high] = filter.bounds.map(Positive::get);
        if low >= high {
            return at(".bounds", format!("must be [low, high] in this order, got [{low}, {high}]"));
        }
        let ratio = filter.ratio.get();
        if !(low..=high).contains(&ratio) {
            return at(".ratio", format!("must lie within the bounds [{low}, {high}], got {ratio}"));
        }
        None
    }

    fn adaptation_inconsistency(&self) -> Option<(String, String)> {
        let Some(Adaptation::RandomSearch(search)) = &self.adaptation else { return None };
        let [low, high] = search.bounds.map(Finite::get);
        let Law::Relay(relay) = &self.law else {
            let why = "adapts the gain k_t of a law `relay`, and there is none".to_owned();
            return Some(("adaptation.random_search".to_owned(), why));
        };
        let gain = relay.k_t.get();
        let bounds = "adaptation.random_search.bounds".to_owned();
        if self.estimator.as_ref().is_none_or(|estimator| estimator.envelope().is_none()) {
            let why = "needs the window means of an `[estimator.envelope]`, and there is none";
            return Some(("adaptation.random_search".to_owned(), why.to_owned()));
        }
        if low >= high {
            return Some((bounds, format!("must be [low, high] in this order, got [{low}, {high}]")));
        }
        if low <= 0.0 || high >= 1.0 {
            let why = format!("must lie between 0 and 1, as k_t itself, got [{low}, {high}]");
            return Some((bounds, why));
        }
        if !(low..=high).contains(&gain) {
            let why = format!("must lie within the adaptation's bounds [{low}, {high}], got {gain}");
            return Some(("law.relay.k_t".to_owned(), why));
        }
        None
    }
}
