//! Requirements over time for FRET of NASA, whose sentences Ogma and Copilot turn into monitors in flight.
//!
//! A sentence has a scope, a trigger, a component, a time and a condition. FRET reads its meaning from the text when the file is
//! imported; text in quotes has none.

use std::collections::BTreeMap;

use flexsc_core::Scenario;
use flexsc_core::answer::requirement_id;
use flexsc_core::control::operation::{Comparison, Expression, ModeQuantity, TimeWindow, Timed};
use flexsc_core::scenario::{AssessedRequirement, RequirementSource};
use serde_json::{Value as Json, json};

use super::error::HandoverError;

/// Requirements in FRET's form.
#[derive(Clone, Debug)]
pub struct FretRequirements {
    /// File for FRET.
    pub json: String,
    /// Identifiers of the requirements that are text alone, each with the reason.
    pub as_text: Vec<(String, &'static str)>,
}

/// Reason for which a requirement has no sentence.
type Absent = &'static str;

/// Names of the quantities in sentences.
struct FretNames<'a> {
    scenario: &'a Scenario,
    names: BTreeMap<String, ModeQuantity>,
}

impl FretNames<'_> {
    /// Returns the name of a quantity: letters, digits and underscores.
    fn name(&mut self, quantity: ModeQuantity) -> String {
        let mut name = identifier(&self.scenario.quantity_name(quantity));
        while *self.names.entry(name.clone()).or_insert(quantity) != quantity {
            name.push('_');
        }
        name
    }

    /// Returns a condition at one instant.
    fn condition(&mut self, expression: &Expression) -> Result<String, Absent> {
        let mut joined = |all: &[Expression], sign: &str| -> Result<String, Absent> {
            let all = all.iter().map(|own| self.condition(own)).collect::<Result<Vec<_>, _>>()?;
            Ok(format!("({})", all.join(sign)))
        };
        match expression {
            Expression::Compared { quantity, comparison, limit } => {
                let sign = match comparison {
                    Comparison::Below => "<",
                    Comparison::AtMost => "<=",
                    Comparison::Above => ">",
                    Comparison::AtLeast => ">=",
                };
                Ok(format!("({} {sign} {})", self.name(*quantity), number(*limit)))
            }
            Expression::Flag(quantity) => Ok(self.name(*quantity)),
            Expression::Not(inner) => Ok(format!("(! {})", self.condition(inner)?)),
            Expression::All(all) => joined(all, " & "),
            Expression::Any(any) => joined(any, " | "),
            Expression::Timed(timed) => match &**timed {
                Timed::While(scope, inner) => {
                    Ok(format!("({} => {})", self.condition(scope)?, self.condition(inner)?))
                }
                Timed::Until(..) => {
                    Err("`until` has to end within a window, and that of FRET does not have to end")
                }
                _ => Err("a sentence of FRET has one operator over time, and no joint of several"),
            },
        }
    }

    /// Returns the scope of a window of the run, such as "while (run_time >= 60) "; empty for the whole run.
    fn window(&mut self, window: TimeWindow, scope: Option<&Expression>) -> Result<String, Absent> {
        let ends = [
            (Comparison::AtLeast, Some(window.from).filter(|from| *from > 0.0)),
            (Comparison::AtMost, window.to),
        ];
        let ends = ends.into_iter().filter_map(|(comparison, limit)| {
            Some(Expression::Compared { quantity: ModeQuantity::RunTime, comparison, limit: limit? })
        });
        let all: Vec<Expression> = ends.chain(scope.cloned()).collect();
        let condition = match all.len() {
            0 => return Ok(String::new()),
            1 => self.condition(&all[0])?,
            _ => self.condition(&Expression::All(all))?,
        };
        Ok(format!("while {condition} "))
    }

    /// Returns the sentence of an expression at the start of the run.
    fn sentence(&mut self, expression: &Expression) -> Result<String, Absent> {
        let craft = component(self.scenario);
        if let Some((window, inner)) = expression.as_eventually() {
            let (scope, time) = match window {
                TimeWindow { from: 0.0, to: Some(to) } => {
                    (String::new(), format!("within {} seconds", number(to)))
                }
                window => (self.window(window, None)?, "eventually".to_owned()),
            };
            return Ok(format!("{scope}the {craft} shall {time} satisfy {}", self.condition(inner)?));
        }
        let Expression::Timed(timed) = expression else {
            return Ok(format!("the {craft} shall immediately satisfy {}", self.condition(expression)?));
        };
        match &**timed {
            Timed::Always(window, inner) => {
                let (scope, inner) = match inner {
                    Expression::Timed(timed) => match &**timed {
                        Timed::While(scope, inner) => (Some(scope), inner),
                        _ => (None, inner),
                    },
                    inner => (None, inner),
                };
                let scope = self.window(*window, scope)?;
                Ok(format!("{scope}the {craft} shall always satisfy {}", self.condition(inner)?))
            }
            Timed::When(event, then) => {
                let from_event = |window: TimeWindow, word: &str, rest: &str| match window {
                    TimeWindow { from: 0.0, to: None } => Ok(rest.to_owned()),
                    TimeWindow { from: 0.0, to: Some(to) } => Ok(format!("{word} {} seconds", number(to))),
                    _ => Err("a time of FRET begins at its trigger"),
                };
                let (time, inner) = match (then.as_eventually(), then) {
                    (Some((window, inner)), _) => (from_event(window, "within", "eventually")?, inner),
                    (None, Expression::Timed(timed)) => match &**timed {
                        Timed::Always(window, inner) => (from_event(*window, "for", "always")?, inner),
                        _ => ("immediately".to_owned(), then),
                    },
                    _ => ("immediately".to_owned(), then),
                };
                let trigger = self.condition(event)?;
                Ok(format!("upon {trigger} the {craft} shall {time} satisfy {}", self.condition(inner)?))
            }
            _ => Err(self.condition(expression).err().unwrap_or("it has no operator of FRET")),
        }
    }
}

