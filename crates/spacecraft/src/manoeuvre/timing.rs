//! Shortest time of a manoeuvre whose peak torque is limited, and the times to which a single harmonic is tuned.

use std::f64::consts::TAU;

use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity;

use super::plan::Plan;
use super::planner::ManoeuvrePlanner;

/// Factor by which the search increases the time until the peak is low enough.
const STRIDE: f64 = 1.02;
/// Largest number of strides: a time ten thousand times that of the rigid body.
const STRIDES: usize = 480;
/// No command is searched that lasts longer, in periods of the fastest mode: its peak is sought among that many.
const MOST_PERIODS: f64 = 2e4;

/// Plans the shortest manoeuvre whose peak torque does not exceed `limit` (N m).
pub fn shortest_plan(planner: &ManoeuvrePlanner, limit: f64) -> Result<Plan, ConfigError> {
    let bound = planner.rigid_bound(limit);
    let mut low = match planner.body.drive {
        flexsc_dynamics::axis_model::CommandedQuantity::Torque => bound,
        // Flexible modes can make the hub's torque less than that of the rigid body.
        flexsc_dynamics::axis_model::CommandedQuantity::Motion => 0.5 * bound,
    }
    .max(planner.shaper() * (1.0 + 1e-9));
    // The bound may be the time itself, so its rounding is tolerated.
    let peak = |time: f64| -> Result<f64, ConfigError> {
        let plan = planner.plan(time)?;
        Ok(plan.peak_torque(planner.body).value / limit - 1.0)
    };
    let excess = |time: f64| peak(time).unwrap_or(f64::INFINITY);
    if !low.is_finite() || low <= 0.0 {
        return Err(impossible(limit));
    }
    let fastest = planner.body.modes.iter().map(|mode| mode.frequency.get()).fold(0.0, f64::max);
    let periods = low * fastest / TAU;
    if periods > MOST_PERIODS {
        return Err(ConfigError::new(
            "peak_torque",
            format!(
                "must be enough for a command that lasts at most {MOST_PERIODS:e} periods of the fastest mode, got {} N m, with \
                 which it lasts {periods:.1e}",
                quantity::shortest(limit)
            ),
        ));
    }
    let mut above = excess(low);
    if above <= 1e-12 {
        return planner.plan(low);
    }
    for _ in 0..STRIDES {
        let high = low * STRIDE;
        let reached = excess(high);
        if reached <= 0.0 {
            return planner.plan(crossing(excess, (low, above), (high, reached)));
        }
        (low, above) = (high, reached);
    }
    Err(impossible(limit))
}

fn impossible(limit: f64) -> ConfigError {
    ConfigError::new("peak_torque", format!("must be enough for the command in some time, got {limit} N m"))
}

/// Finds the point at which a function falls through zero: a point at which it is not positive, within a relative
/// 1e-13.
fn crossing(f: impl Fn(f64) -> f64, mut low: (f64, f64), mut high: (f64, f64)) -> f64 {
    while high.0 - low.0 > 1e-13 * high.0 {
        // Try a secant that stays off the ends, and the middle if the secant fails.
        let secant = low.0 + (high.0 - low.0) * (low.1 / (low.1 - high.1));
        let length = high.0 - low.0;
        let margin = 2e-14 * high.0;
        for guess in [secant - margin, secant + margin, 0.5 * (low.0 + high.0)] {
            if guess > low.0 && guess < high.0 {
                let value = f(guess);
                if value > 0.0 {
                    low = (guess, value);
                } else {
                    high = (guess, value);
                }
            }
            if high.0 - low.0 < 0.25 * length {
                break;
            }
        }
    }
    high.0
}

/// Family of a single-harmonic command that can leave a mode at rest.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum SingleHarmonicTime {
    /// Single sine: w T = 2 pi psi, psi >= 2.
    Sine,
    /// Single cosine: w T = (2 psi + 1) pi, psi >= 1; it needs the same rate before and after.
    Cosine,
}

/// Returns the times nearest to `time` (s), below and above it, for which a single harmonic leaves an undamped mode of
/// this frequency (rad/s) at rest; there may be none below.
pub fn tuned_times(single: SingleHarmonicTime, frequency: f64, time: f64) -> (Option<f64>, f64) {
    let half = std::f64::consts::PI / frequency;
    // The values of w T/pi are 4, 6, 8, ... or 3, 5, 7, ...
    let (first, step) = match single {
        SingleHarmonicTime::Sine => (4.0, 2.0),
        SingleHarmonicTime::Cosine => (3.0, 2.0),
    };
    let below = first + step * libm::floor((time / half - first) / step);
    if below < first { (None, half * first) } else { (Some(half * below), half * (below + step)) }
}
