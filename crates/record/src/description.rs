//! Description of the topics of a log as JSON, for reference pages and for programs that read logs.

use serde_json::{Map, Value, json};

use super::row::{FieldKind, RowField};
use super::topics::TOPICS;

/// Returns the description of every topic, by name without its slash: `message`, `doc` and `fields`.
///
/// A field has its `name`, which ends with its unit, `doc`, and `kind`: `number`, `count`, `text`, `flag`, `time`,
/// `label` with its `labels`, or `row` and `rows` with the `fields` of each row.
pub fn topics() -> Value {
    let topics = TOPICS.iter().map(|topic| {
        let reported =
            json!({"message": topic.message, "doc": text(topic.doc), "fields": fields(topic.fields)});
        (topic.name.trim_start_matches('/').to_owned(), reported)
    });
    Value::Object(topics.collect::<Map<_, _>>())
}

fn fields(row_fields: &[RowField]) -> Value {
    row_fields.iter().map(field).collect()
}

fn field(field: &RowField) -> Value {
    let mut reported = json!({"name": field.name, "doc": text(field.doc)});
    reported["kind"] = match field.kind {
        FieldKind::Number => "number",
        FieldKind::Count => "count",
        FieldKind::Text => "text",
        FieldKind::Flag => "flag",
        FieldKind::Time(_) => "time",
        FieldKind::Label(labels) => {
            let meanings = labels.values.iter().zip(labels.docs);
            let meaning = |(value, doc): (&&str, &&str)| ((*value).to_owned(), Value::from(doc.trim()));
            reported["labels"] = Value::Object(meanings.map(meaning).collect());
            "label"
        }
        FieldKind::Row(message) => {
            reported["fields"] = fields(message.fields);
            "row"
        }
        FieldKind::Rows(message) => {
            reported["fields"] = fields(message.fields);
            "rows"
        }
    }
    .into();
    reported
}

/// Returns the description of the field at a path of topics and nested rows, such as `rates/axes/rate_rad_s`.
pub fn field_text(path: &str) -> Option<String> {
    let mut steps = path.split('/');
    let topic = steps.next()?;
    let mut fields = TOPICS.iter().find(|known| known.name.trim_start_matches('/') == topic)?.fields;
    let mut found = None;
    for step in steps {
        let field = fields.iter().find(|field| field.name == step)?;
        if let FieldKind::Row(message) | FieldKind::Rows(message) = field.kind {
            fields = message.fields;
        }
        found = Some(field);
    }
    found.map(|field| text(field.doc))
}

fn text(lines: &[&str]) -> String {
    lines.iter().map(|line| line.trim()).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn described(fields: &Value, place: &str) {
        for field in fields.as_array().expect("fields") {
            let name = field["name"].as_str().expect("a name");
            assert!(!field["doc"].as_str().expect("a text").is_empty(), "{place}.{name}");
            if let Some(inner) = field.get("fields") {
                described(inner, &format!("{place}.{name}"));
            }
        }
    }

    #[test]
    fn every_topic_and_field_is_described() {
        let all = topics();
        let all = all.as_object().expect("topics");
        assert_eq!(all.len(), TOPICS.len());
        let state = &all["command"]["fields"][3];
        assert!(state["labels"]["W+"].as_str().is_some_and(|doc| doc.contains("weak")), "{state}");
        for (name, topic) in all {
            assert!(!topic["doc"].as_str().expect("a text").is_empty(), "{name}");
            described(&topic["fields"], name);
        }
    }
}
