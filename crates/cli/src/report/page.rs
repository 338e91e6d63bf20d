//! Page of a report: one HTML file without references to others.

use std::fmt::Write;

use flexsc_core::Scenario;

use super::section::{ReportBlock, ReportSection};

/// Style of the page, on screens and on paper.
const STYLE: &str = include_str!("page.css");

/// Returns the page of a scenario with these sections; `text` is that of the scenario's file.
pub fn html(scenario: &Scenario, set: &[String], text: &str, sections: &[ReportSection]) -> String {
    let name = escaped(&scenario.name);
    let mut page = String::new();
    // Writing to a string cannot fail.
    let _ = write!(
        page,
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{name}: design report</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<header>\n<h1>{name}</h1>\n"
    );
    if !scenario.about.is_empty() {
        let _ = writeln!(page, "<p class=\"about\">{}</p>", escaped(&scenario.about));
    }
    let _ = write!(
        page,
        "<p>Made by flexsc {}. The command under each block repeats it.</p>\n</header>\n<nav>\n<ol>\n",
        env!("CARGO_PKG_VERSION")
    );
    for (index, section) in sections.iter().enumerate() {
        let _ = writeln!(page, "<li><a href=\"#part-{}\">{}</a></li>", index + 1, escaped(section.title));
    }
    page.push_str("<li><a href=\"#scenario\">Scenario</a></li>\n</ol>\n</nav>\n<main>\n");
    for (index, section) in sections.iter().enumerate() {
        let _ = writeln!(page, "<section id=\"part-{}\">\n<h2>{}</h2>", index + 1, escaped(section.title));
        let _ = writeln!(page, "<p>{}</p>", escaped(&section.intro));
        section.blocks.iter().for_each(|block| add_block(&mut page, block));
        page.push_str("</section>\n");
    }
    page.push_str("<section id=\"scenario\">\n<h2>Scenario</h2>\n");
    if !set.is_empty() {
        let pairs: Vec<String> = set.iter().map(|pair| format!("<code>{}</code>", escaped(pair))).collect();
        let _ = writeln!(page, "<p>With the keys {}.</p>", pairs.join(", "));
    }
    let _ = write!(page, "<pre>{}</pre>\n</section>\n</main>\n</body>\n</html>\n", escaped(text.trim_end()));
    page
}

fn add_block(page: &mut String, block: &ReportBlock) {
    if !block.text.is_empty() {
        let class = if block.is_refused { " class=\"refused\"" } else { "" };
        let _ = writeln!(page, "<pre{class}>{}</pre>", escaped(&block.text));
    }
    let _ = writeln!(page, "<p class=\"command\"><code>{}</code></p>", escaped(&block.command));
    if !block.figures.is_empty() {
        page.push_str("<div class=\"figures\">\n");
        for figure in &block.figures {
            // The figure begins with its element.
            let from = figure.find("<svg").unwrap_or(0);
            let _ = writeln!(page, "<figure>{}</figure>", figure[from..].trim_end());
        }
        page.push_str("</div>\n");
    }
}

/// Returns a text for HTML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
