//! Abilities of actuators beyond torques about the axes: momentum storage, pulses, and waveforms of a manoeuvre.

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::time::Instant;
use flexsc_record::{self, Report, ThrusterPulse, Thrusters};

use super::Pulse;

/// Abilities of an actuator; `None` for an ability that it does not have.
#[derive(Copy, Clone, Default)]
pub struct Capabilities<'a> {
    /// Wheels or gyros that store momentum.
    pub momentum: Option<&'a dyn MomentumStorage>,
    /// Jets that act by pulses.
    pub pulses: Option<&'a dyn PulsedActuator>,
    /// Actuators that execute the waveform of a manoeuvre.
    pub waveform: Option<&'a dyn WaveformActuator>,
    /// Back-EMF torque per unit of the rate about the first axis (N m s), and true if the elastic rate is included.
    pub back_emf: (f64, bool),
    /// Last cycle of an actuator that unloads wheels or gyros.
    pub unloading: Option<&'a UnloadingCycle>,
}

/// Cycle of an actuator that unloads wheels or gyros.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct UnloadingCycle {
    /// Start of the cycle; `None` before the first one.
    pub at: Option<Instant>,
    /// Torque on the body that they counteract (N m).
    pub counter: Vector,
}

impl Capabilities<'_> {
    /// Returns the angular momentum stored in the rotors (N m s, body axes); 0 without any.
    pub fn stored_momentum(&self, now: Instant) -> [f64; 3] {
        self.momentum.map_or([0.0; 3], |storage| storage.stored_momentum(now))
    }

    /// Returns the angular momentum stored in the rotors (N m s, body axes) as the control system knows it: of wheels by the
    /// speeds that are available to the drives on a body with this rate (rad/s), and by the estimated rate (rad/s).
    pub fn known_momentum(&self, now: Instant, rate: [f64; 3], estimated: [f64; 3]) -> [f64; 3] {
        self.momentum.map_or([0.0; 3], |storage| storage.known_momentum(now, rate, estimated))
    }

    /// Returns the speeds of reaction wheels relative to a body with this rate (rad/s), as available to the drives; empty
    /// without any.
    pub fn wheel_speeds(&self, now: Instant, rate: [f64; 3]) -> Vec<f64> {
        self.momentum.map_or_else(Vec::new, |storage| storage.wheel_speeds(now, rate))
    }

    /// Returns the log rows of wheels about their own axes, of a body with this rate (rad/s); empty without any.
    pub fn wheels(&self, now: Instant, rate: [f64; 3]) -> Vec<flexsc_record::Wheel> {
        self.momentum.map_or_else(Vec::new, |storage| storage.wheels(now, rate))
    }
}

/// Actuator that stores momentum in rotors.
pub trait MomentumStorage {
    /// Returns the angular momentum stored in the rotors (N m s, body axes).
    fn stored_momentum(&self, now: Instant) -> [f64; 3];

    /// Returns the angular momentum stored in the rotors (N m s, body axes) as [`Capabilities::known_momentum`] does.
    fn known_momentum(&self, now: Instant, _rate: [f64; 3], _estimated: [f64; 3]) -> [f64; 3] {
        self.stored_momentum(now)
    }

    /// Returns the log rows of wheels about their own axes, of a body with this rate (rad/s).
    fn wheels(&self, _now: Instant, _rate: [f64; 3]) -> Vec<flexsc_record::Wheel> {
        Vec::new()
    }

    /// Returns the speeds of reaction wheels relative to a body with this rate (rad/s), as available to the drives.
    fn wheel_speeds(&self, _now: Instant, _rate: [f64; 3]) -> Vec<f64> {
        Vec::new()
    }

    /// Returns the commanded torques of the motors of reaction wheels on their rotors (N m), without their failures and limits;
    /// empty if commands are executed after a delay.
    fn commanded_torques(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Returns the log row of control moment gyros; `None` without any.
    fn gyros(&self, _now: Instant) -> Option<flexsc_record::ControlMomentGyros> {
        None
    }
}

/// Actuator that acts by pulses of jets.
pub trait PulsedActuator {
    /// Returns the current cycle of pulses.
    fn cycle(&self) -> JetCycle {
        let mut cycle = JetCycle::default();
        self.write_cycle(&mut cycle);
        cycle
    }

    /// Writes the activity of the current cycle over that of another one, whose memory is used again.
    fn write_cycle(&self, cycle: &mut JetCycle);

    /// Returns the pulses of the current cycle; `None` if they are known only from the held torques.
    fn executed_pulses(&self) -> Option<Vec<Pulse>> {
        None
    }

    /// Returns the pulses that will be executed in the cycle that begins now.
    fn pending_pulses(&self) -> Vec<Pulse> {
        Vec::new()
    }

    /// Returns the signed on-times about the axes (s) that the last command asked for, of groups of jets that fire once in a period
    /// of the law; `None` of other actuators.
    fn commanded_on_times(&self) -> Option<[f64; 3]> {
        None
    }

    /// Returns the angular impulse of all pulses of the current cycle (N m s, body axes).
    fn cycle_impulse(&self) -> Vector;

    /// Returns the changes of the rigid rates (rad/s) by commands that are not yet executed.
    fn queued_rate_change(&self) -> [f64; 3];
}

/// Actuator of a one-axis body that executes the waveform of a manoeuvre.
pub trait WaveformActuator {
    /// Returns the change of the rate (rad/s) by the waveform between two times (s).
    fn waveform_impulse(&self, from: f64, to: f64) -> f64;
}

/// Jet activity in a cycle.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JetCycle {
    /// Signed on-time about each axis (s).
    pub on: [f64; 3],
    /// Propellant used until the end of the pulses (kg).
    pub fuel: f64,
    /// The propellant of each group about x, y and z, or of each thruster where they act by themselves or may fail (kg).
    pub fuels: Vec<f64>,
    /// Number of pulses since the start, of all axes together.
    pub pulses: u64,
    /// Sign of the group that fires now about each axis; 0 for none.
    pub burning: [f64; 3],
    /// On-time of each thruster (s), for jets that are allocated individually.
    pub each: Vec<f64>,
    /// Current fraction of the thrust of each thruster, for jets that are allocated individually or may fail.
    pub open: Vec<f64>,
    /// Impulse in the cycles of burns until the end of the pulses, along the commanded force (N s).
    pub burn_impulse: f64,
}

impl JetCycle {
    /// Adds the current cycle of jets, and its rows, which are logged if pulses have begun since the last ones.
    pub fn report(jets: &dyn PulsedActuator, report: &mut Report) {
        let (on, fuel_kg, pulses, thrusters) = report.write_value(|cycle: &mut Self| {
            jets.write_cycle(cycle);
            let each = cycle.each.iter().map(|on_s| ThrusterPulse { on_s: *on_s });
            (cycle.on, cycle.fuel, cycle.pulses, each.collect::<Vec<_>>())
        });
        let [roll_on_s, pitch_on_s, yaw_on_s] = on;
        report.add_revision(pulses, flexsc_record::Jets { roll_on_s, pitch_on_s, yaw_on_s, fuel_kg });
        if !thrusters.is_empty() {
            report.add_revision(pulses, Thrusters { thrusters });
        }
    }
}
