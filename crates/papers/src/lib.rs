//! Reproduction of the papers behind the studies, on one page: each statement beside the measured result, with the
//! command for every number.
//!
//! A section is a Markdown template, filled with the results of a [`Laboratory`]; see [`page`] for its language.

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

/// Executor of the commands named in a page. Errors are messages for users.
pub trait Laboratory: Send + Sync {
    /// Returns the JSON output of a command.
    ///
    /// # Errors
    /// If the command is unknown or fails.
    fn run(&self, command: &str) -> Result<Value, String>;

    /// Returns the times (s) and the values of a column of a run's full log.
    ///
    /// # Errors
    /// If the command is unknown, is not a simulation, or fails.
    fn column(&self, command: &str, topic: &str, name: &str) -> Result<[Vec<f64>; 2], String>;

    /// Returns the figure `kind` of a command, and the command as a user would enter it.
    ///
    /// # Errors
    /// If the command is unknown or fails, or has no such figure.
    fn draw(&self, command: &str, kind: &str) -> Result<(Figure, String), String>;
}

/// Section of a paper in both output forms.
pub struct Filled {
    /// Section for the HTML page.
    pub section: Section,
    /// Markdown for the documentation.
    pub markdown: String,
}

/// Computes a paper's section.
///
/// # Errors
/// If the template is invalid, or a command is unknown or fails.
pub fn fill(paper: Paper, computed: Computed) -> Result<Filled, String> {
    let (name, computed) = (paper.name(), Arc::new(computed));
    let form =
        |form: Form| page::fill(&computed, paper.template(), form).map_err(|why| format!("{name}.md: {why}"));
    let (text, outcome) = form(Form::Html)?;
    let (markdown, _) = form(Form::Markdown)?;
    Ok(Filled { section: Section { name, text, outcome, times: computed.times() }, markdown })
}

/// Returns the documentation page: sections in Markdown, below its heading.
pub fn documentation(sections: &[String]) -> String {
    format!("{HEAD}\n{}", sections.join("\n"))
}

const HEAD: &str = "# Published results and our values\n\n\
    <!-- Written by `flexsc reproduce -o . --docs DIR` from crates/papers/templates: change it there. -->\n\n\
    - **Relay**: the printed numbers hold to their digits; late means are not smooth over the gain, and resonance stays bounded.\n\
    - **Finite rotation**: every printed number is recomputed; three formulas are misprints, and one system of equations contradicts itself.\n\
    - **Wheels**: 13 of 15 statements hold with constants that meet the printed design condition. No set has the unstable band, and\n  \
    the schedule settles in 180 s, not 170.\n\
    - **Space station**: mechanisms are compared, not figures, since the modes are not published.\n\
    - Constants that a paper does not print are ours; each section names them. A law that cannot be executed as printed is marked.\n";
