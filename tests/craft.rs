//! A spacecraft from its parts: hub, appendages with clamped modes, rotors.
//!
//! Golden numbers: tests/golden/craft_oracle.py, mpmath; the reference spacecraft is tests/golden/craft.toml.

#![expect(clippy::unreadable_literal, reason = "the digits of references are compared as they stand")]

use std::collections::BTreeMap;

use flexsc_core::numerics::attitude::Vector;
use flexsc_core::spacecraft::body::craft::{AssembledSpacecraft, HubRotor};
use flexsc_core::{Document, Scenario, ScenarioError};
use nalgebra::{DMatrix, Matrix3, Matrix3xX, matrix, vector};

use crate::study::pairs;

/// The reference spacecraft.
pub const CRAFT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden/craft.toml");

/// A hub with a panel of one bending mode.
pub const ONE: &str = r#"duration = 10.0
[spacecraft]
mass = 400.0
inertia = [[300.0, 0.0, 0.0], [0.0, 200.0, 0.0], [0.0, 0.0, 250.0]]
[[appendage]]
name = "panel"
mass = 20.0
centre = [0.0, 2.0, 0.0]
inertia = [[30.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 33.0]]
at = [0.0, 1.0, 0.0]
points = [{ name = "tip", position = [0.0, 4.0, 0.0] }]
modes = [
    { frequency = 2.0, damping = 0.01, translation = [0.0, 0.0, 3.5], rotation = [9.0, 0.0, 0.0], shapes = { tip = { translation = [0.0, 0.0, 0.5] } } },
]
[law.pd]
k_p = 1.0
k_d = 20.0
period = 0.5
"#;

/// The reference spacecraft with some keys set.
pub fn reference(set: &[(&str, &str)]) -> Result<Scenario, ScenarioError> {
    let mut document = Document::load(CRAFT.as_ref()).expect("a scenario");
    for (key, value) in set {
        document.set_text(key, value).expect("a key");
    }
    Scenario::from_document(&document)
}

pub fn craft(scenario: &Scenario) -> &AssembledSpacecraft {
    scenario.model.spacecraft().expect("a spacecraft")
}

/// The four wheels of the oracle, a pyramid of 35 degrees.
fn wheels() -> Vec<HubRotor> {
    let cant = 35_f64.to_radians();
    let axis = |degrees: f64| {
        let around = degrees.to_radians();
        vector![cant.cos() * around.cos(), cant.cos() * around.sin(), cant.sin()]
    };
    [45.0, 135.0, 225.0, 315.0].map(|at| HubRotor { axis: axis(at), spin_inertia: 0.04 }).to_vec()
}

/// The reference spacecraft with wheels that turn freely.
fn open() -> AssembledSpacecraft {
    let scenario = reference(&[]).expect("valid");
    let hub = scenario.spacecraft.as_ref().expect("a hub");
    AssembledSpacecraft::assemble(hub, &scenario.appendage, &[0.0; 2], &wheels()).expect("valid")
}

/// The rows of the oracle for wheels that are open or locked.
pub fn golden(wheels: &str) -> Vec<BTreeMap<String, f64>> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden/craft.csv");
    let mut rows = csv::Reader::from_path(path).expect("golden");
    let rows = rows.deserialize().map(|row| row.expect("a whole row"));
    let of = |row: &BTreeMap<String, String>| row["wheels"] == wheels;
    let numbers = |row: BTreeMap<String, String>| {
        row.into_iter().filter_map(|(name, value)| Some((name, value.parse().ok()?))).collect()
    };
    rows.filter(of).map(numbers).collect()
}

pub fn three(row: &BTreeMap<String, f64>, name: &str) -> Vector {
    Vector::from_fn(|axis, _| row[&format!("{name}_{}", ["x", "y", "z"][axis])])
}

#[track_caller]
pub fn near(found: f64, exact: f64, error: f64) {
    assert!((found - exact).abs() <= error, "{found:e} is off {exact:e} by {:e}", found - exact);
}

