//! Environment torques against theory: libration periods of the specification, integrals of the motion, fields computed
//! in another way.

use std::f64::consts::FRAC_PI_2;

use flexsc_dynamics::flow::{RigidBody, RigidState};
use flexsc_dynamics::three_axis::{
    FlexibleBody, FreeMode, Rotor, SegmentLoads, Surroundings, ThreeAxisMotion,
};
use flexsc_numerics::attitude::{Vector, rotation, rotation_vector};
use flexsc_numerics::time::{Instant, Span};
use nalgebra::{Matrix3, Quaternion};

use super::{Environment, OrbitEnvironment, SurroundingsState};
use crate::body::Spatial;

type Never = std::convert::Infallible;

/// Rate of the orbit (rad/s).
const RATE: f64 = 1.1e-3;

/// Returns the inertia of a long body that flies upright: least inertia along the nadir, most across the orbit.
fn upright() -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector::new(1100.0, 1400.0, 500.0))
}

/// Returns the environment of a body without plates on appendages.
fn surroundings_of(
    environment: &Environment,
    sky: OrbitEnvironment,
    inertias: [Matrix3<f64>; 2],
    centre: &Vector,
) -> SurroundingsState {
    SurroundingsState::new(environment, sky, inertias, centre, &super::PlateMounts::default())
}

fn surroundings_from(text: &str, inertia: &Matrix3<f64>) -> SurroundingsState {
    let environment: Environment = flexsc_formats::document::from_text(text).expect("an environment");
    let sky = OrbitEnvironment::new(&environment, Span::from_seconds(1e5), None);
    surroundings_of(&environment, sky, [*inertia, Matrix3::zeros()], &Vector::zeros())
}

/// Returns the torque on an upright body at a time (s) and an attitude.
fn torque_at(surroundings: &SurroundingsState, t: f64, attitude: &Quaternion<f64>) -> Vector {
    surroundings.torque(&surroundings.sky_at(t), attitude, &upright())
}

/// Rigid body in an environment, whose motion is restarted every 20 s as in a plant.
struct One {
    rigid: RigidBody,
    turn: RigidState,
    surroundings: SurroundingsState,
    t: f64,
}

impl One {
    fn new(
        inertia: &Matrix3<f64>,
        surroundings: SurroundingsState,
        attitude: Quaternion<f64>,
        rate: Vector,
    ) -> Self {
        let rows = (0..3).map(|row| format!("{:?}", inertia.row(row).iter().collect::<Vec<_>>()));
        let text = format!("inertia = [{}]", rows.collect::<Vec<_>>().join(", "));
        let body: Spatial = flexsc_formats::document::from_text(&text).expect("a body");
        let rigid = RigidBody::new(&body.solve().expect("valid"));
        Self { turn: rigid.start(attitude, rate), rigid, surroundings, t: 0.0 }
    }

    fn advance_to(&mut self, until: f64) {
        while self.t < until {
            let h = (until - self.t).min(20.0);
            let surroundings = Some(&self.surroundings as &dyn Surroundings);
            let moved =
                self.rigid.advance(&mut self.turn, &Vector::zeros(), None, surroundings, (self.t, h), || {
                    Ok::<(), Never>(())
                });
            moved.expect("nothing stops it");
            self.t += h;
        }
    }
}

/// Returns the attitude of the local axes of an orbit on which they begin as the inertial ones.
fn local(t: f64) -> Quaternion<f64> {
    rotation(&Vector::new(0.0, -RATE * t, 0.0))
}

/// Returns roll, pitch and yaw of a body relative to the local axes, and its rate relative to theirs.
fn libration(body: &One) -> (Vector, Vector) {
    let attitude = body.turn.attitude;
    let normal = super::orbit::to_body(&attitude, &Vector::new(0.0, -RATE, 0.0));
    (rotation_vector(&local(body.t), &attitude), body.rigid.rate(&body.turn) - normal)
}

/// Returns the instant near `guess` at which the pitch crosses 0.
fn crossing(body: &mut One, guess: f64) -> f64 {
    body.advance_to(guess);
    for _ in 0..6 {
        let (angles, rates) = libration(body);
        let step = -angles.y / rates.y;
        let surroundings = Some(&body.surroundings as &dyn Surroundings);
        let moved = body.rigid.advance(
            &mut body.turn,
            &Vector::zeros(),
            None,
            surroundings,
            (body.t, step.max(0.0)),
            || Ok::<(), Never>(()),
        );
        moved.expect("nothing stops it");
        body.t += step.max(0.0);
    }
    body.t
}

