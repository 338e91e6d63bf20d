//! A beam and a panel from CalculiX's results, clamped to a hub: the frequencies of the whole in closed form
//! (tests/golden/beam_oracle.py), and by full matrices (tests/golden/panel_oracle.py).

#![expect(clippy::unreadable_literal, reason = "the digits of references are compared as they stand")]

use flexsc_core::Scenario;

use crate::study::pairs;

/// Frequencies of the panel `fe/solar.inp`, clamped and with the hub free, by its full matrices (tests/golden/panel_oracle.py).
const CLAMPED: [f64; 8] = [
    9.76515522718374,
    61.14208606322635,
    95.95888657869493,
    129.78558262751756,
    171.0080847073781,
    334.8080020757106,
    392.633090590172,
    547.8283278563471,
];
const FREE: [f64; 8] = [
    20.477075303679964,
    66.73841527072692,
    130.74004323522541,
    174.27899409882718,
    192.89189872841274,
    337.3557799830779,
    392.96255945122454,
    555.7607186288641,
];
const RESULTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden/fe/beam.dat");

#[track_caller]
fn near(found: f64, exact: f64, error: f64) {
    assert!(
        (found / exact - 1.0).abs() <= error,
        "{found} is off {exact} by {:e} of it",
        found / exact - 1.0
    );
}

#[test]
fn a_beam_of_calculix_has_its_closed_form_clamped_and_free() {
    for results in [RESULTS.to_owned(), RESULTS.replace("beam.dat", "beam.frd")] {
        a_beam_has_its_closed_form(&results);
    }
}

fn a_beam_has_its_closed_form(results: &str) {
    let text = format!(
        "duration = 1.0\n[law.open]\n[spacecraft]\nmass = 40.0\ninertia = [[4.0, 0, 0], [0, 5.0, 0], [0, 0, 6.0]]\n\
         [[appendage]]\nname = \"boom\"\nmass = 3.66\ncentre = [2.819672131147541, 0, 0]\nat = [0.5, 0, 0]\n\
         inertia = [[9e-5, 0, 0], [0, 6.420983606557378, 0], [0, 0, 6.420983606557378]]\n\
         modes = {results:?}\ndamping = 0.0\n"
    );
    let scenario = Scenario::parse("beam.toml", &text).unwrap_or_else(|error| panic!("{error}"));
    // 1 + cos x cosh x + (M/mL) x (cos x sinh x - sin x cosh x) = 0: in the thin direction, and twice that in the other. The
    // file's errors are those of the elements.
    let clamped: Vec<f64> = scenario.appendage[0].modes.iter().map(|mode| mode.frequency.get()).collect();
    for (index, exact, error) in
        [(0, 1.64828394, 3e-6), (2, 15.2087993, 2e-5), (4, 47.0945496, 1e-5), (6, 96.9990121, 1e-4)]
    {
        near(clamped[index], exact, error);
    }
    // Free, against Euler and Bernoulli's equation with the hub's translation and rotation at the root.
    let free: Vec<f64> = scenario
        .model
        .three_axis()
        .expect("three axes")
        .modes
        .iter()
        .map(|mode| mode.frequency.get())
        .collect();
    for (index, exact, error) in [
        (0, 4.35521656439, 7e-6),
        (1, 9.24863725801, 1.3e-5),
        (2, 16.6571906912, 2e-5),
        (3, 33.8265419263, 2e-5),
        (4, 47.9105219175, 1.1e-5),
        (5, 96.1046402846, 5e-5),
        (6, 97.6097327968, 1.2e-4),
    ] {
        near(free[index], exact, error);
    }
}

/// A spacecraft with the panel of solids that `fe/solar.inp` is the deck of.
fn with_panel(modes: &str, more: &str) -> String {
    format!(
        "duration = 1.0\n[law.open]\n[spacecraft]\nmass = 90.0\ninertia = [[80.0, 0, 0], [0, 60.0, 0], [0, 0, 70.0]]\n\
         [[appendage]]\nname = \"panel\"\nmass = 18.0\ncentre = [3.0, 0, 0]\nat = [0.4, 0.1, -0.2]\n\
         inertia = [[1.515, 0, 0], [0, 54.015, 0], [0, 0, 55.5]]\nmodes = {modes:?}\ndamping = 0.0\n{more}"
    )
}

#[test]
fn a_panel_of_solids_has_the_frequencies_of_a_beam_and_of_its_full_matrices() {
    let shapes = RESULTS.replace("beam.dat", "solar.frd");
    let more = "[[appendage.points]]\nname = \"tip\"\nposition = [6.0, 0.0, 0.0]\n";
    let scenario =
        Scenario::parse("panel.toml", &with_panel(&shapes, more)).unwrap_or_else(|error| panic!("{error}"));
    let modes = &scenario.appendage[0].modes;
    let clamped: Vec<f64> = modes.iter().map(|mode| mode.frequency.get()).collect();
    // The full matrices, clamped (tests/golden/panel_oracle.py), to the digits that they and the results are printed with.
    for (found, exact) in pairs(&clamped, CLAMPED) {
        near(*found, exact, 1e-5);
    }
    // Euler and Bernoulli's cantilever: x² sqrt(EI/m L⁴), participation 2 (cosh x + cos x)/(x (sinh x + sin x)), of which the
    // sizes of elements, and shear, leave this.
    for (index, exact, error) in
        [(0, 9.766709079, 2e-4), (1, 61.20692101, 1.2e-3), (4, 171.3811511, 2.5e-3), (5, 335.8386557, 4e-3)]
    {
        near(clamped[index], exact, error);
    }
    let mode = &modes[0];
    near(mode.translation[2].get().abs(), 0.782_991_4 * 18_f64.sqrt(), 1e-3);
    near(mode.moments.expect("first moments")[0][2].get().abs(), 0.568_825_7 * 6.0 * 18_f64.sqrt(), 1e-3);
    // At its tip a cantilever moves by twice the root of its mean square, and turns by 1.3765 times that over L.
    let tip = &mode.shapes["tip"];
    near(tip.translation[2].get().abs(), 2.0 / 18_f64.sqrt(), 1e-3);
    near(tip.rotation[1].get().abs(), 2.0 * 1.376_505_7 / 6.0 / 18_f64.sqrt(), 2e-3);
    // With the hub free, 8 modes make the 7 lowest of the full matrices of hub and panel, from above.
    let free: Vec<f64> = scenario
        .model
        .three_axis()
        .expect("three axes")
        .modes
        .iter()
        .map(|mode| mode.frequency.get())
        .collect();
    for (found, exact) in pairs(&free, FREE).take(7) {
        near(*found, exact, 3e-4);
        assert!(*found > exact * (1.0 - 1e-5), "{found} {exact}");
    }
}
