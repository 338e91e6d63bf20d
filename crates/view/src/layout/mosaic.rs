//! Mosaic of a layout: two columns of panels, each panel with a height by its weight.

use serde_json::{Value, json};

use super::panel::LayoutPanel;

/// Returns the mosaic of panels, from the upper left down the first column and then down the second.
pub fn from_panels(panels: &[&LayoutPanel]) -> Value {
    let total: u32 = panels.iter().map(|panel| panel.weight()).sum();
    if panels.len() <= 2 {
        return column(panels);
    }
    let mut first = 0;
    let mut weight = 0;
    while first + 1 < panels.len() && 2 * (weight + panels[first].weight()) <= total + 1 {
        weight += panels[first].weight();
        first += 1;
    }
    let (left, right) = panels.split_at(first.max(1));
    json!({ "direction": "row", "splitPercentage": 50, "first": column(left), "second": column(right) })
}

/// Returns a column of panels.
fn column(panels: &[&LayoutPanel]) -> Value {
    let Some((first, rest)) = panels.split_first() else { return Value::Null };
    if rest.is_empty() {
        return json!(first.id());
    }
    let below: u32 = rest.iter().map(|panel| panel.weight()).sum();
    let share = 100 * first.weight() / (first.weight() + below);
    json!({ "direction": "column", "splitPercentage": share, "first": first.id(), "second": column(rest) })
}
