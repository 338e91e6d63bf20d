//! Files of results: figures, or a table as CSV, by the extension of the file.

use std::io::Write;
use std::path::{Path, PathBuf};

use flexsc_core::formats::count::counted;

use crate::error::CliError;
use crate::figure_files::{FigureChoice, FigureFormat, FigureTarget};
use crate::out::{self, Out};
use crate::results::Results;
use crate::{files, say};

/// File extensions of figures and tables.
const FILES: [&str; 4] = ["svg", "png", "pdf", "csv"];

/// Whether a command that prints numbers also draws them or writes them as a table.
#[derive(clap::Args)]
#[group(skip)]
pub struct ResultOutput {
    /// Plot the results: directory, created if missing, or one FILE.svg, .png or .pdf. FILE.csv: write them as a table
    #[arg(short = 'o', long = "out", visible_alias = "figures", value_name = "DIR|FILE")]
    pub out: Option<PathBuf>,
    /// Format of the figures [default: svg and png, or by the extension of FILE]
    #[arg(long, value_enum, requires = "out")]
    pub format: Option<FigureFormat>,
    /// Replace a FILE of other content, and files in DIR that are no figures of flexsc
    #[arg(long, requires = "out")]
    pub force: bool,
    #[command(flatten)]
    pub choice: FigureChoice,
}

impl ResultOutput {
    /// Returns the file FILE.toml of a scenario among the results, if the command was asked for one.
    ///
    /// # Errors
    /// A file that is an input.
    pub fn scenario_file(&self, inputs: &[&Path]) -> Result<Option<PathBuf>, CliError> {
        let Some(out) = self.out.as_ref().filter(|out| out::ending(out) == Some("toml")) else {
            return Ok(None);
        };
        match Out::new(out, &["toml"], inputs)? {
            Out::File(path, _) => Ok(Some(path)),
            Out::Directory(_) => Ok(None),
        }
    }

    /// Returns the target of the results, if the command was asked for one; `inputs` are the files that the results are
    /// made from.
    ///
    /// # Errors
    /// A file with another extension, one that is an input, and a format that contradicts the extension.
    pub fn target(&self, inputs: &[&Path]) -> Result<Option<ResultTarget>, CliError> {
        self.choice.check(self.out.is_some())?;
        let Some(out) = &self.out else { return Ok(None) };
        if let Out::File(path, "csv") = Out::new(out, &FILES, inputs)? {
            if self.format.is_some() {
                return Err(CliError::Arguments(format!(
                    "--format: {} is a table\n\nhint: give a directory, or leave out --format",
                    path.display()
                )));
            }
            return Ok(Some(ResultTarget::Table { path, force: self.force }));
        }
        let figures = FigureTarget::new(out, self.format, inputs, self.force)?;
        Ok(Some(ResultTarget::Figures(figures, self.choice.clone())))
    }
}

/// Target of results.
pub enum ResultTarget {
    /// Figures, and which of them.
    Figures(FigureTarget, FigureChoice),
    /// Table as CSV; `force` is true if another file may be replaced.
    Table { path: PathBuf, force: bool },
}

impl ResultTarget {
    /// Draws the figures or writes the table.
    ///
    /// # Errors
    /// See [`FigureTarget::save`]; results without a table, and a file that cannot be written.
    pub fn save(&self, results: &dyn Results) -> Result<(), CliError> {
        let (path, force) = match self {
            Self::Figures(target, choice) => {
                return target.save(&choice.chosen(results.figures())?, choice.look.style()?, false);
            }
            Self::Table { path, force } => (path, *force),
        };
        let Some(table) = results.table() else {
            return Err(CliError::Arguments(format!("-o {}: there is no table of them", path.display())));
        };
        let csv = table.to_csv().map_err(|error| CliError::write(path)(error.into()))?;
        files::write(path, &csv, force)?;
        say!("{}: {}", path.display(), counted(table.rows.len(), "row"));
        Ok(())
    }
}
