//! Motion of a three-axis body with and without coupling of the modes, through the same plant.

use flexsc_control::sensor::{Orientation, Truth};
use flexsc_dynamics::ModeState;
use flexsc_dynamics::three_axis::Rotor;
use flexsc_dynamics::three_axis_model::{ModalCoupling, ThreeAxisModel};
use flexsc_dynamics::wrench::Wrench;
use flexsc_numerics::attitude::{Vector, rotation};
use flexsc_numerics::gauss_legendre::{NODES, WEIGHTS};
use flexsc_numerics::time::{Instant, Span};
use flexsc_spacecraft::body::Spatial;
use nalgebra::{DMatrix, DVector, Matrix3, Quaternion};

use crate::plant::{Plant, ThreeAxisQuantities};
use flexsc_scenario::ResolvedScenario;

/// Returns a body with two modes, which rotate the hub only if `coupled`, and a bench by a little more.
fn body(disturbed: bool, coupled: bool) -> ThreeAxisModel {
    let torque = "disturbance = { constant = [1e-3, 0, 0], amplitude = [0.02, -0.01, 0.03], period = 7.0 }";
    let hub = if coupled { ["[0.02, 1e-3, -0.01]", "[1e-3, 0.03, 2e-3]"] } else { ["[0, 0, 0]"; 2] };
    let text = format!(
        "inertia = [[1100.0, 6.0, 0.5], [6.0, 310.0, 5.0], [0.5, 5.0, 1090.0]]
        rate = [0.02, 0.03, -0.01]
        points = [{{ name = 'hub' }}, {{ name = 'bench' }}]
        {}
        [[modes]]
        frequency = 1.15
        damping = 0.005
        displacement = 0.01
        shapes.hub.rotation = {}
        shapes.bench.rotation = [0.02, 1.5e-3, -0.01]
        [[modes]]
        frequency = 4.3
        rate = 0.05
        shapes.hub.rotation = {}
        shapes.bench.rotation = [1e-3, 0.03, 1e-3]",
        if disturbed { torque } else { "" },
        hub[0],
        hub[1]
    );
    let body: Spatial = flexsc_formats::document::from_text(&text).expect("a body");
    body.solve().expect("valid")
}

/// Returns the body with modes that act back on its rotation.
fn two_way(body: &ThreeAxisModel) -> ThreeAxisModel {
    let rotations: Vec<Vector> = body.shapes("hub").into_iter().map(|(_, rotation)| rotation).collect();
    let moments =
        |rotation: &Vector| Matrix3::from_diagonal_element(if rotation.norm() > 0.0 { 0.5 } else { 0.0 });
    let moments = rotations.iter().map(moments).collect();
    let own = body.modes.iter().map(|mode| 2.0 * mode.damping.get() * mode.frequency.get());
    let damping = DMatrix::from_diagonal(&DVector::from_iterator(body.modes.len(), own));
    let coupling = ModalCoupling { rotations, moments, damping, couples_by_damping: false };
    ThreeAxisModel { coupling: Some(coupling), ..body.clone() }
}

fn study(sensed_at: &str) -> ResolvedScenario {
    ResolvedScenario {
        assessment_period: Span::from_seconds(0.25),
        sensor_points: vec![sensed_at.to_owned()],
        torque_point: "hub".to_owned(),
        ..ResolvedScenario::default()
    }
}

fn at(seconds: f64) -> Instant {
    Instant::START + Span::from_seconds(seconds)
}

fn seen(plant: &mut Plant, seconds: f64) -> Truth {
    plant.advance(at(seconds), &mut ()).expect("nothing stops it");
    *plant.evaluate(at(seconds)).expect("finite")
}

fn three_axes(plant: &Plant) -> &dyn ThreeAxisQuantities {
    plant.quantities().three_axis().expect("three axes")
}

fn apart(a: &Truth, b: &Truth) -> f64 {
    a.orientation.error_from(&b.orientation).into_iter().fold(0.0, |most, part| part.abs().max(most))
}

fn wheel(momentum: f64, torque: f64) -> Vec<Rotor> {
    vec![Rotor { axis: Vector::new(0.6, 0.0, 0.8), momentum, torque }]
}

