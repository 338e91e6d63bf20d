//! The envelope of the elastic modes, a = sum a_i, and its mean over consecutive windows.
//!
//! Each mode is a phasor Z = x + i (x' + s x)/w_d with s = zeta w and w_d its damped frequency; a_i = abs(Z).
//! Without damping that is the paper's a_i² = x_i² + (x_i'/w_i)² (\[Silaev\], equation (4)). While the torque
//! is constant, Z rotates about its equilibrium c: Z = c + W exp(-(s + i w_d) h).
//!
//! On three axes x is the size of the rotation that a free mode causes at the first sensor, and c follows from its
//! modal force.

use super::pass_through::PassThrough;
use super::{Estimator, EstimatorContext, EstimatorSpec};
use crate::offers::{BodyOffers, EstimatorOffers, Offers};
use crate::requirement::Requirements;
use flexsc_dynamics::AxisState;
use flexsc_dynamics::axis_model::AxisMode;
use flexsc_dynamics::three_axis_model::ThreeAxisMode;
use flexsc_numerics::exp_branch_free::exp;
use flexsc_numerics::phasor::{Complex, Phasor, abs, polar};
use flexsc_numerics::quantity::Finite;
use flexsc_numerics::random::Seed;
use flexsc_numerics::time::{Instant, Span};
use flexsc_numerics::trig::sincos_any;
use flexsc_numerics::{swing_damped, swing_integral};
use flexsc_spacecraft::body::Mode;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An envelope monitor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Envelope {
    /// How the phasors are computed.
    #[serde(default)]
    pub form: EnvelopeMethod,
    /// Length of the windows over which the envelope is averaged (s).
    pub window: Span,
    /// Modes of the monitor's model; default: the body's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub modes: Option<Vec<Mode>>,
}

impl EstimatorSpec for Envelope {
    /// Returns a pass-through: the monitor itself acts without samples.
    fn start(&self, _: &EstimatorContext<'_>, _: Seed) -> Box<dyn Estimator> {
        Box::new(PassThrough)
    }

    fn offers(&self) -> EstimatorOffers {
        EstimatorOffers { is_envelope: true, ..EstimatorOffers::default() }
    }

    fn requires(&self, offers: &Offers, needs: &mut Requirements) {
        let body = &offers.body;
        if let Some(matrix) = &body.damping_matrix {
            let why = "couples modes, and an `[estimator.envelope]` treats each mode on its own";
            needs.require_elsewhere(false, matrix, why);
        }
        needs.require(
            !offers.follows_waveform(),
            "",
            "follows torques that are constant for a while: execute the `[manoeuvre]` by an `[actuator.hold]`, \
             thrusters or a wheel",
        );
        if body.axes == 1 {
            needs.require(
                self.form != EnvelopeMethod::Truth || self.modes.is_none(),
                "modes",
                "must be left out for the form `truth`, which reads the body's",
            );
            return self.require_oscillation(body, needs);
        }
        needs.require(
            self.modes.is_none(),
            "modes",
            "apply only to one angle: about three axes the monitor uses the body's",
        );
        needs.require(body.modes > 0, "", "has no modes to follow: the body has none");
        needs.require(
            !body.turns_appendages,
            "",
            "needs constant modes, and an appendage that turns changes them",
        );
        needs.require(
            !offers.lists_actuator(|actuator| actuator.turns_with_gimbals),
            "",
            "needs torques that are constant between commands, and those of control moment gyros change with the gimbal \
             angles",
        );
        self.require_oscillation(body, needs);
    }

    fn modes(&self) -> Option<&[Mode]> {
        self.modes.as_deref()
    }
}

impl Envelope {
    /// Adds the requirement of modes below critical damping: of the monitor's model, or of the body.
    fn require_oscillation(&self, body: &BodyOffers, needs: &mut Requirements) {
        let why = |ratio: f64| format!("must be below 1 for a mode to have an envelope, got {ratio}");
        if let Some(modes) = &self.modes {
            let mut ratios = modes.iter().map(|mode| mode.damping.get()).enumerate();
            if let Some((index, ratio)) = ratios.find(|(_, ratio)| *ratio >= 1.0) {
                let key = format!("modes[{index}].damping");
                needs.require_with(false, &key, || why(ratio));
            }
        } else if let Some((key, ratio)) = &body.overdamped {
            needs.require_elsewhere(false, key, &why(*ratio));
        }
    }
}

