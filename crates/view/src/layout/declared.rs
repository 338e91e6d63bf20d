//! Panels that follow from the declarations of topics alone: of the engine, and of custom parts.

use std::borrow::Cow;
use std::sync::Arc;

use flexsc_core::Scenario;
use flexsc_core::control::actuator::{ActuatorKind, AssignedActuator};
use flexsc_core::control::estimator::{self, EstimatorKind};
use flexsc_core::control::law::Controllers;
use flexsc_core::control::part::{Occasion, Part, ReportContext, TrueState};
use flexsc_core::control::sensor::{Orientation, Sensor, SensorKind};
use flexsc_core::dynamics::AxisState;
use flexsc_core::dynamics::three_axis::RotorObservation;
use flexsc_core::numerics::random::Seed;
use flexsc_core::numerics::time::Instant;
use flexsc_core::record::row::{FieldKind, RowField, Topic, TopicPanel};
use flexsc_core::record::{CustomField, CustomTopic, Detail, Report, TOPICS};
use nalgebra::Quaternion;

use super::Tab;
use super::panel::{LayoutPanel, MOST_LINES, PlotLine, line};

/// Topics with declared panels that have their place among the panels of the motion.
const PLACED: [&str; 3] = ["/control_moment_gyros", "/hinges", "/wheels"];

/// Returns the tab of the declared panels that have no place elsewhere, those of custom topics included; `None` without any.
pub fn tab(scenario: &Scenario, custom: &[Arc<CustomTopic>]) -> Option<Tab> {
    let custom = custom.iter().flat_map(|topic| custom_panels(topic));
    let own = unplaced(scenario).flat_map(|topic| panels(topic, MOST_LINES));
    let panels: Vec<LayoutPanel> = own.chain(custom).collect();
    (!panels.is_empty()).then_some(Tab { title: "Other parts", panels })
}

/// Returns the topics of that tab, with the least detail of a log that has each.
pub fn topics(scenario: &Scenario, custom: &[Arc<CustomTopic>]) -> Vec<(Cow<'static, str>, Detail)> {
    let own = unplaced(scenario).map(|topic| (Cow::Borrowed(topic.name), topic.logged.detail()));
    let custom = custom.iter().map(|topic| (Cow::Owned(topic.name().to_owned()), Detail::Full));
    own.chain(custom).collect()
}

/// Returns the panels that a topic declares, of at most `count` nested rows.
pub fn panels(topic: &Topic, count: usize) -> Vec<LayoutPanel> {
    let panel = |panel: &TopicPanel| {
        let mut lines = Vec::new();
        add_lines(topic.name, topic.fields, panel, count, &mut lines);
        LayoutPanel::plot(panel.name, panel.title, lines)
    };
    topic.panels.iter().map(panel).collect()
}

/// Adds the lines of the fields of a panel's name, also those in nested rows.
fn add_lines(path: &str, fields: &[RowField], panel: &TopicPanel, count: usize, lines: &mut Vec<PlotLine>) {
    for field in fields {
        let own = format!("{path}.{}", field.name);
        match field.kind {
            FieldKind::Row(inner) => add_lines(&own, inner.fields, panel, count, lines),
            FieldKind::Rows(inner) if inner.fields.iter().any(|of| of.name == panel.field) => {
                let each = |index: usize| {
                    line(format!("{own}[{index}].{}", panel.field), format!("{} {}", panel.label, index + 1))
                };
                lines.extend((0..count.min(MOST_LINES)).map(each));
            }
            _ if field.name == panel.field => lines.push(line(own, panel.label)),
            _ => {}
        }
    }
}

/// Returns the panels of a custom topic: one for the fields of each unit, and one for the words.
fn custom_panels(topic: &CustomTopic) -> Vec<LayoutPanel> {
    let name = topic.name().trim_start_matches('/');
    let (words, numbers): (Vec<&CustomField>, Vec<_>) =
        topic.fields().iter().partition(|field| field.is_word);
    let line_of = |field: &CustomField| line(format!("/{name}.{}", field.name), field.name.replace('_', " "));
    let title = name.replace('_', " ");
    let mut units: Vec<&str> = Vec::new();
    for field in &numbers {
        if !units.contains(&field.unit.as_str()) {
            units.push(&field.unit);
        }
    }
    let panel = |(index, unit): (usize, &&str)| {
        let fields = numbers.iter().filter(|field| field.unit == **unit);
        let lines: Vec<PlotLine> = fields.take(MOST_LINES).map(|field| line_of(field)).collect();
        let unit = if unit.is_empty() { String::new() } else { format!(" ({unit})") };
        LayoutPanel::plot(format!("{name}_{index}"), format!("{title}{unit}"), lines)
    };
    let states: Vec<PlotLine> = words.iter().take(MOST_LINES).map(|field| line_of(field)).collect();
    let states =
        (!states.is_empty()).then(|| LayoutPanel::states(format!("{name}_states"), title.clone(), states));
    units.iter().enumerate().map(panel).chain(states).collect()
}

