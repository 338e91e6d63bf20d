//! Figure `consistency` of three axes: the errors of an attitude filter with three of its standard deviations, and its
//! normalised error squared, which is about 1 for each state of a consistent filter.

use flexsc_core::formats::reader_units::four_digits;
use flexsc_core::record::{AttitudeEstimate, AxisEstimate};
use flexsc_figure::{Figure, Layer, LayerShape, Panel, Point, band, colour};

use super::cycle_data::CycleData;
use super::pointing::{decades, norm};
use super::run_events::RunEvents;
use super::running_mean::{averages, ratio_axis};
use super::three_axis::panels;
use super::{assessed_mean, time, title};

/// Bounds of chi-square with six degrees of freedom, divided by six, that contain 95 % of its probability.
const INSIDE: [f64; 2] = [0.206_224_040_965_200_46, 2.408_229_222_574_653];

/// Number of samples above which a line is a running mean, and number of the parts of the run that it averages.
const RUNNING: usize = 400;

/// Returns true if a run has an attitude filter.
pub fn applies_to(story: &RunEvents) -> bool {
    story.scenario.estimator.as_ref().is_some_and(|estimator| estimator.attitude().is_some())
}

pub fn figure(story: &RunEvents, cycles: &CycleData) -> Figure {
    let over_time = |axis: usize, value_of: &dyn Fn(&AxisEstimate) -> f64| -> Vec<Point> {
        cycles.rows::<AttitudeEstimate>().map(|(time, row)| (time, value_of(&row.axes[axis]))).collect()
    };
    let mut panels = panels(story, "rad", |axis| {
        let name = |name| if axis == 0 { name } else { "" };
        let [high, low] = [3.0, -3.0].map(|width| over_time(axis, &|row| width * row.angle_sd_rad));
        let errors = over_time(axis, &|row| row.angle_error_rad);
        vec![
            Layer::new(
                name("3 standard deviations"),
                colour::GREEN,
                LayerShape::Area(0.2),
                band(&low, &high),
            ),
            Layer::new(name("error of the attitude"), colour::BLUE, LayerShape::Line(0.6), errors),
        ]
    });
    if let Some(last) = panels.last_mut() {
        last.x = last.x.unnamed();
    }
    let norm_of = |value_of: fn(&AxisEstimate) -> f64| -> Vec<Point> {
        cycles
            .rows::<AttitudeEstimate>()
            .map(|(time, row)| (time, norm([0, 1, 2].map(|axis| value_of(&row.axes[axis])))))
            .collect()
    };
    let layers = vec![
        Layer::new("", colour::GREEN, LayerShape::Line(1.4), norm_of(|axis| 3.0 * axis.angle_sd_rad)),
        Layer::new("", colour::BLUE, LayerShape::Line(0.6), norm_of(|axis| axis.angle_error_rad)),
    ];
    let lengths = decades(story, "norm", layers);
    panels.push(Panel { x: lengths.x.unnamed(), ..lengths });
    let nees: Vec<Point> = cycles.rows::<AttitudeEstimate>().map(|(time, row)| (time, row.nees)).collect();
    let mean = assessed_mean::mean(story, &nees);
    let window = nees.len().div_ceil(RUNNING).max(1);
    let (nees, name) = if window > 1 {
        let length = nees[window - 1].0 - nees[0].0;
        (averages(&nees, window), format!("mean over {} s", four_digits(length)))
    } else {
        (nees, "NEES / states".to_owned())
    };
    let level = |height: f64| [(0.0, height), (story.end, height)];
    let values = || nees.iter().map(|point| point.1).chain(INSIDE);
    let y = ratio_axis("NEES / states", values());
    let mut layers = vec![
        Layer::new(
            "95 % of chi-square",
            colour::GREEN,
            LayerShape::Area(0.2),
            band(&level(INSIDE[0]), &level(INSIDE[1])),
        ),
        Layer::new(&name, colour::BLUE, LayerShape::Line(1.0), nees),
    ];
    layers.extend(mean);
    panels.push(Panel::new(time(0.0..story.end), y, layers));
    Figure { title: title(story, "consistency of the attitude filter"), panels, panel_height: 160 }
}
