//! The planar body where its modes do not move on their own: coupled by a wheel's back-EMF, or with frequencies that drift.
//!
//! At constant frequencies the motion under a constant input is that of the matrix exponential; with drifting ones it is
//! integrated to a tolerance, between the kinks of their profiles.

use nalgebra::{DMatrix, DVector};

use super::{Coupled, Drift, Planar, Sight, State};
use crate::integrate::{Field, Trajectory};

/// Error of each step of a drifting body, relative to its largest coordinate or to 1.
const TOLERANCE: f64 = 1e-13;
/// So many transitions are kept, the newest last: the periods of a run are few.
const KEPT: usize = 8;

/// The constants of a motion.
#[derive(Clone, Debug)]
struct Wheeled {
    system: Coupled,
    mobility: f64,
    frequencies: Vec<f64>,
    /// 2 zeta w of each mode (1/s).
    drags: Vec<f64>,
    drift: Option<Drift>,
}

/// A motion under a constant input.
#[derive(Clone, Debug)]
pub struct Coupling {
    body: Wheeled,
    /// Reduced moment (rad/s²).
    moment: f64,
    /// Time of departure (s), and z then.
    departed: f64,
    from: DVector<f64>,
    here: DVector<f64>,
    /// Spans (s) with their transitions.
    transitions: Vec<(f64, DMatrix<f64>, DVector<f64>)>,
    trajectory: Trajectory,
}

impl Coupling {
    /// A body at its start, under no input. A wheel takes back-EMF a (1/s) from the total rate, or from the rigid one.
    pub fn new(body: &Planar, drift: Option<&Drift>, back_emf: f64, total: bool) -> Self {
        let frequencies: Vec<f64> = body.modes.iter().map(|mode| mode.frequency.get()).collect();
        let from = body.start().to_vector(&frequencies);
        let step = 0.1 / frequencies.iter().copied().fold(1e-3, f64::max);
        Self {
            moment: 0.0,
            departed: 0.0,
            trajectory: Trajectory::new(TOLERANCE, from.as_slice().to_vec(), step),
            here: from.clone(),
            from,
            transitions: Vec::with_capacity(KEPT),
            body: Wheeled {
                system: Coupled::new(body, back_emf, total, &vec![1.0; frequencies.len()]),
                mobility: 1.0 / body.inertia.get(),
                drags: body.modes.iter().map(|m| 2.0 * m.damping.get() * m.frequency.get()).collect(),
                frequencies,
                drift: drift.cloned(),
            },
        }
    }

    /// Begins a motion under another constant input (N m), from where the body was seen last, at a time (s).
    pub fn depart(&mut self, now: f64, input: f64) {
        self.moment = input * self.body.mobility;
        self.departed = now;
        self.from.copy_from(&self.here);
        self.trajectory.depart();
    }

    /// The state `h` seconds after departure, not before one asked for earlier, and what a sensor sees.
    pub fn at(&mut self, h: f64, state: &mut State) -> Sight {
        if self.body.drift.is_some() {
            let driven = Drifting { body: &self.body, moment: self.moment, departed: self.departed };
            self.here.as_mut_slice().copy_from_slice(self.trajectory.at(&driven, h));
        } else {
            self.turn(h);
        }
        self.see(h, state)
    }

    /// What a sensor sees at departure.
    pub fn origin(&mut self, state: &mut State) -> Sight {
        self.see(0.0, state)
    }

    /// Moves by the transition over `h` seconds.
    fn turn(&mut self, h: f64) {
        let kept = self.transitions.iter().position(|(span, ..)| *span == h);
        let index = kept.unwrap_or_else(|| {
            let (transition, input) = self.body.system.discrete(h);
            if self.transitions.len() == KEPT {
                self.transitions.remove(0);
            }
            self.transitions.push((h, transition, input));
            self.transitions.len() - 1
        });
        let (_, transition, input) = &self.transitions[index];
        self.here.gemv(1.0, transition, &self.from, 0.0);
        self.here.axpy(self.moment, input, 1.0);
    }

    fn see(&self, h: f64, state: &mut State) -> Sight {
        state.set_vector(&self.here, &self.body.frequencies);
        let mut velocity = vec![0.0; self.here.len()];
        let driven = Drifting { body: &self.body, moment: self.moment, departed: self.departed };
        driven.rate(h, self.here.as_slice(), &mut velocity);
        let sum = |z: &[f64], first: usize| z.iter().skip(first).step_by(2).sum();
        let z = self.here.as_slice();
        Sight { angle: sum(z, 0), rate: sum(z, 1), acceleration: sum(&velocity, 1) }
    }
}

/// z' = A(t) z + g m.
struct Drifting<'a> {
    body: &'a Wheeled,
    moment: f64,
    departed: f64,
}

impl Field for Drifting<'_> {
    fn rate(&self, t: f64, z: &[f64], rate: &mut [f64]) {
        let Wheeled { system: Coupled { system, input, .. }, frequencies, drags, drift, .. } = self.body;
        let order = z.len();
        for (row, rate) in rate.iter_mut().enumerate() {
            *rate = input[row] * self.moment
                + (0..order).map(|column| system[(row, column)] * z[column]).sum::<f64>();
        }
        let Some(drift) = drift else { return };
        let now = self.departed + t;
        for (mode, (w, drag)) in frequencies.iter().zip(drags).enumerate() {
            let ratio = drift.ratio(mode, now);
            let (x, v) = (2 + 2 * mode, 3 + 2 * mode);
            // The system has the stiffness w² and the drag 2 zeta w of the ratio 1.
            rate[v] -= w * w * (ratio * ratio - 1.0) * z[x] + drag * (ratio - 1.0) * z[v];
        }
    }
}
