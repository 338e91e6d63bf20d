//! Records do not change a run, and a copy of a run continues as the run itself, with every kind of parts.

use flexsc_core::dynamics::flow::ThreeAxisState;
use flexsc_core::dynamics::{AxisState, MotionPiece};
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::record::{Detail, PieceDemand, Record, RecordError, Sample, SceneSource, Trace};
use flexsc_core::{Document, Scenario, Simulation};
use flexsc_view::scene::Scene;

use crate::axes::{FILTERED, together};
use crate::lqg::lqg;
use crate::study::scenario;

/// Three-axis body whose modes are not damped, and which rotates fast.
const TURNING: &str = r#"duration = 40.0
[body.spatial]
inertia = [[5.0, 0.4, -0.2], [0.4, 3.0, 0.1], [-0.2, 0.1, 2.0]]
rate = [0.3, -0.2, 0.5]
points = [{ name = "hub" }]
[[body.spatial.modes]]
frequency = 1.3
displacement = 0.2
rate = 0.1
shapes.hub = { rotation = [0.1, 0.5, 0.0] }
[[body.spatial.modes]]
frequency = 4.1
displacement = -0.1
shapes.hub = { rotation = [0.0, 0.2, -0.3] }
"#;

/// Three different laws, on noisy samples.
const MIXED: &str = "[sensor.sampled]\nperiod = 0.2\nnoise = 1e-4\nrate_noise = 1e-4\n\
    [law.per_axis]\nroll = { relay = { dead_zone = 1e-2, hysteresis = 2e-3, strong = 0.1, weak = 1e-3, k_t = 0.3 } }\n\
    pitch = { pd = { k_p = 0.3, k_d = 1.0, period = 0.6 } }\nyaw = { open = {} }\n\
    [[disturbance]]\nabout = \"yaw\"\nnoise = 1e-6\nperiod = 0.7\n";

/// Exposure over the whole latency: one is open most of the time.
const EXPOSED: (&str, &str) = ("sensor[1].star_tracker.exposure", "0.4");

/// Loop without decisions, beyond 20 s.
const TRACKED: &str = "[law.open]\n[sensor.star_tracker]\nperiod = 0.7\nlatency = 0.5\nexposure = 0.7\nnoise = [1e-5, 1e-5, 1e-5]\n\
    [[disturbance]]\nabout = \"yaw\"\nnoise = 1e-3\nperiod = 11.0\n";

fn turning(rest: &str) -> Scenario {
    Scenario::parse("turning.toml", &format!("{TURNING}{rest}")).expect("valid")
}

/// Runs of many kinds.
fn runs() -> Vec<(&'static str, Scenario)> {
    vec![
        ("a filter and a hold", lqg("hold", "rigid")),
        ("a slew by a late wheel", lqg("late wheel turn", "hub")),
        ("a slew of a law that waits", lqg("waiting wheel turn", "hub")),
        ("filters of three axes", together(FILTERED, 1e-3)),
        ("laws that differ", turning(MIXED)),
        ("drifting modes", scenario("wheel-ekf", &[("duration", "60")])),
        ("a relay and a wheel", scenario("relay-wheel", &[("duration", "300")])),
        ("jets", scenario("iss-manoeuvre", &[("duration", "40")])),
        ("a tracker that gathers light", scenario("flexible-boom", &[("duration", "40"), EXPOSED])),
        ("the same of a body that no mode turns", turning(TRACKED)),
    ]
}

/// State that a run has reached.
type Reached = (Option<AxisState>, Option<ThreeAxisState>);

fn reached(simulation: &Simulation) -> Reached {
    (simulation.state().cloned(), simulation.three_axis_state().cloned())
}

fn end(mut simulation: Simulation, record: &mut impl Record) -> Reached {
    simulation.run(record).expect("a run");
    reached(&simulation)
}

