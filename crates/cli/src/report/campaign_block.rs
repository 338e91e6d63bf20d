//! Block of the campaign: figures of the requirements, one table, and what drives them; and the budgets of pointing indices.

use flexsc_core::analysis::budget::{IndexBudget, LevelsAtProbability};
use flexsc_core::answer::{CampaignRequirement, FaultAnswer};
use flexsc_core::formats::reader_units::{ReaderUnits, number};

use super::conclusions::sentence;
use super::html::{HtmlRow, HtmlTable, cell, command, escaped, head, list, number_head, paragraph, picture};
use super::study::{Study, StudyCampaign};
use crate::results::Results;

/// Returns the block of the campaign.
pub fn block(study: &Study, campaign: &StudyCampaign) -> String {
    let keys: Vec<&str> = study.scenario.uncertain.keys().map(String::as_str).collect();
    let drawn = if keys.is_empty() {
        "The runs differ by their noise alone.".to_owned()
    } else {
        format!("Drawn for each run: {}, and all noise.", keys.join(", "))
    };
    let mut html = paragraph(&drawn);
    for (_, drawn) in &campaign.figures {
        if let Ok(svg) = drawn.svg() {
            html += &picture(&svg, &format!("Distribution over {} runs.", campaign.runs));
        }
    }
    let answer = &campaign.answer;
    if !answer.requirements.is_empty() {
        html += &table(&answer.requirements);
        html += &faults(&answer.by_fault);
        let driven = answer.requirements.iter().filter_map(|own| {
            Some(sentence(&format!("{} is driven by {}", own.name, own.driven_by.first()?.text)))
        });
        let notes = answer.requirements.iter().filter_map(|own| Some(sentence(own.text.note.as_ref()?)));
        html += &list(&driven.chain(notes).collect::<Vec<_>>());
    }
    if answer.failed > 0 {
        html += &paragraph(&format!("{} of {} runs failed.", answer.failed, answer.runs));
    }
    html +=
        &command(&study.command("simulate", &format!("--runs {} -o {}", campaign.runs, campaign.directory)));
    if let Some(first) = answer.requirements.first() {
        let (run, directory) = (first.worst.run, &campaign.directory);
        html += &command(&format!("flexsc simulate --from {directory} --row {run} -o run-{run}"));
    }
    html
}

fn table(requirements: &[CampaignRequirement]) -> String {
    let has_nominal = requirements.iter().any(|own| own.nominal.is_some());
    let mut heads = vec![head("No."), head("Requirement"), number_head("Limit")];
    heads.extend(has_nominal.then(|| number_head("Nominal")));
    heads.extend(["Median", "95 %", "Worst", "Least margin", "Met"].map(number_head));
    let row = |own: &CampaignRequirement| {
        let text = &own.text;
        let mut cells = vec![cell(&own.id), cell(&own.name), cell(&text.limit)];
        cells.extend(has_nominal.then(|| cell(&text.nominal)));
        cells.extend([&text.median, &text.p95, &text.worst, &text.margin].map(|text| cell(text)));
        cells.push(cell(&text.met).small(&text.share_interval).hot(own.decision.fails()));
        HtmlRow { cells, is_missed: own.decision.fails() }
    };
    HtmlTable { heads, rows: requirements.iter().map(row).collect(), is_cards: true }.html()
}

/// Returns the table of faults by requirements; empty unless the active fault varies.
fn faults(by_fault: &[FaultAnswer]) -> String {
    let Some(first) = by_fault.first() else { return String::new() };
    let mut heads = vec![head("Fault"), number_head("Runs")];
    heads.extend(first.requirements.iter().map(|own| number_head(&own.name)));
    let row = |own: &FaultAnswer| {
        let mut cells = vec![cell(&own.fault), cell(&own.runs.to_string())];
        cells.extend(own.requirements.iter().map(|own| cell(&own.text()).hot(own.decision.fails())));
        HtmlRow { cells, is_missed: own.requirements.iter().any(|own| own.decision.fails()) }
    };
    HtmlTable { heads, rows: by_fault.iter().map(row).collect(), is_cards: false }.html()
}

/// Returns the block of the budgets of pointing indices; `None` without a requirement on one.
pub fn budget(study: &Study, campaign: &StudyCampaign) -> Option<String> {
    let budgets = campaign.budgets.as_ref()?;
    let report = budgets.report();
    let mut html = String::new();
    for (place, own) in report.budgets.iter().enumerate() {
        html += "<h3>";
        html += &escaped(&format!("{}: {}", own.name, own.description));
        html += "</h3>\n";
        html += &levels(own);
        if let Some(svg) = budgets.figures().get(place).and_then(|(_, own)| own.svg().ok()) {
            html += &picture(&svg, &format!("Levels of {} over {} runs.", own.name, report.runs));
        }
    }
    Some(html + &command(&study.command("budget", &format!("--runs {}", report.runs))))
}

/// Returns the table of the levels of an index, and its sources.
fn levels(own: &IndexBudget) -> String {
    let unit = ReaderUnits::default().as_written(None, own.limit, own.unit);
    let heads = ["Level", "Temporal", "Ensemble", "Mixed", "Mixed, convolved", "Mixed, k sigma"];
    let mut heads: Vec<_> = heads.map(|text| number_head(format!("{text}, {}", unit.name))).into();
    heads[0] = head("Level");
    let row = |level: &LevelsAtProbability| {
        let value = |own: Option<f64>| cell(&own.map_or_else(|| "-".to_owned(), |value| unit.number(value)));
        let mut cells = vec![cell(&format!("{} %", number(100.0 * level.level)))];
        cells.extend(
            [level.temporal.campaign, level.ensemble.campaign, level.mixed.campaign]
                .map(|own| value(Some(own))),
        );
        cells.extend([level.mixed.convolution, level.mixed.rule].map(value));
        HtmlRow { cells, is_missed: false }
    };
    let table = HtmlTable { heads, rows: own.levels.iter().map(row).collect(), is_cards: false }.html();
    let sources = own.sources.as_ref().map_or_else(String::new, |sources| {
        let parts = [sources.bias, sources.bias_spread, sources.noise].map(|value| unit.quantity(value));
        paragraph(&format!(
            "By the runs: bias {}, {} rms from run to run; random part {} rms.",
            parts[0], parts[1], parts[2]
        ))
    });
    table + &sources
}
