//! The planar body with modes that are not independent: coupled by a wheel's back-EMF or damping, or with drifting
//! frequencies.
//!
//! At constant frequencies the motion under a constant input is that of the matrix exponential, or in closed form by
//! its poles; with drifting ones it is a Taylor series, restarted at the kinks of their profiles.

use std::sync::Arc as Shared;

use flexsc_numerics::phasor::abs;
use flexsc_numerics::time::Span;
use nalgebra::{DMatrix, DVector, RowDVector};

use super::{CoupledMatrices, DriftingFlow};
use crate::axis_model::AxisModel;
use crate::crossing::{Crossing, first_crossing};
use crate::frequency_drift::FrequencyDrift;
use crate::guard::Guard;
use crate::linear::{LinearFlow, LinearOutput, LinearSegment, ModalState, OutputGuard};
use crate::polynomial_piece::{self, SeriesExpansion};
use crate::{AngleObservation, AxisState};

/// Number of cached transitions, the newest last: a run has few different periods.
const KEPT: usize = 8;

/// Motion of a coupled body under a constant input.
#[derive(Clone, Debug)]
pub struct CoupledFlow {
    mobility: f64,
    frequencies: Vec<f64>,
    here: DVector<f64>,
    flow: CoupledMethod,
}

/// Method by which the motion is computed.
#[derive(Clone, Debug)]
enum CoupledMethod {
    Constant(TransitionFlow),
    Linear(Box<PoleFlow>),
    Drifting(DriftingFlow),
}

/// Motion at constant frequencies, in closed form.
#[derive(Clone, Debug)]
struct PoleFlow {
    system: CoupledMatrices,
    /// Reduced moment (rad/s²); `from` is z at departure.
    moment: f64,
    from: DVector<f64>,
    flow: Shared<LinearFlow>,
    segment: LinearSegment,
    here: ModalState,
    seen: LinearOutput,
    levels: Vec<OutputGuard>,
}

/// Motion that a batch computes for this run, before its first departure.
#[derive(Clone, Debug)]
pub enum ExternalMotion {
    /// Motion with drifting frequencies.
    Drifting(Box<DriftingFlow>),
    /// Motion with constant frequencies.
    Constant(Box<TransitionFlow>),
}

impl ExternalMotion {
    /// Returns the angles of all coordinates at departure, then their rates.
    pub fn start(&self) -> Vec<f64> {
        match self {
            Self::Drifting(drifting) => drifting.start().to_vec(),
            Self::Constant(constant) => {
                let of = |first: usize| constant.from.iter().skip(first).step_by(2);
                of(0).chain(of(1)).copied().collect()
            }
        }
    }

    /// Returns the motion, if its frequencies drift.
    pub fn drifting(&self) -> Option<&DriftingFlow> {
        if let Self::Drifting(drifting) = self { Some(drifting) } else { None }
    }

    /// Returns the motion, if its frequencies are constant.
    pub fn constant(&self) -> Option<&TransitionFlow> {
        if let Self::Constant(constant) = self { Some(constant) } else { None }
    }
}

/// Motion at constant frequencies, by transition matrices.
#[derive(Clone, Debug)]
pub struct TransitionFlow {
    system: CoupledMatrices,
    /// Acceleration of the angle: a row vector to multiply z, and the value per unit of the moment.
    acceleration: (RowDVector<f64>, f64),
    /// Reduced moment (rad/s²); `from` is z at departure.
    moment: f64,
    from: DVector<f64>,
    /// Upper bound of the rate of change of the motion (rad/s).
    fastest: f64,
    /// Cached time spans (s) with their transitions.
    transitions: Vec<(f64, DMatrix<f64>, DVector<f64>)>,
}

