//! First screen of an answer: the verdict, requirements, warnings, then modes of operation or what else is known.

use flexsc_formats::count::counted;
use flexsc_formats::reader_units::{
    ReaderUnit, ReaderUnits, THIN_SPACE, number, rough_time, time, time_span,
};
use flexsc_formats::text_columns::{columns, widths};

use super::Answer;
use super::mode_answer::ModeAnswer;
use super::requirement_answer::RequirementAnswer;

/// Characters for marks and spaces.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub enum ScreenStyle {
    /// `✓`, `✗`, `!`, thin spaces within numbers.
    #[default]
    Unicode,
    /// `ok`, `NO`, `!`, spaces within numbers.
    Ascii,
}

impl ScreenStyle {
    /// Returns a text with characters of the style.
    pub fn styled(self, text: &str) -> String {
        match self {
            Self::Unicode => text.to_owned(),
            Self::Ascii => ascii(text),
        }
    }
}

/// Contents and width of a screen.
#[derive(Copy, Clone, Debug)]
pub struct ScreenOptions {
    /// Largest number of characters of a line.
    pub width: usize,
    /// True for everything that is known, false for a first screen.
    pub all: bool,
    /// Characters.
    pub style: ScreenStyle,
    /// Units.
    pub units: ReaderUnits,
}

impl Default for ScreenOptions {
    fn default() -> Self {
        Self { width: WIDTH, all: false, style: ScreenStyle::default(), units: ReaderUnits::default() }
    }
}

/// Characters of a line.
const WIDTH: usize = 96;
/// Largest number of requirements, warnings and lines of a warning on a first screen.
const MOST: [usize; 3] = [5, 3, 4];
/// Largest number of lines of a first screen, without the last one that a program adds.
const MOST_LINES: usize = 14;
/// Least median in the unit of a column.
const LEGIBLE: f64 = 1e-3;
/// Largest number of modes of operation in a table on a first screen.
const MOST_MODES: usize = 6;

impl Answer {
    /// Returns the answer as text; `took` is the real time that the run took (s).
    pub fn screen(&self, took: Option<f64>, options: ScreenOptions) -> String {
        let mut blocks = vec![self.head(took, options), self.requirement_lines(options)];
        let warnings: Vec<&str> = self.warnings.iter().map(|warning| &*warning.text).collect();
        blocks.push(warning_lines(&warnings, options));
        if !self.by_mode.is_empty() {
            blocks.push(self.mode_table(options));
        }
        let shown: usize = blocks.iter().map(|block| block.len() + usize::from(!block.is_empty())).sum();
        blocks.push(self.known_lines(options, MOST_LINES.saturating_sub(shown)));
        if options.all {
            blocks.push(self.event_lines());
        }
        let blocks = blocks.into_iter().filter(|block| !block.is_empty()).map(|block| block.join("\n"));
        let text = blocks.collect::<Vec<_>>().join("\n\n");
        options.style.styled(&text)
    }

    fn head(&self, took: Option<f64>, options: ScreenOptions) -> Vec<String> {
        let first = format!("{}   {}", self.scenario, self.verdict_text);
        let duration = time(self.duration_s);
        let took = match (self.from_rows_s, took) {
            (Some(period), _) => format!("{duration}, from rows every {}", time_span(period)),
            (None, Some(took)) => format!("{duration} simulated in {}", rough_time(took)),
            (None, None) => format!("{duration} simulated"),
        };
        let [before, after] = [&first, &took].map(|text| text.chars().count());
        if before + 3 + after <= options.width {
            return vec![format!("{first}{}{took}", " ".repeat(options.width - before - after))];
        }
        let mut lines = wrapped(&first, options.width, 4);
        lines.push(format!("    {took}"));
        lines
    }

    fn requirement_lines(&self, options: ScreenOptions) -> Vec<String> {
        let shown = if options.all { self.requirements.len() } else { MOST[0] };
        let cells = |own: &RequirementAnswer| {
            let prefix = |word: &str, text: &str| match text {
                "" => String::new(),
                text => format!("{word} {text}"),
            };
            vec![
                own.decision.mark().to_owned(),
                own.name.clone(),
                own.text.value.clone(),
                format!("at most {}", own.text.limit),
                if own.margin < -1.0 { own.text.margin.clone() } else { prefix("margin", &own.text.margin) },
                prefix(own.text.largest_word, &own.text.largest),
            ]
        };
        let rows: Vec<Vec<String>> = self.requirements.iter().take(shown).map(cells).collect();
        let widths = widths(&rows);
        let line = |row: &[String]| {
            let mut cells = row.iter().zip(&widths).map(|(cell, width)| format!("{cell:<width$}"));
            let mark = cells.next().unwrap_or_default();
            format!("  {mark} {}", cells.collect::<Vec<_>>().join("   ")).trim_end().to_owned()
        };
        let mut lines = Vec::new();
        for (row, own) in rows.iter().zip(&self.requirements) {
            let text = line(row);
            // The largest value has a line of its own where the table is too wide.
            if text.chars().count() > options.width && !row[5].is_empty() {
                let mut short = row.clone();
                let largest = std::mem::take(&mut short[5]);
                lines.extend(wrapped(&line(&short), options.width, 6));
                lines.push(format!("      {largest}"));
            } else {
                lines.extend(wrapped(&text, options.width, 6));
            }
            if options.all {
                lines.push(format!("      {}", own.description));
            }
        }
        if self.requirements.len() > shown {
            lines.push(format!("    {} more: --all", self.requirements.len() - shown));
        }
        lines
    }

