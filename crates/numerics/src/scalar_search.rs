//! Roots and extrema of functions of one variable.

/// Golden section: (sqrt(5) - 1)/2.
const GOLDEN: f64 = 0.618_033_988_749_894_9;
/// Largest number of evaluations for a root: bisection alone needs fewer.
const MOST: u32 = 200;

/// Returns the root between `low` and `high`, at which the function has different signs, by Brent's method
/// (\[Brent73\]), to rounding.
pub fn root(mut f: impl FnMut(f64) -> f64, low: f64, high: f64) -> f64 {
    // b is the best point, a the one before it, and the root is between b and c.
    let (mut a, mut b) = (low, high);
    let (mut at_a, mut at_b) = (f(a), f(b));
    let (mut c, mut at_c) = (a, at_a);
    let mut step = b - a;
    let mut last_step = step;
    for _ in 0..MOST {
        if at_c.abs() < at_b.abs() {
            (a, b, c) = (b, c, b);
            (at_a, at_b, at_c) = (at_b, at_c, at_b);
        }
        let tolerance = 2.0 * f64::EPSILON * b.abs();
        let middle = 0.5 * (c - b);
        if middle.abs() <= tolerance || at_b == 0.0 {
            break;
        }
        let trial = interpolated([a, b, c], [at_a, at_b, at_c]);
        match trial {
            Some(trial)
                if last_step.abs() >= tolerance
                    && at_a.abs() > at_b.abs()
                    && 2.0 * trial.abs() < (3.0 * middle).abs() - tolerance
                    && 2.0 * trial.abs() < last_step.abs()
                    && trial * middle > 0.0 =>
            {
                (last_step, step) = (step, trial);
            }
            _ => (last_step, step) = (middle, middle),
        }
        (a, at_a) = (b, at_b);
        b += if step.abs() > tolerance { step } else { tolerance.copysign(middle) };
        at_b = f(b);
        if (at_b > 0.0) == (at_c > 0.0) {
            (c, at_c) = (a, at_a);
            step = b - a;
            last_step = step;
        }
    }
    b
}

/// Returns the step from b to the root of a parabola through three points, or of a line through two.
fn interpolated([a, b, c]: [f64; 3], [at_a, at_b, at_c]: [f64; 3]) -> Option<f64> {
    let s = at_b / at_a;
    let (p, q) = if a == c {
        ((c - b) * s, 1.0 - s)
    } else {
        let (q, r) = (at_a / at_c, at_b / at_c);
        (s * ((c - b) * q * (q - r) - (b - a) * (r - 1.0)), (q - 1.0) * (r - 1.0) * (s - 1.0))
    };
    let step = -p / q;
    step.is_finite().then_some(step)
}

/// Returns argument and value of the maximum of a unimodal function on [`low`, `high`], by golden section. The value is
/// exact to rounding; the argument has half the digits.
pub fn maximum(mut f: impl FnMut(f64) -> f64, mut low: f64, mut high: f64) -> (f64, f64) {
    let mut left = high - GOLDEN * (high - low);
    let mut right = low + GOLDEN * (high - low);
    let (mut at_left, mut at_right) = (f(left), f(right));
    while high - low > 1e-9 * high.abs().max(low.abs()) {
        if at_left >= at_right {
            (high, right, at_right) = (right, left, at_left);
            left = high - GOLDEN * (high - low);
            at_left = f(left);
        } else {
            (low, left, at_left) = (left, right, at_right);
            right = low + GOLDEN * (high - low);
            at_right = f(right);
        }
    }
    if at_left >= at_right { (left, at_left) } else { (right, at_right) }
}

/// Largest number of evaluations of a search for a resonance.
const MOST_EVALUATIONS: usize = 24;

/// Returns the argument of the maximum of a positive function near a resonance, whose values at three increasing arguments rise and
/// fall: by parabolas through the reciprocal squares at the best three arguments, which are exact for one resonance alone. The
/// argument has some nine digits.
pub fn resonance(mut f: impl FnMut(f64) -> f64, arguments: [f64; 3], values: [f64; 3]) -> f64 {
    let [mut low, _, mut high] = arguments;
    let square = |value: f64| 1.0 / (value * value);
    let mut best = [0, 1, 2].map(|place: usize| (square(values[place]), arguments[place]));
    best.sort_by(|a, b| a.0.total_cmp(&b.0));
    for _ in 0..MOST_EVALUATIONS {
        let [(at, x), (at_second, second), (at_third, third)] = best;
        let (p, q) = ((x - second) * (at - at_third), (x - third) * (at - at_second));
        let step = 0.5 * ((x - second) * p - (x - third) * q) / (p - q);
        if !step.is_finite() || step.abs() < 1e-9 * x.abs() {
            break;
        }
        let within = (low..high).contains(&(x - step));
        let longer = if x - low > high - x { low } else { high };
        let next = if within { x - step } else { 0.5 * (x + longer) };
        let value = square(f(next));
        // What is beyond the better of two arguments is no maximum.
        if (value <= at) == (next < x) {
            high = x.max(next);
        } else {
            low = x.min(next);
        }
        let mut all = [best[0], best[1], best[2], (value, next)];
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        best = [all[0], all[1], all[2]];
    }
    best[0].1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_to_rounding_with_few_evaluations() {
        for (f, low, high, expected) in [
            ((|x: f64| x * x - 2.0) as fn(f64) -> f64, 0.0, 2.0, std::f64::consts::SQRT_2),
            (|x| libm::exp(x) - 3.0, -4.0, 9.0, 1.098_612_288_668_109_8),
            (|x| libm::cos(x), 3.0, 1.0, std::f64::consts::FRAC_PI_2),
            (|x| x * x * x, -1.0, 3.0, 0.0),
        ] {
            let mut count = 0;
            let counted = |x: f64| {
                count += 1;
                f(x)
            };
            let found = root(counted, low, high);
            // A triple root is approached by a constant factor.
            let bound = if expected == 0.0 { 1e-18 } else { 4e-16 };
            assert!((found - expected).abs() <= bound * expected.abs().max(1.0), "{found} {expected}");
            assert!(count < 15 || expected == 0.0, "{count} evaluations for {expected}");
        }
    }

    #[test]
    fn a_maximum_to_rounding() {
        let (place, value) = maximum(|x| 3.0 - (x - 0.7) * (x - 0.7), 0.1, 4.0);
        assert!((place - 0.7).abs() < 2e-8 && (value - 3.0).abs() < 1e-15, "{place} {value}");
    }

    /// The response of an oscillator of damping 0.01 under an imbalance: w²/|1 - w² + 2 j zeta w|, the largest at 1/sqrt(1 - 2 zeta²).
    #[test]
    fn a_resonance_with_few_evaluations() {
        let zeta = 0.01;
        let response = |w: f64| w * w / libm::hypot(1.0 - w * w, 2.0 * zeta * w);
        let mut count = 0;
        let counted = |w: f64| {
            count += 1;
            response(w)
        };
        let ends = [0.8, 1.02, 1.3];
        let found = resonance(counted, ends, ends.map(response));
        assert!((found - 1.0 / f64::sqrt(1.0 - 2.0 * zeta * zeta)).abs() < 1e-8, "{found}");
        assert!(count < 16, "{count} evaluations");
    }
}
