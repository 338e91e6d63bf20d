//! Every predicted and certified trip of relay runs must equal the trip of the certified search;
//! `tests/crossings.rs` has motions of all kinds.

use flexsc_numerics::quantity::{Finite, Frequency, NonNegative};
use flexsc_numerics::time::Span;

use super::{SegmentInput, UncoupledSegment};
use crate::AxisState;
use crate::axis_model::{AxisMode, AxisModel};
use crate::crossing::first_crossing;
use crate::guard::Guard;

/// Eps, gamma and the strong and weak torque of the relay study.
const LAW: [f64; 4] = [5e-4, 1e-4, 4e-5, 1e-6];

/// Creates a body with modes of given frequency, gain and damping ratio.
fn body(modes: &[(f64, f64, f64)]) -> AxisModel {
    let mode = |&(frequency, gain, ratio): &(f64, f64, f64)| {
        let gain = Finite::new(gain).expect("finite");
        let ratio = NonNegative::new(ratio).expect("in range");
        AxisMode::at_rest(Frequency::new(frequency).expect("in range"), gain, ratio)
    };
    AxisModel { modes: modes.iter().map(mode).collect(), ..AxisModel::default() }
}

/// Statistics of the trips that both methods found.
#[derive(Default)]
struct Seen {
    arcs: usize,
    certain: usize,
    trips: usize,
    /// Largest difference of the two methods (rad).
    worst: f64,
}

impl Seen {
    /// Returns the trip of the search, with the state there, and checks that a certain prediction agrees with it.
    fn compare(
        &mut self,
        arc: &mut UncoupledSegment,
        guards: &[Guard],
        horizon: Span,
        state: &mut AxisState,
    ) -> Option<(Span, usize)> {
        let mut guessed = state.clone();
        let guess = arc.predict_crossing(guards, horizon, &mut guessed);
        let found = first_crossing(arc, guards, horizon, state, || Ok::<(), ()>(())).expect("no limit");
        self.arcs += 1;
        if let Some(guess) = guess {
            self.certain += 1;
            assert_eq!(guess.map(|trip| trip.guard), found.map(|trip| trip.guard));
            if let (Some(guess), Some(found)) = (guess, found) {
                let apart = guess
                    .after
                    .remaining_after(found.after)
                    .seconds()
                    .abs()
                    .min(found.after.remaining_after(guess.after).seconds().abs());
                let (angle, rate) = (found.observation.angle, found.observation.rate);
                self.worst = self.worst.max(apart * rate.abs());
                self.trips += 1;
                let (a, b) = (guess.observation, found.observation);
                assert!((a.rate - b.rate).abs() <= 1e-14 * a.rate.abs() + 1e-17);
                assert!((guessed.angle() - guess.observation.angle).abs() <= 4e-16 * angle.abs());
                state.clone_from(&guessed);
            }
        }
        found.map(|trip| (trip.after, trip.guard))
    }
}

/// Runs `cycles` cycles of the relay law.
fn study(seen: &mut Seen, modes: &[(f64, f64, f64)], k_t: f64, cycles: usize) {
    let [eps, gamma, strong, weak] = LAW;
    let body = body(modes);
    let mut arc = UncoupledSegment::new(&body);
    let mut state = body.initial_state();
    (state.rigid_angle, state.rigid_rate) = (4.5e-4, 2.2e-5);
    let forever = Span::from_seconds(2e4);
    let depart = |arc: &mut UncoupledSegment, state: &AxisState, torque| {
        arc.depart(state, &SegmentInput { constant: torque, waveform: None });
    };
    let mut torque = weak;
    for _ in 0..cycles {
        depart(&mut arc, &state, torque);
        let both = [Guard::at_least(eps), Guard::at_most(-eps)];
        let (_, guard) = seen.compare(&mut arc, &both, forever, &mut state).expect("a boundary");
        let (side, back) = if guard == 0 {
            (1.0, Guard::at_most(eps - gamma))
        } else {
            (-1.0, Guard::at_least(gamma - eps))
        };
        depart(&mut arc, &state, -side * strong);
        let (push, _) = seen.compare(&mut arc, &[back], forever, &mut state).expect("back");
        depart(&mut arc, &state, side * strong);
        arc.at(k_t * push.seconds(), &mut state);
        torque = side * weak;
    }
}

#[test]
fn certain_trips_are_those_of_the_certified_search() {
    let mut seen = Seen::default();
    for index in 0..240 {
        let k_t = 0.28 + 0.12 * f64::from(index) / 240.0;
        study(&mut seen, &[(0.44, 0.0213, 0.0), (0.755, 0.0216, 0.0)], k_t, 60);
    }
    assert!(seen.worst < 4e-18, "{:e}", seen.worst);
    assert!(
        seen.arcs == 240 * 120 && seen.certain > seen.arcs * 95 / 100,
        "{} of {}",
        seen.certain,
        seen.arcs
    );
    // One, three and no modes; modes of large influence and high frequency.
    for modes in [
        &[(0.44, 0.0213, 0.0)][..],
        &[(0.3, 0.02, 0.0), (0.755, 0.03, 0.0), (2.2, 0.1, 0.0)],
        &[],
        &[(0.9, 0.2, 0.0), (5.0, 0.4, 0.0)],
    ] {
        let mut seen = Seen::default();
        study(&mut seen, modes, 0.33, 300);
        assert!(seen.worst < 1e-17 && seen.trips > 50, "{modes:?}: {:e}, {}", seen.worst, seen.trips);
    }
}

#[test]
fn so_they_are_of_damped_modes() {
    let five = |zeta: f64| {
        [
            (0.44, 0.0213, zeta),
            (0.755, 0.0216, zeta),
            (1.3, 0.01, 2.0 * zeta),
            (2.1, 0.01, 0.0),
            (3.4, 0.01, zeta),
        ]
    };
    for (zeta, least) in [(1e-6, 80), (0.002, 80), (0.05, 80), (0.4, 80)] {
        let mut seen = Seen::default();
        for index in 0..30 {
            study(&mut seen, &five(zeta), 0.28 + 0.12 * f64::from(index) / 30.0, 60);
        }
        assert!(seen.worst < 1e-17, "{zeta}: {:e}", seen.worst);
        assert!(
            seen.arcs == 30 * 120 && seen.certain > seen.arcs * least / 100,
            "{zeta}: {} of {}",
            seen.certain,
            seen.arcs
        );
    }
    let mut seen = Seen::default();
    study(&mut seen, &[(0.44, 0.0213, 0.01)], 0.33, 300);
    study(&mut seen, &[(0.44, 0.0213, 0.0), (0.755, 0.0216, 0.99)], 0.33, 300);
    assert!(seen.worst < 1e-17 && seen.certain > 1000, "{:e}, {}", seen.worst, seen.certain);
}
