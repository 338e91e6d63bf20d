//! Search over time for the extremes of a guaranteed range, and for the first instant at which it may pass its limits.
//!
//! Between two instants that are h apart, each response deviates from its chord by at most h²/8 times its second
//! derivative. The ends of the range are maxima of the responses over convex sets, so that they are convex functions of
//! them: the upper end lies below its own chord plus h²/8 times the bound of all second derivatives, `curvature`, and
//! the lower end above.

/// Range of an output at an instant.
#[derive(Clone, Debug)]
pub struct TubeInstant<S> {
    /// Time (s).
    pub t: f64,
    /// Guaranteed range: lower and upper bound.
    pub bounds: [f64; 2],
    /// Range that is attained: the extremes under inputs that are known.
    pub attained: [f64; 2],
    /// Bound of the second derivative of the range's ends, from this time on.
    pub curvature: f64,
    /// Data for later instants.
    pub state: S,
}

/// Guaranteed range of an output over time.
pub trait Tube {
    /// Data of an instant from which later ones follow.
    type State: Clone;

    /// Returns the range at the start.
    fn start(&self) -> TubeInstant<Self::State>;

    /// Returns the range at a later time than that of `before`.
    fn later(&self, before: &TubeInstant<Self::State>, t: f64) -> TubeInstant<Self::State>;
}

/// End of the range.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Side {
    /// Lower end.
    Low,
    /// Upper end.
    High,
}

impl Side {
    /// Both ends, in the order of ranges.
    pub const BOTH: [Self; 2] = [Self::Low, Self::High];

    /// Returns the index in a range.
    pub const fn index(self) -> usize {
        self as usize
    }

    /// Returns a value counted outwards.
    pub fn outwards(self, value: f64) -> f64 {
        if self == Self::Low { -value } else { value }
    }
}

/// Extreme of a range over an interval of time.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Extreme {
    /// Guaranteed bound.
    pub bound: f64,
    /// Value that is attained.
    pub attained: f64,
    /// Time (s) at which it is attained.
    pub time: f64,
}

/// First instant at which limits are passed.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct LimitCrossing {
    /// Time (s) before which no limit is passed.
    pub safe_until: f64,
    /// Time (s) at which a limit is passed for some state and input; `None` if this is not decided.
    pub passed_at: Option<f64>,
}

/// Range over time on a grid, and the search between its instants.
pub struct Reach<'a, T: Tube> {
    tube: &'a T,
    grid: Vec<TubeInstant<T::State>>,
    /// Largest number of evaluations of one search.
    budget: usize,
}

/// Width of an interval, as a part of the whole, below which a search does not divide it.
const NARROWEST: f64 = 1e-11;
/// Difference between the bound and the attained value, relative to it, that ends a search.
const PRECISION: f64 = 1e-10;

impl<'a, T: Tube> Reach<'a, T> {
    /// Evaluates the range at `count` + 1 instants from 0 to `until` (s).
    pub fn new(tube: &'a T, until: f64, count: usize) -> Self {
        let mut grid = vec![tube.start()];
        for index in 1..=count {
            let t = if index == count { until } else { until * (index as f64 / count as f64) };
            let next = tube.later(&grid[index - 1], t);
            grid.push(next);
        }
        Self { tube, grid, budget: 20_000 + 8 * count }
    }

    /// Returns the instants of the grid.
    pub fn grid(&self) -> &[TubeInstant<T::State>] {
        &self.grid
    }

    fn until(&self) -> f64 {
        self.grid.last().map_or(0.0, |last| last.t)
    }

    /// Returns the largest value of an end of the range, counted outwards, between two instants: a bound.
    fn between(side: Side, first: &TubeInstant<T::State>, last: &TubeInstant<T::State>) -> f64 {
        let width = last.t - first.t;
        let ends = side.outwards(first.bounds[side.index()]).max(side.outwards(last.bounds[side.index()]));
        // The factor covers the rounding of these few operations.
        (ends + 0.125 * width * width * first.curvature * (1.0 + 1e-12)).next_up()
    }

    /// Returns the extreme of an end of the range.
    pub fn extreme(&self, side: Side) -> Extreme {
        let attained = |instant: &TubeInstant<T::State>| side.outwards(instant.attained[side.index()]);
        let first = &self.grid[0];
        let mut best = (attained(first), first.t);
        let mut floor = side.outwards(first.bounds[side.index()]);
        for instant in &self.grid {
            if attained(instant) > best.0 {
                best = (attained(instant), instant.t);
            }
            floor = floor.max(side.outwards(instant.bounds[side.index()]));
        }
        // Most promising first, so that few intervals are divided.
        let mut order: Vec<(f64, usize)> = self
            .grid
            .windows(2)
            .enumerate()
            .map(|(index, pair)| (Self::between(side, &pair[0], &pair[1]), index))
            .collect();
        order.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let mut spent = 0;
        let mut bound = floor;
        for (above, index) in order {
            if above <= bound {
                break;
            }
            let mut open = vec![(self.grid[index].clone(), self.grid[index + 1].clone())];
            while let Some((from, to)) = open.pop() {
                let above = Self::between(side, &from, &to);
                let width = to.t - from.t;
                if above <= floor + PRECISION * floor.abs()
                    || width <= NARROWEST * self.until()
                    || spent >= self.budget
                {
                    bound = bound.max(above);
                    continue;
                }
                spent += 1;
                let middle = self.tube.later(&from, from.t + 0.5 * width);
                if attained(&middle) > best.0 {
                    best = (attained(&middle), middle.t);
                }
                floor = floor.max(side.outwards(middle.bounds[side.index()]));
                let [left, right] = [(from, middle.clone()), (middle, to)];
                // The more promising half is searched first.
                if Self::between(side, &left.0, &left.1) > Self::between(side, &right.0, &right.1) {
                    open.extend([right, left]);
                } else {
                    open.extend([left, right]);
                }
            }
        }
        Extreme { bound: side.outwards(bound.max(floor)), attained: side.outwards(best.0), time: best.1 }
    }

    /// Returns the first instant at which the range may pass limits \[low, high\]; `None` if it stays within.
    pub fn first_crossing(&self, limits: [f64; 2]) -> Option<LimitCrossing> {
        let outside = |range: &[f64; 2]| range[0] < limits[0] || range[1] > limits[1];
        if outside(&self.grid[0].attained) {
            return Some(LimitCrossing { safe_until: 0.0, passed_at: Some(0.0) });
        }
        let mut spent = 0;
        let mut doubted: Option<f64> = None;
        for pair in self.grid.windows(2) {
            let mut open = vec![(pair[0].clone(), pair[1].clone())];
            while let Some((from, to)) = open.pop() {
                let is_safe = Side::BOTH
                    .into_iter()
                    .all(|side| Self::between(side, &from, &to) <= side.outwards(limits[side.index()]));
                if is_safe {
                    continue;
                }
                let width = to.t - from.t;
                if width > NARROWEST * self.until() && spent < self.budget {
                    spent += 1;
                    let middle = self.tube.later(&from, from.t + 0.5 * width);
                    open.extend([(middle.clone(), to), (from, middle)]);
                    continue;
                }
                let safe_until = *doubted.get_or_insert(from.t);
                if outside(&to.attained) {
                    return Some(LimitCrossing { safe_until, passed_at: Some(to.t) });
                }
            }
        }
        doubted.map(|safe_until| LimitCrossing { safe_until, passed_at: None })
    }
}
