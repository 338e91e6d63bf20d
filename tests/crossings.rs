//! Crossings of guards on motions of all kinds: none is missed, and those that are predicted are those of the
//! search.

use std::cell::Cell;
use std::convert::Infallible;

use flexsc_core::dynamics::axis_model::{AxisMode, AxisModel};
use flexsc_core::dynamics::crossing::{Crossing, first_crossing};
use flexsc_core::dynamics::flow::{SegmentInput, UncoupledSegment};
use flexsc_core::dynamics::guard::Guard;
use flexsc_core::dynamics::{AxisState, ModeState};
use flexsc_core::numerics::quantity::{Finite, Frequency, NonNegative};
use flexsc_core::numerics::time::Span;
use proptest::array::uniform4;
use proptest::collection::vec;
use proptest::prelude::*;

use crate::properties::{between, holds};

/// Mode as drawn: frequency (rad/s), gain, damping ratio, and displacement and rate over the frequency (rad).
type Drawn = (f64, f64, f64, f64, f64);

/// Returns a body, and a state of it.
fn body(modes: &[Drawn], angle: f64, rate: f64) -> (AxisModel, AxisState) {
    let mode = |(frequency, gain, damping, ..): &Drawn| {
        let gain = Finite::new(*gain).expect("finite");
        let damping = NonNegative::new(*damping).expect("in range");
        AxisMode::at_rest(Frequency::new(*frequency).expect("in range"), gain, damping)
    };
    let body = AxisModel { modes: modes.iter().map(mode).collect(), ..AxisModel::default() };
    let mut state = body.initial_state();
    (state.rigid_angle, state.rigid_rate) = (angle, rate);
    let phase = |(.., displacement, quadrature): &Drawn| ModeState {
        displacement: *displacement,
        quadrature: *quadrature,
    };
    state.modes = modes.iter().map(phase).collect();
    (body, state)
}

/// Segment under a constant torque (rad/s²), and its start.
fn segment(modes: &[Drawn], angle: f64, rate: f64, torque: f64) -> (UncoupledSegment, AxisState) {
    let (body, state) = body(modes, angle, rate);
    let mut segment = UncoupledSegment::new(&body);
    segment.depart(&state, &SegmentInput::constant(torque));
    (segment, state)
}

fn search(
    segment: &UncoupledSegment,
    guards: &[Guard],
    horizon: Span,
    there: &mut AxisState,
) -> Option<Crossing> {
    first_crossing(segment, guards, horizon, there, || Ok::<_, Infallible>(())).expect("not stopped")
}

/// Modes that are damped little or much, critically, and beyond.
fn mode() -> impl Strategy<Value = Drawn> {
    let damping = prop::sample::select(vec![0.0, 0.004, 0.3, 1.0, 1.7]);
    let size = between(-8.0, -4.0).prop_map(|exponent| 10_f64.powf(exponent));
    let frequency = between(-1.3, 1.3).prop_map(|exponent| 10_f64.powf(exponent));
    (frequency, between(0.0, 0.5), damping, size, between(-1.0, 1.0), between(-1.0, 1.0)).prop_map(
        |(frequency, gain, damping, size, displacement, quadrature)| {
            (frequency, gain, damping, size * displacement, size * quadrature)
        },
    )
}

