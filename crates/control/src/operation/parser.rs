//! Parser of conditions and requirements: comparisons joined by `and` and `or`, `not`, and brackets; of requirements also
//! `implies`, and the operators over time.

mod timed;

use std::ops::Range;

use flexsc_formats::document::{nearest, number_in};

use super::condition::{Comparison, ConditionFault, Expression, Vocabulary};
use super::quantity::{ModeQuantity, ModeWord};

/// Largest length of a condition (bytes), and largest depth of its brackets.
const LONGEST: usize = 1000;
const DEEPEST: usize = 32;
/// Comparisons, the longer ones first.
const COMPARISONS: [(&str, Comparison); 4] = [
    ("<=", Comparison::AtMost),
    (">=", Comparison::AtLeast),
    ("<", Comparison::Below),
    (">", Comparison::Above),
];

/// Words that end a number.
const JOINTS: [&str; 4] = ["and", "or", "until", "implies"];
/// Signs by which programming languages join and negate conditions, the longer ones first, with the words for them.
const FOREIGN_SIGNS: [(&str, &str); 5] =
    [("&&", "and"), ("&", "and"), ("||", "or"), ("|", "or"), ("!", "not")];

/// Reads a condition, or a requirement if the vocabulary is that of one.
pub(super) fn parse(text: &str, known: &Vocabulary<'_>) -> Result<Expression, ConditionFault> {
    parse_whole(text, known, Parser::formula)
}

/// Reads a condition of a requirement without operators over time.
///
/// # Errors
/// The first part that is no such condition, and the reason.
pub fn parse_instant(text: &str, known: &Vocabulary<'_>) -> Result<Expression, ConditionFault> {
    parse_whole(text, known, Parser::instant)
}

/// Reads an event after which a requirement holds: `mode enters NAME`, or a condition that becomes true.
///
/// # Errors
/// The first part that is no event, and the reason.
pub fn parse_trigger(text: &str, known: &Vocabulary<'_>) -> Result<Expression, ConditionFault> {
    parse_whole(text, known, Parser::trigger)
}

/// Reads a text to its end.
fn parse_whole<'a>(
    text: &'a str,
    known: &'a Vocabulary<'a>,
    read: impl FnOnce(&mut Parser<'a>) -> Result<Expression, ConditionFault>,
) -> Result<Expression, ConditionFault> {
    if text.len() > LONGEST {
        let why = format!("has at most {LONGEST} bytes, and this one has {}", text.len());
        return Err(ConditionFault { part: 0..text.len(), why });
    }
    let mut parser = Parser { text, at: 0, known, depth: 0, place: Place::Outermost };
    let condition = read(&mut parser)?;
    parser.skip_spaces();
    if parser.at < text.len() {
        let part = parser.next_part();
        let found = &text[part.clone()];
        return Err(fault(part, format!("must end or go on with {}, got `{found}`", parser.joints())));
    }
    Ok(condition)
}

fn fault(part: Range<usize>, why: impl Into<String>) -> ConditionFault {
    ConditionFault { part, why: why.into() }
}

/// Reader of a text from left to right.
struct Parser<'a> {
    text: &'a str,
    /// Byte of the text that is read next.
    at: usize,
    known: &'a Vocabulary<'a>,
    depth: usize,
    place: Place,
}

/// Place of a part in a requirement, by the operators over time that the part may have.
#[derive(Copy, Clone, PartialEq, Eq)]
enum Place {
    /// Any.
    Outermost,
    /// `always` and `eventually`.
    Window,
    /// None: an event, or a condition at one instant.
    Instant,
}

impl<'a> Parser<'a> {
    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn skip_spaces(&mut self) {
        self.at = self.text.len() - self.rest().trim_start().len();
    }

    /// Returns the bytes of the next word, or of the next character; none at the end.
    fn next_part(&self) -> Range<usize> {
        let word = word_length(self.rest());
        let length = if word > 0 { word } else { self.rest().chars().next().map_or(0, char::len_utf8) };
        self.at..self.at + length
    }

    /// Takes a word or sign, if it comes next.
    fn take(&mut self, sign: &str) -> bool {
        self.skip_spaces();
        let is_word = sign.starts_with(char::is_alphabetic);
        let comes =
            if is_word { &self.text[self.next_part()] == sign } else { self.rest().starts_with(sign) };
        if comes {
            self.at += sign.len();
        }
        comes
    }

