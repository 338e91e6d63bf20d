//! Integral of the magnitude of a response: the effect of an input that varies in time.
//!
//! Between two instants at which the magnitude cannot vanish, and on both sides of a single root, the integral is a
//! difference of step responses. It is the largest such sum over all divisions of the interval, so that any division is
//! a lower bound; the upper bound comes from the derivatives.

/// Impulse response h at an instant, and what bounds it afterwards.
#[derive(Copy, Clone, Debug, Default)]
pub struct Impulse {
    /// Time (s).
    pub t: f64,
    /// Impulse response h.
    pub value: f64,
    /// Derivative of h.
    pub slope: f64,
    /// Integral of h from 0, the step response.
    pub step: f64,
    /// Bound of the second derivative from this time on.
    pub bend: f64,
    /// Bound of the third derivative from this time on.
    pub jerk: f64,
    /// Bound of the rounding errors of the value and the step.
    pub rounding: f64,
    /// Bound of the rounding error of the slope.
    pub slope_rounding: f64,
}

/// Integral of |h|: a value that is attained, and its distance from an upper bound.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Variation {
    /// Integral over a division of the interval.
    pub attained: f64,
    /// Upper bound of what it lacks.
    pub gap: f64,
}

/// Division of an interval where the impulse response changes its sign.
pub struct SignChanges<'a> {
    /// Evaluation at a time (s).
    pub impulse: &'a dyn Fn(f64) -> Impulse,
    /// Width (s) below which an interval is not divided.
    pub narrowest: f64,
    /// Gap that is small enough for one root.
    pub small: f64,
    /// Times (s) of the roots.
    pub roots: Vec<f64>,
}

/// Largest number of steps to a root.
const MOST_STEPS: u32 = 6;

impl SignChanges<'_> {
    /// Returns the integral of |h| from one instant to another.
    pub fn integral(&mut self, from: &Impulse, to: &Impulse) -> Variation {
        let mut sum = Variation::default();
        let mut open = vec![(*from, *to)];
        while let Some((from, to)) = open.pop() {
            if let Some(part) = self.undivided(&from, &to) {
                sum.attained += part.attained;
                sum.gap += part.gap;
            } else {
                let middle = (self.impulse)(from.t + 0.5 * (to.t - from.t));
                open.extend([(middle, to), (from, middle)]);
            }
        }
        sum
    }

    /// Returns the integral where the signs within are certain, or the interval is narrow.
    fn undivided(&mut self, from: &Impulse, to: &Impulse) -> Option<Variation> {
        let width = to.t - from.t;
        let noise = from.rounding.max(to.rounding);
        let whole = Variation { attained: (to.step - from.step).abs(), gap: 2.0 * noise };
        let same_sign = (from.value > 0.0) == (to.value > 0.0);
        let deviation = 0.125 * width * width;
        if same_sign && from.value.abs().min(to.value.abs()) > deviation * from.bend + noise {
            return Some(whole);
        }
        let uncertain = 1.01 * (deviation * from.jerk + from.slope_rounding.max(to.slope_rounding));
        let steepness = from.slope.abs().min(to.slope.abs()) - uncertain;
        let is_monotonic = (from.slope > 0.0) == (to.slope > 0.0) && steepness > 0.0;
        if is_monotonic && same_sign && from.value.abs().min(to.value.abs()) > noise {
            return Some(whole);
        }
        if is_monotonic && !same_sign {
            let root = self.root(from, to, steepness);
            self.roots.push(root.t);
            let attained = (root.step - from.step).abs() + (to.step - root.step).abs();
            let miss = root.value.abs() + noise;
            return Some(Variation { attained, gap: 4.0 * noise + 2.0 * miss * miss / steepness });
        }
        let most =
            0.5 * width * (from.value.abs() + to.value.abs() + 2.0 * noise) + deviation * width * from.bend;
        // A response that has decayed below its rounding has no certain signs, and no effect.
        if width <= self.narrowest || most <= whole.attained + 2.0 * noise {
            if !same_sign {
                self.roots.push(from.t);
            }
            return Some(Variation {
                attained: whole.attained,
                gap: (most - whole.attained).max(0.0) + 2.0 * noise,
            });
        }
        None
    }

    /// Returns an instant near the only root between two others.
    fn root(&self, from: &Impulse, to: &Impulse, steepness: f64) -> Impulse {
        let (mut low, mut high) = (*from, *to);
        let mut best = low;
        for _ in 0..MOST_STEPS {
            let width = high.t - low.t;
            let part = cubic_root(&low, &high);
            let point = (self.impulse)((low.t + part * width).clamp(low.t, high.t));
            best = point;
            if 2.0 * point.value * point.value <= self.small * steepness || width <= self.narrowest {
                break;
            }
            if (point.value > 0.0) == (low.value > 0.0) {
                low = point;
            } else {
                high = point;
            }
        }
        best
    }
}

/// Returns the root of the cubic through two instants with their slopes, as a part of the interval.
fn cubic_root(low: &Impulse, high: &Impulse) -> f64 {
    let width = high.t - low.t;
    let (first, last) = (width * low.slope, width * high.slope);
    let rise = high.value - low.value;
    let (square, cube) = (3.0 * rise - 2.0 * first - last, first + last - 2.0 * rise);
    let mut part = -low.value / rise;
    for _ in 0..4 {
        let value = low.value + part * (first + part * (square + part * cube));
        let slope = first + part * (2.0 * square + 3.0 * part * cube);
        let next = part - value / slope;
        if !(0.0..=1.0).contains(&next) {
            break;
        }
        part = next;
    }
    part
}
