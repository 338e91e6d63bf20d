//! Two answers side by side: requirements, modes of operation, warnings and what else is known.

use flexsc_formats::reader_units::{ReaderUnits, time};
use flexsc_formats::text_columns::columns;
use serde::Serialize;

use super::key_difference::KeyDifference;
use super::mode_answer::ModeAnswer;
use super::screen::{ScreenOptions, indented, wrapped};
use super::{Answer, RequirementAnswer};

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
        let [first, second] = self.answers.each_ref().map(|answer| &answer.requirements);
        let of = |all: &[RequirementAnswer], name: &str| all.iter().find(|own| own.name == name).cloned();
        let names = first.iter().chain(second.iter().filter(|own| of(first, &own.name).is_none()));
        let row = |own: &RequirementAnswer| {
            let both = [of(first, &own.name), of(second, &own.name)];
            let limits = both.each_ref().map(|own| own.as_ref().map(|own| own.text.limit.clone()));
            let limit = match limits {
                [Some(a), Some(b)] if a != b => format!("{a}, {b}"),
                [Some(a), _] | [None, Some(a)] => a,
                [None, None] => String::new(),
            };
            let cell = |own: Option<RequirementAnswer>| {
                own.map_or_else(
                    || "not required".to_owned(),
                    |own| {
                        let mark = if own.met { "✓" } else { "✗" };
                        let margin = Some(own.text.margin).filter(|text| !text.is_empty());
                        let margin = margin.map_or_else(String::new, |margin| format!(" ({margin})"));
                        format!("{mark} {}{margin}", own.text.value)
                    },
                )
            };
            let [a, b] = both.map(cell);
            vec![format!("{} at most {limit}", own.name), a, b]
        };
        table("requirement (margin)", names.map(row))
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
        let [first, second] = self.answers.each_ref().map(|answer| &answer.by_mode);
        let of = |all: &[ModeAnswer], name: &str| all.iter().find(|own| own.mode == name).cloned();
        let names = first.iter().chain(second.iter().filter(|own| of(first, &own.mode).is_none()));
        let row = |own: &ModeAnswer| {
            let both = [of(first, &own.mode), of(second, &own.mode)];
            let error = |own: &Option<ModeAnswer>| own.as_ref()?.error_rad.as_ref().map(|error| error.p95);
            let errors = both.each_ref().map(error);
            let unit = units.fitting(errors.into_iter().flatten().fold(0.0, f64::max), "rad");
            let cell = |side: usize| {
                let own = both[side].as_ref()?;
                let error = errors[side].map(|error| format!("95 % {}", unit.quantity(error)));
                let limit = own.at_limit_s.filter(|limit| *limit > 0.0);
                let limit = limit.map(|limit| format!("{} at a limit", time(limit)));
                let parts = [Some(time(own.time_s)), error, limit].into_iter().flatten();
                let text = parts.collect::<Vec<_>>().join(", ");
                Some(text)
            };
            let cells = [0, 1].map(|side| cell(side).unwrap_or_else(|| "not entered".to_owned()));
            let [a, b] = cells;
            vec![own.mode.clone(), a, b]
        };
        table("mode", names.map(row))
    }

    /// Returns the lines on what else is known that differ.
    fn known_lines(&self, options: ScreenOptions) -> Vec<String> {
        let [first, second] = self.answers.each_ref().map(|answer| &answer.lines);
        let of = |all: &[super::Line], head: &str| all.iter().find(|own| own.head == head).cloned();
        let heads = first.iter().chain(second.iter().filter(|own| of(first, &own.head).is_none()));
        let heads: Vec<&super::Line> = heads.filter(|own| own.is_main || options.all).collect();
        let widest = heads.iter().map(|own| own.head.chars().count()).max().unwrap_or(0);
        let mut lines = Vec::new();
        for head in heads.into_iter().map(|own| &own.head) {
            let texts = [first, second].map(|all| of(all, head).map(|own| own.text));
            if texts[0] == texts[1] {
                continue;
            }
            for (side, text) in texts.into_iter().enumerate() {
                let head = if side == 0 { head.as_str() } else { "" };
                let text = text.unwrap_or_else(|| "none".to_owned());
                let line = format!("  {head:<widest$}  {}  {text}", SIDES[side]);
                lines.extend(wrapped(&line, options.width, widest + 7));
            }
        }
        lines
    }
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
