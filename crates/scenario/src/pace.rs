//! The time that runs take on one core, estimated from what acts in them. `benches/costs.py` compares it with measured times: the
//! constants are those of an ordinary core, to a factor of two for the shipped scenarios.

use flexsc_control::actuator::FiringMethod;
use flexsc_dynamics::three_axis::Surroundings;
use flexsc_spacecraft::environment::{FieldModel, Sun};

use super::Scenario;

/// The key of the steps of a rotation.
pub const TURNS: &str = "duration";
/// Key of the steps of a rotation that torques of the environment shorten.
pub(super) const PUSHES: &str = "environment";
/// Ends of the keys of the steps of machines, each of which has its own period.
pub(super) const MACHINE_STEPS: [&str; 3] = ["density.upper", "density.table", "lines.frequency"];
/// Key to which the switchings of a relay law are attributed.
pub(super) const SWITCHES: &str = "law.relay.hysteresis";

/// A time (s), and what each mode adds.
type Pace = (f64, f64);

/// A step of an integration, or of a relay law between crossings.
pub const STEP: Pace = (3e-7, 4e-8);
/// A step of a chain of panels, whose equations are integrated.
const CHAIN: Pace = (6e-7, 1e-7);
/// A search for a crossing of a relay law whose modes a wheel or a drift couples.
const COUPLED_RELAY: Pace = (8e-6, 1.5e-6);
/// Number of steps that the search for one switching of a relay law takes in a cycle as long as the modes' periods, and
/// (`SHORT_SEARCH`) in one that is much shorter.
const SEARCH: f64 = 1.5;
const SHORT_SEARCH: f64 = 3.4;
/// A sample or a decision of a law about one axis, and one of a wheel's law that no sensor samples.
const ONE_AXIS: Pace = (6e-7, 3e-7);
const UNSAMPLED_WHEEL: Pace = (1.2e-6, 6e-7);
/// A radian of the fastest mode that a wheel couples, beyond one between two events.
const COUPLED_RADIAN: Pace = (3e-7, 4e-7);
/// A sample or a decision of laws about three axes: of a body at rest, of one that turns, and a step of its turn.
const AT_REST: Pace = (6e-7, 5e-8);
const TURNING: Pace = (1.2e-6, 5e-8);
const TURN: Pace = (1.5e-6, 5e-8);
/// A sample, a decision or a step of a turn in surroundings that act on the body, with appendages that are driven or bend in
/// sunlight there, with wheels in bearings, with those that whirl on mounts, with appendages on hinges, under sinusoidal torques, and
/// under the loads of machines.
const SURROUNDED: Pace = (3e-6, 1e-6);
const DRIVEN: Pace = (3e-6, 3e-6);
const BEARINGS: Pace = (1e-6, 6.5e-7);
const WHIRL: Pace = (2e-5, 5e-6);
const HINGES: Pace = (7e-6, 7e-6);
const SINES: Pace = (1.5e-6, 5e-7);
const MACHINES: Pace = (3e-6, 5e-7);
/// Times (s) that are added to a step in surroundings: for wheels in bearings, spherical harmonics of the magnetic field (constant part,
/// and part per square of the degree), drag, pressure of sunlight from a Sun that moves, plates on appendages that turn.
const BEARINGS_THERE: f64 = 6e-6;
const HARMONICS: (f64, f64) = (5e-7, 1.2e-8);
const DRAG_THERE: f64 = 1e-6;
const MOVING_SUN: f64 = 3e-6;
const TURNING_PLATES: f64 = 1e-5;
/// Degree of the harmonics unless a scenario gives one.
const DEGREE: u32 = 13;
/// Rate (rad/s) below which swings of a body that holds its attitude in surroundings do not shorten steps.
pub(super) const QUIET_RATE: f64 = 1e-3;
/// Length of steps of such a body, relative to steps that resolve its modes.
pub(super) const QUIET_STEPS: f64 = 64.0;
/// A look at the motion within an exposure (s), and a cycle of individually commanded jets.
const LOOK_S: f64 = 2e-6;
const ALLOCATION_S: f64 = 5e-6;

