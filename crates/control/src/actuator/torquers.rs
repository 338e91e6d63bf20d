//! Actuators that give a torque about an axis each: one of a body with one angle, three of a body with three axes.

use std::fmt;
use std::sync::Arc;

use super::failure::Lasting;
use super::impaired::Impaired;
use super::{Actuate, Actuator, Demand};
use crate::attitude::Vector;
use crate::flow::Forced;
use crate::record::WheelMotion;
use crate::sine::Sine;
use crate::time::{Instant, Span};
use crate::waveform::Waveform;
use crate::wrench::Wrench;

/// What an actuator of one axis knows of what is around it.
#[derive(Clone, Debug)]
pub struct TorquerSetting {
    /// The axis: 0, or 0 to 2 for roll, pitch and yaw.
    pub axis: usize,
    /// What a unit of the torque accelerates (kg m²).
    pub inertia: f64,
    /// The same of the body that the manoeuvre is planned for.
    pub planned_inertia: f64,
    /// Rate at the start (rad/s).
    pub rate: f64,
    /// The law's period, if it has one.
    pub cycle: Option<Span>,
    /// The manoeuvre's command (N m).
    pub waveform: Option<Arc<Waveform>>,
    /// The part of what is demanded about the axis that is the actuator's; 0 of one that does not act about it.
    pub share: f64,
}

impl TorquerSetting {
    /// Impulse of its share of the waveform over the next `h` seconds (N m s).
    pub fn planned(&self, now: Instant, h: f64) -> f64 {
        let from = now.seconds();
        self.waveform.as_ref().map_or(0.0, |waveform| self.share * waveform.impulse(from, from + h))
    }

    /// The constant torque of a demand (N m): a change of the rate takes one period of the law, or 1 s without a period. A torque
    /// stays in the unit of its demand; there is none of a magnetic moment.
    pub fn demanded(&self, demand: &Demand) -> f64 {
        match demand {
            Demand::Torque(torque) => *torque,
            Demand::Change(change) => change * self.inertia / self.cycle.map_or(1.0, Span::seconds),
            Demand::Moment(_) => 0.0,
        }
    }
}

/// An actuator of one axis at work.
pub trait AxisActuate: fmt::Debug + Send + Sync {
    /// Takes over a command from now on: a torque (N m), or so many of its units, on a body that turns at this rigid rate
    /// (rad/s).
    fn command(&mut self, now: Instant, command: f64, rigid_rate: f64);

    /// Does what is due now.
    fn serve(&mut self, _now: Instant, _rigid_rate: f64) {}

    /// The next instant at which its torque changes by itself.
    fn due(&self) -> Option<Instant> {
        None
    }

    /// Torque for each unit of its command (N m).
    fn unit(&self) -> f64 {
        1.0
    }

    /// The torque that it holds (N m), without a waveform and without back-EMF.
    fn torque(&self) -> f64;

    /// The torque that it would hold without a failure (N m), as who does not know of it takes it to be.
    fn believed(&self) -> f64 {
        self.torque()
    }

    /// Returns the torque of the pulse that is on (N m), of thrusters.
    fn firing(&self) -> f64 {
        0.0
    }

    /// Sines of the time in its torque, on a body with three axes.
    fn sines(&self) -> &[Sine] {
        &[]
    }

    /// The torque that is asked for (N m).
    fn asked(&self) -> f64;

    /// Whether it executes the manoeuvre's waveform as it is.
    fn follows(&self) -> bool {
        false
    }

    /// The waveform in its torque from now on, on a body with one angle.
    fn forced(&self, _now: Instant) -> Option<Forced> {
        None
    }

    /// The torque that it gives a body with this rate and this rigid rate (N m).
    fn applied(&self, _now: Instant, _rates: [f64; 2]) -> f64 {
        self.torque()
    }

    /// Back-EMF for each unit of the rate (N m s), and whether it is that of the elastic body.
    fn back_emf(&self) -> (f64, bool) {
        (0.0, false)
    }

    /// Its rotor, of a body that turns at this rigid rate (rad/s), if it stores momentum.
    fn rotor(&self, _rigid_rate: f64) -> Option<WheelMotion> {
        None
    }

    /// A copy in the same state.
    fn copy(&self) -> Box<dyn AxisActuate>;
}

