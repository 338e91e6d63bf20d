//! Export of the topic `/metrics` as a readable table: a row for each metric, with its unit and meaning.

use flexsc_core::metrics;
use flexsc_core::record::{Column, Columns};
use serde_json::{Value as Json, json};

/// Name of the topic.
pub const TOPIC: &str = "/metrics";

/// Row of the table: a metric, or one element of it.
struct MetricRow<'a> {
    name: String,
    value: Json,
    unit: &'a str,
    meaning: &'static str,
}

/// Returns the table as comma-separated values or as JSON lines; `None` if the topic has an unexpected structure.
pub fn table(columns: &Columns, as_json: bool) -> Option<Result<Vec<u8>, csv::Error>> {
    let rows = rows(columns)?;
    Some(if as_json { Ok(rows.iter().map(jsonl).collect::<String>().into_bytes()) } else { csv(&rows) })
}

fn rows(columns: &Columns) -> Option<Vec<MetricRow<'_>>> {
    let Some(Column::Rows(_, inner)) = columns.get("metrics") else { return None };
    let texts = |name: &str| match inner.get(name) {
        Some(Column::Texts(texts)) => Some(texts),
        _ => None,
    };
    let (names, units, words) = (texts("name")?, texts("unit")?, texts("text")?);
    let values = inner.numbers("value")?;
    let row = |(place, name): (usize, &String)| -> Option<MetricRow<'_>> {
        let next_is_same = names.get(place + 1) == Some(name);
        let first = names[..place].iter().rposition(|before| before != name).map_or(0, |before| before + 1);
        let is_list = next_is_same || first < place;
        let (value, word) = (*values.get(place)?, words.get(place)?);
        // In a list, the first element has the description.
        let meaning = metrics::ALL.iter().find(|meaning| meaning.name == name.as_str() && first == place);
        Some(MetricRow {
            name: if is_list { format!("{name}[{}]", place - first) } else { name.clone() },
            value: if word.is_empty() { json!(value) } else { json!(word) },
            unit: units.get(place)?,
            meaning: meaning.map_or("", |meaning| meaning.doc),
        })
    };
    names.iter().enumerate().map(row).collect()
}

fn csv(rows: &[MetricRow<'_>]) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(["name", "value", "unit", "meaning"])?;
    for MetricRow { name, value, unit, meaning } in rows {
        writer.write_record([name.as_str(), &text(value), unit, meaning])?;
    }
    Ok(writer.into_inner().map_err(csv::IntoInnerError::into_error)?)
}

/// Formats a value: integers without a decimal point, and a missing number as an empty cell.
fn text(value: &Json) -> String {
    match value.as_f64() {
        Some(number) if number != 0.0 && !(1e-4..1e15).contains(&number.abs()) => format!("{number:e}"),
        Some(number) => number.to_string(),
        None => value.as_str().unwrap_or_default().to_owned(),
    }
}

fn jsonl(MetricRow { name, value, unit, meaning }: &MetricRow<'_>) -> String {
    format!("{}\n", json!({"name": name, "value": value, "unit": unit, "meaning": meaning}))
}