    fn mode_table(&self, options: ScreenOptions) -> Vec<String> {
        let errors = || self.by_mode.iter().filter_map(|row| row.error_rad.as_ref());
        // One unit for all modes: that of the largest 95 % level, unless the least median has too few digits in it.
        let largest = errors().map(|own| own.p95).fold(0.0, f64::max);
        let least = errors().map(|own| own.median).fold(f64::INFINITY, f64::min);
        let unit = options.units.fitting(largest, "rad");
        let unit = if unit.value(least) < LEGIBLE { options.units.fitting(least, "rad") } else { unit };
        let wheel = self.by_mode.iter().any(|row| row.wheel_speed_rad_s.is_some());
        let limit = self.by_mode.iter().any(|row| row.at_limit_s.is_some_and(|time| time > 0.0));
        let has_errors = errors().next().is_some();
        let mut rows = vec![heads(&unit, [has_errors, wheel, limit])];
        let shown = if options.all { usize::MAX } else { MOST_MODES };
        let speed = options.units.rotor_speed();
        let unvisited: Vec<&str> =
            self.by_mode.iter().filter(|row| row.visits == 0).map(|row| &*row.mode).collect();
        // Several of them are one line of a first screen.
        let is_short = !options.all && unvisited.len() > 1;
        let each = self.by_mode.iter().take(shown).filter(|row| !is_short || row.visits > 0);
        rows.extend(each.map(|row| cells(row, (&unit, &speed), [has_errors, wheel, limit])));
        let mut lines = aligned(&rows, options.width);
        if is_short {
            lines.push(format!("  never in {}", unvisited.join(", ")));
        }
        if self.by_mode.len() > shown {
            lines.push(format!("  {} more: --all", counted(self.by_mode.len() - shown, "mode")));
        }
        lines
    }

    fn known_lines(&self, options: ScreenOptions, most: usize) -> Vec<String> {
        let shown: Vec<_> = self.lines.iter().filter(|line| options.all || line.is_main).collect();
        let width = shown.iter().map(|line| line.head.chars().count()).max().unwrap_or(0) + 3;
        let mut lines = Vec::new();
        for line in shown {
            let text = format!("  {:<width$}{}", line.head, line.text);
            let own = wrapped(&text, options.width, width + 2);
            if options.all || lines.len() + own.len() <= most {
                lines.extend(own);
            }
        }
        lines
    }

    fn event_lines(&self) -> Vec<String> {
        let line = |event: &super::RunEvent| {
            let cause = if event.cause.is_empty() { String::new() } else { format!(": {}", event.cause) };
            vec![
                number(event.from_s),
                "to".to_owned(),
                time(event.to_s),
                format!("{} {}{cause}", event.kind.words(), event.part).trim_end().to_owned(),
            ]
        };
        let rows: Vec<Vec<String>> = self.events.iter().map(line).collect();
        indented(columns(&rows, |column| column == 3))
    }
}

/// Returns the lines of warnings: on a first screen those of the gravest ones.
pub(super) fn warning_lines(texts: &[&str], options: ScreenOptions) -> Vec<String> {
    let (warnings, lines) = if options.all { (usize::MAX, usize::MAX) } else { (MOST[1], MOST[2]) };
    let mut all: Vec<String> = Vec::new();
    for text in texts.iter().take(warnings) {
        let mut own = wrapped(&format!("  ! {text}"), options.width, 4);
        if own.len() > lines {
            own.truncate(lines);
            if let Some(last) = own.last_mut() {
                last.push_str(" ...");
            }
        }
        all.extend(own);
    }
    if texts.len() > warnings {
        all.push(format!("    {} more: --all", counted(texts.len() - warnings, "warning")));
    }
    all
}

fn heads(unit: &ReaderUnit, [errors, wheel, limit]: [bool; 3]) -> Vec<String> {
    let mut heads = vec!["mode".to_owned(), "visits".to_owned(), "time".to_owned()];
    if errors {
        heads.extend([format!("error, {}: median", unit.name), "95 %".to_owned(), "largest".to_owned()]);
    }
    heads.extend(wheel.then(|| "fastest wheel".to_owned()));
    heads.extend(limit.then(|| "at limit".to_owned()));
    heads
}

