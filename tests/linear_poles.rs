//! The linear flow at its limits: poles that nearly coalesce, levels that are just touched, bounds, inputs as more
//! states.

use std::cell::Cell;
use std::convert::Infallible;
use std::sync::Arc;

use flexsc_core::dynamics::crossing::first_crossing;
use flexsc_core::dynamics::guard::Guard;
use flexsc_core::dynamics::linear::{LinearFlow, LinearOutput, LinearPlant, LinearSegment, OutputGuard};
use flexsc_core::numerics::time::{Instant, Span};
use nalgebra::{DMatrix, DVector, dmatrix, dvector};

use crate::plants::{Counted, dashpot, filters, forced, golden, off, three_axes, wheel, wheel_start};

/// Returns an angle at a time (s) after a start from a state, under a constant input.
fn value(system: &LinearPlant, start: &DVector<f64>, input: f64, at: f64) -> f64 {
    let flow = Arc::new(LinearFlow::new(system.split()).expect("a flow"));
    let mut segment = LinearSegment::new(Arc::clone(&flow));
    segment.depart(&flow.to_modal(start), &[input]);
    let mut seen = LinearOutput::default();
    segment.at(at, &mut seen);
    // The final state gives the same value.
    let mut state = flow.to_modal(start);
    segment.state_at(at, &mut state);
    let again = (&system.output * flow.to_state(&state))[0];
    assert!(
        (again - seen.outputs[0].angle).abs() < 1e-11 * again.abs().max(1e-5),
        "{again} {}",
        seen.outputs[0].angle
    );
    seen.outputs[0].angle
}

/// An oscillator read through a low-pass of nearly its own pole.
fn oscillators(apart: f64) -> LinearPlant {
    let (w, v) = (0.755_f64, 0.755 * (1.0 + apart));
    LinearPlant {
        matrix: dmatrix![0.0, 1.0, 0.0, 0.0; -w * w, -0.02 * w, 0.0, 0.0; 0.0, 0.0, 0.0, 1.0; v * v, 0.0, -v * v, -0.02 * v],
        input: dmatrix![0.0; 0.0216; 0.0; 0.0],
        output: dmatrix![0.0, 0.0, 1.0, 0.0],
    }
}

/// Creates an oscillator of 2 rad/s with a damping ratio of 1 + `beyond`.
fn critical(beyond: f64) -> LinearPlant {
    let matrix = dmatrix![0.0, 1.0; -4.0, -4.0 * (1.0 + beyond)];
    LinearPlant { matrix, input: dmatrix![0.0; 4.0], output: dmatrix![1.0, 0.0] }
}

/// Three filters of 2 1/s in a row.
fn cascade() -> LinearPlant {
    let matrix = dmatrix![-2.0, 0.0, 0.0; 2.0, -2.0, 0.0; 0.0, 2.0, -2.0];
    LinearPlant { matrix, input: dmatrix![2.0; 0.0; 0.0], output: dmatrix![0.0, 0.0, 1.0] }
}

#[test]
fn poles_that_nearly_coalesce() {
    for row in golden("e_near_defective") {
        let (case, number) = row[0].rsplit_once(' ').expect("a case and its number");
        let number: f64 = number.parse().expect("a number");
        let (system, start, fastest) = if case.starts_with("oscillators") {
            (oscillators(number), dvector![1e-5, 0.0, 0.0, 0.0], 0.755)
        } else {
            (critical(number), dvector![1e-5, 0.0], 4.0 * (1.0 + number.abs()))
        };
        let (t, exact): (f64, f64) = (row[1].parse().expect("a time"), row[2].parse().expect("a value"));
        let error = (value(&system, &start, 4e-5, t) - exact).abs();
        // Nearer poles are kept together; these stand alone, with a condition of up to 100.
        let apart = if case.starts_with("osc") { number >= 1e-2 } else { number.abs() >= 1e-3 };
        let plain = if apart { 4e-14 } else { 3e-15 };
        let bound = 1e-20 + exact * plain + 1e-5 * 3e-14 * fastest * t.min(150.0);
        assert!(error < bound, "{} at {t}: {error:e} of {exact:e}", row[0]);
    }
}

