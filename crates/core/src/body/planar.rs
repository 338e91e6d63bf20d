//! The planar body: one angle, any number of elastic modes, driven by one moment.
//!
//! x_r'' = m, x_i'' + 2 zeta_i w_i x_i' + w_i² x_i = k_i m, x = x_r + sum x_i, with m = torque / inertia
//! (seed paper 1, equation (1)). Under a constant torque the rigid part is a parabola and every mode turns
//! about its shifted equilibrium, so that no step size exists.

use nalgebra::DVector;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::forced::{Forced, Input, Push};
use super::mode::Flow;
use super::stretch::{Expansion, REACH};
use super::{Mode, Output, Phase, Sight, State};
use crate::crossing::first_root;
use crate::guard::Guard;
use crate::polynomial::TERMS;
use crate::quantity::{Finite, Positive};

/// A planar body as a scenario describes it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Planar {
    /// Moment of inertia (kg m²). Left out, it is 1, and every torque is a reduced moment (rad/s²).
    #[serde(default = "unit")]
    pub inertia: Positive,
    /// Rigid angle at the start (rad).
    #[serde(default)]
    pub angle: Finite,
    /// Rigid rate at the start (rad/s).
    #[serde(default)]
    pub rate: Finite,
    /// What is commanded.
    #[serde(default)]
    pub drive: Drive,
    /// Damping that couples the modes, beside their own ratios (1/s): x_i'' has also -sum_j `damping_matrix`\[i\]\[j\] x_j'.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub damping_matrix: Vec<Vec<Finite>>,
    /// Elastic modes.
    #[serde(default)]
    pub modes: Vec<Mode>,
    /// Coordinates that are observed beside the hub's angle.
    #[serde(default)]
    pub outputs: Vec<Output>,
}

/// What is commanded.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Drive {
    /// A torque (N m): the modes are those of the free body, and show in the hub's angle.
    #[default]
    Torque,
    /// The hub's own motion, as an acceleration (rad/s²): the modes are those of the body clamped at the hub, and do
    /// not show in the hub's angle (seed paper 2, equations (17) and (18)).
    Motion,
}

/// What a damping matrix needs.
pub const HUB_FREE: &str = "couples the modes of a body whose hub turns freely, not one whose hub's motion is given (`drive = \"motion\"`)";

fn unit() -> Positive {
    Positive::ONE
}

impl Default for Planar {
    /// A rigid body of unit inertia at rest.
    fn default() -> Self {
        Self {
            inertia: unit(),
            angle: Finite::default(),
            rate: Finite::default(),
            drive: Drive::default(),
            damping_matrix: Vec::new(),
            modes: Vec::new(),
            outputs: Vec::new(),
        }
    }
}

impl Planar {
    /// What single values cannot show to be wrong: the key, and what is wrong with it.
    pub fn inconsistency(&self) -> Option<(String, String)> {
        let modes = self.modes.len();
        self.damping_inconsistency().or_else(|| {
            self.outputs.iter().enumerate().find_map(|(index, output)| {
                let at = |key: &str, why: String| Some((format!("outputs[{index}].{key}"), why));
                if output.modes.len() != modes {
                    let found = output.modes.len();
                    return at(
                        "modes",
                        format!("must have one number for each of {modes} modes, got {found}"),
                    );
                }
                let before = self.outputs[..index].iter();
                if before.map(|other| &other.name).any(|name| *name == output.name) {
                    return at(
                        "name",
                        format!("must differ from the other names, got `{}` again", output.name),
                    );
                }
                None
            })
        })
    }

    fn damping_inconsistency(&self) -> Option<(String, String)> {
        let modes = self.modes.len();
        let rows = &self.damping_matrix;
        if rows.is_empty() {
            return None;
        }
        if self.drive == Drive::Motion {
            return Some(("damping_matrix".to_owned(), HUB_FREE.to_owned()));
        }
        if rows.len() != modes {
            let why = format!("must have one row for each of {modes} modes, got {}", rows.len());
            return Some(("damping_matrix".to_owned(), why));
        }
        let index = rows.iter().position(|row| row.len() != modes)?;
        let why = format!("must have one number for each of {modes} modes, got {}", rows[index].len());
        Some((format!("damping_matrix[{index}]"), why))
    }

    /// What a unit of the command accelerates (kg m²): 1 where the motion itself is commanded.
    pub fn commanded_inertia(&self) -> f64 {
        match self.drive {
            Drive::Torque => self.inertia.get(),
            Drive::Motion => 1.0,
        }
    }

    /// Whether the inertia is 1, as of a body that is described without one.
    pub fn has_unit_inertia(&self) -> bool {
        self.inertia == Positive::ONE
    }

