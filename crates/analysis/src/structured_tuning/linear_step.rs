//! Step of a tuning: a linear programme that maximises the least of some linearised values within a box.

use flexsc_numerics::simplex::LinearProgramme;

/// Value and its derivatives in the parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Slope {
    /// Value.
    pub value: f64,
    /// Derivative in each parameter.
    pub gradient: Vec<f64>,
    /// True if the value is to be at least 0; false if it is one of those whose least is maximised.
    pub is_constraint: bool,
}

/// Cost of a violated constraint, relative to the margin.
pub const PENALTY: f64 = 100.0;

/// Returns the step within a box that maximises the least of the values, less a penalty for violated constraints, and
/// that least value.
pub fn largest_least(slopes: &[Slope], room: &[[f64; 2]]) -> (Vec<f64>, f64) {
    // The dual programme has as many rows as there are parameters, and one more: weights of the values that sum to 1.
    let count = room.len();
    // Each parameter in units of its room.
    let units: Vec<f64> = room.iter().map(|[low, high]| high.max(-low).max(f64::MIN_POSITIVE)).collect();
    let (mut columns, mut costs, mut most) = (Vec::new(), Vec::new(), Vec::new());
    let largest = slopes
        .iter()
        .flat_map(|slope| slope.gradient.iter().zip(&units).map(|(part, unit)| (part * unit).abs()))
        .fold(1.0, f64::max);
    for slope in slopes {
        let mut column: Vec<f64> =
            slope.gradient.iter().zip(&units).map(|(part, unit)| -part * unit).collect();
        column.push(if slope.is_constraint { 0.0 } else { 1.0 });
        columns.push(column);
        costs.push(slope.value);
        most.push(if slope.is_constraint { PENALTY } else { 1.0 });
    }
    for (place, ([low, high], unit)) in room.iter().zip(&units).enumerate() {
        for (sense, bound) in [(1.0, high / unit), (-1.0, -low / unit)] {
            columns.push((0..=count).map(|row| if row == place { sense } else { 0.0 }).collect());
            costs.push(bound);
            most.push(largest * (1.0 + PENALTY) * 2.0);
        }
    }
    let programme = LinearProgramme::new(count + 1, columns, most);
    let demand: Vec<f64> = (0..=count).map(|row| if row == count { 1.0 } else { 0.0 }).collect();
    let (weights, _, prices) = programme.cheapest_with_prices(&demand, &costs);
    let least = weights.iter().zip(&costs).map(|(weight, cost)| weight * cost).sum();
    let step = prices.iter().zip(room).zip(&units);
    (step.map(|((price, [low, high]), unit)| (price * unit).clamp(*low, *high)).collect(), least)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slope(value: f64, gradient: [f64; 2], is_constraint: bool) -> Slope {
        Slope { value, gradient: gradient.to_vec(), is_constraint }
    }

    /// Against the vertices of the primal programme, by enumeration.
    #[test]
    fn the_step_is_the_best_one() {
        let slopes = [
            slope(0.2, [1.0, 0.5], false),
            slope(0.4, [-1.0, 0.3], false),
            slope(0.3, [0.1, -1.0], false),
            slope(0.05, [1.0, -2.0], true),
        ];
        let room = [[-0.3, 0.2], [-0.1, 0.5]];
        let (step, expected) = largest_least(&slopes, &room);
        let value =
            |slope: &Slope, d: &[f64]| slope.value + slope.gradient[0] * d[0] + slope.gradient[1] * d[1];
        let merit = |d: &[f64]| {
            let least = slopes.iter().filter(|slope| !slope.is_constraint).map(|slope| value(slope, d));
            let over =
                slopes.iter().filter(|slope| slope.is_constraint).map(|slope| value(slope, d).min(0.0));
            least.fold(f64::MAX, f64::min) + PENALTY * over.sum::<f64>()
        };
        assert!((merit(&step) - expected).abs() < 1e-12, "{step:?} {expected}");
        let mut best = f64::MIN;
        for i in 0..=500 {
            for j in 0..=600 {
                best = best.max(merit(&[-0.3 + 1e-3 * f64::from(i), -0.1 + 1e-3 * f64::from(j)]));
            }
        }
        assert!(best <= expected + 1e-12 && best > expected - 3e-3, "{best} {expected}");
    }
}
