//! Single-axis actuators: one of a one-axis body, or three of a three-axis body.

use std::sync::Arc;

use flexsc_dynamics::flow::ActiveWaveform;
use flexsc_dynamics::sine::SineTorque;
use flexsc_dynamics::waveform::Waveform;
use flexsc_dynamics::wrench::Wrench;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::Report;

use super::failure::FailureScope;
use super::faulty::FaultyActuator;
use super::{
    Actuator, ActuatorEvent, AxisEffort, AxisResponse, Capabilities, Demand, Failure, WaveformActuator,
};
use crate::custom::PartError;
use crate::part::{Part, ReportContext};

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

/// Torques of a single-axis actuator.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct AxisTorques {
    /// Torque demanded (N m).
    pub demanded: f64,
    /// Torque held (N m), without a waveform and without back-EMF.
    pub held: f64,
    /// Torque that would be held without failures (N m), which estimators and laws assume.
    pub nominal: f64,
    /// Torque of the pulse that is on (N m), of thrusters.
    pub firing: f64,
}

/// Constant properties of a single-axis actuator.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct AxisProperties {
    /// Torque per unit of the command (N m).
    pub torque_per_unit: f64,
    /// True if the actuator executes the manoeuvre's waveform exactly.
    pub executes_waveform: bool,
    /// Back-EMF torque per unit of the rate (N m s), and true if the elastic rate is included.
    pub back_emf: (f64, bool),
}

impl Default for AxisProperties {
    fn default() -> Self {
        Self { torque_per_unit: 1.0, executes_waveform: false, back_emf: (0.0, false) }
    }
}

/// Parts of a torque that vary continuously with time.
#[derive(Clone, Debug, Default)]
pub struct AxisWaves<'a> {
    /// Waveform, on a one-axis body.
    pub waveform: Option<ActiveWaveform>,
    /// Sines of time, on a three-axis body.
    pub sines: &'a [SineTorque],
}

/// Run-time state of a single-axis actuator.
pub trait AxisActuator: Part {
    /// Sets a command from `now` on: a torque (N m), or a value in the actuator's unit, of a body with this rigid rate
    /// (rad/s).
    fn command(&mut self, now: Instant, command: f64, rigid_rate: f64);

    /// Executes the changes due at `now`.
    fn serve(&mut self, _now: Instant, _rigid_rate: f64) {}

    /// Returns the torques demanded and held.
    fn torques(&self) -> AxisTorques;

    /// Returns the response of a body with this rate and this rigid rate (rad/s).
    fn response(&self, _now: Instant, _rates: [f64; 2]) -> AxisResponse {
        AxisResponse { applied: self.torques().held, rotor: None }
    }

    /// Returns the constant properties.
    fn properties(&self) -> AxisProperties {
        AxisProperties::default()
    }

    /// Returns the parts of the torque that vary continuously from `now` on.
    fn waves(&self, _now: Instant) -> AxisWaves<'_> {
        AxisWaves::default()
    }

    /// Returns a copy in the same state.
    fn copy(&self) -> Box<dyn AxisActuator>;
}

impl Clone for Box<dyn AxisActuator> {
    fn clone(&self) -> Self {
        self.copy()
    }
}

/// Actuators of all axes.
#[derive(Clone, Debug)]
pub struct AxisActuators {
    /// Actuator of each axis; `None` about an axis on which other actuators act.
    axes: Vec<Option<(Box<dyn AxisActuator>, AxisActuatorContext)>>,
    /// Back-EMF torque per unit of the rate about the first axis (N m s), and true if the elastic rate is included.
    back_emf: (f64, bool),
}

