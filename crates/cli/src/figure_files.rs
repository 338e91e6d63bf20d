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

use crate::axes_in_units::AxesInUnits;
use crate::error::CliError;
use crate::human::{Units, UnitsArgs};
use crate::out::Out;
use crate::quantity::in_unit;
#[cfg(not(feature = "png"))]
use crate::unavailable::Renderer;
use crate::{files, print, say};

/// File extensions of figures.
const FIGURES: [&str; 3] = ["svg", "png", "pdf"];

/// Size and title of figures.
#[derive(clap::Args, Clone, Default)]
#[group(skip)]
pub struct FigureLook {
    /// Width of each figure on paper, such as 85 for one column [default: 800 px]
    #[arg(long, value_name = "MM", value_parser = in_unit("mm"))]
    width: Option<f64>,
    /// Font size of the axis labels on paper [default: 8 with --width]
    #[arg(long, value_name = "PT", value_parser = in_unit(""))]
    font: Option<f64>,
    /// Title above each figure
    #[arg(long, value_name = "TEXT")]
    title: Option<String>,
    #[command(flatten)]
    pub units: UnitsArgs,
}

impl FigureLook {
    /// Returns the style of the figures with their size.
    pub fn style(&self) -> Result<Style, CliError> {
        let style = Style::new(self.width, self.font)
            .map_err(|why| CliError::Arguments(format!("--width, --font: {why}")))?;
        Ok(if self.title.is_some() { style.titled() } else { style })
    }

    /// Returns the figures with the title and the units that are asked for.
    ///
    /// # Errors
    /// A unit in which no axis can be.
    pub fn finished(&self, mut figures: Vec<Named>) -> Result<Vec<Named>, CliError> {
        let mut in_units = AxesInUnits::new(self.units.units.0);
        for (_, figure) in &mut figures {
            if let Some(title) = &self.title {
                figure.title.clone_from(title);
            }
            in_units.show(figure);
        }
        in_units.finish().map_err(CliError::Arguments)?;
        Ok(figures)
    }
}

/// Figures of an analysis that are drawn, with their look.
#[derive(clap::Args, Clone, Default)]
#[group(skip)]
pub struct FigureChoice {
    /// Figures to draw, such as `bode` for SCENARIO-bode [default: all]
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    what: Vec<String>,
    #[command(flatten)]
    pub look: FigureLook,
}

impl FigureChoice {
    /// Returns the units of the text and of the figures.
    pub fn units(&self) -> Units {
        self.look.units.units
    }

    /// Checks the options before there are figures; `is_drawn` is true if a place for them is given.
    ///
    /// # Errors
    /// An option of figures that are not drawn, and a size that no figure has.
    pub fn check(&self, is_drawn: bool) -> Result<(), CliError> {
        let FigureLook { width, font, title, .. } = &self.look;
        let options = [
            ("--what", !self.what.is_empty()),
            ("--width", width.is_some()),
            ("--font", font.is_some()),
            ("--title", title.is_some()),
        ];
        if let Some((option, _)) = options.into_iter().find(|(_, is_given)| *is_given && !is_drawn) {
            let why = format!("{option}: no figure is drawn\n\nhint: give a directory or a file with -o");
            return Err(CliError::Arguments(why));
        }
        self.look.style().map(|_| ())
    }

    /// Returns the figures that are asked for, of all that there are.
    ///
    /// # Errors
    /// An analysis without figures, a name that none of them has, and a unit in which no axis can be.
    pub fn chosen(&self, all: Vec<Named>) -> Result<Vec<Named>, CliError> {
        if all.is_empty() {
            return Err(CliError::Arguments("-o: this analysis has no figures".to_owned()));
        }
        if let Some(missing) = self.what.iter().find(|what| !all.iter().any(|(name, _)| is_named(name, what)))
        {
            let names: Vec<&str> = all.iter().map(|(name, _)| name.as_str()).collect();
            return Err(CliError::Arguments(format!(
                "--what: there is no figure `{missing}`\n\nhint: there is {}",
                without_common_start(&names).join(", ")
            )));
        }
        let is_asked = |name: &str| self.what.is_empty() || self.what.iter().any(|what| is_named(name, what));
        self.look.finished(all.into_iter().filter(|(name, _)| is_asked(name)).collect())
    }
}

/// Returns true if a figure goes by a name: the name of its file, the part of it behind the scenario, or that without the output
/// that it shows.
fn is_named(file: &str, what: &str) -> bool {
    let ends = file.match_indices('-').map(|(place, _)| &file[place + 1..]);
    let is_own =
        |end: &str| end.strip_prefix(what).is_some_and(|rest| rest.is_empty() || rest.starts_with('_'));
    ends.chain([file]).any(is_own)
}

/// Returns names of files without the words that all begin with.
fn without_common_start<'a>(names: &[&'a str]) -> Vec<&'a str> {
    let words = |name: &&'a str| name.match_indices('-').map(|(place, _)| place + 1).collect::<Vec<_>>();
    let first = names.first().copied().unwrap_or_default();
    let ends = names.first().map(words).unwrap_or_default().into_iter().rev();
    let is_common =
        |end: &usize| names.len() > 1 && names.iter().all(|name| name.starts_with(&first[..*end]));
    let start = ends.into_iter().find(is_common).unwrap_or(0);
    names.iter().map(|name| &name[start..]).collect()
}

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
    #[command(flatten)]
    pub choice: FigureChoice,
}

impl FigureOutput {
    /// Draws the figures if the command was asked to.
    ///
    /// # Errors
    /// See [`Target::save`].
    pub fn save(&self, figures: impl FnOnce() -> Vec<Named>) -> Result<(), CliError> {
        let Some(out) = &self.figures else { return Ok(()) };
        let choice = &self.choice;
        self.target(out, &[])?.save(&choice.chosen(figures())?, choice.look.style()?, false)
    }

    /// Checks the target of the figures before they exist; `input` is the file that they are made from.
    pub fn check(&self, input: &Path) -> Result<(), CliError> {
        self.choice.check(self.figures.is_some())?;
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_go_by_the_end_of_their_names() {
        let names = ["a-b-root-locus", "a-b-bode", "a-b-density_roll"];
        let chosen =
            |what: &str| -> Vec<&str> { names.iter().copied().filter(|name| is_named(name, what)).collect() };
        assert_eq!(chosen("bode"), ["a-b-bode"]);
        assert_eq!(chosen("root-locus"), ["a-b-root-locus"]);
        assert_eq!(
            (chosen("density"), chosen("density_roll")),
            (vec!["a-b-density_roll"], vec!["a-b-density_roll"])
        );
        assert_eq!((chosen("dens"), chosen("a-b-bode")), (vec![], vec!["a-b-bode"]));
        assert_eq!(without_common_start(&names), ["root-locus", "bode", "density_roll"]);
        assert_eq!(without_common_start(&names[..1]), ["a-b-root-locus"]);
    }

    #[test]
    fn an_analysis_without_figures_draws_none() {
        let refused = FigureChoice::default().chosen(Vec::new()).map(|figures| figures.len());
        assert!(refused.is_err_and(|why| why.to_string().contains("has no figures")));
    }
}
