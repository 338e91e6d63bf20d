//! Checks of the tables `[[requirement]]`, which become the requirements that are assessed.

use flexsc_control::operation::ModeQuantity;
use flexsc_formats::document::{ConfigError, nearest};
use flexsc_numerics::quantity::{Positive, Share, Time};
use flexsc_numerics::time::{Instant, Span};
use flexsc_spacecraft::body::BodyModel;

use super::assessed_requirement::{
    AssessedRequirement, IndexWindow, RequirementLimit, RequirementSource, SampledError, SampledQuantity,
};
use super::contrast_requirement::{ContrastRequirement, MTF};
use super::formula_checks::{formula, scope, scope_words};
use super::requirement::{ErrorAxis, Interpretation, Limit, PointingIndex, Requirement, given};
use super::spec::ScenarioSpec;
use crate::metric_descriptions;

/// Name of the requirement of `reference.pointing.rms`.
pub const POINTING_RMS: &str = "pointing";
/// Metric of the requirement of `reference.pointing.rms`.
const POINTING_METRIC: &str = "pointing_rms_rad";
/// Largest number of samples that a requirement assesses in a run.
pub const MOST_SAMPLES: u64 = 1_000_000;
/// Largest number of requirements.
const MOST_REQUIREMENTS: usize = 1000;
/// Part of a sampling period by which a window may differ from a whole number of them.
const ROUNDING: f64 = 1e-6;
/// Quantities that are sampled.
const SAMPLED: [&str; 3] = ["pointing_error", "rate_error", "line_of_sight"];

/// Requirements of a scenario.
#[derive(Default)]
pub struct CheckedRequirements {
    /// Requirements that runs are judged by, that of `reference.pointing.rms` first.
    pub of_runs: Vec<AssessedRequirement>,
    /// Requirements on the contrast of an image.
    pub of_contrast: Vec<ContrastRequirement>,
}

/// Returns the requirements of a scenario, and adds the errors of those that are inconsistent; `period` is the default sampling period.
pub fn assessed(
    written: &ScenarioSpec,
    model: &BodyModel,
    period: Span,
    errors: &mut Vec<ConfigError>,
) -> CheckedRequirements {
    let pointing = written.reference.pointing.as_ref().and_then(|pointing| pointing.rms);
    let pointing = pointing.map(|most| AssessedRequirement {
        name: POINTING_RMS.to_owned(),
        source: RequirementSource::Metric(POINTING_METRIC.to_owned(), None),
        unit: "rad",
        limit: most.get(),
        written_limit: None,
        level: 1.0,
        interpretation: Interpretation::Ensemble,
        confidence: None,
    });
    let mut all = CheckedRequirements { of_runs: pointing.into_iter().collect(), of_contrast: Vec::new() };
    if written.requirement.len() > MOST_REQUIREMENTS {
        let why = format!("has at most {MOST_REQUIREMENTS} tables, got {}", written.requirement.len());
        errors.push(ConfigError::new("requirement", why));
        return all;
    }
    let context = Context { written, model, period };
    for (index, requirement) in written.requirement.iter().enumerate() {
        let (key, name) = (format!("requirement[{index}]"), &requirement.name);
        let is_taken = all.of_runs.iter().any(|other| other.name == *name)
            || all.of_contrast.iter().any(|other| other.name == *name);
        if name.is_empty() || is_taken {
            let why = format!("must be a name of its own, got `{name}`");
            errors.push(ConfigError::new("name", why).within(&key));
        }
        let judged = if requirement.is_of_contrast() {
            context.contrast(requirement, &key).map(|own| all.of_contrast.push(own))
        } else {
            context.assess(requirement).map(|own| all.of_runs.push(own))
        };
        errors.extend(judged.err().map(|error| error.within(&key)));
    }
    all
}

/// Scenario of the requirements.
struct Context<'a> {
    written: &'a ScenarioSpec,
    model: &'a BodyModel,
    period: Span,
}