impl AxisActuators {
    /// Returns the run-time state of the actuator of each axis about which it acts, with its failures, from the state about
    /// one axis.
    pub fn start<A: AxisActuator + 'static>(
        settings: &[AxisActuatorContext],
        failures: &[Failure],
        start_about: impl Fn(&AxisActuatorContext) -> A,
    ) -> Box<dyn Actuator> {
        let actuator_for = |setting: &AxisActuatorContext| {
            let (actuator, axis) = (Box::new(start_about(setting)), setting.axis);
            let own =
                |scope: &FailureScope<'_>| scope.axis.is_none_or(|failing_axis| failing_axis.index() == axis);
            (FaultyActuator::with_failures(failures, own, actuator), setting.clone())
        };
        let axis = |setting: &AxisActuatorContext| (setting.share > 0.0).then(|| actuator_for(setting));
        let axes: Vec<Option<(Box<dyn AxisActuator>, AxisActuatorContext)>> =
            settings.iter().map(axis).collect();
        let first = axes.first().and_then(Option::as_ref);
        let back_emf = first.map_or((0.0, false), |(actuator, _)| actuator.properties().back_emf);
        Box::new(Self { axes, back_emf })
    }

    /// Returns the actuator about an axis, if one acts there.
    fn about(&self, axis: usize) -> Option<&(Box<dyn AxisActuator>, AxisActuatorContext)> {
        self.axes.get(axis).and_then(Option::as_ref)
    }
}

impl Part for AxisActuators {
    fn due(&self) -> Option<Instant> {
        self.axes.iter().flatten().filter_map(|(actuator, _)| actuator.due()).min()
    }

    fn report(&self, at: &ReportContext<'_>, report: &mut Report) {
        self.axes.iter().flatten().for_each(|(actuator, _)| actuator.report(at, report));
    }

    fn failure(&self) -> Option<PartError> {
        self.axes.iter().flatten().find_map(|(actuator, _)| actuator.failure())
    }
}

impl Actuator for AxisActuators {
    fn command(&mut self, now: Instant, demands: &[Demand], rigid: [f64; 3]) {
        for (axis, (actuator, demand)) in self.axes.iter_mut().zip(demands).enumerate() {
            let Some((actuator, setting)) = actuator else { continue };
            let commanded = match demand {
                Demand::Change(_) => setting.demanded_torque(demand) / actuator.properties().torque_per_unit,
                Demand::Torque(_) | Demand::Moment(_) => setting.demanded_torque(demand),
            };
            actuator.command(now, commanded, rigid[axis]);
        }
    }

    fn update(&mut self, now: Instant, event: ActuatorEvent<'_>) {
        let ActuatorEvent::Due(rigid) = event else { return };
        for (actuator, rate) in self.axes.iter_mut().zip(rigid) {
            if let Some((actuator, _)) = actuator {
                actuator.serve(now, rate);
            }
        }
    }

    fn apply(&self, now: Instant, onto: &mut Wrench) {
        let actuators = self.axes.iter().zip([Vector::x(), Vector::y(), Vector::z()]).enumerate();
        for (index, (actuator, axis)) in actuators {
            let Some((actuator, _)) = actuator else { continue };
            onto.hub[index] += actuator.torques().held;
            let waves = actuator.waves(now);
            if self.axes.len() == 1 {
                onto.add_waveform(waves.waveform);
            } else {
                onto.sines.extend(waves.sines.iter().map(|sine| (axis, *sine)));
            }
        }
    }

    fn effort(&self, axis: usize) -> AxisEffort {
        let Some((actuator, setting)) = self.about(axis) else { return AxisEffort::default() };
        let AxisTorques { demanded, held, nominal, firing } = actuator.torques();
        AxisEffort { demanded, held, firing, reduced_moment: nominal / setting.inertia }
    }

    fn response(&self, now: Instant, axis: usize, rates: [f64; 2]) -> AxisResponse {
        self.about(axis).map_or_else(AxisResponse::default, |(actuator, _)| actuator.response(now, rates))
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities { waveform: Some(self), back_emf: self.back_emf, ..Capabilities::default() }
    }

    fn copy(&self) -> Box<dyn Actuator> {
        Box::new(self.clone())
    }
}

impl WaveformActuator for AxisActuators {
    fn waveform_impulse(&self, from: f64, to: f64) -> f64 {
        self.about(0).map_or(0.0, |(actuator, setting)| {
            let forced = setting.waveform.as_ref().filter(|_| actuator.properties().executes_waveform);
            forced.map_or(0.0, |waveform| setting.share * waveform.impulse(from, to) / setting.inertia)
        })
    }
}
