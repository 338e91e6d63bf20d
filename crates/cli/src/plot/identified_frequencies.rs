//! Figure `frequency` of three axes: the natural frequency of each mode that an attitude filter identifies, with two
//! standard deviations to each side, and the true frequency.

use flexsc_core::record::{ElasticEstimate, ElasticEstimates};
use flexsc_core::scenario::Scenario;
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, band, colour};

use super::cycle_data::CycleData;
use super::run_events::RunEvents;
use super::{time, title};

/// Upper end of the axis, as a multiple of the true frequency, even if the filter's uncertainty is larger.
const BEYOND: f64 = 1.5;

/// Returns true if an attitude filter identifies modes.
pub fn applies_to(story: &RunEvents) -> bool {
    story.scenario.axis_count() == 3 && modes(&story.scenario).is_some()
}

/// Returns the indices of the identified modes.
fn modes(scenario: &Scenario) -> Option<&[usize]> {
    let elastic = scenario.estimator.as_ref()?.attitude()?.elastic.as_ref()?;
    elastic.identifies().then_some(&elastic.modes[..])
}

pub fn figure(story: &RunEvents, cycles: &CycleData) -> Figure {
    let modes = modes(&story.scenario).unwrap_or_default();
    let panel = |(index, mode): (usize, &usize)| {
        let line = |value: &dyn Fn(&ElasticEstimate) -> f64| -> Vec<Point> {
            cycles.rows::<ElasticEstimates>().map(|(time, row)| (time, value(&row.modes[index]))).collect()
        };
        let [estimated, truth] =
            [line(&|mode| mode.frequency_rad_s), line(&|mode| mode.true_frequency_rad_s)];
        let [lower, upper] =
            [-2.0, 2.0].map(|width| line(&|mode| mode.frequency_rad_s + width * mode.frequency_sd_rad_s));
        let most = BEYOND * truth.iter().map(|point| point.1).fold(0.0, f64::max);
        let shown = [&estimated, &truth, &lower, &upper].into_iter().flatten();
        let values = shown.map(|point| point.1.clamp(0.0, most)).collect::<Vec<_>>();
        let y = FigureAxis::around(&format!("mode {mode}"), "rad/s", values).in_hertz();
        let x = time(0.0..story.end);
        let name = |name| if index == 0 { name } else { "" };
        let ends = truth.first().into_iter().chain(truth.last()).copied().collect();
        let layers = vec![
            Layer::new(
                name("± 2 standard deviations"),
                colour::SKY,
                LayerShape::Area(0.35),
                band(&lower, &upper),
            ),
            Layer::new(name("estimated"), colour::BLUE, LayerShape::Line(1.4), estimated),
            Layer::new(name("true"), colour::BLACK, LayerShape::Dashes, ends),
        ];
        Panel::new(if index + 1 == modes.len() { x } else { x.unnamed() }, y, layers)
    };
    let panels = modes.iter().enumerate().map(panel).collect();
    Figure { title: title(story, "identified frequencies"), panels, panel_height: 180 }
}
