//! Figures as files: SVG, PNG or both, each by itself or all on one sheet.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::ValueEnum;
#[cfg(feature = "png")]
use flexsc_figure::Renderer;
use flexsc_figure::{Named, sheet};
use rayon::prelude::*;
use serde_json::json;

use crate::failure::Failure;
#[cfg(not(feature = "png"))]
use crate::left_out::Renderer;
use crate::{files, print, say};

/// How files of other programs end: no directory for figures is meant to be called so.
const OTHERS: [&str; 14] =
    ["bmp", "eps", "gif", "htm", "html", "jpeg", "jpg", "json", "mcap", "pdf", "ps", "tif", "tiff", "webp"];

/// Whether a command that tells numbers also draws them.
#[derive(clap::Args)]
#[group(skip)]
pub struct Drawing {
    /// Draw what is told into this directory, made if it is not there
    #[arg(long, value_name = "DIR")]
    pub figures: Option<PathBuf>,
    /// Form of the figures
    #[arg(long, value_enum, default_value = EVERY.name(), requires = "figures")]
    pub format: Format,
}

impl Drawing {
    /// Draws figures if it is asked for.
    ///
    /// # Errors
    /// See [`Target::save`].
    pub fn save(&self, figures: impl FnOnce() -> Vec<Named>) -> Result<(), Failure> {
        let Some(directory) = &self.figures else { return Ok(()) };
        Target::Directory(directory.clone(), self.format).save(&figures(), false)
    }
}

/// The form of figures.
#[derive(Copy, Clone, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Vector graphics
    Svg,
    /// Pixels
    Png,
    /// One file of each
    Both,
}

/// All forms that this build can draw.
pub const EVERY: Format = if cfg!(feature = "png") { Format::Both } else { Format::Svg };

impl Format {
    /// What the command calls it.
    const fn name(self) -> &'static str {
        match self {
            Self::Svg => "svg",
            Self::Png => "png",
            Self::Both => "both",
        }
    }
}

/// Where figures go.
pub enum Target {
    /// One file in the form that its name says; several figures make up a sheet.
    File(PathBuf, Format),
    /// A directory: a file for each figure and form.
    Directory(PathBuf, Format),
}

impl Target {
    /// What `-o` and `--format` say, or a directory if there is no `-o`.
    pub fn new(out: Option<&Path>, otherwise: &Path, format: Option<Format>) -> Result<Self, Failure> {
        let out = out.unwrap_or(otherwise);
        let extension = out.extension().map(std::ffi::OsStr::to_ascii_lowercase);
        let said = match extension.as_deref().and_then(|extension| extension.to_str()) {
            _ if out.is_dir() => None,
            Some("svg") => Some(Format::Svg),
            Some("png") => Some(Format::Png),
            Some(other) if OTHERS.contains(&other) => {
                return Err(Failure::Arguments(format!(
                    "-o {}: figures cannot be written as .{other}\n\nhint: give a file that ends in .svg or .png, or a directory",
                    out.display()
                )));
            }
            _ => None,
        };
        match (said, format) {
            (None, format) => Ok(Self::Directory(out.to_owned(), format.unwrap_or(EVERY))),
            (Some(said), Some(format)) if format != said => Err(Failure::Arguments(format!(
                "--format: {} says another form\n\nhint: give a directory, or leave out --format",
                out.display()
            ))),
            (Some(said), _) => Ok(Self::File(out.to_owned(), said)),
        }
    }

    /// Draws figures, each with its name, and writes them; `json` tells of each file on stdout. Nothing is written if one
    /// cannot be drawn.
    ///
    /// # Errors
    /// A figure that cannot be drawn, and a file or a directory that cannot be written.
    pub fn save(&self, figures: &[Named], json: bool) -> Result<(), Failure> {
        match self {
            Self::Directory(directory, format) => save_each(directory, *format, figures, json),
            Self::File(path, format) => {
                let undrawn = |why| Failure::Draw { path: path.clone(), why };
                let drawn = figures.par_iter().map(|(_, figure)| figure.svg()).collect::<Result<Vec<_>, _>>();
                let svg = sheet(&drawn.map_err(undrawn)?);
                let bytes = match format {
                    Format::Svg | Format::Both => svg.into_bytes(),
                    Format::Png => Renderer::default().png(&svg).map_err(undrawn)?,
                };
                let names: Vec<&str> = figures.iter().map(|(name, _)| name.as_str()).collect();
                let bytes = [(path.clone(), bytes)];
                files::write_all(&bytes)?;
                tell(&bytes[0], &names, json)
            }
        }
    }
}

/// Writes figures into a directory, which is made if it is not there.
fn save_each(directory: &Path, format: Format, figures: &[Named], json: bool) -> Result<(), Failure> {
    files::make_directory(directory)?;
    let renderer = Renderer::default();
    let path = |name: &str, extension: &str| directory.join(format!("{name}.{extension}"));
    let draw = |(name, figure): &Named| -> Result<(String, Vec<u8>), Failure> {
        let undrawn = |why| Failure::Draw { path: path(name, "svg"), why };
        let svg = figure.svg().map_err(undrawn)?;
        let png = if format == Format::Svg { Vec::new() } else { renderer.png(&svg).map_err(undrawn)? };
        Ok((svg, png))
    };
    let drawn = figures.par_iter().map(draw).collect::<Result<Vec<_>, _>>()?;
    let mut names = Vec::new();
    let mut all = Vec::new();
    for ((name, _), (svg, png)) in figures.iter().zip(drawn) {
        if format != Format::Png {
            names.push(name);
            all.push((path(name, "svg"), svg.into_bytes()));
        }
        if format != Format::Svg {
            names.push(name);
            all.push((path(name, "png"), png));
        }
    }
    files::write_all(&all)?;
    names.into_iter().zip(&all).try_for_each(|(name, file)| tell(file, &[name], json))
}

/// Tells of a file with these figures.
fn tell((path, bytes): &(PathBuf, Vec<u8>), figures: &[&str], json: bool) -> Result<(), Failure> {
    if json {
        let object = json!({"file": path.display().to_string(), "figures": figures, "bytes": bytes.len()});
        return print(format!("{object}\n").as_bytes());
    }
    say!("{} ({:.0} kB)", path.display(), bytes.len() as f64 / 1e3);
    Ok(())
}
