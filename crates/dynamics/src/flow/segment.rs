//! Motion of the planar body under one input, in closed form, with the bounds that certify crossings.

mod predicted_crossing;

use flexsc_numerics::polynomial::TERMS;
use flexsc_numerics::time::Span;
use nalgebra::DVector;

use super::mode::ModeFlow;
use super::modes_simd::ModesSimd;
use super::waveform_response::{ActiveWaveform, ForcedResponse, SegmentInput};
use crate::axis_model::{AxisModel, CommandedQuantity};
use crate::crossing::{BoundedMotion, DerivativeBounds, first_root};
use crate::guard::Guard;
use crate::polynomial_piece::{REACH, SeriesExpansion};
use crate::{AngleObservation, AxisState, ModeState};
use predicted_crossing::CrossingPredictor;

/// Motion under one input, from the state in which it began.
#[derive(Clone, Debug)]
pub struct UncoupledSegment {
    mobility: f64,
    /// True if the modes contribute to the hub's angle.
    visible: bool,
    forced: Option<ActiveWaveform>,
    moment: f64,
    angle: f64,
    rate: f64,
    modes: Vec<ModeSegment>,
    /// Modes in groups of lanes, if that is faster.
    abreast: Option<ModesSimd>,
    /// Sum of the modes' equilibria; `reach` is the sum of their largest distances from them (rad).
    centre: f64,
    reach: f64,
    /// Upper bound of |x''| on the segment (rad/s²).
    curvature: f64,
    /// Upper bound of |x'''| on the segment (rad/s³).
    jerk: f64,
    /// Predictor of the next trip, if the body allows one.
    guess: Option<CrossingPredictor>,
}

/// One mode on a segment: its equilibrium, and its deviation from it at departure.
#[derive(Clone, Debug)]
struct ModeSegment {
    flow: ModeFlow,
    equilibrium: f64,
    from: ModeState,
}

impl UncoupledSegment {
    /// Creates the segment of a body, before its departure.
    pub fn new(body: &AxisModel) -> Self {
        let swing =
            |mode| ModeSegment { flow: ModeFlow::new(mode), equilibrium: 0.0, from: ModeState::default() };
        let visible = body.drive == CommandedQuantity::Torque;
        Self {
            mobility: 1.0 / body.commanded_inertia(),
            visible,
            forced: None,
            moment: 0.0,
            angle: 0.0,
            rate: 0.0,
            modes: body.modes.iter().map(swing).collect(),
            abreast: ModesSimd::new(&body.modes),
            centre: 0.0,
            reach: 0.0,
            curvature: 0.0,
            jerk: 0.0,
            guess: visible.then(|| CrossingPredictor::new(body)).flatten(),
        }
    }

    /// Begins the segment anew from a state, under an input. The bounds, and so guards, hold for the constant part
    /// only.
    pub fn depart(&mut self, from: &AxisState, input: &SegmentInput) {
        self.moment = input.constant * self.mobility;
        self.forced.clone_from(&input.waveform);
        self.angle = from.rigid_angle;
        self.rate = from.rigid_rate;
        self.centre = 0.0;
        self.reach = 0.0;
        self.curvature = self.moment.abs();
        self.jerk = 0.0;
        for (index, (swing, phase)) in self.modes.iter_mut().zip(&from.modes).enumerate() {
            let equilibrium = swing.flow.excitability * self.moment;
            let displacement = phase.displacement - equilibrium;
            swing.equilibrium = equilibrium;
            swing.from = ModeState { displacement, quadrature: phase.quadrature };
            if let Some(abreast) = &mut self.abreast {
                abreast.set_mode(index, swing.from);
            }
            let distance = f64::sqrt(displacement * displacement + phase.quadrature * phase.quadrature);
            if !self.visible {
                continue;
            }
            self.centre += equilibrium;
            self.reach += distance;
            self.curvature += swing.flow.stiffness * distance;
            self.jerk += swing.flow.jerk * distance;
        }
    }

