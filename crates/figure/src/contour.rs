//! Contours of a field on a grid, by marching squares.

use std::collections::BTreeMap;

use crate::line::Point;

/// Scalar field on a rectangular grid.
pub struct ScalarField {
    /// Abscissae of the columns, increasing.
    pub x: Vec<f64>,
    /// Ordinates of the rows, increasing.
    pub y: Vec<f64>,
    /// Values by columns: at each abscissa, one per ordinate.
    pub values: Vec<f64>,
}

/// Closed contour with the higher values on its left.
pub struct Ring {
    /// Points of the contour; the last is connected to the first.
    pub points: Vec<Point>,
    /// True for each point whose following segment lies on the border of the grid.
    border: Vec<bool>,
}

impl ScalarField {
    /// Returns the contours around the regions with values of at least `level`, as straight lines between the edges
    /// of the grid's cells. NaN counts as infinitely high.
    pub fn rings(&self, level: f64) -> Vec<Ring> {
        // The grid is surrounded by cells without width, whose outer corners are below every level, so that each
        // contour closes.
        let (columns, rows) = (self.x.len() + 2, self.y.len() + 2);
        let mut segments = BTreeMap::new();
        for i in 0..columns - 1 {
            for j in 0..rows - 1 {
                let border = i == 0 || j == 0 || i + 2 == columns || j + 2 == rows;
                let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
                let inside = corners.map(|corner| self.value(corner) >= level);
                for from in (0..4).filter(|k| inside[*k] && !inside[(k + 1) % 4]) {
                    // Backwards along the inside corners, to the edge at which they begin.
                    let mut to = from;
                    while inside[to] {
                        to = (to + 3) % 4;
                    }
                    let edge = |k: usize| Edge::between(corners[k], corners[(k + 1) % 4]);
                    segments.insert(edge(from), (edge(to), border));
                }
            }
        }
        let mut rings = Vec::new();
        while let Some((first, (mut next, border))) = segments.pop_first() {
            let mut ring = Ring { points: vec![self.crossing(first, level)], border: vec![border] };
            while let Some((after, border)) = segments.remove(&next) {
                ring.points.push(self.crossing(next, level));
                ring.border.push(border);
                next = after;
            }
            rings.push(ring);
        }
        rings
    }

    /// Returns the areas between levels, in increasing order, each with the number of levels that its values reach. Contours of
    /// constant value do not cross: drawn in this order, from the largest to the smallest, each is filled with the class just within it.
    pub fn areas(&self, levels: &[f64]) -> Vec<(usize, Vec<Point>)> {
        let end = |axis: &[f64], last: usize| axis[last * (axis.len() - 1)];
        let corners = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(i, j)| (end(&self.x, i), end(&self.y, j)));
        let mut rings = vec![(f64::INFINITY, 0, 0, corners.to_vec())];
        for (below, level) in levels.iter().enumerate() {
            let above = below + 1;
            for ring in self.rings(*level) {
                let area = ring.area();
                // If two contours coincide, the steeper class comes last.
                let (class, order) =
                    if area > 0.0 { (above, above) } else { (below, levels.len() + 1 - above) };
                rings.push((area.abs(), order, class, ring.points));
            }
        }
        rings.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        rings.into_iter().map(|(_, _, class, points)| (class, points)).collect()
    }

    /// Returns the contours without their parts on the border of the grid, separated by gaps.
    pub fn lines(&self, level: f64) -> Vec<Point> {
        self.rings(level).iter().flat_map(Ring::open).collect()
    }

    /// Returns the value at a corner of the cells.
    fn value(&self, (i, j): (usize, usize)) -> f64 {
        if i == 0 || j == 0 || i > self.x.len() || j > self.y.len() {
            return f64::NEG_INFINITY;
        }
        let value = self.values[(i - 1) * self.y.len() + j - 1];
        if value.is_nan() { f64::INFINITY } else { value }
    }

    /// Returns the position of a corner.
    fn place(&self, (i, j): (usize, usize)) -> Point {
        let held = |axis: &[f64], index: usize| axis[index.clamp(1, axis.len()) - 1];
        (held(&self.x, i), held(&self.y, j))
    }

    /// Returns the position at which a level is reached on an edge.
    fn crossing(&self, edge: Edge, level: f64) -> Point {
        let (a, b) = (self.value(edge.from), self.value(edge.to));
        let (from, to) = (self.place(edge.from), self.place(edge.to));
        let part = if (b - a).is_finite() { (level - a) / (b - a) } else { f64::from(u8::from(a < b)) };
        (from.0 + part * (to.0 - from.0), from.1 + part * (to.1 - from.1))
    }
}

