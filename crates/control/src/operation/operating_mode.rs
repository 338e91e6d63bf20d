//! Mode of operation as written in a scenario.

use std::collections::BTreeMap;

use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::{Finite, Positive, Time};
use flexsc_numerics::time::Span;
use flexsc_spacecraft::environment::{GroundSite, OrbitEnvironment};
use flexsc_spacecraft::manoeuvre::SlewProfile;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::condition::{ConditionFault, Expression, Vocabulary};
use super::mode_condition::ModeCondition;
use super::parser::{index_of_kind, listed};
use crate::actuator::ActuatorName;
use crate::law::{AttitudeProfile, AttitudeTarget, Frame, LawKind, PointedAxis, SkyDirection, Stage};

/// A mode of operation: the law that acts in it, with what it uses, and when it ends. A run begins in the first mode.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OperatingMode {
    /// Name: letters, digits, `_` and `-`.
    pub name: String,
    /// The law: any but `stages`.
    pub law: LawKind,
    /// Target attitude of a body with three axes, from the start of the mode on; default: the target stays, and
    /// `[[target]]` holds if no mode has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub target: Option<ModeTarget>,
    /// Kinds of the sensors in use, such as `["gyro", "star_tracker"]`, or `star_tracker[1]` for the second of a kind; default:
    /// all. The others give no readings.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sensors: Option<Vec<String>>,
    /// Kinds of the `[[actuator]]` entries that execute the commands of the law, such as `["wheels"]`; default: all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub actuators: Option<Vec<ActuatorName>>,
    /// Ends of the mode: the first whose condition is met ends it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub leave: Vec<ModeExit>,
}

/// An end of a mode.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ModeExit {
    /// Name of the mode that follows.
    pub to: String,
    /// Condition, such as `"rate < 2e-3 and time > 60"`.
    pub when: ModeCondition,
    /// Numbers of the condition by name, such as `{ slow = 2e-3 }` for `"rate < slow"`, in SI units: keys for campaigns and
    /// searches.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub numbers: BTreeMap<String, Finite>,
    /// Time for which the condition has to hold without a break (s).
    #[serde(default, rename = "for", skip_serializing_if = "is_zero")]
    pub dwell: Time,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for a reference")]
fn is_zero(time: &Time) -> bool {
    *time == Time::ZERO
}

/// The target attitude of a mode: yaw, then pitch about the rotated y axis, then roll about the twice rotated x axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ModeTarget {
    /// Frame relative to which the attitude is given; default: inertial.
    #[serde(default, skip_serializing_if = "is_inertial")]
    pub frame: Frame,
    /// Axis of the body that is exactly along a direction: with `secondary`, roll, pitch and yaw are relative to the attitude
    /// that these two give.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub primary: Option<PointedAxis>,
    /// Axis of the body that is as near to a direction as `primary` lets it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub secondary: Option<PointedAxis>,
    /// Roll (rad).
    #[serde(default)]
    pub roll: Finite,
    /// Pitch (rad).
    #[serde(default)]
    pub pitch: Finite,
    /// Yaw (rad).
    #[serde(default)]
    pub yaw: Finite,
    /// Largest acceleration of the slew about one axis to it (rad/s²); default: the reference jumps.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub acceleration: Option<Positive>,
    /// Largest rate of the slew (rad/s); no limit by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_limit: Option<Positive>,
    /// How the rate of the slew rises and falls; default: trapezoid.
    #[serde(default, skip_serializing_if = "is_trapezoid")]
    pub profile: SlewProfile,
    /// Start of the slew; default: the estimated attitude after a law that does not control the attitude, else the reference.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slew_from: Option<SlewStart>,
}

/// Start of the slew to the target of a mode.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SlewStart {
    /// Reference attitude at the start of the mode.
    Reference,
    /// Estimated attitude of the body at the start of the mode.
    Estimate,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for a reference")]
