//! Runs of the relay law in the relay kernel: which scenarios it supports, their initial setup, and conversions of its
//! state.

use std::borrow::Cow;

use flexsc_control::estimator::{EnvelopeMethod, EstimatorKind};
use flexsc_control::law::{Guards, Phase, Relay, RelaySides};
use flexsc_dynamics::axis_model::{AxisMode, AxisModel, CommandedQuantity};
use flexsc_dynamics::damping::Damped;
use flexsc_dynamics::guard::Guard;
use flexsc_dynamics::{self, AxisState};
use flexsc_numerics::time::{Instant, Span};
use flexsc_numerics::trig::FARTHEST;

use flexsc_scenario::Scenario;

pub use flexsc_relay_kernel::{
    CyclePhase, FoundCrossing, LaneHandover, LaneHost, LaneShape, LaneState, MOST, RunSetup, SWITCHINGS,
    run_lanes, run_single, shortest_window,
};

/// Returns the body and the law of a scenario that the relay kernel can run; `None` otherwise.
pub fn is_supported(scenario: &Scenario) -> Option<(&AxisModel, &Relay)> {
    let (Some(body), Some(law)) = (scenario.model.one_axis(), scenario.law.relay()) else { return None };
    suits(scenario, body, law).then_some((body, law))
}

/// Returns the modes of the envelope's model; empty without an envelope estimator.
pub fn envelope_modes(scenario: &Scenario) -> Cow<'_, [AxisMode]> {
    let Some(envelope) = scenario.estimator.as_ref().and_then(EstimatorKind::envelope) else {
        return Cow::default();
    };
    envelope.modes.as_ref().map_or_else(
        || Cow::Borrowed(body_modes(scenario)),
        |modes| modes.iter().map(AxisMode::from).collect(),
    )
}

/// Returns the modes of the one-axis body.
fn body_modes(scenario: &Scenario) -> &[AxisMode] {
    scenario.model.one_axis().map_or(&[], |body| &body.modes)
}

/// Returns true if the relay law alone moves the body, all modes are below critical damping, and nothing but the
/// envelope is estimated. Motions at or above critical damping are no rotations of a phasor, and rare: such runs go
/// through the loop one by one.
fn suits(scenario: &Scenario, model: &AxisModel, law: &Relay) -> bool {
    let observes = scenario.estimator.as_ref().is_none_or(|estimator| {
        estimator.envelope().is_some_and(|envelope| envelope.form == EnvelopeMethod::Dynamic)
    });
    let learns = scenario.adaptation.as_ref().is_none_or(|adaptation| {
        adaptation.custom().is_none() && adaptation.tunes() == "k_t" && adaptation.objective().is_default()
    });
    let duration = scenario.duration.seconds();
    let are_exact = model
        .modes
        .iter()
        .chain(&*envelope_modes(scenario))
        .all(|mode| mode.damping.get() < 1.0 && mode.frequency.get() * duration < FARTHEST);
    let begins = model.initial_state().angle().abs() < law.dead_zone.get();
    let has_band = scenario.expected_band().band(f64::NAN) > 0.0;
    scenario.has_fast_path()
        && flexsc_relay_kernel::is_supported(lane_shape(scenario))
        && model.drive == CommandedQuantity::Torque
        && observes
        && learns
        && are_exact
        && begins
        && has_band
        && law.sides == RelaySides::Two
}

/// Returns the initial setup for a single run in the relay kernel; `None` if the run has to be simulated by the loop.
pub fn single(scenario: &Scenario) -> Option<RunSetup> {
    let (model, law) = is_supported(scenario)?;
    // A mode that nothing excites may leave the kernel's mirrored coordinates with zeros of the other sign.
    let tracks = envelope_modes(scenario);
    let mut modes = model.modes.iter().chain(&*tracks);
    modes.all(|mode| mode.gain.get() != 0.0).then(|| lane_setup(scenario, model, law))
}

/// Returns the numbers of modes and the presence of damping, which all runs of a batch share.
pub fn lane_shape(scenario: &Scenario) -> LaneShape {
    let (modes, tracks) = (body_modes(scenario), envelope_modes(scenario));
    let is_damped = modes.iter().chain(&*tracks).any(|mode| mode.damping.get() > 0.0);
    LaneShape { modes: modes.len(), tracks: tracks.len(), is_damped }
}

