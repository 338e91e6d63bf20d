//! Plates for sunlight and drag on appendages that drives and hinges turn.

use flexsc_core::Scenario;
use flexsc_core::numerics::attitude::{Vector, rotation};
use flexsc_core::record::Trace;
use nalgebra::Quaternion;

use crate::traces::{column, times, traced, within};
use crate::util::Dir;

const GOLDEN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden/hinged.toml");

/// Sunlight on the hub, a hinged panel and a driven antenna, so strong that 1e-9 N m are visible.
const SUNLIGHT: &str = "[environment]\nsun = [0.6, 0.3, 0.8]\n\
    solar_pressure = { pressure = 1e-3, plates = [\
    { area = 2.0, normal = [0, 0, 1], at = [0.1, 0, 0.5], specular = 0.3 }, \
    { area = 3.0, normal = [0, 0.2, 1], at = [0.2, 1.9, 0], specular = 0.2, diffuse = 0.1, appendage = \"panel 1\" }, \
    { area = 0.8, normal = [0.3, 0, 1], at = [1.2, 0.2, 0.1], appendage = \"antenna\" }] }\n";

fn text(environment: &str) -> String {
    let golden = std::fs::read_to_string(GOLDEN).expect("a file");
    let (body, rest) = golden.split_once("[[disturbance]]\nabout").expect("disturbances");
    let law = &rest[rest.find("[law.open]").expect("a law")..];
    format!("{body}{environment}{law}")
}

/// Rotates a vector by a unit quaternion.
fn turned(q: &Quaternion<f64>, v: &Vector) -> Vector {
    (q * Quaternion::from_imag(*v) * q.conjugate()).vector().into_owned()
}

/// A part of the body: mass, root, centre of mass from it, and rotation to the body's axes.
type Part = (f64, Vector, Vector, Quaternion<f64>);

/// Returns hub and appendages at a row of the log.
fn parts(trace: &Trace, row: usize, time: f64) -> [Part; 4] {
    let hinge = |k: usize| within(trace, "/hinges", "hinges", "angle_rad")[2 * row + k];
    let by = |axis: [f64; 3], angle: f64| rotation(&(Vector::from(axis).normalize() * angle));
    let half = by([0.0, 0.0, 1.0], std::f64::consts::PI);
    let v = |part: [f64; 3]| Vector::from(part);
    [
        (200.0, v([0.0; 3]), v([0.05, -0.02, 0.1]), by([1.0, 0.0, 0.0], 0.0)),
        (18.0, v([0.1, 0.6, 0.2]), v([0.2, 1.9, 0.1]), by([1.0, 0.2, -0.1], hinge(0))),
        (15.0, v([0.0, -0.6, 0.2]), v([-0.1, 1.7, 0.0]), half * by([0.0, 0.0, 1.0], hinge(1))),
        (12.0, v([0.5, 0.0, -0.1]), v([1.2, 0.2, 0.1]), by([1.0, 0.0, 0.5], 0.2 + 0.04 * time)),
    ]
}