/// How the phasors are computed. All forms agree to rounding if the model is right.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "Form")]
pub enum EnvelopeMethod {
    /// Dynamic estimation: the paper's A and B, equation (3), integrated exactly.
    #[default]
    Dynamic,
    /// Trigonometric: each switching of the torque adds one phasor.
    Trigonometric,
    /// From the true state of the body, as an ideal observer gives it.
    Truth,
}

/// Run-time state of the envelope observer.
#[derive(Clone, Debug)]
pub struct EnvelopeMonitor {
    form: EnvelopeMethod,
    mobility: f64,
    tracks: Vec<ModePhasor>,
    now: Instant,
    /// Integral of the total envelope since the window began (rad s).
    integral: f64,
}

/// Phasor of one mode.
#[derive(Clone, Debug)]
struct ModePhasor {
    frequency: f64,
    damped: f64,
    decay: f64,
    excitability: f64,
    /// Rotation of the sensor per unit of the mode, of a three-axis body; else 1.
    rotation: f64,
    /// Phasor in the rotating frame, whose axis is at exp(-i w_d t): Z itself (dynamic), or its deviation from
    /// equilibrium (trigonometric).
    frame: Phasor,
    equilibrium: Phasor,
    /// Deviation from equilibrium at the current instant.
    deviation: Phasor,
    /// Axis of the rotating frame at the current instant, exp(i w_d t).
    axis: Phasor,
}

impl EnvelopeMonitor {
    /// Creates the observer of a one-axis body with modes `body_modes` and `inertia` (kg m²), by which torques are
    /// divided.
    pub fn new(spec: &Envelope, body_modes: &[AxisMode], inertia: f64) -> Self {
        let tracks = match &spec.modes {
            Some(modes) => modes.iter().map(|mode| ModePhasor::new(&mode.into())).collect(),
            None => body_modes.iter().map(ModePhasor::new).collect(),
        };
        Self { form: spec.form, mobility: 1.0 / inertia, tracks, now: Instant::START, integral: 0.0 }
    }

    /// Creates the observer of a three-axis body: each free mode with its rotation at the sensor.
    pub fn for_three_axes(spec: &Envelope, modes: &[(ThreeAxisMode, f64)]) -> Self {
        let track = |(mode, rotation): &(ThreeAxisMode, f64)| {
            let start = AxisMode::at_rest(mode.frequency, Finite::default(), mode.damping);
            let mut track = ModePhasor::new(&start);
            track.frame = track.phasor(rotation * mode.displacement.get(), rotation * mode.rate.get());
            track.deviation = track.frame;
            track.rotation = *rotation;
            track
        };
        Self {
            form: spec.form,
            mobility: f64::NAN,
            tracks: modes.iter().map(track).collect(),
            now: Instant::START,
            integral: 0.0,
        }
    }

    /// Returns true for the reference form, which reads the true state at every event.
    pub fn uses_true_state(&self) -> bool {
        self.form == EnvelopeMethod::Truth
    }

    /// Advances the phasors to `now` under the torque that held since the last call. `truth` is the body's state at
    /// `now`, which only the form `truth` uses.
    pub fn advance(&mut self, now: Instant, truth: &AxisState) {
        let h = now.since(self.now).seconds();
        let t = now.seconds();
        self.now = now;
        for (index, track) in self.tracks.iter_mut().enumerate() {
            let (from, deviation) = (track.axis, track.deviation);
            let (sin, cos) = sincos_any(track.damped * t);
            track.axis = Complex { re: cos, im: sin };
            let shrink = if track.decay > 0.0 { exp(-(track.decay * h)) } else { 1.0 };
            match self.form {
                EnvelopeMethod::Dynamic => {
                    track.frame = track.frame * shrink + track.equilibrium * (track.axis - from * shrink);
                    track.deviation = track.frame * track.axis.conj() - track.equilibrium;
                }
                EnvelopeMethod::Trigonometric => {
                    track.frame *= shrink;
                    track.deviation = track.frame * track.axis.conj();
                }
                EnvelopeMethod::Truth => {
                    let phase = truth.modes[index];
                    let rate = track.frequency * phase.quadrature;
                    let z = track.phasor(phase.displacement, rate);
                    track.deviation = z - track.equilibrium;
                }
            }
            self.integral += track.integral(deviation, h);
        }
    }