impl CoupledFlow {
    /// Creates the motion of a body from its initial state, under no input, by the poles of its flow. A wheel's
    /// back-EMF a (1/s) acts on the total rate if `total` is true, else on the rigid rate.
    pub fn by_poles(body: &AxisModel, flow: &Shared<LinearFlow>, back_emf: f64, total: bool) -> Self {
        let frequencies: Vec<f64> = body.modes.iter().map(|mode| mode.frequency.get()).collect();
        let start = body.initial_state().to_vector(&frequencies);
        let (segment, here) = (LinearSegment::new(Shared::clone(flow)), flow.to_modal(&start));
        let poles = PoleFlow {
            system: CoupledMatrices::new(body, back_emf, total, &vec![1.0; frequencies.len()]),
            moment: 0.0,
            from: start.clone(),
            flow: Shared::clone(flow),
            segment,
            here,
            seen: LinearOutput::default(),
            levels: Vec::with_capacity(2),
        };
        Self {
            mobility: 1.0 / body.inertia.get(),
            frequencies,
            here: start,
            flow: CoupledMethod::Linear(Box::new(poles)),
        }
    }

    /// Creates the motion of a body from its initial state, under no input. A wheel's back-EMF a (1/s) acts on the
    /// total rate if `total` is true, else on the rigid rate.
    pub fn new(body: &AxisModel, drift: Option<&FrequencyDrift>, back_emf: f64, total: bool) -> Self {
        let frequencies: Vec<f64> = body.modes.iter().map(|mode| mode.frequency.get()).collect();
        let here = body.initial_state().to_vector(&frequencies);
        let flow = drift.map_or_else(
            || {
                let system = CoupledMatrices::new(body, back_emf, total, &vec![1.0; frequencies.len()]);
                let pushed = (&system.rate * &system.input)[0];
                let modes = body.modes.iter();
                let fastest =
                    modes.clone().map(|mode| super::mode::ModeFlow::new(mode).fastest()).fold(0.0, f64::max);
                let gains: f64 = modes.map(|mode| mode.gain.get().abs()).sum();
                CoupledMethod::Constant(TransitionFlow {
                    acceleration: (&system.rate * &system.system, pushed),
                    system,
                    moment: 0.0,
                    from: here.clone(),
                    fastest: fastest + back_emf.abs() * (1.0 + gains),
                    transitions: Vec::with_capacity(KEPT),
                })
            },
            |drift| CoupledMethod::Drifting(DriftingFlow::new(body, drift, back_emf, total)),
        );
        Self { mobility: 1.0 / body.inertia.get(), frequencies, here, flow }
    }

    /// Begins a motion under another constant input (N m), from the current state, at the time `now` (s).
    pub fn depart(&mut self, now: f64, input: f64) {
        let moment = input * self.mobility;
        match &mut self.flow {
            CoupledMethod::Constant(constant) => {
                constant.moment = moment;
                constant.from.copy_from(&self.here);
            }
            CoupledMethod::Linear(poles) => {
                poles.moment = moment;
                poles.from.copy_from(&self.here);
                poles.segment.depart(&poles.here, &[moment]);
            }
            CoupledMethod::Drifting(drifting) => drifting.depart(now, moment),
        }
    }

    /// Returns a copy of the motion for a batch to compute, with the acceleration per unit of torque (1/(kg m²));
    /// `None` for a motion by poles.
    pub fn take_motion(&self) -> Option<(ExternalMotion, f64)> {
        let borrowed = match &self.flow {
            CoupledMethod::Drifting(drifting) => ExternalMotion::Drifting(Box::new(drifting.clone())),
            CoupledMethod::Constant(constant) => ExternalMotion::Constant(Box::new(constant.clone())),
            CoupledMethod::Linear(_) => return None,
        };
        Some((borrowed, self.mobility))
    }

    /// Advances by some steps towards `h` seconds after departure; returns true if that time is reached.
    pub fn approach(&mut self, h: f64) -> bool {
        match &mut self.flow {
            CoupledMethod::Constant(_) | CoupledMethod::Linear(_) => true,
            CoupledMethod::Drifting(drifting) => drifting.approach(h),
        }
    }

    /// Writes the state at `h` seconds after departure, which must not precede an earlier request; returns the motion
    /// at the sensor.
    pub fn at(&mut self, h: f64, state: &mut AxisState) -> AngleObservation {
        let sensed = match &mut self.flow {
            CoupledMethod::Constant(constant) => constant.go(h, &mut self.here),
            CoupledMethod::Linear(poles) => {
                poles.segment.at(h, &mut poles.seen);
                poles.segment.state_at(h, &mut poles.here);
                self.here = poles.flow.to_state(&poles.here);
                poles.seen.outputs[0]
            }
            CoupledMethod::Drifting(drifting) => {
                drifting.advance(h);
                let mut sensed = AngleObservation::default();
                for (index, [angle, rate, acceleration]) in drifting.motion().enumerate() {
                    (self.here[2 * index], self.here[2 * index + 1]) = (angle, rate);
                    sensed.angle += angle;
                    sensed.rate += rate;
                    sensed.acceleration += acceleration;
                }
                sensed
            }
        };
        state.from_vector(&self.here, &self.frequencies);
        sensed
    }