impl Context<'_> {
    fn contrast(&self, requirement: &Requirement, key: &str) -> Result<ContrastRequirement, ConfigError> {
        let line = match self.line_of_sight(requirement)? {
            SampledQuantity::LineOfSight(index, point) => (index, point),
            SampledQuantity::PointingError | SampledQuantity::RateError => (0, String::new()),
        };
        requirement.contrast(key, line)
    }

    fn assess(&self, requirement: &Requirement) -> Result<AssessedRequirement, ConfigError> {
        if let Some(key) = given(&requirement.contrast_keys()) {
            return Err(ConfigError::new(key, "is for `quantity = \"mtf\"`, the contrast of an image"));
        }
        let at = |key: &str, why: String| Err(ConfigError::new(key, why));
        if let [first, others @ ..] = &absent_keys(requirement)[..]
            && !others.is_empty()
        {
            let verb = if others.len() == 1 { "is" } else { "are" };
            return at(first, format!("is missing, and so {verb} `{}`", others.join("`, `")));
        }
        let RequirementLimit { source, unit, limit, written } = match &requirement.holds {
            Some(text) => {
                let keys =
                    [("quantity", requirement.quantity.is_some()), ("limit", requirement.limit.is_some())];
                if let Some(key) = given(&keys).or(given(&requirement.index_keys())) {
                    let why = "must be left out beside `holds`, which has a quantity and its limit";
                    return at(key, why.to_owned());
                }
                formula(self.written, self.model, requirement, text)?
            }
            None => self.limited(requirement)?,
        };
        if limit.is_nan() || limit < 0.0 && matches!(source, RequirementSource::Error(_)) {
            return at("limit", format!("must be 0 or more, got {limit}"));
        }
        let level = requirement.level.map_or(1.0, Share::get);
        let is_metric = !matches!(source, RequirementSource::Error(_));
        let interpretation = match requirement.interpretation {
            Some(word) if is_metric && word != Interpretation::Ensemble => {
                let why = format!("of a value that each run has once, is `ensemble`, got `{}`", word.word());
                return at("interpretation", why);
            }
            None if !is_metric && level < 1.0 => {
                let why = "is missing: a `level` below 1 means a fraction of the time in the worst run (`temporal`), of the \
                           runs (`ensemble`), or of both (`mixed`)";
                return at("interpretation", why.to_owned());
            }
            word => word.unwrap_or_default(),
        };
        if requirement.confidence.is_some() {
            if level >= 1.0 {
                let why = "needs a `level` below 1: no number of runs shows that all others meet a limit";
                return at("confidence", why.to_owned());
            }
            if interpretation != Interpretation::Ensemble {
                let why = format!(
                    "is for `interpretation = \"ensemble\"`, got `{}`: the values of one run depend on each other",
                    interpretation.word()
                );
                return at("confidence", why);
            }
        }
        Ok(AssessedRequirement {
            name: requirement.name.clone(),
            source,
            unit,
            limit,
            written_limit: written,
            level,
            interpretation,
            confidence: requirement.confidence.map(flexsc_numerics::quantity::Fraction::get),
        })
    }

    /// Returns the origin, the unit and the limit of a requirement on a quantity.
    fn limited(&self, requirement: &Requirement) -> Result<RequirementLimit, ConfigError> {
        let missing =
            |key: &str, other: &str| ConfigError::new(key, format!("is missing: a requirement has {other}"));
        let Some(quantity) = &requirement.quantity else {
            return Err(missing("quantity", "a `quantity` with its `limit`, or `holds`"));
        };
        let Some(limit) = &requirement.limit else {
            return Err(missing("limit", "a `limit` on its `quantity`"));
        };
        if let Some(key) = given(&requirement.time_keys()) {
            let why = format!(
                "is for `holds`: write `holds = \"{quantity} < LIMIT\"` in place of `quantity` and `limit`"
            );
            return Err(ConfigError::new(key, why));
        }
        let (source, unit) = self.source(requirement, quantity)?;
        let value = limit.in_unit(unit).map_err(|why| ConfigError::new("limit", why))?;
        let written = match limit {
            Limit::Text(text) => Some(text.clone()),
            Limit::Number(_) => None,
        };
        Ok(RequirementLimit { source, unit, limit: value, written })
    }

    /// Returns the origin of the values of a quantity and their unit.
    fn source(
        &self,
        requirement: &Requirement,
        name: &str,
    ) -> Result<(RequirementSource, &'static str), ConfigError> {
        let quantity = match name {
            "pointing_error" => SampledQuantity::PointingError,
            "rate_error" => SampledQuantity::RateError,
            "line_of_sight" => self.line_of_sight(requirement)?,
            name => return metric_source(requirement, name, self.model),
        };
        let unit = if quantity == SampledQuantity::RateError { "rad/s" } else { "rad" };
        if requirement.point.is_some() && !matches!(quantity, SampledQuantity::LineOfSight(..)) {
            let why = format!("is that of a `line_of_sight`, and the quantity is `{name}`");
            return Err(ConfigError::new("point", why));
        }
        if let Some(axis) =
            requirement.axis.filter(|axis| self.model.one_axis().is_some() && *axis != ErrorAxis::X)
        {
            let why = format!("must be `x`, the only axis of this body, got `{}`", axis.name());
            return Err(ConfigError::new("axis", why));
        }
        Ok((RequirementSource::Error(self.error(requirement, quantity)?), unit))
    }

    fn line_of_sight(&self, requirement: &Requirement) -> Result<SampledQuantity, ConfigError> {
        let lines = &self.written.line_of_sight;
        let points: Vec<&str> = lines.iter().map(|line| line.point.as_str()).collect();
        let why = match &requirement.point {
            _ if points.is_empty() => format!(
                "`{}` needs a `[[line_of_sight]]` in the scenario",
                requirement.quantity.as_deref().unwrap_or("line_of_sight")
            ),
            None => format!("is missing: the point of one of the lines of sight, `{}`", points.join("`, `")),
            Some(point) => match points.iter().filter(|other| *other == point).count() {
                1 => {
                    let index = points.iter().position(|other| other == point).unwrap_or(0);
                    return Ok(SampledQuantity::LineOfSight(index, point.clone()));
                }
                0 => format!(
                    "must be the point of one of the lines of sight, `{}`, got `{point}`",
                    points.join("`, `")
                ),
                count => format!("must be the point of one line of sight, and `{point}` has {count}"),
            },
        };
        Err(ConfigError::new(if points.is_empty() { "quantity" } else { "point" }, why))
    }

    fn error(
        &self,
        requirement: &Requirement,
        quantity: SampledQuantity,
    ) -> Result<SampledError, ConfigError> {
        let at = |key: &str, why: String| Err(ConfigError::new(key, why));
        let period = match (&quantity, requirement.period) {
            (SampledQuantity::LineOfSight(index, _), None) => self.written.line_of_sight[*index].period,
            (SampledQuantity::LineOfSight(..), Some(_)) => {
                return at("period", "is that of the `[[line_of_sight]]`: leave it out".to_owned());
            }
            (_, period) => period.unwrap_or(self.period),
        };
        let end = Instant::START + self.written.duration;
        let time = |time: Time| Instant::START + Span::from_seconds(time.get());
        let from = requirement.from.map_or(Instant::START, time);
        let to = requirement.to.map_or(end, |to| time(to).min(end));
        if let Some((from, to)) = requirement.from.zip(requirement.to)
            && from.get() >= to.get()
        {
            return at("to", format!("must be after `from`, {} s, got {} s", from.get(), to.get()));
        }
        // A line of sight is sampled from the start of the run on, an error from `from` on.
        let is_line = matches!(quantity, SampledQuantity::LineOfSight(..));
        let samples = if from > to {
            0
        } else if is_line {
            let before = if from == Instant::START {
                0
            } else {
                count(from.before(Span::TICK).since(Instant::START), period)
            };
            count(to.since(Instant::START), period) - before
        } else {
            count(to.since(from), period)
        };
        if samples > MOST_SAMPLES {
            let why = format!(
                "samples the error {samples} times, every {} s: at most {MOST_SAMPLES} are allowed",
                period.seconds()
            );
            return at(if requirement.period.is_some() { "period" } else { "quantity" }, why);
        }
        let index = index_window(requirement, period.seconds())?;
        let scope = scope(self.written, self.model, requirement)?;
        let reads_line = |(quantity, _): &(ModeQuantity, _)| matches!(quantity, ModeQuantity::LineOfSight(_));
        if scope.as_ref().is_some_and(|scope| scope.leaves().iter().any(reads_line)) {
            let why = "has a `line_of_sight`, which limits the time of a `holds` and not samples: write `holds` in place of \
                       `quantity` and `limit`";
            return at("during", why.to_owned());
        }
        let scope = scope.map(|scope| (scope, scope_words(requirement)));
        Ok(SampledError { quantity, axis: requirement.axis, index, period, from, to, samples, scope })
    }
}