/// Returns the requirements of a scenario for FRET: a sentence for each over time, where FRET has one, and else its text.
///
/// # Errors
/// A scenario without requirements.
pub fn fret_requirements(scenario: &Scenario) -> Result<FretRequirements, HandoverError> {
    let all = &scenario.study.requirements;
    if all.is_empty() {
        return Err(HandoverError::refused(
            &format!("{}: has no [[requirement]]", scenario.name),
            "`holds` says what must hold when",
        ));
    }
    let (project, craft) = (scenario.name.as_str(), component(scenario));
    let mut names = FretNames { scenario, names: BTreeMap::new() };
    let (mut requirements, mut as_text) = (Vec::new(), Vec::new());
    for (index, own) in all.iter().enumerate() {
        let id = requirement_id(index);
        let sentence = match &own.source {
            RequirementSource::Formula(_) if own.level < 1.0 => Err("a level below 1 is of many runs"),
            RequirementSource::Formula(formula) => names.sentence(&formula.expression),
            RequirementSource::Error(_) => Err("a pointing index is a statistic of samples"),
            RequirementSource::Metric(..) => Err("a metric has one value in a run"),
        };
        let (text, rationale) = match sentence {
            Ok(text) => (text, own.description()),
            Err(why) => {
                as_text.push((id.clone(), why));
                (format!("\"{}\"", in_words(own).replace(['"', '\\'], "'")), format!("No sentence: {why}."))
            }
        };
        requirements.push(json!({
            "reqid": id,
            "parent_reqid": "",
            "project": project,
            "rationale": format!("{}: {rationale}", own.name),
            "fulltext": text,
        }));
    }
    let variable = |(name, quantity): (&String, &ModeQuantity)| -> Json {
        let (kind, unit) = if quantity.is_boolean() { ("boolean", "") } else { ("double", quantity.unit()) };
        let unit = if unit.is_empty() { String::new() } else { format!(" ({unit})") };
        json!({
            "_id": format!("{project}{craft}{name}"),
            "project": project,
            "component_name": craft,
            "variable_name": name,
            "reqs": [],
            "dataType": kind,
            "idType": "Input",
            "moduleName": "",
            "description": format!("{}{unit}", scenario.quantity_name(*quantity)),
            "assignment": "",
            "copilotAssignment": "",
            "modeRequirement": "",
            "modeldoc": false,
            "modelComponent": "",
            "modeldoc_id": "",
            "completed": true,
        })
    };
    let variables: Vec<Json> = names.names.iter().map(variable).collect();
    let json = format!("{:#}\n", json!({ "requirements": requirements, "variables": variables }));
    Ok(FretRequirements { json, as_text })
}

/// Returns a requirement in words, with the limit of an index or a metric.
fn in_words(own: &AssessedRequirement) -> String {
    let unit = if own.unit.is_empty() { String::new() } else { format!(" {}", own.unit) };
    let limit = own.written_limit.clone().unwrap_or_else(|| format!("{}{unit}", own.limit));
    match own.source {
        RequirementSource::Formula(_) => own.description(),
        _ => format!("{}, at most {limit}", own.description()),
    }
}

/// Returns the name of the component that is to meet the requirements.
fn component(scenario: &Scenario) -> String {
    identifier(&scenario.name)
}

/// Returns a name of letters, digits and underscores that begins with a letter.
fn identifier(name: &str) -> String {
    let name: String = name.chars().map(|own| if own.is_ascii_alphanumeric() { own } else { '_' }).collect();
    let name = name.trim_matches('_');
    if name.starts_with(|first: char| first.is_ascii_alphabetic()) {
        name.to_owned()
    } else {
        format!("craft_{name}")
    }
}

/// Returns a number as FRET reads it.
fn number(value: f64) -> String {
    if value == 0.0 || (1e-4..1e9).contains(&value.abs()) { format!("{value}") } else { format!("{value:e}") }
}
