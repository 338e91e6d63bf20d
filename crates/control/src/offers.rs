//! Offers: what each part of a scenario provides to the others, on which their requirements depend.

use std::borrow::Cow;

use flexsc_numerics::time::Span;

use crate::requirement::Requirements;
use crate::state_estimate::EstimateNeeds;

/// Offers of all parts of a scenario.
#[derive(Clone, Debug)]
pub struct Offers {
    /// Offers of the body and of its motion.
    pub body: BodyOffers,
    /// Offers of the environment.
    pub environment: EnvironmentOffers,
    /// Law about each axis; of stages or modes, all that act about it.
    pub laws: Vec<AxisLaw>,
    /// Name of the law's kind.
    pub law_kind: &'static str,
    /// Shortest period of the laws; `None` if they decide at events.
    pub law_period: Option<Span>,
    /// Offers of all sensors together.
    pub sensors: SensorOffers,
    /// Sampling period of sensors and estimator; `None` if the angle is measured at every instant.
    pub sample_period: Option<Span>,
    /// Offers of each actuator, including those that unload wheels.
    pub actuators: Vec<ActuatorMember>,
    /// Offers of the estimator, if there is one.
    pub estimator: Option<EstimatorOffers>,
}

/// Offers of a body.
#[derive(Clone, Debug, Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is a capability of its own")]
pub struct BodyOffers {
    /// Number of axes: 1 or 3.
    pub axes: usize,
    /// Name of the kind of body.
    pub kind: &'static str,
    /// True if the body is a `[spacecraft]`.
    pub is_spacecraft: bool,
    /// True if the elastic modes of a three-axis body act back on its rotation.
    pub is_two_way: bool,
    /// True if a three-axis body rotates by small angles, in closed form.
    pub has_small_angles: bool,
    /// Number of elastic modes.
    pub modes: usize,
    /// Key and damping ratio of the first mode at or above critical damping.
    pub overdamped: Option<(String, f64)>,
    /// True if sections of panels turn by any angle, without elastic modes.
    pub is_chain: bool,
    /// True if the hub follows a given motion.
    pub follows_motion: bool,
    /// Key of the damping matrix, if there is one that couples modes.
    pub damping_matrix: Option<String>,
    /// True if natural frequencies drift.
    pub drifts: bool,
    /// True if appendages turn on drives or hinges.
    pub turns_appendages: bool,
    /// Names of the points of such appendages, whose motion is not computed.
    pub moving_points: Vec<String>,
    /// True if there is a planned manoeuvre.
    pub has_manoeuvre: bool,
}

/// Offers of an environment.
#[derive(Copy, Clone, Debug, Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is an offer of its own")]
pub struct EnvironmentOffers {
    /// True if there is a magnetic field.
    pub magnetic_field: bool,
    /// True if the direction to the Sun is known.
    pub sun: bool,
    /// True if the body is on an orbit.
    pub orbit: bool,
    /// True if the position of the Moon is known, which follows from the date.
    pub moon: bool,
    /// True if the orbit is far below that of the Moon.
    pub is_below_moon: bool,
}

/// Law about an axis.
#[derive(Clone, Debug)]
pub struct AxisLaw {
    /// Axis about which the law acts: 0, or 0 to 2 for roll, pitch and yaw.
    pub axis: usize,
    /// Key of the law.
    pub key: String,
    /// Offers of the law.
    pub offers: LawOffers,
    /// Kinds of the actuators that execute the law's commands; `None` for all.
    pub actuators: Option<Vec<String>>,
}

impl AxisLaw {
    /// Returns true if actuators of a kind execute torques or accelerations that the law commands.
    pub fn drives(&self, kind: &str) -> bool {
        let is_selected = self.actuators.as_ref().is_none_or(|kinds| kinds.iter().any(|own| own == kind));
        is_selected && !self.offers.is_open && !self.offers.commands_moments
    }
}

/// Offers of a law about an axis.
#[derive(Copy, Clone, Debug)]
#[expect(clippy::struct_excessive_bools, reason = "each is a capability of its own")]
pub struct LawOffers {
    /// Period of the commands; `None` if the law decides at events.
    pub period: Option<Span>,
    /// Estimates that the law reads.
    pub needs: EstimateNeeds,
    /// True if the law is a relay, whose torque changes only with its state.
    pub is_switching: bool,
    /// True if the law commands nothing.
    pub is_open: bool,
    /// True if the law decides where the motion crosses a boundary.
    pub finds_crossings: bool,
    /// True if the law plans pulses of a single actuator, which begin with its periods.
    pub plans_pulses: bool,
    /// True if the law commands magnetic moments.
    pub commands_moments: bool,
    /// True if the law has states between which it switches.
    pub has_states: bool,
    /// True if the law acts about three axes together.
    pub is_three_axis: bool,
    /// True if the law also computes in single precision.
    pub has_single_precision: bool,
}

