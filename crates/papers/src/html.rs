//! Page as self-contained HTML in one file, without scripts.

use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd, html};

use crate::page::{Drawn, Outcome};

const STYLE: &str = include_str!("page.css");

/// Section of a paper, filled with results.
pub struct Section {
    /// Name of the paper.
    pub name: String,
    /// Markdown text, with placeholders for the figures.
    pub text: String,
    /// Figures and verdicts.
    pub outcome: Outcome,
    /// Commands with their durations (s).
    pub times: Vec<(String, f64)>,
}

/// Returns the page of some sections, with the total duration `took` (s) and the number of threads.
pub fn page(sections: &[Section], took: f64, threads: usize) -> String {
    let verdicts: Vec<_> = sections.iter().flat_map(|section| &section.outcome.verdicts).collect();
    let holds = verdicts.iter().filter(|verdict| verdict.holds).count();
    let figures: usize = sections.iter().map(|section| section.outcome.figures.len()).sum();
    let unexpected: Vec<_> = verdicts.iter().filter(|verdict| !verdict.is_as_expected()).collect();
    let known = if unexpected.is_empty() {
        "as known".to_owned()
    } else {
        let names: Vec<String> = unexpected.iter().map(|verdict| escaped(&verdict.name)).collect();
        format!("<b class=\"no\">otherwise than known: {}</b>", names.join("; "))
    };
    let body: Vec<String> = sections.iter().map(Section::html).collect();
    let (version, system, machine) =
        (env!("CARGO_PKG_VERSION"), std::env::consts::OS, std::env::consts::ARCH);
    let times: Vec<String> = sections.iter().flat_map(|section| &section.times).map(row).collect();
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>flexsc: published results and our values</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n\
         <h1>Published results and our values</h1>\n\
         <p class=\"about\">Made by <code>flexsc reproduce</code>, version {version}, on {system} ({machine}) with {threads} threads in \
         {took:.1} s. {} verdicts, {known}: {holds} statements hold, {} do not. {figures} figures. Every number under \"we measure\" \
         was computed for this page by the command beside it.</p>\n<ul class=\"contents\">\n{}</ul>\n{}\
         <h2>What was run</h2>\n<p>Each command once; several share the machine, so that their times are not those of the command \
         alone.</p>\n<table class=\"times\">\n<thead><tr><th>command</th><th>s</th></tr></thead>\n<tbody>\n{}</tbody>\n</table>\n\
         </body>\n</html>\n",
        verdicts.len(),
        verdicts.len() - holds,
        sections.iter().map(Section::entry).collect::<String>(),
        body.concat(),
        times.concat(),
    )
}

fn row((command, seconds): &(String, f64)) -> String {
    format!("<tr><td><code>{}</code></td><td>{seconds:.2}</td></tr>\n", escaped(command))
}

impl Section {
    /// Returns the section's line of the contents.
    fn entry(&self) -> String {
        let heading = self.text.lines().find_map(|line| line.strip_prefix("## ")).unwrap_or(&self.name);
        let (verdicts, figures) = (&self.outcome.verdicts, self.outcome.figures.len());
        let holds = verdicts.iter().filter(|verdict| verdict.holds).count();
        format!(
            "<li><a href=\"#{}\">{}</a>: {holds} of {} statements hold, {figures} figures</li>\n",
            self.name,
            escaped(heading),
            verdicts.len()
        )
    }

    fn html(&self) -> String {
        let mut text = String::new();
        // The page is self-contained: links to the documentation are removed.
        let link = |event: &Event| matches!(event, Event::Start(Tag::Link { .. }) | Event::End(TagEnd::Link));
        let events = Parser::new_ext(&self.text, Options::ENABLE_TABLES).filter(|event| !link(event));
        html::push_html(&mut text, events);
        for drawn in &self.outcome.figures {
            text = text.replace(&format!("<!--figure {}-->", drawn.name), &drawn.html());
        }
        // Makes wide tables scroll within themselves.
        text = text.replace("<table>", "<div class=\"table\"><table>").replace("</table>", "</table></div>");
        format!("<section id=\"{}\">\n{text}</section>\n", self.name)
    }
}

impl Drawn {
    fn html(&self) -> String {
        let Self { svg, caption, command, .. } = self;
        let caption = escaped(caption);
        format!(
            "<figure>\n{svg}<figcaption>{caption}<br><code>flexsc {}</code></figcaption>\n</figure>\n",
            escaped(command)
        )
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
