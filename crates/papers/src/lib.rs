//! The papers that the studies come from, on one page: what each says beside what is measured, with the command behind
//! every number.
//!
//! A section is a template of Markdown, filled with what a [`Laboratory`] finds; see [`page`] for its language.

mod chart;
pub mod computed;
pub mod html;
mod number;
pub mod page;
pub mod paper;
pub mod verdict;

use std::sync::Arc;

use flexsc_figure::Figure;
use serde_json::Value;

pub use computed::Computed;
pub use html::Section;
pub use page::{Drawn, Form, Outcome};
pub use paper::Paper;
pub use verdict::Verdict;

/// What carries out the commands that a page names. Errors are words for people.
pub trait Laboratory: Send + Sync {
    /// What a command tells machines.
    ///
    /// # Errors
    /// A command that is not known, or fails.
    fn tell(&self, command: &str) -> Result<Value, String>;

    /// The times (s) and the values of a column of a run's full log.
    ///
    /// # Errors
    /// A command that is not known, is no simulation, or fails.
    fn column(&self, command: &str, topic: &str, name: &str) -> Result<[Vec<f64>; 2], String>;

    /// The figure `what` of a command, and the command as a user gives it.
    ///
    /// # Errors
    /// A command that is not known, or fails, or has no such figure.
    fn draw(&self, command: &str, what: &str) -> Result<(Figure, String), String>;
}

/// A paper's section in both forms.
pub struct Filled {
    /// For the page.
    pub section: Section,
    /// For the documentation.
    pub markdown: String,
}

/// Computes a paper's section.
///
/// # Errors
/// A template that is wrong, and a command that is not known or fails.
pub fn fill(paper: Paper, computed: Computed) -> Result<Filled, String> {
    let (name, computed) = (paper.name(), Arc::new(computed));
    let form =
        |form: Form| page::fill(&computed, paper.template(), form).map_err(|why| format!("{name}.md: {why}"));
    let (text, outcome) = form(Form::Html)?;
    let (markdown, _) = form(Form::Markdown)?;
    Ok(Filled { section: Section { name, text, outcome, times: computed.times() }, markdown })
}

/// The page of the documentation: sections in Markdown, below its heading.
pub fn documentation(sections: &[String]) -> String {
    format!("{HEAD}\n{}", sections.join("\n"))
}

const HEAD: &str = "# Published results and our values\n\n\
    <!-- Written by `flexsc reproduce -o . --docs docs` from crates/papers/templates: change it there. -->\n";