impl LawOffers {
    /// Returns the offers of a law with this period, which reads these estimates and has no further properties.
    pub fn new(period: Option<Span>, needs: EstimateNeeds) -> Self {
        Self {
            period,
            needs,
            is_switching: false,
            is_open: false,
            finds_crossings: false,
            plans_pulses: false,
            commands_moments: false,
            has_states: false,
            is_three_axis: false,
            has_single_precision: false,
        }
    }

    /// Returns true if the law reads estimates of the body's motion.
    pub fn reads_motion(&self) -> bool {
        !matches!(self.needs, EstimateNeeds::Nothing | EstimateNeeds::Field)
    }
}

/// Offers of the sensors of a scenario together.
#[derive(Copy, Clone, Debug, Default)]
pub struct SensorOffers {
    /// Number of sensors that measure the body's motion.
    pub motion_sensors: usize,
    /// Number of those that measure the magnetic field or a direction.
    pub vector_sensors: usize,
    /// True if a sensor gives the motion at every instant.
    pub is_continuous: bool,
    /// True if a sensor measures the magnetic field.
    pub magnetic_field: bool,
    /// Shortest sampling period, under the law; `None` if all sensors are continuous.
    pub period: Option<Span>,
    /// Standard deviation of the measured angle (rad), including quantisation.
    pub angle_noise: f64,
}

/// Place of a law in a scenario.
#[derive(Copy, Clone, Debug)]
pub struct LawPlace {
    /// Axis about which the law acts.
    pub axis: usize,
    /// True if the other axes have laws of their own.
    pub is_per_axis: bool,
}

/// Place of an actuator among those of a scenario.
#[derive(Copy, Clone, Debug)]
pub struct ActuatorPlace<'a> {
    /// Number of all actuators.
    pub members: usize,
    /// Key of the first earlier actuator of the same kind.
    pub twin: Option<&'a str>,
    /// True if an earlier actuator of the same kind acts about a common axis.
    pub meets_twin: bool,
    /// Share of the laws' demand about each axis.
    pub shares: [f64; 3],
    /// True if the actuator executes commands of the law, and does not unload wheels.
    pub executes: bool,
}

impl ActuatorPlace<'_> {
    /// Adds the requirement that there is no earlier actuator of the same kind.
    pub fn require_single(&self, needs: &mut Requirements, why: &str) {
        needs.require_with(self.twin.is_none(), "", || {
            format!("are there already, as `{}`: {why}", self.twin.unwrap_or_default())
        });
    }
}

/// Limit of the torque of an actuator about an axis.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub enum TorqueLimit {
    /// No limit.
    #[default]
    Unlimited,
    /// Constant largest torque.
    Constant,
    /// Largest torque that changes during a run.
    Varying,
}

/// Offers of an actuator.
#[derive(Copy, Clone, Debug, Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is a capability of its own")]
pub struct ActuatorOffers {
    /// Limit of the torque about each axis.
    pub limits: [TorqueLimit; 3],
    /// True if the torque consists of pulses.
    pub pulses: bool,
    /// Period of its own in which commands are executed; `None` with immediate execution, or with the law.
    pub period: Option<Span>,
    /// True if commands are executed after a delay that laws do not see.
    pub is_delayed: bool,
    /// True if the waveform of a manoeuvre is executed as it is, at every instant.
    pub follows_waveform: bool,
    /// True if the torque changes between commands, with the magnetic field.
    pub turns_with_field: bool,
    /// True if the torque changes between commands, with the gimbal angles.
    pub turns_with_gimbals: bool,
    /// True if there are reaction wheels about axes of their own.
    pub has_reaction_wheels: bool,
    /// Number of reaction wheels about axes of their own.
    pub wheels: usize,
    /// True if the speeds of wheels are known.
    pub has_wheel_speeds: bool,
    /// True if thrusters at points of the body push it.
    pub has_jets: bool,
    /// True if the length of each thruster's pulses is programmed by itself, not by groups.
    pub programs_pulses: bool,
    /// True if commands are also computed in single precision.
    pub has_single_precision: bool,
}