    /// Whether what is commanded is an acceleration (rad/s²) and no torque (N m): the hub's motion, or the reduced moment
    /// of a body without inertia.
    pub fn commands_acceleration(&self) -> bool {
        self.drive == Drive::Motion || self.has_unit_inertia()
    }

    /// The unit of a torque on the body.
    pub fn torque_unit(&self) -> &'static str {
        if self.has_unit_inertia() { "rad/s²" } else { "N m" }
    }

    /// What is commanded, and its unit.
    pub fn commanded(&self) -> (&'static str, &'static str) {
        if self.commands_acceleration() { ("acceleration", "rad/s²") } else { ("torque", "N m") }
    }

    /// The state at the start of a run.
    pub fn start(&self) -> State {
        State {
            rigid_angle: self.angle.get(),
            rigid_rate: self.rate.get(),
            modes: self.modes.iter().map(Mode::start).collect(),
        }
    }
}

/// The motion under one input, from the state in which it began.
#[derive(Clone, Debug)]
pub struct Arc {
    mobility: f64,
    /// Whether the modes show in the hub's angle.
    visible: bool,
    forced: Option<Forced>,
    moment: f64,
    angle: f64,
    rate: f64,
    modes: Vec<Swing>,
    /// Sum of the modes' equilibria, and of their largest distances from them (rad).
    centre: f64,
    reach: f64,
    /// No |x''| on the arc is larger (rad/s²).
    curvature: f64,
    /// No |x'''| on the arc is larger (rad/s³).
    jerk: f64,
}

/// One mode on an arc: its equilibrium, and the deviation in which the arc began.
#[derive(Clone, Debug)]
struct Swing {
    flow: Flow,
    equilibrium: f64,
    from: Phase,
}

impl Arc {
    /// The arc of a body, not yet departed.
    pub fn new(body: &Planar) -> Self {
        let swing = |mode| Swing { flow: Flow::new(mode), equilibrium: 0.0, from: Phase::default() };
        Self {
            mobility: 1.0 / body.commanded_inertia(),
            visible: body.drive == Drive::Torque,
            forced: None,
            moment: 0.0,
            angle: 0.0,
            rate: 0.0,
            modes: body.modes.iter().map(swing).collect(),
            centre: 0.0,
            reach: 0.0,
            curvature: 0.0,
            jerk: 0.0,
        }
    }

    /// Begins the arc anew: from this state, under this input. Its bounds, and so guards, know the constant only.
    pub fn depart(&mut self, from: &State, input: &Input) {
        self.moment = input.constant * self.mobility;
        self.forced.clone_from(&input.waveform);
        self.angle = from.rigid_angle;
        self.rate = from.rigid_rate;
        self.centre = 0.0;
        self.reach = 0.0;
        self.curvature = self.moment.abs();
        self.jerk = 0.0;
        for (swing, phase) in self.modes.iter_mut().zip(&from.modes) {
            let equilibrium = swing.flow.excitability * self.moment;
            let displacement = phase.displacement - equilibrium;
            swing.equilibrium = equilibrium;
            swing.from = Phase { displacement, quadrature: phase.quadrature };
            let distance = libm::sqrt(displacement * displacement + phase.quadrature * phase.quadrature);
            if !self.visible {
                continue;
            }
            self.centre += equilibrium;
            self.reach += distance;
            self.curvature += swing.flow.stiffness * distance;
            self.jerk += swing.flow.jerk * distance;
        }
    }

    /// The state `h` seconds after departure, and what a sensor sees of it.
    #[allow(clippy::inline_always, reason = "the search for crossings calls it")]
    #[inline(always)]
    pub fn at(&self, h: f64, state: &mut State) -> Sight {
        state.rigid_angle = self.angle + h * (self.rate + 0.5 * self.moment * h);
        state.rigid_rate = self.rate + self.moment * h;
        let mut sight = Sight { angle: state.rigid_angle, rate: state.rigid_rate, acceleration: self.moment };
        for (swing, phase) in self.modes.iter().zip(&mut state.modes) {
            let [xx, xy, yx, yy] = swing.flow.transition(h);
            let Phase { displacement: x, quadrature: y } = swing.from;
            let deviation = xx * x + xy * y;
            phase.displacement = swing.equilibrium + deviation;
            phase.quadrature = yx * x + yy * y;
            if self.visible {
                swing.flow.add_sight(swing.equilibrium, deviation, phase.quadrature, &mut sight);
            }
        }
        if let Some(forced) = &self.forced {
            self.add_forced(forced, h, state, &mut sight);
        }
        sight
    }

