//! Custom parts outside the engine's crate: a kind of each role, in a file each, and a loop that they close together.

mod actuator;
mod adaptation;
mod estimator;
mod law;
mod sensor;

use std::sync::Arc;

use flexsc_core::campaign::Campaign;
use flexsc_core::control::actuator::{ActuatorKind, ActuatorSpec};
use flexsc_core::control::adaptation::AdaptationKind;
use flexsc_core::control::custom::Custom;
use flexsc_core::control::estimator::EstimatorKind;
use flexsc_core::control::law::LawKind;
use flexsc_core::control::one_or_many::OneOrMany;
use flexsc_core::control::sensor::SensorKind;
use flexsc_core::record::{Column, Detail, Trace};
use flexsc_core::scenario::CustomParts;
use flexsc_core::{Document, Scenario, Simulation, SimulationError};

const ONE_ANGLE: &str = "duration = 200.0\nseed = 5\n[law.open]\n[body.planar]\ninertia = 100.0\nangle = 2e-3\n\
                         modes = [{ frequency = 1.3, gain = 0.2, damping = 0.02 }]\n\
                         [[disturbance]]\ntorque = 1e-3\n[log]\nperiod = 1.0\n[reference]\nband = 2e-5\n\
                         [uncertain]\n\"body.planar.rate\" = { uniform = [0.0, 1e-5] }";

const THREE_AXES: &str = "duration = 200.0\nseed = 5\n[law.open]\n[body.spatial]\ninertia = [[100, 0, 0], [0, 80, 0], [0, 0, 60]]\n\
                          rate = [1e-5, -1e-5, 2e-5]\npoints = [{ name = \"hub\" }]\n\
                          modes = [{ frequency = 1.3, damping = 0.02, shapes.hub = { rotation = [0.02, 0.01, 0.03] } }]\n\
                          [log]\nperiod = 1.0";

/// Creates a custom servo (N m).
pub fn servo(most: f64, step: f64) -> Arc<dyn ActuatorSpec> {
    Arc::new(actuator::Servo { most, step })
}

/// Returns a scenario whose control system is all custom.
fn of_own_parts(text: &str) -> Scenario {
    let scenario = Scenario::parse("own.toml", text).expect("a scenario");
    let whole = scenario.with(|scenario| {
        scenario.law =
            LawKind::Own(Custom::new(Arc::new(law::Pid { k_p: 4.0, k_i: 0.15, k_d: 30.0, period: 0.25 })));
        scenario.sensor = OneOrMany::one(SensorKind::Own(Custom::new(Arc::new(sensor::Encoder {
            step: 1e-6,
            period: 0.25,
        }))));
        scenario.estimator =
            Some(EstimatorKind::Own(Custom::new(Arc::new(estimator::AlphaBeta { alpha: 0.4, beta: 0.1 }))));
        scenario.actuator = OneOrMany::one(ActuatorKind::Own(Custom::new(servo(0.05, 1e-5))).into());
    });
    whole.expect("parts that fit each other")
}

#[test]
fn parts_from_outside_close_the_loop() {
    let study = of_own_parts(ONE_ANGLE);
    let mut trace = Trace::new(Detail::Full);
    Simulation::new(&study, 0).run(&mut trace).expect("a run");
    let Some(Column::Numbers(angle)) =
        trace.topic("/attitude").and_then(|rows| rows.get("rigid_rad").cloned())
    else {
        panic!("angles")
    };
    // The integral part takes the steady torque up: a law without it would stay torque/k_p = 2.5e-4 rad off.
    let end = angle.last().expect("a motion").abs();
    assert!(end < 2e-5, "{end}");
    // A campaign runs them too, with what it draws.
    let campaign = Campaign::new(study, "own", None).expect("a campaign");
    let ends = |number| {
        let run = campaign.run(number).expect("a run");
        Campaign::simulate(&run, ()).expect("metrics");
        run.drawn
    };
    assert_ne!(ends(0), ends(1));
}

#[test]
fn parts_from_outside_hold_three_axes() {
    let study = of_own_parts(THREE_AXES);
    let mut simulation = Simulation::new(&study, 0);
    simulation.run(&mut ()).expect("a run");
    let state = simulation.spatial_state().expect("three axes");
    let off = state.turn.attitude.vector().norm();
    assert!(off < 1e-5, "{off}");
}

const RELAY: &str = "duration = 3000.0\n[law.relay]\ndead_zone = 5e-4\nhysteresis = 1e-4\nstrong = 4e-5\nweak = 1e-6\n\
                     k_t = 0.31\n[body.planar]\nangle = 4.5e-4\nmodes = [{ frequency = 0.44, gain = 0.02 }]\n\
                     [estimator.envelope]\nwindow = 500.0";

#[test]
fn an_adaptation_from_outside_tunes_and_what_cannot_go_on_ends_the_run() {
    let plain = Scenario::parse("relay.toml", RELAY).expect("a scenario");
    let climbing = |most| {
        let own: Custom<dyn flexsc_core::control::adaptation::AdaptationSpec> =
            Custom::new(Arc::new(adaptation::Climber { step: 0.01, most }));
        plain
            .with_custom_parts(CustomParts { adaptation: Some(own), ..CustomParts::default() })
            .expect("it fits")
    };
    let study = climbing(1.0);
    assert!(matches!(study.adaptation, Some(AdaptationKind::Own(_))) && study.has_custom_parts());
    let mut simulation = Simulation::new(&study, 0);
    let mut trace = Trace::new(Detail::Events);
    simulation.run(&mut trace).expect("a run");
    let Some(Column::Numbers(gains)) = trace.topic("/adaptation").and_then(|rows| rows.get("gain").cloned())
    else {
        panic!("gains")
    };
    assert_eq!(gains.len(), 6);
    assert!((gains[5] - 0.37).abs() < 1e-12, "{gains:?}");
    let ends = Simulation::new(&climbing(0.325), 0).run(&mut ()).expect_err("too far");
    let SimulationError::Own { at, role, ref source } = ends else { panic!("{ends}") };
    assert!(at.seconds() == 1000.0 && role == "adaptation", "{ends}");
    assert!(source.downcast::<std::io::Error>().is_some());
    assert_eq!(ends.to_string(), "the adaptation at t = 1000.000000000000000 s: too far");
}

#[test]
fn own_parts_stay_where_keys_change_and_stand_beside_a_text() {
    let study = of_own_parts(ONE_ANGLE);
    let parts = study.custom_parts();
    assert_eq!(parts.each(), ["law", "sensor", "estimator", "actuator"]);
    let mut document = Document::from_table("own.toml", study.table_without_custom_parts());
    document.set_text("duration", "100.0").expect("a key");
    let shorter = Scenario::from_document_reusing(&document, &study).expect("a scenario");
    assert_eq!(shorter.custom_parts(), parts);
    assert_eq!(Scenario::from_document_with(&document, &parts).expect("a scenario"), shorter);
    document.set_text("law", "{ pd = { k_p = 4.0, k_d = 30.0, period = 0.25 } }").expect("a law");
    let built_in = Scenario::from_document_reusing(&document, &study).expect("a scenario");
    assert!(built_in.custom_parts().law.is_none() && built_in.custom_parts().estimator.is_some());
    // An index without a sensor.
    let elsewhere = parts.sensors.iter().map(|(_, sensor)| (3, sensor.clone())).collect();
    let fault = built_in
        .with_custom_parts(CustomParts { sensors: elsewhere, ..CustomParts::default() })
        .expect_err("no place");
    assert!(fault.to_string().contains("sensor[3]: is not there: the scenario has 1 sensor"), "{fault}");
}
