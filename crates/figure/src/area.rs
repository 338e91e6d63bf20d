//! Preparation of areas for drawing: polygons cut at gaps, limited to a panel, with no more points than it can show.

use crate::line::{Point, Window, drop_close, thin};

/// Returns the polygon between two lines over the same abscissae, with a gap where a point is not finite.
pub fn band(lower: &[Point], upper: &[Point]) -> Vec<Point> {
    let finite = |(a, b): &(&Point, &Point)| [a.0, a.1, b.1].iter().all(|value| value.is_finite());
    let pairs: Vec<_> = lower.iter().zip(upper).collect();
    let runs = pairs.split(|pair| !finite(pair)).filter(|run| !run.is_empty());
    let mut polygons = Vec::new();
    for run in runs {
        polygons.extend(run.iter().map(|(lower, _)| **lower));
        polygons.extend(run.iter().rev().map(|(_, upper)| **upper));
        polygons.push((f64::NAN, f64::NAN));
    }
    polygons
}

/// Returns the polygons of an area that are visible in a window. Points outside are moved to the border, which is
/// correct for areas between lines, and for those within the window.
pub fn polygons(points: &[Point], window: &Window, pixels: u32) -> Vec<Vec<Point>> {
    let size = (window.x.end - window.x.start, window.y.end - window.y.start);
    let hold =
        |(x, y): &Point| (x.clamp(window.x.start, window.x.end), y.clamp(window.y.start, window.y.end));
    let parts = points.split(|(x, y)| !x.is_finite() || !y.is_finite());
    let held = parts.map(|part| part.iter().map(hold).collect::<Vec<_>>());
    let fewer = |part: Vec<Point>| match sides(&part) {
        Some((upper, lower)) => {
            let back: Vec<Point> = lower.iter().rev().copied().collect();
            let mut fewer = thin(upper, window, pixels);
            fewer.extend(thin(&back, window, pixels).into_iter().rev());
            fewer
        }
        None => drop_close(&part, size, pixels),
    };
    held.map(fewer).filter(|part| part.len() > 2).collect()
}

/// The two sides of a polygon between two lines: to the right, and back again; none of any other.
fn sides(polygon: &[Point]) -> Option<(&[Point], &[Point])> {
    let turn = polygon.windows(2).position(|pair| pair[1].0 < pair[0].0)? + 1;
    let (upper, lower) = polygon.split_at(turn);
    lower.is_sorted_by(|a, b| a.0 >= b.0).then_some((upper, lower))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_have_gaps_and_end_at_the_border() {
        let window = Window { x: 0.0..4.0, y: 0.0..1.0 };
        let lower = [(0.0, 0.2), (1.0, 0.2), (2.0, f64::NAN), (3.0, -5.0), (9.0, 0.1)];
        let upper = [(0.0, 0.4), (1.0, 0.6), (2.0, 0.5), (3.0, 0.8), (9.0, 7.0)];
        let found = polygons(&band(&lower, &upper), &window, 1000);
        assert_eq!(found.len(), 2);
        assert_eq!(found[0], [(0.0, 0.2), (1.0, 0.2), (1.0, 0.6), (0.0, 0.4)]);
        assert_eq!(found[1], [(3.0, 0.0), (4.0, 0.1), (4.0, 1.0), (3.0, 0.8)]);
        assert!(polygons(&band(&[], &[]), &window, 1000).is_empty());
    }

    /// The bounds of a filter between its samples are a saw of many teeth for each pixel.
    #[test]
    fn a_band_has_no_more_points_than_pixels_can_show() {
        let window = Window { x: 0.0..1.0, y: -1.0..1.0 };
        let sawtooth = |sign: f64| -> Vec<Point> {
            (0..100_000)
                .map(|i| {
                    (f64::from(i) / 1e5, sign * if i == 31_415 { 0.9 } else { 0.2 + 0.1 * f64::from(i % 7) })
                })
                .collect()
        };
        let found = polygons(&band(&sawtooth(-1.0), &sawtooth(1.0)), &window, 500);
        assert_eq!(found.len(), 1);
        assert!(found[0].len() <= 2 * 4 * 501, "{}", found[0].len());
        // No peak is lost on either side.
        let ends = found[0].iter().fold((0.0_f64, 0.0_f64), |(low, high), p| (low.min(p.1), high.max(p.1)));
        assert_eq!(ends, (-0.9, 0.9));
    }
}