#[test]
fn no_crossing_is_missed() {
    let (tripped, clear) = (Cell::new(0), Cell::new(0));
    let motion = (vec(mode(), 0..6), between(-2e-4, 2e-4), between(-5e-5, 5e-5), between(-6e-6, 6e-6));
    let cases = (motion, between(0.0, 3e-4), between(0.0, 3e-4), any::<bool>());
    holds(1500, cases, |((modes, angle, rate, torque), near, far, one_sided)| {
        let (segment, state) = segment(&modes, angle, rate, torque);
        let start = state.angle();
        // If both guards face one way, the second one may be the nearer.
        let second = if one_sided { Guard::at_least(start + far) } else { Guard::at_most(start - far) };
        let guards = [Guard::at_least(start + near), second];
        let mut there = state.clone();
        let trip = search(&segment, &guards, Span::from_seconds(5.0), &mut there);
        let until = trip.map_or(5.0, |trip| trip.after.seconds());
        // No level is crossed before, at 10 000 instants, within the rounding of the angle.
        let mut probe = state.clone();
        for index in 0..10_000 {
            let sensed = segment.at(until * f64::from(index) / 10_000.0, &mut probe);
            let gap = guards.map(|guard| guard.gap(sensed.angle)).into_iter().fold(f64::INFINITY, f64::min);
            prop_assert!(gap > -1e-18, "crossed before {until} s");
        }
        let Some(trip) = trip else {
            clear.set(clear.get() + 1);
            return Ok(());
        };
        tripped.set(tripped.get() + 1);
        let sensed = segment.at(trip.after.seconds(), &mut probe);
        prop_assert!(guards[trip.guard].holds(sensed.angle));
        prop_assert_eq!(&probe, &there);
        // It is the first tick: one before, the angle is short of the level, or at it to rounding.
        let before = segment.at(trip.after.remaining_after(Span::TICK).seconds(), &mut probe);
        prop_assert!(guards[trip.guard].gap(before.angle) > -1e-18);
        Ok(())
    });
    assert!(tripped.get() > 200 && clear.get() > 200, "{tripped:?} tripped, {clear:?} clear");
}

/// Compares the predictions of motions with two modes of these damping ratios with the search: those that are
/// certain have its guard, its instant and its state.
fn predictions_are_those_of_the_search(damping: impl Strategy<Value = f64> + Clone) {
    let (certain, trips) = (Cell::new(0), Cell::new(0));
    let unit = || between(-1.0, 1.0);
    let size = between(-12.0, -4.0).prop_map(|exponent| 1e-2 * exponent.exp());
    let frequencies = (between(0.1, 0.5), between(0.5, 1.5));
    let modes = (frequencies, (damping.clone(), damping), size, uniform4(unit()));
    let motion = (modes, between(-1e-3, 1e-3), between(-4e-5, 4e-5), (unit(), unit()));
    let guards = (between(-1.2e-3, 1.2e-3), between(-1.2e-3, 1.2e-3), any::<bool>());
    holds(40_000, (motion, guards, between(1.0, 199.0)), |(motion, (high, low, one), horizon)| {
        let (modes, angle, rate, torque) = motion;
        let ((slow, fast), (slow_ratio, fast_ratio), size, [a, b, c, d]) = modes;
        let modes =
            [(slow, 0.02, slow_ratio, size * a, size * b), (fast, 0.02, fast_ratio, size * c, size * d)];
        let (mut segment, state) = segment(&modes, angle, rate, 4e-6 * torque.0 * torque.1);
        let guards = [Guard::at_least(high), Guard::at_most(low)];
        let guards = if one { &guards[..1] } else { &guards };
        let horizon = Span::from_seconds(horizon);
        let (mut predicted, mut there) = (state.clone(), state);
        let Some(prediction) = segment.predict_crossing(guards, horizon, &mut predicted) else {
            return Ok(());
        };
        certain.set(certain.get() + 1);
        let found = search(&segment, guards, horizon, &mut there);
        prop_assert_eq!(prediction.map(|trip| trip.guard), found.map(|trip| trip.guard));
        let (Some(trip), Some(found)) = (prediction, found) else { return Ok(()) };
        trips.set(trips.get() + 1);
        // The instants differ by what the body turns in a rounding of the angle.
        let apart = trip.after.remaining_after(found.after).seconds().abs();
        prop_assert!(apart * found.observation.rate.abs() < 1e-17, "{apart} s apart");
        let (a, b) = (trip.observation, found.observation);
        prop_assert!((a.rate - b.rate).abs() <= 1e-14 * a.rate.abs() + 1e-17);
        prop_assert!((predicted.angle() - a.angle).abs() <= 4e-16 * b.angle.abs());
        Ok(())
    });
    // Most motions do not meet a guard within the horizon, or need the search.
    assert!(certain.get() > 4000 && trips.get() > 3000, "{certain:?} certain, {trips:?} trips");
}

#[test]
fn predicted_crossings_of_undamped_modes_are_those_of_the_search() {
    predictions_are_those_of_the_search(Just(0.0));
}

#[test]
fn predicted_crossings_of_damped_modes_are_those_of_the_search() {
    // Most ratios are small.
    predictions_are_those_of_the_search(between(0.0, 1.0).prop_map(|draw| 0.97 * draw.powi(3)));
}
