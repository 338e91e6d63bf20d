//! Unloading of wheels: beyond a momentum jets or magnetorquers push the body the other way, and the wheels, which hold it,
//! slow down.
//!
//! With the momentum h of the wheels and the field B the moment of magnetorquers is k h x B/B²: its torque is -k times the part
//! of h across B (\[Wertz78\]). What is along the field waits for the orbit to turn it: over an orbit h falls at the mean rate
//! k (1 - <b b'>), with b the field's direction.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Actuate, Actuator, Demand, Jets, Magnetorquers};
use crate::attitude::Vector;
use crate::document::Fault;
use crate::quantity::{NonNegative, Positive, Time};
use crate::time::{Instant, Span};

/// How an actuator of a list unloads the wheels of the list.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Unloads {
    /// Total momentum of the wheels above which unloading begins (N m s).
    pub above: Positive,
    /// Total momentum below which it ends (N m s).
    pub below: NonNegative,
    /// For jets: the largest mean torque about each axis over a cycle (N m), which the wheels counteract.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub torque: Option<Positive>,
    /// For magnetorquers: the fraction of the momentum perpendicular to the field that they remove per second (1/s).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gain: Option<Positive>,
    /// For magnetorquers: the period of their commands (s).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub period: Option<Span>,
    /// For magnetorquers: time of their first command (s); default: 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub phase: Option<Time>,
}

/// Unloading of the wheels by jets or by magnetorquers, within the wheels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Unloading {
    /// Total momentum of the wheels above which unloading begins (N m s).
    pub above: Positive,
    /// Total momentum below which it ends (N m s).
    pub below: NonNegative,
    /// Largest mean torque of the jets about each axis over a cycle (N m), which the wheels counteract.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub torque: Option<Positive>,
    /// Jets for unloading, with their own period and without a delay.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub jets: Option<Jets>,
    /// Magnetorquers for unloading.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub magnetorquers: Option<Magnetorquers>,
    /// For magnetorquers: the fraction of the momentum perpendicular to the field that they remove per second (1/s).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gain: Option<Positive>,
    /// For magnetorquers: the period of their commands (s).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub period: Option<Span>,
}

impl Unloading {
    /// How they unload.
    pub(super) fn how(&self) -> Unloads {
        let Self { above, below, torque, gain, period, .. } = *self;
        Unloads { above, below, torque, gain, period, phase: None }
    }

    /// By what they are unloaded.
    pub(super) fn by(&self) -> Actuator {
        let jets = self.jets.clone().map(Actuator::Jets);
        jets.or_else(|| self.magnetorquers.clone().map(Actuator::Magnetorquers)).unwrap_or_default()
    }

    /// What does not fit of by what they are unloaded: a key within the unloading, and why.
    pub fn inconsistency(&self) -> Option<Fault> {
        let at = |key: &str, why: &str| Some(Fault::new(key, why));
        match (&self.jets, &self.magnetorquers) {
            (None, None) => at("jets", "must be given, or `magnetorquers`"),
            (Some(_), Some(_)) => {
                at("magnetorquers", "must be left out with `jets`: only one of the two can unload the wheels")
            }
            _ => None,
        }
    }
}

impl Unloads {
    /// What of it does not fit the actuator that unloads: a key, and why, whether the key is within the actuator.
    pub fn fault(&self, kind: &Actuator) -> Option<(Fault, bool)> {
        let (above, below) = (self.above.get(), self.below.get());
        let at = |key: &str, why: String| Some((Fault::new(key, why), false));
        if below >= above {
            return at("below", format!("must be less than `above`, {above} N m s, got {below}"));
        }
        let of_torquers = [
            ("gain", self.gain.is_some(), true),
            ("period", self.period.is_some(), true),
            ("phase", self.phase.is_some(), false),
        ];
        match kind {
            Actuator::Jets(jets) => {
                if let Some((key, ..)) = of_torquers.into_iter().find(|(_, given, _)| *given) {
                    return at(key, "applies only to `magnetorquers`: leave it out".to_owned());
                }
                if self.torque.is_none() {
                    return at("torque", "must be given with `jets`".to_owned());
                }
                jets_fault(jets).map(|fault| (fault, true))
            }
            Actuator::Magnetorquers(_) => {
                if self.torque.is_some() {
                    return at("torque", "applies only to `jets`: leave it out".to_owned());
                }
                let (key, ..) = of_torquers.into_iter().find(|(_, given, must)| *must && !given)?;
                at(key, "must be given with `magnetorquers`".to_owned())
            }
            other => {
                let why =
                    "is for `jets` or `magnetorquers`, which can unload `wheels` or `control_moment_gyros`";
                Some((Fault::new("", format!("{why}, got `{}`", other.kind())), false))
            }
        }
    }
}

