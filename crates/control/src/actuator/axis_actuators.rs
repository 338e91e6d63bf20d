//! Single-axis actuators: one of a one-axis body, or three of a three-axis body.

use std::fmt;
use std::sync::Arc;

use flexsc_dynamics::waveform::Waveform;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::WheelMotion;
use flexsc_spacecraft::flow::ActiveWaveform;
use flexsc_spacecraft::sine::Sine;
use flexsc_spacecraft::wrench::Wrench;

use super::failure::FailureScope;
use super::faulty::FaultyActuator;
use super::{Actuator, ActuatorKind, Demand};

/// Body and manoeuvre data that a single-axis actuator needs.
#[derive(Clone, Debug)]
pub struct AxisActuatorContext {
    /// Index of the axis: 0, or 0 to 2 for roll, pitch and yaw.
    pub axis: usize,
    /// Inertia about the axis (kg m²).
    pub inertia: f64,
    /// Inertia about the axis of the body that the manoeuvre is planned for (kg m²).
    pub planned_inertia: f64,
    /// Initial rate about the axis (rad/s).
    pub rate: f64,
    /// Period of the law, if it has one.
    pub cycle: Option<Span>,
    /// Command of the manoeuvre (N m).
    pub waveform: Option<Arc<Waveform>>,
    /// Share of the demand about the axis that the actuator executes; 0 if it does not act about it.
    pub share: f64,
}

impl AxisActuatorContext {
    /// Returns the impulse of the actuator's share of the waveform over the next `h` (s), in N m s.
    pub fn planned_impulse(&self, now: Instant, h: f64) -> f64 {
        let from = now.seconds();
        self.waveform.as_ref().map_or(0.0, |waveform| self.share * waveform.impulse(from, from + h))
    }

    /// Returns the constant torque of a demand (N m): a change of the rate takes one period of the law, or 1 s without
    /// a period. A torque stays in the unit of its demand; a magnetic moment gives 0.
    pub fn demanded_torque(&self, demand: &Demand) -> f64 {
        match demand {
            Demand::Torque(torque) => *torque,
            Demand::Change(change) => change * self.inertia / self.cycle.map_or(1.0, Span::seconds),
            Demand::Moment(_) => 0.0,
        }
    }
}

/// Run-time state of a single-axis actuator.
pub trait AxisActuator: fmt::Debug + Send + Sync {
    /// Sets a command from `now` on: a torque (N m), or a value in the actuator's unit, of a body with this rigid rate
    /// (rad/s).
    fn command(&mut self, now: Instant, command: f64, rigid_rate: f64);

    /// Executes the changes due at `now`.
    fn serve(&mut self, _now: Instant, _rigid_rate: f64) {}

    /// Returns the next time at which the torque changes without a command.
    fn due(&self) -> Option<Instant> {
        None
    }

    /// Returns the torque per unit of the command (N m).
    fn torque_per_unit(&self) -> f64 {
        1.0
    }

    /// Returns the torque held (N m), without a waveform and without back-EMF.
    fn torque(&self) -> f64;

    /// Returns the torque that would be held without failures (N m), which estimators and laws assume.
    fn nominal_torque(&self) -> f64 {
        self.torque()
    }

    /// Returns the torque of the pulse that is on (N m), of thrusters.
    fn firing(&self) -> f64 {
        0.0
    }

    /// Returns the sines of time in the torque, on a three-axis body.
    fn sines(&self) -> &[Sine] {
        &[]
    }

    /// Returns the demanded torque (N m).
    fn demanded_torque(&self) -> f64;

    /// Returns true if the actuator executes the manoeuvre's waveform exactly.
    fn executes_waveform(&self) -> bool {
        false
    }

    /// Returns the waveform in the torque from `now` on, on a one-axis body.
    fn waveform(&self, _now: Instant) -> Option<ActiveWaveform> {
        None
    }

    /// Returns the torque on a body with this rate and this rigid rate (rad/s), in N m.
    fn applied(&self, _now: Instant, _rates: [f64; 2]) -> f64 {
        self.torque()
    }

    /// Returns the back-EMF torque per unit of the rate (N m s), and true if the elastic rate is included.
    fn back_emf(&self) -> (f64, bool) {
        (0.0, false)
    }

    /// Returns the rotor of a body with this rigid rate (rad/s), if it stores momentum.
    fn rotor(&self, _rigid_rate: f64) -> Option<WheelMotion> {
        None
    }

    /// Returns a copy in the same state.
    fn copy(&self) -> Box<dyn AxisActuator>;
}