#[test]
fn three_equal_poles() {
    for t in [0.1_f64, 1.0, 10.0] {
        let (u, z) = (4e-5, 2.0 * t);
        let left = (-z).exp();
        let exact = u * (1.0 - left * (1.0 + z + 0.5 * z * z)) + 1e-5 * 0.5 * z * z * left;
        let error = (value(&cascade(), &dvector![1e-5, 0.0, 0.0], u, t) / exact - 1.0).abs();
        assert!(error < 1e-13, "{t}: {error:e}");
    }
}

#[test]
fn a_touch_is_found_and_none_is_invented() {
    let mut reported = 0;
    for row in golden("f_crests") {
        let number = |index: usize| row[index].parse::<f64>().expect("a number");
        let (d, level, horizon) = (number(1), number(2), Span::from_seconds(number(10)));
        let system = if row[0].parse::<u32>().expect("an index") % 2 == 0 { wheel(2e-4) } else { dashpot() };
        let flow = Arc::new(LinearFlow::new(system.split()).expect("a flow"));
        let mut segment = LinearSegment::new(Arc::clone(&flow));
        segment.depart(&flow.to_modal(&DVector::from_fn(6, |i, _| number(4 + i))), &[number(3)]);
        let guards = [OutputGuard { output: 0, guard: Guard::at_least(level) }];
        let count = Cell::new(0);
        let trip = first_crossing(
            &Counted(&segment, &count),
            &guards,
            horizon,
            &mut LinearOutput::default(),
            || Ok::<_, Infallible>(()),
        );
        let trip = trip.expect("not stopped");
        assert!(count.get() < 60, "{} evaluations", count.get());
        if d == 0.0 {
            continue; // Below the rounding of the angle.
        }
        reported += 1;
        assert_eq!(trip.is_none(), row[11].is_empty(), "{row:?}");
        if let Some(trip) = trip {
            let bound = if d > -1e-15 {
                1e-8
            } else if d > -1e-13 {
                5e-10
            } else {
                5e-11
            };
            let error = off(Instant::START + trip.after, &row[11]).abs();
            assert!(error < bound, "{row:?}: off by {error:e} s");
        }
    }
    assert_eq!(reported, 160);
}