/// Every number of the free modes, with wheels free and locked, against 50 digits of the whole problem of 6 + n.
#[test]
fn free_modes_agree_with_the_whole_problem() {
    let scenario = reference(&[]).expect("valid");
    for (wheels, craft) in [("open", &open()), ("locked", craft(&scenario))] {
        let rows = golden(wheels);
        let flexible = craft.model.flexible().expect("two-way");
        assert_eq!(flexible.modes.len(), 8);
        let mut worst = [0.0_f64; 3];
        for (index, row) in rows.iter().enumerate() {
            let (mode, shown) = (&flexible.modes[index], &craft.model.modes[index]);
            worst[0] = worst[0].max((mode.frequency / row["frequency"] - 1.0).abs());
            worst[1] = worst[1].max((mode.rotation - three(row, "phi")).norm());
            assert_eq!((shown.frequency.get(), shown.damping.get()), (mode.frequency, mode.damping));
            near(mode.damping / row["damping"], 1.0, 1e-12);
            for (at, name) in ["x", "y", "z"].iter().enumerate() {
                for (column, other) in ["x", "y", "z"].iter().enumerate() {
                    let exact = row[&format!("j_{name}{other}")];
                    near(mode.moments[(at, column)], exact, 1e-12 * exact.abs().max(1.0));
                }
            }
            let shapes = |point: &str| craft.model.shapes(point)[index];
            for (found, exact) in [
                (shapes("jet").0, three(row, "hub")),
                (shapes("jet").1, three(row, "phi")),
                (shapes("tip").0, three(row, "tip")),
                (shapes("tip").1, three(row, "tip_turn")),
            ] {
                worst[2] = worst[2].max((found - exact).norm());
            }
        }
        assert!(worst.iter().all(|error| *error < 1e-12), "{wheels}: {worst:?}");
        near(craft.damping_coupling / rows[0]["kappa"], 1.0, 1e-9);
        assert!(flexible.damping.is_none(), "1.7e-3 is small");
    }
}

/// Rotations delta of the clamped modes about the centre of mass, from their first moments.
fn rotations(craft: &AssembledSpacecraft) -> Matrix3xX<f64> {
    let of = |n: &Matrix3<f64>| vector![n[(1, 2)] - n[(2, 1)], n[(2, 0)] - n[(0, 2)], n[(0, 1)] - n[(1, 0)]];
    let columns: Vec<_> = craft.parts.iter().map(|part| of(&part.moments)).collect();
    Matrix3xX::from_columns(&columns)
}

fn translations(craft: &AssembledSpacecraft) -> Matrix3xX<f64> {
    let columns: Vec<_> = craft.parts.iter().map(|part| part.translation).collect();
    Matrix3xX::from_columns(&columns)
}

fn increasing(matrix: &DMatrix<f64>) -> Vec<f64> {
    let mut values = matrix.symmetric_eigenvalues().as_slice().to_vec();
    values.sort_by(f64::total_cmp);
    values
}