    /// Returns the words that may follow a condition.
    fn joints(&self) -> &'static str {
        match self.known.requirement {
            Some(_) => "`and`, `or`, `until` or `implies`",
            None => "`and` or `or`",
        }
    }

    /// Reads an implication, or what it consists of.
    fn formula(&mut self) -> Result<Expression, ConditionFault> {
        let cause = self.any()?;
        if self.known.requirement.is_none() || !self.take("implies") {
            return Ok(cause);
        }
        Ok(Expression::Any(vec![cause.negated(), self.formula()?]))
    }

    fn any(&mut self) -> Result<Expression, ConditionFault> {
        let mut all = vec![self.all()?];
        while self.take("or") {
            all.push(self.all()?);
        }
        Ok(if all.len() == 1 { all.remove(0) } else { Expression::Any(all) })
    }

    fn all(&mut self) -> Result<Expression, ConditionFault> {
        let mut all = vec![self.until()?];
        self.refuse_foreign_signs()?;
        while self.take("and") {
            all.push(self.until()?);
            self.refuse_foreign_signs()?;
        }
        Ok(if all.len() == 1 { all.remove(0) } else { Expression::All(all) })
    }

    /// Refuses signs of programming languages with the word that conditions have for them.
    fn refuse_foreign_signs(&mut self) -> Result<(), ConditionFault> {
        self.skip_spaces();
        match FOREIGN_SIGNS.into_iter().find(|(sign, _)| self.rest().starts_with(sign)) {
            Some((sign, word)) => {
                Err(fault(self.at..self.at + sign.len(), format!("must have `{word}` in place of `{sign}`")))
            }
            None => Ok(()),
        }
    }

    /// Reads a comparison, a flag, a negation, or a condition in brackets.
    fn one(&mut self) -> Result<Expression, ConditionFault> {
        self.refuse_foreign_signs()?;
        let start = self.at;
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(fault(self.next_part(), format!("has at most {DEEPEST} brackets within each other")));
        }
        let read = if self.take("(") {
            let inner = self.formula()?;
            if !self.take(")") {
                return Err(fault(start..start + 1, "has a bracket that is not closed"));
            }
            inner
        } else if self.take("not") {
            self.one()?.negated()
        } else if self.operator("always", Place::Window)? {
            let window = self.window()?;
            self.inside(Place::Window, Self::one)?.always(window)
        } else if self.operator("eventually", Place::Window)? {
            let window = self.window()?;
            self.inside(Place::Window, Self::one)?.eventually(window)
        } else if self.operator("when", Place::Outermost)? {
            self.when()?
        } else {
            self.leaf()?
        };
        self.depth -= 1;
        Ok(read)
    }

    fn leaf(&mut self) -> Result<Expression, ConditionFault> {
        let start = self.at;
        let quantity = self.quantity()?;
        let written = start..self.at;
        self.skip_spaces();
        let sign = COMPARISONS.into_iter().find(|(sign, _)| self.rest().starts_with(sign));
        let Some((sign, comparison)) = sign else {
            if quantity.is_boolean() {
                return Ok(Expression::Flag(quantity));
            }
            let part = if self.at == self.text.len() { written.clone() } else { self.next_part() };
            let name = &self.text[written];
            return Err(fault(part, format!("needs one of `<`, `<=`, `>` and `>=` after `{name}`")));
        };
        if quantity.is_boolean() {
            let name = &self.text[written];
            let why = format!("compares `{name}`, which is true or false: write `{name}` or `not {name}`");
            return Err(fault(self.at..self.at + sign.len(), why));
        }
        self.at += sign.len();
        self.skip_spaces();
        let part = self.number_part();
        let text = &self.text[part.clone()];
        let number = if text.is_empty() {
            let end = self.text.len();
            return Err(fault(end.saturating_sub(1)..end, format!("needs a number after `{sign}`")));
        } else if let Some(named) = self.known.numbers.and_then(|numbers| numbers.get(text)) {
            named.get()
        } else {
            number_in(text, self.unit(quantity)).map_err(|why| fault(part.clone(), why))?
        };
        if quantity.is_clock() && number < 0.0 {
            return Err(fault(part, format!("compares a time with {number}, which is negative")));
        }
        self.at = part.end;
        Ok(Expression::Compared { quantity, comparison, limit: number })
    }

    /// Returns the SI unit of a quantity.
    fn unit(&self, quantity: ModeQuantity) -> &'a str {
        match (quantity, &self.known.requirement) {
            (ModeQuantity::Metric(index, _), Some(names)) => names.metrics[index].1,
            _ => quantity.unit(),
        }
    }

    /// Reads a quantity: of a requirement, an estimate of the motion by its full name, or a metric.
    fn quantity(&mut self) -> Result<ModeQuantity, ConditionFault> {
        let part = self.next_part();
        let written = &self.text[part.clone()];
        let is_of_requirement = self.known.requirement.is_some();
        let word = written.strip_prefix("estimate.").filter(|_| is_of_requirement).unwrap_or(written);
        if word.is_empty() {
            let end = self.text.len();
            return Err(fault(end.saturating_sub(1)..end, "needs a quantity at its end"));
        }
        self.at = part.end;
        let found = ModeQuantity::from_word(word).filter(|of| of.is_for(is_of_requirement));
        let is_estimate = matches!(found, Some(ModeWord::Plain(quantity)) if quantity.is_estimate());
        if is_of_requirement && found.is_some() && is_estimate != (word.len() < written.len()) {
            let truth = if word == "attitude_error" { "pointing_error" } else { &format!("truth.{word}") };
            let accepted = if is_estimate {
                format!("`estimate.{word}` or the truth, `{truth}`")
            } else {
                format!("`{word}`")
            };
            return Err(fault(part, format!("must be {accepted}, got `{written}`")));
        }
        match found {
            Some(ModeWord::Plain(quantity)) => Ok(quantity),
            Some(ModeWord::OfSensor(quantity)) => {
                let (part, name) = self.argument(word, "sensor")?;
                let index = index_of_kind(name, &self.known.sensors);
                index.map(quantity).ok_or_else(|| {
                    let listed = listed(&self.known.sensors);
                    fault(part, format!("must name one of the sensors, {listed}, got `{name}`"))
                })
            }
            Some(ModeWord::OfMode(quantity)) => {
                let (part, name) = self.argument(word, "mode")?;
                self.mode_index(part, name).map(quantity)
            }
            Some(ModeWord::OfLine(quantity)) => {
                let (part, name) = self.argument(word, "point")?;
                let points = self.known.requirement.as_ref().map_or(&[][..], |names| &names.points);
                index_of(part, name, points, "points of the lines of sight").map(quantity)
            }
            Some(ModeWord::OfFault(quantity)) => {
                let (part, name) = self.argument(word, "fault")?;
                let faults = self.known.requirement.as_ref().map_or(&[][..], |names| &names.faults);
                index_of(part, name, faults, "faults").map(quantity)
            }
            None => {
                if let Some(metric) = self.read_metric(written) {
                    return Ok(metric);
                }
                let why = if word.starts_with("truth.") && !is_of_requirement {
                    "reads the truth, of which `truth.time`, `truth.run_time`, `truth.sunlight` and `truth.elevation(MODE)` \
                     have exact instants; test others on what the law knows"
                        .to_owned()
                } else {
                    let words: Vec<String> = ModeQuantity::words(is_of_requirement).collect();
                    let words: Vec<&str> = words.iter().map(String::as_str).collect();
                    let hint = nearest(written, &words);
                    let hint = hint.map_or(String::new(), |near| format!("; did you mean `{near}`?"));
                    let or = if is_of_requirement { " or a metric" } else { "" };
                    format!(
                        "must begin with a quantity, one of {}{or}, got `{written}`{hint}",
                        listed(&words)
                    )
                };
                Err(fault(part, why))
            }
        }
    }

    /// Returns the index of the mode with a name at a place of the text.
    fn mode_index(&self, part: Range<usize>, name: &str) -> Result<usize, ConditionFault> {
        index_of(part, name, &self.known.modes, "modes")
    }

    /// Returns the metric with a name, and reads the index after it: of an element of a list, such as `fuel_axes_kg[2]`.
    fn read_metric(&mut self, name: &str) -> Option<ModeQuantity> {
        let index = self.known.requirement.as_ref()?.metrics.iter().position(|(known, _)| *known == name)?;
        let element = self.rest().strip_prefix('[').and_then(|rest| rest.split_once(']'));
        let element = element.and_then(|(number, _)| Some((number.len() + 2, number.parse().ok()?)));
        self.at += element.map_or(0, |(length, _)| length);
        Some(ModeQuantity::Metric(index, element.map(|(_, number)| number)))
    }

    /// Reads the argument of a quantity: `(star_tracker)`.
    fn argument(&mut self, word: &str, role: &str) -> Result<(Range<usize>, &'a str), ConditionFault> {
        let start = self.at;
        let whole = start - word.len()..start;
        if !self.take("(") {
            return Err(fault(whole, format!("needs a {role} in brackets after `{word}`")));
        }
        let Some(length) = self.rest().find(')') else {
            return Err(fault(start..start + 1, "has a bracket that is not closed"));
        };
        let inner = &self.rest()[..length];
        let from = self.at + (inner.len() - inner.trim_start().len());
        let name = inner.trim();
        self.at += length + 1;
        Ok((from..(from + name.len()).max(from + 1), name))
    }

    /// Returns the bytes of a number with its unit: up to a word that ends it, a closing bracket, a colon or the end.
    fn number_part(&self) -> Range<usize> {
        let (mut depth, mut end) = (0_usize, self.text.len());
        let mut after_space = true;
        for (index, sign) in self.rest().char_indices() {
            let word = &self.rest()[index..];
            let joins = after_space && JOINTS.contains(&&word[..word_length(word)]);
            match sign {
                '(' => depth += 1,
                ')' if depth > 0 => depth -= 1,
                ')' => end = self.at + index,
                _ if joins || "&|:".contains(sign) => end = self.at + index,
                _ => {}
            }
            if end < self.text.len() {
                break;
            }
            after_space = sign.is_whitespace();
        }
        self.at..self.at + self.text[self.at..end].trim_end().len()
    }
}

