//! Figures as files: SVG, PNG or both.

use std::io::Write;
use std::path::Path;

use clap::ValueEnum;
use flexsc_core::whole;
use rayon::prelude::*;

use super::Figure;
use super::image::Renderer;
use crate::failure::Failure;
use crate::say;

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

/// Draws the figure of each item and writes it into a directory, which is made if it is not there. `name` is that of an
/// item's file without its extension. Nothing is written if one cannot be drawn.
///
/// # Errors
/// A figure that cannot be drawn, and a file or a directory that cannot be written.
pub fn save<T: Sync>(
    directory: &Path,
    format: Format,
    items: &[T],
    name: impl Fn(&T) -> String + Sync,
    figure: impl Fn(&T) -> Figure + Sync,
) -> Result<(), Failure> {
    std::fs::create_dir_all(directory).map_err(Failure::write(directory))?;
    let renderer = Renderer::new();
    let path = |item: &T, extension: &str| directory.join(format!("{}.{extension}", name(item)));
    let draw = |item: &T| -> Result<(String, Vec<u8>), Failure> {
        let undrawn = |why| Failure::Draw { path: path(item, "svg"), why };
        let svg = figure(item).svg().map_err(undrawn)?;
        let png = if format == Format::Svg { Vec::new() } else { renderer.png(&svg).map_err(undrawn)? };
        Ok((svg, png))
    };
    let drawn = items.par_iter().map(draw).collect::<Result<Vec<_>, _>>()?;
    for (item, (svg, png)) in items.iter().zip(&drawn) {
        if format != Format::Png {
            write(&path(item, "svg"), svg.as_bytes())?;
        }
        if format != Format::Svg {
            write(&path(item, "png"), png)?;
        }
    }
    Ok(())
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    whole::write(path, bytes).map_err(Failure::write(path))?;
    say!("{} ({:.0} kB)", path.display(), bytes.len() as f64 / 1e3);
    Ok(())
}