fn is_inertial(frame: &Frame) -> bool {
    *frame == Frame::Inertial
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for a reference")]
fn is_trapezoid(profile: &SlewProfile) -> bool {
    *profile == SlewProfile::Trapezoid
}

impl ModeTarget {
    /// Returns the target of the start of a run.
    pub fn at_start(&self) -> AttitudeTarget {
        let Self { frame, primary, secondary, roll, pitch, yaw, acceleration, rate_limit, profile, .. } =
            *self;
        AttitudeTarget {
            frame,
            primary,
            secondary,
            roll,
            pitch,
            yaw,
            acceleration,
            rate_limit,
            profile,
            ..AttitudeTarget::INERTIAL
        }
    }

    /// Checks the target against the sky; returns a key within it and the reason.
    pub fn fault(&self, sky: &OrbitEnvironment) -> Option<ConfigError> {
        if self.slew_from.is_some() && self.acceleration.is_none() {
            let why = "needs an `acceleration`: without one the reference jumps to the target";
            return Some(ConfigError::new("slew_from", why));
        }
        let fault = AttitudeProfile::validate(&[self.at_start()], sky, &[])?;
        Some(ConfigError {
            key: fault.key.trim_start_matches("[0]").trim_start_matches('.').to_owned(),
            ..fault
        })
    }

    /// Returns the ground site to which the target points an axis, if there is one.
    pub fn site(&self) -> Option<GroundSite> {
        [self.primary, self.secondary].into_iter().flatten().find_map(|axis| match axis.along {
            SkyDirection::Site(site) => Some(site),
            _ => None,
        })
    }
}

impl ModeExit {
    /// Returns the span for which the condition has to hold.
    pub fn dwell(&self) -> Span {
        Span::from_seconds(self.dwell.get())
    }
}

impl OperatingMode {
    /// Returns the indices of the sensors in use among the sensors of these kinds; `None` for all.
    ///
    /// # Errors
    /// The index of a name of no sensor, and the reason.
    pub fn sensor_indices(&self, kinds: &[&str]) -> Result<Option<Vec<usize>>, (usize, String)> {
        let Some(names) = &self.sensors else { return Ok(None) };
        let mut indices = Vec::new();
        for (place, name) in names.iter().enumerate() {
            let of_kind = kinds.iter().enumerate().filter(|(_, kind)| **kind == name.as_str());
            let mut named: Vec<usize> = of_kind.map(|(index, _)| index).collect();
            if named.is_empty() {
                named.extend(index_of_kind(name, kinds));
            }
            if named.is_empty() {
                return Err((place, format!("must be one of the sensors, {}, got `{name}`", listed(kinds))));
            }
            indices.extend(named);
        }
        Ok(Some(indices))
    }

    /// Returns the law with its actuators, as those of a stage.
    pub fn stage(&self) -> Stage {
        Stage { from: Time::ZERO, law: self.law.clone(), actuators: self.actuators.clone() }
    }

    /// Checks the names, conditions and sensors of modes against each other and the kinds of the sensors; returns a key
    /// within the list and the reason.
    pub fn fault(modes: &[Self], sensors: &[&str]) -> Option<ConfigError> {
        let known = Vocabulary {
            sensors: sensors.to_vec(),
            modes: modes.iter().map(|mode| mode.name.as_str()).collect(),
            ..Vocabulary::default()
        };
        modes.iter().enumerate().find_map(|(index, mode)| {
            let named = known.modes[..index].contains(&mode.name.as_str());
            mode.validate_mode(&known, named).map(|fault| fault.within(&format!("[{index}]")))
        })
    }

    /// Checks the name, the sensors and the leave conditions of the mode; returns the inconsistent key and the reason.
    fn validate_mode(&self, known: &Vocabulary<'_>, is_taken: bool) -> Option<ConfigError> {
        let at = |key: &str, why: String| Some(ConfigError::new(key, why));
        let valid = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
        if self.name.is_empty() || !self.name.chars().all(valid) {
            let why = format!("must be a name of letters, digits, `_` and `-`, got `{}`", self.name);
            return at("name", why);
        }
        if is_taken {
            return at("name", format!("is that of a mode before, `{}`", self.name));
        }
        if let Err((place, why)) = self.sensor_indices(&known.sensors) {
            return at(&format!("sensors[{place}]"), why);
        }
        self.leave.iter().enumerate().find_map(|(index, exit)| {
            exit.fault(known, &self.name).map(|fault| fault.within(&format!("leave[{index}]")))
        })
    }
}

impl ModeExit {
    /// Reads the condition with its numbers.
    ///
    /// # Errors
    /// The first part that is no condition, and the reason.
    pub fn read(&self, known: &Vocabulary<'_>) -> Result<Expression, ConditionFault> {
        self.when.parse(&Vocabulary { numbers: Some(&self.numbers), ..known.clone() })
    }

    /// Returns why the condition cannot have a number of this name.
    fn number_fault(&self, name: &str) -> Option<String> {
        let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let begins = name.starts_with(|c: char| c.is_ascii_alphabetic());
        if !begins || !name.chars().all(is_word) || ["and", "or", "not"].contains(&name) {
            return Some("must have a name of letters, digits and `_` that begins with a letter".to_owned());
        }
        let is_used = self.when.text().split(|c: char| !is_word(c)).any(|word| word == name);
        (!is_used).then(|| format!("is not in the condition, `{}`", self.when.text()))
    }

    fn fault(&self, known: &Vocabulary<'_>, of: &str) -> Option<ConfigError> {
        if !known.modes.contains(&self.to.as_str()) {
            let why = format!("must name one of the modes, {}, got `{}`", listed(&known.modes), self.to);
            return Some(ConfigError::new("to", why));
        }
        if self.to == of {
            return Some(ConfigError::new("to", format!("must name another mode, got `{of}` itself")));
        }
        if let Some((name, why)) = self.numbers.keys().find_map(|name| Some((name, self.number_fault(name)?)))
        {
            return Some(ConfigError::new(format!("numbers.{name}"), why));
        }
        let read = match self.read(known) {
            Ok(read) => read,
            Err(ConditionFault { part, why }) => {
                return Some(ConfigError { part: Some(part), ..ConfigError::new("when", why) });
            }
        };
        let is_mixed = read.reads_truth() && read.leaves().iter().any(|(quantity, _)| !quantity.is_truth());
        is_mixed.then(|| {
            let why = "joins the truth, which is tested at exact instants, with what the law knows at its samples: use one of \
                       them";
            ConfigError::new("when", why)
        })
    }
}