    /// Returns the first guard of the angle that trips on this motion within `horizon`. Only the closed form finds one;
    /// laws with guards of a continuous sensor use that form.
    ///
    /// # Errors
    /// An error of `go_on` ends the search.
    pub fn trip<E>(
        &mut self,
        guards: &[Guard],
        horizon: Span,
        go_on: impl FnMut() -> Result<(), E>,
    ) -> Result<Option<Crossing<()>>, E> {
        let CoupledMethod::Linear(poles) = &mut self.flow else { return Ok(None) };
        poles.levels.clear();
        poles.levels.extend(guards.iter().map(|guard| OutputGuard { output: 0, guard: *guard }));
        first_crossing(&poles.segment, &poles.levels, horizon, &mut poles.seen, go_on)
    }
}

/// Taylor expansion of a motion from its departure on.
#[derive(Clone, Debug)]
pub enum CoupledExpansion<'a> {
    /// Expansion at constant frequencies.
    Linear(polynomial_piece::LinearExpansion),
    /// Expansion with drifting frequencies: the present motion, and a copy of it once the expansion goes beyond its
    /// first series.
    Drifting(&'a DriftingFlow, Option<Box<DriftingFlow>>),
}

impl CoupledFlow {
    /// Returns the Taylor expansion of the motion from its departure on.
    pub fn expansion(&self) -> CoupledExpansion<'_> {
        match &self.flow {
            CoupledMethod::Constant(constant) => {
                let push = &constant.system.input * constant.moment;
                CoupledExpansion::Linear(polynomial_piece::LinearExpansion::new(
                    &constant.system.system,
                    push,
                    &constant.from,
                    constant.fastest,
                ))
            }
            CoupledMethod::Linear(poles) => {
                let push = &poles.system.input * poles.moment;
                let fastest = poles.flow.poles().into_iter().map(abs).fold(0.0, f64::max);
                CoupledExpansion::Linear(polynomial_piece::LinearExpansion::new(
                    &poles.system.system,
                    push,
                    &poles.from,
                    fastest,
                ))
            }
            CoupledMethod::Drifting(drifting) => CoupledExpansion::Drifting(drifting, None),
        }
    }
}

impl CoupledExpansion<'_> {
    /// Expands all coordinates at `h` seconds after departure, which must not precede an earlier request. Returns the
    /// time for which the series are valid (s), infinite if that covers the rest of `span`.
    pub fn expand(&mut self, h: f64, span: f64, into: &mut SeriesExpansion) -> f64 {
        match self {
            Self::Linear(linear) => {
                let reach = linear.expand(h);
                // Angles and rates alternate.
                for (x, series) in into.coordinates.iter_mut().zip(linear.series().iter().step_by(2)) {
                    *x = *series;
                }
                reach
            }
            Self::Drifting(motion, _) if h == 0.0 && motion.is_at_start() => {
                motion.write_series(span, &mut into.coordinates)
            }
            Self::Drifting(motion, again) => {
                let again = again.get_or_insert_with(|| Box::new(motion.restarted()));
                again.expand_to(h);
                again.write_series(span - h, &mut into.coordinates)
            }
        }
    }
}

impl TransitionFlow {
    /// Returns the system matrices.
    pub fn system(&self) -> &CoupledMatrices {
        &self.system
    }

    /// Returns an upper bound of the rate of change of the motion (rad/s).
    pub fn fastest(&self) -> f64 {
        self.fastest
    }

    /// Advances by the transition over `h` seconds from departure.
    fn go(&mut self, h: f64, here: &mut DVector<f64>) -> AngleObservation {
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
        AngleObservation {
            angle: dot(&self.system.angle),
            rate: dot(&self.system.rate),
            acceleration: dot(&self.acceleration.0) + self.acceleration.1 * self.moment,
        }
    }
}
