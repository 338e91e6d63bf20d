//! Two answers side by side: requirements, modes of operation, warnings and what else is known.

use flexsc_formats::reader_units::{ReaderUnits, time};
use flexsc_formats::text_columns::columns;
use serde::Serialize;

use super::key_difference::KeyDifference;
use super::mode_answer::ModeAnswer;
use super::screen::{ScreenOptions, indented, wrapped};
use super::{Answer, Line, RequirementAnswer};

/// Letters of the two sides.
pub(super) const SIDES: [&str; 2] = ["A", "B"];
/// Largest number of keys on a first screen.
const MOST_KEYS: usize = 12;

/// Two scenarios or runs, and in what they differ.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RunComparison {
    /// Names of the two sides.
    pub names: [String; 2],
    /// Keys in which the scenarios differ.
    pub keys: Vec<KeyDifference>,
    /// Answer of each side.
    pub answers: [Answer; 2],
}

impl RunComparison {
    /// Returns the comparison as text.
    pub fn screen(&self, options: ScreenOptions) -> String {
        let blocks = [
            heads(&self.names, &self.answers.each_ref().map(|answer| answer.verdict_text.clone())),
            key_lines(&self.keys, options.all),
            self.requirement_lines(),
            self.warning_lines(options.width),
            self.mode_lines(options.units),
            self.known_lines(options),
        ];
        let blocks = blocks.into_iter().filter(|block| !block.is_empty()).map(|block| block.join("\n"));
        options.style.styled(&blocks.collect::<Vec<_>>().join("\n\n"))
    }

    fn requirement_lines(&self) -> Vec<String> {
        let all = self.answers.each_ref().map(|answer| &answer.requirements[..]);
        let row = |(name, both): (&str, [Option<&RequirementAnswer>; 2])| {
            let limits = both.map(|own| own.map(|own| own.text.limit.clone()));
            let limit = match limits {
                [Some(a), Some(b)] if a != b => format!("{a}, {b}"),
                [Some(a), _] | [None, Some(a)] => a,
                [None, None] => String::new(),
            };
            let cell = |own: Option<&RequirementAnswer>| {
                own.map_or_else(
                    || "not required".to_owned(),
                    |own| {
                        let mark = own.decision.mark();
                        let margin = Some(&own.text.margin).filter(|text| !text.is_empty());
                        let margin = margin.map_or_else(String::new, |margin| format!(" ({margin})"));
                        format!("{mark} {}{margin}", own.text.value)
                    },
                )
            };
            let [a, b] = both.map(cell);
            vec![format!("{name} at most {limit}"), a, b]
        };
        table("requirement (margin)", paired(all, |own| &own.name).into_iter().map(row))
    }

    fn warning_lines(&self, width: usize) -> Vec<String> {
        let [first, second] = self.answers.each_ref().map(|answer| &answer.warnings);
        let is_in = |text: &str, all: &[super::Warning]| all.iter().any(|own| own.text == text);
        let line = |sides: &str, text: &str| wrapped(&format!("  {sides} ! {text}"), width, 6);
        let mut lines = Vec::new();
        for own in first {
            lines.extend(line(if is_in(&own.text, second) { "A, B" } else { "A" }, &own.text));
        }
        for own in second.iter().filter(|own| !is_in(&own.text, first)) {
            lines.extend(line("B", &own.text));
        }
        lines
    }

    fn mode_lines(&self, units: ReaderUnits) -> Vec<String> {
        let all = self.answers.each_ref().map(|answer| &answer.by_mode[..]);
        let row = |(name, both): (&str, [Option<&ModeAnswer>; 2])| {
            let errors = both.map(|own| own?.error_rad.as_ref().map(|error| error.p95));
            let unit = units.fitting(errors.into_iter().flatten().fold(0.0, f64::max), "rad");
            let cell = |side: usize| {
                let own = both[side]?;
                let error = errors[side].map(|error| format!("95 % {}", unit.quantity(error)));
                let limit = own.at_limit_s.filter(|limit| *limit > 0.0);
                let limit = limit.map(|limit| format!("{} at a limit", time(limit)));
                let parts = [Some(time(own.time_s)), error, limit].into_iter().flatten();
                Some(parts.collect::<Vec<_>>().join(", "))
            };
            let [a, b] = [0, 1].map(|side| cell(side).unwrap_or_else(|| "not in this run".to_owned()));
            vec![name.to_owned(), a, b]
        };
        table("mode", paired(all, |own| &own.mode).into_iter().map(row))
    }

    /// Returns the lines on what else is known that differ.
    fn known_lines(&self, options: ScreenOptions) -> Vec<String> {
        let all = self.answers.each_ref().map(|answer| &answer.lines[..]);
        let is_shown = |own: &Line| own.is_main || options.all;
        let differs = |(_, both): &(&str, [Option<&Line>; 2])| {
            both[0] != both[1] && both.iter().flatten().any(|own| is_shown(own))
        };
        let shown: Vec<_> = paired(all, |own| &own.head).into_iter().filter(differs).collect();
        let widest = shown.iter().map(|(head, _)| head.chars().count()).max().unwrap_or(0);
        let mut lines = Vec::new();
        for (head, both) in shown {
            for (side, own) in both.into_iter().enumerate() {
                let head = if side == 0 { head } else { "" };
                let text = own.map_or("not in this run", |own| own.text.as_str());
                let line = format!("  {head:<widest$}  {}  {text}", SIDES[side]);
                lines.extend(wrapped(&line, options.width, widest + 7));
            }
        }
        lines
    }
}

/// Returns the items of both sides by their names, those of the first side in front.
pub(super) fn paired<'a, T>(
    [first, second]: [&'a [T]; 2],
    name: fn(&T) -> &str,
) -> Vec<(&'a str, [Option<&'a T>; 2])> {
    let of = |all: &'a [T], wanted: &str| all.iter().find(|own| name(own) == wanted);
    let new = second.iter().filter(|own| of(first, name(own)).is_none());
    let all = first.iter().chain(new).map(name);
    all.map(|name| (name, [of(first, name), of(second, name)])).collect()
}

/// Returns a line for each side with its name and its verdict.
pub(super) fn heads(names: &[String; 2], verdicts: &[String; 2]) -> Vec<String> {
    let row = |side: usize| vec![SIDES[side].to_owned(), names[side].clone(), verdicts[side].clone()];
    columns(&[row(0), row(1)], |_| true)
}

/// Returns the keys that differ, the first ones or all.
pub(super) fn key_lines(keys: &[KeyDifference], all: bool) -> Vec<String> {
    if keys.is_empty() {
        return vec!["  the scenarios have the same keys".to_owned()];
    }
    let shown = if all { keys.len() } else { MOST_KEYS };
    let or_none = |text: &String| if text.is_empty() { "none".to_owned() } else { text.clone() };
    let row = |own: &KeyDifference| vec![own.key.clone(), or_none(&own.texts[0]), or_none(&own.texts[1])];
    let mut lines = table("key", keys.iter().take(shown).map(row));
    if keys.len() > shown {
        lines.push(format!("    {} more: --all", keys.len() - shown));
    }
    lines
}

/// Returns a table with a column for each side, without its head if it has no rows.
fn table(head: &str, rows: impl Iterator<Item = Vec<String>>) -> Vec<String> {
    let rows: Vec<Vec<String>> = rows.collect();
    if rows.is_empty() {
        return Vec::new();
    }
    let head = [head, SIDES[0], SIDES[1]].map(str::to_owned).to_vec();
    let all: Vec<Vec<String>> = std::iter::once(head).chain(rows).collect();
    indented(columns(&all, |_| true))
}
