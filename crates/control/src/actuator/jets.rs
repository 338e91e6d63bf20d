//! Jets: thrusters at points of a three-axis body, fired in groups about the axes or individually.

use flexsc_dynamics::three_axis_model::ThreeAxisModel;
use flexsc_dynamics::wrench::ForceEffect;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::{AXES, vector};
use flexsc_numerics::quantity::{Finite, NonNegative, Positive, Time};
use flexsc_numerics::time::Span;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    Actuator, ActuatorAuthority, ActuatorPlacement, ActuatorSpec, AllocatedJets, AxisActuatorContext, Burn,
    FailingComponent, Failure, Ideal, JetsState, PulseWidth, jet_allocation,
};
use crate::offers::{ActuatorOffers, ActuatorPlace, Offers};
use crate::requirement::{OFF_HUB, Requirements};

/// Standard gravity (m/s²), to which the specific impulse refers.
const G_0: f64 = 9.806_65;

/// Thrusters that are either on or off (\[Timakov14\]).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Jets {
    /// Shortest pulse (s); a shorter one is not given, and does not carry over to the next.
    #[serde(default)]
    pub minimum_on: NonNegative,
    /// Quantum of a pulse's length (s); 0 for none.
    #[serde(default)]
    pub quantum: NonNegative,
    /// Period of the pulses (s); default: that of the law, which must then be one for all axes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub period: Option<Span>,
    /// Time of the first cycle of pulses, for jets with a `period` (s); default: 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub phase: Option<Time>,
    /// Specific impulse (s): thrust per unit of propellant weight flow.
    pub specific_impulse: Positive,
    /// Delay from a command to its pulses in whole cycles: 0, or 1 if computing it takes a cycle.
    #[serde(default)]
    pub delay: u32,
    /// The thrusters.
    pub thrusters: Vec<Thruster>,
    /// How the demand is converted into pulses; default: `groups`.
    #[serde(default, skip_serializing_if = "is_default")]
    pub allocation: FiringMethod,
    /// For `least_propellant`: whether the forces of the pulses must cancel.
    #[serde(default, skip_serializing_if = "is_default")]
    pub force_free: bool,
    /// For `least_propellant`: burns, in which a force is commanded beside the torques.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub burns: Vec<Burn>,
    /// For `groups`: the thrusters that act together about each axis about which the jets act.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub groups: Option<ThrusterGroups>,
    /// Intervals in which the jets fail, all or the one named `thruster`: `stuck` at 1 fires all the time, and
    /// `added` is a leak (N).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faults: Vec<Failure>,
}

/// How the demand on the jets is converted into pulses.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "Firing")]
pub enum FiringMethod {
    /// One pulse per axis, by one group of thrusters.
    #[default]
    Groups,
    /// One pulse per thruster, with the lengths that meet the demand with the least propellant.
    LeastPropellant,
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// One thruster.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Thruster {
    /// Name.
    pub name: String,
    /// Point of the structure on which it is mounted.
    pub point: String,
    /// Position of its nozzle relative to that point (m).
    #[serde(default)]
    pub offset: [Finite; 3],
    /// Direction of the force on the body, of length 1.
    pub direction: [Finite; 3],
    /// Thrust (N).
    pub thrust: Positive,
}

/// The groups: for each axis, names of the thrusters that turn the body about it one way and the other.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Groups")]
pub struct ThrusterGroups {
    /// About x; needed if the jets act about it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub roll: Option<GroupPair>,
    /// About y; needed if the jets act about it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pitch: Option<GroupPair>,
    /// About z; needed if the jets act about it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub yaw: Option<GroupPair>,
}

impl ThrusterGroups {
    /// Returns the groups of roll, pitch and yaw.
    pub fn each(&self) -> [Option<&GroupPair>; 3] {
        [&self.roll, &self.pitch, &self.yaw].map(Option::as_ref)
    }
}

