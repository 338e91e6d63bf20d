//! Contrasts of images that requirements ask for: verdicts, what costs most, and curves over the spatial frequency.

use std::io::Write;

use flexsc_core::Scenario;
use flexsc_core::analysis::noise::RequiredContrast;
use flexsc_core::formats::count::counted;
use flexsc_core::formats::document::units_ratio;
use flexsc_core::formats::reader_units::{four_digits, time_span};
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Named, Panel, Point, colour};
use serde_json::{Value as Json, json};

use crate::error::CliError;
use crate::human::Units;
use crate::row_table::{Column, column, print_rows};
use crate::say;

/// Sources of which what they cost is printed, and the least cost.
const SHOWN: usize = 4;
const LEAST: f64 = 5e-5;
/// Unit of spatial frequencies that are written without one.
const PLAIN: &str = "cycles/rad";

/// Units in which the spatial frequencies of contrasts are written, each with its size in cycles/rad.
pub struct SpatialUnits(Vec<(String, f64)>);

impl SpatialUnits {
    /// Returns the units of a scenario's requirements.
    pub fn new(scenario: &Scenario) -> Self {
        let unit = |key: &str| {
            let written = scenario.written_unit(&format!("{key}.spatial_frequency")).unwrap_or(PLAIN);
            (written.to_owned(), units_ratio(written, PLAIN).unwrap_or(1.0))
        };
        Self(scenario.study.contrasts.iter().map(|own| unit(&own.key)).collect())
    }

    /// Returns the unit of a requirement by its number.
    fn unit(&self, place: usize) -> (&str, f64) {
        self.0.get(place).map_or((PLAIN, 1.0), |(name, size)| (name.as_str(), *size))
    }

    /// Returns the spatial frequency and the exposure of a requirement by its number, in words.
    fn place(&self, place: usize, own: &RequiredContrast) -> String {
        let (unit, size) = self.unit(place);
        let exposure = own.exposure_s.map_or_else(|| "long exposure".to_owned(), time_span);
        format!("{} {unit}, {exposure}", four_digits(own.spatial_frequency / size))
    }
}

/// Columns of the contrasts.
const CONTRASTS: [Column<'_>; 8] = [
    column("name", "requirement"),
    column("mtf", "MTF").decimals(4),
    column("least", "at least").decimals(4),
    column("margin", "margin").decimals(4),
    column("verdict", "verdict"),
    column("place", "at"),
    column("output", "worst about"),
    column("speed_rad_s", "wheels at"),
];

/// Columns of what sources cost.
const COSTS: [Column<'_>; 4] = [
    column("name", "requirement"),
    column("source", "costs most"),
    column("alone", "MTF with\nit alone").decimals(4),
    column("without", "MTF\nwithout it").decimals(4),
];

/// Prints the contrasts and what costs most of them.
pub fn print(contrasts: &[RequiredContrast], spatial: &SpatialUnits, units: Units) {
    if contrasts.is_empty() {
        return;
    }
    let row = |(place, own): (usize, &RequiredContrast)| {
        json!({
            "name": own.name, "mtf": own.mtf, "least": own.least, "margin": own.margin(),
            "verdict": verdict(own), "place": spatial.place(place, own), "output": own.output,
            "speed_rad_s": own.speed_rad_s,
        })
    };
    let rows: Vec<Json> = contrasts.iter().enumerate().map(row).collect();
    say!("  contrast (MTF) of images that requirements ask for");
    let has_speed = contrasts.iter().any(|own| own.speed_rad_s.is_some());
    print_rows(&rows, if has_speed { &CONTRASTS[..] } else { &CONTRASTS[..7] }, units);
    let costs: Vec<Json> = contrasts.iter().flat_map(cost_rows).collect();
    if !costs.is_empty() {
        print_rows(&costs, &COSTS, units);
    }
}

/// Returns the verdict on a contrast in a word.
pub fn verdict(own: &RequiredContrast) -> &'static str {
    if own.met { "met" } else { "missed" }
}

/// Returns the rows of the sources that cost most of a contrast.
fn cost_rows(own: &RequiredContrast) -> Vec<Json> {
    let mut name = own.name.as_str();
    let costly = own.costs.iter().filter(|cost| cost.without - own.mtf > LEAST).take(SHOWN);
    costly
        .map(|cost| {
            let mut row = json!(cost);
            row["name"] = json!(std::mem::take(&mut name));
            row
        })
        .collect()
}

/// Fails if a contrast is not met.
///
/// # Errors
/// The names of those that are missed.
pub fn require_met(name: &str, contrasts: &[RequiredContrast]) -> Result<(), CliError> {
    let missed: Vec<&str> = contrasts.iter().filter(|own| !own.met).map(|own| own.name.as_str()).collect();
    if missed.is_empty() {
        return Ok(());
    }
    let (count, all) = (missed.len(), counted(contrasts.len(), "requirement on the contrast"));
    Err(CliError::Requirements(format!("{name}: {count} of {all} not met: {}", missed.join(", "))))
}

/// Returns a figure of each contrast over the spatial frequency.
pub fn figures(name: &str, contrasts: &[RequiredContrast], spatial: &SpatialUnits) -> Vec<Named> {
    let figure = |(place, own): (usize, &RequiredContrast)| {
        let number = if place == 0 { String::new() } else { format!("-{}", place + 1) };
        (format!("{name}-mtf{number}"), figure(name, own, spatial.unit(place)))
    };
    contrasts.iter().enumerate().map(figure).collect()
}

fn figure(name: &str, own: &RequiredContrast, (unit, size): (&str, f64)) -> Figure {
    let points: Vec<Point> =
        own.curve.iter().map(|point| (point.spatial_frequency / size, point.mtf)).collect();
    let at = own.spatial_frequency / size;
    let x = FigureAxis::from_zero(
        &format!("spatial frequency ({unit})"),
        "",
        points.iter().map(|(frequency, _)| *frequency),
    );
    let y =
        FigureAxis::from_zero("contrast (MTF)", "", points.iter().map(|(_, mtf)| *mtf).chain([own.least]));
    let layers = vec![
        Layer::new("", colour::BLUE, LayerShape::Line(1.5), points),
        Layer::new(
            &format!("at least {}", four_digits(own.least)),
            colour::RED,
            LayerShape::Line(1.6),
            vec![(0.0, own.least), (at, own.least)],
        ),
        Layer::new(verdict(own), colour::BLACK, LayerShape::Ring, vec![(at, own.mtf)]),
    ];
    let title = format!("{name}: contrast of {}, {}", own.name, own.output);
    Figure { title, panels: vec![Panel::new(x, y, layers)], panel_height: 260 }
}