/// Intermediate results of the assembly, with freely rotating wheels; the numbers are those of two other programs.
#[test]
fn the_parts_come_to_the_right_sums() {
    let craft = open();
    near(craft.mass, 660.0, 0.0);
    let centre = vector![0.0454545454545, -0.0181818181818, 0.1090909090909];
    near((craft.centre - centre).norm(), 0.0, 1e-12);
    let inertia = craft.model.inertia;
    let exact = matrix![
        1112.5229116171, 6.0545454545, 0.5817272652715;
        6.0545454545, 311.87813737609, 4.8909090909;
        0.5817272652715, 4.8909090909, 1089.3462237341
    ];
    near((inertia - exact).norm(), 0.0, 2e-10);
    let first = craft.parts[0].moments;
    let exact = matrix![
        -0.082385588142, 0.0, -0.176676463921;
        8.428561837519, 0.0, 18.075109190502;
        0.164771176284, 0.0, 0.353352927842
    ];
    near((first - exact).norm(), 0.0, 2e-12);
    let stretching = |index: usize| {
        let n: Matrix3<f64> = craft.parts[index].moments;
        2.0 * n.trace() * Matrix3::identity() - n - n.transpose()
    };
    near(stretching(0)[(0, 0)], 0.7067058556844, 1e-12);
    near(stretching(0)[(1, 2)], -18.07510919050, 1e-11);
    near(stretching(1)[(0, 0)], 1.635734699392, 1e-12);
    near(stretching(1)[(0, 2)], 1.372544382964, 1e-12);
    near(stretching(1).column(1).norm(), 0.0, 1e-15);
    let (t, delta) = (translations(&craft), rotations(&craft));
    near((delta.column(0) - vector![18.0751091905024, 0.3414476402054, -8.4285618375191]).norm(), 0.0, 2e-13);

    // The first jet pushes 5 N along z: half of a pair of panels moves each clamped mode.
    let pushed = t.tr_mul(&vector![0.0, 0.0, -5.0]) / craft.mass;
    for (found, exact) in pushed.iter().zip([-0.02944608, 0.0, -0.01631835, 0.01373093]) {
        near(*found, exact, 5e-9);
    }
    near(pushed[7], -0.01373093, 5e-9);

    let e = DMatrix::identity(8, 8) - t.tr_mul(&t) / craft.mass;
    let inverse = inertia.try_inverse().expect("definite");
    let found = increasing(&(&e - delta.tr_mul(&(inverse * &delta))));
    let exact =
        [0.243720072316, 0.279403101175, 0.9254706099614, 0.9433988123306, 0.9718565445801, 1.0, 1.0, 1.0];
    for (found, exact) in pairs(&found, exact) {
        near(*found, exact, 1e-12);
    }
    let carried = &delta * e.try_inverse().expect("definite") * delta.transpose();
    let left = DMatrix::from_fn(3, 3, |row, column| inertia[(row, column)] - carried[(row, column)]);
    for (found, exact) in increasing(&left).iter().zip([268.85973971, 296.68953622, 312.67719513]) {
        near(*found, exact, 1e-8);
    }
}

/// Free modes give the clamped ones back: W² x = O² (1 + phi' J phi + m u' u) x.
#[test]
fn free_modes_lead_back_to_clamped_ones() {
    let craft = open();
    let at = craft.model.point("jet").expect("a point");
    let modes = craft.model.shapes("jet");
    let order = modes.len();
    let (phi, u): (Vec<_>, Vec<_>) = modes.iter().map(|(f, phi)| (*phi, f - phi.cross(&at))).unzip();
    let matrix = DMatrix::from_fn(order, order, |row, column| {
        let own = if row == column { 1.0 } else { 0.0 };
        let sum =
            own + phi[row].dot(&(craft.model.inertia * phi[column])) + craft.mass * u[row].dot(&u[column]);
        sum / (craft.model.modes[row].frequency.get() * craft.model.modes[column].frequency.get())
    });
    let mut clamped: Vec<f64> = craft.parts.iter().map(|part| part.frequency).collect();
    clamped.sort_by(f64::total_cmp);
    for (square, exact) in pairs(increasing(&matrix).iter().rev(), clamped) {
        near(1.0 / square.sqrt() / exact, 1.0, 1e-12);
    }
}

#[test]
fn one_mode_is_solved_by_hand() {
    let scenario = Scenario::parse("one.toml", ONE).expect("valid");
    let craft = craft(&scenario);
    // 400 kg at O and 20 kg 3 m out; t = 3.5 at b from the common centre of mass.
    let (centre, mass) = (60.0 / 420.0, 420.0);
    let inertia = 300.0 + 30.0 + 400.0 * centre * centre + 20.0 * (3.0 - centre) * (3.0 - centre);
    let delta: f64 = 9.0 + (1.0 - centre) * 3.5;
    let s = 1.0 - 3.5 * 3.5 / mass - delta * delta / inertia;
    let flexible = craft.model.flexible().expect("two-way");
    let mode = &flexible.modes[0];
    near(mode.frequency, 2.0 / s.sqrt(), 1e-14 * mode.frequency);
    near(mode.damping, 0.01 / s.sqrt(), 1e-15);
    near(mode.rotation.x, -delta / inertia / s.sqrt(), 1e-15);
    assert_eq!(craft.damping_coupling.to_bits(), 0);
    // Without first moments nothing but the offset of the root is known of them.
    assert!(!craft.parts[0].knows_moments);
    near(mode.moments[(1, 2)], -(1.0 - centre) * 3.5 / s.sqrt(), 1e-14);
}