/// The two groups of an axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Pair")]
pub struct GroupPair {
    /// Thrusters whose torque is positive.
    pub plus: Vec<String>,
    /// Thrusters whose torque is negative.
    pub minus: Vec<String>,
}

/// Effect of a group while it fires.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GroupEffect {
    /// Total force, torque and modal forces of the group.
    pub push: ForceEffect,
    /// Propellant flow (kg/s).
    pub flow: f64,
    /// Absolute acceleration about the group's axis, m = |M_a|/J_aa (rad/s²).
    pub acceleration: f64,
}

impl GroupEffect {
    /// Returns two groups without effect on a body with `modes` modes.
    pub(super) fn without_effect(modes: usize) -> [Self; 2] {
        let effect = ForceEffect { forces: vec![0.0; modes], ..ForceEffect::default() };
        [(); 2].map(|()| Self { push: effect.clone(), ..Self::default() })
    }
}

/// Effect of a thruster while it is open.
#[derive(Clone, Debug, PartialEq)]
pub struct ThrusterEffect {
    /// Force, torque and modal forces of the thruster.
    pub push: ForceEffect,
    /// Propellant flow (kg/s).
    pub flow: f64,
    /// Thrust (N).
    pub thrust: f64,
}

impl ActuatorSpec for Jets {
    fn start(&self, settings: &[AxisActuatorContext], on: &ActuatorPlacement<'_>) -> Box<dyn Actuator> {
        let Some(groups) = on.groups else { return Ideal::default().start(settings, on) };
        let fitted = (groups, on.nozzles);
        match self.allocation {
            FiringMethod::Groups => Box::new(JetsState::new(self, fitted, on.period)),
            FiringMethod::LeastPropellant => Box::new(AllocatedJets::new(self, fitted, on.period)),
        }
    }

    fn authority(&self, axis: usize, _: f64, on: &ActuatorPlacement<'_>) -> ActuatorAuthority {
        let groups = on.groups.map(|groups| &groups[axis]);
        let largest = |sign: usize| groups.map_or(f64::INFINITY, |groups| groups[sign].acceleration);
        let period = self.period.unwrap_or(on.period);
        ActuatorAuthority {
            accelerations: [largest(0), largest(1)],
            width: self.pulse_width(),
            delay: f64::from(self.delay) * period.seconds(),
        }
    }

    fn offers(&self) -> ActuatorOffers {
        ActuatorOffers {
            pulses: true,
            has_jets: true,
            programs_pulses: self.allocation == FiringMethod::LeastPropellant,
            ..ActuatorOffers::default()
        }
    }

    fn requires(&self, place: &ActuatorPlace<'_>, offers: &Offers, needs: &mut Requirements) {
        // With wheels about three axes, the wheels are reported.
        if !offers.lists_actuator(|actuator| actuator.has_reaction_wheels) {
            let instead = ": `[actuator.thrusters]` push a body with one angle";
            offers.require_three_axes(needs, "", instead);
        }
        place.require_single(needs, "write all thrusters in one `jets`");
        let moves = |thruster: &Thruster| !offers.body.has_motion_at(&thruster.point);
        if let Some(index) = self.thrusters.iter().position(moves) {
            needs.require(false, &format!("thrusters[{index}].point"), OFF_HUB);
        }
        needs.require(
            place.executes || self.burns.is_empty(),
            "burns",
            "must be left out of jets that unload wheels: they execute no commands",
        );
        if place.executes {
            self.require_cycle(offers, needs);
        }
    }

    fn period(&self) -> Option<Span> {
        self.period
    }

    fn phase(&self) -> Option<Time> {
        self.phase
    }

    fn failures(&self) -> &[Failure] {
        &self.faults
    }

    fn failing_components(&self, _: usize) -> FailingComponent {
        FailingComponent::Thrusters(self.names())
    }
}

