//! Viewer layouts: panels that show a run in Foxglove-compatible viewers, created from its scenario.
//!
//! A layout is created with all topics that a log of the scenario can have, and then keeps the panels whose topics a
//! log has. The layouts attached to logs, written by `flexsc layout` and shipped with the examples come from this
//! module; the last two have their axes fitted to the values of a log.

mod axis_limits;
mod declared;
mod mosaic;
mod one_axis;
mod panel;
mod three_axis;

use std::borrow::Cow;
use std::sync::Arc;

use flexsc_core::Scenario;
use flexsc_core::control::actuator::FiringMethod;
use flexsc_core::control::adaptation::Objective;
use flexsc_core::control::estimator::EstimatorKind;
use flexsc_core::dynamics::three_axis::Bearing;
use flexsc_core::metrics::MetricsCollector;
use flexsc_core::numerics::time::Instant;
use flexsc_core::record::row::{Logging, Topic};
use flexsc_core::record::{CustomTopic, Detail, Log, LogError, Summary, TOPICS};
use flexsc_core::spacecraft::body::BodyAxes;
use serde_json::{Map, Value, json};

use panel::LayoutPanel;

/// Number of panels above which a layout has tabs.
const MOST_PANELS: usize = 8;

/// Number of points of a curve that is drawn as points: up to about one for each pixel, viewers mark each point of a
/// line with a black disc, and that many discs hide the line and its colour.
const FEW: std::ops::Range<f64> = 100.0..1000.0;
/// Topic of the flywheel, whose curve is drawn as a line whatever the number of its points.
const FLYWHEEL: &str = "/wheel";

/// Layout of a viewer.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    tabs: Vec<Tab>,
    /// Topics of a log, with the least detail that has each.
    topics: Vec<(Cow<'static, str>, Detail)>,
}

/// Tab with related panels.
#[derive(Clone, Debug, PartialEq)]
struct Tab {
    title: &'static str,
    panels: Vec<LayoutPanel>,
}

impl Layout {
    /// Returns the layout of a log of a scenario, with all that it can show.
    ///
    /// # Errors
    /// A log that cannot be read.
    pub fn for_log(scenario: &Scenario, log: &Log) -> Result<Self, LogError> {
        let layout = Self::with_custom_topics(scenario, &log.custom_topics()?);
        Ok(layout.for_topics(|topic| log.topics().iter().any(|own| own == topic)))
    }

    /// Returns the layout of a scenario's logs, with all that they can show.
    pub fn for_scenario(scenario: &Scenario) -> Self {
        Self::with_custom_topics(scenario, &scenario.custom_topics())
    }

    /// Returns the layout of a scenario's logs with these custom topics.
    fn with_custom_topics(scenario: &Scenario, custom: &[Arc<CustomTopic>]) -> Self {
        let mut tabs = match scenario.model.axes() {
            BodyAxes::One(body) => one_axis::tabs(scenario, body),
            BodyAxes::Three(body) => three_axis::tabs(scenario, body),
        };
        if let Some(first) = tabs.first_mut().filter(|_| !scenario.mode.is_empty()) {
            let mode =
                LayoutPanel::states("mode", "Mode of operation", vec![panel::line("/mode.mode", "mode")]);
            first.panels.insert(1, mode);
        }
        tabs.extend(declared::tab(scenario, custom));
        tabs.push(Tab { title: "Metrics at the end", panels: metrics(scenario).collect() });
        let rows = scenario.duration.seconds() / scenario.log_period().seconds();
        if FEW.contains(&rows) {
            for panel in tabs.iter_mut().flat_map(|tab| &mut tab.panels) {
                panel.mark(&is_at_each_period);
            }
        }
        let known = topics(scenario).into_iter().map(|(topic, detail)| (Cow::Borrowed(topic), detail));
        Self { tabs, topics: known.chain(declared::topics(scenario, custom)).collect() }
    }

    /// Returns the layout with the panels that a log of this detail can show.
    #[must_use]
    pub fn for_detail(&self, detail: Detail) -> Self {
        let has = |topic: &str| self.topics.iter().any(|(own, least)| *own == topic && *least <= detail);
        self.for_topics(has)
    }

    /// Returns the layout with the panels that a log with these topics can show.
    #[must_use]
    pub fn for_topics(&self, has: impl Fn(&str) -> bool) -> Self {
        let tabs = self.tabs.iter().map(|tab| {
            let panels = tab.panels.iter().filter_map(|panel| panel.with_topics(&has)).collect();
            Tab { title: tab.title, panels }
        });
        let tabs = tabs.filter(|tab: &Tab| !tab.panels.is_empty()).collect();
        Self { tabs, topics: self.topics.clone() }
    }

    /// Returns the layout as JSON, in the form that viewers import.
    pub fn to_json(&self) -> String {
        let panels = || self.tabs.iter().flat_map(|tab| &tab.panels);
        let mut configs: Map<String, Value> = panels().map(|panel| (panel.id(), panel.config())).collect();
        let layout = if panels().count() <= MOST_PANELS {
            mosaic::from_panels(&panels().collect::<Vec<_>>())
        } else {
            let tab = |tab: &Tab| {
                let layout = mosaic::from_panels(&tab.panels.iter().collect::<Vec<_>>());
                json!({ "title": tab.title, "layout": layout })
            };
            let tabs: Vec<Value> = self.tabs.iter().map(tab).collect();
            configs.insert("Tab!run".to_owned(), json!({ "activeTabIdx": 0, "tabs": tabs }));
            json!("Tab!run")
        };
        let layout = json!({
            "configById": configs,
            "globalVariables": {},
            "userNodes": {},
            "playbackConfig": { "speed": 1 },
            "layout": layout,
        });
        // The value is a tree of texts and finite numbers, so this cannot fail.
        serde_json::to_string_pretty(&layout).unwrap_or_default() + "\n"
    }
}

