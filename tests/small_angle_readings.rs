//! Small rotations about three axes: what gyros, wheels, filters and rows of energy read of them, and a crossing that a push
//! prevents.

use flexsc_core::control::quantity::total_width;
use flexsc_core::numerics::attitude::{Vector, rotation_vector};
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::{Scenario, Simulation, StopAt};
use nalgebra::Quaternion;

use crate::study::pairs;
use crate::traces::{column, nested, times, traced};

fn scenario(text: &str) -> Scenario {
    Scenario::parse("small.toml", text).unwrap_or_else(|error| panic!("{error}"))
}

/// A gyro reads the rate of its point, the modes included, as the closed form of a free mode has it.
#[test]
fn a_gyro_reads_the_modes_at_its_point() {
    let (rate, shape, frequency, displacement) = (1e-4, 0.03, 1.7, 2e-4);
    let trace = traced(&scenario(&format!(
        "duration = 10.0\nlaw.open = {{}}\nsensor.gyro = {{ period = 0.1 }}\nlog.period = 0.1\n[body.spatial]
inertia = [[100, 0, 0], [0, 80, 0], [0, 0, 60]]\nrate = [{rate}, 0, 0]\nsmall_angles = {{}}\npoints = [{{ name = \"hub\" }}]
modes = [{{ frequency = {frequency}, displacement = {displacement}, shapes.hub = {{ rotation = [{shape}, 0, 0] }} }}]"
    )));
    let measured = nested(&trace, "/rates", ["axes", "measured_rad_s"], (0, 3));
    assert_eq!(measured.len(), 101);
    for (time, found) in pairs(times(&trace, "/rates"), measured) {
        let expected = rate - shape * displacement * frequency * f64::sin(frequency * time);
        assert!((found - expected).abs() < 1e-18, "{time}: {found} {expected}");
    }
}

/// Wheels take the momentum that the body loses, and the rows of energy have the momentum of both and the energy of the body.
#[test]
fn wheels_take_the_momentum_of_the_body() {
    let scenario = scenario(
        "duration = 60.0\nlaw.pd = { k_p = 2.0, k_d = 20.0, period = 0.5 }\nsensor.sampled = { period = 0.5 }\nlog.period = 0.5
[actuator.wheels]\narrangement = \"pyramid\"\ninertia = 0.01\n[body.spatial]\nrate = [1e-4, 2e-4, -1e-4]
inertia = [[100.0, 6.0, -9.0], [6.0, 80.0, 4.0], [-9.0, 4.0, 60.0]]\nsmall_angles = {}",
    );
    let inertia = scenario.model.three_axis().expect("three axes").inertia;
    let trace = traced(&scenario);
    // At the start the wheels turn with the body, which adds 0.02 % to its momentum.
    let start = column(&trace, "/energy", "momentum_nm_s")[0];
    let ratio = start / (inertia * Vector::new(1e-4, 2e-4, -1e-4)).norm();
    assert!(ratio > 1.0 && ratio < 1.0003, "{ratio}");
    let rates = [0, 1, 2].map(|axis| nested(&trace, "/rates", ["axes", "rigid_rad_s"], (axis, 3)));
    let energies =
        pairs(column(&trace, "/energy", "momentum_nm_s"), column(&trace, "/energy", "rotational_j"));
    let mut slowest = f64::INFINITY;
    for (row, (momentum, energy)) in energies.enumerate() {
        let rate = Vector::from_fn(|axis, _| rates[axis][row]);
        slowest = slowest.min(rate.norm());
        assert!((momentum / start - 1.0).abs() < 1e-13, "{momentum} {start}");
        assert!((energy - 0.5 * rate.dot(&(inertia * rate))).abs() < 1e-20, "{energy}");
    }
    // The wheels stop the body.
    assert_eq!(rates[0].len(), 121);
    assert!(slowest < 5e-6, "{slowest}");
}

/// A filter begins at the attitude of the body, which is not that of the target.
#[test]
fn a_filter_begins_at_the_attitude_of_the_body() {
    let trace = traced(&scenario(
        "duration = 1.0\nlaw.open = {}\nlog.period = 0.5\n[[sensor]]\ngyro = { period = 0.5, angle_random_walk = 1e-9 }\n[[sensor]]
star_tracker = { period = 0.5, noise = [0.1, 0.1, 0.1] }\n[estimator.attitude]\ninitial = { angle = 1e-6, bias = 1e-9 }\nwatch_only = true
[body.spatial]\ninertia = [[100, 0, 0], [0, 80, 0], [0, 0, 60]]\nsmall_angles = { angle = 0.1 }
attitude = [0.9999875000260416, 0.004999979166692708, 0, 0]",
    ));
    let first = nested(&trace, "/attitude_filter", ["axes", "angle_error_rad"], (0, 3))[0];
    assert!(first.abs() < 1e-4, "{first}");
}

/// A push from outside that ends before a relay's threshold is crossed: at the instant of that crossing, the body is where the
/// push has left it.
#[test]
fn a_crossing_that_is_prevented_leaves_no_trace() {
    let relay = "relay = { dead_zone = 5e-4, hysteresis = 1e-4, strong = 8e-3, weak = 1e-12, k_t = 0.33 }";
    let scenario = scenario(&format!(
        "duration = 20.0\n[law.per_axis]\nroll = {{ {relay} }}\npitch = {{ {relay} }}\nyaw = {{ {relay} }}\n[body.spatial]
inertia = [[100, 0, 0], [0, 80, 0], [0, 0, 60]]\nrate = [1e-4, 0, 0]\nsmall_angles = {{}}"
    ));
    let pushed = |pushes: &[(f64, f64)]| {
        let mut run = Simulation::new(&scenario, 0);
        for (from, torque) in pushes {
            run.run_up_to(Instant::START + Span::from_seconds(*from), &mut ()).expect("a run");
            run.set_external_torque([*torque, 0.0, 0.0]);
        }
        run
    };
    let mut run = pushed(&[(2.0, -5e-3)]);
    assert!(run.run_to_next(StopAt::Switching, Instant::END, &mut ()).expect("a run"));
    let crossed = run.time();
    // 2e-4 rad and 1e-4 rad/s at 2 s, and -5e-5 rad/s² from then on.
    assert!((crossed.seconds() - 4.0 - f64::sqrt(32.0)).abs() < 1e-6, "{}", crossed.seconds());
    let mut run = pushed(&[(2.0, -5e-3), (3.9, 0.0)]);
    run.run_until(crossed, &mut ()).expect("a run");
    let width = total_width(&run.observation_fields(&scenario));
    let mut row = vec![0.0; width];
    run.observe(&mut row).expect("finite");
    let roll = rotation_vector(&Quaternion::identity(), &Quaternion::new(row[0], row[1], row[2], row[3])).x;
    let expected = 3.9e-4 - 0.5 * 5e-5 * 1.9 * 1.9 + 5e-6 * (crossed.seconds() - 3.9);
    assert!((roll - expected).abs() < 1e-12, "{roll} {expected}");
}