/// Returns the number of samples in a span, at its start and after each period.
fn count(span: Span, period: Span) -> u64 {
    let femtoseconds = |span: Span| (Instant::START + span).femtoseconds();
    u64::try_from(femtoseconds(span) / femtoseconds(period).max(1)).unwrap_or(u64::MAX - 1) + 1
}

/// Returns the keys that a requirement on an error needs and does not have.
fn absent_keys(requirement: &Requirement) -> Vec<&'static str> {
    let quantity = requirement.quantity.as_deref().unwrap_or_default();
    let is_sight = quantity == "line_of_sight";
    if !is_sight && !["pointing_error", "rate_error"].contains(&quantity) {
        return Vec::new();
    }
    let index = requirement.index.unwrap_or(PointingIndex::Absolute);
    let is_difference = matches!(index, PointingIndex::Drift | PointingIndex::Reproducibility);
    let is_partial = requirement.level.is_some_and(|level| level.get() < 1.0);
    let absent = [
        ("point", is_sight && requirement.point.is_none()),
        ("window", index != PointingIndex::Absolute && requirement.window.is_none()),
        ("convention", index == PointingIndex::Relative && requirement.convention.is_none()),
        ("shift", is_difference && requirement.shift.is_none()),
        ("interpretation", is_partial && requirement.interpretation.is_none()),
    ];
    absent.into_iter().filter(|(_, is_absent)| *is_absent).map(|(key, _)| key).collect()
}

