//! Figures as files: SVG, PNG or PDF, each by itself or all on one sheet.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::ValueEnum;
#[cfg(feature = "png")]
use flexsc_figure::Renderer;
use flexsc_figure::{Named, Style, sheet};
use rayon::prelude::*;
use serde_json::json;

use crate::failure::Failure;
#[cfg(not(feature = "png"))]
use crate::left_out::Renderer;
use crate::{files, print, say};

/// How files of other programs end: no directory for figures is meant to be called so.
const OTHERS: [&str; 13] =
    ["bmp", "eps", "gif", "htm", "html", "jpeg", "jpg", "json", "mcap", "ps", "tif", "tiff", "webp"];

/// Whether a command that prints numbers also draws them.
#[derive(clap::Args)]
#[group(skip)]
pub struct Drawing {
    /// Plot the results: directory, created if missing, or one FILE.svg, .png or .pdf
    #[arg(short = 'o', long = "out", visible_alias = "figures", value_name = "DIR|FILE")]
    pub figures: Option<PathBuf>,
    /// Format of the figures [default: svg and png, or by the extension of FILE]
    #[arg(long, value_enum, requires = "figures")]
    pub format: Option<Format>,
}

impl Drawing {
    /// Draws figures if it is asked for.
    ///
    /// # Errors
    /// See [`Target::save`].
    pub fn save(&self, figures: impl FnOnce() -> Vec<Named>) -> Result<(), Failure> {
        let Some(out) = &self.figures else { return Ok(()) };
        Target::new(Some(out), out, self.format)?.save(&figures(), Style::default(), false)
    }
}

/// The form of figures.
#[derive(Copy, Clone, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Vector graphics
    Svg,
    /// Raster graphics
    Png,
    /// Vector graphics with embedded fonts, for LaTeX
    Pdf,
    /// SVG and PNG
    Both,
}

/// All forms that this build can draw.
pub const EVERY: Format = if cfg!(feature = "png") { Format::Both } else { Format::Svg };

impl Format {
    /// The forms of files, each with its extension.
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

    /// A drawn figure as a file of this form.
    fn bytes(self, svg: &str, style: &Style, renderer: &Renderer) -> Result<Vec<u8>, String> {
        match self {
            Self::Svg | Self::Both => Ok(style.sized(svg).into_bytes()),
            Self::Png => renderer.png(svg, style),
            Self::Pdf => renderer.pdf(&style.sized(svg)),
        }
    }
}

/// The form that a file's name says.
fn said(path: &Path) -> Option<Format> {
    let extension = path.extension()?.to_ascii_lowercase();
    [Format::Svg, Format::Png, Format::Pdf].into_iter().find(|format| extension == format.extension())
}

/// Whether a path is that of a figure.
pub fn is_figure(path: &Path) -> bool {
    said(path).is_some() && !path.is_dir()
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
        let said = if out.is_dir() { None } else { said(out) };
        let other = out.extension().map(std::ffi::OsStr::to_ascii_lowercase);
        let other = other.as_deref().and_then(|extension| extension.to_str()).filter(|_| !out.is_dir());
        if let Some(other) = other.filter(|other| OTHERS.contains(other)) {
            return Err(Failure::Arguments(format!(
                "-o {}: figures cannot be written as .{other}\n\nhint: give a file that ends in .svg, .png or .pdf, or a directory",
                out.display()
            )));
        }
        match (said, format) {
            (None, format) => Ok(Self::Directory(out.to_owned(), format.unwrap_or(EVERY))),
            (Some(said), Some(format)) if format != said => Err(Failure::Arguments(format!(
                "--format: {} has the extension of another format\n\nhint: give a directory, or leave out --format",
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
    pub fn save(&self, figures: &[Named], style: Style, json: bool) -> Result<(), Failure> {
        match self {
            Self::Directory(directory, format) => save_each(directory, (*format, style), figures, json),
            Self::File(path, format) => {
                let undrawn = |why| Failure::Draw { path: path.clone(), why };
                let svg = sheet(figures.iter().map(|(_, figure)| figure), &style).map_err(undrawn)?;
                let bytes = format.bytes(&svg, &style, &Renderer::default()).map_err(undrawn)?;
                let names: Vec<&str> = figures.iter().map(|(name, _)| name.as_str()).collect();
                let bytes = [(path.clone(), bytes)];
                files::write_all(&bytes)?;
                tell(&bytes[0], &names, json)
            }
        }
    }
}

/// Writes figures into a directory, which is made if it is not there.
fn save_each(
    directory: &Path,
    (format, style): (Format, Style),
    figures: &[Named],
    json: bool,
) -> Result<(), Failure> {
    files::make_directory(directory)?;
    let renderer = Renderer::default();
    let draw = |(name, figure): &Named| -> Result<Vec<(PathBuf, Vec<u8>)>, Failure> {
        let path = |format: &Format| directory.join(format!("{name}.{}", format.extension()));
        let undrawn = |why| Failure::Draw { path: path(&format), why };
        let svg = figure.laid_out(&style).map_err(undrawn)?;
        let file = |format: &Format| {
            let undrawn = |why| Failure::Draw { path: path(format), why };
            Ok((path(format), format.bytes(&svg, &style, &renderer).map_err(undrawn)?))
        };
        format.files().iter().map(file).collect()
    };
    let drawn = figures.par_iter().map(draw).collect::<Result<Vec<_>, _>>()?;
    let names = figures.iter().flat_map(|(name, _)| format.files().iter().map(move |_| name));
    let names: Vec<&String> = names.collect();
    let all: Vec<_> = drawn.into_iter().flatten().collect();
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