impl Clone for Box<dyn AxisActuate> {
    fn clone(&self) -> Self {
        self.copy()
    }
}

/// The actuators of all axes; none about one that others serve.
#[derive(Clone, Debug)]
pub struct Torquers(Vec<Option<(Box<dyn AxisActuate>, TorquerSetting)>>);

impl Torquers {
    /// An actuator in the setting of each axis about which it acts, with the failures that are its own.
    pub fn new(kind: &Actuator, settings: Vec<TorquerSetting>) -> Self {
        let of = |setting: TorquerSetting| {
            let (actuator, axis) = (kind.about_an_axis(&setting), setting.axis);
            let own = |of: &Lasting<'_>| of.about.is_none_or(|about| about.index() == axis);
            (Impaired::by(kind.failures(), own, actuator), setting)
        };
        Self(settings.into_iter().map(|setting| (setting.share > 0.0).then(|| of(setting))).collect())
    }

    /// A number of the actuator about an axis, 0 where there is none.
    fn about(&self, axis: usize, number: impl Fn(&dyn AxisActuate, &TorquerSetting) -> f64) -> f64 {
        let actuator = self.0.get(axis).and_then(Option::as_ref);
        actuator.map_or(0.0, |(actuator, setting)| number(&**actuator, setting))
    }
}

impl Actuate for Torquers {
    fn command(&mut self, now: Instant, demands: &[Demand], rigid: [f64; 3]) {
        for (axis, (actuator, demand)) in self.0.iter_mut().zip(demands).enumerate() {
            let Some((actuator, setting)) = actuator else { continue };
            let wanted = match demand {
                Demand::Change(_) => setting.demanded(demand) / actuator.unit(),
                Demand::Torque(_) | Demand::Moment(_) => setting.demanded(demand),
            };
            actuator.command(now, wanted, rigid[axis]);
        }
    }

    fn due(&self) -> Option<Instant> {
        self.0.iter().flatten().filter_map(|(actuator, _)| actuator.due()).min()
    }

    fn serve(&mut self, now: Instant, rigid: [f64; 3]) {
        for (actuator, rate) in self.0.iter_mut().zip(rigid) {
            if let Some((actuator, _)) = actuator {
                actuator.serve(now, rate);
            }
        }
    }

    fn exert(&self, now: Instant, onto: &mut Wrench) {
        let actuators = self.0.iter().zip([Vector::x(), Vector::y(), Vector::z()]).enumerate();
        for (index, (actuator, axis)) in actuators {
            let Some((actuator, _)) = actuator else { continue };
            onto.hub[index] += actuator.torque();
            if self.0.len() == 1 {
                onto.force(actuator.forced(now));
            } else {
                onto.sines.extend(actuator.sines().iter().map(|sine| (axis, *sine)));
            }
        }
    }

    fn asked(&self, axis: usize) -> f64 {
        self.about(axis, |actuator, _| actuator.asked())
    }

    fn torque(&self, axis: usize) -> f64 {
        self.about(axis, |actuator, _| actuator.torque())
    }

    fn firing(&self, axis: usize) -> f64 {
        self.about(axis, |actuator, _| actuator.firing())
    }

    fn applied(&self, now: Instant, axis: usize, rates: [f64; 2]) -> f64 {
        self.about(axis, |actuator, _| actuator.applied(now, rates))
    }

    fn moment(&self, axis: usize) -> f64 {
        self.about(axis, |actuator, setting| actuator.believed() / setting.inertia)
    }

    fn waveform_impulse(&self, from: f64, to: f64) -> f64 {
        self.about(0, |actuator, setting| {
            let forced = setting.waveform.as_ref().filter(|_| actuator.follows());
            forced.map_or(0.0, |waveform| setting.share * waveform.impulse(from, to) / setting.inertia)
        })
    }

    fn back_emf(&self) -> (f64, bool) {
        self.0[0].as_ref().map_or((0.0, false), |(actuator, _)| actuator.back_emf())
    }

    fn wheel(&self, axis: usize, rigid_rate: f64) -> Option<WheelMotion> {
        self.0[axis].as_ref()?.0.rotor(rigid_rate)
    }

    fn copy(&self) -> Box<dyn Actuate> {
        Box::new(self.clone())
    }
}