/// The logged torque is that of the forces at the plates' places about the centre of mass, which the appendages move.
#[test]
fn plates_turn_with_their_appendages() {
    let scenario = Scenario::parse("plates.toml", &text(SUNLIGHT)).expect("a scenario");
    let trace = traced(&scenario);
    let q = ["q_w", "q_x", "q_y", "q_z"].map(|name| column(&trace, "/pointing", name));
    let torques = within(&trace, "/torques", "axes", "disturbance_nm");
    let sun = Vector::new(0.6, 0.3, 0.8).normalize();
    // Area, normal, position, specular, diffuse and part of each plate.
    let plates = [
        (2.0, [0.0, 0.0, 1.0], [0.1, 0.0, 0.5], 0.3, 0.0, 0),
        (3.0, [0.0, 0.2, 1.0], [0.2, 1.9, 0.0], 0.2, 0.1, 1),
        (0.8, [0.3, 0.0, 1.0], [1.2, 0.2, 0.1], 0.0, 0.0, 3),
    ];
    let (mut largest, mut moved): (f64, f64) = (0.0, 0.0);
    let at = times(&trace, "/pointing");
    assert_eq!(at.len() * 3, torques.len());
    let first = parts(&trace, 0, 0.0);
    for (row, time) in at.iter().enumerate() {
        let attitude = Quaternion::new(q[0][row], q[1][row], q[2][row], q[3][row]);
        let light = turned(&attitude.conjugate(), &sun);
        let sum = |parts: &[Part; 4]| {
            let mass: f64 = parts.iter().map(|part| part.0).sum();
            let moment: Vector =
                parts.iter().map(|(m, root, centre, to_body)| (root + turned(to_body, centre)) * *m).sum();
            let torque = |(area, normal, place, specular, diffuse, part): (
                f64,
                [f64; 3],
                [f64; 3],
                f64,
                f64,
                usize,
            )| {
                let (_, root, _, to_body) = &parts[part];
                let n = turned(to_body, &Vector::from(normal).normalize());
                let c = n.dot(&light).max(0.0);
                let force = (light * (1.0 - specular) + n * (2.0 * (specular * c + diffuse / 3.0)))
                    * (-1e-3 * area * c);
                (root + turned(to_body, &Vector::from(place)) - moment / mass).cross(&force)
            };
            plates.into_iter().map(torque).sum::<Vector>()
        };
        let found = Vector::new(torques[3 * row], torques[3 * row + 1], torques[3 * row + 2]);
        let expected = sum(&parts(&trace, row, *time));
        assert!((found - expected).norm() < 1e-11, "{time}: {found} {expected}");
        largest = largest.max(expected.norm());
        moved = moved.max((expected - sum(&first)).norm());
    }
    assert!(largest > 1e-3 && moved > 1e-3, "{largest} {moved}");
    // Momentum about the centre of mass changes by the integral of the torque in inertial axes.
    let momentum = column(&trace, "/energy", "momentum_nm_s");
    assert!((momentum[momentum.len() - 1] / momentum[0] - 1.0).abs() > 1e-4);
}

/// A plate on an appendage at rest is a plate in the body's axes, for sunlight and for drag.
#[test]
fn a_plate_on_an_appendage_at_rest_is_one_of_the_body() {
    let with = |first: &str, second: &str| {
        let text = format!(
            "duration = 300.0\nlaw = {{ open = {{}} }}\nlog = {{ period = 10.0 }}\n\
             [spacecraft]\nmass = 100.0\ninertia = [[20, 0, 0], [0, 24, 0], [0, 0, 28]]\nrate = [0, -1e-3, 0]\n\
             [[appendage]]\nname = \"wing\"\nmass = 5.0\ncentre = [0, 1, 0]\ninertia = [[2, 0, 0], [0, 0.2, 0], [0, 0, 2.2]]\n\
             at = [0, 0.5, 0]\nturned = {{ about = [0, 0, 1], by = 1.5707963267948966 }}\n\
             [environment]\norbit = {{ semi_major_axis = 6.778e6, inclination = 1.2 }}\nsun = [0.9, 0.4, 0.17]\n\
             solar_pressure = {{ plates = [{{ area = 3.0, {first} }}] }}\n\
             drag = {{ density = 1e-12, plates = [{{ area = 3.0, {second} }}] }}\n"
        );
        let trace = traced(&Scenario::parse("plate.toml", &text).expect("a scenario"));
        within(&trace, "/torques", "axes", "disturbance_nm").to_vec()
    };
    // A quarter turn about z takes x to y and y to -x.
    let on = with(
        "normal = [1, 0, 0.5], at = [0.1, 1.2, 0], appendage = \"wing\"",
        "normal = [0, -1, 0], at = [0.1, 1.2, 0.3], appendage = \"wing\"",
    );
    let body = with("normal = [0, 1, 0.5], at = [-1.2, 0.6, 0]", "normal = [1, 0, 0], at = [-1.2, 0.6, 0.3]");
    assert!(on.iter().any(|torque| torque.abs() > 1e-6));
    for (on, body) in on.iter().zip(&body) {
        assert!((on - body).abs() < 1e-15, "{on} {body}");
    }
}

#[test]
fn a_plate_on_no_appendage_is_refused() {
    let dir = Dir::with(&[]);
    dir.write("study.toml", text(SUNLIGHT).replace("appendage = \"antenna\"", "appendage = \"dish\""));
    dir.run("check study.toml").exits(2).says(&[
        "study.toml:",
        "`environment.solar_pressure.plates[2].appendage`",
        "one of \"panel 1\", \"panel 2\", \"antenna\", got \"dish\"",
    ]);
}
