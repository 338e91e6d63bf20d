//! First screen of a campaign: the verdict, the distribution of each requirement, what drives it, and how to repeat it.

use flexsc_formats::count::counted;
use flexsc_formats::reader_units::{rough_time, time};
use flexsc_formats::text_columns::columns;

use super::campaign_answer::{CampaignAnswer, CampaignRequirement};
use super::campaign_mode::RunSpread;
use super::fault_answer::fault_table;
use super::screen::{ScreenOptions, indented, warning_lines, wrapped};

/// Largest number of requirements, and of keys that drive one, on a first screen.
const MOST: [usize; 2] = [6, 1];
/// Largest number of lines on a first screen without its head, blank lines and its last one.
const MOST_LINES: usize = 10;
/// Least number of lines of warnings on a first screen.
const LEAST_WARNING: usize = 2;
/// Columns between the limit and the worst value, which are left out where no requirement has them.
const NOMINAL: usize = 3;

impl CampaignAnswer {
    /// Returns the answer as text; `took` is the real time that the runs took (s).
    pub fn screen(&self, took: Option<f64>, options: ScreenOptions) -> String {
        let took = took.map_or_else(String::new, |took| format!(" in {}", rough_time(took)));
        let head = format!("{}   {}   {}{took}", self.scenario, self.verdict_text, self.counted_runs());
        let mut blocks = vec![wrapped(&head, options.width, 4)];
        let texts: Vec<&str> = self.warnings.iter().map(|warning| &*warning.text).collect();
        let mut warnings = warning_lines(&texts, options);
        let is_asked = !self.requirements.is_empty() && self.runs > 0;
        let (table, lines) = if is_asked {
            (self.requirement_table(options), self.lines(options))
        } else {
            Default::default()
        };
        let room = MOST_LINES.saturating_sub(table.len() + lines.len()).max(LEAST_WARNING);
        if !options.all && warnings.len() > room {
            warnings.truncate(room - 1);
            warnings.push("    more: --all".to_owned());
        }
        blocks.extend([table, fault_table(&self.by_fault, options), warnings]);
        if options.all && self.runs > 0 {
            blocks.push(self.mode_table());
        }
        blocks.push(lines);
        let blocks = blocks.into_iter().filter(|block| !block.is_empty()).map(|block| block.join("\n"));
        options.style.styled(&blocks.collect::<Vec<_>>().join("\n\n"))
    }

    /// Returns the number of runs, with those that failed.
    pub(super) fn counted_runs(&self) -> String {
        let failed = if self.failed == 0 { String::new() } else { format!(", {} failed", self.failed) };
        counted(self.runs, "run") + &failed
    }

    fn requirement_table(&self, options: ScreenOptions) -> Vec<String> {
        let shown = if options.all { self.requirements.len() } else { MOST[0] };
        let heads = ["", "requirement", "limit", "nominal", "median", "95 %", "worst", "met"];
        let mut rows = vec![heads.map(str::to_owned).to_vec()];
        rows.extend(self.requirements.iter().take(shown).map(CampaignRequirement::cells));
        if self.requirements.iter().all(|own| own.nominal.is_none()) {
            for row in &mut rows {
                row.remove(NOMINAL);
            }
        }
        let mut lines = indented(columns(&rows, |_| true));
        let notes = self.requirements.iter().filter_map(|own| own.text.note.as_ref());
        lines.extend(notes.flat_map(|note| wrapped(&format!("  {note}"), options.width, 4)));
        if self.requirements.len() > shown {
            lines.push(format!("    {} more: --all", self.requirements.len() - shown));
        }
        lines
    }

    fn mode_table(&self) -> Vec<String> {
        if self.by_mode.is_empty() {
            return Vec::new();
        }
        let heads = ["mode", "in runs", "time: median", "95 %", "at limit: median", "largest", "target lost"];
        let mut rows = vec![heads.map(str::to_owned).to_vec()];
        let none = || "-".to_owned();
        rows.extend(self.by_mode.iter().map(|own| {
            let spread = |of: Option<RunSpread>, number: fn(RunSpread) -> f64| {
                of.map_or_else(none, |own| time(number(own)))
            };
            vec![
                own.mode.clone(),
                format!("{} of {}", own.runs, self.runs),
                spread(own.time_s, |own| own.median),
                spread(own.time_s, |own| own.p95),
                spread(own.at_limit_s, |own| own.median),
                spread(own.at_limit_s, |own| own.largest),
                if own.runs_lost == 0 { none() } else { counted(own.runs_lost, "run") },
            ]
        }));
        indented(columns(&rows, |column| column == 0))
    }

    /// Returns the keys that drive the first requirement, or, if all are wanted, each of them, and how the worst run is
    /// repeated.
    fn lines(&self, options: ScreenOptions) -> Vec<String> {
        let [requirements, keys] = if options.all { [usize::MAX; 2] } else { [1, MOST[1]] };
        let mut heads: Vec<[String; 2]> = Vec::new();
        let driven = self.requirements.iter().filter(|own| !own.driven_by.is_empty());
        for own in driven.take(requirements) {
            let name = if self.requirements.len() > 1 { format!("{}, ", own.name) } else { String::new() };
            let mut head = "driven by".to_owned();
            for key in own.driven_by.iter().take(keys) {
                heads.push([std::mem::take(&mut head), format!("{name}{}", key.text)]);
            }
        }
        heads.extend(self.least_robust.iter().map(|own| ["weakest".to_owned(), own.text()]));
        heads.extend(self.repeat.iter().map(|command| ["repeat".to_owned(), command.clone()]));
        let line = |[head, text]: [String; 2]| wrapped(&format!("  {head:<12}{text}"), options.width, 14);
        heads.into_iter().flat_map(line).collect()
    }
}

impl CampaignRequirement {
    fn cells(&self) -> Vec<String> {
        let text = &self.text;
        vec![
            self.decision.mark().to_owned(),
            self.name.clone(),
            format!("at most {}", text.limit),
            text.nominal.clone(),
            text.median.clone(),
            text.p95.clone(),
            text.worst.clone(),
            text.met.clone(),
        ]
    }
}