    /// Sets the torque (N m) that acts from now on.
    pub fn command(&mut self, torque: f64) {
        let moment = torque * self.mobility;
        self.hold(|_, track| track.excitability * moment);
    }

    /// Sets the modal forces (N/sqrt(kg)) of a three-axis body that act from now on.
    pub fn set_modal_forces(&mut self, forces: &[f64]) {
        let force = |index: usize| forces.get(index).copied().unwrap_or(0.0);
        self.hold(|index, track| track.rotation * force(index) / (track.frequency * track.frequency));
    }

    /// Sets the equilibrium displacements (rad) of the modes from now on.
    fn hold(&mut self, phasor_at: impl Fn(usize, &ModePhasor) -> f64) {
        for (index, track) in self.tracks.iter_mut().enumerate() {
            let equilibrium = track.phasor(phasor_at(index, track), 0.0);
            let shift = track.equilibrium - equilibrium;
            track.equilibrium = equilibrium;
            track.deviation += shift;
            if self.form == EnvelopeMethod::Trigonometric {
                track.frame += shift * track.axis;
            }
        }
    }

    /// Loads the state that a batch has computed up to `now`: the integral since the window began (rad s), and of each
    /// mode the phasor in the rotating frame, that frame's axis, the real part of the equilibrium, and the deviation
    /// from it.
    pub fn load(&mut self, now: Instant, integral: f64, tracks: &[[f64; 7]]) {
        (self.now, self.integral) = (now, integral);
        for (track, [re, im, cos, sin, equilibrium, x, y]) in
            self.tracks.iter_mut().zip(tracks.iter().copied())
        {
            track.frame = Complex { re, im };
            track.axis = Complex { re: cos, im: sin };
            track.equilibrium = track.phasor(equilibrium, 0.0);
            track.deviation = Complex { re: x, im: y };
        }
    }

    /// Returns the integral of the total envelope since the last call (rad s), and starts a new window.
    pub fn close_window(&mut self) -> f64 {
        std::mem::take(&mut self.integral)
    }

    /// Returns the envelope of each mode (rad) at `now`, not before the last call of `advance`, under the current
    /// torque.
    pub fn at(&self, now: Instant) -> impl Iterator<Item = f64> + '_ {
        let h = now.since(self.now).seconds();
        self.tracks.iter().map(move |track| {
            let turn = polar(libm::exp(-track.decay * h), -track.damped * h);
            abs(track.equilibrium + track.deviation * turn)
        })
    }
}

impl ModePhasor {
    fn new(mode: &AxisMode) -> Self {
        let (frequency, zeta) = (mode.frequency.get(), mode.damping.get());
        let mut track = Self {
            frequency,
            damped: frequency * f64::sqrt((1.0 - zeta) * (1.0 + zeta)),
            decay: zeta * frequency,
            excitability: mode.excitability(),
            rotation: 1.0,
            frame: Phasor::default(),
            equilibrium: Phasor::default(),
            deviation: Phasor::default(),
            axis: Complex { re: 1.0, im: 0.0 },
        };
        // The equilibrium is 0 until the first command, and the frame has not rotated yet.
        track.frame = track.phasor(mode.displacement.get(), mode.rate.get());
        track.deviation = track.frame;
        track
    }

    fn phasor(&self, displacement: f64, rate: f64) -> Phasor {
        Complex { re: displacement, im: (rate + self.decay * displacement) / self.damped }
    }

    /// Returns the integral of the mode's envelope (rad s) over the last `h` (s); `from` is the deviation at their
    /// start.
    fn integral(&self, from: Phasor, h: f64) -> f64 {
        let Self { equilibrium, deviation, decay, damped, frequency, .. } = *self;
        let ends = [[from.re, from.im], [deviation.re, deviation.im]];
        if decay > 0.0 {
            swing_damped::damped([equilibrium.re, equilibrium.im], ends, decay, damped, h)
        } else {
            swing_integral::undamped(equilibrium.re, ends, frequency, h)
        }
    }
}