#[test]
fn the_pitch_swings_with_its_period() {
    let inertia = upright();
    let surroundings = surroundings_from("gravity_gradient = { orbit_rate = 1.1e-3 }", &inertia);
    let start = rotation(&Vector::new(0.0, 1e-3, 0.0));
    let mut body = One::new(&inertia, surroundings, start, Vector::new(0.0, -RATE, 0.0));
    let first = crossing(&mut body, 1259.0);
    let second = crossing(&mut body, first + 5037.0);
    // The period is (4/w) K(sin² of 1e-3 rad), w = n sqrt(3 (Jx - Jz)/Jy).
    let exact = 5_037.499_975_779;
    assert!(((second - first) / exact - 1.0).abs() < 1e-10, "{}", second - first);
    assert!((first / (0.25 * exact) - 1.0).abs() < 1e-10, "{first}");
}

/// A black plate behind the centre of mass, across the light, makes the body a pendulum: theta'' = -P A a/J sin cos
/// theta.
#[test]
fn a_sail_behind_the_body_swings_as_a_pendulum() {
    let inertia = Matrix3::from_diagonal_element(100.0);
    let surroundings = surroundings_from(
        "sun = [0, 0, 3]\nsolar_pressure = { pressure = 1e-3, plates = [{ area = 1000, normal = [0, 0, 1], at = [0, 0, -1] }] }",
        &inertia,
    );
    let start = rotation(&Vector::new(0.0, 0.6, 0.0));
    let mut body = One::new(&inertia, surroundings, start, Vector::zeros());
    // A quarter of the period is K(sin² 0.6)/sqrt(P A a/J), with K of SciPy.
    let quarter = 1.725_064_310_933_874_4 / 0.1;
    for (quarters, angle) in [(1.0, 0.0), (2.0, -0.6), (3.0, 0.0), (8.0, 0.6)] {
        body.advance_to(quarters * quarter);
        let off = rotation_vector(&rotation(&Vector::new(0.0, angle, 0.0)), &body.turn.attitude);
        assert!(off.norm() < 1e-9, "{quarters} {:e}", off.norm());
    }
}

#[test]
fn roll_and_yaw_swing_with_the_roots_of_the_quartic() {
    let inertia = upright();
    let surroundings = surroundings_from("gravity_gradient = { orbit_rate = 1.1e-3 }", &inertia);
    let start = rotation(&Vector::new(1e-6, 0.0, -5e-7));
    let normal = super::orbit::to_body(&start, &Vector::new(0.0, -RATE, 0.0));
    let mut body = One::new(&inertia, surroundings, start, normal);
    // Samples of two harmonics obey x[2] + x[-2] - a (x[1] + x[-1]) + b x[0] = 0 with a = 2 (c1 + c2), b = 2 + 4 c1 c2.
    let period = 900.0;
    let samples: Vec<Vector> = (0..40)
        .map(|k| {
            body.advance_to(period * f64::from(k));
            libration(&body).0
        })
        .collect();
    let (mut normal, mut right_hand_side) = (nalgebra::Matrix2::zeros(), nalgebra::Vector2::zeros());
    for row in samples.windows(5).flat_map(|x| [0, 2].map(|axis| [0, 1, 2, 3, 4].map(|k| x[k][axis]))) {
        let [e, d, c, b, a] = row;
        let unknown = nalgebra::Vector2::new(b + d, -c);
        normal += unknown * unknown.transpose();
        right_hand_side += unknown * (a + e);
    }
    let found = normal.try_inverse().expect("two harmonics") * right_hand_side;
    let (sum, product) = (0.5 * found.x, 0.25 * (found.y - 2.0));
    let root = f64::sqrt(sum * sum - 4.0 * product);
    let frequencies = [0.5 * (sum + root), 0.5 * (sum - root)].map(|cos| libm::acos(cos) / period);
    let (k1, k3) = ((1400.0 - 500.0) / 1100.0, (1400.0 - 1100.0) / 500.0);
    let (b, c) = (1.0 + 3.0 * k1 + k1 * k3, 4.0 * k1 * k3);
    let root = f64::sqrt(b * b - 4.0 * c);
    let exact = [0.5 * (b - root), 0.5 * (b + root)].map(|square| RATE * f64::sqrt(square));
    for (found, exact) in frequencies.iter().zip(exact) {
        assert!((found / exact - 1.0).abs() < 1e-10, "{found} {exact}");
    }
}