/// A mass on a spring that moves along the line through the centre of mass: two bodies on a spring.
#[test]
fn a_sloshing_mass_is_an_appendage() {
    let text = "duration = 1.0\n[spacecraft]\nmass = 400.0\ninertia = [[90, 0, 0], [0, 80, 0], [0, 0, 70]]\n[[appendage]]\n\
                name = \"propellant\"\nmass = 50.0\ncentre = [0.5, 0, 0]\nmodes = [\n\
                { frequency = 3.0, translation = [7.0710678118654755, 0, 0] },\n\
                { frequency = 3.0, translation = [0, 7.0710678118654755, 0] }]\n[law.pd]\nk_p = 1\nk_d = 20\nperiod = 0.5\n";
    let scenario = Scenario::parse("slosh.toml", text).expect("valid");
    let craft = craft(&scenario);
    let modes = craft.model.flexible().expect("two-way").modes;
    let along = 3.0 * (450.0_f64 / 400.0).sqrt();
    near(modes[0].frequency, along, 1e-13);
    // Across, the hub turns too: 1/m_hub + 1/m_mass + b²/J_hub, the mass at b from the hub's own centre.
    let across = 3.0 * (50.0 * (1.0 / 50.0 + 1.0 / 400.0 + 0.25 / 70.0_f64)).sqrt();
    near(modes[1].frequency, across, 1e-13);
    assert!(craft.parts.iter().all(|part| part.knows_moments));
    // Farther out along x, the mass adds 2 m b to the inertia about y and z.
    let b = 0.5 * 400.0 / 450.0;
    let grown = 2.0 * b * 50.0_f64.sqrt();
    let share = modes[0].moments[(1, 1)] / grown;
    near(modes[0].moments[(2, 2)], share * grown, 1e-13);
    near(modes[0].moments[(0, 0)], 0.0, 1e-13);
    near(share.abs(), along / 3.0, 1e-13);
}

/// Changes that leave the spacecraft the same change numbers by rounding only: order of the appendages, point O, axes.
#[test]
fn order_origin_and_axes_do_not_matter() {
    let scenario = reference(&[]).expect("valid");
    let (hub, panels) = (scenario.spacecraft.as_ref().expect("a hub"), &scenario.appendage);
    let exact = craft(&scenario);
    let put = |text: &str| {
        let scenario = Scenario::parse("again.toml", text).expect("valid");
        craft(&scenario).clone()
    };
    let swapped = AssembledSpacecraft::assemble(hub, &[panels[1].clone(), panels[0].clone()], &[0.0; 2], &[])
        .expect("valid");
    // O is moved by (1, -2, 0.5), and with it everything that is given from there.
    let mut moved = scenario.clone();
    let mut document = Document::from_table("moved.toml", moved.to_table());
    for (key, value) in [
        ("spacecraft.centre", "[1.05, -2.02, 0.6]"),
        (
            "spacecraft.points",
            "[{ name = \"bus\", position = [1, -2, 0.5] }, { name = \"jet\", position = [1.8, -1.5, 0.5] }]",
        ),
        ("appendage[0].at", "[1.0, -1.0, 0.7]"),
        ("appendage[1].at", "[1.0, -3.0, 0.7]"),
    ] {
        document.set_text(key, value).expect("a key");
    }
    moved = Scenario::from_document(&document).expect("valid");
    // The body's axes are turned a quarter about z: x is now where y was.
    let turned = std::fs::read_to_string(CRAFT)
        .expect("a scenario")
        .replace("centre = [0.05, -0.02, 0.10]", "centre = [-0.02, -0.05, 0.10]")
        .replace(
            "[[250.0, 6.0, -4.0], [6.0, 300.0, 5.0], [-4.0, 5.0, 220.0]]",
            "[[300.0, -6.0, 5.0], [-6.0, 250.0, 4.0], [5.0, 4.0, 220.0]]",
        )
        .replace("[0.0, 1.0, 0.2]", "[1.0, 0.0, 0.2]")
        .replace("[0.0, -1.0, 0.2]", "[-1.0, 0.0, 0.2]")
        .replace("position = [0.8, 0.5, 0.0]", "position = [0.5, -0.8, 0.0]")
        .replace(
            "turned = { about = [0, 1, 0]",
            "turned = [{ about = [0, 0, -3], by = 1.5707963267948966 }, { about = [0, 1, 0]",
        )
        .replace("by = 0.4363323129985824 }  ", "by = 0.4363323129985824 }]  ")
        .replace("by = 3.141592653589793", "by = 1.5707963267948966");
    let back = matrix![0.0, -1.0, 0.0; 1.0, 0.0, 0.0; 0.0, 0.0, 1.0];
    for (name, again, back) in [
        ("swapped", &swapped, Matrix3::identity()),
        ("moved", craft(&moved), Matrix3::identity()),
        ("turned", &put(&turned), back),
    ] {
        let [modes, exact_modes] = [again, exact].map(|craft| craft.model.flexible().expect("two-way").modes);
        for (index, (mode, exact)) in pairs(&modes, &exact_modes).enumerate() {
            near(mode.frequency / exact.frequency, 1.0, 2e-13);
            near(mode.damping / exact.damping, 1.0, 2e-12);
            near((back * mode.rotation - exact.rotation).norm(), 0.0, 1e-13);
            near((back * mode.moments * back.transpose() - exact.moments).norm(), 0.0, 1e-11);
            for point in ["jet", "tip"] {
                let of = |craft: &AssembledSpacecraft| craft.model.shapes(point)[index];
                let ((f, phi), (exact_f, exact_phi)) = (of(again), of(self::craft(&scenario)));
                near((back * f - exact_f).norm() + (back * phi - exact_phi).norm(), 0.0, 1e-12);
            }
        }
        near((back * again.model.inertia * back.transpose() - exact.model.inertia).norm(), 0.0, 1e-11);
        assert_eq!(modes.len(), 8, "{name}");
    }
}

