//! Burns of jets: intervals in which a force is commanded, which the thrusters give beside the torques.

use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::{Vector, vector};
use flexsc_numerics::quantity::{Finite, Time};
use flexsc_numerics::simplex::LinearProgramme;
use flexsc_numerics::time::{Instant, Span};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::ThrusterEffect;

/// Force commanded in an interval.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Burn {
    /// Start (s).
    pub from: Time,
    /// End (s).
    pub to: Time,
    /// Force on the body, in body axes (N).
    pub force: [Finite; 3],
}

impl Burn {
    /// Returns the commanded impulse over a cycle (N s).
    fn impulse(&self, cycle: Instant, period: Span) -> Vector {
        let at = |time: Time| Instant::START + Span::from_seconds(time.get());
        let (from, to) = (at(self.from).max(cycle), at(self.to).min(cycle + period));
        if from < to { vector(&self.force) * to.since(from).seconds() } else { Vector::zeros() }
    }

    /// Checks burns, which must follow one another; returns a key within them and the reason.
    pub fn validate(burns: &[Self]) -> Option<ConfigError> {
        for (index, burn) in burns.iter().enumerate() {
            let at = |key: &str, why: String| Some(ConfigError::new(format!("[{index}].{key}"), why));
            if burn.to <= burn.from {
                let (from, to) = (burn.from.get(), burn.to.get());
                return at("to", format!("must be later than `from`, {from} s, got {to}"));
            }
            if let Some(before) = index.checked_sub(1).map(|before| &burns[before])
                && burn.from < before.to
            {
                let (from, end) = (burn.from.get(), before.to.get());
                return at(
                    "from",
                    format!("must be at or after the end of the burn before, {end} s, got {from}"),
                );
            }
            if vector(&burn.force).norm() == 0.0 {
                return at("force", "must not be zero".to_owned());
            }
        }
        None
    }

    /// Checks that thrusters can push the body along each force without turning it, and that no force exceeds their
    /// thrust; returns the key and the reason.
    pub(super) fn capability_fault(burns: &[Self], nozzles: &[ThrusterEffect]) -> Option<ConfigError> {
        let thrust: f64 = nozzles.iter().map(|nozzle| nozzle.thrust).sum();
        let size = |burn: &Self| vector(&burn.force).norm();
        if let Some(index) = burns.iter().position(|burn| size(burn) > thrust) {
            let why = format!(
                "must be at most {thrust} N, the thrust of all thrusters, got {}",
                size(&burns[index])
            );
            return Some(ConfigError::new(format!("burns[{index}].force"), why));
        }
        let costs: Vec<f64> = nozzles.iter().map(|nozzle| nozzle.flow).collect();
        let cannot_push = |burn: &Self| {
            let force = vector(&burn.force);
            let direction = force.normalize();
            let along = |nozzle: &ThrusterEffect| nozzle.push.force.dot(&direction);
            let column =
                |nozzle: &ThrusterEffect| nozzle.push.torque.iter().copied().chain([along(nozzle)]).collect();
            let columns = nozzles.iter().map(column).collect();
            let programme = LinearProgramme::new(4, columns, vec![1.0; nozzles.len()]);
            programme.cheapest(&[0.0, 0.0, 0.0, force.norm()], &costs).1 <= 1e-9
        };
        let index = burns.iter().position(cannot_push)?;
        let why = "must have a direction in which the thrusters can push the body without turning it";
        Some(ConfigError::new(format!("burns[{index}].force"), why))
    }
}

/// Linear programme of the on-times of a cycle in which a force is commanded: the torque first, then the force as closely
/// as the torque leaves it.
#[derive(Clone, Debug)]
pub(super) struct BurnProgramme {
    burns: Vec<Burn>,
    programme: LinearProgramme,
    costs: Vec<f64>,
    thrusters: usize,
}

/// Cost of a missing force relative to that of the propellant of all thrusters: any thruster that gives it is cheaper.
const MISSING_FORCE: f64 = 1e4;

impl BurnProgramme {
    /// Creates the programme of burns with cycles of this length (s).
    pub fn new(burns: &[Burn], nozzles: &[ThrusterEffect], period: f64) -> Self {
        let thrust: f64 = nozzles.iter().map(|nozzle| nozzle.thrust).sum();
        let flow: f64 = nozzles.iter().map(|nozzle| nozzle.flow).sum();
        let thruster = |nozzle: &ThrusterEffect| {
            nozzle.push.torque.iter().chain(nozzle.push.force.iter()).copied().collect()
        };
        // The force that is missing or too large along each axis: at most all that is commanded and all that is given.
        let difference = |index: usize| {
            let sign = if index.is_multiple_of(2) { 2.0 } else { -2.0 };
            (0..6).map(|row| if row == 3 + index / 2 { sign * thrust } else { 0.0 }).collect()
        };
        let columns: Vec<Vec<f64>> = nozzles.iter().map(thruster).chain((0..6).map(difference)).collect();
        let costs = nozzles.iter().map(|nozzle| nozzle.flow).chain([MISSING_FORCE * flow; 6]).collect();
        Self {
            burns: burns.to_vec(),
            thrusters: nozzles.len(),
            programme: LinearProgramme::new(6, columns, vec![period; nozzles.len() + 6]),
            costs,
        }
    }

    /// Returns the impulse commanded over a cycle (N s), and its direction; `None` outside of the burns.
    pub fn demand(&self, cycle: Instant, period: Span) -> Option<(Vector, Vector)> {
        let impulses = self.burns.iter().map(|burn| burn.impulse(cycle, period));
        let impulse = impulses.reduce(|sum, next| sum + next)?;
        let size = impulse.norm();
        (size > 0.0).then(|| (impulse, impulse / size))
    }

    /// Returns the on-times (s) for an angular impulse that the thrusters can give (N m s) and an impulse (N s).
    pub fn on_times(&self, angular: &Vector, impulse: &Vector) -> Vec<f64> {
        let demand: Vec<f64> = angular.iter().chain(impulse.iter()).copied().collect();
        let (mut times, _) = self.programme.cheapest(&demand, &self.costs);
        times.truncate(self.thrusters);
        times
    }
}