/// Returns the energy in the axes of the orbit: kinetic and gravitational energy minus the orbit's rate times momentum.
fn integral(
    energy: f64,
    attitude: &Quaternion<f64>,
    momentum: &Vector,
    inertia: &Matrix3<f64>,
    t: f64,
) -> f64 {
    let nadir = Vector::new(-libm::sin(RATE * t), 0.0, libm::cos(RATE * t));
    let nadir = super::orbit::to_body(attitude, &nadir);
    let normal = super::orbit::to_body(attitude, &Vector::new(0.0, -RATE, 0.0));
    let gravity = RATE * RATE * (1.5 * nadir.dot(&(inertia * nadir)) - 0.5 * inertia.trace());
    energy + gravity - normal.dot(momentum)
}

#[test]
fn a_rigid_body_keeps_its_energy_in_the_axes_of_the_orbit() {
    let inertia = Matrix3::new(1100.0, 20.0, -10.0, 20.0, 1400.0, 30.0, -10.0, 30.0, 500.0);
    let surroundings = surroundings_from("gravity_gradient = { orbit_rate = 1.1e-3 }", &inertia);
    let mut body = One::new(
        &inertia,
        surroundings,
        rotation(&Vector::new(0.9, -0.4, 1.3)),
        Vector::new(4e-3, 1e-3, -2e-3),
    );
    let energy_of = |body: &One| {
        let (energy, momentum) = (body.rigid.energy(&body.turn), RigidBody::momentum(&body.turn));
        integral(energy, &body.turn.attitude, &momentum, &inertia, body.t)
    };
    let (before, momentum) = (energy_of(&body), RigidBody::momentum(&body.turn));
    for k in 1..=20 {
        body.advance_to(1000.0 * f64::from(k));
        let scale = body.rigid.energy(&body.turn);
        assert!(
            (energy_of(&body) - before).abs() < 1e-14 * scale,
            "{k} {:e}",
            (energy_of(&body) - before) / scale
        );
    }
    // Check that gravity did turn the body.
    let momentum_change = RigidBody::momentum(&body.turn).norm() / momentum.norm() - 1.0;
    assert!(momentum_change.abs() > 1e-2, "{momentum_change}");
}

/// Returns two modes with first moments and rotations as of panels, and a weakly coupled one that makes steps short.
fn flexible() -> FlexibleBody {
    let mode = |frequency: f64, rotation: [f64; 3], moments: [f64; 6]| {
        let [xx, yy, zz, yz, zx, xy] = moments;
        let moments = Matrix3::new(xx, xy, zx, xy, yy, yz, zx, yz, zz);
        FreeMode { frequency, damping: 0.0, rotation: rotation.into(), moments }
    };
    FlexibleBody {
        inertia: Matrix3::new(1112.5, 6.0, 0.6, 6.0, 311.9, 4.9, 0.6, 4.9, 1089.3),
        modes: vec![
            mode(0.115, [0.02, -1e-3, -0.01], [0.7, 0.5, -0.2, -18.0, 0.1, -8.4]),
            mode(0.43, [1e-3, 0.03, 2e-3], [1.6, 0.0, -1.6, 0.4, 1.4, 2.0]),
            mode(2.0, [1e-6, 0.0, 0.0], [0.0; 6]),
        ],
        damping: None,
    }
}

#[test]
fn a_bent_body_keeps_its_energy_in_the_axes_of_the_orbit() {
    let body = flexible();
    let surroundings = surroundings_from("gravity_gradient = { orbit_rate = 1.1e-3 }", &body.inertia);
    let start = rotation(&Vector::new(0.9, -0.4, 1.3));
    let mut motion =
        ThreeAxisMotion::new(&body, start, Vector::new(4e-3, 1e-3, -2e-3), &[[0.5, 0.0], [0.0, 0.02]]);
    let momentum = 2.0;
    motion.begin_segment(&SegmentLoads {
        rotors: vec![Rotor { axis: Vector::new(0.6, 0.0, 0.8), momentum, torque: 0.0 }],
        ..SegmentLoads::default()
    });
    let energy_of = |motion: &ThreeAxisMotion, t: f64| {
        let view = motion.view();
        let energy = view.rotational_energy + motion.energies().sum::<f64>();
        let energy = integral(energy, &view.attitude, &view.momentum, &motion.inertia(), t);
        (energy, 0.5 * view.rate.dot(&view.momentum))
    };
    let (before, _) = energy_of(&motion, 0.0);
    for k in 1..=10 {
        let t = 200.0 * f64::from(k);
        motion.advance(t, Some((&surroundings, 0.0)), || Ok::<(), Never>(())).expect("nothing stops it");
        let (now, scale) = energy_of(&motion, t);
        assert!((now - before).abs() < 1e-11 * scale.abs(), "{k} {:e} of {scale:e}", now - before);
    }
}

