//! Template filters and tests for numbers and lists of numbers.

#![expect(clippy::needless_pass_by_value, reason = "templates hand their values over")]

use flexsc_core::statistics::quantile as quantile_of;
use minijinja::value::{Serde, Value};
use minijinja::{Environment, Error, ErrorKind};
use serde::Deserialize;

/// Registers the filters and tests for numbers in a template environment.
pub fn register(environment: &mut Environment) {
    environment.add_filter("sci", |value: f64, digits: usize| format!("{value:.digits$e}"));
    environment.add_filter("fixed", |value: f64, digits: usize| format!("{:.digits$}", positive_zero(value)));
    environment.add_filter("percent", |value: f64, digits: usize| format!("{:.digits$} %", 100.0 * value));
    environment.add_filter("grouped", grouped);
    environment
        .add_filter("zero_below", |value: f64, least: f64| if value.abs() < least { 0.0 } else { value });
    // Smaller values are rounding errors.
    environment.add_filter(
        "small",
        |value: f64| if value < 1e-12 { "0".to_owned() } else { format!("{value:.3e}") },
    );
    environment.add_filter("numbers", |list: Vec<Value>| finite(&list));
    environment.add_filter("known", |list: Vec<Value>| finite(&list).len());
    environment.add_filter("mean", |list: Vec<Value>| mean(&finite(&list)));
    environment.add_filter("spread", |list: Vec<Value>| spread(&finite(&list)));
    environment.add_filter("least", |list: Vec<Value>| some(finite(&list).into_iter().reduce(f64::min)));
    environment.add_filter("most", |list: Vec<Value>| some(finite(&list).into_iter().reduce(f64::max)));
    environment.add_filter("median", |list: Vec<Value>| quantile(&list, 0.5));
    environment.add_filter("quantile", |list: Vec<Value>, part: f64| quantile(&list, part));
    environment.add_filter("above", |list: Vec<Value>, limit: f64| {
        finite(&list).iter().filter(|v| **v > limit).count()
    });
    environment.add_filter("below", |list: Vec<Value>, limit: f64| {
        finite(&list).iter().filter(|v| **v < limit).count()
    });
    environment.add_filter("sooner", |a: Vec<Value>, b: Vec<Value>| pairs(&a, &b, |a, b| a < b));
    environment.add_filter("equal", |a: Vec<Value>, b: Vec<Value>| pairs(&a, &b, |a, b| a == b));
    environment.add_filter("first_below", |list: Vec<f64>, limit: f64| list.iter().position(|v| *v < limit));
    environment.add_filter("last_below", |list: Vec<f64>, limit: f64| list.iter().rposition(|v| *v < limit));
    environment.add_filter("acos", |value: f64| value.acos());
    environment.add_filter("nth", |list: Vec<Value>, place: usize| list.into_iter().nth(place));
    environment.add_filter("fill", fill);
    environment.add_filter("as_schedule", as_schedule);
    environment.add_filter("by", by);
    environment.add_filter("within", |list: Vec<Value>, keys: Vec<f64>, low: f64, high: f64| {
        within(&list, &keys, low, high)
    });
    environment.add_filter("place", place);
    environment.add_filter("from_place", |list: Vec<Value>, place: usize| {
        list.into_iter().skip(place).collect::<Vec<_>>()
    });
    // Tests of a missing number fail.
    environment.add_test("near", |value: Option<f64>, reference: f64, part: f64| {
        value.is_some_and(|value| (value - reference).abs() <= part * reference.abs())
    });
    environment.add_test("between", |value: Option<f64>, low: f64, high: f64| {
        value.is_some_and(|value| low <= value && value <= high)
    });
    environment.add_test("rounds_to", rounds_to);
}

/// Formats an integer with groups of thousands.
fn grouped(value: f64) -> String {
    let digits = format!("{:.0}", value.abs());
    let first = digits.len() % 3;
    let mut text = if value < 0.0 { "-".to_owned() } else { String::new() };
    // Four digits are not grouped, as in the rest of the text.
    if digits.len() < 5 {
        return text + &digits;
    }
    text.push_str(&digits[..first]);
    for start in (first..digits.len()).step_by(3) {
        if start > 0 {
            text.push(' ');
        }
        text.push_str(&digits[start..start + 3]);
    }
    text
}

