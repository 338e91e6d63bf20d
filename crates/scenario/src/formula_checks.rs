//! Checks of requirements over time: `holds` with its keys, and the modes and conditions in which a requirement counts.

use flexsc_control::operation::{
    Comparison, ConditionFault, Expression, ModeCondition, ModeQuantity, RequirementNames, TimeWindow, Timed,
    Vocabulary, parse_instant, parse_trigger,
};
use flexsc_control::robustness::limit_scale;
use flexsc_control::sensor::SensorKind;
use flexsc_formats::document::{ConfigError, number_in};
use flexsc_numerics::quantity::Time;
use flexsc_spacecraft::body::BodyModel;

use super::assessed_requirement::{RequirementFormula, RequirementLimit, RequirementSource};
use super::requirement::{Requirement, given};
use super::spec::ScenarioSpec;
use crate::metric_descriptions;

/// Returns the limit of a requirement with `holds`, and the origin of its values.
///
/// # Errors
/// A key that does not go with it, or the part of a text that cannot be read.
pub(super) fn formula(
    written: &ScenarioSpec,
    model: &BodyModel,
    requirement: &Requirement,
    text: &str,
) -> Result<RequirementLimit, ConfigError> {
    let known = vocabulary(written);
    let at = |key: &str, why: &str| Err(ConfigError::new(key, why));
    let holds = at_key("holds", ModeCondition::new(text).parse(&known))?;
    if let Some(limit) = metric_limit(&holds, model, text)? {
        return match given(&requirement.scope_keys()).or(given(&requirement.time_keys())) {
            Some(key) => at(key, "is for quantities that change during a run, and `holds` limits a metric"),
            None => Ok(limit),
        };
    }
    validate_leaves(written, model, "holds", &holds)?;
    let measured = holds.measured();
    let limits: Vec<f64> = measured.iter().filter_map(|leaf| limit(leaf)).collect();
    if limits.contains(&0.0) && measured.len() > 1 {
        return at(
            "holds",
            "compares with 0 beside other conditions: a distance from 0 has a unit and is no part of a limit; give each a \
             requirement of its own",
        );
    }
    let is_timed = holds.has_timed(|_| true);
    let scope = scope(written, model, requirement)?;
    let key = if requirement.mode.is_some() { "mode" } else { "during" };
    if is_timed && scope.is_some() {
        return at(
            key,
            "is for a `holds` without operators over time: write `when mode enters NAME: ..` or `mode(NAME) implies ..` in it",
        );
    }
    let mut whole = holds.clone();
    if let Some(scope) = scope {
        whole = Expression::Timed(Box::new(Timed::While(scope, whole)));
    }
    let window = |time: Time| TimeWindow { from: 0.0, to: Some(time.get()) };
    let times = [requirement.held, requirement.within];
    if let Some(held) = requirement.held {
        whole = whole.always(window(held));
    }
    if let Some(within) = requirement.within {
        whole = whole.eventually(window(within));
    }
    if let Some(after) = &requirement.after {
        let event = at_key("after", parse_trigger(after, &known))?;
        validate_leaves(written, model, "after", &event)?;
        whole = Expression::Timed(Box::new(Timed::When(event, whole)));
    } else if !is_timed && times == [None; 2] {
        whole = whole.always(TimeWindow::REST);
    }
    if given(&requirement.time_keys()).is_some() && holds.has_timed(Timed::is_outermost) {
        return at("holds", "has `until` or `when`, which cannot be within `after`, `within` or `for`");
    }
    // With one upper limit, the value is that of the quantity.
    let (unit, limit, scale, written_limit) = match measured[..] {
        [Expression::Compared { quantity, comparison: Comparison::Below | Comparison::AtMost, limit }] => {
            (quantity.unit(), *limit, limit_scale(*limit), limit_text(text, quantity.unit(), *limit))
        }
        _ if limits.contains(&0.0) => ("", 0.0, 1.0, None),
        _ => ("", 1.0, 1.0, None),
    };
    let source = RequirementSource::Formula(Box::new(RequirementFormula {
        text: described(requirement, text),
        expression: whole,
        scale,
    }));
    Ok(RequirementLimit { source, unit, limit, written: written_limit })
}

/// Returns the condition at which a requirement counts, by its mode and the condition `during`; `None` if it always counts.
///
/// # Errors
/// A mode or a condition that cannot be read.
pub fn scope(
    written: &ScenarioSpec,
    model: &BodyModel,
    requirement: &Requirement,
) -> Result<Option<Expression>, ConfigError> {
    let known = vocabulary(written);
    let mut all = Vec::new();
    if let Some(name) = &requirement.mode {
        let Some(index) = known.modes.iter().position(|known| known == name) else {
            let why = if known.modes.is_empty() {
                format!("needs a `[[mode]]` in the scenario, got `{name}`")
            } else {
                format!("must name one of the modes, `{}`, got `{name}`", known.modes.join("`, `"))
            };
            return Err(ConfigError::new("mode", why));
        };
        all.push(Expression::Flag(ModeQuantity::Mode(index)));
    }
    if let Some(text) = &requirement.during {
        let read = at_key("during", parse_instant(text, &known))?;
        validate_leaves(written, model, "during", &read)?;
        all.push(read);
    }
    Ok(if all.len() < 2 { all.pop() } else { Some(Expression::All(all)) })
}