/// Returns the index of a requirement with its window in samples.
fn index_window(requirement: &Requirement, period: f64) -> Result<IndexWindow, ConfigError> {
    let at = |key: &str, why: String| Err(ConfigError::new(key, why));
    let index = requirement.index.unwrap_or(PointingIndex::Absolute);
    let is_difference = matches!(index, PointingIndex::Drift | PointingIndex::Reproducibility);
    let misplaced = [
        ("window", requirement.window.is_some() && index == PointingIndex::Absolute, "MPE, RPE, PDE and PRE"),
        ("convention", requirement.convention.is_some() && index != PointingIndex::Relative, "RPE"),
        ("shift", requirement.shift.is_some() && !is_difference, "PDE and PRE"),
    ];
    if let Some((key, _, indices)) = misplaced.into_iter().find(|(_, is_given, _)| *is_given) {
        return at(key, format!("is for {indices}, and the index is {index}"));
    }
    let samples = |key: &str, length: Option<Positive>| {
        let Some(length) = length.map(Positive::get) else {
            return Err(ConfigError::new(key, format!("is missing: {index} needs it (s)")));
        };
        let (ratio, whole) = (length / period, (length / period).round());
        if whole < 1.0 || (ratio - whole).abs() > ROUNDING * whole || whole > MOST_SAMPLES as f64 {
            let why = format!(
                "must be a whole number of sampling periods of {period} s, at most {MOST_SAMPLES}, got {length} s"
            );
            return Err(ConfigError::new(key, why));
        }
        Ok(whole as u64)
    };
    if index == PointingIndex::Absolute {
        return Ok(IndexWindow::Absolute);
    }
    let window = samples("window", requirement.window)?;
    match index {
        PointingIndex::Relative if window < 2 => {
            at("window", format!("must contain at least two samples, which are {period} s apart"))
        }
        PointingIndex::Relative => {
            let Some(convention) = requirement.convention else {
                let why = "is missing: RPE depends on the position of the instant in its window, `uniform`, `end` or `middle`";
                return at("convention", why.to_owned());
            };
            Ok(IndexWindow::Relative { window, convention })
        }
        PointingIndex::Drift | PointingIndex::Reproducibility => {
            let shift = samples("shift", requirement.shift)?;
            if shift < window {
                return at("shift", "must be at least the window: the two windows do not overlap".to_owned());
            }
            Ok(IndexWindow::Difference { window, shift, index })
        }
        PointingIndex::Absolute | PointingIndex::Mean => Ok(IndexWindow::Mean { window }),
    }
}

/// Returns a metric as the origin of a requirement's values, and its unit.
fn metric_source(
    requirement: &Requirement,
    name: &str,
    model: &BodyModel,
) -> Result<(RequirementSource, &'static str), ConfigError> {
    let at = |key: &str, why: String| Err(ConfigError::new(key, why));
    let (list, element) =
        metric_descriptions::list_element(name).map_or((name, None), |(list, index)| (list, Some(index)));
    let known = metric_descriptions::meaning(list, Some(model));
    let Some(meaning) = known else {
        let names: Vec<&str> = SAMPLED
            .into_iter()
            .chain([MTF])
            .chain(metric_descriptions::ALL.iter().map(|meaning| meaning.name))
            .collect();
        let hint = nearest(name, &names).map_or_else(
            || "`flexsc schema --metrics` lists them".to_owned(),
            |close| format!("did you mean `{close}`?"),
        );
        let why = format!("must be `{}` or a metric, got `{name}`; {hint}", SAMPLED.join("`, `"));
        return at("quantity", why);
    };
    metric_descriptions::validate_limited(list).map_err(|why| ConfigError::new("quantity", why))?;
    if let Some(key) = given(&requirement.index_keys()).or(given(&requirement.scope_keys())) {
        let why = format!("is for `{}`, and the quantity is the metric `{list}`", SAMPLED.join("`, `"));
        return at(key, why);
    }
    Ok((RequirementSource::Metric(list.to_owned(), element), meaning.unit))
}