/// Returns the topics with declared panels without a place elsewhere that the logs of a scenario have.
fn unplaced(scenario: &Scenario) -> impl Iterator<Item = &'static Topic> {
    let declared: Vec<&Topic> =
        TOPICS.iter().filter(|topic| !topic.panels.is_empty() && !PLACED.contains(&topic.name)).collect();
    let reported = if declared.is_empty() { Vec::new() } else { reported_topics(scenario) };
    declared.into_iter().filter(move |topic| reported.contains(&topic.name))
}

/// Returns the topics that the parts of a scenario report at each period of a full log, apart from custom parts, which
/// declare theirs.
fn reported_topics(scenario: &Scenario) -> Vec<&'static str> {
    let seed = Seed { scenario: scenario.seed, run: 0 };
    let axes = scenario.study.axes.len();
    let built_in = |sensor: &&SensorKind| !matches!(sensor, SensorKind::Own(_));
    let sensors = scenario.sensor.iter().filter(built_in).map(|sensor| sensor.start(axes, seed, 0));
    let sensors: Vec<Box<dyn Sensor>> = sensors.collect();
    let estimator = (!matches!(scenario.estimator, Some(EstimatorKind::Own(_))))
        .then(|| estimator::start(&scenario.estimator_context(), seed));
    let laws = (!scenario.law.has_custom())
        .then(|| Controllers::new(&scenario.law, &scenario.study.authorities, &[]));
    let is_own = |assigned: &AssignedActuator| matches!(assigned.kind, ActuatorKind::Own(_));
    let actuator = (!scenario.actuator.iter().any(is_own)).then(|| scenario.study.actuator(scenario, seed));
    let parts = (sensors.iter().map(|sensor| &**sensor as &dyn Part))
        .chain(estimator.iter().map(|estimator| &**estimator as &dyn Part))
        .chain(laws.iter().map(|laws| laws as &dyn Part))
        .chain(actuator.iter().map(|actuator| &**actuator as &dyn Part));
    let truth = StartingState(scenario);
    let at =
        ReportContext { now: Instant::START, occasion: Occasion::Period, axes, truth: &truth, damping: &[] };
    let mut report = Report::new();
    parts.for_each(|part| part.report(&at, &mut report));
    report.rows().filter_map(|row| Some(TOPICS[row.topic().declared_index()?].name)).collect()
}

/// State of a body at the start of a scenario, at rest.
struct StartingState<'a>(&'a Scenario);

impl TrueState for StartingState<'_> {
    fn orientation(&self) -> Orientation {
        match self.0.study.axes.len() {
            1 => Orientation::Angle(0.0),
            _ => Orientation::Attitude(Quaternion::identity()),
        }
    }

    fn rates(&self) -> [[f64; 3]; 2] {
        [[0.0; 3]; 2]
    }

    fn about_axis(&self, axis: usize) -> Cow<'_, AxisState> {
        Cow::Owned(self.0.study.axes[axis].initial_state())
    }

    fn mode_rates(&self) -> Vec<f64> {
        vec![0.0; self.0.mode_count()]
    }

    fn rotors(&self) -> Vec<RotorObservation> {
        Vec::new()
    }

    fn gyro_bias(&self) -> [f64; 3] {
        [0.0; 3]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENARIOS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios");

    #[test]
    fn parts_report_the_topics_that_the_layout_expects() {
        for (name, topic) in [
            ("wheel-ekf", "/wheel"),
            ("earth-observer", "/wheels"),
            ("agile-observer", "/control_moment_gyros"),
            ("detumble-and-point", "/magnetorquers"),
        ] {
            let path = format!("{SCENARIOS}/{name}.toml");
            let Ok(scenario) = Scenario::load(path.as_ref()) else { panic!("no scenario {name}") };
            assert!(reported_topics(&scenario).contains(&topic), "{name}: {topic}");
        }
    }

    #[test]
    fn declared_panels_have_unique_names() {
        let names: Vec<&str> = TOPICS.iter().flat_map(|topic| topic.panels).map(|panel| panel.name).collect();
        assert!(names.iter().enumerate().all(|(index, name)| !names[..index].contains(name)), "{names:?}");
        for topic in TOPICS {
            assert!(
                panels(topic, 2).iter().all(|panel| !panel.vertical_paths().is_empty()),
                "{}",
                topic.name
            );
        }
    }
}