fn cells(
    row: &ModeAnswer,
    (unit, speed): (&ReaderUnit, &ReaderUnit),
    [errors, wheel, limit]: [bool; 3],
) -> Vec<String> {
    let none = || "-".to_owned();
    if row.visits == 0 {
        let mut cells = vec![row.mode.clone(), "never".to_owned()];
        cells.resize_with(3 + 3 * usize::from(errors) + usize::from(wheel) + usize::from(limit), none);
        return cells;
    }
    let mut cells = vec![row.mode.clone(), row.visits.to_string(), time(row.time_s)];
    if errors {
        cells.extend(match &row.error_rad {
            Some(own) => [own.median, own.p95, own.largest].map(|value| unit.number(value)),
            None => ["no target".to_owned(), none(), none()],
        });
    }
    if wheel {
        cells.push(row.wheel_speed_rad_s.map_or_else(none, |value| speed.quantity(value)));
    }
    if limit {
        let at_limit = row.at_limit_s.zip(row.at_limit_of);
        cells.push(at_limit.map_or_else(none, |(seconds, of)| format!("{} {of}", time(seconds))));
    }
    cells
}

/// Returns rows as columns, the first one aligned to the left; columns that do not fit are left out.
fn aligned(rows: &[Vec<String>], most: usize) -> Vec<String> {
    let widths = widths(rows);
    let total = |shown: usize| 2 + widths[..shown].iter().sum::<usize>() + 2 * shown.saturating_sub(1);
    let shown = (1..=widths.len()).rev().find(|shown| total(*shown) <= most).unwrap_or(1);
    let rows: Vec<Vec<String>> = rows.iter().map(|row| row[..shown].to_vec()).collect();
    indented(columns(&rows, |column| column == 0))
}

/// Returns lines with the indent of a block.
pub(super) fn indented(lines: Vec<String>) -> Vec<String> {
    lines.into_iter().map(|line| format!("  {line}")).collect()
}

/// Returns a text in lines of at most `width` characters, broken at spaces but not between a number and its unit, all but
/// the first indented.
pub(super) fn wrapped(text: &str, width: usize, indent: usize) -> Vec<String> {
    let start = text.len() - text.trim_start().len();
    let mut lines = vec![text[..start].to_owned()];
    for (index, word) in words(&text[start..]).into_iter().enumerate() {
        let last = lines.last_mut().expect("there is one line at least");
        if index == 0 {
            last.push_str(&word);
        } else if last.chars().count() + 1 + word.chars().count() > width && !word.is_empty() {
            lines.push(format!("{}{word}", " ".repeat(indent)));
        } else {
            last.push(' ');
            last.push_str(&word);
        }
    }
    lines.iter().map(|line| line.trim_end().to_owned()).collect()
}

/// Returns the words of a text, with units behind their numbers: `26.4 mN m`, `95 %`.
fn words(text: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    for word in text.split(' ') {
        let before = words.last().map_or("", |last| last.as_str());
        let plain = word.trim_end_matches([',', ';', '.', ')']);
        let is_unit = match before.rsplit(' ').next().unwrap_or_default() {
            "N" | "mN" | "µN" | "nN" | "m" => matches!(plain, "m" | "s"),
            number => {
                let digits = number.trim_start_matches(['±', '(']).replace(THIN_SPACE, "");
                let is_number = digits.parse::<f64>().is_ok();
                is_number && (plain == "%" || plain == "s" || (UNITS.contains(&plain) && plain.len() > 1))
            }
        };
        match words.last_mut() {
            Some(last)
                if is_unit || matches!(plain, "N" | "m" | "J" | "g") && last.parse::<f64>().is_ok() =>
            {
                last.push(' ');
                last.push_str(word);
            }
            _ => words.push(word.to_owned()),
        }
    }
    words
}

/// Units that stay with their numbers.
const UNITS: [&str; 26] = [
    "deg",
    "arcsec",
    "mas",
    "deg/s",
    "arcsec/s",
    "mas/s",
    "deg/s²",
    "arcsec/s²",
    "mas/s²",
    "rpm",
    "Hz",
    "mHz",
    "rad",
    "rad/s",
    "rad/s²",
    "mN",
    "µN",
    "nN",
    "mJ",
    "µJ",
    "nJ",
    "kJ",
    "kg",
    "mg",
    "mm",
    "µm",
];

/// Returns a text with plain characters for marks and spaces.
fn ascii(text: &str) -> String {
    let plain = text.replace(THIN_SPACE, " ").replace('✓', "ok").replace('✗', "NO");
    plain.replace('×', "x").replace('±', "+-").replace('µ', "u").replace('²', "^2")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_texts_are_broken_at_spaces_and_indented() {
        let text = "  ! one two three four";
        assert_eq!(wrapped(text, 11, 4), ["  ! one two", "    three", "    four"]);
        assert_eq!(wrapped("short", 20, 4), ["short"]);
        assert_eq!(
            wrapped("torque 26.4 mN m, 95 % of it", 14, 2),
            ["torque", "  26.4 mN m,", "  95 % of it"]
        );
        // Columns keep their distances.
        assert_eq!(wrapped("  a   b", 20, 4), ["  a   b"]);
    }
}
