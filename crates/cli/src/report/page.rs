//! Page of a report: one HTML file without references to others.

use std::fmt::Write;

use flexsc_core::answer::EventKind;
use flexsc_core::formats::reader_units::time;

use super::html::{HtmlRow, HtmlTable, cell, command, escaped, head, list, number_head, numbered, picture};
use super::loop_blocks::LoopBlocks;
use super::study::{Study, StudyCampaign, StudyRun};
use super::{
    assumptions, campaign_block, conclusions, craft_block, mode_block, requirement_block, time_line,
};
use crate::bound;
use crate::results::Results;

/// Style of the page, on screens and on paper.
pub const STYLE: &str = include_str!("page.css");
/// Figures of a log that a page shows at once, the first of each that there are, and the largest number of them.
const SHOWN: [&str; 9] =
    ["pointing", "line-of-sight", "wheel", "angle", "envelope", "gain", "gimbals", "hinges", "deflection"];
const MOST_SHOWN: usize = 3;
/// Number of digits of a SHA-256 in the title block.
const SHA_DIGITS: usize = 12;
/// Largest size of the page up to which further figures are added (bytes).
const MOST_BYTES: usize = 1_400_000;

/// Block of a page: identifier, title and content.
struct PageBlock {
    id: &'static str,
    title: String,
    html: String,
}

/// Results that a page shows.
pub struct Review<'a> {
    pub study: &'a Study,
    pub run: &'a StudyRun,
    pub campaign: Option<&'a StudyCampaign>,
    pub loops: LoopBlocks,
    pub bounds: Option<bound::OutputBounds>,
    /// Script that reloads the page; empty for one that stays as it is.
    pub script: String,
}

/// Returns the page.
pub fn html(review: &Review<'_>) -> String {
    let Review { study, run, campaign, .. } = review;
    let answer = &run.answer;
    let mut page = opening(study, &review.script);
    page += &title_block(study, *campaign);
    let campaign_answer = campaign.map(|own| &own.answer);
    page += &conclusions::block(answer, campaign_answer, &review.loops.summary);
    let mut blocks = Vec::new();
    let mut add =
        |id, title: &str, html: String| blocks.push(PageBlock { id, title: title.to_owned(), html });
    if !answer.requirements.is_empty() {
        let table = requirement_block::table(answer, campaign_answer);
        let drawn = run.drawn("requirement").map_or_else(String::new, |svg| {
            picture(&svg, "Requirements over time: shaded while they count, with the instant that decides.")
        });
        add("requirements", "Requirements", table + &drawn + &command(&study.command("simulate", "")));
    }
    add("spacecraft", "Spacecraft", craft_block::block(study, Some(run)));
    add("time", "Time line", time_block(review));
    if answer.by_mode.is_empty() {
        add("run", "The run", mode_block::lines(answer) + &command(&study.command("simulate", "--all")));
    } else {
        let html = mode_block::table(answer) + &mode_block::lines(answer);
        add("modes", "By mode of operation", html + &command(&study.command("simulate", "--all")));
    }
    let of = if study.scenario.mode.is_empty() { "" } else { " of each mode" };
    add("margins", &format!("Margins{of}"), review.loops.margins.clone());
    add("noise", &format!("Noise{of}"), review.loops.noise.clone());
    if let Some(bounds) = &review.bounds {
        add("ranges", "Guaranteed ranges", ranges(study, bounds));
    }
    if let Some(campaign) = campaign {
        if let Some(budget) = campaign_block::budget(study, campaign) {
            add("budget", "Pointing budget", budget);
        }
        let title = format!("Campaign of {} runs", campaign.runs);
        add("campaign", &title, campaign_block::block(study, campaign));
    }
    add("assumptions", "Assumptions and what is left out", list(&assumptions::sentences(study)));
    let shown: usize = blocks.iter().map(|block| block.html.len()).sum();
    let more = further_figures(review, MOST_BYTES.saturating_sub(shown));
    page += &navigation(&blocks);
    for (place, block) in blocks.iter().enumerate() {
        let _ = writeln!(
            page,
            "<h2 id=\"{}\"><span>{}</span>{}</h2>\n{}",
            block.id,
            place + 1,
            escaped(&block.title),
            block.html
        );
    }
    page += &more;
    numbered(&(page + &scenario_text(study, blocks.len() + 1)))
}

fn opening(study: &Study, script: &str) -> String {
    let title = title(study);
    let issue = &study.scenario.document.issue;
    let foot = [
        study.scenario.name.clone(),
        if issue.is_empty() { String::new() } else { format!("issue {issue}") },
    ];
    let foot: Vec<String> = foot.into_iter().filter(|text| !text.is_empty()).collect();
    // The foot of a printed page is a string of CSS.
    let foot = foot.join(", ").replace(['\\', '"', '\n', '<'], " ");
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{}</title>\n<style>\n{}</style>\n{script}</head>\n<body>\n<main>\n<h1>{}</h1>\n{}",
        escaped(&title),
        STYLE.replace("FOOT", &foot),
        escaped(&title),
        subtitle(study, &title)
    )
}

fn title(study: &Study) -> String {
    let scenario = &study.scenario;
    [&scenario.document.title, &scenario.about, &scenario.name]
        .into_iter()
        .find(|text| !text.is_empty())
        .map_or_else(String::new, Clone::clone)
}

fn subtitle(study: &Study, title: &str) -> String {
    let about = &study.scenario.about;
    let text = if about.is_empty() || about == title { "Attitude control, design review" } else { about };
    format!("<p class=\"sub\">{}</p>\n", escaped(text))
}

