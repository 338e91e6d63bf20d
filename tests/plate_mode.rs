//! A panel known by its mass, its size and its first frequency: the first bending mode of a uniform cantilever.
//!
//! Golden numbers: tests/golden/plate_oracle.py, mpmath.

use flexsc_core::Scenario;
use flexsc_core::numerics::attitude::{Vector, vector};

use crate::craft::near;
use crate::traces::{column, traced};

/// Participations over sqrt(m) and sqrt(m) L.
const TRANSLATION: f64 = 0.782_991_756_039_625_8;
const ROTATION: f64 = 0.568_825_743_709_910_8;
/// Place over L, displacement times sqrt(m), slope times sqrt(m) L.
const SHAPE: [[f64; 3]; 4] = [
    [0.25, 0.194_571_616_707_423_62, 1.456_186_134_098_768_5],
    [0.5, 0.679_046_225_730_647_9, 2.326_108_900_682_365],
    [0.8, 1.450_955_383_468_002, 2.722_312_832_269_101],
    [1.0, 2.0, 2.753_010_969_345_069_7],
];

/// A 6U CubeSat with one panel, of which `panel` has the keys that differ.
fn text(panel: &str) -> String {
    format!(
        "duration = 20.0\n[spacecraft]\nmass = 11.0\ninertia = [[0.09, 0, 0], [0, 0.13, 0], [0, 0, 0.16]]\n\
         [[appendage]]\nname = \"panel\"\nmass = 0.35\nat = [0.0, 0.1, 0.0]\n{panel}\n\
         [law.pd]\nk_p = 0.01\nk_d = 0.06\nperiod = 0.5\n[[target]]\nfrom = 2.0\nroll = \"1 deg\"\n"
    )
}

fn read(panel: &str) -> Scenario {
    Scenario::parse("panel.toml", &text(panel)).expect("valid")
}

#[test]
fn the_mode_is_the_first_of_a_uniform_cantilever() {
    let (mass, length) = (0.35, 0.3);
    for (along, axis, turned) in [("y", 1, Vector::x()), ("x", 0, -Vector::y())] {
        let point = |[at, ..]: [f64; 3], height: f64| {
            let mut position = [0.0, 0.0, height];
            position[axis] = at * length;
            position[1 - axis] = 0.1;
            format!("{{ name = \"{at} {height}\", position = {position:?} }}")
        };
        let points: Vec<_> = SHAPE.iter().flat_map(|row| [point(*row, 0.0), point(*row, 0.02)]).collect();
        let scenario = read(&format!(
            "plate = {{ length = 0.3, width = 0.2, frequency = \"2.3 Hz\", damping = \"0.5 %\", along = \"{along}\" }}\n\
             points = [{}]",
            points.join(", ")
        ));
        let panel = &scenario.appendage[0];
        let modes = panel.clamped_modes();
        assert_eq!(modes.len(), 1);
        near(modes[0].frequency.get(), std::f64::consts::TAU * 2.3, 1e-14);
        near(modes[0].damping.get(), 0.005, 1e-15);
        let (t, r) = panel.participations()[0];
        let root = f64::sqrt(mass);
        assert!((t - Vector::z() * (TRANSLATION * root)).norm() < 1e-15, "{t}");
        assert!((r - turned * (ROTATION * root * length)).norm() < 1e-15, "{r}");
        for [at, displacement, slope] in SHAPE {
            let angle = turned * (slope / (root * length));
            for height in [0.0, 0.02] {
                let shape = &modes[0].shapes[&format!("{at} {height}")];
                let moved = Vector::z() * (displacement / root) + angle.cross(&(Vector::z() * height));
                assert!((vector(&shape.translation) - moved).norm() < 1e-14 * moved.norm());
                assert!((vector(&shape.rotation) - angle).norm() < 1e-14 * angle.norm());
            }
        }
    }
}

/// A panel whose mode is written out has the same run, to rounding.
#[test]
fn a_plate_moves_as_its_mode_written_out() {
    let (mass, length, width) = (0.35_f64, 0.3, 0.2);
    let plate = read("plate = { length = 0.3, width = 0.2, frequency = \"2.3 Hz\", damping = 0.005 }");
    let [long, wide] = [mass / 12.0 * length * length, mass / 12.0 * width * width];
    let written = read(&format!(
        "centre = [0, {}, 0]\ninertia = [[{long}, 0, 0], [0, {wide}, 0], [0, 0, {}]]\nplate = \"y\"\nmodes = [{{ frequency = \
         \"2.3 Hz\", damping = 0.005, translation = [0, 0, {}], rotation = [{}, 0, 0] }}]",
        length / 2.0,
        long + wide,
        TRANSLATION * mass.sqrt(),
        ROTATION * mass.sqrt() * length
    ));
    let errors = |scenario: &Scenario| column(&traced(scenario), "/pointing", "roll_error_rad").to_vec();
    let (own, other) = (errors(&plate), errors(&written));
    let largest = own.iter().fold(0.0_f64, |most, rate| most.max(rate.abs()));
    assert!(largest > 1e-4, "{largest}");
    assert!(own.iter().zip(&other).all(|(a, b)| (a - b).abs() < 1e-11 * largest));
}

#[test]
fn what_does_not_go_with_a_plate_is_refused() {
    const PLATE: &str = "plate = { length = 0.3, width = 0.2, frequency = \"2.3 Hz\" }";
    for (panel, line, words) in [
        ("plate = { length = 0.3, frequency = 14.5 }".to_owned(), 9, "missing key `width`"),
        (PLATE.replace("width", "with"), 9, "with"),
        (PLATE.replace("2.3 Hz", "2.3 m"), 9, "`appendage[0].plate.frequency`"),
        (PLATE.replace("0.3", "-0.3"), 9, "`appendage[0].plate.length`: must be a positive number"),
        ("plate = \"z\"".to_owned(), 9, "`appendage[0].plate`"),
        ("plate = 2.3".to_owned(), 9, "\"x\", \"y\", or { length = ..., width = ..., frequency = ... }"),
        (format!("{PLATE}\ncentre = [0, 0.15, 0]"), 10, "`appendage[0].centre` must be left out"),
        (format!("{PLATE}\nmodes = [{{ frequency = 1.0 }}]"), 10, "`appendage[0].modes` must be left out"),
        (format!("{PLATE}\ndamping = 0.01"), 10, "`appendage[0].damping` must be in `plate`"),
        (
            format!("{PLATE}\npoints = [{{ name = \"tip\", position = [0, 0.4, 0] }}]"),
            10,
            "`appendage[0].points[0].position` must be on the plate",
        ),
    ] {
        let error = Scenario::parse("panel.toml", &text(&panel)).expect_err(&panel).to_string();
        assert!(error.contains(words) && error.contains(&format!("panel.toml:{line}:")), "{error}");
    }
}