    /// Writes the state at `h` seconds after departure, and returns the motion at the sensor.
    #[allow(clippy::inline_always, reason = "the search for crossings calls it")]
    #[inline(always)]
    pub fn at(&self, h: f64, state: &mut AxisState) -> AngleObservation {
        state.rigid_angle = self.angle + h * (self.rate + 0.5 * self.moment * h);
        state.rigid_rate = self.rate + self.moment * h;
        let mut sensed =
            AngleObservation { angle: state.rigid_angle, rate: state.rigid_rate, acceleration: self.moment };
        match &self.abreast {
            Some(abreast) if abreast.is_valid_for(h) => abreast.evaluate(h, &mut state.modes),
            _ => self.turn_each(h, &mut state.modes),
        }
        for (swing, phase) in self.modes.iter().zip(&mut state.modes) {
            let deviation = phase.displacement;
            phase.displacement = swing.equilibrium + deviation;
            if self.visible {
                swing.flow.add_to(swing.equilibrium, deviation, phase.quadrature, &mut sensed);
            }
        }
        if let Some(forced) = &self.forced {
            self.add_forced(forced, h, state, &mut sensed);
        }
        sensed
    }

    /// Writes the deviations of the modes from their equilibria, one mode after another.
    #[inline]
    fn turn_each(&self, h: f64, to: &mut [ModeState]) {
        for (swing, phase) in self.modes.iter().zip(to) {
            let [xx, xy, yx, yy] = swing.flow.evaluate(h);
            let ModeState { displacement: x, quadrature: y } = swing.from;
            *phase = ModeState { displacement: xx * x + xy * y, quadrature: yx * x + yy * y };
        }
    }

    /// Adds the response to the waveform at `h` seconds after departure. Not inlined, so that the search for crossings,
    /// which has no waveform, stays small.
    #[inline(never)]
    fn add_forced(
        &self,
        forced: &ActiveWaveform,
        h: f64,
        state: &mut AxisState,
        sensed: &mut AngleObservation,
    ) {
        let mut show = |push: ForcedResponse| {
            sensed.angle += push.angle;
            sensed.rate += push.rate;
            sensed.acceleration += push.acceleration;
        };
        let rigid = forced.rigid(h).scaled(self.mobility);
        state.rigid_angle += rigid.angle;
        state.rigid_rate += rigid.rate;
        show(rigid);
        for (swing, phase) in self.modes.iter().zip(&mut state.modes) {
            let push = forced.mode(&swing.flow, h).scaled(self.mobility);
            phase.displacement += push.angle;
            phase.quadrature += push.rate / swing.flow.frequency;
            if self.visible {
                show(push);
            }
        }
    }

    /// Expands all coordinates at `h` seconds after departure, and returns the time for which the series are valid (s).
    /// The waveform must have no break until 2 `middle` after departure (s).
    pub fn expand(&self, h: f64, middle: f64, state: &mut AxisState, into: &mut SeriesExpansion) -> f64 {
        self.at(h, state);
        let mut fastest = 0.0_f64;
        if let Some(forced) = &self.forced {
            into.command = forced.series(middle, h);
            fastest = forced.fastest();
        }
        let mut moment = into.command.map(|c| self.mobility * c);
        moment[0] += self.moment;
        let [rigid, modes @ ..] = &mut into.coordinates[..] else { return f64::INFINITY };
        (rigid[0], rigid[1]) = (state.rigid_angle, state.rigid_rate);
        for n in 0..TERMS - 2 {
            rigid[n + 2] = moment[n] / ((n + 1) * (n + 2)) as f64;
        }
        for ((swing, phase), x) in self.modes.iter().zip(&state.modes).zip(modes) {
            let flow = &swing.flow;
            (x[0], x[1]) = (phase.displacement, flow.frequency * phase.quadrature);
            for n in 0..TERMS - 2 {
                let back = flow.velocity(flow.frequency * x[n], (n + 1) as f64 * x[n + 1])[1];
                x[n + 2] = (flow.gain * moment[n] + back) / ((n + 1) * (n + 2)) as f64;
            }
            fastest = fastest.max(flow.fastest());
        }
        REACH / fastest
    }

    /// Returns true if the modes contribute to the hub's angle.
    pub fn sensor_sees_modes(&self) -> bool {
        self.visible
    }

    /// Returns true if the bounds of the derivatives are valid: no waveform acts.
    pub fn has_bounds(&self) -> bool {
        self.forced.is_none()
    }

    /// Returns true if the angle is certain to stay within `band` (rad) of 0 for `span` seconds, because the rigid
    /// parabola plus the full amplitude of all modes does.
    pub fn stays_within(&self, band: f64, span: f64) -> bool {
        if !self.has_bounds() {
            return false;
        }
        let end = self.angle + span * (self.rate + 0.5 * self.moment * span);
        let (mut low, mut high) = (self.angle.min(end), self.angle.max(end));
        let turn = -self.rate / self.moment;
        if turn > 0.0 && turn < span {
            let crest = self.angle + 0.5 * self.rate * turn;
            (low, high) = (low.min(crest), high.max(crest));
        }
        high + self.centre + self.reach <= band && low + self.centre - self.reach >= -band
    }