fn vocabulary(written: &ScenarioSpec) -> Vocabulary<'_> {
    Vocabulary {
        sensors: written.sensor.iter().map(SensorKind::kind).collect(),
        modes: written.mode.iter().map(|mode| mode.name.as_str()).collect(),
        numbers: None,
        requirement: Some(RequirementNames {
            faults: written.fault.iter().map(|fault| fault.name.as_str()).collect(),
            points: written.line_of_sight.iter().map(|line| line.point.as_str()).collect(),
            metrics: metric_descriptions::ALL.iter().map(|metric| (metric.name, metric.unit)).collect(),
        }),
    }
}

fn at_key(key: &str, read: Result<Expression, ConditionFault>) -> Result<Expression, ConfigError> {
    read.map_err(|ConditionFault { part, why }| ConfigError {
        part: Some(part),
        ..ConfigError::new(key, why)
    })
}

/// Returns the limit of a metric, if the expression has a metric.
fn metric_limit(
    holds: &Expression,
    model: &BodyModel,
    text: &str,
) -> Result<Option<RequirementLimit>, ConfigError> {
    let Some((index, element)) = holds.leaves().into_iter().find_map(|(quantity, _)| match quantity {
        ModeQuantity::Metric(index, element) => Some((index, element)),
        _ => None,
    }) else {
        return Ok(None);
    };
    let name = metric_descriptions::ALL[index].name;
    let Expression::Compared { comparison: Comparison::Below | Comparison::AtMost, limit, .. } = holds else {
        let why = format!(
            "limits the metric `{name}`, which has one value in a run: write `{name} < NUMBER` alone"
        );
        return Err(ConfigError::new("holds", why));
    };
    metric_descriptions::validate_limited(name).map_err(|why| ConfigError::new("holds", why))?;
    let unit = metric_descriptions::meaning(name, Some(model)).map_or("", |meaning| meaning.unit);
    Ok(Some(RequirementLimit {
        source: RequirementSource::Metric(name.to_owned(), element),
        unit,
        limit: *limit,
        written: limit_text(text, unit, *limit),
    }))
}

/// Checks that runs of the scenario have the quantities of an expression.
fn validate_leaves(
    written: &ScenarioSpec,
    model: &BodyModel,
    key: &str,
    expression: &Expression,
) -> Result<(), ConfigError> {
    let in_use = vec![true; written.sensor.len()];
    let offers = written.offers(model);
    let why = expression.leaves().into_iter().find_map(|(quantity, _)| match quantity {
        ModeQuantity::Metric(..) => Some("has a metric, which has one value in a run, as a condition"),
        ModeQuantity::LineOfSight(index) if written.line_of_sight[index].mirror.is_some() => Some(
            "has a line of sight with a `mirror`, which is known at its samples and not between them: write `quantity` and `limit` \
             in place of `holds`",
        ),
        quantity => written.unknown_quantity(quantity, &in_use, &offers),
    });
    why.map_or(Ok(()), |why| Err(ConfigError::new(key, why)))
}

fn limit(leaf: &Expression) -> Option<f64> {
    if let Expression::Compared { limit, .. } = leaf { Some(*limit) } else { None }
}

/// Returns the number of a text after a `<` that is the limit, if it was written with a unit.
fn limit_text(text: &str, unit: &str, limit: f64) -> Option<String> {
    let number = |after: &str| {
        let after = after.trim_start_matches('=');
        let end = after.find([')', ':', ';']).unwrap_or(after.len());
        let words = [" until", " and ", " or ", " implies "];
        let end = words.iter().filter_map(|word| after[..end].find(word)).fold(end, usize::min);
        let number = after[..end].trim();
        let has_unit = number.parse::<f64>().is_err() && number_in(number, unit) == Ok(limit);
        has_unit.then(|| number.to_owned())
    };
    text.split('<').skip(1).find_map(number)
}

/// Returns the requirement in words: `holds` with the other keys.
fn described(requirement: &Requirement, text: &str) -> String {
    let mut all = Vec::new();
    all.extend(requirement.after.as_ref().map(|after| format!("after {after}")));
    all.extend(requirement.within.map(|time| format!("within {} s", time.get())));
    all.extend(requirement.held.map(|time| format!("for {} s", time.get())));
    let scope = scope_words(requirement);
    let text = if scope.is_empty() { text.to_owned() } else { format!("{text}, {scope}") };
    if all.is_empty() { text } else { format!("{}: {text}", all.join(", ")) }
}

/// Returns the mode and the condition in which a requirement counts, in words; empty without them.
pub fn scope_words(requirement: &Requirement) -> String {
    let mode = requirement.mode.as_ref().map(|mode| format!("in mode {mode}"));
    let during = requirement.during.as_ref().map(|during| format!("during {during}"));
    mode.into_iter().chain(during).collect::<Vec<_>>().join(", ")
}
