//! Small rotation about three axes under constant torques, in closed form, with the bounds that certify crossings.
//!
//! Linear motion about a fixed attitude: theta'' = J^-1 M, and q_i'' + 2 zeta_i w_i q_i' + w_i² q_i = f_i for each free
//! mode. The angle at the sensor about an axis is theta + sum_i psi_i q_i, with the rotation psi_i of the sensor by the
//! mode. About each axis that is a parabola plus oscillators, which have the bounds of the motion about one axis
//! (`docs/events.md`, certified search).

use std::array::from_fn;

use crate::axis_model::AxisMode;
use crate::crossing::{BoundedMotion, DerivativeBounds, first_root};
use crate::guard::Guard;
use crate::three_axis_model::{SmallAngleBounds, ThreeAxisMode, ThreeAxisModel};
use crate::{AngleObservation, ModeState};
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::quantity::Finite;
use flexsc_numerics::time::Span;

use super::mode::ModeFlow;

/// Small rotation of the mean axes, and the free modes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SmallAngleState {
    /// Rotation vector from the target (rad), in the body's axes.
    pub angles: Vector,
    /// Rates (rad/s).
    pub rates: Vector,
    /// Phase of each mode: displacement (m sqrt(kg)), and rate over natural frequency.
    pub modes: Vec<ModeState>,
}

/// Guard on the angle of the sensor about an axis.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SmallAngleGuard {
    /// Axis: 0 to 2 for roll, pitch and yaw.
    pub axis: usize,
    /// Index of the guard among those about its axis.
    pub index: usize,
    /// Threshold of the angle.
    pub guard: Guard,
}

/// Motion under constant loads, from the state in which it began.
#[derive(Clone, Debug)]
pub struct SmallAngleSegment {
    modes: Vec<ModeSegment>,
    angles: Vector,
    rates: Vector,
    /// Angular acceleration of the mean axes (rad/s²).
    acceleration: Vector,
    /// Bounds of the angle at the sensor about each axis.
    bounds: [AxisBounds; 3],
}

/// Free mode on a segment: its equilibrium, and its deviation from it at departure.
#[derive(Clone, Debug)]
struct ModeSegment {
    flow: ModeFlow,
    /// Rotation of the sensor (rad/(m sqrt(kg))).
    rotation: Vector,
    equilibrium: f64,
    from: ModeState,
}

/// Bounds of the elastic part of an angle on a segment.
#[derive(Copy, Clone, Debug, Default)]
struct AxisBounds {
    /// Sum of the modes' equilibria (rad), and (`reach`) of their largest distances from them.
    centre: f64,
    reach: f64,
    derivatives: DerivativeBounds,
}

impl SmallAngleSegment {
    /// Creates the segment of a body whose modes rotate the sensor by `rotations` (rad/(m sqrt(kg))), before its
    /// departure.
    pub fn new(body: &ThreeAxisModel, rotations: &[Vector]) -> Self {
        let mode = |(mode, rotation): (&ThreeAxisMode, &Vector)| ModeSegment {
            flow: ModeFlow::new(&AxisMode::at_rest(mode.frequency, Finite::default(), mode.damping)),
            rotation: *rotation,
            equilibrium: 0.0,
            from: ModeState::default(),
        };
        Self {
            modes: body.modes.iter().zip(rotations).map(mode).collect(),
            angles: Vector::zeros(),
            rates: Vector::zeros(),
            acceleration: Vector::zeros(),
            bounds: [AxisBounds::default(); 3],
        }
    }

    /// Begins the segment anew from a state, under an angular acceleration (rad/s²) and modal forces (N/sqrt(kg)).
    pub fn depart(&mut self, from: &SmallAngleState, acceleration: Vector, forces: &[f64]) {
        (self.angles, self.rates, self.acceleration) = (from.angles, from.rates, acceleration);
        let derivatives = |axis: usize| DerivativeBounds { curvature: acceleration[axis].abs(), jerk: 0.0 };
        self.bounds = from_fn(|axis| AxisBounds { derivatives: derivatives(axis), ..AxisBounds::default() });
        for ((mode, phase), force) in self.modes.iter_mut().zip(&from.modes).zip(forces) {
            let flow = &mode.flow;
            mode.equilibrium = force / (flow.frequency * flow.frequency);
            let displacement = phase.displacement - mode.equilibrium;
            mode.from = ModeState { displacement, quadrature: phase.quadrature };
            let distance = f64::sqrt(displacement * displacement + phase.quadrature * phase.quadrature);
            for (bounds, rotation) in self.bounds.iter_mut().zip(&mode.rotation) {
                let reach = rotation.abs() * distance;
                bounds.centre += rotation * mode.equilibrium;
                bounds.reach += reach;
                bounds.derivatives.curvature += flow.stiffness * reach;
                bounds.derivatives.jerk += flow.jerk * reach;
            }
        }
    }

