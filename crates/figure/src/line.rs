//! Preparation of lines for drawing: cut at gaps and at the border of a panel, with no more points than it can show.

use std::ops::Range;

/// Point of a figure, x and y.
pub type Point = (f64, f64);

/// Visible part of the plane in a panel.
#[derive(Clone, Debug)]
pub struct Window {
    /// Visible range of x.
    pub x: Range<f64>,
    /// Visible range of y.
    pub y: Range<f64>,
}

impl Window {
    /// Returns true if a point is visible.
    pub fn contains(&self, (x, y): Point) -> bool {
        (self.x.start..=self.x.end).contains(&x) && (self.y.start..=self.y.end).contains(&y)
    }

    /// Returns the visible part of a segment.
    pub(crate) fn clip(&self, (a, b): (Point, Point)) -> Option<(Point, Point)> {
        if self.contains(a) && self.contains(b) {
            return Some((a, b));
        }
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        // Each border is crossed at the t with `slope * t == room`.
        let borders = [
            (-dx, a.0 - self.x.start),
            (dx, self.x.end - a.0),
            (-dy, a.1 - self.y.start),
            (dy, self.y.end - a.1),
        ];
        for (slope, room) in borders {
            if slope < 0.0 {
                enter = enter.max(room / slope);
            } else if slope > 0.0 {
                leave = leave.min(room / slope);
            } else if room < 0.0 {
                return None;
            }
        }
        let point_at = |t: f64| (a.0 + t * dx, a.1 + t * dy);
        (enter < leave).then(|| (point_at(enter), point_at(leave)))
    }
}

/// Returns the visible pieces of a line; a point that is not finite is a gap.
pub fn pieces(points: &[Point], window: &Window) -> Vec<Vec<Point>> {
    let mut pieces: Vec<Vec<Point>> = Vec::new();
    for pair in points.windows(2) {
        let finite = pair.iter().all(|(x, y)| x.is_finite() && y.is_finite());
        let Some((a, b)) = window.clip((pair[0], pair[1])).filter(|_| finite) else { continue };
        match pieces.last_mut() {
            Some(piece) if piece.last() == Some(&a) => piece.push(b),
            _ => pieces.push(vec![a, b]),
        }
    }
    pieces
}

/// Reduces a line to points that look the same at a resolution of `pixels` columns and rows. Where x never decreases,
/// each column keeps its first, lowest, highest and last point, so that no peak is lost.
pub fn thin(points: &[Point], window: &Window, pixels: u32) -> Vec<Point> {
    let (width, height) = (window.x.end - window.x.start, window.y.end - window.y.start);
    if points.windows(2).any(|pair| pair[1].0 < pair[0].0) {
        return drop_close(points, (width, height), pixels);
    }
    let column = |p: &Point| ((p.0 - window.x.start) / width * f64::from(pixels)) as i64;
    let mut thinned = Vec::new();
    for group in points.chunk_by(|a, b| column(a) == column(b)) {
        let by_height = |a: &(usize, &Point), b: &(usize, &Point)| a.1.1.total_cmp(&b.1.1);
        let low = group.iter().enumerate().min_by(by_height).map_or(0, |(index, _)| index);
        let high = group.iter().enumerate().max_by(by_height).map_or(0, |(index, _)| index);
        let mut kept = [0, low.min(high), low.max(high), group.len() - 1].to_vec();
        kept.dedup();
        thinned.extend(kept.into_iter().map(|index| group[index]));
    }
    thinned
}

/// Drops points closer than a pixel to the last one kept.
pub fn drop_close(points: &[Point], (width, height): (f64, f64), pixels: u32) -> Vec<Point> {
    let far = |a: &Point, b: &Point| {
        let (dx, dy) = ((a.0 - b.0) / width, (a.1 - b.1) / height);
        (dx * dx + dy * dy) * f64::from(pixels) * f64::from(pixels) >= 1.0
    };
    let mut kept: Vec<Point> = Vec::new();
    for (index, point) in points.iter().enumerate() {
        if index + 1 == points.len() || kept.last().is_none_or(|last| far(last, point)) {
            kept.push(*point);
        }
    }
    kept
}

/// Drops points, in the backend's coordinates, where the line is straight to one unit, a tenth of a pixel (Ramer,
/// Douglas and Peucker).
pub fn straighten(points: &[(i32, i32)]) -> Vec<(i32, i32)> {
    let mut kept = vec![false; points.len()];
    let mut spans = vec![(0, points.len().saturating_sub(1))];
    while let Some((from, to)) = spans.pop() {
        for end in [from, to] {
            if let Some(end) = kept.get_mut(end) {
                *end = true;
            }
        }
        let off = |index: usize| squared_distance(points[index], points[from], points[to]);
        let farthest = (from + 1..to).map(|index| (off(index), index)).max_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((_, index)) = farthest.filter(|(off, _)| *off > 1.0) {
            spans.extend([(from, index), (index, to)]);
        }
    }
    points.iter().zip(kept).filter_map(|(point, kept)| kept.then_some(*point)).collect()
}

