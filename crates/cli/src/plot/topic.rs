//! Figure of any topic of a log, from its rows alone: a panel for the fields of each unit, and a line for each field.

use std::collections::BTreeMap;
use std::path::Path;

use flexsc_core::record::{Column, Columns, Log};
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, RGBColor, colour, name_and_unit};

use super::time;
use super::title::readable;
use crate::error::CliError;

/// Colours of the lines of a panel, cyclic.
const COLOURS: [RGBColor; 5] = [colour::BLUE, colour::VERMILLION, colour::GREEN, colour::ORANGE, colour::SKY];
/// Largest number of panels and of lines in a panel.
const MOST: usize = 12;
/// Columns of indices, that distinguish the rows of one topic.
const INDICES: [&str; 3] = ["axis", "sensor", "wheel"];
/// Endings of the engine's field names with their units, and the quantity of several such fields.
const UNITS: [(&str, &str, &str); 15] = [
    ("_rad_s", "rad/s", "rate"),
    ("_rad", "rad", "angle"),
    ("_nm_s", "N m s", "momentum"),
    ("_nm", "N m", "torque"),
    ("_m_s2", "m/s²", "acceleration"),
    ("_m_s", "m/s", "velocity"),
    ("_m", "m", "length"),
    ("_am2", "A m²", "magnetic moment"),
    ("_on_s", "s", "time"),
    ("_from_s", "s", "time"),
    ("_to_s", "s", "time"),
    ("_kg", "kg", "mass"),
    ("_j", "J", "energy"),
    ("_t", "T", "magnetic field"),
    ("_1_s", "1/s", "rate"),
];
/// Unit of rates, and the words in the names of fields that are speeds of rotors and angular frequencies.
const RATE: (&str, &str, &str) = ("rad/s", "speed", "frequency");

/// Line of a figure: name, unit, and points.
struct NumberLine {
    name: String,
    unit: String,
    points: Vec<Point>,
}

impl NumberLine {
    /// Returns the quantity of a rate that is shown in a unit of its own.
    fn special(&self) -> Option<&'static str> {
        let (unit, speed, frequency) = RATE;
        let is_it = |word: &&str| self.unit == unit && self.name.split(' ').any(|own| own == *word);
        [speed, frequency].into_iter().find(is_it)
    }
}

/// Returns the figure of a topic of a log.
///
/// # Errors
/// A topic that the log does not have, or that has no numbers.
pub fn figure(log: &Log, path: &Path, topic: &str) -> Result<Figure, CliError> {
    let columns = log.columns(topic)?;
    let times = columns.numbers("time_s").unwrap_or_default();
    let mut lines = Vec::new();
    collect(&columns, times, &log.units(topic), &mut lines);
    let mut panels: Vec<(String, Vec<NumberLine>)> = Vec::new();
    for line in lines {
        let is_alike = |other: &NumberLine| other.unit == line.unit && other.special() == line.special();
        match panels.iter_mut().find(|(_, own)| own.len() < MOST && own.iter().all(is_alike)) {
            Some((_, own)) => own.push(line),
            None => panels.push((line.unit.clone(), vec![line])),
        }
    }
    if panels.is_empty() {
        let why = format!("topic {topic}: has no numbers to draw");
        return Err(CliError::Draw { path: path.to_owned(), why });
    }
    let end = times.last().copied().unwrap_or(0.0);
    let start = times.first().copied().unwrap_or(0.0).min(0.0);
    let count = panels.len().min(MOST);
    let panel = |(index, (unit, lines)): (usize, (String, Vec<NumberLine>))| {
        let values: Vec<f64> = lines.iter().flat_map(|line| &line.points).map(|point| point.1).collect();
        let single = if let [line] = &lines[..] { line.name.clone() } else { String::new() };
        let special = lines[0].special();
        let quantity = || UNITS.iter().find(|(_, own, _)| *own == unit).map(|(.., quantity)| *quantity);
        let name = if single.is_empty() { special.or(quantity()).unwrap_or("value") } else { &single };
        let (name, unit) = name_and_unit(name, &unit);
        let y = FigureAxis::around(&name, unit, values);
        let y = match special {
            Some(word) if word == RATE.1 => y.in_rpm(),
            Some(_) => y.in_hertz(),
            None => y,
        };
        let x = time(start..end);
        let is_alone = !single.is_empty();
        let layers = lines.into_iter().enumerate().map(|(index, line)| {
            let name = if is_alone { "" } else { line.name.as_str() };
            Layer::new(name, COLOURS[index % COLOURS.len()], LayerShape::Line(1.2), line.points)
        });
        Panel::new(if index + 1 == count { x } else { x.unnamed() }, y, layers.collect())
    };
    let title =
        format!("{}: {topic}", readable(log.metadata().get("scenario").map_or("log", String::as_str)));
    let panels = panels.into_iter().take(MOST).enumerate().map(panel).collect();
    Ok(Figure { title, panels, panel_height: 180 })
}

