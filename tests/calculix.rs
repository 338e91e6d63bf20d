//! A beam from CalculiX's results, clamped to a hub: the frequencies of the whole in closed form (tests/golden/beam_oracle.py).

#![expect(clippy::unreadable_literal, reason = "the digits of references are compared as they stand")]

use flexsc_core::Scenario;

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
    let text = format!(
        "duration = 1.0\n[law.open]\n[spacecraft]\nmass = 40.0\ninertia = [[4.0, 0, 0], [0, 5.0, 0], [0, 0, 6.0]]\n\
         [[appendage]]\nname = \"boom\"\nmass = 3.66\ncentre = [2.819672131147541, 0, 0]\nat = [0.5, 0, 0]\n\
         inertia = [[9e-5, 0, 0], [0, 6.420983606557378, 0], [0, 0, 6.420983606557378]]\n\
         modes = {RESULTS:?}\ndamping = 0.0\n"
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
    let free: Vec<f64> =
        scenario.body.spatial().expect("three axes").modes.iter().map(|mode| mode.frequency.get()).collect();
    for (index, exact, error) in [
        (0, 4.35521656439, 7e-6),
        (1, 9.24863725801, 1.3e-5),
        (2, 16.6571906912, 2e-6),
        (3, 33.8265419263, 2e-6),
        (4, 47.9105219175, 1.1e-5),
        (5, 96.1046402846, 3e-5),
        (6, 97.6097327968, 1.2e-4),
    ] {
        near(free[index], exact, error);
    }
}