#[test]
fn a_copy_goes_on_as_the_run_itself() {
    for (name, scenario) in runs() {
        let mut straight = Trace::new(Detail::Full);
        let exact = end(Simulation::new(&scenario, 3), &mut straight);
        let (mut simulation, mut trace) = (Simulation::new(&scenario, 3), Trace::new(Detail::Full));
        for part in [0.0, 0.0, 0.123_456_789, 0.25, 0.25, 0.333, 0.5, 0.612_3, 0.999, 1.0] {
            let until = Instant::START + Span::from_seconds(part * scenario.duration.seconds());
            simulation.run_until(until, &mut trace).expect("a run");
            let copy = simulation.clone();
            assert_eq!(end(simulation, &mut ()), exact, "{name}, from {part}");
            simulation = copy;
        }
        // NaN is not itself: texts are compared.
        assert!(format!("{trace:?}") == format!("{straight:?}"), "{name}: other rows");
        assert_eq!(end(simulation, &mut ()), exact, "{name}");
    }
}

/// Record that needs everything.
struct Everything {
    scene: Scene,
    samples: u64,
}

impl Record for Everything {
    fn wants_motion(&self) -> bool {
        true
    }

    fn scene(&self) -> Option<Box<dyn SceneSource>> {
        self.scene.scene()
    }

    fn piece_demand(&self) -> PieceDemand {
        PieceDemand::All
    }

    fn piece(&mut self, _: Instant, _: &MotionPiece) -> Result<(), RecordError> {
        self.samples += 1;
        Ok(())
    }

    fn record(&mut self, _: Instant, _: Sample<'_>) -> Result<(), RecordError> {
        self.samples += 1;
        Ok(())
    }
}

#[test]
fn whatever_looks_at_a_run_changes_nothing() {
    for (name, scenario) in runs() {
        let exact = end(Simulation::new(&scenario, 5), &mut ());
        let events = end(Simulation::new(&scenario, 5), &mut Trace::new(Detail::Events));
        assert_eq!(events, exact, "{name}: events");
        for period in ["0.1", "0.37", "1", "7.77"] {
            let mut document = Document::parse("again.toml", scenario.to_toml()).expect("TOML");
            document.set_text("log.period", period).expect("a key");
            let looked = Scenario::from_document(&document).expect("valid");
            let full = end(Simulation::new(&looked, 5), &mut Trace::new(Detail::Full));
            assert_eq!(full, exact, "{name}: a row each {period} s");
            let simulation = Simulation::new(&looked, 5);
            let mut everything = Everything { scene: Scene::new(&looked), samples: 0 };
            assert_eq!(end(simulation, &mut everything), exact, "{name}: a scene, each {period} s");
            assert!(everything.samples > 0, "{name}");
        }
    }
}

#[test]
fn three_axes_that_nothing_pushes_keep_their_energy() {
    let idle = "[law.pd]\nk_p = 0.0\nk_d = 0.0\nperiod = 0.3\n";
    let filtered = "[sensor.sampled]\nperiod = 0.3\nnoise = 1e-3\n[estimator.kalman]\nwatch_only = true\n";
    for rest in [
        "[law.open]\n".to_owned(),
        idle.to_owned(),
        format!("{idle}[actuator.wheel]\ngain = 2.0\ndelay = 0.1\n"),
        format!("{idle}[actuator.hold]\nperiod = 0.7\n"),
        format!("{idle}{filtered}"),
    ] {
        let mut trace = Trace::new(Detail::Full);
        Simulation::new(&turning(&rest), 0).run(&mut trace).expect("a run");
        let energy = trace.topic("/energy").expect("energies");
        let column = |name: &str| energy.numbers(name).expect("a column");
        for name in ["rotational_j", "elastic_j", "momentum_nm_s"] {
            let values = column(name);
            assert!(values.len() > 20 && values[0] > 0.0, "{rest}");
            let worst = values.iter().map(|value| (value / values[0] - 1.0).abs()).fold(0.0, f64::max);
            assert!(worst < 1e-13, "{rest}{name}: {worst:e}");
        }
    }
}