/// Returns the square of the distance of a point from a segment.
fn squared_distance(point: (i32, i32), from: (i32, i32), to: (i32, i32)) -> f64 {
    let apart = |a: (i32, i32), b: (i32, i32)| (f64::from(a.0 - b.0), f64::from(a.1 - b.1));
    let ((x, y), (dx, dy)) = (apart(point, from), apart(to, from));
    let square = dx * dx + dy * dy;
    let part = if square > 0.0 { ((x * dx + y * dy) / square).clamp(0.0, 1.0) } else { 0.0 };
    let (x, y) = (x - part * dx, y - part * dy);
    x * x + y * y
}

/// Returns the line of a value that holds until the next one: it is `values[i]` from `times[i]` on, up to `end`.
pub fn steps(values: impl IntoIterator<Item = Point>, end: f64) -> Vec<Point> {
    let mut line: Vec<Point> = Vec::new();
    for (time, value) in values {
        if let Some(&(_, before)) = line.last() {
            line.push((time, before));
        }
        line.push((time, value));
    }
    if let Some(&(_, last)) = line.last() {
        line.push((end, last));
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: Window = Window { x: 0.0..1.0, y: 0.0..1.0 };

    #[test]
    fn lines_end_at_the_border_and_at_gaps() {
        let through = pieces(&[(-1.0, 0.5), (2.0, 0.5)], &UNIT);
        assert_eq!(through, [[(0.0, 0.5), (1.0, 0.5)]]);
        let out_and_in = pieces(&[(0.0, 0.5), (0.2, 1.5), (0.4, 0.5), (0.4, 0.5)], &UNIT);
        assert_eq!(out_and_in.len(), 2);
        let gap = pieces(&[(0.1, 0.1), (0.2, 0.2), (f64::NAN, 0.0), (0.3, 0.3), (0.4, 0.4)], &UNIT);
        assert_eq!(gap, [[(0.1, 0.1), (0.2, 0.2)], [(0.3, 0.3), (0.4, 0.4)]]);
        assert!(pieces(&[(0.0, 2.0), (1.0, 2.0)], &UNIT).is_empty());
        assert!(pieces(&[], &UNIT).is_empty());
    }

    #[test]
    fn no_peak_is_lost() {
        let spike = 31_415;
        let wave = |i: usize| if i == spike { 1.0 } else { 0.3 + 0.2 * (i as f64).sin() };
        let points: Vec<_> = (0..100_000).map(|i| (i as f64 / 1e5, wave(i))).collect();
        let thinned = thin(&points, &UNIT, 500);
        assert!(thinned.len() <= 2000);
        assert!(thinned.iter().any(|p| p.1 == 1.0));
        assert!(thinned.is_sorted_by(|a, b| a.0 <= b.0));
    }

    #[test]
    fn loops_keep_their_shape() {
        let circle = |i: i32| (f64::from(i) * 1e-3).sin_cos();
        let points: Vec<_> = (0..6283).map(circle).map(|(s, c)| (0.5 + 0.4 * c, 0.5 + 0.4 * s)).collect();
        let thinned = thin(&points, &UNIT, 300);
        assert!((300..800).contains(&thinned.len()));
        assert_eq!(thinned.last(), points.last());
    }

    #[test]
    fn straight_parts_need_their_ends_only() {
        let corner = [(0, 0), (10, 1), (20, 2), (30, 3), (40, 300), (50, 3)];
        assert_eq!(straighten(&corner), [(0, 0), (30, 3), (40, 300), (50, 3)]);
        let circle: Vec<(i32, i32)> = (0..=1000)
            .map(|i| (f64::from(i) * 1e-3 * std::f64::consts::TAU).sin_cos())
            .map(|(s, c)| ((3000.0 * c).round() as i32, (3000.0 * s).round() as i32))
            .collect();
        let kept = straighten(&circle);
        assert!((60..250).contains(&kept.len()), "{}", kept.len());
        for point in &circle {
            assert!(kept.windows(2).any(|pair| squared_distance(*point, pair[0], pair[1]) <= 1.0));
        }
        assert_eq!(straighten(&[(1, 2)]), [(1, 2)]);
        assert!(straighten(&[]).is_empty());
    }

    #[test]
    fn a_value_holds_until_the_next() {
        assert_eq!(steps([(0.0, 1.0), (2.0, 3.0)], 5.0), [(0.0, 1.0), (2.0, 1.0), (2.0, 3.0), (5.0, 3.0)]);
        assert!(steps([], 5.0).is_empty());
    }
}