/// Returns true if a topic is logged once in each period of the log, and drawn as points where they are few.
fn is_at_each_period(topic: &str) -> bool {
    let logged = |known: &Topic| known.name == topic && known.logged == Logging::Period;
    topic != FLYWHEEL && TOPICS.iter().any(logged)
}

/// Returns the panels of the metrics, page by page.
fn metrics(scenario: &Scenario) -> impl Iterator<Item = LayoutPanel> {
    let pages = MetricsCollector::new(scenario).finish(scenario).0.len().div_ceil(Summary::PAGE);
    (0..pages).map(move |page| LayoutPanel::metrics(page, pages))
}

/// Returns the topics of a complete log of a scenario, with the least detail that has each.
fn topics(scenario: &Scenario) -> Vec<(&'static str, Detail)> {
    use Detail::{Events, Full, Scene};
    let mut topics =
        vec![("/params", Events), ("/log", Events), ("/summary", Events), ("/scene", Scene), ("/tf", Scene)];
    let mut add = |there: bool, topic: &'static str, detail: Detail| {
        if there {
            topics.push((topic, detail));
        }
    };
    let estimator = scenario.estimator.as_ref();
    let window = scenario.adaptation.as_ref().and_then(|adaptation| adaptation.window());
    let measures =
        window.is_some_and(|window| scenario.goal().from + window <= Instant::START + scenario.duration);
    add(measures, "/objective", Events);
    add(measures, "/adaptation", Events);
    add(!scenario.failures().is_empty(), "/faults", Events);
    add(!scenario.mode.is_empty(), "/mode", Events);
    if scenario.axis_count() == 3 {
        add(scenario.study.fires(), "/jets", Events);
        let alone = scenario
            .actuator
            .jets()
            .is_some_and(|(jets, _)| jets.allocation == FiringMethod::LeastPropellant);
        add(alone, "/thrusters", Events);
        add(!scenario.study.jets_alone || scenario.environment.is_some(), "/torques", Full);
        add(one_axis::filters(scenario), "/estimators", Full);
        add(estimator.is_some_and(|estimator| estimator.attitude().is_some()), "/attitude_filter", Full);
        add(scenario.has_false_readings(), "/refusals", Full);
        let elastic =
            estimator.and_then(EstimatorKind::attitude).is_some_and(|filter| filter.elastic.is_some());
        add(elastic, "/attitude_filter_modes", Full);
        add(scenario.study.wheels.is_some(), "/wheels", Full);
        add(!scenario.study.gimbals.is_empty(), "/control_moment_gyros", Full);
        add(scenario.environment.as_ref().is_some_and(|around| around.orbit.is_some()), "/orbit", Full);
        add(scenario.sensor.accelerometers().next().is_some(), "/accelerations", Full);
        add(scenario.sensor.exclusions().next().is_some(), "/blinding", Events);
        add(!scenario.line_of_sight.is_empty(), "/line_of_sight", Full);
        add(scenario.line_of_sight.iter().any(|line| line.mirror.is_some()), "/fine_mirror", Full);
        add(scenario.actuator.magnetorquers().is_some(), "/magnetorquers", Full);
        add(scenario.study.articulation().is_some(), "/drives", Full);
        add(scenario.study.hinges() > 0, "/hinges", Full);
        add(!scenario.study.bearings.is_empty(), "/bearings", Full);
        add(scenario.study.bearings.iter().any(Bearing::can_stick), "/wheel_events", Events);
        for topic in ["/pointing", "/rates", "/vibrations", "/energy"] {
            add(true, topic, Full);
        }
        add(estimator.is_some_and(|estimator| estimator.adaptive().is_some()), "/tracking", Full);
        add(scenario.study.translation.is_some(), "/position", Full);
        let window = estimator.and_then(EstimatorKind::envelope).map(|envelope| envelope.window);
        let closes = window.is_some_and(|window| window <= scenario.duration);
        add(closes, "/envelope_mean", Events);
        add(closes && scenario.objective() == Some(Objective::EnvelopeMean), "/adaptation", Events);
        add(window.is_some(), "/envelope", Full);
        add(true, "/plumes", Scene);
        return topics;
    }
    let plan = scenario.plan.as_ref();
    let wheel = scenario.actuator.flywheel().map(|(wheel, _)| wheel);
    add(true, "/law", Events);
    add(
        scenario.law.is_switching() || (plan.is_some() && one_axis::feeds_back(scenario)),
        "/command",
        Events,
    );
    let window = estimator.and_then(EstimatorKind::envelope).map(|envelope| envelope.window);
    let closes = window.is_some_and(|window| window <= scenario.duration);
    add(closes, "/envelope_mean", Events);
    let learns = scenario.objective() == Some(Objective::EnvelopeMean);
    add(closes && learns, "/adaptation", Events);
    add(plan.is_some_and(|plan| plan.time <= scenario.duration.seconds()), "/arrival", Events);
    for topic in ["/attitude", "/rate", "/modes"] {
        add(true, topic, Full);
    }
    add(!scenario.model.outputs().is_empty(), "/outputs", Full);
    add(scenario.has_torque_rows(), "/goal", Full);
    add(scenario.has_torque_rows(), "/torque", Full);
    add(wheel.is_some_and(|wheel| wheel.rotor.is_some()), "/wheel", Full);
    add(window.is_some(), "/envelope", Full);
    add(one_axis::filters(scenario), "/estimator", Full);
    add(wheel.is_none(), "/plumes", Scene);
    topics
}