impl Jets {
    /// Adds the requirements on the cycle of jets that execute commands.
    fn require_cycle(&self, offers: &Offers, needs: &mut Requirements) {
        let driving: Vec<_> = offers.laws.iter().filter(|law| law.drives("jets")).collect();
        let mut periods = driving.iter().map(|law| law.offers.period);
        let first = periods.next().or(offers.laws.first().map(|law| law.offers.period)).flatten();
        let Some(period) = self.period.or(first) else {
            let why = "must be given with a law that has none of its own";
            return needs.require(false, "period", why);
        };
        needs.require(
            self.period.is_some() || periods.all(|other| other == first),
            "period",
            "must be given where the laws of the axes have periods that differ",
        );
        let period = period.seconds();
        for (key, value) in [("minimum_on", self.minimum_on.get()), ("quantum", self.quantum.get())] {
            needs.require_with(value <= period, key, || {
                let whose = if self.period.is_some() { "" } else { "law's " };
                format!("must be at most the {whose}period of {period} s, got {value}")
            });
        }
        needs.require_with(self.delay <= 1, "delay", || format!("must be 0 or 1 cycles, got {}", self.delay));
    }

    /// Returns the effect of each thruster on a body that has the thrusters' points.
    pub fn thruster_effects(&self, body: &ThreeAxisModel) -> Vec<ThrusterEffect> {
        let nozzle = |thruster: &Thruster| {
            let thrust = thruster.thrust.get();
            let mut effect = ForceEffect { forces: vec![0.0; body.modes.len()], ..ForceEffect::default() };
            let force = vector(&thruster.direction).normalize() * thrust;
            effect.add(body, &thruster.point, &vector(&thruster.offset), &force);
            ThrusterEffect { push: effect, flow: thrust / (self.specific_impulse.get() * G_0), thrust }
        };
        self.thrusters.iter().map(nozzle).collect()
    }

    /// Returns the groups of each thruster: axis, and 0 for plus or 1 for minus.
    pub(super) fn memberships(&self) -> Vec<Vec<[usize; 2]>> {
        let Some(groups) = &self.groups else { return Vec::new() };
        let effect_of = |thruster: &Thruster| {
            let mut own = Vec::new();
            for (axis, pair) in groups.each().into_iter().enumerate() {
                for (side, names) in pair.into_iter().flat_map(|pair| [&pair.plus, &pair.minus]).enumerate() {
                    own.extend(names.iter().filter(|name| **name == thruster.name).map(|_| [axis, side]));
                }
            }
            own
        };
        self.thrusters.iter().map(effect_of).collect()
    }