/// Returns the length of the word at the start of a text; words have letters, digits, `_`, `.` and `-`.
fn word_length(text: &str) -> usize {
    if !text.starts_with(|c: char| c.is_alphabetic() || c == '_') {
        return 0;
    }
    text.find(|c: char| !(c.is_alphanumeric() || "_.-".contains(c))).unwrap_or(text.len())
}

/// Returns the index of a part by its kind, or by kind and index among those of the kind: `star_tracker[1]`.
pub fn index_of_kind(name: &str, kinds: &[&str]) -> Option<usize> {
    let (kind, place) = match name.strip_suffix(']').and_then(|name| name.split_once('[')) {
        Some((kind, place)) => (kind, place.parse().ok()?),
        None => (name, 0),
    };
    let mut of_kind = kinds.iter().enumerate().filter(|(_, known)| **known == kind);
    of_kind.nth(place).map(|(index, _)| index)
}

/// Returns the index of a name at a place of the text; an error lists the known ones under their role.
fn index_of(part: Range<usize>, name: &str, known: &[&str], role: &str) -> Result<usize, ConditionFault> {
    let index = known.iter().position(|known| *known == name);
    let count = known.iter().filter(|known| **known == name).count();
    if count > 1 {
        return Err(fault(part, format!("must name one of the {role}, and {count} are `{name}`")));
    }
    index.ok_or_else(|| fault(part, format!("must name one of the {role}, {}, got `{name}`", listed(known))))
}

