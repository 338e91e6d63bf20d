//! Failures of actuators within intervals: no output, a stuck output, a wrong scale, or an added error.

use std::num::NonZeroU32;

use flexsc_dynamics::sine::SineTorque;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::{Finite, Time};
use flexsc_numerics::time::Instant;
use flexsc_spacecraft::axes::Axis;
use flexsc_spacecraft::sine::Sine;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::interval::Interval;

/// Declares a kind of failure: its interval, the component that fails, and further keys.
macro_rules! kinds {
    ($($(#[doc = $doc:literal])* $name:ident { $($(#[$meta:meta])* $field:ident: $of:ty),* $(,)? })+) => {
        $(
            $(#[doc = $doc])*
            #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
            #[serde(deny_unknown_fields)]
            pub struct $name {
                /// Start time (s).
                pub from: Time,
                /// End time (s); default: the end of the run.
                #[serde(default, skip_serializing_if = "Option::is_none")]
                pub to: Option<Time>,
                /// Axis that fails, on a body with three; default: all.
                #[serde(default, skip_serializing_if = "Option::is_none")]
                pub about: Option<Axis>,
                /// Wheel that fails, counted from 1; default: all.
                #[serde(default, skip_serializing_if = "Option::is_none")]
                pub wheel: Option<NonZeroU32>,
                /// Gimbal of `control_moment_gyros` that fails, counted from 1; default: all.
                #[serde(default, skip_serializing_if = "Option::is_none")]
                pub gimbal: Option<NonZeroU32>,
                /// Thruster of `jets` that fails; default: all.
                #[serde(default, skip_serializing_if = "Option::is_none")]
                pub thruster: Option<String>,
                $($(#[$meta])* pub $field: $of),*
            }

            impl $name {
                fn scope(&self) -> FailureScope<'_> {
                    let interval = Interval { from: self.from, to: self.to };
                    let (axis, wheel, gimbal) = (self.about, self.wheel, self.gimbal);
                    FailureScope { interval, axis, wheel, gimbal, thruster: self.thruster.as_deref() }
                }
            }
        )+
    };
}

kinds! {
    /// No output.
    Dead {}
    /// A fraction of the commanded output.
    Scaled {
        /// The fraction; a negative one reverses the output.
        factor: Finite,
    }
    /// A constant output, whatever the command.
    Stuck {
        /// The output: a torque (N m); for magnetorquers a moment (A m²), for gimbals a rate (rad/s), for jets a fraction of their thrust; default: the output
        /// when the failure begins.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        at: Option<Finite>,
    }
    /// An error added to the commanded output.
    Added {
        /// Constant part: a torque (N m); for magnetorquers a moment (A m²), for gimbals a rate (rad/s), for jets a thrust (N).
        #[serde(default)]
        constant: Finite,
        /// Sine torques.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        sines: Vec<Sine>,
    }
}

/// A failure of an actuator.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Failure {
    /// No output.
    Dead(Dead),
    /// A fraction of the commanded output.
    Scaled(Scaled),
    /// A constant output, whatever the command.
    Stuck(Stuck),
    /// An error added to the commanded output.
    Added(Added),
}

/// Interval of a failure, and the component that fails.
#[derive(Copy, Clone, Debug)]
pub struct FailureScope<'a> {
    /// Interval of the failure.
    pub interval: Interval,
    /// Axis that fails; `None` for all.
    pub axis: Option<Axis>,
    /// Wheel that fails, counted from 1; `None` for all.
    pub wheel: Option<NonZeroU32>,
    /// Gimbal that fails, counted from 1; `None` for all.
    pub gimbal: Option<NonZeroU32>,
    /// Thruster that fails; `None` for all.
    pub thruster: Option<&'a str>,
}

/// Components of an actuator that failures can name.
#[derive(Clone, Debug)]
pub enum FailingComponent {
    /// Number of axes with an actuator each; magnetorquers count so too.
    Axes(usize),
    /// Number of wheels.
    Wheels(usize),
    /// Number of gimbals.
    Gimbals(usize),
    /// Names of the thrusters.
    Thrusters(Vec<String>),
}

impl Failure {
    /// Returns the interval of the failure and the component that fails.
    pub fn scope(&self) -> FailureScope<'_> {
        match self {
            Self::Dead(failure) => failure.scope(),
            Self::Scaled(failure) => failure.scope(),
            Self::Stuck(failure) => failure.scope(),
            Self::Added(failure) => failure.scope(),
        }
    }

    /// Returns the name of the kind, as in a scenario.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Dead(_) => "dead",
            Self::Scaled(_) => "scaled",
            Self::Stuck(_) => "stuck",
            Self::Added(_) => "added",
        }
    }

    /// Returns the sines that the failure adds.
    pub fn sines(&self) -> &[Sine] {
        if let Self::Added(added) = self { &added.sines } else { &[] }
    }

    /// Checks the failure against an actuator with these components; `turns`: it exerts torques. Returns a key and the
    /// reason.
    pub(super) fn validate(&self, parts: &FailingComponent, turns: bool) -> Option<ConfigError> {
        let FailureScope { interval, axis, wheel, gimbal, thruster } = self.scope();
        if let Some(fault) = interval.validate() {
            return Some(fault);
        }
        let error_at = |key: &str, why: &str| Some(ConfigError::new(format!("{}.{key}", self.kind()), why));
        let (axes, wheels, gimbals, names): (usize, usize, usize, &[String]) = match parts {
            FailingComponent::Axes(axes) => (*axes, 0, 0, &[]),
            FailingComponent::Wheels(wheels) => (0, *wheels, 0, &[]),
            FailingComponent::Gimbals(gimbals) => (0, 0, *gimbals, &[]),
            FailingComponent::Thrusters(names) => (0, 0, 0, names),
        };
        if axis.is_some() && axes < 3 {
            return error_at(
                "about",
                "must be left out for an actuator that does not act about three axes independently",
            );
        }
        if let Some(number) = wheel.filter(|wheel| wheel.get() as usize > wheels) {
            let why = format!("must be one of {wheels} wheels, counted from 1, got {number}");
            let none = "applies only to `[actuator.wheels]`, and this actuator has no wheels";
            return error_at("wheel", if wheels == 0 { none } else { &why });
        }
        if let Some(number) = gimbal.filter(|gimbal| gimbal.get() as usize > gimbals) {
            let why = format!("must be one of {gimbals} gimbals, counted from 1, got {number}");
            let none = "applies only to `[actuator.control_moment_gyros]`, and this actuator has no gimbals";
            return error_at("gimbal", if gimbals == 0 { none } else { &why });
        }
        if let Some(name) = thruster.filter(|name| !names.iter().any(|known| known == name)) {
            let known: Vec<_> = names.iter().map(|name| format!("`{name}`")).collect();
            let why = format!("must be one of the thrusters, {}, got `{name}`", known.join(", "));
            let none = "applies only to `[actuator.jets]`, and this actuator has no jets";
            return error_at("thruster", if names.is_empty() { none } else { &why });
        }
        if (axes == 0 || !turns) && !self.sines().is_empty() {
            let why = "apply only to a torque on the body: wheels, gimbals, jets and magnetorquers can only add a constant; a `[[disturbance]]` can have sines";
            return error_at("sines", why);
        }
        if let FailingComponent::Thrusters(_) = parts {
            return self.thruster_fault();
        }
        None
    }

    /// Checks the failure of a thruster, whose thrust has a fixed direction.
    fn thruster_fault(&self) -> Option<ConfigError> {
        let error_at = |key: &str, why: String| Some(ConfigError::new(format!("{}.{key}", self.kind()), why));
        match self {
            Self::Scaled(failure) if failure.factor.get() < 0.0 => {
                error_at("factor", format!("must be 0 or more for a thruster, got {}", failure.factor.get()))
            }
            Self::Stuck(failure) => {
                let part = failure.at.map(Finite::get).filter(|part| !(0.0..=1.0).contains(part))?;
                error_at("at", format!("must be a fraction of the thrust, from 0 to 1, got {part}"))
            }
            Self::Added(failure) if failure.constant.get() < 0.0 => error_at(
                "constant",
                format!("must be 0 or more for a thruster, got {}", failure.constant.get()),
            ),
            _ => None,
        }
    }
}

