//! Shaded intervals in which a mode moves too little for a filter to estimate its frequency, or the filter has lost
//! lock.

use flexsc_figure::{FigureAxis, Layer, LayerShape, Point, band, colour};

use super::motion::{DominantModeEstimate, MotionData};

/// Returns the areas, over the whole height of a panel; `named` adds them to its legend.
pub fn spans(motion: &MotionData, y: &FigureAxis, named: bool) -> Vec<Layer> {
    let area = |name: &str, colour, is: fn(&DominantModeEstimate) -> bool| {
        let points = shaded(&motion.estimates, y, is);
        (!points.is_empty())
            .then(|| Layer::new(if named { name } else { "" }, colour, LayerShape::Area(0.2), points))
    };
    let gated = area("gated", colour::GREY, |estimate| estimate.gated);
    let lost = area("lock lost", colour::VERMILLION, |estimate| estimate.lost);
    gated.into_iter().chain(lost).collect()
}

/// Returns a rectangle for each series of samples that satisfy `is`, up to the next sample.
fn shaded(
    estimates: &[DominantModeEstimate],
    y: &FigureAxis,
    is: fn(&DominantModeEstimate) -> bool,
) -> Vec<Point> {
    let mut points = Vec::new();
    let mut from = 0;
    for alike in estimates.chunk_by(|a, b| is(a) == is(b)) {
        let next = from + alike.len();
        if is(&alike[0]) {
            let end = estimates.get(next).unwrap_or(&alike[alike.len() - 1]).time;
            let level = |height: f64| [(alike[0].time, height), (end, height)];
            points.extend(band(&level(y.range.start), &level(y.range.end)));
        }
        from = next;
    }
    points
}