/// A key of jets that does not fit the unloading of wheels, and why.
fn jets_fault(jets: &Jets) -> Option<Fault> {
    let at = |key: &str, why: String| Some(Fault::new(key, why));
    let Some(period) = jets.period.map(Span::seconds) else {
        return at("period", "must be given: the law's cycles are those of the wheels".to_owned());
    };
    if jets.delay > 0 {
        return at("delay", format!("must be 0 for jets that unload wheels, got {}", jets.delay));
    }
    for (key, value) in [("minimum_on", jets.minimum_on.get()), ("quantum", jets.quantum.get())] {
        if value > period {
            return at(key, format!("must be at most the period of {period} s, got {value}"));
        }
    }
    None
}

/// An actuator that unloads wheels, at work.
#[derive(Clone, Debug)]
pub(super) struct Unloader {
    pub actuator: Box<dyn Actuate>,
    /// Momenta at which it begins and ends (N m s).
    limits: [f64; 2],
    /// Of magnetorquers, the gain (1/s).
    gain: Option<f64>,
    /// Largest mean torque of jets (N m).
    torque: f64,
    period: Span,
    /// When the next cycle begins.
    next: Instant,
    active: bool,
    /// What the wheels hold against (N m).
    mean: Vector,
}

impl Unloader {
    /// An actuator before it first acts.
    pub fn new(unloads: &Unloads, kind: &Actuator, actuator: Box<dyn Actuate>) -> Self {
        let (period, phase) = match kind {
            Actuator::Jets(jets) => (jets.period, jets.phase),
            _ => (unloads.period, unloads.phase),
        };
        Self {
            actuator,
            limits: [unloads.above.get(), unloads.below.get()],
            gain: unloads.gain.map(Positive::get),
            torque: unloads.torque.map_or(f64::INFINITY, Positive::get),
            period: period.unwrap_or(Span::TICK),
            next: super::first(phase),
            active: false,
            mean: Vector::zeros(),
        }
    }

    /// When it changes what it does.
    pub fn due(&self) -> Option<Instant> {
        self.actuator.due().into_iter().chain([self.next]).min()
    }

    /// Whether laws command it themselves: magnetorquers, by magnetic moments.
    pub fn is_taken(&self, demands: &[Demand]) -> bool {
        self.gain.is_some() && demands.iter().any(|demand| matches!(demand, Demand::Moment(_)))
    }

    /// Does what laws demand, of magnetorquers that they command.
    pub fn take(&mut self, now: Instant, demands: &[Demand], rigid: [f64; 3]) {
        self.actuator.command(now, demands, rigid);
        (self.active, self.mean) = (false, Vector::zeros());
    }

    /// Begins a cycle if one is due: as long as the wheels have too much momentum (N m s), it takes of it what it may. Returns
    /// what they have to hold against from now on (N m), if that changes.
    pub fn serve(
        &mut self,
        now: Instant,
        rigid: [f64; 3],
        stored: Vector,
        demands: &[Demand],
    ) -> Option<Vector> {
        let begins = self.next == now;
        let taken = self.is_taken(demands);
        if begins {
            self.next = now + self.period;
            if !taken {
                let [above, below] = self.limits;
                self.active = stored.norm() > if self.active { below } else { above };
                let wanted = self.wanted(stored);
                self.actuator.command(now, &wanted.data.0[0].map(Demand::Torque), [0.0; 3]);
            }
        }
        self.actuator.serve(now, rigid);
        if !begins || taken {
            return None;
        }
        let mean = if self.gain.is_some() {
            Vector::from_fn(|axis, _| self.actuator.torque(axis))
        } else {
            self.actuator.impulse() / self.period.seconds()
        };
        // Of jets the mean torque is 0 most of the time; the field of magnetorquers is another one each time.
        (std::mem::replace(&mut self.mean, mean) != mean || self.gain.is_some()).then_some(mean)
    }

    /// The torque that shall take momentum from wheels (N m).
    fn wanted(&self, stored: Vector) -> Vector {
        if !self.active {
            return Vector::zeros();
        }
        if let Some(gain) = self.gain {
            return stored * -gain;
        }
        let wanted = stored / -self.period.seconds();
        // The direction stays where one axis has more than the jets may give.
        let largest = wanted.amax();
        if largest > self.torque { wanted * (self.torque / largest) } else { wanted }
    }
}
