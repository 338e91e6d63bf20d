//! Panels that follow from the declarations of topics alone: of custom parts, and of topics with panels of their own.

use std::borrow::Cow;

use flexsc_record::row::{FieldKind, RowField, Topic};
use flexsc_record::{CustomTopic, Detail, TOPICS};

use super::Tab;
use super::panel::{LayoutPanel, MOST_LINES, PlotLine, line};
use crate::scenario::Scenario;

/// Returns the tab of the declared panels; `None` without any.
pub fn tab(scenario: &Scenario) -> Option<Tab> {
    let custom = scenario.custom_parts().topics();
    let custom = custom.iter().flat_map(|topic| custom_panels(topic));
    let own = TOPICS.iter().flat_map(|topic| topic.panels.iter().map(|panel| declared_panel(topic, panel)));
    let panels: Vec<LayoutPanel> = own.chain(custom).collect();
    (!panels.is_empty()).then_some(Tab { title: "Other parts", panels })
}

/// Returns the topics with declared panels, with the least detail of a log that has each.
pub fn topics(scenario: &Scenario) -> Vec<(Cow<'static, str>, Detail)> {
    let own = TOPICS.iter().filter(|topic| !topic.panels.is_empty());
    let own = own.map(|topic| (Cow::Borrowed(topic.name), topic.logged.detail()));
    let custom = scenario.custom_parts().topics();
    let custom = custom.iter().map(|topic| (Cow::Owned(topic.name().to_owned()), Detail::Full));
    own.chain(custom).collect()
}

/// Returns the panels of a custom topic: one for the fields of each unit.
fn custom_panels(topic: &CustomTopic) -> Vec<LayoutPanel> {
    let name = topic.name().trim_start_matches('/');
    let mut units: Vec<&str> = Vec::new();
    for field in topic.fields() {
        if !units.contains(&field.unit.as_str()) {
            units.push(&field.unit);
        }
    }
    let panel = |(index, unit): (usize, &&str)| {
        let fields = topic.fields().iter().filter(|field| field.unit == **unit);
        let lines: Vec<PlotLine> = fields
            .take(MOST_LINES)
            .map(|field| line(format!("/{name}.{}", field.name), field.name.replace('_', " ")))
            .collect();
        let unit = if unit.is_empty() { String::new() } else { format!(" ({unit})") };
        LayoutPanel::plot(format!("{name}_{index}"), format!("{}{unit}", name.replace('_', " ")), lines)
    };
    units.iter().enumerate().map(panel).collect()
}

/// Returns a panel that a topic declares with its title and the name of its fields.
fn declared_panel(topic: &Topic, (title, shown): &(&'static str, &'static str)) -> LayoutPanel {
    let mut lines = Vec::new();
    add_lines(topic.name, topic.fields, shown, &mut lines);
    let name = topic.name.trim_start_matches('/');
    LayoutPanel::plot(format!("{name}_{shown}"), *title, lines)
}

/// Adds the lines of all fields of a name; of repeated rows the first ones, as viewers ignore those that are missing.
fn add_lines(path: &str, fields: &[RowField], shown: &str, lines: &mut Vec<PlotLine>) {
    for field in fields {
        let own = format!("{path}.{}", field.name);
        match field.kind {
            FieldKind::Row(inner) => add_lines(&own, inner.fields, shown, lines),
            FieldKind::Rows(inner) => {
                for index in (0..MOST_LINES).filter(|_| inner.fields.iter().any(|of| of.name == shown)) {
                    let label = format!("{} {}", field.name.trim_end_matches('s'), index + 1);
                    lines.push(line(format!("{own}[{index}].{shown}"), label));
                }
            }
            _ if field.name == shown => lines.push(line(own, shown.replace('_', " "))),
            _ => {}
        }
    }
}
