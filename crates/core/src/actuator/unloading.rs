//! Jets that unload wheels: beyond a momentum they push the body the other way, and the wheels, which hold it, slow down.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Actuate, Cycle, Demand, Group, Jets, Pulsing, Spinning};
use crate::body::Wrench;
use crate::body::spatial::Vector;
use crate::document::Fault;
use crate::motion::turning::Turned;
use crate::quantity::{NonNegative, Positive};
use crate::record;
use crate::time::{Instant, Span};

/// How wheels are unloaded.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Unloading {
    /// Momentum of the wheels together beyond which it begins (N m s).
    pub above: Positive,
    /// Momentum below which it ends (N m s).
    pub below: NonNegative,
    /// Largest mean torque of the jets about each axis over their cycles (N m), which the wheels take up meanwhile.
    pub torque: Positive,
    /// The jets, with a period of their own and without a delay.
    pub jets: Jets,
}

impl Unloading {
    /// What single values cannot show to be wrong: a key within the unloading, and why.
    pub fn inconsistency(&self) -> Option<Fault> {
        let (above, below) = (self.above.get(), self.below.get());
        let at = |key: &str, why: String| Some(Fault::new(key, why));
        if below >= above {
            return at("below", format!("must be less than `above`, {above} N m s, got {below}"));
        }
        let Some(period) = self.jets.period.map(Span::seconds) else {
            return at("jets.period", "must be given: the law's cycles are those of the wheels".to_owned());
        };
        if self.jets.delay > 0 {
            return at(
                "jets.delay",
                format!("must be 0 for jets that unload wheels, got {}", self.jets.delay),
            );
        }
        for (key, value) in [("minimum_on", self.jets.minimum_on.get()), ("quantum", self.jets.quantum.get())]
        {
            if value > period {
                let why = format!("must be at most the period of {period} s, got {value}");
                return at(&format!("jets.{key}"), why);
            }
        }
        None
    }

    /// Wheels and jets before the first command.
    pub fn start(&self, wheels: Spinning, groups: &[[Group; 2]; 3]) -> Unloaded {
        let period = self.jets.period.unwrap_or(Span::TICK);
        Unloaded {
            wheels,
            jets: Pulsing::new(&self.jets, groups, period),
            limits: [self.above.get(), self.below.get()],
            torque: self.torque.get(),
            period,
            next: Instant::START,
            active: false,
            mean: Vector::zeros(),
            demands: [Demand::Torque(0.0); 3],
        }
    }
}

/// Wheels and jets at work.
#[derive(Clone, Debug)]
pub struct Unloaded {
    wheels: Spinning,
    jets: Pulsing,
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
