//! Block of the requirements: value, limit, margin and worst instant of the run, and the runs of the campaign that meet each.

use flexsc_core::answer::{Answer, CampaignAnswer, RequirementAnswer};
use flexsc_core::formats::reader_units::time;

use super::html::{HtmlCell, HtmlRow, HtmlTable, cell, head, number_head};

/// Returns the table of the requirements, in the order of the scenario.
pub fn table(answer: &Answer, campaign: Option<&CampaignAnswer>) -> String {
    let mut heads = vec![head("No."), head("Requirement"), number_head("Value"), number_head("Limit")];
    heads.extend([number_head("Margin"), head("Verdict")]);
    let has_instants = answer.requirements.iter().any(|own| own.largest.is_some());
    heads.extend(has_instants.then(|| head("Worst instant")));
    heads.extend(campaign.map(|_| number_head("Campaign: runs that meet it")));
    let mut all: Vec<&RequirementAnswer> = answer.requirements.iter().collect();
    all.sort_by_key(|own| own.id[1..].parse::<usize>().unwrap_or(0));
    let rows = all.into_iter().map(|own| row(own, has_instants, campaign)).collect();
    HtmlTable { heads, rows, is_cards: true }.html()
}

fn row(own: &RequirementAnswer, has_instants: bool, campaign: Option<&CampaignAnswer>) -> HtmlRow {
    let text = &own.text;
    let worst = match &own.largest {
        Some(largest) => {
            let mode = largest.mode.as_ref().map_or_else(String::new, |mode| format!(", mode {mode}"));
            let value = text.largest.split_once(" at ").map_or("", |(value, _)| value);
            cell(&format!("{}{mode}", time(largest.at_s))).small(value)
        }
        None => cell(""),
    };
    let mut cells = vec![
        cell(&own.id),
        cell(&own.name).small(&own.description),
        cell(&text.value),
        cell(&text.limit),
        cell(&text.margin),
        HtmlCell::verdict(own.decision),
    ];
    cells.extend(has_instants.then_some(worst));
    let mut is_missed = own.decision.fails();
    if let Some(campaign) = campaign {
        let runs = campaign.requirements.iter().find(|other| other.id == own.id);
        is_missed |= runs.is_some_and(|runs| runs.decision.fails());
        cells.push(runs.map_or_else(HtmlCell::default, |runs| {
            cell(&runs.text.met).small(&runs.text.share_interval).hot(runs.decision.fails())
        }));
    }
    HtmlRow { cells, is_missed }
}
