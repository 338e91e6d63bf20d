//! The linear flow against 66-digit arithmetic: `tests/golden/linear`, Taylor series of the matrix exponential from node to
//! node and strides certified to 1e-55, without eigenvalues. The law is that of the relay study, on each axis.

use flexsc_core::dynamics::linear::{LinearFlow, SplitPlant};
use nalgebra::DVector;

use crate::plants::{
    Flight, INERTIAS, dashpot, filters, filters_start, fly, forced, forced_start, golden, off, three_axes,
    three_start, wheel, wheel_start,
};
use crate::study::pairs;

/// Flies a plant against its files: the first 20 switchings to 1e-12 s, all to `bound`.
fn agrees(
    name: &str,
    form: SplitPlant,
    start: &DVector<f64>,
    inertias: &[f64],
    k_t: f64,
    bound: f64,
) -> Flight {
    let events = golden(&format!("{name}_events"));
    let states = match std::fs::exists(format!(
        "{}/../../tests/golden/linear/{name}_states.csv",
        env!("CARGO_MANIFEST_DIR")
    )) {
        Ok(true) => golden(&format!("{name}_states")),
        _ => Vec::new(),
    };
    let times: Vec<f64> = states.iter().map(|row| row[0].parse().expect("a time")).collect();
    let flight = fly(form, start, inertias, k_t, &times, events.len());
    // A run that goes on to the times of the states may switch more often.
    let switchings = flight.switchings.iter().take(events.len());
    for (index, (row, (axis, state, at))) in pairs(&events, switchings).enumerate() {
        assert_eq!((row[1].as_str(), row[2].as_str()), (axis.to_string().as_str(), *state), "{name} {index}");
        let error = off(*at, &row[3]).abs();
        assert!(
            error < if index < 20 { 1e-12 } else { bound },
            "{name}, switching {index}: off by {error:e} s"
        );
    }
    // The first state is that at 200 s.
    if let Some(row) = states.first() {
        for (exact, x) in pairs(&row[1..], flight.states[0].iter()) {
            let error = (x - exact.parse::<f64>().expect("a number")).abs();
            assert!(error < 3e-15, "{name}: {x:e} is off by {error:e}");
        }
    }
    flight
}

#[test]
fn a_relay_beside_a_wheel() {
    agrees("a_backemf_31", wheel(2e-4).split(), &wheel_start(), &[1.0], 0.31, 1e-11);
}

/// Shifted equilibria lose nine digits here.
#[test]
fn a_drag_that_is_nearly_none() {
    agrees("a9_backemf_1e-9_31", wheel(1e-9).split(), &wheel_start(), &[1.0], 0.31, 1e-11);
}

#[test]
fn damping_that_couples_the_modes() {
    agrees("b_damping_3389", dashpot().split(), &wheel_start(), &[1.0], 0.3389, 1e-11);
}

#[test]
fn three_axes_with_momentum_bias() {
    let form = three_axes(1.1e-3, 20.0).to_split_form().expect("a plant");
    let flow = LinearFlow::new(form.clone()).expect("a flow");
    assert!(flow.condition() < 1.01, "{}", flow.condition());
    agrees("c_three", form, &three_start(), &INERTIAS, 0.31, 5e-11);
}

/// Filters that read the rigid angle itself would lose three digits.
#[test]
fn filters_between_sensor_and_law() {
    let flow = LinearFlow::new(filters(2e-4).split()).expect("a flow");
    assert!(flow.condition() < 10.0, "{}", flow.condition());
    let flight = agrees("d_filters_31", filters(2e-4).split(), &filters_start(), &[1.0], 0.31, 1e-11);
    assert!(flight.evaluations < 4.0, "{}", flight.evaluations);
    agrees("d0_filters_no_drag_31", filters(0.0).split(), &filters_start(), &[1.0], 0.31, 1e-11);
}

#[test]
fn a_harmonic_disturbance_as_two_more_states() {
    agrees("g_forced_31", forced(0.3).split(), &forced_start(), &[1.0], 0.31, 1e-11);
}

/// Two poles that beat have large residues of opposite signs.
#[test]
fn a_disturbance_in_resonance_costs_few_evaluations() {
    let flight = fly(forced(0.44).split(), &forced_start(), &[1.0], 0.31, &[], 60);
    assert!(flight.evaluations < 7.0, "{}", flight.evaluations);
}

/// Three poles at 0 are left as they are, and the columns of three angles are zeros by structure.
#[test]
fn rates_that_nothing_damps() {
    let form = three_axes(0.0, 0.0).to_split_form().expect("a plant");
    assert_eq!(form.carried.nrows(), 3);
    let flow = LinearFlow::new(form).expect("a flow");
    assert_eq!(flow.poles().iter().filter(|pole| pole.norm_sqr() < 1e-28).count(), 3);
    assert!(flow.condition() < 1.01, "{}", flow.condition());
    let form = three_axes(0.0, 20.0).to_split_form().expect("a plant");
    agrees("h_three_bias", form, &three_start(), &INERTIAS, 0.3389, 1e-11);
}

/// Bounds of growing poles hold for a while and are renewed.
#[test]
fn modes_that_grow() {
    let mut system = wheel(2e-4);
    for (at, value) in [((3, 3), 0.004), ((3, 5), -0.001), ((5, 5), 0.006), ((5, 3), -0.001)] {
        system.matrix[at] += value;
    }
    let flight = agrees("u_unstable_31", system.split(), &wheel_start(), &[1.0], 0.31, 1e-11);
    assert!(flight.evaluations < 8.0, "{}", flight.evaluations);
}