    /// Adds what the waveform does within `h` seconds of departure; apart, so that the search for crossings, which knows
    /// no waveform, stays small.
    #[inline(never)]
    fn add_forced(&self, forced: &Forced, h: f64, state: &mut State, sight: &mut Sight) {
        let mut show = |push: Push| {
            sight.angle += push.angle;
            sight.rate += push.rate;
            sight.acceleration += push.acceleration;
        };
        let rigid = forced.rigid(h).times(self.mobility);
        state.rigid_angle += rigid.angle;
        state.rigid_rate += rigid.rate;
        show(rigid);
        for (swing, phase) in self.modes.iter().zip(&mut state.modes) {
            let push = forced.mode(&swing.flow, h).times(self.mobility);
            phase.displacement += push.angle;
            phase.quadrature += push.rate / swing.flow.frequency;
            if self.visible {
                show(push);
            }
        }
    }

    /// Finds the series of all coordinates `h` seconds after departure, with a waveform that has no break until twice
    /// `middle` seconds after it, and tells how far they reach (s).
    pub fn expand(&self, h: f64, middle: f64, state: &mut State, into: &mut Expansion) -> f64 {
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

    /// Whether the modes show in the hub's angle.
    pub fn shows_modes(&self) -> bool {
        self.visible
    }

    /// Whether the bounds hold: they know no waveform.
    pub fn knows_bounds(&self) -> bool {
        self.forced.is_none()
    }

    /// Whether the angle is certain to stay within so much of 0 for `span` seconds: the rigid parabola with all modes at
    /// full swing does.
    pub fn stays_within(&self, band: f64, span: f64) -> bool {
        if !self.knows_bounds() {
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

    /// What a sensor sees at departure.
    #[inline]
    pub fn origin(&self) -> Sight {
        let mut sight = Sight { angle: self.angle, rate: self.rate, acceleration: self.moment };
        let forced = self.forced.as_ref().map_or(0.0, |forced| forced.at(0.0) * self.mobility);
        sight.acceleration += forced;
        for swing in self.modes.iter().filter(|_| self.visible) {
            let Phase { displacement, quadrature } = swing.from;
            swing.flow.add_sight(swing.equilibrium, displacement, quadrature, &mut sight);
            sight.acceleration += swing.flow.gain * forced;
        }
        sight
    }

    /// A time after departure (s) before which the guard cannot trip: until then the rigid parabola with
    /// all modes at full swing towards the guard stays short of its level.
    pub fn earliest(&self, guard: Guard) -> f64 {
        let towards = guard.side.sign();
        let gap = towards * (guard.level - self.angle - self.centre) - self.reach;
        if gap <= 0.0 {
            return 0.0;
        }
        first_root(gap, towards * self.rate, towards * self.moment)
    }

    /// A time (s) for which the guard cannot trip, given what a sensor sees now.
    ///
    /// With the bounds M of |x''| and J of |x'''| the gap left after t is at least gap - speed t - M t²/2, and at least
    /// gap - speed t - a t²/2 - J t³/6 with the acceleration a now. Let q be the first root of gap - speed t - a t²/2.
    /// Up to q, J t³/6 is at most (J q/3) t²/2, so that the first root with the acceleration a + J q/3, which is not
    /// after q, is certain too. The lesser of the two accelerations gives the longer stride.
    #[inline]
    pub fn stride(&self, guard: Guard, now: Sight) -> f64 {
        let towards = guard.side.sign();
        let (gap, speed, acceleration) =
            (guard.gap(now.angle), towards * now.rate, towards * now.acceleration);
        let q = first_root(gap, speed, acceleration);
        // Without modes an endless q makes J q no number, and the minimum takes M.
        first_root(gap, speed, self.curvature.min(acceleration + self.jerk * q / 3.0))
    }

    /// Whether the guard cannot trip within a time (s), given what a sensor sees now.
    #[inline]
    pub fn is_clear(&self, guard: Guard, now: Sight, time: f64) -> bool {
        let speed = guard.side.sign() * now.rate;
        guard.gap(now.angle) > time * (speed + 0.5 * self.curvature * time)
    }

    /// Carries a small deviation of the state over `h` seconds. Its components are the rigid angle and rate, then
    /// displacement and quadrature of each mode.
    pub fn carry(&self, h: f64, deviation: &mut [f64]) {
        deviation[0] += h * deviation[1];
        for (swing, pair) in self.modes.iter().zip(deviation[2..].chunks_exact_mut(2)) {
            let [xx, xy, yx, yy] = swing.flow.transition(h);
            (pair[0], pair[1]) = (xx * pair[0] + xy * pair[1], yx * pair[0] + yy * pair[1]);
        }
    }

    /// The derivative of a state with time on this arc, in the components of [`Arc::carry`].
    pub fn velocity(&self, state: &State) -> DVector<f64> {
        let mut velocity = vec![state.rigid_rate, self.moment];
        for (swing, phase) in self.modes.iter().zip(&state.modes) {
            let from_rest = phase.displacement - swing.equilibrium;
            velocity.extend(swing.flow.velocity(from_rest, phase.quadrature));
        }
        DVector::from_vec(velocity)
    }
}