    /// Returns the motion at the sensor at departure.
    #[inline]
    pub fn initial_output(&self) -> AngleObservation {
        let mut sensed = AngleObservation { angle: self.angle, rate: self.rate, acceleration: self.moment };
        let forced = self.forced.as_ref().map_or(0.0, |forced| forced.at(0.0) * self.mobility);
        sensed.acceleration += forced;
        for swing in self.modes.iter().filter(|_| self.visible) {
            let ModeState { displacement, quadrature } = swing.from;
            swing.flow.add_to(swing.equilibrium, displacement, quadrature, &mut sensed);
            sensed.acceleration += swing.flow.gain * forced;
        }
        sensed
    }

    /// Returns a time after departure (s) before which the guard cannot trip: until then the rigid parabola plus the
    /// full amplitude of all modes towards the guard stays short of its level.
    pub fn earliest_crossing(&self, guard: Guard) -> f64 {
        let towards = guard.side.sign();
        let gap = towards * (guard.level - self.angle - self.centre) - self.reach;
        if gap <= 0.0 {
            return 0.0;
        }
        first_root(gap, towards * self.rate, towards * self.moment)
    }

    /// Returns a time (s) for which the guard cannot trip, given the present motion at the sensor.
    #[inline]
    pub fn safe_stride(&self, guard: Guard, now: AngleObservation) -> f64 {
        self.bounds().safe_stride(guard, now)
    }

    /// Returns true if the guard cannot trip within `time` (s), given the present motion at the sensor.
    #[inline]
    pub fn has_no_crossing(&self, guard: Guard, now: AngleObservation, time: f64) -> bool {
        self.bounds().has_no_crossing(guard, now, time)
    }

    #[inline]
    fn bounds(&self) -> DerivativeBounds {
        DerivativeBounds { curvature: self.curvature, jerk: self.jerk }
    }

    /// Propagates a small deviation of the state over `h` seconds. Its components are the rigid angle and rate, then
    /// displacement and quadrature of each mode.
    pub fn propagate_deviation(&self, h: f64, deviation: &mut [f64]) {
        deviation[0] += h * deviation[1];
        for (swing, pair) in self.modes.iter().zip(deviation[2..].chunks_exact_mut(2)) {
            let [xx, xy, yx, yy] = swing.flow.evaluate(h);
            (pair[0], pair[1]) = (xx * pair[0] + xy * pair[1], yx * pair[0] + yy * pair[1]);
        }
    }

    /// Returns the time derivative of a state on this segment, in the components of [`UncoupledSegment::propagate_deviation`].
    pub fn velocity(&self, state: &AxisState) -> DVector<f64> {
        let mut velocity = vec![state.rigid_rate, self.moment];
        for (swing, phase) in self.modes.iter().zip(&state.modes) {
            let from_rest = phase.displacement - swing.equilibrium;
            velocity.extend(swing.flow.velocity(from_rest, phase.quadrature));
        }
        DVector::from_vec(velocity)
    }
}

impl BoundedMotion for UncoupledSegment {
    type Guard = Guard;
    type State = AxisState;
    type Observation = AngleObservation;

    #[inline]
    fn initial(&self, _: &mut AxisState) -> AngleObservation {
        self.initial_output()
    }

    #[allow(clippy::inline_always, reason = "the search calls it")]
    #[inline(always)]
    fn evaluate(&self, h: f64, state: &mut AxisState) -> AngleObservation {
        self.at(h, state)
    }

    #[inline]
    fn is_finite(_: &AxisState, sensed: AngleObservation) -> bool {
        sensed.angle.is_finite()
    }

    #[inline]
    fn holds(guard: Guard, _: &AxisState, sensed: AngleObservation) -> bool {
        guard.holds(sensed.angle)
    }

    #[inline]
    fn bounds_valid_for(_: &AxisState) -> f64 {
        f64::INFINITY
    }

    #[inline]
    fn earliest_crossing(&self, guard: Guard, _: Span, _: &AxisState) -> f64 {
        Self::earliest_crossing(self, guard)
    }

    #[inline]
    fn safe_stride(&self, guard: Guard, _: &AxisState, sensed: AngleObservation) -> f64 {
        Self::safe_stride(self, guard, sensed)
    }

    #[inline]
    fn has_no_crossing(&self, guard: Guard, _: &AxisState, sensed: AngleObservation, time: f64) -> bool {
        Self::has_no_crossing(self, guard, sensed, time)
    }
}
