//! Tests of reaction wheels: stored momentum, limits, and cancelling torques.

use super::*;
use crate::actuator::MomentumStorage;
use crate::part::Part;

const PERIOD: f64 = 0.25;

fn start(keys: &str) -> WheelsState {
    let text = format!(
        "arrangement = \"pyramid\"\ncant = 0.610_865_238_198_015_3\ninertia = 0.04\n{keys}\n\
         speeds = [200.0, -200.0, 200.0, -200.0]"
    );
    let wheels: Wheels = flexsc_formats::document::from_text(&text).unwrap();
    let setting = |axis| AxisActuatorContext {
        axis,
        inertia: 1000.0,
        planned_inertia: 1000.0,
        rate: 0.0,
        cycle: Some(Span::from_seconds(PERIOD)),
        waveform: None,
        share: 1.0,
    };
    WheelsState::new(&wheels, &wheels.allocation().unwrap(), &[0, 1, 2].map(setting))
}

fn at(seconds: f64) -> Instant {
    Instant::START + Span::from_seconds(seconds)
}

fn demand(wheels: &mut WheelsState, now: Instant, torque: [f64; 3]) {
    wheels.command(now, &torque.map(Demand::Torque), [0.0; 3]);
}

fn applied(wheels: &WheelsState) -> [f64; 3] {
    [0, 1, 2].map(|axis| wheels.effort(axis).held)
}

#[test]
fn wheels_take_the_momentum_that_the_body_gets() {
    let mut wheels = start("torque = 0.4");
    let before = Vector::from(wheels.stored_momentum(at(0.0)));
    assert!(before.norm() < 1e-14, "two turn one way and two the other: {before}");
    let torque = [0.1, -0.05, 0.2];
    demand(&mut wheels, at(0.0), torque);
    for (found, exact) in applied(&wheels).into_iter().zip(torque) {
        assert!((found - exact).abs() < 1e-15);
    }
    let after = Vector::from(wheels.stored_momentum(at(2.0)));
    assert!((after + Vector::from(torque) * 2.0).norm() < 1e-14, "{after}");
    let speed = wheels.wheels(at(2.0), [0.0; 3])[0].speed_rad_s;
    assert!((speed - (200.0 - 2.0 * 0.108_752_79 / 0.04)).abs() < 1e-5, "{speed}");
    // If the body rotates, a wheel of the same momentum is slower.
    let wheel_speed = wheels.wheels(at(2.0), [0.0, 0.0, 1.0])[0].speed_rad_s;
    assert!((speed - wheel_speed - 0.573_576_436_351_046).abs() < 1e-12);
}

#[test]
fn a_torque_that_is_too_large_keeps_its_axis() {
    let mut wheels = start("torque = 0.4");
    demand(&mut wheels, at(0.0), [1.0, -0.5, 2.0]);
    // Ten times the torque that requires 0.1519 N m of a wheel.
    let part = 0.4 / 1.519_136_9;
    for (found, exact) in applied(&wheels).into_iter().zip([1.0, -0.5, 2.0]) {
        assert!((found - part * exact).abs() < 1e-7, "{found}");
    }
}

#[test]
fn a_wheel_stops_at_its_limit_exactly() {
    // From 8 N m s at the start to 9 takes 2.5 s at |u| = 0.4 N m.
    let mut wheels = start("torque = 0.4\nmomentum = 9.0");
    demand(&mut wheels, at(0.0), [0.0, 0.0, -5.0]);
    assert_eq!(wheels.due(), Some(at(2.5)));
    wheels.update(at(2.5), ActuatorEvent::Due([0.0; 3]));
    let motion = wheels.wheels(at(9.0), [0.0; 3]);
    assert!((motion[0].momentum_nm_s - 9.0).abs() < 1e-14 && (motion[1].momentum_nm_s + 4.4).abs() < 1e-13);
    // The two wheels away from the limit continue; all do away from the limit.
    demand(&mut wheels, at(9.0), [0.0, 0.0, -5.0]);
    assert_eq!(wheels.wheels.iter().filter(|wheel| wheel.torque == 0.0).count(), 2);
    demand(&mut wheels, at(9.0), [0.0, 0.0, 5.0]);
    assert!(wheels.wheels.iter().all(|wheel| wheel.torque == -0.4));
    let mut wheels = start("torque = 0.4\nspeed_limit = 250.0");
    demand(&mut wheels, at(0.0), [0.0, 0.0, -5.0]);
    assert_eq!(wheels.due(), Some(at(5.0)), "50 rad/s at 10 rad/s²");
}

#[test]
fn a_speed_bias_gives_the_body_nothing() {
    let mut wheels = start("torque = 0.4\nspeed_bias = { speed = 100.0, gain = 0.02 }");
    let torque = [0.1, -0.05, 0.2];
    for k in 0..1600 {
        demand(&mut wheels, at(PERIOD * f64::from(k)), if k < 8 { torque } else { [0.0; 3] });
        let demand = if k < 8 { torque } else { [0.0; 3] };
        for (found, exact) in applied(&wheels).into_iter().zip(demand) {
            assert!((found - exact).abs() < 1e-14);
        }
        assert!(wheels.wheels.iter().all(|wheel| wheel.torque.abs() <= 0.4 + 1e-15));
    }
    let speeds: Vec<f64> = wheels.wheels(at(400.0), [0.0; 3]).iter().map(|wheel| wheel.speed_rad_s).collect();
    let bias = (speeds[0] - speeds[1] + speeds[2] - speeds[3]) / 4.0;
    // (1 - gain T)^1600 of the initial 100 rad/s of excess remain.
    assert!((bias - 100.0 - 100.0 * libm::pow(0.995, 1600.0)).abs() < 0.1, "{bias}");
}

#[test]
fn what_cannot_be_built_is_refused_with_its_key() {
    let fault = |text: &str| {
        let wheels: Wheels = flexsc_formats::document::from_text(&format!("inertia = 0.04\n{text}")).unwrap();
        wheels.allocation().unwrap_err().to_string()
    };
    assert!(fault("").starts_with("`axes` must be given without an `arrangement`"));
    assert!(fault("axes = [[1, 0, 0], [0, 1, 0]]").contains("must span all three axes"));
    assert!(fault("axes = [[1, 0, 0], [0, 1, 0], [0, 0, 0]]").starts_with("`axes[2]` must not be zero"));
    assert!(fault("arrangement = \"pyramid\"\nspeeds = [1.0]").contains("one for each of 4 wheels"));
    let bias = "speed_bias = { speed = 1.0, gain = 1.0 }";
    assert!(fault(&format!("arrangement = \"orthogonal\"\n{bias}")).starts_with("`speed_bias` needs four"));
    let fast = "arrangement = \"orthogonal\"\nmomentum = 1.0\nspeeds = [0.0, 30.0, 0.0]";
    assert!(fault(fast).starts_with("`speeds[1]` must be within"));
}
