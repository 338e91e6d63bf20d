//! Mean of a filter's consistency over the interval that the metrics assess.

use flexsc_core::formats::reader_units::number;
use flexsc_figure::{Layer, LayerShape, Point, colour};

use super::run_events::RunEvents;

/// Returns a line at the mean of the values over the interval that the metrics assess; `None` without values.
pub fn mean(story: &RunEvents, values: &[Point]) -> Option<Layer> {
    let [from, to] = story.scenario.estimator.as_ref()?.assess();
    let to = to.min(story.end);
    let inside = || values.iter().filter(|(time, value)| (from..=to).contains(time) && value.is_finite());
    let mean = inside().map(|point| point.1).sum::<f64>() / inside().count() as f64;
    let name = if from > 0.0 || to < story.end {
        format!("mean {mean:.2} from {} to {} s", number(from), number(to))
    } else {
        format!("mean {mean:.2}")
    };
    let line = vec![(from, mean), (to, mean)];
    mean.is_finite().then(|| Layer::new(&name, colour::VERMILLION, LayerShape::Dashes, line))
}
