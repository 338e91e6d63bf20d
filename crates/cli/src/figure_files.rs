//! Figure files: SVG, PNG or PDF, each figure in a file of its own or all on one sheet.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use clap::ValueEnum;
#[cfg(feature = "png")]
use flexsc_figure::Renderer;
use flexsc_figure::{Named, Style, is_figure, sheet};
use rayon::prelude::*;
use serde_json::json;

use crate::error::CliError;
use crate::out::Out;
#[cfg(not(feature = "png"))]
use crate::unavailable::Renderer;
use crate::{files, print, say};

/// File extensions of figures.
const FIGURES: [&str; 3] = ["svg", "png", "pdf"];

/// Whether a command that prints numbers also draws them.
#[derive(clap::Args)]
#[group(skip)]
pub struct FigureOutput {
    /// Plot the results: directory, created if missing, or one FILE.svg, .png or .pdf
    #[arg(short = 'o', long = "out", visible_alias = "figures", value_name = "DIR|FILE")]
    pub figures: Option<PathBuf>,
    /// Format of the figures [default: svg and png, or by the extension of FILE]
    #[arg(long, value_enum, requires = "figures")]
    pub format: Option<FigureFormat>,
    /// Replace a FILE of other content, and files in DIR that are no figures of flexsc
    #[arg(long, requires = "figures")]
    pub force: bool,
}

impl FigureOutput {
    /// Draws the figures if the command was asked to.
    ///
    /// # Errors
    /// See [`Target::save`].
    pub fn save(&self, figures: impl FnOnce() -> Vec<Named>) -> Result<(), CliError> {
        let Some(out) = &self.figures else { return Ok(()) };
        self.target(out, &[])?.save(&figures(), Style::default(), false)
    }

    /// Checks the target of the figures before they exist; `input` is the file that they are made from.
    pub fn check(&self, input: &Path) -> Result<(), CliError> {
        self.figures.as_ref().map_or(Ok(()), |out| self.target(out, &[input]).map(|_| ()))
    }

    fn target(&self, out: &Path, inputs: &[&Path]) -> Result<FigureTarget, CliError> {
        FigureTarget::new(out, self.format, inputs, self.force)
    }
}

/// The form of figures.
#[derive(Copy, Clone, PartialEq, Eq, ValueEnum)]
pub enum FigureFormat {
    /// Vector graphics
    Svg,
    /// Raster graphics
    Png,
    /// Vector graphics with embedded fonts, for LaTeX
    Pdf,
    /// SVG and PNG
    Both,
}

/// Every format that this build can draw.
pub const EVERY: FigureFormat = if cfg!(feature = "png") { FigureFormat::Both } else { FigureFormat::Svg };

impl FigureFormat {
    /// Returns the file formats, each with an extension of its own.
    const fn files(self) -> &'static [Self] {
        match self {
            Self::Svg => &[Self::Svg],
            Self::Png => &[Self::Png],
            Self::Pdf => &[Self::Pdf],
            Self::Both => &[Self::Svg, Self::Png],
        }
    }

    const fn extension(self) -> &'static str {
        match self {
            Self::Svg | Self::Both => "svg",
            Self::Png => "png",
            Self::Pdf => "pdf",
        }
    }

    /// Returns a drawn figure as the bytes of a file in this format.
    fn bytes(self, svg: &str, style: &Style, renderer: &Renderer) -> Result<Vec<u8>, String> {
        match self {
            Self::Svg | Self::Both => Ok(style.sized(svg).into_bytes()),
            Self::Png => renderer.png(svg, style),
            Self::Pdf => renderer.pdf(&style.sized(svg)),
        }
    }
}

/// Target of figures.
pub enum FigureTarget {
    /// A file with its format, where several figures form a sheet; the flag is true if another file may be replaced.
    File(PathBuf, FigureFormat, bool),
    /// A directory with a file for each figure and format; the flag is true if a file that is no figure may be replaced.
    Directory(PathBuf, FigureFormat, bool),
}