impl Scenario {
    /// The time of a run without a log (s), in which these keys act so often.
    pub(super) fn run_seconds(&self, acts: &[(String, f64)]) -> f64 {
        let modes = self.mode_count() as f64;
        let takes = |(base, each): Pace| base + modes * each;
        let (mut turns, mut looks, mut events, mut windows, mut switchings) = (0.0, 0.0, 0.0_f64, 0.0, 0.0);
        let mut machines = 0.0;
        for (key, count) in acts {
            match key {
                _ if *key == TURNS || *key == PUSHES => turns += count,
                _ if *key == SWITCHES => switchings += count,
                _ if key.ends_with(".exposure") => looks += count,
                _ if key.ends_with(".window") => windows += count,
                _ if MACHINE_STEPS.iter().any(|name| key.ends_with(name)) => machines += count,
                // What acts with one period acts at the same instants.
                _ => events = events.max(*count),
            }
        }
        let estimator = self.estimator.as_ref();
        let sample = estimator.map_or(0.0, |of| of.sample_seconds(self.axis_count(), modes));
        let filtered = events * sample + windows * takes(STEP);
        if self.axis_count() == 3 {
            let jets = self.actuator.jets().map(|(jets, _)| jets);
            let programmed = jets.filter(|jets| jets.allocation == FiringMethod::LeastPropellant);
            let cycles = programmed.map_or(0.0, |jets| {
                jets.period.map_or(events, |period| self.duration.seconds() / period.seconds())
            });
            let allocated = cycles * ALLOCATION_S;
            let moves = match self.loaded_step() {
                Some(stride) => (events + machines + turns) * (takes(stride) + self.environment_seconds()),
                // A step that an event ends is part of the event.
                None if turns > 0.0 => events * takes(TURNING) + (turns - events).max(0.0) * takes(TURN),
                None => events * takes(AT_REST),
            };
            return moves + looks * LOOK_S + allocated + filtered;
        }
        let coupled = self.drift.is_some() || self.actuator.flywheel().is_some();
        let is_sampled = self.study.sample_period.is_some();
        let moves = if self.model.chain().is_some() {
            turns * takes(CHAIN)
        } else if self.law.offers().finds_crossings && is_sampled {
            events * takes(STEP)
        } else if self.law.offers().finds_crossings {
            let strides = turns * takes(if coupled { COUPLED_RELAY } else { STEP });
            let fastest = self.model.frequencies().fold(0.0, f64::max);
            let is_short = switchings > fastest * self.duration.seconds();
            strides.max(switchings * if is_short { SHORT_SEARCH } else { SEARCH } * takes(STEP))
        } else if self.actuator.flywheel().is_some() && !is_sampled {
            events * takes(UNSAMPLED_WHEEL) + (turns - events).max(0.0) * takes(COUPLED_RADIAN)
        } else {
            events * takes(ONE_AXIS)
        };
        moves + filtered
    }

    /// Returns the time (s) that wheels in bearings and parts of the environment add to a step in surroundings.
    fn environment_seconds(&self) -> f64 {
        let Some(around) = &self.environment else { return 0.0 };
        let field = around.magnetic_field.as_ref();
        let harmonic = field.filter(|field| field.model(self.epoch.is_some()) != FieldModel::Dipole);
        let degree = harmonic.map(|field| f64::from(field.degree.unwrap_or(DEGREE)));
        let pressure = around.solar_pressure.as_ref();
        let on_appendage = pressure.is_some_and(|of| of.plates.iter().any(|plate| plate.appendage.is_some()))
            || around.drag.as_ref().is_some_and(|of| of.plates.iter().any(|plate| plate.appendage.is_some()));
        let adds = |applies: bool, seconds: f64| if applies { seconds } else { 0.0 };
        adds(!self.study.bearings.is_empty(), BEARINGS_THERE)
            + degree.map_or(0.0, |degree| HARMONICS.0 + HARMONICS.1 * degree * degree)
            + adds(around.drag.is_some(), DRAG_THERE)
            + adds(pressure.is_some() && around.sun == Some(Sun::Epoch), MOVING_SUN)
            + adds(on_appendage, TURNING_PLATES)
    }

    /// Returns the pace of a step of a three-axis body on which more acts than constant torques; `None` otherwise.
    fn loaded_step(&self) -> Option<Pace> {
        if self.study.hinges() > 0 {
            return Some(HINGES);
        }
        if let Some(around) = &self.study.surroundings {
            let is_driven = self.study.drives.is_some() || !around.thermal_forces().is_empty();
            return Some(if is_driven { DRIVEN } else { SURROUNDED });
        }
        let bearings = if self.study.carried_rotors.is_empty() { BEARINGS } else { WHIRL };
        let bearings = (!self.study.bearings.is_empty()).then_some(bearings);
        let sines = (self.largest_sine_frequency() > 0.0).then_some(SINES);
        let is_shaken = self.disturbance.iter().any(|own| own.density.is_some() || own.lines.is_some());
        let all = bearings.into_iter().chain(sines).chain(is_shaken.then_some(MACHINES));
        all.reduce(|one, other| (one.0 + other.0, one.1 + other.1))
    }
}