/// On dense samples of every plant nothing exceeds its bounds while they hold.
#[test]
fn bounds_are_never_exceeded() {
    let mut draws = 0x2545_f491_4f6c_dd1d_u64;
    let mut draw = || {
        draws ^= draws << 13;
        draws ^= draws >> 7;
        draws ^= draws << 17;
        (draws >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    let mut growing = wheel(2e-4);
    (growing.matrix[(3, 3)], growing.matrix[(5, 5)]) = (0.004, 0.006);
    let forms = [
        wheel(2e-4).split(),
        dashpot().split(),
        filters(2e-4).split(),
        three_axes(1.1e-3, 20.0).to_split_form().expect("a plant"),
        growing.split(),
        forced(0.44).split(),
        oscillators(1e-3).split(),
        oscillators(0.0).split(),
        critical(0.0).split(),
        critical(1e-6).split(),
        cascade().split(),
    ];
    for (plant, form) in forms.into_iter().enumerate() {
        let flow = Arc::new(LinearFlow::new(form.clone()).expect("a flow"));
        let mut segment = LinearSegment::new(Arc::clone(&flow));
        let (order, inputs) = (form.split[0].ncols(), form.input.ncols());
        let mut nearest = 0.0_f64;
        for _ in 0..60 {
            let state = DVector::from_fn(order, |_, _| 1e-5 * draw());
            let input: Vec<f64> = (0..inputs).map(|_| 1e-5 * draw()).collect();
            segment.depart(&flow.to_modal(&state), &input);
            let (mut now, mut then) = (LinearOutput::default(), LinearOutput::default());
            let from = 800.0 * draw().abs();
            segment.at(from, &mut now);
            let span = now.window.min(40.0);
            let mut before: Option<LinearOutput> = None;
            for step in 0..=400 {
                segment.at(from + span * f64::from(step) / 400.0, &mut then);
                for (j, sensed) in then.outputs.iter().enumerate() {
                    let (m, jerk) = (now.curvature[j], now.jerk[j]);
                    // Squares of decayed values underflow.
                    let room = 1e-12 * m + 1e-100;
                    assert!(
                        sensed.acceleration.abs() <= m + room,
                        "plant {plant}: {} {m}",
                        sensed.acceleration
                    );
                    nearest = nearest.max(sensed.acceleration.abs() / m.max(1e-100));
                    if let Some(before) = &before {
                        let slope = (sensed.acceleration - before.outputs[j].acceleration) / (span / 400.0);
                        assert!(
                            slope.abs() <= jerk * (1.0 + 1e-9) + 1e-9 * m + 1e-100,
                            "plant {plant}: {slope} {jerk}"
                        );
                    }
                }
                before = Some(then.clone());
            }
        }
        // A bound over a window is attained to a third and more somewhere: a stride is at most three times
        // too short.
        assert!(nearest > 0.3, "plant {plant}: bounds are far too large, {nearest}");
    }
}

/// A plant with its one input made by more states: a polynomial, or an oscillation.
fn driven(plain: &LinearPlant, exosystem: &DMatrix<f64>) -> LinearPlant {
    let (order, more) = (plain.matrix.nrows(), exosystem.nrows());
    let mut matrix = DMatrix::zeros(order + more, order + more);
    matrix.view_mut((0, 0), (order, order)).copy_from(&plain.matrix);
    matrix.view_mut((0, order), (order, 1)).copy_from(&plain.input);
    matrix.view_mut((order, order), (more, more)).copy_from(exosystem);
    LinearPlant {
        matrix,
        input: DMatrix::zeros(order + more, 1),
        output: plain.output.clone().resize_horizontally(order + more, 0.0),
    }
}

#[test]
fn waveforms_as_more_states() {
    for row in golden("w_waveforms") {
        let plain = if row[1] == "True" { dashpot() } else { wheel(2e-4) };
        let (h, exact): (f64, f64) = (row[2].parse().expect("a time"), row[3].parse().expect("a value"));
        let mut start = wheel_start();
        let harmonic = row[0].strip_prefix("harmonic ").and_then(|rest| rest.strip_suffix(": y''"));
        let system = if let Some(nu) = harmonic {
            let nu: f64 = nu.parse().expect("a frequency");
            start.extend([2e-7, 0.0]);
            driven(&plain, &dmatrix![0.0, nu; -nu, 0.0])
        } else {
            // u = 2e-6 - 3e-7 h + 2e-8 h^2 - (5/6)e-9 h^3 and its derivatives at 0.
            start.extend([2e-6, -3e-7, 4e-8, -5e-9]);
            driven(&plain, &DMatrix::from_fn(4, 4, |i, j| f64::from(u8::from(j == i + 1))))
        };
        let flow = Arc::new(LinearFlow::new(system.split()).expect("a flow"));
        let mut segment = LinearSegment::new(Arc::clone(&flow));
        segment.depart(&flow.to_modal(&start), &[0.0]);
        let mut seen = LinearOutput::default();
        segment.at(h, &mut seen);
        let sensed = seen.outputs[0];
        let (value, bound) = if harmonic.is_some() {
            (sensed.acceleration, 1e-19)
        } else {
            (sensed.angle, 3e-15 * exact.abs())
        };
        assert!((value - exact).abs() < bound, "{row:?}: {:e}", (value - exact).abs());
    }
}
