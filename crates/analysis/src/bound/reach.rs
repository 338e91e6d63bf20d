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
/// Differences between the bound and the largest value of an instant, relative to it, that end the passes of a search. A
/// range that stays at its extreme for long needs more evaluations by the root of ten for each.
const PRECISIONS: [f64; 9] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10];
/// Largest number of evaluations of one search, besides a few for each interval of a short grid.
const MOST_EVALUATIONS: usize = 100_000;

/// State of a search for an extreme; values count outwards.
struct ExtremeSearch {
    side: Side,
    /// Largest bound of an instant.
    floor: f64,
    /// Largest value that is attained, and its time (s).
    best: (f64, f64),
    /// Number of evaluations.
    spent: usize,
}

impl ExtremeSearch {
    fn add<S>(&mut self, instant: &TubeInstant<S>) {
        let index = self.side.index();
        let attained = self.side.outwards(instant.attained[index]);
        if attained > self.best.0 {
            self.best = (attained, instant.t);
        }
        self.floor = self.floor.max(self.side.outwards(instant.bounds[index]));
    }
}

impl<'a, T: Tube> Reach<'a, T> {
    /// Evaluates the range at `count` + 1 instants from 0 to `until` (s).
    pub fn new(tube: &'a T, until: f64, count: usize) -> Self {
        let mut grid = vec![tube.start()];
        for index in 1..=count {
            let t = if index == count { until } else { until * (index as f64 / count as f64) };
            let next = tube.later(&grid[index - 1], t);
            grid.push(next);
        }
        Self { tube, grid, budget: 20_000 + (8 * count).min(MOST_EVALUATIONS) }
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
        let mut search =
            ExtremeSearch { side, floor: f64::NEG_INFINITY, best: (f64::NEG_INFINITY, 0.0), spent: 0 };
        for instant in &self.grid {
            search.add(instant);
        }
        // Most promising first, so that few intervals are divided.
        let mut order: Vec<(f64, usize)> = self
            .grid
            .windows(2)
            .enumerate()
            .map(|(index, pair)| (Self::between(side, &pair[0], &pair[1]), index))
            .collect();
        order.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let mut bound = f64::INFINITY;
        for precision in PRECISIONS {
            // Each pass has a bound of its own, which a pass that ends early may exceed.
            bound = bound.min(self.pass(&order, precision, &mut search));
            if search.spent >= self.budget {
                break;
            }
        }
        let bound = bound.max(search.floor);
        Extreme { bound: side.outwards(bound), attained: side.outwards(search.best.0), time: search.best.1 }
    }

    /// Returns a bound of an end of the range, by dividing the intervals in which it may exceed its largest value at an
    /// instant by more than the precision.
    fn pass(&self, order: &[(f64, usize)], precision: f64, search: &mut ExtremeSearch) -> f64 {
        let side = search.side;
        let mut bound = search.floor;
        for &(above, index) in order {
            if above <= bound {
                break;
            }
            let mut open = vec![(self.grid[index].clone(), self.grid[index + 1].clone())];
            while let Some((from, to)) = open.pop() {
                let above = Self::between(side, &from, &to);
                let width = to.t - from.t;
                if above <= search.floor + precision * search.floor.abs()
                    || width <= NARROWEST * self.until()
                    || search.spent >= self.budget
                {
                    bound = bound.max(above);
                    continue;
                }
                search.spent += 1;
                let middle = self.tube.later(&from, from.t + 0.5 * width);
                search.add(&middle);
                let [left, right] = [(from, middle.clone()), (middle, to)];
                // The more promising half is searched first.
                if Self::between(side, &left.0, &left.1) > Self::between(side, &right.0, &right.1) {
                    open.extend([right, left]);
                } else {
                    open.extend([left, right]);
                }
            }
        }
        bound
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