/// Returns names in quotes, separated by commas.
pub(super) fn listed(names: &[&str]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    quoted.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn known() -> Vocabulary<'static> {
        Vocabulary {
            sensors: vec!["gyro", "star_tracker", "star_tracker"],
            modes: vec!["safe", "point-2"],
            ..Vocabulary::default()
        }
    }

    fn compared(quantity: ModeQuantity, comparison: Comparison, limit: f64) -> Expression {
        Expression::Compared { quantity, comparison, limit }
    }

    #[test]
    fn conditions_bind_and_before_or() {
        let read = parse("rate < 2e-3 or time >= 1 min and not (lock_lost)", &known());
        let expected = Expression::Any(vec![
            compared(ModeQuantity::Rate, Comparison::Below, 2e-3),
            Expression::All(vec![
                compared(ModeQuantity::Time, Comparison::AtLeast, 60.0),
                Expression::Not(Box::new(Expression::Flag(ModeQuantity::LockLost))),
            ]),
        ]);
        assert_eq!(read, Ok(expected));
    }

    #[test]
    fn signs_of_programming_languages_have_words_here() {
        for (text, sign, word) in [
            ("rate < 2e-3 && time > 1 min", "&&", "and"),
            ("(rate < 2e-3 || lock_lost)", "||", "or"),
            ("lock_lost & time > 3", "&", "and"),
            ("time > 5 s|lock_lost", "|", "or"),
            ("!lock_lost", "!", "not"),
            ("time > 3 and !(lock_lost)", "!", "not"),
        ] {
            let fault = parse(text, &known()).expect_err(text);
            assert_eq!(fault.why, format!("must have `{word}` in place of `{sign}`"), "{text}");
            assert_eq!(&text[fault.part], sign, "{text}");
        }
    }

    #[test]
    fn arguments_and_units_are_read() {
        let read = |text| parse(text, &known()).unwrap();
        assert_eq!(
            read("silent( star_tracker[1] )>30"),
            compared(ModeQuantity::Silent(2), Comparison::Above, 30.0)
        );
        assert_eq!(
            read("(entries(point-2) >= 3)"),
            compared(ModeQuantity::Entries(1), Comparison::AtLeast, 3.0)
        );
        assert_eq!(
            read("momentum <= 20 mN m s and sunlight>0.5"),
            Expression::All(vec![
                compared(ModeQuantity::Momentum, Comparison::AtMost, 0.02),
                compared(ModeQuantity::Sunlight, Comparison::Above, 0.5),
            ])
        );
        let Expression::Compared { limit, .. } = read("attitude_error < 180 deg") else { panic!() };
        assert!((limit - std::f64::consts::PI).abs() < 1e-15);
    }

    #[test]
    fn faults_name_their_part() {
        let found = |text: &'static str| {
            let ConditionFault { part, why } = parse(text, &known()).unwrap_err();
            (&text[part], why)
        };
        for (text, part, begins) in [
            ("rte < 2", "rte", "must begin with a quantity"),
            ("rate = 2", "=", "needs one of `<`"),
            ("rate", "rate", "needs one of `<`"),
            ("rate <", "<", "needs a number"),
            ("rate < 2 and", "d", "needs a quantity"),
            ("rate < 2 s", "2 s", "has the unit `s`"),
            ("rate < fast", "fast", "must be a number"),
            ("rate < nan", "nan", "must be a number"),
            ("rate < 1e999", "1e999", "must be a number"),
            ("rate < 2 time > 3", "2 time > 3", "has the unit"),
            ("(rate < 2", "(", "has a bracket"),
            ("rate < 2) or time > 1", ")", "must end or go on"),
            ("silent > 3", "silent", "needs a sensor in brackets"),
            ("silent(sun_sensor) > 3", "sun_sensor", "must name one of the sensors, `gyro`, `star_tracker`"),
            ("silent(star_tracker[2]) > 3", "star_tracker[2]", "must name one of the sensors"),
            ("silent(gyro > 3", "(", "has a bracket"),
            ("entries(sleep) > 3", "sleep", "must name one of the modes, `safe`, `point-2`"),
            ("lock_lost > 0", ">", "compares `lock_lost`"),
            ("time > -1", "-1", "compares a time with -1"),
            ("truth.rate > 1", "truth.rate", "reads the truth"),
            ("", "", "needs a quantity"),
            ("ä < 1", "ä", "must begin with a quantity"),
        ] {
            let (there, why) = found(text);
            assert_eq!(there, part, "{text}: {why}");
            assert!(why.starts_with(begins), "{text}: {why}");
        }
        let deep = format!("{}rate < 1{}", "(".repeat(400), ")".repeat(400));
        assert!(parse(&deep, &known()).unwrap_err().why.starts_with("has at most 32 brackets"));
        assert!(
            parse(&"rate < 1 and ".repeat(100), &known()).unwrap_err().why.starts_with("has at most 1000")
        );
    }
}
