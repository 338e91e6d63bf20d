//! Figures over a part of a run, by `--from` and `--to`.

use std::ops::Range;

use flexsc_figure::{Figure, Layer, LayerShape, Panel, Scale};

use crate::error::CliError;

/// Margin above and below the content of a panel, as a fraction of its height.
const MARGIN: f64 = 0.06;

/// Returns the shown interval of a run that ends at `end` (s).
///
/// # Errors
/// An interval that is outside the run, or has a bound that is not a number.
pub fn resolve(from: Option<f64>, to: Option<f64>, end: f64) -> Result<Option<Range<f64>>, CliError> {
    if from.is_none() && to.is_none() {
        return Ok(None);
    }
    let (start, last) = (from.unwrap_or(0.0), to.unwrap_or(end));
    // False if a bound is NaN.
    if start >= 0.0 && start < last && start < end {
        return Ok(Some(start..last.min(end)));
    }
    let limit_text = |time: Option<f64>| time.map_or("-".to_owned(), |time| time.to_string());
    let why =
        format!("the run is from 0 to {end} s, got --from {} --to {}", limit_text(from), limit_text(to));
    Err(CliError::Arguments(why))
}

/// Restricts a figure to an interval of time: lines over time are cut, and their panels are scaled to the rest.
pub fn crop(mut figure: Figure, shown: &Range<f64>) -> Figure {
    for panel in
        figure.panels.iter_mut().filter(|panel| panel.x.unit == "s" && panel.x.scale == Scale::Linear)
    {
        panel.x = panel.x.over(shown.clone());
        if panel.y.scale == Scale::Linear
            && let Some(range) = heights(panel)
        {
            panel.y = panel.y.over(range);
        }
    }
    figure
}

/// Returns the range of a panel's values with a margin; `None` if the panel shows none.
fn heights(panel: &Panel) -> Option<Range<f64>> {
    let (shown, before) = (&panel.x.range, &panel.y.range);
    // Areas and vertical lines have the panel's previous height, and do not count as values.
    let upright = |layer: &Layer| layer.points.windows(2).all(|pair| pair[0].0 == pair[1].0);
    let lines =
        panel.layers.iter().filter(|layer| !matches!(layer.shape, LayerShape::Area(_)) && !upright(layer));
    let values = lines.flat_map(|layer| {
        let inside = layer.points.iter().filter(|point| shown.contains(&point.0) || point.0 == shown.end);
        let ends = [shown.start, shown.end].map(|time| value_at(layer, time));
        inside.map(|point| point.1).chain(ends.into_iter().flatten()).collect::<Vec<_>>()
    });
    let finite = values.filter(|value| value.is_finite());
    let (low, high) =
        finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    let margin = MARGIN * (high - low);
    if margin > 0.0 {
        // An axis from zero still begins at zero.
        let start = if before.start == 0.0 && low >= 0.0 { 0.0 } else { low - margin };
        Some(start..high + margin)
    } else {
        None
    }
}

/// Returns the value of a line at a time, interpolated between two of its points.
fn value_at(layer: &Layer, time: f64) -> Option<f64> {
    if !matches!(layer.shape, LayerShape::Line(_) | LayerShape::Dashes) {
        return None;
    }
    let interval = layer.points.windows(2).find(|pair| pair[0].0 <= time && time < pair[1].0)?;
    let part = (time - interval[0].0) / (interval[1].0 - interval[0].0);
    Some(interval[0].1 + part * (interval[1].1 - interval[0].1))
}

#[cfg(test)]
mod tests {
    use flexsc_figure::{FigureAxis, colour};

    use super::*;

    #[test]
    fn what_is_left_fills_the_panel() {
        let line: Vec<_> = (0..=100).map(|i| (f64::from(i), f64::from(i * i))).collect();
        let mark = vec![(15.0, -1e6), (15.0, 1e6)];
        let layers = vec![
            Layer::new("", colour::BLUE, LayerShape::Line(1.0), line),
            Layer::new("", colour::GREY, LayerShape::Dashes, mark),
        ];
        let panel = Panel::new(
            FigureAxis::exact("time", "s", 0.0..100.0),
            FigureAxis::exact("y", "m", -1.0..1e4),
            layers,
        );
        let figure = Figure { title: String::new(), panels: vec![panel], panel_height: 100 };
        let cut = crop(figure, &(10.5..20.0));
        let (x, y) = (&cut.panels[0].x, &cut.panels[0].y);
        assert_eq!((x.range.clone(), x.name.as_str()), (10.5..20.0, "time"));
        // At 10.5 s the line is between two points.
        let margin = 0.06 * (400.0 - 110.5);
        assert!(
            (y.range.start - (110.5 - margin)).abs() < 1e-9 && (y.range.end - (400.0 + margin)).abs() < 1e-9
        );
    }

    #[test]
    fn a_part_of_the_run_is_left() {
        assert!(resolve(None, None, 10.0).is_ok_and(|shown| shown.is_none()));
        assert!(resolve(Some(3.0), None, 10.0).is_ok_and(|shown| shown == Some(3.0..10.0)));
        assert!(resolve(None, Some(30.0), 10.0).is_ok_and(|shown| shown == Some(0.0..10.0)));
        for (from, to) in
            [(Some(10.0), None), (Some(4.0), Some(3.0)), (Some(f64::NAN), None), (Some(-1.0), None)]
        {
            assert!(resolve(from, to, 10.0).is_err(), "{from:?} {to:?}");
        }
    }
}