/// Edge of a cell, from its lower or left corner.
#[derive(Copy, Clone, PartialEq, Eq, PartialOrd, Ord)]
struct Edge {
    from: (usize, usize),
    to: (usize, usize),
}

impl Edge {
    fn between(a: (usize, usize), b: (usize, usize)) -> Self {
        Self { from: a.min(b), to: a.max(b) }
    }
}

impl Ring {
    /// Returns the enclosed area, negative if the values inside are lower.
    pub fn area(&self) -> f64 {
        let next = self.points.iter().cycle().skip(1);
        0.5 * self.points.iter().zip(next).map(|(a, b)| a.0 * b.1 - b.0 * a.1).sum::<f64>()
    }

    /// Returns the contour with gaps in place of its segments on the border.
    fn open(&self) -> Vec<Point> {
        const GAP: Point = (f64::NAN, f64::NAN);
        let next = self.points.iter().cycle().skip(1);
        let mut line = Vec::new();
        for ((point, to), border) in self.points.iter().zip(next).zip(&self.border) {
            if *border {
                line.push(GAP);
            } else {
                if line.last() != Some(point) {
                    line.push(*point);
                }
                line.push(*to);
            }
        }
        line.push(GAP);
        line
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field(values: impl Fn(f64, f64) -> f64) -> ScalarField {
        let axis: Vec<f64> = (0..=40).map(|i| f64::from(i) / 10.0 - 2.0).collect();
        let values = axis.iter().flat_map(|x| axis.iter().map(|y| values(*x, *y)).collect::<Vec<_>>());
        ScalarField { values: values.collect(), x: axis.clone(), y: axis.clone() }
    }

    #[test]
    fn a_hill_has_one_ring_and_a_pit_a_negative_one() {
        let hill = field(|x, y| -(x * x + y * y));
        let rings = hill.rings(-1.0);
        assert_eq!(rings.len(), 1);
        assert!((rings[0].area() - std::f64::consts::PI).abs() < 2e-2, "{}", rings[0].area());
        assert!(rings[0].points.iter().all(|(x, y)| (x.hypot(*y) - 1.0).abs() < 3e-3));
        // A pit is a hole in the whole rectangle.
        let pit = field(|x, y| x * x + y * y).rings(1.0);
        let mut areas: Vec<f64> = pit.iter().map(Ring::area).collect();
        areas.sort_by(f64::total_cmp);
        assert_eq!(areas.len(), 2);
        assert!((areas[0] + std::f64::consts::PI).abs() < 2e-2 && (areas[1] - 16.0).abs() < 1e-12);
    }

    #[test]
    fn lines_leave_the_border_out() {
        let slope = field(|x, _| x);
        let line = slope.lines(0.55);
        let drawn: Vec<_> = line.iter().filter(|point| point.0.is_finite()).collect();
        assert!(drawn.len() >= 41 && drawn.iter().all(|(x, _)| (x - 0.55).abs() < 1e-12), "{line:?}");
        assert!((slope.rings(0.55)[0].area() - 1.45 * 4.0).abs() < 1e-12);
        assert!(slope.rings(3.0).is_empty());
        assert!(slope.lines(-3.0).iter().all(|(x, _)| x.is_nan()));
    }

    #[test]
    fn saddles_and_infinities_close() {
        let saddle = field(|x, y| (3.0 * x).sin() * (3.0 * y).sin());
        for level in [-0.5, 0.0, 0.5] {
            let inside: f64 = saddle.rings(level).iter().map(Ring::area).sum();
            assert!((0.0..16.0).contains(&inside), "{level}: {inside}");
        }
        let broken = field(|x, _| if x > 1.0 { f64::NAN } else { x });
        let area = broken.rings(1.5)[0].area();
        assert!((area - 0.9 * 4.0).abs() < 0.41, "{area}");
        let single = ScalarField { x: vec![1.0], y: vec![2.0], values: vec![3.0] };
        assert_eq!(single.rings(1.0).len(), 1);
    }
}
