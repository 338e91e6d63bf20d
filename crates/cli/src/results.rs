//! Results of an analysis: the same numbers and figures for people, for machines and for the pages of `reproduce`.

use flexsc_figure::Named;
use serde_json::{Value as Json, json};

use crate::error::CliError;
use crate::figure_files::FigureOutput;
use crate::number_table::NumberTable;
use crate::print;

/// Results of an analysis.
pub trait Results {
    /// Returns the objects that `--json` prints, one per line.
    fn json(&self) -> Vec<Json>;

    /// Returns the figures, each with the name of its file; by default none.
    fn figures(&self) -> Vec<Named> {
        Vec::new()
    }

    /// Returns the table that is written as CSV; by default none.
    fn table(&self) -> Option<NumberTable> {
        None
    }

    /// Prints the results as text.
    fn print(&self) -> Result<(), CliError>;
}

/// Draws the figures if the arguments ask for them, and prints text or JSON.
pub fn show(results: &dyn Results, drawing: Option<&FigureOutput>, as_json: bool) -> Result<(), CliError> {
    if let Some(drawing) = drawing {
        drawing.save(|| results.figures())?;
    }
    if as_json { print_lines(&results.json()) } else { results.print() }
}

/// Prints objects, one per line.
pub fn print_lines(objects: &[Json]) -> Result<(), CliError> {
    let lines: Vec<String> = objects.iter().map(|object| format!("{object}\n")).collect();
    print(lines.concat().as_bytes())
}

/// Returns an object whose first key is the scenario.
pub fn with_scenario_name(name: &str, table: Json) -> Json {
    let mut object = json!({ "scenario": name });
    if let (Some(object), Json::Object(table)) = (object.as_object_mut(), table) {
        object.extend(table);
    }
    object
}
