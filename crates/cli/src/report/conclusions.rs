//! Conclusions of a report: the verdict as a sentence, then at most four more.

use flexsc_core::answer::{Answer, CampaignAnswer, RunVerdict};
use flexsc_core::formats::count::counted;

use super::html::{escaped, list};
use super::loop_blocks::LoopSummary;

/// Largest number of sentences below the verdict, and of warnings among them.
const MOST: [usize; 2] = [4, 2];

/// Returns the block of the conclusions, with a bar in the colour of the verdict.
pub fn block(answer: &Answer, campaign: Option<&CampaignAnswer>, loops: &LoopSummary) -> String {
    let is_missed = campaign.is_some_and(|own| own.verdict == RunVerdict::Missed);
    let class = match answer.verdict {
        RunVerdict::Failed | RunVerdict::Missed => "red",
        _ if is_missed => "red",
        RunVerdict::MetBut | RunVerdict::GoalMissed => "amber",
        RunVerdict::Met | RunVerdict::GoalMet => "green",
        RunVerdict::NotAsked => "plain",
    };
    let mut sentences: Vec<String> =
        answer.warnings.iter().take(MOST[1]).map(|own| sentence(&own.text)).collect();
    sentences.extend(
        campaign.and_then(|own| campaign_sentence(own, is_missed && answer.verdict != RunVerdict::Missed)),
    );
    sentences.extend(least_margin_sentence(answer));
    sentences.extend(loops.margins.clone());
    sentences.extend(loops.accuracy.clone());
    sentences.truncate(MOST[0]);
    let missed = campaign.filter(|_| is_missed && answer.verdict != RunVerdict::Missed);
    let verdict = missed.map_or(&answer.verdict_text, |campaign| &campaign.verdict_text);
    let head = sentence(&verdict.replace("MISSED: ", "Missed: ").replace("FAILED: ", "Failed: "));
    format!("<section class=\"answer {class}\"><h2>{}</h2>\n{}</section>\n", escaped(&head), list(&sentences))
}

/// Returns a text as a sentence: with a capital and a full stop.
pub fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map_or_else(String::new, |first| first.to_uppercase().collect());
    let end = if text.ends_with('.') { "" } else { "." };
    format!("{first}{}{end}", letters.as_str())
}

/// Returns what the campaign says; how many runs meet what is asked, unless it is the verdict.
fn campaign_sentence(campaign: &CampaignAnswer, is_verdict: bool) -> Option<String> {
    campaign.met.as_ref()?;
    let first = campaign.requirements.first()?;
    let text = campaign.verdict_text.trim_start_matches("MISSED: ").trim_start_matches("undecided: ");
    let driven = first.driven_by.first().map(|own| format!("{} is driven by {}.", first.name, own.text));
    let share = (!is_verdict).then(|| format!("campaign: {text}."));
    let text: Vec<String> = share.into_iter().chain(driven).map(|text| sentence(&text)).collect();
    (!text.is_empty()).then(|| text.join(" "))
}

/// Returns which requirements are met, and by how much at least.
fn least_margin_sentence(answer: &Answer) -> Option<String> {
    let met: Vec<_> = answer.requirements.iter().filter(|own| own.met).collect();
    let least =
        met.iter().filter(|own| own.margin.is_finite()).min_by(|a, b| a.margin.total_cmp(&b.margin))?;
    let text = &least.text;
    let rest = match met.len() {
        1 => String::new(),
        all => format!(" In the run {} are met; the least margin is that of", counted(all, "requirement")),
    };
    Some(if rest.is_empty() {
        let name = sentence(&least.name);
        let name = name.trim_end_matches('.');
        format!("{name} is met in the run with {} of {}: margin {}.", text.value, text.limit, text.margin)
    } else {
        format!("{} {}: {} of {}, {}.", rest.trim_start(), least.name, text.value, text.limit, text.margin)
    })
}

#[cfg(test)]
mod tests {
    use super::sentence;

    #[test]
    fn texts_become_sentences() {
        assert_eq!(sentence("pass: target lost in 3 of 3 visits"), "Pass: target lost in 3 of 3 visits.");
        assert_eq!(sentence("2 of 2 requirements met."), "2 of 2 requirements met.");
    }
}
