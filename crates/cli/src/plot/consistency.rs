//! Figure `consistency`: consistency of a filter's covariance with its errors. The normalised innovation squared per
//! measurement and the normalised estimation error squared per state are both about 1 if they are consistent.

use flexsc_core::control::estimator::chi_square;
use flexsc_core::record::AttitudeEstimate;
use flexsc_figure::{Figure, Layer, LayerShape, Panel, Point, band, colour};

use super::cycle_data::RowSource;
use super::estimate::filters_one_axis;
use super::figure_spec::{FigureSpec, MotionPart, RunData};
use super::motion::{DominantModeEstimate, MotionData};
use super::run_events::RunEvents;
use super::running_mean::{averages, ratio_axis};
use super::{assessed_mean, attitude_filter, time, title};

pub const SPEC: FigureSpec = FigureSpec {
    name: "consistency",
    contents: "Consistency of a filter: NIS and NEES with 95 % bands; of an attitude filter, errors and NEES",
    rows: &[RowSource::new::<AttitudeEstimate>()],
    motion: MotionPart::All,
    is_in: |story| attitude_filter::applies_to(story) || filters_one_axis(story),
    draw,
};

fn draw(run: &RunData<'_>) -> Figure {
    if run.story.scenario.axis_count() == 3 {
        attitude_filter::figure(run.story, run.cycles)
    } else {
        figure(run.story, run.motion)
    }
}

/// Number of samples in an average, as in the filter's own test of lost lock.
const WINDOW: usize = 50;

fn figure(story: &RunEvents, motion: &MotionData) -> Figure {
    let scenario = &story.scenario;
    let measurements = 1 + usize::from(scenario.sensor.rate_noise(0).is_some());
    let states = scenario.estimator.as_ref().map_or(0, |e| e.states(scenario.mode_count()));
    let window = WINDOW.min(motion.estimates.len()).max(1);
    let panel = |name: &str, ratio: fn(&DominantModeEstimate) -> f64, degrees: usize, averaged: usize| {
        let values: Vec<Point> = motion.estimates.iter().map(|e| (e.time, ratio(e))).collect();
        let line = averages(&values, window);
        let [low, high] = chi_square(degrees * averaged).map(|bound| bound / (degrees * averaged) as f64);
        let shown = || line.iter().map(|point| point.1).chain([low, high]);
        let y = ratio_axis(name, shown());
        let level = |height: f64| [(0.0, height), (story.end, height)];
        let samples = if averaged == 1 { "one sample".to_owned() } else { format!("{averaged} samples") };
        let mut layers = vec![
            Layer::new(
                &format!("95 % of chi-square, {samples}"),
                colour::GREEN,
                LayerShape::Area(0.2),
                band(&level(low), &level(high)),
            ),
            Layer::new("", colour::GREY, LayerShape::Line(0.8), level(1.0).to_vec()),
            Layer::new(
                &format!("mean of the last {window} samples"),
                colour::BLUE,
                LayerShape::Line(1.2),
                line,
            ),
        ];
        layers.extend(assessed_mean::mean(story, &values));
        Panel::new(time(0.0..story.end), y, layers)
    };
    // Innovations of a consistent filter are independent from sample to sample. Errors are not: within a window they
    // are nearly a single draw.
    let nis = panel("NIS / measurements", |e| e.nis, measurements, window);
    let nees = panel("NEES / states", |e| e.nees, states.max(1), 1);
    let panels = vec![Panel { x: nis.x.unnamed(), ..nis }, nees];
    Figure { title: title(story, "consistency of the filter"), panels, panel_height: 200 }
}