/// Returns true if a number, rounded to the digits of a printed one, equals it.
fn rounds_to(value: Option<f64>, printed: &str) -> Result<bool, Error> {
    let decimals = printed.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    if printed.parse::<f64>().is_err() {
        let why = format!("`{printed}` is no number");
        return Err(Error::new(ErrorKind::InvalidOperation, why));
    }
    Ok(value.is_some_and(|value| format!("{value:.decimals$}") == printed))
}

/// Removes the sign of a negative zero.
fn positive_zero(value: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value }
}

/// Returns the finite numbers of a list, without missing ones.
fn finite(list: &[Value]) -> Vec<f64> {
    let number = |value: &Value| f64::try_from(value.clone()).ok().filter(|value| value.is_finite());
    list.iter().filter_map(number).collect()
}

fn some(value: Option<f64>) -> Value {
    value.map_or(Value::from(()), Value::from)
}

fn mean(list: &[f64]) -> f64 {
    list.iter().sum::<f64>() / list.len() as f64
}

/// Returns the standard deviation divided by the mean.
fn spread(list: &[f64]) -> f64 {
    let mean = mean(list);
    let squares: f64 = list.iter().map(|value| (value - mean) * (value - mean)).sum();
    (squares / list.len() as f64).sqrt() / mean
}

/// Returns a quantile of the numbers of a list, interpolated as in the statistics of campaigns.
fn quantile(list: &[Value], part: f64) -> Value {
    let mut sorted = finite(list);
    sorted.sort_by(f64::total_cmp);
    let quantile = quantile_of(&sorted, part);
    some(Some(quantile).filter(|value| value.is_finite()))
}

/// Counts the pairs of two lists that satisfy a condition.
fn pairs(a: &[Value], b: &[Value], fits: impl Fn(f64, f64) -> bool) -> usize {
    // A missing event counts as later than all others.
    let number = |value: &Value| f64::try_from(value.clone()).unwrap_or(f64::INFINITY);
    let both = a.iter().map(number).zip(b.iter().map(number));
    both.filter(|(a, b)| fits(*a, *b)).count()
}

/// Returns the values of a list whose keys lie within a range.
fn within(list: &[Value], keys: &[f64], low: f64, high: f64) -> Vec<Value> {
    let inside = |key: &f64| (low - 1e-9..=high + 1e-9).contains(key);
    list.iter().zip(keys).filter(|(_, key)| inside(key)).map(|(value, _)| value.clone()).collect()
}

/// Returns the key at which a list has the given value.
fn place(value: f64, list: Vec<Value>, keys: Vec<f64>) -> Value {
    let number = |value: &Value| f64::try_from(value.clone()).ok();
    some(
        list.iter().position(|other| number(other) == Some(value)).and_then(|index| keys.get(index).copied()),
    )
}

/// Replaces the placeholders `{}` of a command by values.
fn fill(command: String, values: Vec<f64>) -> String {
    values.iter().fold(command, |command, value| command.replacen("{}", &format!("{value:?}"), 1))
}

/// A point of a schedule, as `flexsc tune --json` has it.
#[derive(Deserialize)]
struct Point {
    /// Frequency (rad/s).
    frequency: f64,
    gain: f64,
}

/// Formats the points of a schedule as in a scenario.
fn as_schedule(points: Serde<Vec<Point>>) -> String {
    let point = |Point { frequency, gain }: &Point| format!("{{frequency={frequency:.6}, gain={gain:.4}}}");
    points.0.iter().map(point).collect::<Vec<_>>().join(", ")
}

/// Maps objects by the value of one of their keys.
fn by(list: Vec<Value>, key: &str) -> Result<Value, Error> {
    let pair = |object: Value| Ok((object.get_attr(key)?, object));
    Ok(Value::from_pairs(list.into_iter().map(pair).collect::<Result<Vec<_>, Error>>()?))
}
