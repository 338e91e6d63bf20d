//! The meter of an objective: what is measured over consecutive windows, from which the adaptation learns.
//!
//! About one axis integrals and peaks are those of the exact motion, stretch by stretch. About three they are means over the
//! control cycles, as the metrics of these bodies are; torques hold between the instants at which the actuator acts.

use super::searching::Searching;
use crate::adaptation::Objective;
use crate::law::Goal;
use crate::motion::Stretch;
use crate::numerics::polynomial::Polynomial;
use crate::numerics::quadrature;
use crate::record;
use crate::time::{Instant, Span};

/// The meter at work.
#[derive(Clone, Debug)]
pub struct Meter {
    /// What it measures.
    pub objective: Objective,
    /// Where the body shall be about one axis.
    goal: Goal,
    window: Span,
    opened: Instant,
    /// When the window closes.
    pub closes: Instant,
    index: u64,
    sum: f64,
    /// Of samples, how many.
    count: u64,
    /// What was held last, and since when.
    held: (f64, Instant),
    /// Until when the motion was measured.
    pub measured: Instant,
    /// Signs of the torques about the axes that were applied last, and pulses of jets that were counted.
    burning: [bool; 3],
    pulses: u64,
    search: Searching,
}

/// What a window that ends brings.
#[derive(Clone, Debug)]
pub struct WindowMeans {
    /// What was measured.
    pub row: record::Objective,
    /// The step of the adaptation, with the value before it.
    pub step: Option<(record::Adaptation, f64)>,
}

/// What is seen of one axis over a stretch of the exact motion, beside its angle and torque.
#[derive(Clone, Debug)]
pub struct Beside {
    /// Rigid part of the angle (rad).
    pub rigid: Polynomial,
    /// Speed of the wheel at rest and its change with the rigid rate (rad/s, 1), if there is one.
    pub wheel: Option<[f64; 2]>,
}

impl Meter {
    /// The meter of a run; windows begin with the goal.
    pub fn new(objective: Objective, window: Span, goal: Goal, search: Searching) -> Self {
        Self {
            objective,
            window,
            opened: goal.from,
            closes: goal.from + window,
            index: 0,
            sum: 0.0,
            count: 0,
            held: (0.0, goal.from),
            measured: goal.from,
            burning: [false; 3],
            pulses: 0,
            goal,
            search,
        }
    }

    /// The adaptation.
    pub fn search(&self) -> &Searching {
        &self.search
    }

    /// Whether it integrates the motion about one axis.
    pub fn integrates(&self) -> bool {
        !matches!(self.objective, Objective::EnvelopeMean | Objective::Switchings | Objective::Firings)
    }

    /// Takes a stretch of the motion about one axis.
    pub fn stretch(&mut self, stretch: &Stretch, beside: &Beside) {
        let length = stretch.length;
        let since = stretch.from - self.goal.from.seconds();
        let error = || {
            let start = self.goal.angle + self.goal.rate * since;
            stretch.angle.less(start, self.goal.rate * length)
        };
        let part = match self.objective {
            Objective::PointingErrorMean => mean_of_absolute(&[&error()]),
            Objective::PointingErrorRms => mean_of_square(&error()),
            Objective::PointingErrorPeak => {
                self.sum = error().magnitude(self.sum);
                return;
            }
            Objective::RateErrorRms => {
                // The rate is a derivative with time.
                let rate = error().derivative();
                mean_of_square(&rate) / (length * length)
            }
            Objective::ElasticRms => mean_of_square(&stretch.angle.minus(&beside.rigid)),
            Objective::TorqueMean => mean_of_absolute(&[&stretch.applied]),
            Objective::WheelPowerMean => beside.wheel.map_or(0.0, |[rest, slope]| {
                let speed = beside.rigid.derivative().scaled(slope / length).less(-rest, 0.0);
                mean_of_absolute(&[&stretch.applied, &speed])
            }),
            Objective::EnvelopeMean | Objective::Switchings | Objective::Firings => return,
        };
        self.sum += part * length;
    }

    /// Takes a sample of three axes: what the objective is the mean, the root mean square or the largest of.
    pub fn sample(&mut self, value: f64) {
        match self.objective {
            Objective::PointingErrorPeak => self.sum = self.sum.max(value),
            Objective::PointingErrorRms | Objective::RateErrorRms | Objective::ElasticRms => {
                self.sum += value * value;
            }
            _ => self.sum += value,
        }
        self.count += 1;
    }

    /// Takes a value that holds from now on.
    pub fn hold(&mut self, now: Instant, value: f64) {
        let (before, since) = self.held;
        if now > since {
            self.sum += before * now.since(since).seconds();
        }
        self.held = (value, now.max(since));
    }

    /// Counts switchings of the law.
    pub fn switched(&mut self, now: Instant, switchings: u32) {
        if now >= self.opened {
            self.sum += f64::from(switchings);
        }
    }

    /// Counts pulses: those of jets so far, or those that begin with these torques about the axes.
    pub fn fired(&mut self, now: Instant, pulses: Option<u64>, torques: [f64; 3]) {
        let begun = torques.map(|torque| torque != 0.0);
        let new = match pulses {
            Some(pulses) => pulses - std::mem::replace(&mut self.pulses, pulses),
            None => begun.iter().zip(&self.burning).map(|(now, before)| u64::from(*now && !before)).sum(),
        };
        self.burning = begun;
        if now >= self.opened {
            self.sum += new as f64;
        }
    }

    /// Closes the window that ends now, and lets the adaptation learn.
    pub fn close(&mut self, now: Instant) -> WindowMeans {
        if self.objective == Objective::TorqueMean && self.count == 0 {
            self.hold(now, self.held.0);
        }
        let over = if self.count > 0 { self.count as f64 } else { self.window.seconds() };
        let value = match self.objective {
            Objective::PointingErrorPeak | Objective::Switchings | Objective::Firings => self.sum,
            Objective::PointingErrorRms | Objective::RateErrorRms | Objective::ElasticRms => {
                f64::sqrt(self.sum / over)
            }
            _ => self.sum / over,
        };
        let row = record::Objective {
            window: self.index,
            from_s: self.opened.seconds(),
            to_s: now.seconds(),
            value,
            gain: self.search.tunes().1,
        };
        let step = self.search.learn(now, self.index, value);
        (self.sum, self.count, self.index) = (0.0, 0, self.index + 1);
        (self.opened, self.closes) = (now, now + self.window);
        WindowMeans { row, step }
    }
}

/// The mean of the square over a stretch; a stretch is so short that the quadrature is exact to rounding.
fn mean_of_square(of: &Polynomial) -> f64 {
    quadrature::integral(&[0.0, 1.0], 1.0, |_, s| of.at(s) * of.at(s))
}

/// The mean of the absolute value of a product over a stretch, broken where a factor changes its sign.
fn mean_of_absolute(factors: &[&Polynomial]) -> f64 {
    let mut breaks = vec![0.0, 1.0];
    for factor in factors {
        let (low, high) = factor.bounds();
        if low < 0.0 && high > 0.0 {
            factor.roots(0.0, &mut breaks);
        }
    }
    breaks.sort_by(f64::total_cmp);
    quadrature::integral(&breaks, 1.0, |_, s| factors.iter().map(|of| of.at(s)).product::<f64>().abs())
}