    /// Writes the state at `h` seconds after departure, and returns the motion at the sensor about each axis.
    pub fn at(&self, h: f64, state: &mut SmallAngleState) -> [AngleObservation; 3] {
        state.angles = self.angles + h * (self.rates + 0.5 * self.acceleration * h);
        state.rates = self.rates + self.acceleration * h;
        for (mode, phase) in self.modes.iter().zip(&mut state.modes) {
            let [xx, xy, yx, yy] = mode.flow.evaluate(h);
            let ModeState { displacement: x, quadrature: y } = mode.from;
            let displacement = mode.equilibrium + (xx * x + xy * y);
            *phase = ModeState { displacement, quadrature: yx * x + yy * y };
        }
        self.sensed(state)
    }

    /// Returns the motion at the sensor about each axis in a state of this segment.
    fn sensed(&self, state: &SmallAngleState) -> [AngleObservation; 3] {
        let mut sensed = from_fn(|axis| AngleObservation {
            angle: state.angles[axis],
            rate: state.rates[axis],
            acceleration: self.acceleration[axis],
        });
        for (mode, phase) in self.modes.iter().zip(&state.modes) {
            let flow = &mode.flow;
            let [rate, quadrature_rate] =
                flow.velocity(phase.displacement - mode.equilibrium, phase.quadrature);
            for (sensed, rotation) in sensed.iter_mut().zip(&mode.rotation) {
                sensed.angle += rotation * phase.displacement;
                sensed.rate += rotation * rate;
                sensed.acceleration += rotation * (flow.frequency * quadrature_rate);
            }
        }
        sensed
    }

    /// Returns the first time after departure (s) at which the mean axes reach a limit, with the axis, and true if it is
    /// that of the rate; `None` if they never do.
    pub fn first_limit(&self, limits: &SmallAngleBounds) -> Option<(f64, usize, bool)> {
        let (largest, fastest) = (limits.angle, limits.rate);
        let mut first = (f64::INFINITY, 0, false);
        for axis in 0..3 {
            for towards in [1.0, -1.0] {
                let [angle, rate, acceleration] =
                    [self.angles, self.rates, self.acceleration].map(|of| towards * of[axis]);
                let far = if angle > largest { 0.0 } else { first_root(largest - angle, rate, acceleration) };
                let fast = match fastest - rate {
                    left if left < 0.0 => 0.0,
                    left if acceleration > 0.0 => left / acceleration,
                    _ => f64::INFINITY,
                };
                for (at, is_rate) in [(far, false), (fast, true)] {
                    if at < first.0 {
                        first = (at, axis, is_rate);
                    }
                }
            }
        }
        (first.0 < f64::INFINITY).then_some(first)
    }
}

impl BoundedMotion for SmallAngleSegment {
    type Guard = SmallAngleGuard;
    type State = SmallAngleState;
    type Observation = [AngleObservation; 3];

    fn initial(&self, state: &mut SmallAngleState) -> [AngleObservation; 3] {
        (state.angles, state.rates) = (self.angles, self.rates);
        for (mode, phase) in self.modes.iter().zip(&mut state.modes) {
            let displacement = mode.equilibrium + mode.from.displacement;
            *phase = ModeState { displacement, ..mode.from };
        }
        self.sensed(state)
    }

    fn evaluate(&self, h: f64, state: &mut SmallAngleState) -> [AngleObservation; 3] {
        self.at(h, state)
    }

    fn is_finite(_: &SmallAngleState, sensed: [AngleObservation; 3]) -> bool {
        sensed.iter().all(|sensed| sensed.angle.is_finite())
    }

    fn holds(guard: SmallAngleGuard, _: &SmallAngleState, sensed: [AngleObservation; 3]) -> bool {
        guard.guard.holds(sensed[guard.axis].angle)
    }

    fn bounds_valid_for(_: &SmallAngleState) -> f64 {
        f64::INFINITY
    }

    /// Returns a time before which the parabola of the mean axes, with all modes at full amplitude towards the guard,
    /// stays short of its level.
    fn earliest_crossing(&self, guard: SmallAngleGuard, _: Span, _: &SmallAngleState) -> f64 {
        let SmallAngleGuard { axis, guard, .. } = guard;
        let (bounds, towards) = (&self.bounds[axis], guard.side.sign());
        let gap = towards * (guard.level - self.angles[axis] - bounds.centre) - bounds.reach;
        if gap <= 0.0 {
            return 0.0;
        }
        first_root(gap, towards * self.rates[axis], towards * self.acceleration[axis])
    }

    fn safe_stride(&self, guard: SmallAngleGuard, _: &SmallAngleState, sensed: [AngleObservation; 3]) -> f64 {
        self.bounds[guard.axis].derivatives.safe_stride(guard.guard, sensed[guard.axis])
    }

    fn has_no_crossing(
        &self,
        guard: SmallAngleGuard,
        _: &SmallAngleState,
        sensed: [AngleObservation; 3],
        time: f64,
    ) -> bool {
        self.bounds[guard.axis].derivatives.has_no_crossing(guard.guard, sensed[guard.axis], time)
    }
}
