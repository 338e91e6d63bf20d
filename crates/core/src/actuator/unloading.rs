//! Jets that unload wheels: beyond a momentum they push the body the other way, and the wheels, which hold it, slow down.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Actuate, Cycle, Demand, Group, Jets, Magnetic, Magnetorquers, Nozzle, Setting, Spinning};
use crate::attitude::Vector;
use crate::body::Wrench;
use crate::document::Fault;
use crate::motion::turning::Turned;
use crate::quantity::{NonNegative, Positive};
use crate::record;
use crate::time::{Instant, Span};

/// Unloading of the wheels by jets or by magnetorquers.
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
    /// What single values cannot show to be wrong: a key within the unloading, and why.
    pub fn inconsistency(&self) -> Option<Fault> {
        let (above, below) = (self.above.get(), self.below.get());
        let at = |key: &str, why: String| Some(Fault::new(key, why));
        if below >= above {
            return at("below", format!("must be less than `above`, {above} N m s, got {below}"));
        }
        let of_torquers = [("gain", self.gain.is_some()), ("period", self.period.is_some())];
        match (&self.jets, &self.magnetorquers) {
            (Some(jets), None) => {
                if let Some((key, _)) = of_torquers.into_iter().find(|(_, given)| *given) {
                    return at(key, "applies only to `magnetorquers`: leave it out".to_owned());
                }
                if self.torque.is_none() {
                    return at("torque", "must be given with `jets`".to_owned());
                }
                jets_fault(jets)
            }
            (None, Some(_)) => {
                if self.torque.is_some() {
                    return at("torque", "applies only to `jets`: leave it out".to_owned());
                }
                let (key, _) = of_torquers.into_iter().find(|(_, given)| !given)?;
                at(key, "must be given with `magnetorquers`".to_owned())
            }
            (None, None) => at("jets", "must be given, or `magnetorquers`".to_owned()),
            (Some(_), Some(_)) => at(
                "magnetorquers",
                "must be left out with `jets`: only one of the two can unload the wheels".to_owned(),
            ),
        }
    }

    /// Wheels and jets before the first command, if jets unload them.
    pub fn start(&self, wheels: Spinning, fitted: (&[[Group; 2]; 3], &[Nozzle])) -> Option<Unloaded> {
        let jets = self.jets.as_ref()?;
        let period = jets.period.unwrap_or(Span::TICK);
        Some(Unloaded {
            wheels,
            jets: jets.start(fitted, period),
            limits: [self.above.get(), self.below.get()],
            torque: self.torque.map_or(f64::INFINITY, Positive::get),
            period,
            next: Instant::START,
            active: false,
            mean: Vector::zeros(),
            demands: [Demand::Torque(0.0); 3],
        })
    }

    /// Wheels and magnetorquers before the first command, if these unload them.
    pub fn start_magnetic(&self, wheels: Spinning, settings: &[Setting]) -> Option<Magnetic> {
        Some(Magnetic {
            wheels,
            torquers: self.magnetorquers.as_ref()?.start(settings),
            limits: [self.above.get(), self.below.get()],
            gain: self.gain?.get(),
            period: self.period?,
            next: Instant::START,
            active: false,
            demands: [Demand::Torque(0.0); 3],
        })
    }
}

/// A key of jets that does not fit the unloading of wheels, and why.
fn jets_fault(jets: &Jets) -> Option<Fault> {
    let at = |key: &str, why: String| Some(Fault::new(format!("jets.{key}"), why));
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

/// Wheels and jets at work.
#[derive(Clone, Debug)]
pub struct Unloaded {
    wheels: Spinning,
    jets: Box<dyn Actuate>,
    /// Momenta at which it begins and ends (N m s).
    limits: [f64; 2],
    /// Largest mean torque of the jets (N m).
    torque: f64,
    period: Span,
    /// When the next cycle of the jets begins.
    next: Instant,
    active: bool,
    /// Mean torque of the jets over their cycle (N m).
    mean: Vector,
    /// What laws demand.
    demands: [Demand; 3],
}

impl Unloaded {
    /// Begins a cycle of the jets: as long as there is too much momentum they take of it what they may.
    fn begin(&mut self, now: Instant) {
        let stored = Vector::from(self.wheels.stored(now));
        let [above, below] = self.limits;
        self.active = stored.norm() > if self.active { below } else { above };
        let wanted = if self.active { stored / -self.period.seconds() } else { Vector::zeros() };
        // The direction stays where one axis has more than the jets may give.
        let largest = wanted.amax();
        let wanted = if largest > self.torque { wanted * (self.torque / largest) } else { wanted };
        let demands = [0, 1, 2].map(|axis| Demand::Torque(wanted[axis]));
        self.jets.command(now, &demands, [0.0; 3]);
        self.next = now + self.period;
    }
}

impl Actuate for Unloaded {
    fn command(&mut self, now: Instant, demands: &[Demand], rigid: [f64; 3]) {
        self.demands.iter_mut().zip(demands).for_each(|(own, demand)| *own = *demand);
        self.wheels.command(now, demands, rigid);
    }

    fn due(&self) -> Option<Instant> {
        [self.wheels.due(), self.jets.due()].into_iter().flatten().min()
    }

    fn serve(&mut self, now: Instant, rigid: [f64; 3]) {
        let begins = self.next == now;
        if begins {
            self.begin(now);
        }
        self.jets.serve(now, rigid);
        self.wheels.serve(now, rigid);
        if begins {
            let mean = self.jets.impulse() / self.period.seconds();
            if mean != self.mean {
                self.mean = mean;
                self.wheels.hold_against(mean);
                self.wheels.command(now, &self.demands, rigid);
            }
        }
    }

    fn turned(&mut self, now: Instant, rotors: &[Turned]) {
        self.wheels.turned(now, rotors);
    }

    fn exert(&self, now: Instant, onto: &mut Wrench) {
        self.wheels.exert(now, onto);
        self.jets.exert(now, onto);
    }

    fn asked(&self, axis: usize) -> f64 {
        self.wheels.asked(axis)
    }

    fn torque(&self, axis: usize) -> f64 {
        self.wheels.torque(axis) + self.jets.torque(axis)
    }

    fn moment(&self, axis: usize) -> f64 {
        self.wheels.moment(axis) + self.jets.moment(axis)
    }

    fn wheels(&self, now: Instant, rate: [f64; 3]) -> Vec<record::Wheel> {
        self.wheels.wheels(now, rate)
    }

    fn known_speeds(&self) -> Vec<f64> {
        self.wheels.known_speeds()
    }

    fn applied(&self, now: Instant, axis: usize, rates: [f64; 2]) -> f64 {
        self.wheels.applied(now, axis, rates) + self.jets.torque(axis)
    }

    fn cycle(&self) -> Option<Cycle> {
        self.jets.cycle()
    }

    fn stored(&self, now: Instant) -> [f64; 3] {
        self.wheels.stored(now)
    }

    fn copy(&self) -> Box<dyn Actuate> {
        Box::new(self.clone())
    }
}