    /// Checks the jets and returns the groups on a body: plus and minus about each axis. `acts` selects the axes about
    /// which the jets act; about another axis without groups they have no effect.
    ///
    /// # Errors
    /// A `ConfigError` with a key within the jets and the reason.
    pub fn group_effects(
        &self,
        body: &ThreeAxisModel,
        acts: [bool; 3],
    ) -> Result<[[GroupEffect; 2]; 3], ConfigError> {
        for (index, thruster) in self.thrusters.iter().enumerate() {
            let refused =
                |key: &str, why: String| Err(ConfigError::new(format!("thrusters[{index}].{key}"), why));
            let length = vector(&thruster.direction).norm();
            if (length - 1.0).abs() > 1e-6 {
                return refused("direction", format!("must have length 1, got {length}"));
            }
            if self.thrusters[..index].iter().any(|other| other.name == thruster.name) {
                let why = format!("must differ from the other names, got `{}` again", thruster.name);
                return refused("name", why);
            }
            if body.point(&thruster.point).is_none() {
                let (points, found) = (body.point_names(), &thruster.point);
                return refused(
                    "point",
                    format!("must be one of the body's points, {points}, got `{found}`"),
                );
            }
        }
        if self.allocation == FiringMethod::LeastPropellant {
            if self.groups.is_some() {
                let why = "apply only to `allocation = \"groups\"`: leave them out";
                return Err(ConfigError::new("groups", why));
            }
            let tensor = body.inertia;
            let inertia = [0, 1, 2].map(|axis| tensor[(axis, axis)]);
            let nozzles = self.thruster_effects(body);
            let misplaced = Burn::validate(&self.burns).map(|fault| fault.within("burns"));
            if let Some(fault) = misplaced.or_else(|| Burn::capability_fault(&self.burns, &nozzles)) {
                return Err(fault);
            }
            return jet_allocation::largest_torques(self, &nozzles, inertia, acts);
        }
        if !self.burns.is_empty() {
            return Err(ConfigError::new("burns", "apply only to `allocation = \"least_propellant\"`"));
        }
        if self.force_free {
            return Err(ConfigError::new(
                "force_free",
                "applies only to `allocation = \"least_propellant\"`",
            ));
        }
        let Some(listed) = &self.groups else {
            let why = "must be given, or `allocation = \"least_propellant\"`";
            return Err(ConfigError::new("groups", why));
        };
        let mut groups = [(); 3].map(|()| GroupEffect::without_effect(body.modes.len()));
        for (axis, pair) in listed.each().into_iter().enumerate() {
            match pair {
                Some(pair) => {
                    groups[axis] = [
                        self.group(body, axis, "plus", 1.0, &pair.plus)?,
                        self.group(body, axis, "minus", -1.0, &pair.minus)?,
                    ];
                }
                None if acts[axis] => {
                    let name = AXES[axis];
                    return Err(ConfigError::new(
                        "groups",
                        format!("must have `{name}`, about which the jets act"),
                    ));
                }
                None => {}
            }
        }
        Ok(groups)
    }

    fn group(
        &self,
        body: &ThreeAxisModel,
        axis: usize,
        sign: &str,
        sense: f64,
        names: &[String],
    ) -> Result<GroupEffect, ConfigError> {
        let key = format!("groups.{}.{sign}", AXES[axis]);
        let mut effect = ForceEffect { forces: vec![0.0; body.modes.len()], ..ForceEffect::default() };
        let mut thrust = 0.0;
        for name in names {
            let Some(thruster) = self.thrusters.iter().find(|thruster| thruster.name == *name) else {
                let known: Vec<_> = self.thrusters.iter().map(|t| format!("`{}`", t.name)).collect();
                let why = format!("must name thrusters, {}, got `{name}`", known.join(", "));
                return Err(ConfigError::new(key, why));
            };
            let force = vector(&thruster.direction).normalize() * thruster.thrust.get();
            effect.add(body, &thruster.point, &vector(&thruster.offset), &force);
            thrust += thruster.thrust.get();
        }
        let torque = effect.torque;
        if sense * torque[axis] <= 0.0 {
            let (turns, [x, y, z]) = (AXES[axis], [torque.x, torque.y, torque.z]);
            let why = format!("must give a torque to {sign} {turns}, got [{x}, {y}, {z}] N m");
            return Err(ConfigError::new(key, why));
        }
        let acceleration = torque[axis].abs() / body.inertia[(axis, axis)];
        let flow = thrust / (self.specific_impulse.get() * G_0);
        Ok(GroupEffect { push: effect, flow, acceleration })
    }

    /// Whether propellant is counted by thruster: each is commanded individually, or can fail.
    pub fn is_by_thruster(&self) -> bool {
        self.allocation == FiringMethod::LeastPropellant || !self.faults.is_empty()
    }

    /// Returns the names of the thrusters.
    pub fn names(&self) -> Vec<String> {
        self.thrusters.iter().map(|thruster| thruster.name.clone()).collect()
    }

    /// Returns the quantisation of pulse lengths.
    pub fn pulse_width(&self) -> PulseWidth {
        PulseWidth { minimum: self.minimum_on, quantum: self.quantum }
    }
}