/// Returns the title block; keys that are absent leave no empty field.
fn title_block(study: &Study, campaign: Option<&StudyCampaign>) -> String {
    let scenario = &study.scenario;
    let own = &scenario.document;
    let issue: Vec<&str> =
        [&own.issue, &own.date].into_iter().map(String::as_str).filter(|text| !text.is_empty()).collect();
    let epoch = scenario.epoch.map_or_else(String::new, |epoch| {
        format!(" from {}", epoch.to_string().replace('T', " ").replace('Z', " UTC"))
    });
    let cells = [
        ("Project", own.project.clone()),
        ("Author", own.author.clone()),
        ("Issue", issue.join(", ")),
        ("Scenario", format!("{}, SHA-256 {}", study.file(), &study.sha256()[..SHA_DIGITS])),
        ("Program", format!("flexsc {}", env!("CARGO_PKG_VERSION"))),
        ("Simulated", format!("{}{epoch}", time(scenario.duration.seconds()))),
        ("Seed", scenario.seed.to_string()),
        ("Campaign", campaign.map_or_else(String::new, |own| format!("{} runs", own.runs))),
    ];
    let cells = cells.iter().filter(|(_, text)| !text.is_empty());
    let cells = cells.map(|(name, text)| format!("<div><b>{name}</b>{}</div>", escaped(text)));
    format!("<div class=\"block\">{}</div>\n", cells.collect::<Vec<_>>().concat())
}

fn navigation(blocks: &[PageBlock]) -> String {
    let link = |block: &PageBlock| format!("<a href=\"#{}\">{}</a>\n", block.id, escaped(&block.title));
    format!("<nav>{}<a href=\"#file\">Scenario</a></nav>\n", blocks.iter().map(link).collect::<String>())
}

/// Returns the time line with the figures of the run.
fn time_block(review: &Review<'_>) -> String {
    let scenario = &review.study.scenario;
    let asks = |kind: EventKind| match kind {
        EventKind::Saturation => !scenario.actuator_limits().is_empty(),
        EventKind::Eclipse => scenario.environment.as_ref().is_some_and(|own| own.sun.is_some()),
        _ => false,
    };
    let answer = &review.run.answer;
    let mut html = String::new();
    if let Some(svg) = time_line::svg(answer, asks) {
        html += &picture(&svg, "Modes of operation and events. Point at a bar for its times.");
    }
    let kinds = review.run.kinds();
    for kind in shown(&kinds) {
        if let Some(svg) = review.run.drawn(kind) {
            html += &picture(&svg, &format!("{}.", sentence_of(kind)));
        }
    }
    let name = &scenario.name;
    html + &command(&format!(
        "{} --log full && flexsc plot {name}.mcap",
        review.study.command("simulate", "")
    ))
}

/// Returns the figures that are shown at once.
fn shown(kinds: &[String]) -> Vec<&String> {
    let mut shown: Vec<&String> =
        SHOWN.iter().filter_map(|name| kinds.iter().find(|kind| kind == name)).take(MOST_SHOWN).collect();
    if shown.is_empty() {
        shown = kinds.iter().take(MOST_SHOWN).collect();
    }
    shown
}

fn sentence_of(kind: &str) -> String {
    let text = kind.replace('-', " ");
    let mut letters = text.chars();
    letters
        .next()
        .map_or_else(String::new, |first| first.to_uppercase().collect::<String>() + letters.as_str())
}

/// Returns the other figures of the run, folded, up to a number of bytes.
fn further_figures(review: &Review<'_>, mut room: usize) -> String {
    let kinds = review.run.kinds();
    let shown = shown(&kinds);
    let mut html = String::new();
    for kind in kinds.iter().filter(|kind| !shown.contains(kind)) {
        let Some(svg) = review.run.drawn(kind).filter(|svg| svg.len() <= room) else { continue };
        room -= svg.len();
        html += &picture(&svg, &format!("{}.", sentence_of(kind)));
    }
    if html.is_empty() {
        return html;
    }
    format!("<details class=\"further\"><summary>Further figures of the run</summary>\n{html}</details>\n")
}

fn ranges(study: &Study, bounds: &bound::OutputBounds) -> String {
    let row = |(texts, fails): ([String; 5], bool)| {
        let mut cells: Vec<_> = texts.iter().map(|text| cell(text)).collect();
        cells[4] = cells[4].clone().hot(fails);
        HtmlRow { cells, is_missed: fails }
    };
    let heads = vec![
        head("Output"),
        number_head("Guaranteed range"),
        number_head("Limits"),
        number_head("Until"),
        head("Claim"),
    ];
    let mut html =
        HtmlTable { heads, rows: bounds.texts().into_iter().map(row).collect(), is_cards: false }.html();
    for (_, drawn) in bounds.figures() {
        if let Ok(svg) = drawn.svg() {
            html += &picture(
                &svg,
                "Guaranteed ranges over sets of initial states, inputs, frequencies and damping ratios.",
            );
        }
    }
    html + &command(&study.command("bound", ""))
}

fn scenario_text(study: &Study, number: usize) -> String {
    let text = study.text().trim_end();
    format!(
        "<section class=\"appendix\"><h2 id=\"file\"><span>{number}</span>Scenario</h2>\n\
         <details open><summary>{}, {} lines, SHA-256 {}</summary><pre>{}</pre></details></section>\n</main>\n</body>\n</html>\n",
        escaped(&study.file()),
        text.lines().count(),
        study.sha256(),
        escaped(text)
    )
}

#[cfg(test)]
mod tests {
    use super::SHOWN;
    use crate::plot::FigureName;

    #[test]
    fn figures_that_are_shown_at_once_exist() {
        for name in SHOWN {
            assert!(FigureName::parse(name).is_ok(), "{name}");
        }
    }
}
