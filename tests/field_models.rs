//! Models of the Earth's magnetic field in whole scenarios: defaults, the model of an attitude filter, and bad keys.

use flexsc_core::Scenario;
use flexsc_core::record::Trace;

use crate::traces::{times, traced, within};
use crate::util::Dir;

/// Returns the rows of a column along three axes.
fn along(trace: &Trace, topic: &str, field: &str) -> Vec<[f64; 3]> {
    within(trace, topic, "axes", field).chunks_exact(3).map(|row| [row[0], row[1], row[2]]).collect()
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn norm(v: &[f64; 3]) -> f64 {
    dot(v, v).sqrt()
}

fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// A body at rest whose filter takes the field of a lower degree than the true one, with hardly any noise.
const BOARD_MODEL: &str = "duration = 5.0\nepoch = 2026-11-24T00:00:00Z\nlaw = { open = {} }\n\
    sensor = [{ gyro = { period = 0.5, angle_random_walk = 1e-6 } }, { magnetometer = { period = 0.5, noise = 1e-11 } }]\n\
    estimator = { attitude = { prior = \"true\", watch_only = true, field_degree = 1, gate = { deviations = 1e6 } } }\n\
    [spacecraft]\nmass = 100.0\ninertia = [[30, 0, 0], [0, 40, 0], [0, 0, 35]]\n\
    [environment]\norbit = { semi_major_axis = 7e6, inclination = 1.2, node = 0.4 }\nmagnetic_field = {}\n";

/// The first innovation of a filter with a dipole as its model is the rotation from the dipole to the true field.
#[test]
fn a_filter_with_a_dipole_errs_by_what_the_dipole_leaves_out() {
    let innovation = |text: &str| {
        let scenario = Scenario::parse("model.toml", text).expect("a scenario");
        let trace = traced(&scenario);
        let t = times(&trace, "/attitude_filter")[0];
        let sky = scenario.orbit_environment();
        let truth: [f64; 3] = sky.field_at(t).expect("a field").into();
        let model: [f64; 3] = sky.with_field_degree(1).field_at(t).expect("a field").into();
        let exact = cross(&truth, &model).map(|part| part / dot(&model, &model));
        (along(&trace, "/attitude_filter", "innovation_rad")[0], exact)
    };
    let (found, exact) = innovation(BOARD_MODEL);
    assert!(norm(&exact) > 0.02, "{exact:?}");
    let off = [0, 1, 2].map(|axis| found[axis] - exact[axis]);
    assert!(norm(&off) < 5e-6, "{found:?} {exact:?}");
    // With the degree of the truth, and by default, the model has no error.
    for other in ["field_degree = 13", "initial = { angle = 1e-3 }"] {
        let (found, _) = innovation(&BOARD_MODEL.replace("field_degree = 1", other));
        assert!(norm(&found) < 5e-6, "{other}: {found:?}");
    }
}

#[test]
fn fields_that_do_not_fit_are_refused() {
    for (from, to, words) in [
        (
            "field_degree = 1",
            "field_degree = 14",
            ["`estimator.attitude.field_degree`", "from 1 to 13", "got 14"],
        ),
        (
            "field_degree = 1",
            "field_degree = 0",
            ["`estimator.attitude.field_degree`", "from 1 to 13", "got 0"],
        ),
        (
            "magnetic_field = {}",
            "magnetic_field = { degree = 14 }",
            ["`environment.magnetic_field.degree`", "from 1 to 13", "got 14"],
        ),
        (
            "magnetic_field = {}",
            "magnetic_field = { model = \"WMM2025\", degree = 13 }",
            ["`environment.magnetic_field.degree`", "from 1 to 12", "got 13"],
        ),
        (
            "magnetic_field = {}",
            "magnetic_field = { model = \"IGRF-14\", radius = 6.4e6 }",
            ["`environment.magnetic_field.radius`", "is for the model \"dipole\"", "leave it out"],
        ),
        (
            "magnetic_field = {}",
            "magnetic_field = { model = \"IGRF-13\" }",
            ["`environment.magnetic_field.model`", "IGRF-14", "WMM2025"],
        ),
        (
            "epoch = 2026-11-24T00:00:00Z",
            "epoch = 1999-07-01T00:00:00Z",
            ["`environment.magnetic_field.model`", "covers 2000 to 2030", "from 1999.50"],
        ),
        (
            "epoch = 2026-11-24T00:00:00Z",
            "epoch = 1969-12-31T23:59:59Z",
            ["`epoch`", "must be a date and time from 1970 to 2500", "such as 2026-"],
        ),
        (
            "epoch = 2026-11-24T00:00:00Z",
            "epoch = 2026-11-24",
            ["`epoch`", "must be a date and time from 1970 to 2500", "such as 2026-"],
        ),
        ("epoch = 2026-11-24T00:00:00Z", "", ["`estimator.attitude.field_degree`", "must be 1", "got 13"]),
    ] {
        assert!(BOARD_MODEL.contains(from), "{from}");
        let text = BOARD_MODEL.replace(from, to);
        let text = if to.is_empty() { text.replace("field_degree = 1", "field_degree = 13") } else { text };
        let error = Scenario::parse("bad.toml", &text).expect_err(words[1]).to_string();
        assert!(words.iter().all(|word| error.contains(word)), "{error}");
    }
    let undated = BOARD_MODEL
        .replace("epoch = 2026-11-24T00:00:00Z", "")
        .replace("magnetic_field = {}", "magnetic_field = { model = \"IGRF-14\" }");
    let error = Scenario::parse("bad.toml", &undated).expect_err("no date").to_string();
    assert!(error.contains("`environment.magnetic_field.model`") && error.contains("`epoch`"), "{error}");
}

/// With a date the field is IGRF-14 unless a key of the dipole is given; a written scenario gives the same one.
#[test]
fn the_model_follows_from_the_date() {
    let field = |text: &str| {
        let scenario = Scenario::parse("model.toml", text).expect("a scenario");
        let again = Scenario::parse("again.toml", &scenario.to_toml()).expect("a scenario");
        let at = |scenario: &Scenario| -> [f64; 3] {
            scenario.orbit_environment().field_at(100.0).expect("a field").into()
        };
        assert_eq!(at(&scenario), at(&again));
        at(&scenario)
    };
    let with = |keys: &str| {
        field(&BOARD_MODEL.replace("magnetic_field = {}", &format!("magnetic_field = {{ {keys} }}")))
    };
    let default = with("");
    assert_eq!(default, with("model = \"IGRF-14\", degree = 13"));
    let dipole = with("model = \"dipole\"");
    assert_ne!(default, dipole);
    // Coefficients of a dipole, of any size, are those of the dipole.
    let scaled = with("coefficients = [-1.4509e-6, 4.6525e-6, -2.94049e-5]");
    let off = [0, 1, 2].map(|axis| scaled[axis] - dipole[axis]);
    assert!(norm(&off) > 0.0 && norm(&off) < 1e-5 * norm(&dipole), "{off:?}");
    // Without a date it is the dipole, with the meridian at inertial x.
    let undated = BOARD_MODEL.replace("epoch = 2026-11-24T00:00:00Z", "");
    assert_eq!(field(&undated), with("model = \"dipole\", meridian = 0.0"));
}

/// A file of coefficients, whose first degree is a dipole, has its field; a log repeats without the file, and a damaged file is refused
/// with its line.
#[test]
fn files_of_coefficients_are_fields() {
    let wmm = "  2025.0  WMM-2025  11/13/2024\n1 0 -29350.0 0.0 12.6 0.0\n1 1 -1410.3 4545.5 10.0 -21.5\n9999999999999999999999999\n";
    let shc = "# comment\n1 1 2 2 1 2025.0 2030.0\n2025.0 2030.0\n1 0 -29350.0 -29287.0\n1 1 -1410.3 -1360.3\n1 -1 4545.5 4438.0\n";
    let field = |scenario: &Scenario| scenario.orbit_environment().field_at(900.0).expect("a field");
    // The day of the year 328 of 365, of the first degree of IGRF-14 with its rates.
    let years = 1.0 + 327.0 / 365.0;
    let [g10, g11, h11] = [[-29_350.0, 12.6], [-1410.3, 10.0], [4545.5, -21.5]]
        .map(|[value, rate]| 1e-9 * (value + rate * years));
    let dipole = format!("magnetic_field = {{ coefficients = [{g11:e}, {h11:e}, {g10:e}] }}");
    let exact = field(
        &Scenario::parse("a.toml", &BOARD_MODEL.replace("magnetic_field = {}", &dipole)).expect("a scenario"),
    );
    let dir = Dir::with(&[]);
    for (name, text) in [("field.COF", wmm), ("field.shc", shc)] {
        dir.write(name, text);
        dir.write(
            "study.toml",
            BOARD_MODEL.replace("magnetic_field = {}", &format!("magnetic_field = {{ table = \"{name}\" }}")),
        );
        let scenario = Scenario::load(&dir.path("study.toml")).expect("a scenario");
        let off = (field(&scenario) - exact).norm();
        assert!(off < 1e-17, "{name}: {off:e}");
        let alone = scenario.self_contained().to_toml();
        assert!(!alone.contains(name), "{alone}");
        assert_eq!(field(&Scenario::parse("alone.toml", &alone).expect("self-contained")), field(&scenario));
    }
    dir.write("field.shc", shc.replace("1 -1 4545.5", "1 -2 4545.5"));
    dir.run("check study.toml").exits(2).says(&[
        "study.toml:",
        "`environment.magnetic_field.table`",
        "field.shc: line 6: must have an order from -1 to 1, got -2",
    ]);
    dir.write(
        "study.toml",
        BOARD_MODEL.replace("magnetic_field = {}", "magnetic_field = { table = \"none.COF\" }"),
    );
    dir.run("check study.toml").exits(2).says(&["`environment.magnetic_field.table`", "none.COF"]);
}