/// Checks that both motions agree if modes do not rotate the hub: under the environment, torques, and rotors.
#[test]
fn without_coupling_both_are_one() {
    let body = body(true, false);
    let mut one_way = Plant::with_three_axes(&body, &study("bench"));
    let mut two_way = Plant::with_three_axes(&two_way(&body), &study("bench"));
    let mut momentum = 20.0;
    for leg in 0..4 {
        let began = 25.0 * f64::from(leg);
        let torque = 0.1 - 0.05 * f64::from(leg);
        let wrench = Wrench {
            hub: [0.0, 0.2 * f64::from(leg), -0.1],
            rotors: wheel(momentum, torque),
            ..Wrench::default()
        };
        momentum += 25.0 * torque;
        one_way.begin_segment(&wrench);
        two_way.begin_segment(&wrench);
        for t in [3.0, 25.0] {
            let (a, b) = (seen(&mut one_way, began + t), seen(&mut two_way, began + t));
            let off = |x: [f64; 3], y: [f64; 3]| (Vector::from(x) - Vector::from(y)).norm();
            let attitudes = off(
                a.orientation.rotated_by(a.elastic).error_from(&b.orientation.rotated_by(b.elastic)),
                [0.0; 3],
            );
            let found = [
                attitudes,
                off(a.rigid_rate, b.rigid_rate),
                off(a.rate, b.rate),
                off(a.rate_integral, b.rate_integral),
            ];
            assert!(found.into_iter().all(|off| off < 1e-12), "{found:?}");
            let (a, b) = (three_axes(&one_way).energy(), three_axes(&two_way).energy());
            assert!((a.rotational_j - b.rotational_j).abs() < 1e-11, "{a:?} {b:?}");
            assert!((a.momentum_nm_s - b.momentum_nm_s).abs() < 1e-10, "{a:?} {b:?}");
        }
    }
}

/// Checks that a torque on the hub equals jets with its torque and its modal forces.
#[test]
fn torques_on_modes_and_on_the_hub_are_separate() {
    let body = body(false, true);
    let body = two_way(&body);
    let torque = Vector::new(3.0, -2.0, 1.0);
    let forces = body.shapes("hub").iter().map(|(_, rotation)| rotation.dot(&torque)).collect();
    let wrenches =
        [Wrench { hub: torque.into(), ..Wrench::default() }, Wrench { torque, forces, ..Wrench::default() }];
    let [first, second] = wrenches.map(|wrench| {
        let mut plant = Plant::with_three_axes(&body, &study("bench"));
        plant.begin_segment(&wrench);
        let truth = seen(&mut plant, 10.0);
        (three_axes(&plant).body().state.clone(), truth)
    });
    assert!(apart(&first.1, &second.1) < 1e-14);
    for (ModeState { displacement: a, .. }, ModeState { displacement: b, .. }) in
        first.0.modes.iter().zip(&second.0.modes)
    {
        assert!((a - b).abs() < 1e-14 && a.abs() > 1e-4);
    }
}

/// Checks that a gyro's angle is the integral of its rate, on both motions.
#[test]
fn the_angle_of_a_gyro_is_the_integral_of_its_rate() {
    let body = body(true, true);
    for body in [two_way(&body), body] {
        let mut plant = Plant::with_three_axes(&body, &study("bench"));
        plant.begin_segment(&Wrench { hub: [0.5, 0.0, -1.0], rotors: wheel(3.0, 0.1), ..Wrench::default() });
        let h = 1.0 / 16.0;
        let mut integral = Vector::zeros();
        let before = seen(&mut plant, 0.0).rate_integral;
        // Covers the instant at which a one-way motion begins another segment.
        for step in 0..400 {
            for (node, weight) in NODES.into_iter().zip(WEIGHTS) {
                integral += Vector::from(seen(&mut plant, h * (f64::from(step) + node)).rate) * (weight * h);
            }
        }
        let turned = Vector::from(seen(&mut plant, 25.0).rate_integral) - Vector::from(before);
        assert!((turned - integral).norm() < 1e-9, "{turned} {integral}");
        assert!(turned.norm() > 0.1);
    }
}

/// Checks that the bench rotates against the hub by its own part of each mode, and that evaluations change nothing.
#[test]
fn a_bench_is_seen_beside_the_hub() {
    let body = body(true, true);
    let body = two_way(&body);
    let run = |looks: &[f64], point: &str| {
        let mut plant = Plant::with_three_axes(&body, &study(point));
        plant.begin_segment(&Wrench { hub: [0.5, 0.0, -1.0], ..Wrench::default() });
        for t in looks {
            seen(&mut plant, *t);
        }
        let truth = seen(&mut plant, 30.0);
        (plant, truth)
    };
    let ((plant, hub), (bench_plant, bench)) = (run(&[], "hub"), run(&[0.1, 20.0, 29.999_999], "bench"));
    assert_eq!(hub.orientation, bench.orientation);
    let state = &three_axes(&plant).body().state;
    assert_eq!(*state, three_axes(&bench_plant).body().state);
    assert!(Vector::from(hub.elastic).norm() < 1e-18);
    let displacements: Vec<f64> = state.modes.iter().map(|phase| phase.displacement).collect();
    let beyond =
        Vector::new(0.0, 5e-4, 0.0) * displacements[0] - Vector::new(0.0, 0.0, 1e-3) * displacements[1];
    assert!((Vector::from(bench.elastic) - beyond).norm() < 1e-17);
    // The mean axes and the modal rotations give the attitude of the hub.
    let Orientation::Attitude(attitude) = hub.orientation else { panic!("three axes") };
    let angles =
        body.shapes("hub").iter().zip(&displacements).fold(Vector::zeros(), |sum, ((_, r), q)| sum + r * *q);
    let made: Quaternion<f64> = state.turn.attitude * rotation(&angles);
    assert!((made - attitude).norm() < 1e-15);
}
