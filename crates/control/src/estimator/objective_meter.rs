//! The meter of an adaptation's objective: it evaluates the objective over consecutive windows.
//!
//! On one axis, integrals and peaks are those of the exact motion, piece by piece. On three axes they are means over
//! the control cycles, like the metrics of these bodies; torques are constant between the instants at which the
//! actuator acts.

use flexsc_dynamics::MotionPiece;
use flexsc_numerics::polynomial::Polynomial;
use flexsc_numerics::quadrature;
use flexsc_numerics::time::{Instant, Span};

use super::adaptation_run::AdaptationRun;
use crate::adaptation::Objective;
use crate::law::Setpoint;

/// Run-time state of the objective meter.
#[derive(Clone, Debug)]
pub struct ObjectiveMeter {
    /// Objective that is evaluated.
    pub objective: Objective,
    /// Setpoint of a one-axis body.
    goal: Setpoint,
    window: Span,
    opened: Instant,
    /// Time at which the current window closes.
    pub closes: Instant,
    index: u64,
    sum: f64,
    /// Number of samples in `sum`.
    count: u64,
    /// Value held last, and the time from which on it holds.
    held: (f64, Instant),
    /// Time up to which the motion has been evaluated.
    pub measured: Instant,
    /// Signs of the torques about the axes that were applied last, and the count of jet pulses.
    burning: [bool; 3],
    pulses: u64,
    search: AdaptationRun,
}

/// Results of a window that has ended.
#[derive(Clone, Debug)]
pub struct ObjectiveWindow {
    /// Log row with the value of the objective.
    pub row: flexsc_record::Objective,
    /// Step of the adaptation, with the parameter before it; `None` without a step.
    pub step: Option<(flexsc_record::Adaptation, f64)>,
}

/// Motion of one axis over a piece of the trajectory, apart from its angle and torque.
#[derive(Clone, Debug)]
pub struct MotionSample {
    /// Rigid part of the angle (rad).
    pub rigid: Polynomial,
    /// Wheel speed at zero rigid rate (rad/s) and its change per unit of rigid rate (1), if there is a wheel.
    pub wheel: Option<[f64; 2]>,
}

impl ObjectiveMeter {
    /// Creates the meter of a run; the first window starts with the setpoint `goal`.
    pub fn new(objective: Objective, window: Span, goal: Setpoint, search: AdaptationRun) -> Self {
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

    /// Returns the adaptation that reads the meter.
    pub fn search(&self) -> &AdaptationRun {
        &self.search
    }

    /// Returns true if the objective is an integral or a peak of the motion about one axis.
    pub fn integrates(&self) -> bool {
        !matches!(self.objective, Objective::EnvelopeMean | Objective::Switchings | Objective::Firings)
    }

    /// Adds a piece of the exact motion about one axis.
    pub fn add_piece(&mut self, piece: &MotionPiece, state: &MotionSample) {
        let length = piece.length;
        let since = piece.from - self.goal.from.seconds();
        let error = || {
            let start = self.goal.angle + self.goal.rate * since;
            piece.angle.minus_line(start, self.goal.rate * length)
        };
        let part = match self.objective {
            Objective::PointingErrorMean => mean_of_absolute(&[&error()]),
            Objective::PointingErrorRms => mean_of_square(&error()),
            Objective::PointingErrorPeak => {
                self.sum = error().magnitude(self.sum);
                return;
            }
            Objective::RateErrorRms => {
                // The rate is a derivative with respect to time.
                let rate = error().derivative();
                mean_of_square(&rate) / (length * length)
            }
            Objective::ElasticRms => mean_of_square(&piece.angle.minus(&state.rigid)),
            Objective::TorqueMean => mean_of_absolute(&[&piece.applied]),
            Objective::WheelPowerMean => state.wheel.map_or(0.0, |[rest, slope]| {
                let speed = state.rigid.derivative().scaled(slope / length).minus_line(-rest, 0.0);
                mean_of_absolute(&[&piece.applied, &speed])
            }),
            Objective::EnvelopeMean | Objective::Switchings | Objective::Firings => return,
        };
        self.sum += part * length;
    }

    /// Adds a sample of a three-axis body, of which the objective is the mean, root mean square or maximum.
    pub fn add_sample(&mut self, value: f64) {
        match self.objective {
            Objective::PointingErrorPeak => self.sum = self.sum.max(value),
            Objective::PointingErrorRms | Objective::RateErrorRms | Objective::ElasticRms => {
                self.sum += value * value;
            }
            _ => self.sum += value,
        }
        self.count += 1;
    }

    /// Sets a value that holds from `now` on, and integrates the previous one.
    pub fn set_value(&mut self, now: Instant, value: f64) {
        let (before, since) = self.held;
        if now > since {
            self.sum += before * now.since(since).seconds();
        }
        self.held = (value, now.max(since));
    }

    /// Counts `switchings` of the law.
    pub fn switched(&mut self, now: Instant, switchings: u32) {
        if now >= self.opened {
            self.sum += f64::from(switchings);
        }
    }

    /// Counts pulses: from the total `pulses` of jets, or, without it, the torques about the axes that start now.
    pub fn add_pulses(&mut self, now: Instant, pulses: Option<u64>, torques: [f64; 3]) {
        let is_acting = torques.map(|torque| torque != 0.0);
        let new = match pulses {
            Some(pulses) => pulses - std::mem::replace(&mut self.pulses, pulses),
            None => is_acting.iter().zip(&self.burning).map(|(now, before)| u64::from(*now && !before)).sum(),
        };
        self.burning = is_acting;
        if now >= self.opened {
            self.sum += new as f64;
        }
    }

    /// Closes the window that ends at `now` and updates the adaptation.
    pub fn close_window(&mut self, now: Instant) -> ObjectiveWindow {
        if self.objective == Objective::TorqueMean && self.count == 0 {
            self.set_value(now, self.held.0);
        }
        let over = if self.count > 0 { self.count as f64 } else { self.window.seconds() };
        let value = match self.objective {
            Objective::PointingErrorPeak | Objective::Switchings | Objective::Firings => self.sum,
            Objective::PointingErrorRms | Objective::RateErrorRms | Objective::ElasticRms => {
                f64::sqrt(self.sum / over)
            }
            _ => self.sum / over,
        };
        let row = flexsc_record::Objective {
            window: self.index,
            from_s: self.opened.seconds(),
            to_s: now.seconds(),
            value,
            gain: self.search.parameter().1,
        };
        let step = self.search.learn(now, self.index, value);
        (self.sum, self.count, self.index) = (0.0, 0, self.index + 1);
        (self.opened, self.closes) = (now, now + self.window);
        ObjectiveWindow { row, step }
    }
}

/// Returns the mean of the square over a piece; a piece is so short that the quadrature is exact to rounding.
fn mean_of_square(polynomial: &Polynomial) -> f64 {
    quadrature::integral(&[0.0, 1.0], 1.0, |_, s| polynomial.at(s) * polynomial.at(s))
}

/// Returns the mean of the absolute value of a product over a piece, split where a factor changes its sign.
fn mean_of_absolute(factors: &[&Polynomial]) -> f64 {
    let mut breaks = vec![0.0, 1.0];
    for factor in factors {
        let (low, high) = factor.bounds();
        if low < 0.0 && high > 0.0 {
            factor.roots(0.0, &mut breaks);
        }
    }
    breaks.sort_by(f64::total_cmp);
    quadrature::integral(&breaks, 1.0, |_, s| {
        factors.iter().map(|factor| factor.at(s)).product::<f64>().abs()
    })
}
