//! The planar body where its modes do not move on their own: coupled by a wheel's back-EMF, or with frequencies that drift.
//!
//! At constant frequencies the motion under a constant input is that of the matrix exponential; with drifting ones it is
//! a Taylor series, anew between the kinks of their profiles.

use nalgebra::{DMatrix, DVector, RowDVector};

use super::{Coupled, Drift, Drifting, Planar, Sight, State};

/// So many transitions are kept, the newest last: the periods of a run are few.
const KEPT: usize = 8;

/// A motion under a constant input.
#[derive(Clone, Debug)]
pub struct Coupling {
    mobility: f64,
    frequencies: Vec<f64>,
    here: DVector<f64>,
    flow: Flow,
}

/// How the body moves.
#[derive(Clone, Debug)]
enum Flow {
    Constant(Constant),
    Drifting(Drifting),
}

/// A motion at constant frequencies.
#[derive(Clone, Debug)]
struct Constant {
    system: Coupled,
    /// The acceleration of the angle is this times z, and so much for each unit of the moment.
    acceleration: (RowDVector<f64>, f64),
    /// Reduced moment (rad/s²), and z at departure.
    moment: f64,
    from: DVector<f64>,
    /// Spans (s) with their transitions.
    transitions: Vec<(f64, DMatrix<f64>, DVector<f64>)>,
}

impl Coupling {
    /// A body at its start, under no input. A wheel takes back-EMF a (1/s) from the total rate, or from the rigid one.
    pub fn new(body: &Planar, drift: Option<&Drift>, back_emf: f64, total: bool) -> Self {
        let frequencies: Vec<f64> = body.modes.iter().map(|mode| mode.frequency.get()).collect();
        let here = body.start().to_vector(&frequencies);
        let flow = drift.map_or_else(
            || {
                let system = Coupled::new(body, back_emf, total, &vec![1.0; frequencies.len()]);
                let pushed = (&system.rate * &system.input)[0];
                Flow::Constant(Constant {
                    acceleration: (&system.rate * &system.system, pushed),
                    system,
                    moment: 0.0,
                    from: here.clone(),
                    transitions: Vec::with_capacity(KEPT),
                })
            },
            |drift| Flow::Drifting(Drifting::new(body, drift, back_emf, total)),
        );
        Self { mobility: 1.0 / body.inertia.get(), frequencies, here, flow }
    }

    /// Begins a motion under another constant input (N m), from where the body was seen last, at a time (s).
    pub fn depart(&mut self, now: f64, input: f64) {
        let moment = input * self.mobility;
        match &mut self.flow {
            Flow::Constant(constant) => {
                constant.moment = moment;
                constant.from.copy_from(&self.here);
            }
            Flow::Drifting(drifting) => drifting.depart(now, moment),
        }
    }

    /// Takes some steps towards `h` seconds after departure; whether no more are needed.
    pub fn approach(&mut self, h: f64) -> bool {
        match &mut self.flow {
            Flow::Constant(_) => true,
            Flow::Drifting(drifting) => drifting.approach(h),
        }
    }

    /// The state `h` seconds after departure, not before one asked for earlier, and what a sensor sees.
    pub fn at(&mut self, h: f64, state: &mut State) -> Sight {
        let sight = match &mut self.flow {
            Flow::Constant(constant) => constant.go(h, &mut self.here),
            Flow::Drifting(drifting) => {
                drifting.go(h);
                let mut sight = Sight::default();
                for (index, [angle, rate, acceleration]) in drifting.motion().enumerate() {
                    (self.here[2 * index], self.here[2 * index + 1]) = (angle, rate);
                    sight.angle += angle;
                    sight.rate += rate;
                    sight.acceleration += acceleration;
                }
                sight
            }
        };
        state.set_vector(&self.here, &self.frequencies);
        sight
    }
}

impl Constant {
    /// Moves by the transition over `h` seconds.
    fn go(&mut self, h: f64, here: &mut DVector<f64>) -> Sight {
        let kept = self.transitions.iter().position(|(span, ..)| *span == h);
        let index = kept.unwrap_or_else(|| {
            let (transition, input) = self.system.discrete(h);
            if self.transitions.len() == KEPT {
                self.transitions.remove(0);
            }
            self.transitions.push((h, transition, input));
            self.transitions.len() - 1
        });
        let (_, transition, input) = &self.transitions[index];
        here.gemv(1.0, transition, &self.from, 0.0);
        here.axpy(self.moment, input, 1.0);
        let dot = |row: &RowDVector<f64>| row.iter().zip(here.iter()).map(|(a, z)| a * z).sum::<f64>();
        Sight {
            angle: dot(&self.system.angle),
            rate: dot(&self.system.rate),
            acceleration: dot(&self.acceleration.0) + self.acceleration.1 * self.moment,
        }
    }
}