#[test]
fn a_torque_that_is_constant_in_inertial_axes_adds_to_the_momentum_as_time_does() {
    let text = "torque = [2e-3, -1e-3, 3e-3]";
    let torque = Vector::new(2e-3, -1e-3, 3e-3);
    let (inertia, rate) = (upright(), Vector::new(0.01, -0.03, 0.02));
    let start = rotation(&Vector::new(0.3, 1.0, -0.5));
    let mut body = One::new(&inertia, surroundings_from(text, &inertia), start, rate);
    let in_space =
        |attitude: Quaternion<f64>, momentum: Vector| super::orbit::to_body(&attitude.conjugate(), &momentum);
    let before = in_space(start, inertia * rate);
    for t in [100.0, 1000.0, 3000.0] {
        body.advance_to(t);
        let now = in_space(body.turn.attitude, RigidBody::momentum(&body.turn));
        let off = (now - before - torque * t).norm() / now.norm();
        assert!(off < 1e-14, "{t} {off:e}");
    }
    let (body, start) = (flexible(), Quaternion::identity());
    let surroundings = surroundings_from(text, &body.inertia);
    let mut motion = ThreeAxisMotion::new(&body, start, rate, &[[0.5, 0.0], [0.0, 0.02]]);
    let view = motion.view();
    let before = in_space(view.attitude, view.momentum);
    for t in [100.0, 1000.0, 3000.0] {
        motion.advance(t, Some((&surroundings, 0.0)), || Ok::<(), Never>(())).expect("nothing stops it");
        let view = motion.view();
        let now = in_space(view.attitude, view.momentum);
        let off = (now - before - torque * t).norm() / now.norm();
        assert!(off < 1e-14, "{t} {off:e}");
    }
}

#[test]
fn the_field_is_that_of_a_dipole_along_the_axis() {
    let (inclination, node, strength) = (0.9_f64, 0.7_f64, 2.4e-5);
    let text = format!(
        "dipole = {{ moment = [1.0, -2.0, 0.5], strength = {strength}, inclination = {inclination}, from_node = {node}, \
         orbit_rate = {RATE} }}"
    );
    let environment: Environment = flexsc_formats::document::from_text(&text).expect("an environment");
    let dipole = environment.dipole.expect("a dipole");
    // Axes of the equator: x to the ascending node, z north; the local axes at the start, expressed in them.
    let (sin_i, cos_i) = libm::sincos(inclination);
    let up = |u: f64| {
        let (sin, cos) = libm::sincos(u);
        Vector::new(cos, sin * cos_i, sin * sin_i)
    };
    let (nadir, along) = (-up(node), up(node + FRAC_PI_2));
    let axes = Matrix3::from_columns(&[along, nadir.cross(&along), nadir]);
    for t in [0.0, 800.0, 5000.0] {
        let from = up(node + RATE * t);
        let south = -Vector::z();
        let field = (from * (3.0 * south.dot(&from)) - south) * strength;
        let field_at = dipole.own_field().expect("a field").at(t);
        let found = axes * field_at;
        assert!((found - field).norm() < 1e-14 * strength, "{t} {found} {field}");
        let attitude = rotation(&Vector::new(0.2, 0.4, -1.0));
        let body = super::orbit::to_body(&attitude, &field_at);
        let torque = torque_at(&surroundings_from(&text, &upright()), t, &attitude);
        assert!((torque - Vector::new(1.0, -2.0, 0.5).cross(&body)).norm() < 1e-19);
        assert!(torque.norm() <= dipole.bound(0.0));
    }
}