/// A start of clamped modes is one of free modes: at the tip the panel is bent as it was written.
#[test]
fn clamped_starts_become_free_ones() {
    let scenario = reference(&[
        ("appendage[0].modes[0].displacement", "0.02"),
        ("appendage[0].modes[3].displacement", "-0.01"),
        ("appendage[0].modes[0].rate", "0.3"),
        ("appendage[1].modes[1].rate", "0.1"),
    ])
    .expect("valid");
    let craft = craft(&scenario);
    let tip = craft.model.point("tip").expect("a point");
    let hub = craft.model.point("jet").expect("a point");
    let (mut bent, mut moving) = (Vector::zeros(), Vector::zeros());
    for (index, mode) in craft.model.modes.iter().enumerate() {
        let ((end, _), (jet, phi)) = (craft.model.shapes("tip")[index], craft.model.shapes("jet")[index]);
        let against_hub = end - jet - phi.cross(&(tip - hub));
        bent += against_hub * mode.displacement.get();
        moving += against_hub * mode.rate.get();
    }
    let (sin, cos) = 0.4363323129985824_f64.sin_cos();
    let axes = |x: f64, z: f64| vector![cos * x + sin * z, 0.0, cos * z - sin * x];
    near((bent - axes(0.7 * -0.01, 0.7 * 0.02)).norm(), 0.0, 1e-15);
    near((moving - axes(0.0, 0.7 * 0.3)).norm(), 0.0, 1e-14);
}

/// Damping that couples near modes is kept whole.
#[test]
fn damping_that_couples_modes_is_kept_whole() {
    let near_modes =
        [("appendage[1].modes[1].frequency", "4.301"), ("appendage[1].modes[1].damping", "0.05")];
    let scenario = reference(&near_modes).expect("valid");
    let flexible = craft(&scenario).model.flexible().expect("two-way");
    let damping = flexible.damping.as_ref().expect("coupled");
    assert!(craft(&scenario).damping_coupling > 0.05);
    for (index, mode) in flexible.modes.iter().enumerate() {
        near(damping[(index, index)] / (2.0 * mode.damping * mode.frequency), 1.0, 1e-14);
    }
    assert!(damping[(2, 3)].abs() > 0.01 && damping[(2, 3)].to_bits() == damping[(3, 2)].to_bits());
}
