//! Prediction of a run's topics: viewers must know them before the first message, or they would miss it.

use std::collections::BTreeSet;

use flexsc_core::campaign::CampaignRun;
use flexsc_core::control::actuator::FiringMethod;
use flexsc_core::control::estimator::EstimatorKind;
use flexsc_core::dynamics::three_axis::Bearing;
use flexsc_core::numerics::time::Instant;
use flexsc_core::record::{Detail, Message, MessageEncoder, MessageSink, Provenance, RecordError, TOPICS};
use flexsc_core::{Scenario, Simulation};
use flexsc_view::scene::Scene;

/// Returns the expected topics of a run as indices into [`TOPICS`]: of its first instant, and of possible later events.
pub fn expected(run: &CampaignRun, from: &Provenance, scene: &Scene) -> BTreeSet<usize> {
    let mut topics = TopicCollector::default();
    if let Ok(mut messages) = MessageEncoder::new(&mut topics, from, Detail::Scene) {
        // A run that fails at its start reports the error when it is made.
        let mut simulation = Simulation::new(&run.scenario, run.noise_run);
        let _ = simulation.run_until(Instant::START, &mut (&mut messages, scene.clone()));
    }
    let late_topics = later(&run.scenario);
    // Custom topics are advertised with their first messages.
    topics.0.retain(|&index| index < TOPICS.len());
    topics.0.extend((0..TOPICS.len()).filter(|&index| late_topics.contains(&TOPICS[index].name)));
    topics.0
}

/// Returns the topics of events within a run or at its end.
fn later(scenario: &Scenario) -> Vec<&'static str> {
    let envelope = scenario.estimator.as_ref().and_then(EstimatorKind::envelope);
    let topics = [
        ("/command", scenario.axis_count() == 1 && !scenario.law.offers().is_open),
        ("/envelope_mean", envelope.is_some()),
        ("/objective", scenario.adaptation.as_ref().is_some_and(|adaptation| adaptation.window().is_some())),
        ("/adaptation", scenario.adaptation.is_some()),
        ("/arrival", scenario.plan.is_some()),
        ("/jets", scenario.study.fires()),
        ("/faults", !scenario.failures().is_empty()),
        ("/mode", !scenario.mode.is_empty()),
        ("/refusals", scenario.has_false_readings()),
        (
            "/thrusters",
            scenario
                .actuator
                .jets()
                .is_some_and(|(jets, _)| jets.allocation == FiringMethod::LeastPropellant),
        ),
        ("/blinding", scenario.sensor.exclusions().next().is_some()),
        ("/wheel_events", scenario.study.bearings.iter().any(Bearing::can_stick)),
        ("/summary", true),
        ("/metrics", true),
    ];
    topics.into_iter().filter(|(_, is_expected)| *is_expected).map(|(name, _)| name).collect()
}

/// Record that collects the topics of messages.
#[derive(Default)]
struct TopicCollector(BTreeSet<usize>);

impl MessageSink for &mut TopicCollector {
    fn push(&mut self, message: Message<'_>) -> Result<(), RecordError> {
        self.0.insert(message.topic);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use flexsc_core::campaign::Campaign;
    use flexsc_core::numerics::time::Span;

    use super::*;

    #[test]
    fn the_topics_of_every_shipped_scenario_are_known_beforehand() {
        let directory = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios");
        let mut names = BTreeSet::new();
        for file in std::fs::read_dir(directory).expect("scenarios").flatten() {
            if file.path().extension().is_none_or(|extension| extension != "toml") {
                continue;
            }
            let scenario = Scenario::load(&file.path()).expect("a scenario");
            let run = CampaignRun::new(scenario, 0);
            let (from, scene) = (Campaign::provenance(&run), Scene::new(&run.scenario));
            let (expected, mut topics) = (expected(&run, &from, &scene), TopicCollector::default());
            let messages = MessageEncoder::new(&mut topics, &from, Detail::Scene).expect("messages");
            // Long enough for an arrival, the windows of an adaptation, a zero crossing of a wheel, and a false attitude.
            let grips = run.scenario.study.bearings.iter().any(Bearing::can_stick);
            let errs = file.path().ends_with("false-readings.toml");
            let seconds = match (run.scenario.adaptation.is_some(), grips || errs) {
                (true, _) => 1100.0,
                (_, true) => 61.0,
                _ => 25.0,
            };
            let until = Instant::START + Span::from_seconds(seconds);
            let mut simulation = Simulation::new(&run.scenario, 0);
            simulation.run_until(until, &mut (messages, scene)).expect("a run");
            // Custom topics are advertised with their first messages.
            topics.0.retain(|&index| index < TOPICS.len());
            let name = |index: &usize| TOPICS[*index].name;
            let unknown: Vec<_> = topics.0.difference(&expected).map(name).collect();
            assert!(unknown.is_empty(), "{}: {unknown:?}", file.path().display());
            names.extend(topics.0.iter().map(name));
        }
        let all: BTreeSet<_> = TOPICS.iter().map(|topic| topic.name).collect();
        // The last of all.
        assert_eq!(all.difference(&names).collect::<Vec<_>>(), [&"/metrics", &"/summary"]);
    }
}