/// Collects the lines of the numbers in columns.
fn collect(columns: &Columns, times: &[f64], units: &BTreeMap<String, String>, lines: &mut Vec<NumberLine>) {
    let indices = indices(columns);
    for (name, column) in &columns.columns {
        match column {
            Column::Numbers(values) if name != "time_s" && !INDICES.contains(&name.as_str()) => {
                let unit = unit(name, units);
                let readable = words(name, &unit);
                if indices.is_empty() {
                    let points = times.iter().copied().zip(values.iter().copied()).collect();
                    lines.push(NumberLine { name: readable, unit, points });
                    continue;
                }
                let mut groups: BTreeMap<u64, Vec<Point>> = BTreeMap::new();
                for ((time, value), index) in times.iter().zip(values).zip(&indices) {
                    groups.entry(*index).or_default().push((*time, *value));
                }
                lines.extend(groups.into_iter().map(|(index, points)| NumberLine {
                    name: format!("{readable} {}", index + 1),
                    unit: unit.clone(),
                    points,
                }));
            }
            Column::Rows(counts, inner) => collect_nested(counts, inner, name, times, units, lines),
            _ => {}
        }
    }
}

/// Collects the lines of nested rows: one for each field and place within a row.
fn collect_nested(
    counts: &[u32],
    inner: &Columns,
    name: &str,
    times: &[f64],
    units: &BTreeMap<String, String>,
    lines: &mut Vec<NumberLine>,
) {
    let most = counts.iter().copied().max().unwrap_or(0) as usize;
    for (field, column) in &inner.columns {
        let Column::Numbers(values) = column else { continue };
        let unit = unit(field, units);
        for place in 0..most.min(MOST) {
            let mut start = 0;
            let mut points = Vec::new();
            for (time, count) in times.iter().zip(counts) {
                let count = *count as usize;
                points
                    .extend(values.get(start + place).filter(|_| place < count).map(|value| (*time, *value)));
                start += count;
            }
            let label = format!("{} of {} {}", words(field, &unit), words(name, ""), place + 1);
            lines.push(NumberLine { name: label, unit: unit.clone(), points });
        }
    }
}

/// Returns the index of each row, if the rows have one.
fn indices(columns: &Columns) -> Vec<u64> {
    let column = INDICES.iter().find_map(|name| columns.get(name));
    match column {
        Some(Column::Counts(values)) => values.clone(),
        Some(Column::Numbers(values)) => values.iter().map(|value| *value as u64).collect(),
        _ => Vec::new(),
    }
}

/// Returns the unit of a field: as the log gives it, or by the ending of its name.
fn unit(field: &str, units: &BTreeMap<String, String>) -> String {
    let by_name = || UNITS.iter().find(|(ending, ..)| field.ends_with(ending)).map(|(_, unit, _)| *unit);
    units.get(field).cloned().unwrap_or_else(|| by_name().unwrap_or_default().to_owned())
}

/// Returns the name of a field in words, without the ending for its unit.
fn words(field: &str, unit: &str) -> String {
    let stem =
        UNITS.iter().filter(|(_, own, _)| *own == unit).find_map(|(ending, ..)| field.strip_suffix(ending));
    stem.unwrap_or(field).replace('_', " ")
}