/// Returns the initial setup of a run.
pub fn lane_setup(scenario: &Scenario, model: &AxisModel, law: &Relay) -> RunSetup {
    let mobility = 1.0 / model.commanded_inertia();
    let lane_mode = |mode: &AxisMode| {
        let phase = mode.start();
        let ratio = mode.damping.get();
        [mode.frequency.get(), mode.excitability(), phase.displacement, phase.quadrature, ratio]
    };
    // In the form of the envelope's phasor: the imaginary part in place of the quadrature.
    let track = |mode: &AxisMode| {
        let [frequency, k, displacement, _, ratio] = lane_mode(mode);
        let damped = Damped::new(frequency, ratio);
        let imaginary = (mode.rate.get() + damped.decay * displacement) / damped.frequency;
        [frequency, k, displacement, imaginary, ratio]
    };
    let envelope = scenario.estimator.as_ref().and_then(EstimatorKind::envelope);
    RunSetup {
        angle: model.angle.get(),
        rate: model.rate.get(),
        modes: model.modes.iter().map(lane_mode).collect(),
        tracks: envelope_modes(scenario).iter().map(track).collect(),
        edge: law.dead_zone.get(),
        back: law.dead_zone.get() - law.hysteresis.get(),
        torques: [law.strong.get(), law.weak.get()],
        strong: law.strong.get() * mobility,
        weak: law.weak.get() * mobility,
        k_t: law.k_t.get(),
        structure: lane_shape(scenario),
        band: scenario.expected_band().band(1.0),
        end: (Instant::START + scenario.duration).parts(),
        window: envelope.map(|envelope| (Instant::START + envelope.window).parts()),
    }
}

/// Returns the guards of the law at a phase of the limit cycle, on the given side.
pub fn guards(setup: &RunSetup, phase: CyclePhase, side: f64) -> Guards {
    match phase {
        CyclePhase::Coast => Guards::two(Guard::at_least(setup.edge), Guard::at_most(-setup.edge)),
        CyclePhase::Push if side > 0.0 => Guards::one(Guard::at_most(setup.back)),
        CyclePhase::Push => Guards::one(Guard::at_least(-setup.back)),
        CyclePhase::Brake => Guards::NONE,
    }
}

/// Returns the state of the relay law at a phase of the limit cycle, on the given side.
pub fn law_state(phase: CyclePhase, side: f64) -> Phase {
    match (phase, side > 0.0) {
        (CyclePhase::Coast, true) => Phase::WeakRight,
        (CyclePhase::Coast, false) => Phase::WeakLeft,
        (CyclePhase::Push, true) => Phase::PushFromRight,
        (CyclePhase::Push, false) => Phase::PushFromLeft,
        (CyclePhase::Brake, true) => Phase::BrakeFromRight,
        (CyclePhase::Brake, false) => Phase::BrakeFromLeft,
    }
}

/// Fills `found` with a guard crossing: the span since the segment's start, whether it is the first guard, and the
/// modes there.
pub fn apply_crossing(found: &mut FoundCrossing, after: Span, is_first: bool, state: &AxisState) {
    *found = FoundCrossing {
        after: ((Instant::START + after).parts(), after.seconds()),
        right: is_first,
        modes: std::mem::take(&mut found.modes),
    };
    found.modes.clear();
    found.modes.extend(state.modes.iter().map(|phase| [phase.displacement, phase.quadrature]));
}

/// Copies the motion of a lane into a one-axis state.
pub fn apply_state(state: &mut AxisState, lane_state: &LaneState) {
    (state.rigid_angle, state.rigid_rate) = (lane_state.angle, lane_state.rate);
    for (phase, [displacement, quadrature]) in state.modes.iter_mut().zip(&lane_state.modes) {
        *phase = flexsc_dynamics::ModeState { displacement: *displacement, quadrature: *quadrature };
    }
}

/// Returns the instant of whole seconds and femtoseconds.
pub fn instant((whole, part): (u64, u64)) -> Instant {
    Instant::from_parts(whole, part)
}