/// Actuator of a scenario: its offers, and its share of the demand.
#[derive(Clone, Debug)]
pub struct ActuatorMember {
    /// Key of the actuator.
    pub key: String,
    /// Offers of the actuator.
    pub offers: ActuatorOffers,
    /// Share of the laws' demand about each axis; 0 for an actuator that unloads wheels.
    pub shares: [f64; 3],
    /// Name of the actuator's kind.
    pub kind: &'static str,
    /// True if the actuator is an entry of the list, not one within another.
    pub is_listed: bool,
    /// True if the actuator executes commands of the law, and does not unload wheels.
    pub executes: bool,
}

/// Offers of an estimator.
#[derive(Copy, Clone, Debug, Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is a capability of its own")]
pub struct EstimatorOffers {
    /// True if the estimator only monitors the envelope, and acts without samples.
    pub is_envelope: bool,
    /// True if the estimator runs for assessment only, so that the law does not read it.
    pub is_assessed_only: bool,
    /// True if the dominant mode is estimated.
    pub dominant_mode: bool,
    /// True if the rates of all elastic modes are estimated.
    pub elastic_rates: bool,
    /// True if several sensors are fused into one state estimate.
    pub fuses_sensors: bool,
    /// True if rates only are estimated, and angles left as measured.
    pub estimates_rates_only: bool,
    /// True if a Kalman filter processes measured angles and rates.
    pub filters_measurements: bool,
    /// True if the estimator has no use without a law that reads the estimates.
    pub needs_reader: bool,
    /// True if the estimator also computes in single precision.
    pub has_single_precision: bool,
}

impl BodyOffers {
    /// Returns true if the motion of a point of the body is computed; that of points on appendages is not where these turn.
    pub fn has_motion_at(&self, point: &str) -> bool {
        !self.moving_points.iter().any(|moving| moving == point)
    }
}

impl Offers {
    /// Returns the offers to a law whose commands only actuators of the selected kinds execute.
    pub fn serving_law(&self, selects: impl Fn(&str) -> bool) -> Cow<'_, Self> {
        let is_idle = |member: &ActuatorMember| member.executes && !selects(member.kind);
        if !self.actuators.iter().any(is_idle) {
            return Cow::Borrowed(self);
        }
        let mut offers = self.clone();
        offers
            .actuators
            .iter_mut()
            .filter(|member| is_idle(member))
            .for_each(|member| member.shares = [0.0; 3]);
        Cow::Owned(offers)
    }

    /// Returns the offers to an actuator of a kind, with the laws whose commands it executes.
    pub fn driving_actuator(&self, kind: &str) -> Cow<'_, Self> {
        if self.laws.iter().all(|law| law.actuators.is_none()) {
            return Cow::Borrowed(self);
        }
        let mut offers = self.clone();
        offers.laws.retain(|law| law.drives(kind));
        Cow::Owned(offers)
    }

    /// Returns the first actuator that executes a share of the demand about an axis.
    pub fn serving(&self, axis: usize) -> Option<&ActuatorMember> {
        self.actuators.iter().find(|member| member.shares[axis] > 0.0)
    }

    /// Returns true if an actuator of the list, or one within another, satisfies `is`.
    pub fn has_actuator(&self, is: impl Fn(&ActuatorOffers) -> bool) -> bool {
        self.actuators.iter().any(|member| is(&member.offers))
    }

    /// Returns true if an actuator of the list itself satisfies `is`.
    pub fn lists_actuator(&self, is: impl Fn(&ActuatorOffers) -> bool) -> bool {
        self.actuators.iter().any(|member| member.is_listed && is(&member.offers))
    }

    /// Returns true if an actuator executes a manoeuvre's waveform as it is.
    pub fn follows_waveform(&self) -> bool {
        self.body.has_manoeuvre && self.lists_actuator(|offers| offers.follows_waveform)
    }

    /// Adds the requirement of three axes; `instead` is an alternative for one, after a colon.
    pub fn require_three_axes(&self, needs: &mut Requirements, key: &str, instead: &str) {
        let why = format!("is for a body with three axes, and the body is `{}`{instead}", self.body.kind);
        needs.require_axes(self.body.axes == 3, key, &why);
    }
}