/// Failures that act on one value: a torque, a moment, or the fraction of a thrust.
#[derive(Clone, Debug)]
pub(super) struct ActiveFailures {
    /// Failures, and the held value of a stuck one.
    failures: Vec<(Failure, Option<f64>)>,
    /// Times at which a failure begins or ends, latest first.
    change_times: Vec<Instant>,
    /// Factor on the commanded value, and the constant value that replaces it, if any.
    factor: f64,
    fixed: Option<f64>,
    /// Constant added to the value.
    added: f64,
    sines: Vec<SineTorque>,
}

impl ActiveFailures {
    /// Creates the failures that concern a value, none of which has begun; `None` if there are none.
    pub fn new(failures: &[Failure], concerns: impl Fn(&FailureScope<'_>) -> bool) -> Option<Self> {
        let own: Vec<_> = failures.iter().filter(|failure| concerns(&failure.scope())).cloned().collect();
        if own.is_empty() {
            return None;
        }
        let bounds_of = |failure: &Failure| {
            let interval = failure.scope().interval;
            [Some(interval.start()), interval.end()]
        };
        let mut change_times: Vec<Instant> = own.iter().flat_map(bounds_of).flatten().collect();
        change_times.sort_by(|a, b| b.cmp(a));
        change_times.dedup();
        let failures = own.into_iter().map(|failure| (failure, None)).collect();
        Some(Self { failures, change_times, factor: 1.0, fixed: None, added: 0.0, sines: Vec::new() })
    }

    /// Returns the next time at which a failure begins or ends.
    pub fn due(&self) -> Option<Instant> {
        self.change_times.last().copied()
    }

    /// Starts and ends failures at `now`, given the commanded value. Returns true if any started or ended.
    pub fn update(&mut self, now: Instant, commanded: f64) -> bool {
        let before = self.change_times.len();
        while self.change_times.last().is_some_and(|edge| *edge <= now) {
            self.change_times.pop();
        }
        if self.change_times.len() == before {
            return false;
        }
        // Without added errors, which act in addition to a stuck value.
        let torque = self.fixed.unwrap_or(self.factor * commanded);
        (self.factor, self.fixed, self.added) = (1.0, None, 0.0);
        self.sines.clear();
        let mut dead = false;
        for (failure, held) in &mut self.failures {
            if !failure.scope().interval.contains(now) {
                continue;
            }
            match failure {
                Failure::Dead(_) => dead = true,
                Failure::Scaled(failure) => self.factor *= failure.factor.get(),
                Failure::Stuck(failure) => {
                    self.fixed = Some(*held.get_or_insert_with(|| failure.at.map_or(torque, Finite::get)));
                }
                Failure::Added(failure) => {
                    self.added += failure.constant.get();
                    self.sines.extend(failure.sines.iter().map(SineTorque::from));
                }
            }
        }
        if dead {
            self.fixed = Some(0.0);
        }
        true
    }

    /// Returns the output for a commanded value, without the sines.
    pub fn output(&self, commanded: f64) -> f64 {
        self.fixed.unwrap_or(self.factor * commanded) + self.added
    }

    /// Returns the factor on the commanded value; `None` if the output is constant.
    pub fn fraction(&self) -> Option<f64> {
        if self.fixed.is_some() { None } else { Some(self.factor) }
    }

    /// Returns the sines that are added now.
    pub fn sines(&self) -> &[SineTorque] {
        &self.sines
    }

    /// Returns all sines of the failures, each with its interval.
    pub fn scheduled_sines(&self) -> impl Iterator<Item = (SineTorque, Interval)> + '_ {
        let term_of = |(failure, _): &'_ (Failure, Option<f64>)| {
            let interval = failure.scope().interval;
            failure.sines().iter().map(move |sine| (sine.into(), interval)).collect::<Vec<_>>()
        };
        self.failures.iter().flat_map(term_of)
    }
}
