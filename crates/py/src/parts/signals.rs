//! Signals of parts written in Python: attributes that the log has as columns of a topic of the part.

use std::sync::Arc;

use flexsc_core::control::part::{Occasion, ReportContext};
use flexsc_core::record::{CustomField, CustomTopic, CustomValue, Report};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyString;

use super::object::{Method, shape};

/// Kind of the value of an attribute.
#[derive(Copy, Clone, Debug)]
enum Held {
    Number,
    /// Sequence of this length.
    Numbers(usize),
    Word,
}

/// Signals of a part: the topic of their rows, and each attribute with what it holds.
#[derive(Clone, Debug)]
pub struct Signals {
    role: String,
    topic: Arc<CustomTopic>,
    attributes: Arc<[(String, Held)]>,
    /// True if the first column is the axis of the part.
    has_axis: bool,
}

impl Signals {
    /// Reads the attribute `signals` of a part of a role, such as `law` or `sensor1`; `None` without signals.
    pub fn from_python(part: &Bound<'_, PyAny>, role: &str, has_axis: bool) -> PyResult<Option<Self>> {
        let declared = part.getattr("signals")?;
        let wrong = |found: String| {
            PyTypeError::new_err(format!(
                "{role}: signals must map each attribute to its unit, to (unit, size), or to str for words, got {found}"
            ))
        };
        let items = declared.call_method0("items").map_err(|_| wrong(shape(&declared)))?;
        let axis = CustomField::new("axis", "", "Index of the axis about which the law acts.");
        let mut fields: Vec<CustomField> = has_axis.then_some(axis).into_iter().collect();
        let mut attributes = Vec::new();
        for item in items.try_iter()? {
            let (name, value): (String, Bound<'_, PyAny>) = item?.extract()?;
            let doc = format!("Attribute `{name}` of the {role}.");
            let held = if value.is(part.py().get_type::<PyString>()) {
                fields.push(CustomField::word(&name, doc));
                Held::Word
            } else if let Ok(unit) = value.extract::<String>() {
                fields.push(CustomField::new(&name, unit, doc));
                Held::Number
            } else if let Ok((unit, size)) = value.extract::<(String, usize)>() {
                let each = |index| CustomField::new(format!("{name}{index}"), &unit, &doc);
                fields.extend((0..size).map(each));
                Held::Numbers(size)
            } else {
                return Err(wrong(format!("{name}: {}", value.repr()?)));
            };
            attributes.push((name, held));
        }
        if attributes.is_empty() {
            return Ok(None);
        }
        let doc = format!("Signals of the {role}, which is written in Python.");
        let topic = CustomTopic::new(format!("/own_{role}"), doc, fields)
            .map_err(|error| PyValueError::new_err(format!("{role}: signals: {error}")))?;
        Ok(Some(Self { role: role.to_owned(), topic, attributes: attributes.into(), has_axis }))
    }

    /// Returns the topic of the signals as a list, empty without signals.
    pub fn topics(signals: Option<&Self>) -> Vec<Arc<CustomTopic>> {
        signals.map(|signals| Arc::clone(&signals.topic)).into_iter().collect()
    }

    /// Adds the row of the signals at a period of a full log; an error ends the run.
    pub fn report(
        signals: Option<&Self>,
        method: &Method,
        axis: usize,
        at: &ReportContext<'_>,
        report: &mut Report,
    ) {
        let Some(signals) = signals.filter(|_| at.occasion == Occasion::Period) else { return };
        let row = Python::attach(|py| {
            method.other(py, |part| {
                let row = signals.topic.row(signals.values(part, axis)?);
                row.map_err(|error| PyValueError::new_err(format!("{}: signals: {error}", signals.role)))
            })
        });
        if let Some(row) = row {
            report.add(row);
        }
    }

    /// Returns the values of the signals.
    fn values(&self, part: &Bound<'_, PyAny>, axis: usize) -> PyResult<Vec<CustomValue>> {
        let mut values: Vec<CustomValue> =
            self.has_axis.then_some(CustomValue::Number(axis as f64)).into_iter().collect();
        for (name, held) in &*self.attributes {
            let value = part.getattr(name.as_str())?;
            let wrong = || {
                let expected = match held {
                    Held::Number => "a number".to_owned(),
                    Held::Numbers(size) => format!("of shape ({size},)"),
                    Held::Word => "a str".to_owned(),
                };
                let (role, found) = (&self.role, shape(&value));
                PyTypeError::new_err(format!("{role}: the signal {name} must be {expected}, got {found}"))
            };
            match held {
                Held::Number => values.push(CustomValue::Number(value.extract().map_err(|_| wrong())?)),
                Held::Numbers(size) => {
                    let each = super::object::numbers(&value).map_err(|_| wrong())?;
                    if each.len() != *size {
                        return Err(wrong());
                    }
                    values.extend(each.into_iter().map(CustomValue::Number));
                }
                Held::Word => values.push(CustomValue::Word(value.extract().map_err(|_| wrong())?)),
            }
        }
        Ok(values)
    }
}
