//! Answers of two campaigns side by side.

use flexsc_formats::text_columns::columns;
use serde::Serialize;

use super::campaign_answer::{CampaignAnswer, CampaignRequirement};
use super::key_difference::KeyDifference;
use super::run_comparison::{SIDES, heads, key_lines, paired};
use super::screen::{ScreenOptions, indented};
use crate::campaign::MOST_METRICS;

/// Two campaigns, and in what they differ.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CampaignComparison {
    /// Names of the two sides.
    pub names: [String; 2],
    /// Keys in which the scenarios differ.
    pub keys: Vec<KeyDifference>,
    /// Answer of each side.
    pub answers: [CampaignAnswer; 2],
}

impl CampaignComparison {
    /// Returns the comparison as text.
    pub fn screen(&self, options: ScreenOptions) -> String {
        let verdicts = self
            .answers
            .each_ref()
            .map(|answer| format!("{}   {}", answer.verdict_text, answer.counted_runs()));
        let blocks = [
            heads(&self.names, &verdicts),
            key_lines(&self.keys, options.all),
            self.requirement_lines(),
            self.metric_lines(options),
        ];
        let blocks = blocks.into_iter().filter(|block| !block.is_empty()).map(|block| block.join("\n"));
        options.style.styled(&blocks.collect::<Vec<_>>().join("\n\n"))
    }

    /// Returns a table with a row for each main metric and side, of campaigns without requirements.
    fn metric_lines(&self, options: ScreenOptions) -> Vec<String> {
        let mut rows = vec![["metric", "", "median", "95 %", "largest"].map(str::to_owned).to_vec()];
        let all = self.answers.each_ref().map(|answer| &answer.metrics[..]);
        let shown = if options.all { usize::MAX } else { MOST_METRICS };
        for (name, both) in paired(all, |own| own.name).into_iter().take(shown) {
            let largest = both.iter().flatten().map(|own| own.largest.abs().max(own.median.abs()));
            let unit = both.iter().flatten().next().map_or("", |own| own.unit);
            let unit = options.units.for_metric(name, largest.fold(0.0, f64::max), unit);
            for (side, own) in both.into_iter().enumerate() {
                let head = if side == 0 { name } else { "" };
                let cells = own.map_or_else(
                    || vec!["constant or none".to_owned()],
                    |own| [own.median, own.p95, own.largest].map(|value| unit.quantity(value)).to_vec(),
                );
                rows.push([head, SIDES[side]].map(str::to_owned).into_iter().chain(cells).collect());
            }
        }
        if rows.len() == 1 { Vec::new() } else { indented(columns(&rows, |column| column < 2)) }
    }

    /// Returns a table with a row for each requirement and side.
    fn requirement_lines(&self) -> Vec<String> {
        let heads = ["requirement", "", "limit", "median", "95 %", "worst", "met"];
        let mut rows = vec![heads.map(str::to_owned).to_vec()];
        let all = self.answers.each_ref().map(|answer| &answer.requirements[..]);
        for (name, both) in paired(all, |own| &own.name) {
            for (side, own) in both.into_iter().enumerate() {
                let head = if side == 0 { name } else { "" };
                let cells = own.map_or_else(|| vec!["not required".to_owned()], cells);
                rows.push([head, SIDES[side]].map(str::to_owned).into_iter().chain(cells).collect());
            }
        }
        if rows.len() == 1 { Vec::new() } else { indented(columns(&rows, |_| true)) }
    }
}

fn cells(own: &CampaignRequirement) -> Vec<String> {
    let text = &own.text;
    let met = format!("{} {}", own.decision.mark(), text.met);
    vec![format!("at most {}", text.limit), text.median.clone(), text.p95.clone(), text.worst.clone(), met]
}
