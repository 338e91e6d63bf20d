//! Events of a run: what began, when it ended, and in which mode of operation.

use serde::Serialize;

/// Kind of an event.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum EventKind {
    /// Stay in a mode of operation.
    Mode,
    /// Actuator at a limit.
    Saturation,
    /// Actuator at a limit, where the target is lost.
    TargetLoss,
    /// Star tracker blinded by a bright body.
    Blinding,
    /// Less than half of the Sun's disc in view.
    Eclipse,
    /// Failure of a sensor or an actuator.
    Failure,
}

impl EventKind {
    /// Returns the words of the kind before its part.
    pub fn words(self) -> &'static str {
        match self {
            Self::Mode => "mode",
            Self::Saturation => "at a limit",
            Self::TargetLoss => "target lost",
            Self::Blinding => "blinded",
            Self::Eclipse => "eclipse",
            Self::Failure => "failure",
        }
    }
}

/// Event of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RunEvent {
    /// Kind.
    pub kind: EventKind,
    /// Mode that begins, part that fails or is blinded, or actuator at its limit; empty for an eclipse.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub part: String,
    /// Condition that began the mode, kind of failure, bright body, or limit; empty if there is none.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub cause: String,
    /// Name of the mode of operation in which it begins.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mode: Option<String>,
    /// Start (s).
    pub from_s: f64,
    /// End (s); the end of the run if it lasts.
    pub to_s: f64,
}

impl RunEvent {
    /// Creates the event of an eclipse from one time to another (s).
    pub(super) fn eclipse([from, to]: [f64; 2]) -> Self {
        Self {
            kind: EventKind::Eclipse,
            part: String::new(),
            cause: String::new(),
            mode: None,
            from_s: from,
            to_s: to,
        }
    }
}