impl Clone for Box<dyn AxisActuator> {
    fn clone(&self) -> Self {
        self.copy()
    }
}

/// Actuators of all axes; `None` about an axis on which other actuators act.
#[derive(Clone, Debug)]
pub struct AxisActuators(Vec<Option<(Box<dyn AxisActuator>, AxisActuatorContext)>>);

impl AxisActuators {
    /// Creates the actuator of each axis about which it acts, with its failures.
    pub fn new(kind: &ActuatorKind, settings: Vec<AxisActuatorContext>) -> Self {
        let actuator_for = |setting: AxisActuatorContext| {
            let (actuator, axis) = (kind.axis_actuator(&setting), setting.axis);
            let own =
                |scope: &FailureScope<'_>| scope.axis.is_none_or(|failing_axis| failing_axis.index() == axis);
            (FaultyActuator::with_failures(kind.failures(), own, actuator), setting)
        };
        Self(
            settings
                .into_iter()
                .map(|setting| (setting.share > 0.0).then(|| actuator_for(setting)))
                .collect(),
        )
    }

    /// Returns a number of the actuator about an axis; 0 without an actuator.
    fn about(&self, axis: usize, number: impl Fn(&dyn AxisActuator, &AxisActuatorContext) -> f64) -> f64 {
        let actuator = self.0.get(axis).and_then(Option::as_ref);
        actuator.map_or(0.0, |(actuator, setting)| number(&**actuator, setting))
    }
}

impl Actuator for AxisActuators {
    fn command(&mut self, now: Instant, demands: &[Demand], rigid: [f64; 3]) {
        for (axis, (actuator, demand)) in self.0.iter_mut().zip(demands).enumerate() {
            let Some((actuator, setting)) = actuator else { continue };
            let commanded = match demand {
                Demand::Change(_) => setting.demanded_torque(demand) / actuator.torque_per_unit(),
                Demand::Torque(_) | Demand::Moment(_) => setting.demanded_torque(demand),
            };
            actuator.command(now, commanded, rigid[axis]);
        }
    }

    fn due(&self) -> Option<Instant> {
        self.0.iter().flatten().filter_map(|(actuator, _)| actuator.due()).min()
    }

    fn update(&mut self, now: Instant, rigid: [f64; 3]) {
        for (actuator, rate) in self.0.iter_mut().zip(rigid) {
            if let Some((actuator, _)) = actuator {
                actuator.serve(now, rate);
            }
        }
    }

    fn apply(&self, now: Instant, onto: &mut Wrench) {
        let actuators = self.0.iter().zip([Vector::x(), Vector::y(), Vector::z()]).enumerate();
        for (index, (actuator, axis)) in actuators {
            let Some((actuator, _)) = actuator else { continue };
            onto.hub[index] += actuator.torque();
            if self.0.len() == 1 {
                onto.add_waveform(actuator.waveform(now));
            } else {
                onto.sines.extend(actuator.sines().iter().map(|sine| (axis, *sine)));
            }
        }
    }

    fn demanded_torque(&self, axis: usize) -> f64 {
        self.about(axis, |actuator, _| actuator.demanded_torque())
    }

    fn held_torque(&self, axis: usize) -> f64 {
        self.about(axis, |actuator, _| actuator.torque())
    }

    fn firing(&self, axis: usize) -> f64 {
        self.about(axis, |actuator, _| actuator.firing())
    }

    fn applied_torque(&self, now: Instant, axis: usize, rates: [f64; 2]) -> f64 {
        self.about(axis, |actuator, _| actuator.applied(now, rates))
    }

    fn reduced_moment(&self, axis: usize) -> f64 {
        self.about(axis, |actuator, setting| actuator.nominal_torque() / setting.inertia)
    }

    fn waveform_impulse(&self, from: f64, to: f64) -> f64 {
        self.about(0, |actuator, setting| {
            let forced = setting.waveform.as_ref().filter(|_| actuator.executes_waveform());
            forced.map_or(0.0, |waveform| setting.share * waveform.impulse(from, to) / setting.inertia)
        })
    }

    fn back_emf(&self) -> (f64, bool) {
        self.0[0].as_ref().map_or((0.0, false), |(actuator, _)| actuator.back_emf())
    }

    fn wheel(&self, axis: usize, rigid_rate: f64) -> Option<WheelMotion> {
        self.0[axis].as_ref()?.0.rotor(rigid_rate)
    }

    fn copy(&self) -> Box<dyn Actuator> {
        Box::new(self.clone())
    }
}
