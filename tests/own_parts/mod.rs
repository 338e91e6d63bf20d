//! Custom parts outside the engine's crate: a kind of each role, in a file each, and a loop that they close together.

mod actuator;
mod adaptation;
mod estimator;
mod law;
mod log_figures;
mod sensor;
mod stage_laws;

use std::path::Path;
use std::sync::Arc;

use flexsc_cli::figures;
use flexsc_core::campaign::{Campaign, CampaignRun};
use flexsc_core::control::actuator::{ActuatorKind, ActuatorSpec};
use flexsc_core::control::adaptation::AdaptationKind;
use flexsc_core::control::custom::Custom;
use flexsc_core::control::one_or_many::OneOrMany;
use flexsc_core::record::metrics::Metrics;
use flexsc_core::record::{
    Column, CustomField, CustomTopic, Detail, Log, LogBytes, RunEnd, TopicError, Trace,
};
use flexsc_core::scenario::CustomParts;
use flexsc_core::{Document, Scenario, Simulation, SimulationError};
use flexsc_view::with_layout;

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
    actuator::Servo::new(most, step)
}

/// Returns a scenario whose control system is all custom.
fn of_own_parts(text: &str) -> Scenario {
    let scenario = Scenario::parse("own.toml", text).expect("a scenario");
    let whole = scenario.with(|scenario| {
        scenario.law = law::Pid::kind([4.0, 0.15, 30.0], 0.25);
        scenario.sensor = OneOrMany::one(sensor::Encoder::kind(1e-6, 0.25));
        scenario.estimator = Some(estimator::AlphaBeta::kind(0.4, 0.1));
        scenario.actuator = OneOrMany::one(actuator::Servo::kind(0.05, 1e-5).into());
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
    let state = simulation.three_axis_state().expect("three axes");
    let off = state.turn.attitude.vector().norm();
    assert!(off < 1e-5, "{off}");
}

/// Topics of the toys, each with a field and its unit.
const TOPICS: [(&str, &str, &str); 4] = [
    ("/pid", "integral", "rad s"),
    ("/encoder", "x", ""),
    ("/alpha_beta", "innovation", "rad"),
    ("/servo", "travel", "N m"),
];

#[test]
fn parts_from_outside_log_their_states() {
    for text in [ONE_ANGLE, THREE_AXES] {
        let study = of_own_parts(text);
        let mut trace = Trace::new(Detail::Full);
        Simulation::new(&study, 0).run(&mut trace).expect("a run");
        let run = CampaignRun::new(study.clone(), 0);
        let provenance = with_layout(Campaign::provenance(&run), &study, Detail::Full);
        let layout = String::from_utf8(provenance.attachments[0].data.clone()).expect("a text");
        let mut bytes = LogBytes::new(&provenance, Detail::Full).expect("a log");
        Simulation::new(&study, 0).run(&mut bytes).expect("a run");
        let bytes = bytes.finish(&Metrics(Vec::new()), RunEnd::Complete).expect("a log");
        let path = Path::new("own.mcap");
        let log = Log::read(path, bytes).expect("a log");
        for (topic, field, unit) in TOPICS {
            let traced = trace.topic(topic).and_then(|rows| rows.numbers(field)).expect("a column");
            let logged = log.columns(topic).expect("a topic");
            assert_eq!(logged.numbers(field), Some(traced), "{topic}");
            let moves = text == THREE_AXES || traced.iter().any(|value| *value != 0.0);
            assert!(traced.len() >= 200 && moves, "{topic}");
            assert_eq!(log.units(topic)[field], unit);
            let path = format!("{topic}.{field}");
            assert!(layout.contains(&path), "no panel shows {path}");
            let figure = figures::log_figure(&log, Path::new("own.mcap"), topic, None).expect("a figure");
            assert!(figure.svg().expect("a picture").contains(field), "{topic}");
        }
        // A log without the motion has no rows of the toys either.
        let mut events = Trace::new(Detail::Events);
        Simulation::new(&study, 0).run(&mut events).expect("a run");
        assert!(TOPICS.iter().all(|(topic, ..)| events.topic(topic).is_none()));
    }
}

#[test]
fn custom_topics_are_checked() {
    let field = |name: &str| CustomField::new(name, "rad", "A field.");
    let topic = |name: &str, fields| CustomTopic::new(name, "A topic.", fields).map(drop).expect_err("wrong");
    for name in ["pid", "/", "/Pid", "/1pid", "/a-b", "/a/b"] {
        assert_eq!(topic(name, vec![field("x")]), TopicError::Name(name.to_owned()));
    }
    let long = format!("/{}", "a".repeat(65));
    assert_eq!(topic(&long, vec![field("x")]), TopicError::Name(long.clone()));
    assert_eq!(topic("/wheels", vec![field("x")]), TopicError::Taken("/wheels".to_owned()));
    for name in ["", "X", "time_s", "a b", "ä"] {
        let (topic_name, field_name) = ("/pid".to_owned(), name.to_owned());
        let wrong = TopicError::Field { topic: topic_name, field: field_name };
        assert_eq!(topic("/pid", vec![field(name)]), wrong);
    }
    let twice = TopicError::Twice { topic: "/pid".to_owned(), field: "x".to_owned() };
    assert_eq!(topic("/pid", vec![field("x"), field("x")]), twice);
    let many = (0..65).map(|index| field(&format!("x{index}"))).collect::<Vec<_>>();
    for fields in [Vec::new(), many] {
        let count = fields.len();
        assert_eq!(topic("/pid", fields), TopicError::Count { topic: "/pid".to_owned(), count });
    }
    let long = CustomField::new("x", "y".repeat(65), "");
    assert_eq!(topic("/pid", vec![long]), TopicError::Text { topic: "/pid".to_owned() });
    let own = CustomTopic::new("/pid", "", vec![field("x")]).expect("a topic");
    let values = TopicError::Values { topic: "/pid".to_owned(), fields: 1, count: 2 };
    assert_eq!(own.row([1.0, 2.0]).expect_err("two values"), values);
    // Two parts with different topics of one name.
    let fault = of_own_parts(ONE_ANGLE)
        .with(|scenario| {
            let other = CustomTopic::new("/pid", "", vec![field("x")]).expect("a topic");
            let servo = Custom::with_topics(servo(0.05, 1e-5), vec![other]);
            scenario.actuator = OneOrMany::one(ActuatorKind::Own(servo).into());
        })
        .expect_err("a conflict");
    assert!(fault.to_string().contains("actuator: topic `/pid`: is declared by two parts"), "{fault}");
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