impl FigureTarget {
    /// Returns the target given by `-o`, `--format` and `--force`; `inputs` are the files that the figures are made
    /// from.
    pub fn new(
        out: &Path,
        format: Option<FigureFormat>,
        inputs: &[&Path],
        force: bool,
    ) -> Result<Self, CliError> {
        let (out, ending) = match Out::new(out, &FIGURES, inputs)? {
            Out::File(out, ending) => (out, ending),
            Out::Directory(out) => return Ok(Self::Directory(out, format.unwrap_or(EVERY), force)),
        };
        let every = [FigureFormat::Svg, FigureFormat::Png, FigureFormat::Pdf];
        let from_ending =
            every.into_iter().find(|format| format.extension() == ending).unwrap_or(FigureFormat::Svg);
        match format {
            Some(format) if format != from_ending => Err(CliError::Arguments(format!(
                "--format: {} has the extension of another format\n\nhint: give a directory, or leave out --format",
                out.display()
            ))),
            _ => Ok(Self::File(out, from_ending, force)),
        }
    }

    /// Draws and writes named figures; `json` prints an object for each file on stdout. No file is written if a figure
    /// cannot be drawn.
    ///
    /// # Errors
    /// A figure that cannot be drawn, and a file or a directory that cannot be written.
    pub fn save(&self, figures: &[Named], style: Style, json: bool) -> Result<(), CliError> {
        match self {
            Self::Directory(directory, format, force) => {
                save_each(directory, (*format, style), figures, (*force, json))
            }
            Self::File(path, format, force) => {
                let undrawn = |why| CliError::Draw { path: path.clone(), why };
                let svg = sheet(figures.iter().map(|(_, figure)| figure), &style).map_err(undrawn)?;
                let bytes = format.bytes(&svg, &style, &Renderer::default()).map_err(undrawn)?;
                let names: Vec<&str> = figures.iter().map(|(name, _)| name.as_str()).collect();
                files::write(path, &bytes, *force)?;
                print_written(&(path.clone(), bytes), &names, json)
            }
        }
    }
}

/// Writes figures to a directory, which is created if it does not exist.
fn save_each(
    directory: &Path,
    (format, style): (FigureFormat, Style),
    figures: &[Named],
    (force, json): (bool, bool),
) -> Result<(), CliError> {
    files::make_directory(directory)?;
    let renderer = Renderer::default();
    let draw = |(name, figure): &Named| -> Result<Vec<(PathBuf, Vec<u8>)>, CliError> {
        let path = |format: &FigureFormat| directory.join(format!("{name}.{}", format.extension()));
        let undrawn = |why| CliError::Draw { path: path(&format), why };
        let svg = figure.laid_out(&style).map_err(undrawn)?;
        let file = |format: &FigureFormat| {
            let undrawn = |why| CliError::Draw { path: path(format), why };
            Ok((path(format), format.bytes(&svg, &style, &renderer).map_err(undrawn)?))
        };
        format.files().iter().map(file).collect()
    };
    let drawn = figures.par_iter().map(draw).collect::<Result<Vec<_>, _>>()?;
    let names = figures.iter().flat_map(|(name, _)| format.files().iter().map(move |_| name));
    let names: Vec<&String> = names.collect();
    let all: Vec<_> = drawn.into_iter().flatten().collect();
    for (path, bytes) in &all {
        // A figure of before may be replaced: its name has that of its scenario.
        if !fs::read(path).is_ok_and(|existing| is_figure(&existing)) {
            files::refuse_other(path, bytes, force)?;
        }
    }
    files::write_within(&all)?;
    names.into_iter().zip(&all).try_for_each(|(name, file)| print_written(file, &[name], json))
}

/// Prints the path of a written file and the names of its figures.
fn print_written((path, bytes): &(PathBuf, Vec<u8>), figures: &[&str], json: bool) -> Result<(), CliError> {
    if json {
        let object = json!({"file": path.display().to_string(), "figures": figures, "bytes": bytes.len()});
        return print(format!("{object}\n").as_bytes());
    }
    say!("{} ({:.0} kB)", path.display(), bytes.len() as f64 / 1e3);
    Ok(())
}