#[test]
fn sunlight_pushes_at_the_centre_of_pressure_unless_in_shadow() {
    let text = "solar_pressure = { force = [1e-4, 0.0, 0.0], at = [0.1, 0.5, 0.0], shadow = [[10.0, 20.0]] }";
    let environment: Environment = flexsc_formats::document::from_text(text).expect("an environment");
    let centre = Vector::new(0.1, 0.3, 0.0);
    let sky = OrbitEnvironment::new(&environment, Span::from_seconds(100.0), None);
    let surroundings = surroundings_of(&environment, sky, [upright(), Matrix3::zeros()], &centre);
    let torque = |t: f64| torque_at(&surroundings, t, &Quaternion::identity());
    let pushed = Vector::new(0.0, 0.0, -0.2e-4);
    assert!((torque(0.0) - pushed).norm() < 1e-19 && (torque(20.0) - pushed).norm() < 1e-19);
    assert!(torque(10.0) == Vector::zeros() && torque(19.9) == Vector::zeros());
    // On a body turned by a quarter about z the force acts along its -y axis, where it has no arm.
    let quarter = rotation(&Vector::new(0.0, 0.0, FRAC_PI_2));
    assert!(torque_at(&surroundings, 0.0, &quarter).norm() < 1e-19);
    assert!(surroundings.change_times().map(Instant::seconds).eq([10.0, 20.0]));
}

/// Nanoseconds from 1970 to 2027-01-03T12:00:00Z, when the Earth is near its perihelion.
const PERIHELION: u64 = 1_798_977_600_000_000_000;

#[test]
fn sunlight_presses_by_the_square_of_the_distance_of_the_sun() {
    let text =
        "sun = \"epoch\"\nsolar_pressure = { plates = [{ area = 2, normal = [1, 0, 0], at = [0, 0.5, 0] }] }";
    let environment: Environment = flexsc_formats::document::from_text(text).expect("an environment");
    let duration = Span::from_seconds(2e7);
    let sky = OrbitEnvironment::new(&environment, duration, Some(PERIHELION));
    let state = surroundings_of(&environment, sky.clone(), [upright(), Matrix3::zeros()], &Vector::zeros());
    // Half a year apart, at distances of 0.98333 and 1.01667 au, the plate faces the Sun.
    for (t, distance) in [(0.0, 0.983_334), (1.577e7, 1.016_6)] {
        let sun = sky.sun().expect("a Sun").direction(t);
        let attitude = flexsc_numerics::attitude::from_axes(&[
            sun,
            Vector::z().cross(&sun).normalize(),
            sun.cross(&Vector::z().cross(&sun).normalize()),
        ]);
        let torque = torque_at(&state, t, &attitude);
        let exact = 2.0 * 0.5 * 1361.0 / 299_792_458.0 / (distance * distance);
        assert!((torque.z / exact - 1.0).abs() < 3e-4 && torque.norm() <= state.bound(), "{t} {torque}");
    }
}

/// Along an orbit a field of degree n, and its rate, are within the bounds that the steps of the motion rely on.
#[test]
fn a_field_model_varies_as_its_degree_allows() {
    for degree in [1, 4, 13] {
        let text = format!(
            "orbit = {{ semi_major_axis = 6.778e6, inclination = 1.5 }}\nmagnetic_field = {{ degree = {degree} }}"
        );
        let environment: Environment = flexsc_formats::document::from_text(&text).expect("an environment");
        let sky = OrbitEnvironment::new(&environment, Span::from_seconds(1e4), Some(PERIHELION));
        let orbit_rate = sky.orbit().expect("an orbit").fastest();
        let mut state =
            surroundings_of(&environment, sky.clone(), [upright(), Matrix3::zeros()], &Vector::zeros());
        state.set_magnetic_moment(Vector::new(3.0, -4.0, 12.0));
        let (bound, frequency) = (sky.field_bound(), state.frequency());
        assert!((frequency / (f64::from(degree + 1) * (orbit_rate + 7.292_115e-5)) - 1.0).abs() < 1e-14);
        assert!((state.bound() / (13.0 * bound) - 1.0).abs() < 1e-14);
        for t in (0..3000).map(|k| 2.0 * f64::from(k)) {
            let [before, now, after] = [t - 1.0, t, t + 1.0].map(|t| sky.field_at(t).expect("a field"));
            assert!(now.norm() <= bound, "{degree} {t}");
            assert!((after - before).norm() / 2.0 <= frequency * bound, "{degree} {t}");
            assert!((after - now * 2.0 + before).norm() <= frequency * frequency * bound, "{degree} {t}");
            let torque = torque_at(&state, t, &Quaternion::identity());
            assert!((torque - Vector::new(3.0, -4.0, 12.0).cross(&now)).norm() < 1e-18);
        }
    }
}
