//! Figure `drives` of a spacecraft with turning appendages: drive angles, and natural frequencies relative to their
//! highest.

use flexsc_core::record::DrivesMotion;
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, colour};

use super::cycle_data::CycleData;
use super::run_events::RunEvents;
use super::{time, title};

/// Colours of drives, hinges and modes, cyclic.
const COLOURS: [plotters::style::RGBColor; 7] = [
    colour::BLUE,
    colour::VERMILLION,
    colour::GREEN,
    colour::ORANGE,
    colour::SKY,
    colour::BLACK,
    colour::GREY,
];

/// Ratio of its lowest to its highest value above which a frequency is constant.
const CONSTANT: f64 = 0.999;

/// Returns a panel with one line for each of several similar components.
pub fn alike(x: FigureAxis, name: &str, unit: &'static str, lines: Vec<(String, Vec<Point>)>) -> Panel {
    let values: Vec<f64> = lines.iter().flat_map(|(_, points)| points).map(|(_, value)| *value).collect();
    let layers = lines.into_iter().enumerate().map(|(index, (name, points))| {
        Layer::new(&name, COLOURS[index % COLOURS.len()], LayerShape::Line(1.2), points)
    });
    Panel::new(x, FigureAxis::around(name, unit, values), layers.collect())
}

pub fn figure(story: &RunEvents, cycles: &CycleData) -> Figure {
    let line = |value_of: &dyn Fn(&DrivesMotion) -> f64| -> Vec<Point> {
        cycles.rows().map(|(time, row)| (time, value_of(row))).collect()
    };
    let (drives, modes) =
        cycles.rows::<DrivesMotion>().next().map_or((0, 0), |(_, row)| (row.drives.len(), row.modes.len()));
    let x = time(0.0..story.end);
    let angles = (0..drives)
        .map(|drive| (format!("drive {}", drive + 1), unwrapped(line(&|row| row.drives[drive].angle_rad))))
        .collect();
    let highest = |mode: usize| {
        cycles.rows::<DrivesMotion>().map(|(_, row)| row.modes[mode].frequency_rad_s).fold(0.0, f64::max)
    };
    let varies = |mode: &usize| {
        let lowest = cycles.rows::<DrivesMotion>().map(|(_, row)| row.modes[*mode].frequency_rad_s);
        lowest.fold(f64::INFINITY, f64::min) < CONSTANT * highest(*mode)
    };
    let varying: Vec<usize> = (0..modes).filter(varies).collect();
    let constant = modes - varying.len();
    let frequencies = varying
        .into_iter()
        .map(|mode| {
            let most = highest(mode);
            let name = format!("{most:.3} rad/s");
            (name, line(&|row| row.modes[mode].frequency_rad_s / most))
        })
        .collect();
    let mut panels = vec![alike(x.unnamed(), "angle", "rad", angles)];
    if modes > constant {
        panels.push(alike(x, "frequency over its highest", "", frequencies));
    } else if let Some(last) = panels.last_mut() {
        last.x = x;
    }
    let subject = match (modes > constant, constant) {
        (false, _) => "drives".to_owned(),
        (true, 0) => "drives and natural frequencies".to_owned(),
        (true, _) => format!("drives and natural frequencies ({constant} constant ones left out)"),
    };
    Figure { title: title(story, &subject), panels, panel_height: 240 }
}

/// Adds a gap to a line wherever an angle wraps around.
fn unwrapped(line: Vec<Point>) -> Vec<Point> {
    let mut parted: Vec<Point> = Vec::new();
    for point in line {
        if parted.last().is_some_and(|last| (point.1 - last.1).abs() > std::f64::consts::PI) {
            parted.push((point.0, f64::NAN));
        }
        parted.push(point);
    }
    parted
}
